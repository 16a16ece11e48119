// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>

#include <pulsecast/adapters/output_file.hpp>
#include <pulsecast/adapters/text_row.hpp>
#include <pulsecast/base/units.hpp>
#include <pulsecast/concepts.hpp>

namespace pulsecast::adapters {

/// A rotation as three turns: first about z by `yaw`, then about the fixed y by `pitch`, then about the fixed x by `roll`. With yaw alone
/// it is the heading, counter-clockwise from +y. Where |pitch| is 90 degrees only roll +- yaw is defined; roll is then 0.
struct RollPitchYaw {
  double roll = 0;   ///< about x, in [-pi, pi] [rad]
  double pitch = 0;  ///< about y, in [-pi/2, pi/2] [rad]
  double yaw = 0;    ///< about z, in [-pi, pi] [rad]
};

/// Source: the entries of the product Rx(roll) Ry(pitch) Rz(yaw), whose last column is (sin p, -sin r cos p, cos r cos p) and whose first
/// row is (cos p cos y, -cos p sin y, sin p); with r = 0 its second row is (sin y, cos y, 0).
[[nodiscard]] inline RollPitchYaw roll_pitch_yaw(const Rotation& rotation) noexcept {
  const Vec3 column = rotation * up;
  const Vec3 row = conjugate(rotation) * right;
  const double cos_pitch = std::hypot(row.x, row.y);
  const double pitch = std::atan2(row.z, cos_pitch);
  if (cos_pitch < 1e-8) {  // less than this and rounding, 1e-16, would turn roll and yaw by more than leaving the rest out does
    const Vec3 second_row = conjugate(rotation) * forward;
    return {0, pitch, std::atan2(second_row.x, second_row.y)};
  }
  return {std::atan2(-column.y, column.z), pitch, std::atan2(-row.y, row.x)};
}

struct TrajectoryFileSettings {
  double start_time = 0;  ///< what the clock shows at tick 0 [s]

  void validate() const { expect_finite("TrajectoryFileSettings::start_time", start_time, "s"); }
};

/// Writes where a platform was and how it was turned as text, one record a line, with these columns and a blank between them:
///
///     x y z gpsTime roll pitch yaw
///
/// x, y, z [m] and the angles of `RollPitchYaw` [deg] have 4 decimals, gpsTime [s] has 9; yaw is in [0, 360). There is no head line.
/// These are the columns of HELIOS++ trajectory files. Only `close()` makes the file: see `OutputFile`.
class TrajectoryWriter {
 public:
  explicit TrajectoryWriter(std::filesystem::path path, const TrajectoryFileSettings& settings = {})
      : settings_(validated(settings)), file_(std::move(path)) {}

  /// One record; `tick` is in the survey's time.
  void add(Tick tick, const Pose<frame::Body, frame::World>& pose) {
    if (!finite(pose.position) || !std::isfinite(length(pose.rotation))) {
      file_.discard();
      throw FileError(file_.path().string(), "line " + std::to_string(records_ + 1), "cannot be written: expected a finite pose");
    }
    const RollPitchYaw angles = roll_pitch_yaw(pose.rotation);
    const double yaw_deg = degrees(angles.yaw < 0 ? angles.yaw + 2 * pi : angles.yaw);
    row_.add(pose.position.x, 4).add(pose.position.y, 4).add(pose.position.z, 4).add(settings_.start_time + tick.seconds(), 9);
    row_.add(degrees(angles.roll), 4).add(degrees(angles.pitch), 4).add(yaw_deg < 359.99995 ? yaw_deg : 0, 4);  // not 360.0000
    file_.write(row_.end());
    ++records_;
  }

  /// A leg that begins at `start` in the survey's time. The trajectory is asked in its own time: at 0, `interval` [s], twice the interval
  /// and so on, and at the end, `duration`.
  void add(const Trajectory auto& trajectory, Tick start, Tick duration, double interval) {
    expect_positive("TrajectoryWriter::add interval", interval, "s");
    const double end = duration.seconds();
    constexpr double least = 0.5e-9;  // records that would show the same time are one [s]
    for (std::uint64_t i = 0; end - static_cast<double>(i) * interval > least; ++i) {
      const Tick tick = Tick::of_seconds(static_cast<double>(i) * interval);
      add(start + tick, trajectory.at(tick));
    }
    add(start + duration, trajectory.at(duration));
  }

  void close() { file_.commit(); }

 private:
  TrajectoryFileSettings settings_;
  OutputFile file_;
  TextRow row_;
  std::uint64_t records_ = 0;
};

}  // namespace pulsecast::adapters
