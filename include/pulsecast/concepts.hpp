// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <concepts>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <type_traits>

#include <pulsecast/base/frame.hpp>
#include <pulsecast/echo.hpp>
#include <pulsecast/geometry/box.hpp>
#include <pulsecast/geometry/bundle.hpp>
#include <pulsecast/geometry/ray.hpp>
#include <pulsecast/pulse.hpp>

/// The contract: every public concept, on one page. A model is one plain struct; nothing is inherited or registered.
/// The laws that a compiler cannot check are tested by `tests/support/laws.hpp`.
// clang-format off
// version 14 tears compound requirements apart
namespace pulsecast {

// ---------------------------------------------------------------------------------------------------------------- motions

/// A moving thing, as a closed-form function of time: where the frame `From` is in the frame `To`.
/// Law: the same tick gives the same pose, in any order, from any thread, from a copy; its rotation is unit.
/// Not required: continuity, a default constructor, an inverse.
template <class M, class From, class To>
concept Motion = std::copyable<M> && requires(const M m, Tick t) {
  { m.at(t) } noexcept -> std::same_as<Pose<From, To>>;
};

/// What a laser beam passes on its way out: a mirror, a prism, a fibre.
template <class O>
concept Optic = Motion<O, frame::Beam, frame::Instrument>;

/// A moving thing that lets light out at some times only. An optic or head need not be gated.
/// Law: as for `Motion`.
template <class M>
concept Gated = requires(const M m, Tick t) {
  { m.open(t) } noexcept -> std::same_as<bool>;
};

/// What turns a whole instrument that already deflects its beam.
template <class H>
concept Head = Motion<H, frame::Instrument, frame::Instrument>;

/// What carries an instrument through the world.
/// Law: continuous, except where its data jump; right-continuous there.
template <class T>
concept Trajectory = Motion<T, frame::Body, frame::World>;

/// The height of the ground [m] at a place [m east, m north]; empty where there is none. Asked by planners, before the first pulse, so it
/// need not be noexcept.
template <class G>
concept Ground = requires(const G ground, Vec2 place) {
  { ground(place) } -> std::convertible_to<std::optional<double>>;
};

// ---------------------------------------------------------------------------------------------------------- pulse sources

/// Pulses by number, in one frame: slot i is asked for in any order, and may be empty if an optic blocks it.
/// `duration()` is the time from the first slot to the one that would follow the last.
/// Law: pure in i; time does not decrease with i; the pose's rotation is unit; what wraps a source keeps its size and ticks.
template <class S, class Frame>
concept PulseSource = std::copyable<S> && requires(const S s, PulseIndex i) {
  { s.size() } noexcept -> std::same_as<PulseIndex>;
  { s.duration() } noexcept -> std::same_as<Tick>;
  { s.pulse(i) } noexcept -> std::same_as<std::optional<Pulse<Frame>>>;
};

template <class S>
concept BeamSource = PulseSource<S, frame::Beam>;  ///< as `Scanner`
template <class S>
concept InstrumentSource = PulseSource<S, frame::Instrument>;  ///< as `Deflector<...>`
template <class S>
concept WorldSource = PulseSource<S, frame::World>;  ///< as `Platform<...>`

/// A source that draws random errors, as `WithPoseErrors`: `Legs` tells each of its legs its place in the list, so that no two draw the
/// same.
/// Law: place 0 changes nothing.
template <class S>
concept DrawsByLeg = WorldSource<S> && requires(S& s, std::uint32_t leg) { s.draw_for_leg(leg); };

// -------------------------------------------------------------------------------------------------------------- the scene

namespace detail {
struct TestsPrimitives {
  void operator()(std::span<const PrimitiveIndex>) const noexcept {}
};
}  // namespace detail

/// A search structure over the boxes of numbered primitives. It knows nothing of what is inside them: `test` is called with the
/// primitives that a bundle may meet, and enters what it finds into `nearest`. What it is called with are stretches of `order()`, in which
/// every primitive stands that can be met at all, side by side with its neighbours, and maybe in several places. `test.prefetch(range)`, if
/// there is such a thing, may be told some time before.
/// Law: where the primitives keep to their boxes, `nearest` ends as if every primitive had been tested; rays of NaN miss.
template <class A>
concept Accelerator = std::copyable<A> && std::constructible_from<A, std::span<const Box>> &&
    requires(const A a, const RayBundle& rays, const detail::TestsPrimitives& test, ClosestHits& nearest) {
  { a.bounds() } noexcept -> std::same_as<const Box&>;
  { a.memory() } noexcept -> std::same_as<std::size_t>;
  { a.order() } noexcept -> std::same_as<std::span<const PrimitiveIndex>>;
  { a.closest(rays, test, nearest) } noexcept;
};

/// A primitive's surface where a ray met it.
struct Surface {
  Vec3 normal{};               ///< unit, either side, in the geometry's own frame; zero if the surface has no direction
  std::uint32_t material = 0;  ///< index into the material table of the part
};

/// A shape that rays can meet, in its own frame [m]. Shared by any number of parts. `memory()` is in bytes; `material_count()` is how
/// long a part's material table must be.
/// `surface(i, rays, j)` is that of primitive i where ray j met it: not told where, a curved one meets the ray again. The shape may say
/// `static constexpr bool flat = true` if a primitive's surface is the same wherever it is met: it is then asked for once.
/// Law: pure; random draws come from the bundle's names only; `closest` offers primitives to `nearest` and nothing else.
template <class G>
concept Geometry = requires(const G g, const RayBundle& rays, ClosestHits& nearest, PrimitiveIndex i, std::size_t j) {
  { g.bounds() } noexcept -> std::same_as<const Box&>;
  { g.memory() } noexcept -> std::same_as<std::size_t>;
  { g.material_count() } noexcept -> std::same_as<std::size_t>;
  { g.closest(rays, nearest) } noexcept;
  { g.surface(i, rays, j) } noexcept -> std::same_as<Surface>;
};

/// A map that answers for a bundle of subrays at once, as `Scene` does. `hits` has room for one hit a ray.
/// Law: pure; every hit is set, to infinite range where nothing is met.
template <class T>
concept BundleTarget = requires(const T t, const RayBundle& rays, std::span<Hit> hits) {
  { t.closest(rays, hits) } noexcept;
};

/// A map of the user's own that answers for one ray: the simplest thing that can be scanned.
template <class T>
concept RayTarget = requires(const T t, const Ray& ray) {
  { t.closest_hit(ray) } noexcept -> std::same_as<std::optional<Hit>>;
};

/// Anything that can be scanned.
template <class T>
concept Target = BundleTarget<T> || RayTarget<T>;

// ----------------------------------------------------------------------------------------------------------- the detector

/// How a beam's cross section is sampled by subrays, in units of its 1/e^2 radius: x to the right and y up, looking along the beam.
/// Law: the shares are not negative and sum to one; a survey refuses others.
/// May say `static constexpr bool recorded = true`, to have all subrays handed on to the sinks, as `WithSubrayRecord` does.
template <class F>
concept Footprint = std::copyable<F> && requires(const F f, std::size_t j) {
  { f.size() } noexcept -> std::same_as<std::size_t>;
  { f.offset(j) } noexcept -> std::same_as<Vec2>;
  { f.share(j) } noexcept -> std::same_as<double>;
};

/// What a subray brought back: the input of a detector.
struct Reflection {
  double range = 0;  ///< [m]
  double power = 0;  ///< received, as if the pulse had no length; greater than 0 [W]
  ObjectId object = 0;
  std::uint16_t classification = 0;
  double cos_incidence = 1;  ///< as in `Hit`
};

/// What a detector made of a pulse; the spans stay valid until the workspace is used again.
struct Detection {
  std::span<Echo> echoes;           ///< sorted by range; `reflectance` is the survey's to fill in
  std::span<const float> waveform;  ///< received power [W]; empty if not kept
  double waveform_start = 0;        ///< two-way travel time of the first sample [s]
};

/// Turns what the subrays brought back into echoes. Reflections come in the order of the subrays, those without power left out. All that it
/// needs to write on is its `Workspace`, made once per worker by `workspace(subrays)`.
/// Law: pure; echoes are sorted by range; their energy is not more than what came in.
/// Not required: to use all reflections; randomness; `void validate(const Laser&) const`, which refuses lasers before the first pulse. A
/// detector that draws random numbers takes a last argument, `RandomKey key = {}`, that names seed and pulse, and draws from a
/// `purpose` of its own, as `Purpose{128}`, and any `subray` and `part` of it.
template <class D>
concept Detector = std::copyable<D> && requires(const D d, const Laser& laser, std::span<Reflection> reflections, std::size_t subrays,
                                                decltype(d.workspace(subrays))& workspace) {
  { d.detect(laser, reflections, workspace) } noexcept -> std::same_as<Detection>;
};

/// How the width of an echo is measured: a policy of the waveform detectors. `samples` is the waveform [W] between the valleys to the
/// neighbouring echoes, every `interval` [s]; the answer is a standard deviation in time [s], NaN if there is none to be found.
/// Not required: `width(const WaveformMoments&)`, from which `AnalyticWaveform` has the exact width without samples; `min_share()`, a
/// share of the highest sample below which samples do not matter, so that the tail of a waveform need not be sampled.
template <class W>
concept EchoWidth = std::copyable<W> && requires(const W w, std::span<const double> samples, double interval) {
  { w.width(samples, interval) } noexcept -> std::same_as<double>;
};

/// Whatever takes the results: a writer, a cloud in memory, a lambda.
/// Law of the caller: batches come in ascending pulse order, one call at a time.
template <class S>
concept EchoSink = std::invocable<S&, const EchoBatch&>;

}  // namespace pulsecast
