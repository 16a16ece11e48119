// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DRIVE_BAG_HPP
#define PULSECAST_IO_DRIVE_BAG_HPP

#include <pulsecast/io/mcap.hpp>
#include <pulsecast/io/point_cloud2.hpp>

namespace PULSECAST_NAMESPACE::io {

/// Topic of a `DriveBag`, with messages of type `M` about a frame.
template <ros::RosMessage M>
struct BagTopic {
  std::uint16_t channel = 0;     ///< channel in the file
  std::string frame_id{};        ///< frame of the data; of odometry the fixed one
  std::string child_frame_id{};  ///< of odometry the moving frame
};

/// Writes a drive as an MCAP file of ROS 2, in order of the times when data were complete:
///
///     DriveBag bag("drive.mcap", 1.7e9);
///     const auto points = bag.add<ros::PointCloud2>("/points", "lidar");
///     const auto imu = bag.add<ros::Imu>("/imu/data", "imu_link");
///     const auto truth = bag.add<ros::Odometry>("/ground_truth/odom", "map", "base_link");
///     bag.fix("base_link", "lidar", body_from_lidar);
///     // in each step: bag.write(points, scan, end); bag.write(imu, sample); ...
///     bag.advance(end);
///     bag.close();
///
/// The truth is no frame: SLAM and odometry set `map`, `odom` and `base_link` on `/tf`, and a frame has one parent.
/// After the first steps, it allocates the index of the file only. Members throw a `FileError`.
class DriveBag {
 public:
  /// `start_time` is the clock time at tick 0 [s].
  explicit DriveBag(std::filesystem::path path, double start_time = 0, McapSettings settings = {})
      : file_(std::move(path), std::move(settings)), start_time_(start_time) {
    file_.add_metadata("rosbag2", {});  // without it, rosbag2 expects names in the quality of service
    clock_ = add<ros::Clock>("/clock", "");
    tf_ = add<ros::TFMessage>("/tf", "");
    fixed_ = {file_.add_channel({.topic = "/tf_static",
                                 .schema_name = ros::type_of<ros::TFMessage>,
                                 .schema = ros::definition_of<ros::TFMessage>,
                                 .metadata = {{"offered_qos_profiles", transient_local}}})};
  }

  /// Adds a topic. @throws SettingError beyond 65,535
  template <ros::RosMessage M>
  [[nodiscard]] BagTopic<M> add(std::string topic, std::string frame_id, std::string child_frame_id = {}) {
    const std::uint16_t channel =
        file_.add_channel({.topic = std::move(topic), .schema_name = ros::type_of<M>, .schema = ros::definition_of<M>});
    return {channel, std::move(frame_id), std::move(child_frame_id)};
  }

  /// Appends a scan, complete at a tick. @throws SettingError, as all `write`, for times that ROS does not hold, or
  /// before the last `advance`
  void write(const BagTopic<ros::PointCloud2>& topic, const PointBuffer& scan, const Tick& complete) {
    serialize_point_cloud2(scan, topic.frame_id, message_);
    keep(topic.channel, stamp(scan.scan_start()), complete);
  }
  /// Appends a scan of a Livox, in a `ros::livox_layout()`.
  void write(const BagTopic<ros::CustomMsg>& topic, const PointBuffer& scan, const Tick& complete) {
    ros::CustomMsg message = ros::livox_of(scan);
    message.timebase = stamp(scan.scan_start());
    put(topic, message, scan.scan_start(), complete);
  }
  /// Appends a sweep, in a `ros::sweep_layout()`.
  void write(const BagTopic<ros::LaserScan>& topic, const PointBuffer& sweep, const Tick& complete,
             const ros::SweepSettings& settings) {
    put(topic, ros::laser_scan_of(sweep, settings, numbers_), sweep.scan_start(), complete);
  }
  /// Appends an image of depths.
  void write(const BagTopic<ros::Image>& topic, const PointBuffer& points, const Tick& complete) {
    put(topic, ros::depth_image_of(points, numbers_), points.scan_start(), complete);
  }
  void write(const BagTopic<ros::Imu>& topic, const ImuSample& sample) {
    put(topic, ros::imu_of(sample), sample.tick, sample.tick);
  }
  /// Appends odometry or the truth: a pose, a velocity in the world [m/s], and an angular rate in the body [rad/s].
  void write(const BagTopic<ros::Odometry>& topic, const Tick& tick, const Pose<frame::Body, frame::World>& pose,
             const Vec3& velocity, const Vec3& angular_rate) {
    ros::Odometry message = ros::odometry_of(pose, velocity, angular_rate);
    message.child_frame_id = topic.child_frame_id;
    put(topic, message, tick, tick);
  }

