// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/refinements.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
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
#include <pulsecast/scanner/any_source.hpp>
#include <pulsecast/scanner/channels.hpp>
#include <pulsecast/scanner/scanner.hpp>

#include <doctest/doctest.h>

#include "support/archetypes.hpp"
#include "support/generators.hpp"
#include "support/laws.hpp"

using namespace pulsecast;
using namespace pulsecast::support;

// Each optional member is refused under a near name, and in another form.
namespace {

#define MISSPELT(Model, name, ...) \
  struct Model##_by_##name {       \
    __VA_ARGS__;                   \
  };                               \
  static_assert(!pulsecast::detail::Model##OrAbsent<Model##_by_##name>, #name)

MISSPELT(Validating, check, void check() const);
MISSPELT(Validating, verify, void verify() const);
MISSPELT(Validating, is_valid, bool is_valid() const);
MISSPELT(Validating, validate_settings, void validate_settings() const);
MISSPELT(Validating, result, bool validate() const);
MISSPELT(Validating, changing, void validate());
MISSPELT(Validating, argument, void validate(int) const);
MISSPELT(ValidatesLaser, validate_laser, void validate_laser(const Laser&) const);
MISSPELT(ValidatesLaser, check, void check(const Laser&) const);
MISSPELT(ValidatesLaser, check_laser, void check_laser(Laser) const);
MISSPELT(ValidatesLaser, validate_for, void validate_for(const Laser&) const);
MISSPELT(ValidatesLaser, overload, void validate() const; bool validate(const Laser&) const);
MISSPELT(Normalizable, normalise, void normalise() noexcept);
MISSPELT(Normalizable, normalized, void normalized() const);
MISSPELT(Normalizable, normalised, void normalised() const);
MISSPELT(Normalizable, make_unit, void make_unit());
MISSPELT(Normalizable, throwing, void normalize());
MISSPELT(Normalizable, copying, Normalizable_by_throwing normalize() const noexcept);
MISSPELT(Gated, is_open, bool is_open(Tick) const noexcept);
MISSPELT(Gated, opened, bool opened(Tick) const noexcept);
MISSPELT(Gated, gate, bool gate(Tick) const noexcept);
MISSPELT(Gated, transmits, bool transmits(Tick) const noexcept);
MISSPELT(Gated, seconds, bool open(const Vec3&) const noexcept);
MISSPELT(Gated, number, int open(Tick) const noexcept);
MISSPELT(ForeseesOpening, next_opening, Tick next_opening(Tick) const noexcept);
MISSPELT(ForeseesOpening, opens_next, Tick opens_next(Tick) const noexcept);
MISSPELT(ForeseesOpening, opens_at, Tick opens_at(Tick) const noexcept);
MISSPELT(ForeseesOpening, open_after, Tick open_after(Tick) const noexcept);
MISSPELT(ForeseesOpening, seconds, double next_open(Tick) const noexcept);
using BeamLanes = PoseLanes<frame::Beam, frame::Instrument>;
#define POSES_AS(name)                                          \
  Pose<frame::Beam, frame::Instrument> at(Tick) const noexcept; \
  simd::Mask name(const TickLanes&, BeamLanes&) const noexcept
MISSPELT(MovesInLanes, at_lanes, POSES_AS(at_lanes));
MISSPELT(MovesInLanes, pose_lanes, POSES_AS(pose_lanes));
MISSPELT(MovesInLanes, lanes, POSES_AS(lanes));
MISSPELT(MovesInLanes, poses_at, POSES_AS(poses_at));
MISSPELT(MovesInLanes, tick, simd::Mask poses(Tick, BeamLanes&) const noexcept);
#define PULSES_AS(name)                                               \
  std::optional<Pulse<frame::Beam>> pulse(PulseIndex) const noexcept; \
  PulseLanes<frame::Beam> name(PulseIndex, std::size_t) const noexcept
MISSPELT(MakesLanes, pulses_in_lanes, PULSES_AS(pulses_in_lanes));
MISSPELT(MakesLanes, lanes, PULSES_AS(lanes));
MISSPELT(MakesLanes, pulses, PULSES_AS(pulses));
MISSPELT(MakesLanes, lanes_of, PULSES_AS(lanes_of));
MISSPELT(MakesLanes, throwing, std::optional<Pulse<frame::Beam>> pulse(PulseIndex) const noexcept;
         PulseLanes<frame::Beam> pulse_lanes(PulseIndex, std::size_t) const);
MISSPELT(FindsSlots, slot_at, PulseIndex slot_at(Tick) const noexcept);
MISSPELT(FindsSlots, slot_after, PulseIndex slot_after(Tick) const noexcept);
MISSPELT(FindsSlots, first_slot, PulseIndex first_slot(Tick) const noexcept);
MISSPELT(FindsSlots, slot_of, PulseIndex slot_of(Tick) const noexcept);
MISSPELT(FindsSlots, throwing, PulseIndex slot_from(Tick) const);
MISSPELT(SkipsBlocked, next_slot, PulseIndex next_slot(PulseIndex) const noexcept);
MISSPELT(SkipsBlocked, pulse_after, PulseIndex pulse_after(PulseIndex) const noexcept);
MISSPELT(SkipsBlocked, skip_blocked, PulseIndex skip_blocked(PulseIndex) const noexcept);
MISSPELT(SkipsBlocked, next_open, PulseIndex next_open(PulseIndex) const noexcept);
MISSPELT(SkipsBlocked, changing, PulseIndex next_pulse(PulseIndex) noexcept);
MISSPELT(DrawsByLeg, draw_leg, void draw_leg(std::uint32_t));
MISSPELT(DrawsByLeg, draw_by_leg, void draw_by_leg(std::uint32_t));
MISSPELT(DrawsByLeg, draw_of_leg, void draw_of_leg(std::uint32_t));
MISSPELT(DrawsByLeg, set_leg, void set_leg(std::uint32_t));
MISSPELT(DrawsByLeg, nothing, void draw_for_leg());
MISSPELT(PrefetchesPrimitives, soon, void soon(std::span<const PrimitiveIndex>) const noexcept);
MISSPELT(PrefetchesPrimitives, pre_fetch, void pre_fetch(std::span<const PrimitiveIndex>) const noexcept);
MISSPELT(PrefetchesPrimitives, prefetch_primitives,
         void prefetch_primitives(std::span<const PrimitiveIndex>) const noexcept);
MISSPELT(PrefetchesPrimitives, announce, void announce(std::span<const PrimitiveIndex>) const noexcept);
MISSPELT(PrefetchesPrimitives, index, void prefetch(const PrimitiveIndex*) const noexcept);
MISSPELT(UniformConstant, is_flat, static constexpr bool is_flat = true);
MISSPELT(UniformConstant, planar, static constexpr bool planar = true);
MISSPELT(UniformConstant, is_planar, bool is_planar = true);
MISSPELT(UniformConstant, flat_surface, static constexpr bool flat_surface = true);
MISSPELT(
    UniformConstant, function, static constexpr bool uniform_surface() { return true; });
MISSPELT(UniformConstant, variable, bool flat = true);
MISSPELT(RecordedConstant, is_recorded, static constexpr bool is_recorded = true);
MISSPELT(RecordedConstant, record, static constexpr bool record = true);
MISSPELT(RecordedConstant, records, static constexpr bool records = true);
MISSPELT(RecordedConstant, records_subrays, static constexpr bool records_subrays = true);
MISSPELT(RecordedConstant, member, const bool recorded = true);
MISSPELT(RotatesConstant, turned_per_pulse, static constexpr bool turned_per_pulse = true);
MISSPELT(RotatesConstant, turned_each_pulse, static constexpr bool turned_each_pulse = true);
MISSPELT(RotatesConstant, turns_by_pulse, static constexpr bool turns_by_pulse = true);
MISSPELT(RotatesConstant, turn_by_pulse, static constexpr bool turn_by_pulse = true);
MISSPELT(RotatesConstant, member, const bool rotates_per_pulse = true);
MISSPELT(SamplesWaveforms, sampling_interval, double sampling_interval() const noexcept);
MISSPELT(SamplesWaveforms, sample_spacing, double sample_spacing() const noexcept);
MISSPELT(SamplesWaveforms, sample_time, double sample_time() const noexcept);
MISSPELT(SamplesWaveforms, sampling_period, double sampling_period() const noexcept);
MISSPELT(SamplesWaveforms, data, double sample_interval = 1);
MISSPELT(PreparesForLasers, prepare_for, void prepare_for(const Laser&));
MISSPELT(PreparesForLasers, prepare_laser, void prepare_laser(const Laser&));
MISSPELT(PreparesForLasers, set_laser, void set_laser(const Laser&));
MISSPELT(PreparesForLasers, configure, void configure(const Laser&));
MISSPELT(PreparesForLasers, result, bool prepare(const Laser&));
MISSPELT(RunsWithoutReflectionsConstant, always_listens, static constexpr bool always_listens = true);
MISSPELT(RunsWithoutReflectionsConstant, listens, static constexpr bool listens = true);
MISSPELT(RunsWithoutReflectionsConstant, listen_always, static constexpr bool listen_always = true);
MISSPELT(RunsWithoutReflectionsConstant, always_on, bool always_on = true);
MISSPELT(RunsWithoutReflectionsConstant, number, static constexpr int runs_without_reflections = 1);
MISSPELT(VelocityConstant, needs_velocity, static constexpr bool needs_velocity = true);
MISSPELT(VelocityConstant, reads_velocities, static constexpr bool reads_velocities = true);
MISSPELT(VelocityConstant, uses_velocity, static constexpr bool uses_velocity = true);
MISSPELT(VelocityConstant, with_velocity, static constexpr bool with_velocity = true);
MISSPELT(VelocityConstant, variable, bool reads_velocity = true);
MISSPELT(MeasuresBeam, measured_beam,
         Pose<frame::Beam, frame::Instrument> measured_beam(PulseIndex, Tick) const noexcept);
MISSPELT(MeasuresBeam, measured_pose,
         Pose<frame::Beam, frame::Instrument> measured_pose(PulseIndex, Tick) const noexcept);
MISSPELT(MeasuresBeam, reported, Pose<frame::Beam, frame::Instrument> reported(PulseIndex, Tick) const noexcept);
MISSPELT(MeasuresBeam, reported_beam,
         Pose<frame::Beam, frame::Instrument> reported_beam(PulseIndex, Tick) const noexcept);
MISSPELT(MeasuresBeam, always, Pose<frame::Beam, frame::Instrument> measured(PulseIndex, Tick) const noexcept);
MISSPELT(MomentWidthMeasure, moment_width, double moment_width(const WaveformMoments&) const noexcept);
MISSPELT(MomentWidthMeasure, width_by_moments, double width_by_moments(const WaveformMoments&) const noexcept);
MISSPELT(MomentWidthMeasure, width_from_moments, double width_from_moments(const WaveformMoments&) const noexcept);
MISSPELT(MomentWidthMeasure, width_of_moments, double width_of_moments(const WaveformMoments&) const noexcept);
MISSPELT(MomentWidthMeasure, single, float width(const WaveformMoments&) const noexcept);
MISSPELT(TruncatedWidthMeasure, share_min, double share_min() const noexcept);
MISSPELT(TruncatedWidthMeasure, share_min, double share_min() const noexcept);
MISSPELT(TruncatedWidthMeasure, minimum_share, double minimum_share() const noexcept);
MISSPELT(TruncatedWidthMeasure, min_fraction, double min_fraction() const noexcept);
MISSPELT(TruncatedWidthMeasure, throwing, double min_share() const);
MISSPELT(ConsistencyChecking, sound, bool sound() const);
MISSPELT(ConsistencyChecking, consistent, bool consistent() const);
MISSPELT(ConsistencyChecking, check_consistency, void check_consistency() const);
MISSPELT(ConsistencyChecking, is_valid, bool is_valid() const);
MISSPELT(ConsistencyChecking, changing, bool is_consistent());
MISSPELT(SelfCheckingAccelerator, sound, bool sound(std::size_t) const);
MISSPELT(SelfCheckingAccelerator, consistent, bool consistent(std::size_t) const);
MISSPELT(SelfCheckingAccelerator, check_consistency, bool check_consistency(std::size_t) const);
MISSPELT(SelfCheckingAccelerator, is_valid, bool is_valid(std::size_t) const);
MISSPELT(SelfCheckingAccelerator, nothing, bool is_consistent() const);
MISSPELT(MissesCones, misses, bool misses(const RayCone&) const noexcept);
MISSPELT(MissesCones, miss_cone, bool miss_cone(const RayCone&) const noexcept);
MISSPELT(MissesCones, cone_misses, bool cone_misses(RayCone) const noexcept);
MISSPELT(MissesCones, misses_all, bool misses_all(const RayCone&) const noexcept);
MISSPELT(MissesCones, throwing, bool misses_cone(const RayCone&) const);
MISSPELT(ChoosesShots, reads_empty, bool reads_empty() const noexcept);
MISSPELT(ChoosesShots, reads_misses, bool reads_misses() const noexcept);
MISSPELT(TimeDependentConstant, is_timed, static constexpr bool is_timed = true);
MISSPELT(TimeDependentConstant, timed_hits, static constexpr bool timed_hits = true);
MISSPELT(TimeDependentConstant, time_dependent, static constexpr bool time_dependent = true);
MISSPELT(TimeDependentConstant, number, static constexpr int timed = 1);
MISSPELT(ChoosesShots, wants_empty_shots, bool wants_empty_shots() const noexcept);
MISSPELT(ChoosesShots, wants_misses, bool wants_misses() const noexcept);
MISSPELT(ChoosesShots, constant, static constexpr bool reads_empty_shots = true);
struct Memory {};
using NextSlot = PulseIndex (&)(const Outcome&);
MISSPELT(SimulatesInOrder, simulates_in_order, Memory workspace() const;
         void simulates_in_order(PulseIndex, PulseIndex, Memory&, NextSlot) const);
MISSPELT(SimulatesInOrder, simulate_slots, Memory workspace() const;
         void simulate_slots(PulseIndex, PulseIndex, Memory&, NextSlot) const);
MISSPELT(SimulatesInOrder, simulate_all, Memory workspace() const;
         void simulate_all(PulseIndex, PulseIndex, Memory&, NextSlot) const);
MISSPELT(SimulatesInOrder, outcomes_in_order, Memory workspace() const;
         void outcomes_in_order(PulseIndex, PulseIndex, Memory&, NextSlot) const);
MISSPELT(SimulatesInOrder, changing, Memory workspace() const;
         void simulate_in_order(PulseIndex, PulseIndex, Memory&, NextSlot));
MISSPELT(SimulatesInOrder, result, Memory workspace() const;
         bool simulate_in_order(PulseIndex, PulseIndex, Memory&, NextSlot) const);
MISSPELT(IdentifiedSurvey, get_identity, std::shared_ptr<const void> get_identity() const noexcept);
MISSPELT(IdentifiedSurvey, identify, std::shared_ptr<const void> identify() const noexcept);
MISSPELT(IdentifiedSurvey, identifier, std::uint64_t identifier() const noexcept);
MISSPELT(IdentifiedSurvey, workspace_identity, std::shared_ptr<const void> workspace_identity() const noexcept);
MISSPELT(IdentifiedSurvey, number, int identity() const noexcept);

template <bool value>
struct Shape : LeastGeometry {
  static constexpr bool uniform_surface = value;
};
template <bool value>
struct Pattern : LeastFootprint {
  static constexpr bool recorded = value;
};
template <bool value>
struct Listener : LeastDetector {
  static constexpr bool runs_without_reflections = value;
};
template <bool value>
struct Speedometer : LeastDetector {
  static constexpr bool reads_velocity = value;
};

}  // namespace

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
  CHECK(UniformGeometry<Shape<true>>);
  CHECK_FALSE(UniformGeometry<Shape<false>>);
  CHECK_FALSE(UniformGeometry<LeastGeometry>);
  CHECK_FALSE(DeterministicGeometry<LeastGeometry>);
  CHECK(RecordsSubrays<Pattern<true>>);
  CHECK_FALSE(RecordsSubrays<Pattern<false>>);
  CHECK_FALSE(RecordsSubrays<LeastFootprint>);
  CHECK(RunsWithoutReflections<Listener<true>>);
  CHECK_FALSE(RunsWithoutReflections<Listener<false>>);
  CHECK_FALSE(RunsWithoutReflections<LeastDetector>);
  CHECK(ReadsVelocity<Speedometer<true>>);
  CHECK_FALSE(ReadsVelocity<Speedometer<false>>);
  CHECK_FALSE(ReadsVelocity<LeastDetector>);
  CHECK(pulsecast::detail::UniformConstantCheck<Shape<false>>::passed);
  CHECK(pulsecast::detail::UniformConstantCheck<LeastGeometry>::passed);
  CHECK(pulsecast::detail::RecordedConstantCheck<Pattern<false>>::passed);
  CHECK(pulsecast::detail::RecordedConstantCheck<LeastFootprint>::passed);
  CHECK(pulsecast::detail::RunsWithoutReflectionsConstantCheck<Listener<false>>::passed);
  CHECK(pulsecast::detail::RunsWithoutReflectionsConstantCheck<LeastDetector>::passed);
  CHECK(pulsecast::detail::VelocityConstantCheck<Speedometer<false>>::passed);
  CHECK(pulsecast::detail::VelocityConstantCheck<LeastDetector>::passed);
}
