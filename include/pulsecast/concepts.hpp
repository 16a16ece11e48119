// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_CONCEPTS_HPP
#define PULSECAST_CONCEPTS_HPP

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <pulsecast/base/frame.hpp>
#include <pulsecast/base/lanes.hpp>
#include <pulsecast/base/random.hpp>
#include <pulsecast/echo.hpp>
#include <pulsecast/geometry/box.hpp>
#include <pulsecast/geometry/bundle.hpp>
#include <pulsecast/geometry/ray.hpp>
#include <pulsecast/pulse.hpp>
#include <pulsecast/refinements.hpp>

/// Contract: the public concepts. A model is a plain struct, without inheritance or registration. Optional members are
/// refinements, listed in refinements.hpp. The laws that a compiler cannot check are tested by
/// `tests/support/laws.hpp`.
// clang-format off
// version 14 breaks up compound requirements
namespace PULSECAST_NAMESPACE {

// ---------------------------------------------------------------------------------------------------------------- motions

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

/// Height of the ground [m] at a place [m east, m north]; empty where there is none. Called by planners, before the first pulse, so it need
/// not be noexcept.
template <class G>
concept Ground = requires(const G ground, Vec2 place) {
  { ground(place) } -> std::convertible_to<std::optional<double>>;
};

// ---------------------------------------------------------------------------------------------------------- pulse sources

/// Pulses by number, in one frame. Slots may be requested in any order, and are empty if an optic blocks the pulse. `duration()` is the
/// time from the first slot to one past the last. `emitters()` is the table of emitters, at most `max_emitters`, that pulses refer to by
/// index. Surveys and wrappers ask for it once, when they are made; it may allocate.
/// Law: pure in i; time does not decrease with i, except between `Legs` with starts of their own; the pose's rotation is unit; the table is always the same and lists the emitter of each
/// pulse; a wrapper of a source keeps its size, ticks and emitters.
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

/// Poses of a motion at the ticks of the lanes in `asked`; returns the lanes of these where it is open. A motion that does not move in lanes,
/// or that replaces the `at` of one, is asked tick by tick.
template <class M>
simd::Mask find_poses(const M& motion, const TickLanes& ticks, simd::Mask asked, detail::PosesOf<M>& poses) noexcept {
  static_assert(detail::members_checked<M, tag::Gated, tag::ForeseesOpening, tag::MovesInLanes>);
  if constexpr (MovesInLanes<M> && detail::LanesOfItsPoses<M>) {
    return asked & motion.poses(ticks, poses);
  } else {
    for (std::size_t lane = 0; lane < simd::lane_count; ++lane) {
      if (asked[lane] == 0) continue;
      const Tick t = ticks[lane];
      if constexpr (Gated<M>) asked[lane] = motion.open(t) ? -1 : 0;
      if (asked[lane] != 0) poses.set(lane, motion.at(t));
    }
    return asked;
  }
}

/// Pulses of a source from slot i on, as the concept MakesLanes requires: of one slot, if the source does not, or replaces
/// the `pulse` of one that does.
template <class S>
[[nodiscard]] detail::PulsesOf<S> find_pulses(const S& source, PulseIndex i, std::size_t count) noexcept {
  static_assert(detail::members_checked<S, tag::MakesLanes, tag::FindsSlots, tag::SkipsBlocked, tag::DrawsByLeg, tag::MeasuresBeam>);
  if constexpr (MakesLanes<S> && detail::LanesOfItsPulses<S>) return source.pulse_lanes(i, count);
  detail::PulsesOf<S> one;
  one.push_back(source.pulse(i));
  return one;
}

// -------------------------------------------------------------------------------------------------------------- the scene

namespace detail {
struct TestsPrimitives {
  void operator()(std::span<const PrimitiveIndex>) const noexcept {}
};
}  // namespace detail

/// Search structure over the boxes of numbered primitives, independent of their kind. `closest` calls `test` with the primitives that a
/// bundle may meet, and `test` enters hits into `nearest`. Each call gets a subrange of `order()`. `order()` holds every primitive that can
/// be hit, next to its neighbours, possibly repeated. A test that `PrefetchesPrimitives` may be told some time before.
/// Law: if primitives are inside their boxes, `nearest` ends as if every primitive had been tested; rays of NaN miss.
template <class A>
concept Accelerator = std::copyable<A> && std::constructible_from<A, std::span<const Box>> &&
    requires(const A a, const RayBundle& rays, const detail::TestsPrimitives& test, ClosestHits& nearest) {
  { a.bounds() } noexcept -> std::same_as<const Box&>;
  { a.memory() } noexcept -> std::same_as<std::size_t>;
  { a.order() } noexcept -> std::same_as<std::span<const PrimitiveIndex>>;
  { a.closest(rays, test, nearest) } noexcept;
};

/// Surface of a primitive at a hit.
struct Surface {
  Vec3 normal{};               ///< unit, either side, in the geometry's own frame; zero for a surface without direction
  std::uint32_t material = 0;  ///< index into the material table of the part
  bool foliage = false;        ///< true for one of many leaves of all directions, of whose incidence the normal tells the mean
};

/// Shape for ray intersection, in its own frame [m], shared by any number of parts. `memory()` is in bytes; `material_count()` is the least
/// length of a part's material table.
/// `surface(i, rays, j)` is the surface of primitive i at its hit by ray j. The hit point is not passed; a curved primitive recomputes it.
/// Not required: one surface for all hits of a primitive, as of a `UniformGeometry`.
/// Law: pure; random draws depend on the bundle's names only; `closest` offers primitives to `nearest` and does nothing else.
template <class G>
concept Geometry = requires(const G g, const RayBundle& rays, ClosestHits& nearest, PrimitiveIndex i, std::size_t j) {
  { g.bounds() } noexcept -> std::same_as<const Box&>;
  { g.memory() } noexcept -> std::same_as<std::size_t>;
  { g.material_count() } noexcept -> std::same_as<std::size_t>;
  { g.closest(rays, nearest) } noexcept;
  { g.surface(i, rays, j) } noexcept -> std::same_as<Surface>;
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

/// Any scan target.
template <class T>
concept Target = BundleTarget<T> || RayTarget<T>;

/// Nearest hit in a target of each ray of a bundle. Sets one hit per ray, of infinite range for a miss.
template <Target Map>
void find_hits(const Map& map, const RayBundle& rays, std::span<Hit> hits) noexcept {
  if constexpr (BundleTarget<Map>)
    map.closest(rays, hits);
  else
    for (std::size_t j = 0; j < rays.size; ++j) hits[j] = map.closest_hit(rays.ray(j)).value_or(Hit{});
}

namespace detail {
/// True only if a target that `MissesCones` says so of a cone of rays.
template <Target Map>
[[nodiscard]] bool misses_cone(const Map& map, const RayCone& cone) noexcept {
  static_assert(members_checked<Map, tag::MissesCones>);
  if constexpr (MissesCones<Map>) return map.misses_cone(cone);
  return false;
}
}  // namespace detail

/// Map that knows how its surfaces move, as `MovingScene`: queries by a ray give the surface at the hit, with its velocity [m/s].
template <class T>
concept VelocityTarget = Target<T> && requires(const T t, const Ray& ray) {
  { t.surface(*t.closest_hit(ray), ray).velocity } noexcept -> std::convertible_to<Vec3>;
};

struct Material;

/// Surface that a ray of a bundle met, in the world.
struct HitSurface {
  const Material* material = nullptr;  ///< owned by the target; of no meaning for a miss
  Vec3 normal{};                       ///< unit, either side; zero for a surface without direction
  bool foliage = false;                ///< as in `Surface`
  std::optional<Vec2> texture{};       ///< texture coordinates, for a material with a map of reflectances; empty without
};

/// Map that also tells the materials and normals at the hits of a bundle, and answers for rays one by one, as `Scene`: light can go on there.
/// Law: hits are those of `closest` without surfaces, but for the ranges at which rays begin; `closest_hit` finds the same.
template <class T>
concept OpticalTarget = BundleTarget<T> && requires(const T t, const StaggeredBundle& rays, std::span<Hit> hits, std::span<HitSurface> surfaces,
                                                    const Ray& ray, double range) {
  { t.closest(rays, hits, surfaces) } noexcept;
  { t.occluded(ray, range) } noexcept -> std::same_as<bool>;
  { t.surface(*t.closest_hit(ray), ray).material } noexcept -> std::convertible_to<const Material*>;
};

// ---------------------------------------------------------------------------------------------- from the beam to the echoes

/// Sampling of a beam's cross section by subrays, in units of its 1/e^2 radius: x to the right and y up, looking along the beam.
/// Law: the shares are not negative and sum to one; a survey refuses others.
/// Not required: a record of all subrays, as of one that `RecordsSubrays`.
template <class F>
concept Footprint = std::copyable<F> && requires(const F f, std::size_t j) {
  { f.size() } noexcept -> std::same_as<std::size_t>;
  { f.offset(j) } noexcept -> std::same_as<Vec2>;
  { f.share(j) } noexcept -> std::same_as<double>;
};

/// Light that returned along one path of a subray: the input of a detector.
struct Reflection {
  double range = 0;                               ///< half the optical path from the pulse's origin and back [m]
  double power = 0;                               ///< received power for a pulse of zero length; greater than 0 [W]
  ObjectId object = 0;                            ///< as in `Hit`
  std::uint16_t classification = 0;               ///< as in `Hit`
  ReflectionKind kind = ReflectionKind::surface;  ///< way of the light
  double cos_incidence = 1;                       ///< as in `Hit`
  double velocity = 0;                            ///< velocity of the surface along the ray, positive away; set for `ReadsVelocity` [m/s]
};

/// Light that returned from all ranges of a stretch, as from haze or water: a power by range that is linear from end to end. It is no
/// echo by itself, as its waveform has a maximum only where it begins or grows.
struct ContinuousReturn {
  double begin = 0, end = 0;                  ///< ends of the stretch, as `Reflection::range` [m]
  double at_begin = 0, at_end = 0;            ///< received power by range there, for a pulse of zero length; not negative [W/m]
  ObjectId object = 0;                        ///< as in `Hit`
  std::uint16_t classification = 0;           ///< as in `Hit`
  ReflectionKind kind = ReflectionKind::air;  ///< way of the light

  /// Power of the whole stretch [W].
  [[nodiscard]] double power() const noexcept { return 0.5 * (at_begin + at_end) * (end - begin); }
};

/// Light of one pulse, as a transport takes it: `transport/transport_input.hpp`.
struct TransportInput;

/// Result of a transport for one pulse.
struct TransportResult {
  EnergyLedger energy{};        ///< energy of the pulse by the end of its paths
  std::size_t reflections = 0;  ///< number of reflections
  Fate fate = Fate::missed;     ///< fate of a pulse of which no light returned: `missed`, `out_of_range` or `absorbed`
  bool nan = false;             ///< true if the map answered with NaN: an error of the run
  bool spread = false;          ///< true if the light was spread over a smooth surface: `spread_over_plane`
  bool unresolved = false;      ///< true if more subrays would have been needed for that than there is room for
  /// What returned from no one place, by ascending begin; stretches may overlap. In the workspace, until that is used again.
  std::span<const ContinuousReturn> continuous{};

  /// True if no light returned.
  [[nodiscard]] bool dark() const noexcept { return reflections == 0 && continuous.empty(); }
};

/// Paths of light from the beam to surfaces and back. Sets the first of `reflections`, in any order. There is room for
/// `reflections(n)` of a pulse of n subrays. Its only writable memory is a `Workspace`, made once per worker by `workspace(subrays)`.
/// Law: pure; the terms of the ledger sum to the energy sent to 1e-6; `received` is the sum of the powers of reflections and continuous
/// returns, times the pulse length, and at most `scattered`; both are of positive power, from inside the gate; each of
/// `TransportInput::record` is set.
/// Not required: `trace<true>(...)`, which also sets velocities: `TracesVelocity`.
template <class T, class Map>
concept Transport = std::copyable<T> && requires(const T t, const Map& map, const TransportInput& light, std::size_t subrays,
                                                 decltype(t.workspace(subrays))& workspace, std::span<Reflection> reflections) {
  { t.reflections(subrays) } noexcept -> std::same_as<std::size_t>;
  { t.trace(map, light, workspace, reflections) } noexcept -> std::same_as<TransportResult>;
};

/// Transport that also sets `Reflection::velocity`, if the first template argument of `trace` is true.
template <class T, class Map>
concept TracesVelocity = Transport<T, Map> && requires(const T t, const Map& map, const TransportInput& light, std::size_t subrays,
                                                       decltype(t.workspace(subrays))& workspace, std::span<Reflection> reflections) {
  { t.template trace<true>(map, light, workspace, reflections) } noexcept -> std::same_as<TransportResult>;
};

/// Input of a detector for one pulse.
struct DetectorInput {
  const Emitter& emitter;               ///< emitter of the pulse
  RangeGate gate{};                     ///< range gate of the receiver
  std::span<Reflection> reflections{};  ///< all reflections, in any order; a detector may reorder and change them
  RandomKey key{};                      ///< seed of the survey, and index of the pulse
  /// As in `TransportResult`. A detector that does not read them hears the surfaces alone, dimmed by what is between.
  std::span<const ContinuousReturn> continuous{};
};

/// Result of a detector for one pulse; the spans stay valid until the workspace is used again.
struct Detection {
  std::span<Echo> echoes;           ///< sorted by range; the survey fills in `reflectance`
  std::span<const float> waveform;  ///< received power [W]; empty if not kept
  double waveform_start = 0;        ///< two-way travel time of the first sample [s]
};

/// Turns the reflections of a pulse into echoes. Its only writable memory is a `Workspace`, made once per worker by `workspace(n)` for up
/// to n reflections. Random draws take `input.key` with a `purpose` of the detector's own, as `Purpose{128}`, and any `subray` and `part`.
/// Law: pure; echoes are sorted by range. Unless it `RunsWithoutReflections`, nothing heard gives no echo, and the echoes' energy does not exceed
/// that received.
/// Not required: use of all reflections; randomness; waveforms, as of one that `SamplesWaveforms`; limits of the laser, as of one that
/// `ValidatesLaser`; velocities, as of one that `ReadsVelocity`.
template <class D>
concept Detector = std::copyable<D> &&
    requires(const D d, const DetectorInput& input, std::size_t reflections, decltype(d.workspace(reflections))& workspace) {
  { d.detect(input, workspace) } noexcept -> std::same_as<Detection>;
};

/// Measure of the width of an echo: a policy of the waveform detectors. `samples` is the waveform [W] between the valleys to the
/// neighbouring echoes, every `interval` [s]. The result is a standard deviation in time [s], or NaN if none is found.
/// Not required: a width from moments, as of a `MomentWidthMeasure`; a limit of the tail, as of a `TruncatedWidthMeasure`.
template <class W>
concept EchoWidth = std::copyable<W> && requires(const W w, std::span<const double> samples, double interval) {
  { w.width(samples, interval) } noexcept -> std::same_as<double>;
};

// ---------------------------------------------------------------------------------------------------------------- the run

struct Outcome;

/// Simulation as `run` takes it: from a pulse slot to its outcome. `Survey` models it. A worker's only writable memory is a workspace.
/// `sample_interval()` is the sample spacing of waveforms, or 0 [s]. `subrays()` and `recorded_subrays()` are counts per pulse.
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