  /// Sets the pose of a frame on `/tf`, at a tick.
  template <class From, class To>
  void move(std::string_view parent, std::string_view child, const Pose<From, To>& pose, const Tick& tick) {
    const ros::TransformStamped frame{{ros::Time::of(stamp(tick)), parent}, child, ros::transform_of(pose)};
    ros::serialize(ros::TFMessage{{&frame, 1}}, message_);
    keep(tf_.channel, stamp(tick), tick);
  }
  /// Sets the pose of a fixed frame on `/tf_static`, whose last message has all of them.
  template <class From, class To>
  void fix(std::string parent, std::string child, const Pose<From, To>& pose, const Tick& tick = {}) {
    frames_.push_back({std::move(parent), std::move(child), ros::transform_of(pose)});
    std::vector<ros::TransformStamped> all;
    for (const Frame& f : frames_) all.push_back({{ros::Time::of(stamp(tick)), f.parent}, f.child, f.pose});
    ros::serialize(ros::TFMessage{all}, message_);
    keep(fixed_.channel, stamp(tick), tick);
  }

  /// Writes all messages of times before `end`, after which no earlier one may come; and `end` to `/clock`.
  void advance(const Tick& end) {
    const std::uint64_t limit = stamp(end);
    put_until(limit);
    end_ = limit;
    ros::serialize(ros::Clock{ros::Time::of(limit)}, message_);
    keep(clock_.channel, limit, end);
  }

  /// Writes the rest, and completes the file.
  void close() {
    put_until(std::numeric_limits<std::uint64_t>::max());
    file_.close();
  }

 private:
  struct Frame {
    std::string parent, child;
    ros::Transform pose;
  };
  struct Waiting {
    std::uint64_t log_time, publish_time;  // [ns]
    std::size_t at, size;                  // place in `waiting_bytes_`
    std::uint16_t channel;
  };

  /// Quality of service of topics whose last message reaches late subscribers: history keep last, reliable, transient
  /// local, and no limits in time. Source: rosbag2_storage, qos.cpp, bags up to version 8; rmw/types.h.
  static constexpr const char* transient_local =
      "- history: 1\n  depth: 1\n  reliability: 1\n  durability: 1\n"
      "  deadline:\n    sec: 9223372036\n    nsec: 854775807\n"
      "  lifespan:\n    sec: 9223372036\n    nsec: 854775807\n"
      "  liveliness: 1\n  liveliness_lease_duration:\n    sec: 9223372036\n    nsec: 854775807\n"
      "  avoid_ros_namespace_conventions: false\n";

  [[nodiscard]] std::uint64_t stamp(const Tick& tick) const {
    return ros::stamp_ns(start_time_, tick, "DriveBag::start_time + tick");
  }

  template <class M>
  void put(const BagTopic<M>& topic, M message, const Tick& tick, const Tick& complete) {
    message.header = {ros::Time::of(stamp(tick)), topic.frame_id};
    ros::serialize(message, message_);
    keep(topic.channel, stamp(tick), complete);
  }

  /// Keeps the message until those of earlier times have come.
  void keep(std::uint16_t channel, std::uint64_t publish_time, const Tick& complete) {
    const std::uint64_t log_time = stamp(complete);
    if (log_time < end_)
      throw SettingError("DriveBag::write (time)", complete.seconds(), "s", "not before that of the last advance");
    waiting_.push_back({log_time, publish_time, waiting_bytes_.size(), message_.size(), channel});
    waiting_bytes_.insert(waiting_bytes_.end(), message_.begin(), message_.end());
  }

  void put_until(std::uint64_t limit) {
    std::ranges::sort(waiting_, {}, [](const Waiting& w) { return std::pair(w.log_time, w.at); });
    const auto left = std::ranges::lower_bound(waiting_, limit, {}, &Waiting::log_time);
    const std::span bytes(waiting_bytes_);
    for (auto w = waiting_.begin(); w != left; ++w)
      file_.write(w->channel, w->log_time, w->publish_time, bytes.subspan(w->at, w->size));
    waiting_.erase(waiting_.begin(), left);
    left_bytes_.clear();
    for (Waiting& w : waiting_) {
      const auto own = bytes.subspan(w.at, w.size);
      w.at = left_bytes_.size();
      left_bytes_.insert(left_bytes_.end(), own.begin(), own.end());
    }
    waiting_bytes_.swap(left_bytes_);
  }

  McapWriter file_;
  double start_time_;
  BagTopic<ros::Clock> clock_;
  BagTopic<ros::TFMessage> tf_, fixed_;
  std::vector<Frame> frames_;  // fixed ones
  std::vector<Waiting> waiting_;
  std::vector<std::byte> message_, waiting_bytes_, left_bytes_;  // the one under construction; of those that wait
  std::vector<float> numbers_;                                   // of a message under construction
  std::uint64_t end_ = 0;                                        // time before which all is written [ns]
};

}  // namespace PULSECAST_NAMESPACE::io

#endif
