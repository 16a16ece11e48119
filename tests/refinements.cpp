// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/refinements.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <pulsecast/base/lanes.hpp>
#include <pulsecast/base/require.hpp>
#include <pulsecast/deflector/deflector.hpp>
#include <pulsecast/deflector/fixed_beam.hpp>
#include <pulsecast/deflector/polygon_mirror.hpp>
#include <pulsecast/deflector/rotating_head.hpp>
#include <pulsecast/platform/legs.hpp>
#include <pulsecast/platform/platform.hpp>
#include <pulsecast/platform/pose_errors.hpp>
#include <pulsecast/platform/tripod.hpp>
#include <pulsecast/run.hpp>
#include <pulsecast/scanner/any_source.hpp>
#include <pulsecast/scanner/channels.hpp>
#include <pulsecast/scanner/scanner.hpp>
#include <pulsecast/scene/scene.hpp>
#include <pulsecast/survey.hpp>

#include <doctest/doctest.h>

#include "support/archetypes.hpp"
#include "support/generators.hpp"
#include "support/laws.hpp"

using namespace pulsecast;
using namespace pulsecast::support;

namespace {

// Each optional member is refused in another form.
#define MISSPELT(Model, name, ...) \
  struct Model##_##name {          \
    __VA_ARGS__;                   \
  };                               \
  static_assert(!pulsecast::tag::Model::right<Model##_##name>)

MISSPELT(Validated, result, bool validate() const);
MISSPELT(Validated, changing, void validate());
MISSPELT(Validated, argument, void validate(int) const);
MISSPELT(ValidatesLaser, overload, void validate() const; bool validate(const Laser&) const);
MISSPELT(Normalizable, throwing, void normalize());
MISSPELT(Normalizable, copying, Normalizable_throwing normalize() const noexcept);
MISSPELT(Gated, vector, bool open(const Vec3&) const noexcept);
MISSPELT(Gated, number, int open(Tick) const noexcept);
MISSPELT(Gated, throwing, bool open(Tick) const);
MISSPELT(ForeseesOpening, seconds, double next_open(Tick) const noexcept);
MISSPELT(MovesInLanes, tick, Pose<frame::Beam, frame::Instrument> at(Tick) const noexcept;
         simd::Mask poses(Tick, PoseLanes<frame::Beam, frame::Instrument>&) const noexcept);
MISSPELT(Differentiable, throwing, Derivatives derivatives(Tick) const);
MISSPELT(Differentiable, velocity, Vec3 derivatives(Tick) const noexcept);
MISSPELT(MakesLanes, throwing, std::optional<Pulse<frame::Beam>> pulse(PulseIndex) const noexcept;
         PulseLanes<frame::Beam> pulse_lanes(PulseIndex, std::size_t) const);
MISSPELT(FindsSlots, throwing, PulseIndex slot_from(Tick) const);
MISSPELT(SkipsBlocked, changing, PulseIndex next_pulse(PulseIndex) noexcept);
MISSPELT(DrawsByLeg, nothing, void draw_for_leg());
MISSPELT(MeasuresBeam, always, Pose<frame::Beam, frame::Instrument> measured(PulseIndex, Tick) const noexcept);
MISSPELT(StatesErrors, throwing, std::optional<Pulse<frame::World>> pulse(PulseIndex) const noexcept;
         void visit_errors(PulseIndex, Tick, const auto&) const);
MISSPELT(StatesErrors, frame, std::optional<Pulse<frame::Instrument>> pulse(PulseIndex) const noexcept;
         void visit_errors(PulseIndex, Tick, void (*)(const PoseError<frame::World>&)) const noexcept);
MISSPELT(PrefetchesPrimitives, index, void prefetch(const PrimitiveIndex*) const noexcept);
MISSPELT(MissesCones, throwing, bool misses_cone(const RayCone&) const);
MISSPELT(VisitsMaterials, argument, void visit_materials(int) const);
MISSPELT(ScattersBetween, throwing, double scattered(const Vec3&, const Vec3&, const Vec3&, double) const);
MISSPELT(ScattersBetween, cosines, double scattered(double, double, double) const noexcept);
MISSPELT(SamplesDirections, direction, Vec3 sample(const Vec3&, const Vec3&, double, double) const noexcept);
MISSPELT(Retroreflects, alone, double returned_share() const noexcept);
MISSPELT(ReflectsInterface, function, bool reflects_interface() const noexcept);
MISSPELT(
    UniformGeometry, function, static constexpr bool uniform_surface() { return true; });
MISSPELT(UniformGeometry, variable, bool uniform_surface = true);
MISSPELT(DeterministicGeometry, function, bool deterministic() const noexcept);
MISSPELT(TimeDependentGeometry, number, static constexpr int time_dependent = 1);
MISSPELT(RecordsSubrays, member, const bool recorded = true);
MISSPELT(RotatesPerPulse, member, const bool rotates_per_pulse = true);
MISSPELT(SamplesWaveforms, data, double sample_interval = 1);
MISSPELT(PreparesForLasers, result, bool prepare(const Laser&));
MISSPELT(RunsWithoutReflections, number, static constexpr int runs_without_reflections = 1);
MISSPELT(ReadsVelocity, variable, bool reads_velocity = true);
MISSPELT(MomentWidthMeasure, single, float width(const WaveformMoments&) const noexcept);
MISSPELT(TruncatedWidthMeasure, throwing, double min_share() const);
MISSPELT(SelfChecking, changing, bool is_consistent());
MISSPELT(SelfCheckingAccelerator, nothing, bool is_consistent() const);
MISSPELT(ChoosesShots, constant, static constexpr bool reads_empty_shots = false);
struct Memory {};
using NextSlot = PulseIndex (&)(const Outcome&);
MISSPELT(SimulatesInOrder, changing, Memory workspace() const;
         void simulate_in_order(PulseIndex, PulseIndex, Memory&, NextSlot));
MISSPELT(SimulatesInOrder, result, Memory workspace() const;
         bool simulate_in_order(PulseIndex, PulseIndex, Memory&, NextSlot) const);
MISSPELT(IdentifiedSurvey, number, int identity() const noexcept);

// Models with members of their own, of names that are near those of optional members.
struct OwnOptic : LeastOptic {
  int lanes = 2;
  bool is_open(Tick) const noexcept { return false; }
  bool gate(Tick) const noexcept { return false; }
};
struct OwnSource : LeastSource<frame::Beam> {
  PulseIndex next_slot(PulseIndex i) const noexcept { return i + 5; }
  void set_leg(std::uint32_t) {}
};
struct OwnTrajectory : LeastTrajectory {
  bool is_valid() const { return false; }
  void check() {}
  bool verify() const { return false; }
  void normalise() {}
};
struct OwnFootprint : LeastFootprint {
  std::size_t records = 7, width = 3;
};
struct OwnShape : LeastGeometry {
  bool planar = true;
  bool is_consistent() const { return true; }
};
struct OwnMap : LeastRayTarget {
  bool misses(const RayCone&) const noexcept { return true; }
  bool sound() const { return false; }
};
struct OwnDetector : LeastDetector {
  bool listens = true, always_on = true;
  void configure(const Laser&) {}
  double sampling_interval() const { return 1; }
};
struct OwnSink : LeastSink {
  bool reads_misses() const { return false; }
};

template <bool value>
struct Constants : LeastGeometry, LeastFootprint, LeastDetector {
  static constexpr bool uniform_surface = value, deterministic = value, time_dependent = value, recorded = value,
                        rotates_per_pulse = value, runs_without_reflections = value, reads_velocity = value;
};

/// Instrument that reports each beam moved, and turned about a point beside it: by draws of two errors, which it
/// states.
struct Shaking {
  using refinements = refines<tag::MeasuresBeam, tag::StatesErrors>;
  double number = 0;                                  ///< tells instruments apart
  Scanner scanner{.pulse_rate = 1000, .pulses = 50};  ///< laser
  static constexpr double draws[] = {0.7, -1.3};

  std::array<PoseError<frame::Instrument>, 2> errors(PulseIndex i, Tick t) const noexcept {
    const double at = static_cast<double>(i) + number, x = std::sin(at), y = std::cos(at + 40 * t.seconds());
    return {PoseError<frame::Instrument>{1e-6 * Vec3{x, y, x * y}, {}, {}, ErrorScope::leg},
            {{}, 1e-7 * Vec3{y, 1, x}, Vec3{1 + x, 2, y}, ErrorScope::pulse}};
  }
  PulseIndex size() const noexcept { return scanner.size(); }
  Tick duration() const noexcept { return scanner.duration(); }
  std::vector<Emitter> emitters() const { return scanner.emitters(); }
  std::optional<Pulse<frame::Instrument>> pulse(PulseIndex i) const noexcept {
    const Pose<frame::Beam, frame::Instrument> aim{rotation_about({1, 2, 3}, static_cast<double>(i)), {0.1, 0.2, 0.3}};
    return Pulse<frame::Instrument>(aim, *scanner.pulse(i));
  }
  std::optional<Pose<frame::Beam, frame::Instrument>> measured(PulseIndex i, Tick t) const noexcept {
    const auto [move, turn] = errors(i, t);
    const auto truth = pulse(i)->pose;
    const Vec3 turned = draws[1] * turn.turned;
    const Rotation by = rotation_about(turned, length(turned));
    return Pose<frame::Beam, frame::Instrument>{
        by * truth.rotation, by * (truth.position - *turn.about) + *turn.about + draws[0] * move.moved};
  }
  void visit_errors(PulseIndex i, Tick t, const auto& visit) const noexcept {
    for (const auto& error : errors(i, t)) visit(error);
  }
};

/// Names a pulse whose misreported point is not the sum of the stated errors times their draws.
template <class Source>
std::string misstated(const Source& source) {
  static_assert(StatesErrors<Source>);
  for (PulseIndex i = 0; i < source.size(); ++i) {
    const auto p = source.pulse(i);
    const Vec3 ray{0, 20, 0}, point = p->pose.point(ray);
    Vec3 rest = p->reported->point(ray) - point;
    std::size_t k = 0;
    source.visit_errors(i, p->tick, [&](const PoseError<frame::World>& error) noexcept {
      if (k < 2 && error.scope == (k == 0 ? ErrorScope::leg : ErrorScope::pulse))
        rest -= Shaking::draws[k] * support::detail::displaced(error, *p, point);
      ++k;
    });
    if (k != 2 || !(length(rest) < 1e-10)) return "pulse " + std::to_string(i);
  }
  return {};
}

}  // namespace

