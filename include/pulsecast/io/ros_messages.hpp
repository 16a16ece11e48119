// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_ROS_MESSAGES_HPP
#define PULSECAST_IO_ROS_MESSAGES_HPP

#include <pulsecast/io/detail/ros/description.hpp>
#include <pulsecast/io/point_records.hpp>
#include <pulsecast/sensor/imu.hpp>

/// Messages of ROS 2, without ROS, for `serialize(message, bytes)`. Their texts and sequences belong to the caller,
/// and must live until then. Source of the definitions: ROS 2 packages builtin_interfaces, std_msgs, geometry_msgs,
/// nav_msgs, rosgraph_msgs, sensor_msgs, tf2_msgs; livox_ros_driver2.
namespace PULSECAST_NAMESPACE::io::ros {

/// Clock time at a tick, to the nearest nanosecond; `start_time` is that at tick 0 [s].
/// @throws SettingError for a time that ROS does not hold: before 0 s or after 2^31 - 1 s
[[nodiscard]] inline std::uint64_t stamp_ns(double start_time, const Tick& tick,
                                            std::string_view what = "start_time + tick") {
  require_within(what, start_time + tick.seconds(), 0, 2'147'483'647, "s");
  const Tick stamp = Tick::of_seconds(start_time) + tick;
  const long long rest = std::llround(stamp.fraction * 1e9);
  return static_cast<std::uint64_t>(stamp.second * 1'000'000'000 + rest);
}

/// Point in time.
struct Time {
  std::int32_t sec = 0;       ///< whole seconds [s]
  std::uint32_t nanosec = 0;  ///< rest [ns]
  PULSECAST_ROS_MESSAGE("builtin_interfaces/msg/Time", sec, nanosec)

  /// Time of a stamp [ns].
  [[nodiscard]] static Time of(std::uint64_t stamp_ns) noexcept {
    return {static_cast<std::int32_t>(stamp_ns / 1'000'000'000), static_cast<std::uint32_t>(stamp_ns % 1'000'000'000)};
  }
};

/// Time and frame of a message.
struct Header {
  Time stamp{};                 ///< time of the data
  std::string_view frame_id{};  ///< frame of the data
  PULSECAST_ROS_MESSAGE("std_msgs/msg/Header", stamp, frame_id)
};

/// Time of the simulation.
struct Clock {
  Time clock{};  ///< time
  PULSECAST_ROS_MESSAGE("rosgraph_msgs/msg/Clock", clock)
};

/// Translation, velocity or rate.
struct Vector3 {
  double x = 0, y = 0, z = 0;  ///< components
  PULSECAST_ROS_MESSAGE("geometry_msgs/msg/Vector3", x, y, z)
};

/// Position.
struct Point {
  double x = 0, y = 0, z = 0;  ///< coordinates [m]
  PULSECAST_ROS_MESSAGE("geometry_msgs/msg/Point", x, y, z)
};

/// Unit quaternion.
struct Quaternion {
  double x = 0, y = 0, z = 0, w = 1;  ///< w is the real part
  PULSECAST_ROS_MESSAGE("geometry_msgs/msg/Quaternion", x, y, z, w)
};

/// Pose of a frame in another one.
struct Transform {
  Vector3 translation{};  ///< origin of the frame [m]
  Quaternion rotation{};  ///< from the frame to the other one
  PULSECAST_ROS_MESSAGE("geometry_msgs/msg/Transform", translation, rotation)
};

/// Pose of the child in the frame of the header.
struct TransformStamped {
  Header header{};                    ///< time, and the parent frame
  std::string_view child_frame_id{};  ///< frame that has the pose
  Transform transform{};              ///< its pose
  PULSECAST_ROS_MESSAGE("geometry_msgs/msg/TransformStamped", header, child_frame_id, transform)
};

/// Poses of frames, as on `/tf` and `/tf_static`.
struct TFMessage {
  std::span<const TransformStamped> transforms{};  ///< poses
  PULSECAST_ROS_MESSAGE("tf2_msgs/msg/TFMessage", transforms)
};

/// Position and attitude.
struct Pose {
  Point position{};          ///< position [m]
  Quaternion orientation{};  ///< attitude
  PULSECAST_ROS_MESSAGE("geometry_msgs/msg/Pose", position, orientation)
};

/// Pose and its uncertainty.
struct PoseWithCovariance {
  Pose pose{};                          ///< pose
  std::array<double, 36> covariance{};  ///< of x, y, z and rotations about these; 0 as of a truth [m2, m rad, rad2]
  PULSECAST_ROS_MESSAGE("geometry_msgs/msg/PoseWithCovariance", pose, covariance)
};

/// Velocities.
struct Twist {
  Vector3 linear{};   ///< velocity [m/s]
  Vector3 angular{};  ///< angular rate [rad/s]
  PULSECAST_ROS_MESSAGE("geometry_msgs/msg/Twist", linear, angular)
};

/// Velocities and their uncertainty.
struct TwistWithCovariance {
  Twist twist{};                        ///< velocities
  std::array<double, 36> covariance{};  ///< as of poses, by seconds; 0 as of a truth
  PULSECAST_ROS_MESSAGE("geometry_msgs/msg/TwistWithCovariance", twist, covariance)
};

/// Pose in the frame of the header, and velocities in that of the child.
struct Odometry {
  Header header{};                    ///< time, and the frame of the pose
  std::string_view child_frame_id{};  ///< frame that has the pose
  PoseWithCovariance pose{};          ///< pose
  TwistWithCovariance twist{};        ///< velocities
  PULSECAST_ROS_MESSAGE("nav_msgs/msg/Odometry", header, child_frame_id, pose, twist)
};

/// Sample of an inertial sensor. A covariance of zeros is unknown; one that begins with -1 has no values.
struct Imu {
  Header header{};                                         ///< time and frame of the sensor
  Quaternion orientation{};                                ///< not measured
  std::array<double, 9> orientation_covariance{-1};        ///< [rad2]
  Vector3 angular_velocity{};                              ///< angular rate [rad/s]
  std::array<double, 9> angular_velocity_covariance{};     ///< [rad2/s2]
  Vector3 linear_acceleration{};                           ///< specific force, upwards at rest [m/s2]
  std::array<double, 9> linear_acceleration_covariance{};  ///< [m2/s4]
  PULSECAST_ROS_MESSAGE("sensor_msgs/msg/Imu", header, orientation, orientation_covariance, angular_velocity,
                        angular_velocity_covariance, linear_acceleration, linear_acceleration_covariance)
};

/// Sweep of a scanner in a plane. Angles are from x forward to y left.
struct LaserScan {
  Header header{};                       ///< time of the first beam, and frame of the scanner
  float angle_min = 0, angle_max = 0;    ///< of the first and last beam [rad]
  float angle_increment = 0;             ///< from a beam to the next [rad]
  float time_increment = 0;              ///< from a beam to the next [s]
  float scan_time = 0;                   ///< from a sweep to the next [s]
  float range_min = 0, range_max = 0;    ///< limits of ranges [m]
  std::span<const float> ranges{};       ///< +infinity without a return: ROS REP 117 [m]
  std::span<const float> intensities{};  ///< as many, or none
  PULSECAST_ROS_MESSAGE("sensor_msgs/msg/LaserScan", header, angle_min, angle_max, angle_increment, time_increment,
                        scan_time, range_min, range_max, ranges, intensities)
};

/// Picture.
struct Image {
  Header header{};                    ///< time and frame of the camera
  std::uint32_t height = 0;           ///< number of rows
  std::uint32_t width = 0;            ///< number of columns
  std::string_view encoding{};        ///< as "32FC1"
  std::uint8_t is_bigendian = 0;      ///< 0: little-endian
  std::uint32_t step = 0;             ///< size of a row [byte]
  std::span<const std::byte> data{};  ///< pixels, row by row
  PULSECAST_ROS_MESSAGE("sensor_msgs/msg/Image", header, height, width, encoding, is_bigendian, step, data)
};

/// Point of a Livox.
struct CustomPoint {
  std::uint32_t offset_time = 0;  ///< since the time base [ns]
  float x = 0, y = 0, z = 0;      ///< x forward, y left, z up [m]
  std::uint8_t reflectivity = 0;  ///< reflectance as a byte
  std::uint8_t tag = 0;           ///< kind of the return
  std::uint8_t line = 0;          ///< number of the laser
  PULSECAST_ROS_MESSAGE("livox_ros_driver2/msg/CustomPoint", offset_time, x, y, z, reflectivity, tag, line)
};

/// Scan of a Livox.
struct CustomMsg {
  Header header{};                        ///< time and frame of the sensor
  std::uint64_t timebase = 0;             ///< time from which those of the points count [ns]
  std::uint32_t point_num = 0;            ///< number of points
  std::uint8_t lidar_id = 0;              ///< number of the sensor
  std::array<std::uint8_t, 3> rsvd{};     ///< reserved
  std::span<const CustomPoint> points{};  ///< points
  PULSECAST_ROS_MESSAGE("livox_ros_driver2/msg/CustomMsg", header, timebase, point_num, lidar_id, rsvd, points)
};

/// Vector in axes x right, y forward, z up as one in axes x forward, y left, z up.
[[nodiscard]] inline Vector3 vector_of(const Vec3& v) noexcept { return {v.y, -v.x, v.z}; }

/// Pose of a frame with axes x forward, y left, z up (ROS REP 103), in another such frame, or in the world.
template <class From, class To>
[[nodiscard]] Transform transform_of(const pulsecast::Pose<From, To>& pose) noexcept {
  const Rotation own = rotation_about(axis::up, pi / 2);  // from x forward, y left to x right, y forward
  constexpr bool of_world = std::is_same_v<From, frame::World>, in_world = std::is_same_v<To, frame::World>;
  const Rotation q = (in_world ? no_rotation : conjugate(own)) * pose.rotation * (of_world ? no_rotation : own);
  const Vec3 p = pose.position;
  return {in_world ? Vector3{p.x, p.y, p.z} : vector_of(p), {q.x, q.y, q.z, q.w}};
}

/// Pose of a frame in another one, by their names.
template <class From, class To>
[[nodiscard]] TransformStamped frame_of(std::string_view parent, std::string_view child,
                                        const pulsecast::Pose<From, To>& pose) noexcept {
  return {{{}, parent}, child, transform_of(pose)};
}

/// Message of a pose in the world, a velocity there [m/s], and an angular rate in axes of the body [rad/s].
[[nodiscard]] inline Odometry odometry_of(const pulsecast::Pose<frame::Body, frame::World>& pose, const Vec3& velocity,
                                          const Vec3& angular_rate) noexcept {
  const auto [p, q] = transform_of(pose);
  const Vec3 v = conjugate(pose.rotation) * velocity;
  return {.pose = {.pose = {{p.x, p.y, p.z}, q}}, .twist = {.twist = {vector_of(v), vector_of(angular_rate)}}};
}

/// Message of a sample: its means, which hold in the `middle()` of its interval. No orientation is measured.
[[nodiscard]] inline Imu imu_of(const ImuSample& sample) noexcept {
  Imu imu;
  imu.angular_velocity = vector_of(sample.mean_angular_rate());
  imu.linear_acceleration = vector_of(sample.mean_specific_force());
  return imu;
}

/// Sweep of a scanner in a plane, whose beams are the columns of a `PointGrid` of one row.
struct SweepSettings {
  double angle_min = 0;        ///< angle of the first beam, from x forward to y left [rad]
  double angle_increment = 0;  ///< from a beam to the next; negative: clockwise [rad]
  double scan_time = 0;        ///< from a sweep to the next [s]
  RangeGate gate{};            ///< limits of the ranges [m]
};

/// Points of `laser_scan_of`: range and intensity.
[[nodiscard]] inline PointLayout sweep_layout() {
  return PointLayout::packed(
      {{"range", NumberType::float32, column("range")}, {"intensity", NumberType::float32, column("reflectivity")}});
}

namespace detail {

/// @throws SettingError unless the fields of a layout begin with these
inline void require_fields(const PointLayout& layout, std::initializer_list<std::string_view> names) {
  for (std::size_t i = 0; i < names.size(); ++i)
    if (i >= layout.fields.size() || layout.fields[i].name != names.begin()[i])
      throw SettingError("PointLayout::fields (index)", static_cast<double>(i), "",
                         text::joined({"that of '", names.begin()[i], "', for this message"}));
}

/// Numbers in a field of the points of a grid; `missing` in place of NaN.
inline void take_numbers(const PointBuffer& points, const PointField& field, float missing, float* to) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto number = static_cast<float>(points.number(i, field));
    to[i] = std::isnan(number) ? missing : number;
  }
}
inline constexpr float no_return = std::numeric_limits<float>::infinity();  ///< ROS REP 117

}  // namespace detail

/// Message of a sweep, with its numbers in `memory`. @throws SettingError for another layout or no grid of one row
[[nodiscard]] inline LaserScan laser_scan_of(const PointBuffer& sweep, const SweepSettings& settings,
                                             std::vector<float>& memory) {
  const auto [rows, beams, rate] = sweep.grid();
  require_within("PointGrid::rows, as a LaserScan", rows, 1, 1, "");
  detail::require_fields(sweep.layout(), {"range", "intensity"});
  memory.resize(std::size_t{2} * beams);
  detail::take_numbers(sweep, sweep.layout().fields[0], detail::no_return, memory.data());
  detail::take_numbers(sweep, sweep.layout().fields[1], 0, memory.data() + beams);
  const auto single = [](double number) { return static_cast<float>(number); };
  const double last = settings.angle_min + settings.angle_increment * (beams - 1.0);
  return {{},
          single(settings.angle_min),
          single(last),
          single(settings.angle_increment),
          single(rate > 0 ? 1 / rate : 0),
          single(settings.scan_time),
          single(settings.gate.near),
          single(settings.gate.far),
          {memory.data(), beams},
          {memory.data() + beams, beams}};
}

/// Depths of the points of a grid, whose layout begins with x, y, z: metres along the forward axis, +infinity without a
/// return (ROS REP 118), in `memory`. @throws SettingError for another layout, or without a grid or sensor
[[nodiscard]] inline Image depth_image_of(const PointBuffer& points, std::vector<float>& memory) {
  const auto [rows, columns, rate] = points.grid();
  require_within("PointGrid::rows, as an Image", rows, 1, 1e6, "");
  detail::require_fields(points.layout(), {"x", "y"});
  if (!points.settings().sensor)
    throw SettingError("PointSettings::sensor (poses)", 0, "", "1, for depths in the frame of a sensor");
  const bool x_is_forward = points.settings().axes == PointAxes::forward_left_up;
  memory.resize(points.size());
  detail::take_numbers(points, points.layout().fields[x_is_forward ? 0 : 1], detail::no_return, memory.data());
  return {{}, rows, columns, "32FC1", 0, columns * std::uint32_t{sizeof(float)}, std::as_bytes(std::span(memory))};
}

/// Points of `livox_of`, which lie in memory as a `CustomPoint`.
[[nodiscard]] inline PointLayout livox_layout() {
  using enum NumberType;
  PointLayout layout = PointLayout::packed({{"offset_time", uint32, column("time"), 1e9}})
                           .with(layouts::xyz_float())
                           .with({{"reflectivity", uint8, column("reflectivity")}, {"tag", uint8}})
                           .with({{"line", uint8, column("ring")}});
  layout.size = sizeof(CustomPoint);
  return layout;
}

/// Message of a scan in a `livox_layout()`, which it refers to. @throws SettingError for another layout, a grid, or a
/// scan of 2^32 ns (4.3 s) and more
[[nodiscard]] inline CustomMsg livox_of(const PointBuffer& scan) {
  detail::require_fields(scan.layout(), {"offset_time", "x", "y", "z", "reflectivity", "tag", "line"});
  require_within("PointLayout::size, as a CustomMsg", scan.layout().size, sizeof(CustomPoint), sizeof(CustomPoint),
                 "byte");
  require_within("PointGrid::rows, as a CustomMsg", scan.grid().rows, 0, 0, "");
  constexpr std::array<std::uint32_t, 7> places{0, 4, 8, 12, 16, 17, 18};
  for (std::size_t i = 0; i < places.size(); ++i) {
    const PointField& field = scan.layout().fields[i];
    const NumberType type = i == 0 ? NumberType::uint32 : i < 4 ? NumberType::float32 : NumberType::uint8;
    if (field.offset != places[i] || field.type != type)
      throw SettingError("PointLayout::fields (index)", static_cast<double>(i), "",
                         text::joined({"'", field.name, "' with type and offset of livox_layout()"}));
  }
  const std::span points(reinterpret_cast<const CustomPoint*>(scan.records().data()), scan.size());
  constexpr std::uint32_t last = std::numeric_limits<std::uint32_t>::max();
  if (std::ranges::find(points, last, &CustomPoint::offset_time) != points.end())
    throw SettingError("PointBuffer (time after the start of the scan)", 1e-9 * last, "s", "less, as a CustomMsg");
  return {.point_num = static_cast<std::uint32_t>(scan.size()), .points = points};
}

}  // namespace PULSECAST_NAMESPACE::io::ros

#endif
