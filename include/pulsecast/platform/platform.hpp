// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_PLATFORM_PLATFORM_HPP
#define PULSECAST_PLATFORM_PLATFORM_HPP

#include <pulsecast/base/unit_rotation.hpp>
#include <pulsecast/pulse_lanes.hpp>
#include <pulsecast/stage_arguments.hpp>

namespace PULSECAST_NAMESPACE {

/// Mounting of an instrument on its platform.
struct Mount {
  Vec3 lever_arm{};                  ///< position of the instrument's origin in the body frame [m]
  Rotation boresight = no_rotation;  ///< from the instrument to the body; unit to 1e-3

  void validate() const {
    require_finite("Mount::lever_arm (length)", length(lever_arm), "m");
    require_rotation("Mount::boresight", boresight);
  }
  void normalize() noexcept { boresight = unit(boresight); }

  /// Pose of the instrument in the body frame.
  [[nodiscard]] Pose<frame::Instrument, frame::Body> pose() const noexcept { return {boresight, lever_arm}; }
};

/// Pulse source of an instrument carried through the world. The lever arm turns with the body.
template <Trajectory Path, InstrumentSource Source>
class Platform {
 public:
  using refinements = refines<tag::MakesLanes>;
  static constexpr bool strides_lanes = detail::MakesStridedLanes<Source>;
  /// @throws SettingError for settings out of range
  Platform(Path path, Mount mount, Source source)
      : path_(validated(std::move(path))), mount_(validated(mount)), source_(validated(std::move(source))) {}

  [[nodiscard]] PulseIndex size() const noexcept { return source_.size(); }
  [[nodiscard]] Tick duration() const noexcept { return source_.duration(); }
  [[nodiscard]] std::vector<Emitter> emitters() const { return source_.emitters(); }

  [[nodiscard]] std::optional<Pulse<frame::World>> pulse(PulseIndex i) const noexcept { return pulse_lanes(i, 1)[0]; }

  [[nodiscard]] PulseLanes<frame::World> pulse_lanes(PulseIndex i, std::size_t count,
                                                     PulseIndex step = 1) const noexcept {
    const auto inner = find_pulses(source_, i, count, step);
    auto out = placed(inner);
    if constexpr (MeasuresBeam<Source>)
      for (std::size_t lane = 0; lane < inner.size; ++lane)
        if (inner.sent[lane] != 0)
          if (const auto beam = source_.measured(i + lane * step, inner.tick[lane]))
            out.report(lane, instrument_at(inner.tick[lane]) * *beam);
    return out;
  }

  [[nodiscard]] PulseIndex slot_from(Tick t) const noexcept requires FindsSlots<Source> { return source_.slot_from(t); }
  [[nodiscard]] PulseIndex next_pulse(PulseIndex i) const noexcept requires SkipsBlocked<Source> {
    return source_.next_pulse(i);
  }

  /// Errors of the instrument, as the concept StatesErrors requires.
  template <class Visit>
  void visit_errors(PulseIndex i, Tick t, const Visit& visit) const noexcept requires StatesErrors<Source> {
    source_.visit_errors(i, t, [&, placed = instrument_at(t)](const PoseError<frame::Instrument>& error) noexcept {
      visit(placed * error);
    });
  }

  /// Pulses of the instrument, transformed into the world.
  [[nodiscard]] PulseLanes<frame::World> placed(const PulseLanes<frame::Instrument>& inner) const noexcept {
    PoseLanes<frame::Body, frame::World> world_from_body;
    [[maybe_unused]] const simd::Mask moved = find_poses(path_, inner.tick, inner.sent, world_from_body);
    PULSECAST_ASSERT(rigid_lanes(world_from_body, moved));
    PulseLanes<frame::World> out(world_from_body * PoseLanes(mount_.pose()), inner);
    const Vec3Lanes beam = out.pose.rotation * Vec3Lanes(axis::forward);
    const Vec3Lanes ahead = world_from_body.rotation * Vec3Lanes(axis::forward);
    // components to the right of the heading and down, by the length of the heading on the map
    const simd::Doubles right = beam.x * ahead.y - beam.y * ahead.x;
    const simd::Doubles on_map = simd::sqrt(ahead.x * ahead.x + ahead.y * ahead.y);
    for (std::size_t lane = 0; lane < simd::lane_count; ++lane)
      out.scan_angle[lane] = {right[lane], -beam.z[lane] * on_map[lane]};
    return out;
  }

  /// Pose of the instrument in the world.
  [[nodiscard]] Pose<frame::Instrument, frame::World> instrument_at(Tick t) const noexcept {
    const Pose<frame::Body, frame::World> world_from_body = path_.at(t);
    PULSECAST_ASSERT(world_from_body.rigid() || !world_from_body.finite());  // a run reports NaN
    return world_from_body * mount_.pose();
  }

  [[nodiscard]] const Path& trajectory() const noexcept { return path_; }  ///< of the body
  [[nodiscard]] const Mount& mount() const noexcept { return mount_; }     ///< of the instrument
  [[nodiscard]] const Source& source() const noexcept { return source_; }  ///< of its pulses

 private:
  Path path_;
  Mount mount_;
  Source source_;
};

/// Names the mistake in the arguments.
template <class Path, class Source>
Platform(Path, Source) -> Platform<typename detail::PlatformArguments<Path, Source, false>::First, Source>;
/// As above.
template <class Path, class Source, class Second = Mount>
requires(!Trajectory<Path> || !std::convertible_to<Second, Mount> || !InstrumentSource<Source>)
    Platform(Path, Second, Source)
->Platform<typename detail::PlatformArguments<Path, Source, std::convertible_to<Second, Mount>>::First, Source>;

}  // namespace PULSECAST_NAMESPACE

#endif
