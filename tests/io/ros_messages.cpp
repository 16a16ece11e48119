// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/ros_messages.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <doctest/doctest.h>
#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>

#include <pulsecast/base/error.hpp>

#include "support/allocations.hpp"
#include "support/generators.hpp"

namespace pulsecast::io {
namespace {

using support::Generator;

/// Reads a message by Fast CDR, and compares it value by value.
class Reading {
 public:
  explicit Reading(std::vector<std::byte> message)
      : bytes_(std::move(message)),
        buffer_(reinterpret_cast<char*>(bytes_.data() + 4), bytes_.size() - 4),
        cdr_(buffer_) {
    CHECK((bytes_[0] == std::byte{0} && bytes_[1] == std::byte{1} && bytes_[2] == std::byte{0} &&
           bytes_[3] == std::byte{0}));
  }

  template <class... Number>
  Reading& is(Number... expected) {
    (one(expected), ...);
    return *this;
  }
  Reading& is(const ros::Header& h) { return is(h.stamp.sec, h.stamp.nanosec, h.frame_id); }
  Reading& is(const ros::Quaternion& q) { return is(q.x, q.y, q.z, q.w); }
  Reading& is(const ros::Vector3& v) { return is(v.x, v.y, v.z); }
  template <std::size_t n>
  Reading& is(const std::array<double, n>& all) {
    for (const double number : all) is(number);
    return *this;
  }
  void end() { CHECK(cdr_.getSerializedDataLength() == bytes_.size() - 4); }

 private:
  template <class Number>
  void one(Number expected) {
    if constexpr (std::is_same_v<Number, std::string_view>) {
      std::string found;
      cdr_ >> found;
      CHECK(found == expected);
    } else {
      Number found;
      cdr_ >> found;
      CHECK(std::memcmp(&found, &expected, sizeof found) == 0);
    }
  }

