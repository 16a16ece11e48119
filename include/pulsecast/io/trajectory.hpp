// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_TRAJECTORY_HPP
#define PULSECAST_IO_TRAJECTORY_HPP

#include <pulsecast/io/detail/text/output.hpp>
#include <pulsecast/io/detail/trajectory/table.hpp>

namespace PULSECAST_NAMESPACE::io {

using TrajectoryFileSettings = TextFileSettings;  ///< settings of a trajectory file, which has no waveforms

/// Calls `record` with record times of a leg: multiples of `interval` [s] from 0, and `duration`.
void for_each_record(const Tick& duration, double interval, const auto& record) {
  const double end = duration.seconds();
  constexpr double least = 0.5e-9;  // records this close have the same time in the file [s]
  for (std::uint64_t i = 0; end - static_cast<double>(i) * interval > least; ++i)
    record(Tick::of_seconds(static_cast<double>(i) * interval));
  record(duration);
}

/// Poses of a trajectory at ticks, as ground truth for `write_trajectory` and `write_kitti_poses`.
[[nodiscard]] std::vector<TimedPose> timed_poses(const Trajectory auto& trajectory, std::span<const Tick> ticks) {
  std::vector<TimedPose> poses;
  for (const Tick& tick : ticks) {
    const Pose<frame::Body, frame::World> pose = trajectory.at(tick);
    poses.push_back({tick.seconds(), pose.position, pose.rotation});
  }
  return poses;
}

/// Writes poses of a platform as text, one a line, with these columns and a blank between them:
///
///     x y z gpsTime roll pitch yaw
///
/// x, y, z [m] and the angles [deg, as `helios_canonical`] have 4 decimals, gpsTime [s] has 9; yaw
/// is in [0, 360). There is no header line. HELIOS++ writes these columns, too;
/// `helios_output_format` reads them. Only `close()` completes the file: see `OutputFile`.
class TrajectoryWriter {
 public:
  /// Opens the file. @throws SettingError for settings out of range @throws FileError
  explicit TrajectoryWriter(std::filesystem::path path, const TrajectoryFileSettings& settings = {})
      : settings_(validated(settings)), file_(std::move(path)) {}

  /// Adds one record; `tick` in the survey's time. Throws a `FileError` unless the pose is finite.
  void add(Tick tick, const Pose<frame::Body, frame::World>& pose) {
    if (!finite(pose.position) || !std::isfinite(length(pose.rotation))) {
      file_.discard();
      throw FileError(file_.path().string(), "line " + std::to_string(records_ + 1),
                      "cannot be written: expected a finite pose");
    }
    const RollPitchYaw angles = roll_pitch_yaw(pose.rotation, helios_canonical);
    const double yaw_deg = degrees(angles.yaw < 0 ? angles.yaw + 2 * pi : angles.yaw);
    const Vec3 p = pose.position;
    row_.add(p.x, 4).add(p.y, 4).add(p.z, 4).add(settings_.start_time + tick.seconds(), 9);
    row_.add(degrees(angles.roll), 4).add(degrees(angles.pitch), 4);
    row_.add(yaw_deg < 359.99995 ? yaw_deg : 0, 4);  // not 360.0000
    file_.write(row_.end());
    ++records_;
  }

  /// Adds a leg that begins at `start` in the survey's time, sampled at multiples of `interval` [s]
  /// from its start, and at `duration`. @throws SettingError unless `interval` is positive
  void add(const Trajectory auto& trajectory, Tick start, Tick duration, double interval) {
    require_positive("TrajectoryWriter::add interval", interval, "s");
    for_each_record(duration, interval, [&](const Tick& tick) { add(start + tick, trajectory.at(tick)); });
  }

  void close() { file_.commit(); }

 private:
  TrajectoryFileSettings settings_;
  OutputFile file_;
  TextRow row_;
  std::uint64_t records_ = 0;
};

namespace detail {

/// Header lines with the names of the columns.
[[nodiscard]] inline std::string head_of(const TrajectoryFormat& format, const TrajectoryColumns& columns) {
  if (format.names == ColumnNames::nowhere) return {};
  const bool in_comments = format.names == ColumnNames::comments;
  std::string time, names;
  for (std::size_t i = 0, place = 0; i < format.columns.size(); ++i) {
    const std::optional<TrajectoryColumn>& column = columns.all()[i];
    if (!column) continue;
    if (column->quantity == Quantity::time) time = std::to_string(place);
    if (place++ > 0) names += in_comments ? ", " : std::string(1, format.separator);
    names += in_comments ? '"' + format.columns[i] + '"' : format.columns[i];
  }
  return in_comments ? "#TIME_COLUMN: " + time + "\n#HEADER: " + names + '\n' : names + '\n';
}

/// Values of a pose in a format.
[[nodiscard]] inline QuantityValues values_of(const TimedPose& pose, const TrajectoryFormat& format,
                                              double start_time) {
  const Vec3 p = pose.position, in_file = format.axes.swapped(p);
  const Rotation q = format.axes.to_file(pose.rotation);
  const RollPitchYaw angles = roll_pitch_yaw(pose.rotation, format.angles);
  const double turn = angles.yaw < 0 ? angles.yaw + 2 * pi : angles.yaw;
  const double yaw = turn < 2 * pi ? turn : 0;
  return {{start_time + pose.time, in_file.x, in_file.y, in_file.z, p.x, p.y, p.z, -p.z, angles.roll, angles.pitch, yaw,
           q.x, q.y, q.z, q.w}};  // in the order of `Quantity`
}

}  // namespace detail

/// Writes a trajectory for `read_trajectory`, in all digits, yaw in [0, 2 pi). Poses are in order of time, a jump's
/// time twice; `start_time` [s] is added. @throws SettingError @throws FileError for unordered, too large or non-unit
/// poses
inline void write_trajectory(const std::filesystem::path& path, std::span<const TimedPose> poses,
                             const TrajectoryFormat& format = csv_format(), double start_time = 0) {
  format.validate();
  require_finite("write_trajectory start_time", start_time, "s");
  const TrajectoryColumns columns(format.columns, format.left_out, format.angle_unit);
  if (poses.empty()) detail::fail(path, "cannot be written: expected at least one pose");
  if (columns.has(Quantity::longitude)) detail::fail(path, "cannot be written in degrees: expected columns of metres");
  OutputFile file(path);
  file.write(detail::head_of(format, columns));
  TextRow row(format.separator);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const TimedPose pose{poses[i].time, poses[i].position, unit(poses[i].rotation)};
    const double time = start_time + pose.time;
    constexpr double largest = detail::max_in_trajectory;
    const bool in_order = i == 0 || time > start_time + poses[i - 1].time || pose.time == poses[i - 1].time;
    if (!(std::fabs(time) <= largest) || !is_within(pose.position, largest) ||
        !(std::fabs(length(poses[i].rotation) - 1) <= 1e-3) || !in_order)
      detail::fail(path, "pose ", i,
                   " cannot be written: expected finite numbers within 1e12, a unit rotation and a time not "
                   "before the last one's");
    const QuantityValues values = detail::values_of(pose, format, start_time);
    for (const std::optional<TrajectoryColumn>& column : columns.all())
      if (column) row.add(values[column->quantity] * column->per_si);
    file.write(row.end());
  }
  file.commit();
}

}  // namespace PULSECAST_NAMESPACE::io

#endif
