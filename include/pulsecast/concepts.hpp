// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_CONCEPTS_HPP
#define PULSECAST_CONCEPTS_HPP

#include <vector>

#include <pulsecast/base/frame.hpp>
#include <pulsecast/base/lanes.hpp>
#include <pulsecast/base/random.hpp>
#include <pulsecast/echo.hpp>
#include <pulsecast/geometry/box.hpp>
#include <pulsecast/geometry/bundle.hpp>
#include <pulsecast/geometry/ray.hpp>
#include <pulsecast/hit.hpp>
#include <pulsecast/pulse.hpp>
#include <pulsecast/refinements.hpp>
#include <pulsecast/reflection.hpp>

/// Contract: the public concepts. A model is a plain struct, without inheritance or registration. Optional members are
/// refinements, listed in refinements.hpp. The laws that a compiler cannot check are tested by
/// `tests/support/laws.hpp`.
// clang-format off
// version 14 breaks up compound requirements
namespace PULSECAST_NAMESPACE {

// ----------------------------------------------------------------------------------------- motions

/// Rigid motion in closed form over time: the pose of the frame `From` in the frame `To`.
/// Law: the same tick gives the same pose, in any order, from any thread, from a copy; its rotation is unit.
/// Not required: continuity, a default constructor, an inverse.
template <class M, class From, class To>
concept Motion = std::copyable<M> && requires(const M m, Tick t) {
  { m.at(t) } noexcept -> std::same_as<Pose<From, To>>;
};

/// Optic in the path of the outgoing laser beam: a mirror, a prism, a fibre.
template <class O>
concept Optic = Motion<O, frame::Beam, frame::Instrument>;

/// Rotation of a whole instrument that already deflects its beam.
template <class H>
concept Head = Motion<H, frame::Instrument, frame::Instrument>;

/// Motion of an instrument's carrier through the world.
/// Law: continuous, except where its data jump; right-continuous there.
template <class T>
concept Trajectory = Motion<T, frame::Body, frame::World>;

/// Height of the ground [m] at a place [m east, m north]; empty where there is none. Called by planners, before the
/// first pulse, so it need not be noexcept.
template <class G>
concept Ground = requires(const G ground, Vec2 place) {
  { ground(place) } -> std::convertible_to<std::optional<double>>;
};

// ----------------------------------------------------------------------------------- pulse sources

/// Pulses by number, in one frame. Slots may be requested in any order, and are empty if an optic blocks the pulse.
/// `duration()` is the time from the first slot to one past the last. `emitters()` is the table of emitters, at most
/// `max_emitters`, that pulses refer to by index. Surveys and wrappers ask for it once, when they are made; it may
/// allocate.
/// Law: pure in i; time does not decrease with i, except between `Legs` with starts of their own; the pose's rotation
/// is unit; the table is always the same and lists the emitter of each pulse; a wrapper of a source keeps its size,
/// ticks and emitters.
template <class S, class Frame>
concept PulseSource = std::copyable<S> && requires(const S s, PulseIndex i) {
  { s.size() } noexcept -> std::same_as<PulseIndex>;
  { s.duration() } noexcept -> std::same_as<Tick>;
  { s.pulse(i) } noexcept -> std::same_as<std::optional<Pulse<Frame>>>;
  { s.emitters() } -> std::same_as<std::vector<Emitter>>;
};

template <class S>
concept BeamSource = PulseSource<S, frame::Beam>;  ///< as `Scanner`
template <class S>
concept InstrumentSource = PulseSource<S, frame::Instrument>;  ///< as `Deflector<...>`
template <class S>
concept WorldSource = PulseSource<S, frame::World>;  ///< as `Platform<...>`

// --------------------------------------------------------------------------------------- the scene

namespace detail {
struct TestsPrimitives {
  void operator()(std::span<const PrimitiveIndex>) const noexcept {}
};
}  // namespace detail

/// Search structure over the boxes of numbered primitives, independent of their kind. `closest` calls `test` with the
/// primitives that a bundle may meet, and `test` enters hits into `nearest`. Each call gets a subrange of `order()`.
/// `order()` holds every primitive that can be hit, next to its neighbours, possibly repeated. A test that
/// `PrefetchesPrimitives` may be told some time before.
/// Law: if primitives are inside their boxes, `nearest` ends as if every primitive had been tested; rays of NaN miss.
template <class A>
concept Accelerator = std::copyable<A> && std::constructible_from<A, std::span<const Box>> &&
    requires(const A a, const RayBundle& rays, const detail::TestsPrimitives& test, ClosestHits& nearest) {
  { a.bounds() } noexcept -> std::same_as<const Box&>;
  { a.memory() } noexcept -> std::same_as<std::size_t>;
  { a.order() } noexcept -> std::same_as<std::span<const PrimitiveIndex>>;
  { a.closest(rays, test, nearest) } noexcept;
};

/// Shape for ray intersection, in its own frame [m], shared by any number of parts. `memory()` is in bytes;
/// `material_count()` is the least length of a part's material table. `surface(i, rays, j)` is the surface of primitive
/// i at its hit by ray j: normal, material index, foliage. The hit point is not passed; a curved primitive recomputes
/// it.
/// Not required: one surface for all hits of a primitive, as of a `UniformGeometry`.
/// Law: pure; random draws depend on the bundle's names only; `closest` offers primitives to `nearest` and does nothing
/// else.
template <class G>
concept Geometry = requires(const G g, const RayBundle& rays, ClosestHits& nearest, PrimitiveIndex i, std::size_t j) {
  { g.bounds() } noexcept -> std::same_as<const Box&>;
  { g.memory() } noexcept -> std::same_as<std::size_t>;
  { g.material_count() } noexcept -> std::same_as<std::size_t>;
  { g.closest(rays, nearest) } noexcept;
  { g.surface(i, rays, j) } noexcept -> std::same_as<SurfaceInteraction>;
};

/// Map that intersects a bundle of subrays at once, as `Scene` does. `hits` has room for one hit per ray.
/// Law: pure; every hit is set, to infinite range for a miss.
template <class T>
concept BundleTarget = requires(const T t, const RayBundle& rays, std::span<Hit> hits) {
  { t.closest(rays, hits) } noexcept;
};

/// User's own map that intersects one ray: the simplest scan target.
template <class T>
concept RayTarget = requires(const T t, const Ray& ray) {
  { t.closest_hit(ray) } noexcept -> std::same_as<std::optional<Hit>>;
};

namespace detail {
struct TakesSurfaces {
  void operator()(std::size_t, std::size_t, const SurfaceInteraction&) const noexcept {}
};
}  // namespace detail

/// Map that tells the surfaces that rays hit, as `Scene`: light can be followed further there, and its velocity is known.
/// `closest` tells geometry: it sets range, cosine, object and class of the hits, and calls `visit(first, end, surface)`
/// for rays from `first` up to `end` that hit one surface; a later call for the same ray counts. What the surface
/// scatters, `visit` asks its law: `scatter_at`. Rays begin at ranges of their own. `surface(hit, ray)` is at a hit of the
/// same ray, `occluded` true if a ray hits anything beyond `ray.near`, up to a range [m] and to `ray.far`.
/// Law: hits are those of a `BundleTarget`, but for the ranges at which rays begin; `closest_hit` finds the same.
/// Not required: all hits of a ray; `position`, `part`, `primitive`, `weights` and `velocity` of what `closest` visits.
template <class T>
concept SceneQueries = requires(const T t, const StaggeredBundle& rays, std::span<Hit> hits,
                                const detail::TakesSurfaces& visit, const Ray& ray, const RayHit& hit, double range) {
  { t.closest(rays, hits, visit) } noexcept;
  { t.closest_hit(ray) } noexcept -> std::same_as<std::optional<RayHit>>;
  { t.occluded(ray, range) } noexcept -> std::same_as<bool>;
  { t.surface(hit, ray) } noexcept -> std::same_as<SurfaceInteraction>;
};

/// Any scan target. Scenes are a `BundleTarget` with `SceneQueries`.
template <class T>
concept Target = BundleTarget<T> || RayTarget<T>;

// --------------------------------------------------------------------- from the beam to the echoes

/// Sampling of a beam's cross section by subrays, in units of its 1/e^2 radius: x to the right and y up, looking along
/// the beam.
/// Law: the shares are not negative and sum to one; a survey refuses others.
/// Not required: a record of all subrays, as of one that `RecordsSubrays`.
template <class F>
concept Footprint = std::copyable<F> && requires(const F f, std::size_t j) {
  { f.size() } noexcept -> std::same_as<std::size_t>;
  { f.offset(j) } noexcept -> std::same_as<Vec2>;
  { f.share(j) } noexcept -> std::same_as<double>;
};

/// Light of one pulse, as a transport takes it: `transport/transport_input.hpp`.
struct TransportInput;

/// Paths of light from the beam to surfaces and back. Sets the first of `reflections`, in any order. There is room for
/// `reflections(n)` of a pulse of n subrays. Its only writable memory is a `Workspace`, made once per worker by
/// `workspace(subrays)`.
/// Law: pure; the terms of the ledger sum to the energy sent to 1e-6; `received` is the sum of the powers of
/// reflections and continuous returns, times the pulse length, and at most `scattered`; both are of positive power,
/// from inside the gate; each of `TransportInput::record` is set.
/// Not required: `trace<true>(...)`, which also sets velocities: `TracesVelocity`.
template <class T, class Target>
concept Transport = std::copyable<T> &&
    requires(const T t, const Target& target, const TransportInput& light, std::size_t subrays,
             decltype(t.workspace(subrays))& workspace, std::span<Reflection> reflections) {
  { t.reflections(subrays) } noexcept -> std::same_as<std::size_t>;
  { t.trace(target, light, workspace, reflections) } noexcept -> std::same_as<TransportResult>;
};

/// Transport that also sets `Reflection::velocity`, if the first template argument of `trace` is true.
template <class T, class Target>
concept TracesVelocity = Transport<T, Target> &&
    requires(const T t, const Target& target, const TransportInput& light, std::size_t subrays,
             decltype(t.workspace(subrays))& workspace, std::span<Reflection> reflections) {
  { t.template trace<true>(target, light, workspace, reflections) } noexcept -> std::same_as<TransportResult>;
};

/// Transport that is asked, when a survey is made, whether it can trace a target; it throws a `SettingError`.
template <class T, class Target>
concept ValidatesTarget = Transport<T, Target> && requires(const T t, const Target& target) { t.validate(target); };

/// Transport that takes the light of several pulses of one emitter at once, at most `simd::lane_count`. Pulse k sets
/// `results[k]`, and the first of the reflections from `k * reflections(subrays)` on. Reserved: surveys ask pulse by pulse
/// so far.
/// Law: what `trace` gives for each, bit for bit.
template <class T, class Target>
concept TracesInLanes = Transport<T, Target> &&
    requires(const T t, const Target& target, std::span<const TransportInput> light, std::size_t subrays,
             decltype(t.workspace(subrays))& workspace, std::span<Reflection> reflections,
             std::span<TransportResult> results) {
  { t.trace_lanes(target, light, workspace, reflections, results) } noexcept -> std::same_as<void>;
};

/// Turns the reflections of a pulse into echoes. Its only writable memory is a `Workspace`, made once per worker by
/// `workspace(n)` for up to n reflections. Random draws take `input.key` with a `purpose` of the detector's own, as
/// `Purpose{128}`, and any `subray` and `part`.
/// Law: pure; echoes are sorted by range. Unless it `RunsWithoutReflections`, nothing heard gives no echo, and the
/// echoes' energy does not exceed that received.
/// Not required: use of all reflections; randomness; waveforms, as of one that `SamplesWaveforms`; limits of the laser,
/// as of one that `ValidatesLaser`; velocities, as of one that `ReadsVelocity`.
template <class D>
concept Detector = std::copyable<D> &&
    requires(const D d, const DetectorInput& input, std::size_t reflections,
             decltype(d.workspace(reflections))& workspace) {
  { d.detect(input, workspace) } noexcept -> std::same_as<Detection>;
};

/// Detector that takes the reflections of several pulses at once, at most `simd::lane_count`. Reserved, as
/// `TracesInLanes`.
/// Law: what `detect` gives for each, bit for bit; all detections are valid until the next call.
template <class D>
concept DetectsInLanes = Detector<D> &&
    requires(const D d, std::span<const DetectorInput> inputs, std::size_t reflections,
             decltype(d.workspace(reflections))& workspace, std::span<Detection> detections) {
  { d.detect_lanes(inputs, workspace, detections) } noexcept -> std::same_as<void>;
};

/// Measure of the width of an echo: a policy of the waveform detectors. `samples` is the waveform [W] between the
/// valleys to the neighbouring echoes, every `interval` [s]. The result is a standard deviation in time [s], or NaN if
/// none is found.
/// Not required: a width from moments, as of a `MomentWidthMeasure`; a limit of the tail, as of a
/// `TruncatedWidthMeasure`.
template <class W>
concept EchoWidth = std::copyable<W> && requires(const W w, std::span<const double> samples, double interval) {
  { w.width(samples, interval) } noexcept -> std::same_as<double>;
};

// ----------------------------------------------------------------------------------------- the run

/// Simulation as `run` takes it: from a pulse slot to its outcome. `Survey` models it. A worker's only writable memory
/// is a workspace. `sample_interval()` is the sample spacing of waveforms, or 0 [s]. `subrays()` and
/// `recorded_subrays()` are counts per pulse.
/// Law: pure; the same slot gives the same outcome, in any order, with any workspace of the survey.
/// Not required: workspaces that can be moved or copied. For threads of one's own see `Executor` in base/parallel.hpp.
template <class S>
concept PulseSurvey = requires(const S& s, PulseIndex i, decltype(s.workspace())& workspace) {
  { s.size() } noexcept -> std::same_as<PulseIndex>;
  { s.subrays() } noexcept -> std::convertible_to<std::size_t>;
  { s.recorded_subrays() } noexcept -> std::convertible_to<std::size_t>;
  { s.sample_interval() } noexcept -> std::same_as<double>;
  { s(i, workspace) } noexcept -> std::same_as<Outcome>;
};

/// Receiver of results: a writer, a cloud in memory, a lambda.
/// Not required: a choice of shots, as of one that `ChoosesShots`.
/// Law of the caller: batches come in ascending pulse order, one call at a time.
template <class S>
concept EchoSink = std::invocable<S&, const EchoBatch&>;

}  // namespace pulsecast

#endif