TEST_CASE("members of near names are the user's own") {
  const OwnMap map;
  const Platform platform{OwnTrajectory{}, Mount{}, Deflector{OwnOptic{}, OwnSource{}}};
  const Survey survey{platform, OwnFootprint{}, map, Receiver{}, OwnDetector{}};
  const Scene<OwnShape> scene(std::vector<Scene<OwnShape>::Part>{});
  CHECK(run(survey, {}, OwnSink{}).pulses() == 10);
  CHECK(survey.sample_interval() == 0);
  CHECK(scene.misses_cone({}));
}

TEST_CASE("every stage passes on the errors that an instrument states, as it does its measured beam") {
  const auto on_tripod = [](auto source) {
    return Platform{Tripod{.position = {1, 2, 3}, .heading = 0.5},
                    Mount{.lever_arm = {0.3, 0.2, 0.1}, .boresight = rotation_about({3, 1, 2}, 1)}, source};
  };
  const Deflector turning{RotatingHead{.angular_rate = 30, .axis = {1, 1, 2}}, Shaking{}};
  CHECK(misstated(on_tripod(Shaking{})) == "");
  CHECK(misstated(on_tripod(turning)) == "");
  CHECK(misstated(on_tripod(Channels{std::vector{Shaking{1}, Shaking{2}, Shaking{3}}})) == "");
  CHECK(misstated(Legs{std::vector{on_tripod(Shaking{1}), on_tripod(Shaking{2})}}) == "");
  CHECK(misstated(WithPoseErrors{on_tripod(turning), PoseErrors{}}) == "");

  using Any = AnySource<Shaking, Deflector<RotatingHead, Shaking>>;
  static_assert(StatesErrors<Any>);
  const Channels channels{std::vector<Any>{Shaking{1}, turning}};
  CHECK(misstated(on_tripod(channels)) == "");
  const WithPoseErrors tripod{on_tripod(Deflector{RotatingHead{}, channels}), PoseErrors{}};
  const Legs legs{std::vector{tripod, tripod}};
  CHECK(misstated(legs) == "");
  CHECK(misstated(AnySource<std::decay_t<decltype(tripod)>, std::decay_t<decltype(legs)>>{legs}) == "");

  static_assert(!StatesErrors<decltype(on_tripod(Deflector{FixedBeam{}, Scanner{}}))>);
  using Exact = Deflector<FixedBeam, Scanner>;
  const AnySource<Shaking, Exact> exact{Exact{FixedBeam{}, Scanner{}}};
  exact.visit_errors(0, {}, [](const auto&) noexcept { CHECK_MESSAGE(false, "a source without errors states one"); });
}