  std::vector<std::byte> bytes_;
  eprosima::fastcdr::FastBuffer buffer_;
  eprosima::fastcdr::Cdr cdr_;
};

template <class M>
Reading written(const M& message) {
  static std::vector<std::byte> bytes(99, std::byte{0xff});  // reused, so that nothing of a former message may be left
  ros::serialize(message, bytes);
  return Reading(bytes);
}

ros::Vector3 any_vector(Generator& any) { return {any.normal(), any.normal(), any.normal()}; }
ros::Quaternion any_quaternion(Generator& any) { return {any.normal(), any.normal(), any.normal(), any.normal()}; }
template <std::size_t n>
std::array<double, n> any_numbers(Generator& any) {
  std::array<double, n> all;
  for (double& number : all) number = any.normal();
  return all;
}
std::string any_text(std::uint64_t length, Generator& any) {
  std::string text;
  while (text.size() < length) text += static_cast<char>('a' + any.whole(26));
  return text;
}
ros::Header any_header(std::string_view frame_id, Generator& any) {
  return {{static_cast<std::int32_t>(any.whole(1U << 31)), static_cast<std::uint32_t>(any.whole(1'000'000'000))},
          frame_id};
}

/// Shot along +y of the sensor that is turned to the left.
Shot shot(PulseIndex index, Tick tick, std::uint16_t channel = 0, std::uint32_t echoes = 1, double left = 0) {
  return {.index = index,
          .tick = tick,
          .direction = {-std::sin(left), std::cos(left), 0},
          .channel = channel,
          .echoes = echoes};
}

void add(PointBuffer& points, const Shot& of, const Echo& echo) {
  points({.shots = {&of, 1}, .echoes = {&echo, 1}, .samples = {}});
}

TEST_CASE("definitions are those of the packages, with each part once") {
  const std::string rule(80, '='),
      time = rule + "\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n",
      header = rule + "\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n" + time,
      vector = rule + "\nMSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n",
      quaternion = rule + "\nMSG: geometry_msgs/Quaternion\nfloat64 x\nfloat64 y\nfloat64 z\nfloat64 w\n";
  CHECK(ros::definition_of<ros::Clock> == "builtin_interfaces/Time clock\n" + time);
  CHECK(ros::definition_of<ros::Imu> ==
        "std_msgs/Header header\ngeometry_msgs/Quaternion orientation\nfloat64[9] orientation_covariance\n"
        "geometry_msgs/Vector3 angular_velocity\nfloat64[9] angular_velocity_covariance\n"
        "geometry_msgs/Vector3 linear_acceleration\nfloat64[9] linear_acceleration_covariance\n" +
            header + quaternion + vector);
  CHECK(ros::definition_of<ros::LaserScan> ==
        "std_msgs/Header header\nfloat32 angle_min\nfloat32 angle_max\nfloat32 angle_increment\nfloat32 "
        "time_increment\nfloat32 scan_time\nfloat32 range_min\nfloat32 range_max\nfloat32[] ranges\nfloat32[] "
        "intensities\n" +
            header);
  CHECK(ros::definition_of<ros::Odometry> ==
        "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/PoseWithCovariance pose\n"
        "geometry_msgs/TwistWithCovariance twist\n" +
            header + rule +
            "\nMSG: geometry_msgs/PoseWithCovariance\ngeometry_msgs/Pose pose\nfloat64[36] covariance\n" + rule +
            "\nMSG: geometry_msgs/Pose\ngeometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n" + rule +
            "\nMSG: geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z\n" + quaternion + rule +
            "\nMSG: geometry_msgs/TwistWithCovariance\ngeometry_msgs/Twist twist\nfloat64[36] covariance\n" + rule +
            "\nMSG: geometry_msgs/Twist\ngeometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular\n" + vector);
  CHECK(ros::definition_of<ros::TFMessage> ==
        "geometry_msgs/TransformStamped[] transforms\n" + rule +
            "\nMSG: geometry_msgs/TransformStamped\nstd_msgs/Header header\nstring child_frame_id\n"
            "geometry_msgs/Transform transform\n" +
            header + rule +
            "\nMSG: geometry_msgs/Transform\ngeometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n" +
            vector + quaternion);
  CHECK(ros::definition_of<ros::Image> ==
        "std_msgs/Header header\nuint32 height\nuint32 width\nstring encoding\nuint8 is_bigendian\nuint32 step\n"
        "uint8[] data\n" +
            header);
  CHECK(ros::definition_of<ros::CustomMsg> ==
        "std_msgs/Header header\nuint64 timebase\nuint32 point_num\nuint8 lidar_id\nuint8[3] rsvd\n"
        "livox_ros_driver2/CustomPoint[] points\n" +
            header + rule +
            "\nMSG: livox_ros_driver2/CustomPoint\nuint32 offset_time\nfloat32 x\nfloat32 y\nfloat32 z\n"
            "uint8 reflectivity\nuint8 tag\nuint8 line\n");
  CHECK(ros::type_of<ros::Imu> == std::string("sensor_msgs/msg/Imu"));
}

TEST_CASE("libfastcdr reads from every message what it holds, with texts and sequences of any length") {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    CAPTURE(seed);
    Generator any(seed);
    const std::string frame = any_text(seed % 18, any), child = any_text(any.whole(18), any);
    const ros::Header header = any_header(frame, any);
    written(ros::Clock{header.stamp}).is(header.stamp.sec, header.stamp.nanosec).end();

    const ros::Imu imu{header,          any_quaternion(any), any_numbers<9>(any), any_vector(any), any_numbers<9>(any),
                       any_vector(any), any_numbers<9>(any)};
    auto reading = written(imu);
    reading.is(header).is(imu.orientation).is(imu.orientation_covariance).is(imu.angular_velocity);
    reading.is(imu.angular_velocity_covariance)
        .is(imu.linear_acceleration)
        .is(imu.linear_acceleration_covariance)
        .end();

    ros::Odometry odometry{header, child, {{{1, 2, 3}, any_quaternion(any)}, any_numbers<36>(any)}, {}};
    odometry.twist = {{any_vector(any), any_vector(any)}, any_numbers<36>(any)};
    auto of_odometry = written(odometry);
    of_odometry.is(header).is(std::string_view(child)).is(1.0, 2.0, 3.0).is(odometry.pose.pose.orientation);
    of_odometry.is(odometry.pose.covariance).is(odometry.twist.twist.linear).is(odometry.twist.twist.angular);
    of_odometry.is(odometry.twist.covariance).end();

    std::vector<ros::TransformStamped> frames(any.whole(4));
    for (auto& f : frames) f = {any_header(child, any), frame, {any_vector(any), any_quaternion(any)}};
    auto of_frames = written(ros::TFMessage{frames});
    of_frames.is(static_cast<std::uint32_t>(frames.size()));
    for (const auto& f : frames)
      of_frames.is(f.header).is(std::string_view(frame)).is(f.transform.translation).is(f.transform.rotation);
    of_frames.end();

    std::vector<float> ranges(any.whole(9)), intensities(any.coin() ? ranges.size() : 0);
    for (auto* all : {&ranges, &intensities})
      for (float& number : *all) number = static_cast<float>(any.normal());
    auto of_scan = written(ros::LaserScan{header, 1, 2, 3, 4, 5, 6, 7, ranges, intensities});
    of_scan.is(header).is(1.0F, 2.0F, 3.0F, 4.0F, 5.0F, 6.0F, 7.0F);
    for (const auto* all : {&ranges, &intensities}) {
      of_scan.is(static_cast<std::uint32_t>(all->size()));
      for (const float number : *all) of_scan.is(number);
    }
    of_scan.end();

    std::vector<std::byte> data(any.whole(20));
    for (std::byte& b : data) b = static_cast<std::byte>(any.whole(256));
    auto of_image = written(ros::Image{header, 8, 9, child, 0, 10, data});
    of_image.is(header).is(8U, 9U, std::string_view(child), std::uint8_t{0}, 10U,
                           static_cast<std::uint32_t>(data.size()));
    for (const std::byte b : data) of_image.is(static_cast<std::uint8_t>(b));
    of_image.end();

    std::vector<ros::CustomPoint> points(any.whole(40));
    for (auto& p : points) p = {static_cast<std::uint32_t>(any.whole(1U << 31)), 1, -2, 3, 4, 5, 6};
    const std::uint64_t base = any.whole(1ULL << 50);
    auto of_livox = written(ros::CustomMsg{header, base, 77, 3, {1, 2, 3}, points});
    of_livox.is(header).is(base, 77U, std::uint8_t{3}, std::uint8_t{1}, std::uint8_t{2}, std::uint8_t{3});
    of_livox.is(static_cast<std::uint32_t>(points.size()));
    for (const auto& p : points)
      of_livox.is(p.offset_time, 1.0F, -2.0F, 3.0F, std::uint8_t{4}, std::uint8_t{5}, std::uint8_t{6});
    of_livox.end();
  }
}

TEST_CASE("a text with a zero in it is written whole") {
  std::vector<std::byte> bytes;
  ros::serialize(ros::Header{{}, std::string_view("a\0b", 3)}, bytes);
  const std::string end(reinterpret_cast<const char*>(bytes.data()) + 12, bytes.size() - 12);
  CHECK(end == std::string("\4\0\0\0a\0b\0", 8));
}

TEST_CASE("a message that has room allocates nothing") {
  const std::string frame = "a frame whose name is longer than a short string";
  const std::vector<float> ranges(1000);
  std::vector<std::byte> bytes;
  const auto write = [&](std::size_t beams) {
    ros::serialize(ros::LaserScan{{{}, frame}, 0, 0, 0, 0, 0, 0, 0, std::span(ranges).first(beams), {}}, bytes);
  };
  write(1000);
  const std::size_t before = support::allocations;
  for (std::size_t beams = 0; beams < 1000; ++beams) write(beams);
  CHECK(support::allocations == before);
}

TEST_CASE("stamps are exact to the nanosecond, and times that ROS does not hold are refused") {
  for (PulseIndex n = 0; n < 1000; ++n) {
    CAPTURE(n);
    CHECK(ros::stamp_ns(1'700'000'000, Tick::of(n, 8)) == 1'700'000'000'000'000'000 + 125'000'000 * n);
  }
  const ros::Time time = ros::Time::of(ros::stamp_ns(0, {2'147'483'646, 0.9999999999}));
  CHECK((time.sec == 2'147'483'647 && time.nanosec == 0));
  CHECK_THROWS_WITH_AS(static_cast<void>(ros::stamp_ns(-1, {})), doctest::Contains("start_time + tick is -1 s"),
                       SettingError);
  CHECK_THROWS_AS(static_cast<void>(ros::stamp_ns(1, {2'147'483'647, 0})), SettingError);
  CHECK_THROWS_AS(static_cast<void>(ros::stamp_ns(std::nan(""), {})), SettingError);
}

/// Image of a vector by the rotation of a message.
Vec3 turned(const ros::Quaternion& q, const Vec3& v) { return Rotation{q.w, q.x, q.y, q.z} * v; }
Vec3 vec3(const auto& v) { return {v.x, v.y, v.z}; }

TEST_CASE("transforms map points in axes x forward, y left, z up as poses map them") {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    CAPTURE(seed);
    Generator any(seed);
    const Vec3 point = any.point(10), at = any.point(10);  // in axes of ROS
    const Rotation rotation = any.rotation();
    const Pose<frame::Body, frame::World> body{rotation, at};
    const ros::Transform world = ros::transform_of(body);
    CHECK(length(turned(world.rotation, point) + vec3(world.translation) - body.point(from_forward_left_up(point))) <
          1e-13);
    const Pose<frame::Instrument, frame::Body> mount{rotation, at};
    const ros::Transform fixed = ros::transform_of(mount);
    const Vec3 expected = to_forward_left_up(mount.point(from_forward_left_up(point)));
    CHECK(length(turned(fixed.rotation, point) + vec3(fixed.translation) - expected) < 1e-13);
    const ros::Transform back = ros::transform_of(body.inverse());  // from a point of the world
    const Vec3 in_body = to_forward_left_up(body.inverse().point(point));
    CHECK(length(turned(back.rotation, point) + vec3(back.translation) - in_body) < 1e-13);
  }
  const ros::Transform east = ros::transform_of(Pose<frame::Body, frame::World>{level(pi / 2), {1, 2, 3}});
  CHECK(std::fabs(east.rotation.w) == doctest::Approx(1));  // x forward is x east
  CHECK((east.translation.x == 1 && east.translation.y == 2 && east.translation.z == 3));
}

TEST_CASE("odometry has the velocity in axes of the body") {
  const Pose<frame::Body, frame::World> north{no_rotation, {4, 5, 6}}, east{level(pi / 2), {}};
  const ros::Odometry m = ros::odometry_of(north, {1, 20, 3}, {0.1, 0.2, 0.3});
  CHECK(vec3(m.twist.twist.linear) == Vec3{20, -1, 3});
  CHECK(vec3(m.twist.twist.angular) == Vec3{0.2, -0.1, 0.3});
  CHECK(vec3(m.pose.pose.position) == Vec3{4, 5, 6});
  CHECK(m.pose.pose.orientation.z == doctest::Approx(std::sqrt(0.5)));  // x forward is y north
  CHECK(length(vec3(ros::odometry_of(east, {20, 0, 0}, {}).twist.twist.linear) - Vec3{20, 0, 0}) < 1e-14);
}

TEST_CASE("a sample of an inertial sensor has no orientation, and its vectors are in axes of ROS") {
  const ros::Imu m = ros::imu_of({.interval = 2, .velocity_increment = {8, 10, 19.62}});
  CHECK(m.orientation_covariance == std::array<double, 9>{-1});
  CHECK(m.angular_velocity_covariance == std::array<double, 9>{});
  CHECK(vec3(m.angular_velocity) == Vec3{0, 0, 0});
  CHECK(vec3(m.linear_acceleration) == Vec3{5, -4, 9.81});
  const ImuSample turning{.interval = 2, .angle_increment = {2, 4, 6}, .velocity_increment = {0, 0, 20}};
  CHECK(vec3(ros::imu_of(turning).angular_velocity) == Vec3{2, -1, 3});
  CHECK(length(vec3(ros::imu_of(turning).linear_acceleration)) == doctest::Approx(10));
}

TEST_CASE("a sweep has a range a beam, and infinity for those without a return") {
  PointBuffer sweep(ros::sweep_layout(), {}, {.rows = 1, .columns = 5, .column_rate = 100});
  std::vector<float> memory;
  for (int turn = 0; turn < 2; ++turn) {
    sweep.begin_scan({10 + turn, 0.5});
    for (const int beam : {0, 3, 4})
      add(sweep, shot(0, Tick{10 + turn, 0.5} + Tick::of(static_cast<PulseIndex>(beam), 100)),
          {.range = beam + 1.5, .reflectance = 0.5});
    const ros::LaserScan m = ros::laser_scan_of(
        sweep, {.angle_min = -1, .angle_increment = 0.5, .scan_time = 0.1, .gate = {0.05, 30}}, memory);
    constexpr float none = std::numeric_limits<float>::infinity();
    CHECK(std::vector(m.ranges.begin(), m.ranges.end()) == std::vector<float>{1.5F, none, none, 4.5F, 5.5F});
    CHECK(std::vector(m.intensities.begin(), m.intensities.end()) == std::vector<float>{50, 0, 0, 50, 50});
    CHECK((m.angle_min == -1 && m.angle_max == 1 && m.angle_increment == 0.5F && m.time_increment == 0.01F));
    CHECK((m.scan_time == 0.1F && m.range_min == 0.05F && m.range_max == 30));
  }
  CHECK_THROWS_WITH_AS(static_cast<void>(ros::laser_scan_of(PointBuffer(ros::sweep_layout()), {}, memory)),
                       doctest::Contains("PointGrid::rows"), SettingError);
  CHECK_THROWS_WITH_AS(static_cast<void>(ros::laser_scan_of(PointBuffer(layouts::xyzi(), {}, {1, 5, 100}), {}, memory)),
                       doctest::Contains("'range'"), SettingError);
}

/// Sensor that stands at the origin.
Pose<frame::Instrument, frame::World> at_origin(Tick) { return {}; }

TEST_CASE("a depth image has the way along the forward axis, in either axes, and infinity for misses") {
  for (const PointAxes axes : {PointAxes::right_forward_up, PointAxes::forward_left_up}) {
    PointBuffer points(layouts::xyzi(), {.sensor = at_origin, .axes = axes}, {.rows = 2, .columns = 3});
    points.begin_scan({});
    add(points, shot(12 + 1, {}), {.range = 5});
    add(points, shot(12 + 5, {}, 0, 1, pi / 3), {.range = 8});
    std::vector<float> memory;
    const ros::Image m = ros::depth_image_of(points, memory);
    CHECK((m.height == 2 && m.width == 3 && m.encoding == "32FC1" && m.is_bigendian == 0 && m.step == 12));
    REQUIRE(m.data.size() == 24);
    std::array<float, 6> depths;
    std::memcpy(depths.data(), m.data.data(), sizeof depths);
    for (const std::size_t miss : {0U, 2U, 3U, 4U}) CHECK(depths[miss] == std::numeric_limits<float>::infinity());
    CHECK(depths[1] == 5);
    CHECK(depths[5] == doctest::Approx(4));
  }
  std::vector<float> memory;
  CHECK_THROWS_AS(static_cast<void>(ros::depth_image_of(PointBuffer(layouts::xyzi()), memory)), SettingError);
  CHECK_THROWS_WITH_AS(static_cast<void>(ros::depth_image_of(PointBuffer(layouts::xyzi(), {}, {1, 1}), memory)),
                       doctest::Contains("PointSettings::sensor"), SettingError);
  CHECK_THROWS_AS(static_cast<void>(ros::depth_image_of(PointBuffer(ros::sweep_layout(), {}, {1, 1}), memory)),
                  SettingError);
}

TEST_CASE("points of a Livox lie in memory as the message has them") {
  PointBuffer scan(ros::livox_layout(), {.axes = PointAxes::forward_left_up, .rings = {3, 2, 1, 0}});
  const std::uintptr_t place = offsetof(ros::CustomPoint, line);
  REQUIRE((scan.layout().fields.back().offset == place && scan.layout().size == sizeof(ros::CustomPoint)));
  CHECK(ros::livox_of(scan).points.empty());
  Generator any(5);
  scan.begin_scan({100, 0.25});
  std::vector<ros::CustomPoint> expected;
  for (std::uint16_t i = 0; i < 4; ++i) {
    const double range = any.uniform(1, 100);
    add(scan, shot(i, {100, 0.25 + 0.01 * i}, i), {.range = range, .reflectance = 0.25 * i});
    expected.push_back({10'000'000U * i, static_cast<float>(range), 0, 0, static_cast<std::uint8_t>(25 * i), 0,
                        static_cast<std::uint8_t>(3 - i)});
  }
  const ros::CustomMsg m = ros::livox_of(scan);
  CHECK(m.point_num == 4);
  REQUIRE(m.points.size() == 4);
  for (std::size_t i = 0; i < 4; ++i) {
    CAPTURE(i);
    const ros::CustomPoint &a = m.points[i], &b = expected[i];
    CHECK((a.offset_time == b.offset_time && a.x == b.x && a.y == 0 && a.z == 0));
    CHECK((a.reflectivity == b.reflectivity && a.tag == 0 && a.line == b.line));
  }
  CHECK_THROWS_WITH_AS(static_cast<void>(ros::livox_of(PointBuffer(layouts::livox()))),
                       doctest::Contains("'offset_time'"), SettingError);
  CHECK_THROWS_WITH_AS(static_cast<void>(ros::livox_of(PointBuffer(ros::livox_layout(), {}, {1, 4}))),
                       doctest::Contains("PointGrid::rows, as a CustomMsg is 1"), SettingError);
  PointLayout other = ros::livox_layout();
  other.fields[0].type = NumberType::float32;
  CHECK_THROWS_WITH_AS(static_cast<void>(ros::livox_of(PointBuffer(other))), doctest::Contains("type and offset"),
                       SettingError);
  add(scan, shot(9, {104, 0.6}), {.range = 1});
  CHECK_THROWS_WITH_AS(static_cast<void>(ros::livox_of(scan)), doctest::Contains("is 4.294967295 s"), SettingError);
  PointLayout longer = ros::livox_layout();
  longer.size = 24;
  CHECK_THROWS_WITH_AS(static_cast<void>(ros::livox_of(PointBuffer(longer))), doctest::Contains("from 20 to 20"),
                       SettingError);
}

}  // namespace
}  // namespace pulsecast::io
