// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_XML_LEG_HPP
#define PULSECAST_HELIOS_DETAIL_XML_LEG_HPP

#include <array>
#include <cstddef>
#include <string>
#include <utility>

#include <pulsecast/helios/detail/xml/element.hpp>
#include <pulsecast/helios/detail/xml/fields.hpp>
#include <pulsecast/helios/settings.hpp>

/// `<platformSettings>` and `<scannerSettings>` of a leg, and the offsets of all.
namespace PULSECAST_NAMESPACE::helios::xml {

template <class Io>
void fields(Io& io, Of<Io, LegOffsetSettings>& offset) {
  io.number("legRandomOffsetMean", offset.mean, units::metre, -1e6, 1e6);
  io.number("legRandomOffsetStdev", offset.deviation, units::metre, 0, 1e6);
}

template <class Io>
void fields(Io& io, Of<Io, TrajectorySettings>& trajectory) {
  static constexpr std::array names{"tIndex", "rollIndex", "pitchIndex", "yawIndex", "xIndex", "yIndex", "zIndex"};
  io.file("trajectory", trajectory.file);
  if constexpr (Io::reads) {
    for (const char* name : {"trajectory_separator", "trajectory_seperator"}) {
      const auto text = io.given(name);
      const bool is_one =
          text && text->size() == 1 && std::string_view(",;\t ").find(text->front()) != std::string_view::npos;
      if (is_one) trajectory.separator = text->front();
      if (text && !is_one)
        io.warn(name, XmlInput::said(name, *text) +
                          " has no effect: expected a comma, a semicolon, a tab or a blank; it is detected");
    }
    for (const char* name : names)
      if (io.has(name) && !trajectory.columns) trajectory.columns.emplace();
  } else if (trajectory.separator) {
    io.text("trajectory_separator", std::string(1, *trajectory.separator));
  }
  TrajectoryIndices c = trajectory.columns.value_or(TrajectoryIndices{});
  std::size_t i = 0;
  for (int* index : {&c.time, &c.roll, &c.pitch, &c.yaw, &c.x, &c.y, &c.z}) {
    if (Io::reads || trajectory.columns) io.whole(names[i], *index, 0, 999);
    ++i;
  }
  if constexpr (Io::reads)
    if (trajectory.columns) trajectory.columns = c;
  io.choice("interpolationDomain", trajectory.position_only, {{"position_and_attitude", false}, {"position", true}});
  io.flag("toRadians", trajectory.angles_in_degrees);
  io.flag("syncGPSTime", trajectory.sync_clock);
  io.flag("teleportToStart", trajectory.teleports);
  if constexpr (Io::reads) {
    double slope = 0;
    io.number("slopeFilterThreshold", slope, units::one, 0, 1e9);
    if (slope > 0) io.warn("slopeFilterThreshold", "slopeFilterThreshold has no effect: all samples are kept");
  }
  io.number("tStart", trajectory.start, units::second, -1e12, 1e12);
  io.number("tEnd", trajectory.end, units::second, -1e12, 1e12);
  if (trajectory.start && trajectory.end && !(*trajectory.start < *trajectory.end))
    io.fault("tEnd", "tEnd is not after tStart");
}

template <class Io>
void fields(Io& io, Of<Io, LegPlatformSettings>& platform) {
  components(io, platform.position);
  io.flag("onGround", platform.on_ground);
  io.number("movePerSec_m", platform.speed, units::metre_per_second, 0, 1e5);
  if constexpr (Io::reads) {
    bool smooth = platform.smooth_turn, stops = true, slows = true;
    io.flag("smoothTurn", smooth);
    io.flag("stopAndTurn", stops);
    io.flag("slowdownEnabled", slows);
    platform.smooth_turn = smooth || !stops;
    if (!slows)
      io.warn("slowdownEnabled",
              "slowdownEnabled of false has no effect: a multicopter slows down as it must to turn and to stop");
  } else {
    io.flag("smoothTurn", platform.smooth_turn);
  }
  io.number("yawAtDeparture_deg", platform.yaw_at_departure, units::degree, -3600, 3600);
  if constexpr (Io::reads) {
    const TrajectorySettings before = platform.trajectory.value_or(TrajectorySettings{});
    TrajectorySettings trajectory = before;
    fields(io, trajectory);
    if (trajectory != before || io.has("trajectory")) platform.trajectory = std::move(trajectory);
  } else if (platform.trajectory) {
    fields(io, *platform.trajectory);
  }
}

template <class Io>
void fields(Io& io, Of<Io, LegScannerSettings>& scanner) {
  io.flag("active", scanner.active);
  io.number("pulseFreq_hz", scanner.pulse_rate, units::hertz, 0, 1e8);
  io.number("scanFreq_hz", scanner.scan_rate, units::hertz, 0, 1e6);
  io.number("scanAngle_deg", scanner.scan_angle, units::degree, 0, 180);
  io.number("verticalAngleMin_deg", scanner.vertical_angle_min, units::degree, -360, 360);
  io.number("verticalAngleMax_deg", scanner.vertical_angle_max, units::degree, -360, 360);
  io.number("headRotatePerSec_deg", scanner.head_rate, units::degree, -1e6, 1e6);
  io.number("headRotateStart_deg", scanner.head_start, units::degree, -1e8, 1e8);
  io.number("headRotateStop_deg", scanner.head_stop, units::degree, -1e8, 1e8);
  io.number("beamDivergence_rad", scanner.divergence, units::radian, 1e-9, 0.5);
  io.number("trajectoryTimeInterval_s", scanner.trajectory_interval, units::second, 0, 1e9);
  io.number("opticsWarmupPhase_s", scanner.warm_up, units::second, 0, 1e5);
}

}  // namespace PULSECAST_NAMESPACE::helios::xml

#endif