TEST_CASE("every stage passes over blocked slots, and over no other") {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    CAPTURE(seed);
    Generator any(seed);
    const auto deflected = [&] {
      const double low = any.uniform(-pi / 3, pi / 3);
      return Deflector{
          RotatingHead{},
          Deflector{PolygonMirror{.sweep = pi / 3, .angle_min = low, .angle_max = any.uniform(low, pi / 2)},
                    Scanner{.pulses = 20'000}}};
    };
    using Mirror = decltype(deflected());
    using Fixed = Deflector<FixedBeam, Scanner>;
    std::vector<AnySource<Mirror, Fixed>> sources;
    for (std::uint64_t k = any.whole(4) + 1; k > 0; --k) sources.emplace_back(deflected());
    if (seed % 5 == 0) sources.emplace_back(Fixed{FixedBeam{}, Scanner{.pulses = 20'000}});
    const Channels channels{sources};
    CHECK(source_laws(channels) == "");
    const Legs legs{std::vector<Leg<decltype(WithPoseErrors{Platform{Tripod{}, Mount{}, channels}, PoseErrors{}})>>{
        {WithPoseErrors{Platform{Tripod{}, Mount{}, channels}, PoseErrors{}}},
        {WithPoseErrors{Platform{Tripod{}, Mount{}, channels}, PoseErrors{}}}}};
    CHECK(source_laws(legs) == "");
    PulseIndex pulses = 0, found = 0, visits = 0;
    for (PulseIndex i = 0; i < legs.size(); ++i) pulses += legs.pulse(i).has_value();
    for (PulseIndex i = 0; i < legs.size(); ++visits) {
      const bool open = legs.pulse(i++).has_value();
      found += open;
      if (!open && i < legs.size()) i = legs.next_pulse(i);
    }
    CHECK(found == pulses);
    CHECK(visits <
          2 * pulses +
              legs.size() / 50);  // of channels that open at different times, a blocked slot may follow each pulse
  }
}

TEST_CASE("a constant that is false is as one that is absent, and both pass the checks") {
#define CHECK_CONSTANT(Model)                                              \
  CHECK(Model<Constants<true>>);                                           \
  CHECK_FALSE(Model<Constants<false>>);                                    \
  CHECK_FALSE(Model<LeastGeometry>);                                       \
  CHECK(pulsecast::detail::members_checked<Constants<false>, tag::Model>); \
  CHECK(pulsecast::detail::members_checked<LeastGeometry, tag::Model>)
  CHECK_CONSTANT(UniformGeometry);
  CHECK_CONSTANT(DeterministicGeometry);
  CHECK_CONSTANT(TimeDependentGeometry);
  CHECK_CONSTANT(RecordsSubrays);
  CHECK_CONSTANT(RotatesPerPulse);
  CHECK_CONSTANT(RunsWithoutReflections);
  CHECK_CONSTANT(ReadsVelocity);
}
