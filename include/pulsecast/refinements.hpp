// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_REFINEMENTS_HPP
#define PULSECAST_REFINEMENTS_HPP

#include <memory>
#include <span>

#include <pulsecast/base/error_source.hpp>
#include <pulsecast/geometry/bundle.hpp>
#include <pulsecast/geometry/ray_cone.hpp>
#include <pulsecast/pulse.hpp>

/// Contract, continued: optional members, a refinement of a concept in concepts.hpp each. The stage or class that uses
/// the member refuses one of another form by a static assertion. A model that states `using refinements =
/// pulsecast::refines<tag::Gated, tag::ForeseesOpening>;` is refused without these members, too. `Validated`,
/// `ValidatesLaser` and `Normalizable`, for settings of all kinds, are in base/require.hpp.
// clang-format off
// version 14 breaks up compound requirements
namespace PULSECAST_NAMESPACE {

/// Optic or head that transmits light at some times only.
/// Law: as for `Motion`.
template <class M>
concept Gated = requires(const M m, Tick t) {
  { m.open(t) } noexcept -> std::same_as<bool>;
};
PULSECAST_OPTIONAL_MEMBER(Gated, "bool open(Tick) const noexcept", open, (Tick{}))

/// Ground of several levels, such as roads and the bridges above them.
/// Law: `ground(place, near)` is the level nearest to the height `near` [m]; for infinity the highest, which is
/// `ground(place)`.
template <class G>
concept LevelledGround = requires(const G ground, Vec2 place, double near) {
  { ground(place, near) } -> std::convertible_to<std::optional<double>>;
};

/// Gated optic or head that foresees its opening, as `PolygonMirror`, so that a run passes over slots without a visit.
/// Law: `open` is false from t up to, but not at, `next_open(t)`, which is not before t. It may be early, and is t if
/// nothing is foreseen.
template <class M>
concept ForeseesOpening = requires(const M m, Tick t) {
  { m.next_open(t) } noexcept -> std::same_as<Tick>;
};
PULSECAST_OPTIONAL_MEMBER(ForeseesOpening, "Tick next_open(Tick) const noexcept", next_open, (Tick{}))

namespace detail {
template <class P>
struct InLanes;
template <class From, class To>
struct InLanes<Pose<From, To>> { using type = PoseLanes<From, To>; };
template <class Frame>
struct InLanes<std::optional<Pulse<Frame>>> { using type = PulseLanes<Frame>; };
template <class C, class Result, class... Arguments>
std::type_identity<C> declared_in(Result (C::*)(Arguments...) const noexcept);
/// Source whose `pulse_lanes` goes with its `pulse`: not one that inherits both and replaces one.
template <class S>
concept LanesOfItsPulses = std::same_as<decltype(declared_in(&S::pulse)), decltype(declared_in(&S::pulse_lanes))>;
/// Motion whose `poses` goes with its `at`.
template <class M>
concept LanesOfItsPoses = std::same_as<decltype(declared_in(&M::at)), decltype(declared_in(&M::poses))>;
/// Motion whose `derivatives` go with its `at`.
template <class M>
concept DerivativesOfItsPoses = std::same_as<decltype(declared_in(&M::at)), decltype(declared_in(&M::derivatives))>;
/// `PoseLanes` of a motion.
template <class M>
using PosesOf = typename InLanes<decltype(std::declval<const M&>().at(Tick{}))>::type;
/// `PulseLanes` of a source.
template <class S>
using PulsesOf = typename InLanes<decltype(std::declval<const S&>().pulse(PulseIndex{}))>::type;
}  // namespace detail

/// Motion that answers for a register of ticks at once, as `PolygonMirror`. It sets the poses, and returns the lanes at
/// whose ticks it is open: all, unless it is `Gated`. Poses of the other lanes have no meaning.
/// Law: a lane has the pose that `at` gives for its tick, bit for bit, whatever is in the other lanes, and is set where
/// `open` is true.
template <class M>
concept MovesInLanes = requires(const M m, const TickLanes& ticks, detail::PosesOf<M>& poses) {
  { m.poses(ticks, poses) } noexcept -> std::same_as<simd::Mask>;
};
PULSECAST_OPTIONAL_MEMBER(MovesInLanes, "simd::Mask poses(const TickLanes&, PoseLanes<From, To>&) const noexcept", poses,
                          (TickLanes{}, std::declval<detail::PosesOf<T>&>()))

/// Motion that knows its derivatives, as `Waypoints`, for an `Imu`. Others are differentiated by `derivatives_of`.
/// `at` has one signature, by which both are known to be of the same class.
/// Law: the derivatives of `at` at that tick, from the right where they jump; zero where the pose rests.
template <class M>
concept Differentiable = requires(const M m, Tick t) {
  { m.derivatives(t) } noexcept -> std::same_as<Derivatives>;
};
PULSECAST_OPTIONAL_MEMBER(Differentiable, "Derivatives derivatives(Tick) const noexcept", derivatives, (Tick{}))

/// Source that makes the pulses of a register at once, as `Scanner`: from 1 to `count` slots from i on, where `count`
/// is at least 1 and at most `simd::lane_count`, and the slots are below `size()`.
/// Law: slot i + k is `pulse(i + k)`, bit for bit.
template <class S>
concept MakesLanes = requires(const S s, PulseIndex i, std::size_t count) {
  { s.pulse_lanes(i, count) } noexcept -> std::same_as<detail::PulsesOf<S>>;
};
PULSECAST_OPTIONAL_MEMBER(MakesLanes, "PulseLanes<Frame> pulse_lanes(PulseIndex, std::size_t) const noexcept", pulse_lanes,
                          (PulseIndex{}, std::size_t{}))

/// Source that makes every n-th pulse in lanes at no more cost, as of one channel of many: `pulse_lanes(i, count, step)`.
/// Law: its lane k is `pulse(i + k * step)`, bit for bit.
PULSECAST_OPTIONAL_CONSTANT(StridesLanes, strides_lanes)

namespace detail {
/// Source whose `pulse_lanes` take a step.
template <class S>
concept MakesStridedLanes = MakesLanes<S> && StridesLanes<S> && LanesOfItsPulses<S>;
}  // namespace detail

/// Source that finds slots by time, as `Scanner`.
/// Law: all slots before `slot_from(t)` are at times before t; it may be early, and is at most `size()`.
template <class S>
concept FindsSlots = requires(const S s, Tick t) {
  { s.slot_from(t) } noexcept -> std::same_as<PulseIndex>;
};
PULSECAST_OPTIONAL_MEMBER(FindsSlots, "PulseIndex slot_from(Tick) const noexcept", slot_from, (Tick{}))

/// Source or survey that passes over blocked slots. `run` asks it after each blocked slot, and counts those between
/// without a visit.
/// Law: for i below `size()`, all slots from i up to, but not at, `next_pulse(i)` are blocked; it is at least i and at
/// most `size()`.
template <class S>
concept SkipsBlocked = requires(const S& s, PulseIndex i) {
  { s.next_pulse(i) } noexcept -> std::same_as<PulseIndex>;
};
PULSECAST_OPTIONAL_MEMBER(SkipsBlocked, "PulseIndex next_pulse(PulseIndex) const noexcept", next_pulse, (PulseIndex{}))

/// Source with random errors, as `WithPoseErrors`. `Legs` passes each of its legs its place in the list, so that their
/// draws are independent.
/// Law: place 0 changes nothing.
template <class S>
concept DrawsByLeg = requires(S& s, std::uint32_t leg) {
  { s.draw_for_leg(leg) } -> std::same_as<void>;
};
PULSECAST_OPTIONAL_MEMBER(DrawsByLeg, "void draw_for_leg(std::uint32_t)", draw_for_leg, (std::uint32_t{}))

/// Instrument that measures its beams with errors, as `helios::Instrument`. `measured(i, t)` is the beam of pulse i,
/// fired at t, as the instrument reports it, or empty if exact. A platform computes the reported pose from it.
/// Law: pure; a wrapper of an instrument passes it on, as it does the pulse.
template <class S>
concept MeasuresBeam = requires(const S s, PulseIndex i, Tick t) {
  { s.measured(i, t) } noexcept -> std::same_as<std::optional<Pose<frame::Beam, frame::Instrument>>>;
};
PULSECAST_OPTIONAL_MEMBER(MeasuresBeam,
                          "std::optional<Pose<frame::Beam, frame::Instrument>> measured(PulseIndex, Tick) const noexcept",
                          measured, (PulseIndex{}, {}))

namespace detail {
template <class Frame>
struct TakesErrors {
  void operator()(const PoseError<Frame>&) const noexcept {}
};
template <class P>
struct FrameOf;
template <class Frame>
struct FrameOf<std::optional<Pulse<Frame>>> { using type = Frame; };
/// Visitor of the errors of a source.
template <class S>
using ErrorVisitorOf = TakesErrors<typename FrameOf<decltype(std::declval<const S&>().pulse(PulseIndex{}))>::type>;
}  // namespace detail

/// Source that states the errors of its reported pulses, as `WithPoseErrors`: `visit_errors(i, t, visit)` calls `visit` with
/// a `PoseError` in its frame for each error of pulse i, fired at t. An instrument that `MeasuresBeam` and draws its errors
/// states them so.
/// Law: pure; to first order, the reported pose of a pulse is its true one, displaced by the sum of these errors, each times
/// a draw from the standard normal distribution; a wrapper of a source passes them on.
template <class S>
concept StatesErrors = requires(const S s, PulseIndex i, Tick t, const detail::ErrorVisitorOf<S>& visit) {
  { s.visit_errors(i, t, visit) } noexcept -> std::same_as<void>;
};
PULSECAST_OPTIONAL_MEMBER(StatesErrors, "void visit_errors(PulseIndex, Tick, const Visitor&) const noexcept", visit_errors,
                          (PulseIndex{}, Tick{}, std::declval<const detail::ErrorVisitorOf<T>&>()))

/// Leaf test of an accelerator that loads primitives into the cache ahead of their test.
template <class T>
concept PrefetchesPrimitives = requires(const T& test, std::span<const PrimitiveIndex> primitives) {
  { test.prefetch(primitives) } noexcept -> std::same_as<void>;
};
PULSECAST_OPTIONAL_MEMBER(PrefetchesPrimitives, "void prefetch(std::span<const PrimitiveIndex>) const noexcept", prefetch,
                          (std::span<const PrimitiveIndex>{}))

/// Target, shape or accelerator that tells of a cone of rays, at little cost, that none meets anything, so that they
/// need not be made. It need not look further than its bounds and the upper levels of its trees.
/// Law: pure; true only if every ray in the cone misses at the cone's tick, and so it stays for any near and far ends
/// of the rays.
template <class T>
concept MissesCones = requires(const T target, const RayCone& cone) {
  { target.misses_cone(cone) } noexcept -> std::same_as<bool>;
};
PULSECAST_OPTIONAL_MEMBER(MissesCones, "bool misses_cone(const RayCone&) const noexcept", misses_cone, (RayCone{}))

struct Material;
namespace detail {
struct TakesMaterials {
  void operator()(const Material&) const {}
};
}  // namespace detail

/// Target that visits its materials, so that a transport may refuse one before the first pulse, as `LightPaths` does.
/// Law: its hits have a `scattered_share`.
template <class T>
concept VisitsMaterials = requires(const T& target, const detail::TakesMaterials& visit) {
  { target.visit_materials(visit) } -> std::same_as<void>;
};
PULSECAST_OPTIONAL_MEMBER(VisitsMaterials, "void visit_materials(const Visitor&) const", visit_materials, (detail::TakesMaterials{}))

/// Geometry whose primitives have the same surface at all their points: `surface` is called once for all hits of one.
PULSECAST_OPTIONAL_CONSTANT(UniformGeometry, uniform_surface)

/// Geometry whose hits do not depend on the key of the rays (seed, pulse and subray): nothing is drawn at random.
PULSECAST_OPTIONAL_CONSTANT(DeterministicGeometry, deterministic)

/// Geometry whose hits depend on the tick of the rays, as `WaterSurface`. Its bounds hold at all times.
PULSECAST_OPTIONAL_CONSTANT(TimeDependentGeometry, time_dependent)

struct Triangle;

/// Geometry whose primitives are triangles: hits on it have barycentric weights.
template <class G>
concept MadeOfTriangles = requires(const G g, PrimitiveIndex i) {
  { g.triangle(i) } noexcept -> std::same_as<Triangle>;
};

/// Geometry with texture coordinates, by primitive and barycentric weights; empty where there are none.
template <class G>
concept Textured = MadeOfTriangles<G> && requires(const G g, PrimitiveIndex i, const Vec3& weights) {
  { g.texture(i, weights) } noexcept -> std::same_as<std::optional<Vec2>>;
};

/// Footprint whose subrays are all passed to the sinks, as those of `WithSubrayRecord`.
PULSECAST_OPTIONAL_CONSTANT(RecordsSubrays, recorded)

/// Footprint that is turned about the beam's axis for each pulse, by an angle drawn from the pulse's number, as
/// `TurnedFootprint`. The beams are round.
PULSECAST_OPTIONAL_CONSTANT(RotatesPerPulse, rotates_per_pulse)

/// Footprint whose surveys judge whether all subrays of a pulse met one smooth surface, as those of `JudgedFootprint`, by
/// `Shot::surface`.
template <class F>
concept JudgesSurfaces = requires(const F footprint) {
  { footprint.judges_surfaces() } noexcept -> std::same_as<bool>;
};
PULSECAST_OPTIONAL_MEMBER(JudgesSurfaces, "bool judges_surfaces() const noexcept", judges_surfaces, ())

/// Detector that samples waveforms, every so many seconds [s].
template <class D>
concept SamplesWaveforms = requires(const D detector) {
  { detector.sample_interval() } noexcept -> std::same_as<double>;
};
PULSECAST_OPTIONAL_MEMBER(SamplesWaveforms, "double sample_interval() const noexcept", sample_interval, ())

/// Detector that is told of each laser that it will hear, before the first pulse, as one with tables by pulse length.
template <class D>
concept PreparesForLasers = requires(D& detector, const Laser& laser) {
  { detector.prepare(laser) } -> std::same_as<void>;
};
PULSECAST_OPTIONAL_MEMBER(PreparesForLasers, "void prepare(const Laser&)", prepare, (std::declval<const Laser&>()))

/// Detector that is asked for every pulse sent, also without returned light. Others need reflections.
PULSECAST_OPTIONAL_CONSTANT(RunsWithoutReflections, runs_without_reflections)

/// Detector that reads `Reflection::velocity`: of a transport that `TracesVelocity`, and a target with `SceneQueries`.
PULSECAST_OPTIONAL_CONSTANT(ReadsVelocity, reads_velocity)

struct WaveformMoments;

/// Measure of width that is exact from moments, without samples: a width in time, in the unit of the moments.
template <class W>
concept MomentWidthMeasure = requires(const W w, const WaveformMoments& moments) {
  { w.width(moments) } noexcept -> std::same_as<double>;
};
// each `EchoWidth` has a `width` of samples, too
PULSECAST_OPTIONAL_MEMBER(MomentWidthMeasure, "double width(const WaveformMoments&) const noexcept", width,
                          (std::declval<const WaveformMoments&>()), && false)

/// Measure of width that needs no samples below a share of the highest: the tail of a waveform need not be sampled.
template <class W>
concept TruncatedWidthMeasure = requires(const W w) {
  { w.min_share() } noexcept -> std::same_as<double>;
};
PULSECAST_OPTIONAL_MEMBER(TruncatedWidthMeasure, "double min_share() const noexcept", min_share, ())

/// Data structure that checks itself after it was read from a file: true if all indices in its arrays are in bounds.
template <class T>
concept SelfChecking = requires(const T& t) {
  { t.is_consistent() } -> std::same_as<bool>;
};

/// Accelerator that checks itself after it was read from a file: true if it is one of so many primitives.
template <class A>
concept SelfCheckingAccelerator = requires(const A& a, std::size_t primitives) {
  { a.is_consistent(primitives) } -> std::same_as<bool>;
};

PULSECAST_OPTIONAL_MEMBER(SelfChecking, "bool is_consistent() const", is_consistent, (), && !pulsecast::SelfCheckingAccelerator<T>)
PULSECAST_OPTIONAL_MEMBER(SelfCheckingAccelerator, "bool is_consistent(std::size_t) const", is_consistent, (std::size_t{}))

/// Sink that says whether it reads shots that give nothing: no echo, waveform or recorded subray. They are left out of
/// the batches if no sink of the run reads them. A sink without this member gets all shots.
/// Law: the same answer during a run.
template <class S>
concept ChoosesShots = requires(const S& sink) {
  { sink.reads_empty_shots() } noexcept -> std::same_as<bool>;
};
PULSECAST_OPTIONAL_MEMBER(ChoosesShots, "bool reads_empty_shots() const noexcept", reads_empty_shots, ())

struct Outcome;

/// Survey that simulates slots in order, from i up to `end`, so that it may prepare several at once, as `Survey`.
/// `next(outcome)` takes the outcome of a slot, and returns the slot to go on with, which is a later one.
/// Law: outcomes are those of single calls, bit for bit; what trajectory, map or clock said is not kept for another
/// call.
template <class S>
concept SimulatesInOrder = requires(const S& s, PulseIndex i, decltype(s.workspace())& workspace, PulseIndex (&next)(const Outcome&)) {
  { s.simulate_in_order(i, i, workspace, next) } -> std::same_as<void>;
};
PULSECAST_OPTIONAL_MEMBER(SimulatesInOrder, "void simulate_in_order(PulseIndex, PulseIndex, Workspace&, const Next&) const",
                          simulate_in_order, (PulseIndex{}, PulseIndex{}, std::declval<decltype(t.workspace())&>(),
                                              std::declval<PulseIndex (&)(const Outcome&)>()))

/// Survey that can be told from others, so that an executor may keep its workspaces from one run to the next.
/// Law: two surveys of one type share an identity, which is not null, only if each may use the other's workspaces.
template <class S>
concept IdentifiedSurvey = requires(const S& s) {
  { s.identity() } noexcept -> std::convertible_to<std::shared_ptr<const void>>;
};
PULSECAST_OPTIONAL_MEMBER(IdentifiedSurvey, "std::shared_ptr<const void> identity() const noexcept", identity, ())

namespace detail {
/// True; refuses a detector with an optional member in another form.
template <class D>
inline constexpr bool detector_checked =
    members_checked<D, tag::ValidatesLaser, tag::PreparesForLasers, tag::SamplesWaveforms, tag::RunsWithoutReflections,
                    tag::ReadsVelocity>;
}  // namespace detail

}  // namespace pulsecast

#endif
