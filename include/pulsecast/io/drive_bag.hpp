// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DRIVE_BAG_HPP
#define PULSECAST_IO_DRIVE_BAG_HPP

#include <pulsecast/io/mcap.hpp>
#include <pulsecast/io/point_cloud2.hpp>

namespace PULSECAST_NAMESPACE::io {

/// Topic of a `DriveBag`, with messages of type `M`.
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
///     bag.fix({ros::frame_of("base_link", "lidar", body_from_lidar)});
///     // in each step up to a tick `end`
///     bag.write(points, scan, end);
///     bag.write(imu, ros::imu_of(sample), sample.middle(), sample.tick);
///     bag.write(truth, ros::odometry_of(pose, velocity, angular_rate), end);
///     bag.advance(end);
///
/// The truth is no frame: SLAM and odometry set `map`, `odom` and `base_link` on `/tf`, and a frame has one parent.
/// After the first steps, only the index of the file grows. Members throw a `FileError`, and a `SettingError` for times
/// that ROS does not hold.
class DriveBag {
 public:
  /// `start_time` is the clock time at tick 0 [s].
  explicit DriveBag(std::filesystem::path path, double start_time = 0, McapSettings settings = {})
      : file_(std::move(path), std::move(settings)), start_time_(start_time) {
    file_.add_metadata("rosbag2", {});  // without it, rosbag2 expects names in the quality of service
    clock_ = add<ros::Clock>("/clock", "");
    tf_ = add<ros::TFMessage>("/tf", "");
    fixed_ = {add_channel<ros::TFMessage>("/tf_static", transient_local)};
  }

  /// Adds a topic. @throws SettingError beyond 65,535, or for a frame that begins with /, which tf2 refuses
  template <ros::RosMessage M>
  [[nodiscard]] BagTopic<M> add(std::string topic, std::string frame_id, std::string child_frame_id = {}) {
    check_frame(frame_id);
    check_frame(child_frame_id);
    return {add_channel<M>(std::move(topic), ""), std::move(frame_id), std::move(child_frame_id)};
  }

  /// Appends a message of a tick, complete at another; sets its stamp and frames.
  template <ros::RosMessage M>
  void write(const BagTopic<M>& topic, M message, const Tick& tick, const Tick& complete) {
    message.header = header(tick, topic.frame_id);
    if constexpr (std::is_same_v<M, ros::Odometry>) message.child_frame_id = topic.child_frame_id;
    if constexpr (std::is_same_v<M, ros::CustomMsg>) message.timebase = stamp(tick);
    ros::serialize(message, message_);
    keep(topic.channel, tick, complete);
  }
  /// Appends a message that is complete at its tick.
  template <ros::RosMessage M>
  void write(const BagTopic<M>& topic, const M& message, const Tick& tick) {
    write(topic, message, tick, tick);
  }
  /// Appends a scan, complete at a tick.
  void write(const BagTopic<ros::PointCloud2>& topic, const PointBuffer& scan, const Tick& complete) {
    const auto tells_clock = [](const PointField& field) { return field.column->name == "clock"; };
    if (scan.settings().start_time != start_time_ && std::ranges::any_of(scan.layout().fields, tells_clock))
      throw SettingError("PointSettings::start_time", scan.settings().start_time, "s",
                         text::joined({"that of the bag, ", text::to_text(start_time_)}));
    detail::serialize_points(scan, header(scan.scan_start(), topic.frame_id), message_);
    keep(topic.channel, scan.scan_start(), complete);
  }

  /// Sets the pose of a frame on `/tf`.
  void move(ros::TransformStamped frame, const Tick& tick) { put_frames(tf_, {&frame, 1}, tick); }
  /// Sets the poses of all fixed frames, at once, on `/tf_static`, for early and late subscribers. A drive that begins
  /// later than at tick 0 gives its first tick, as the bag begins there.
  void fix(std::vector<ros::TransformStamped> frames, const Tick& tick = {}) { put_frames(fixed_, frames, tick); }

  /// Writes all messages complete up to `end`, before which no other may come, and this to `/clock`.
  void advance(const Tick& end) {
    const std::uint64_t limit = stamp(end);
    if (limit < end_)
      throw SettingError("DriveBag::advance (end)", end.seconds(), "s", "not before that of the last advance");
    put_until(end_ = limit);
    ros::serialize(ros::Clock{ros::Time::of(end_)}, message_);
    file_.write(clock_.channel, end_, end_, message_);
  }

  /// Writes the rest, and completes the file.
  void close() {
    put_until(std::numeric_limits<std::uint64_t>::max());
    file_.close();
  }

 private:
  struct Waiting {
    std::uint64_t log_time, publish_time;  // [ns]
    std::size_t at, size;                  // place in `bytes_`
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

  template <class M>
  [[nodiscard]] std::uint16_t add_channel(std::string topic, const char* quality) {
    return file_.add_channel({.topic = std::move(topic),
                              .schema_name = ros::type_of<M>,
                              .schema = ros::definition_of<M>,
                              .metadata = {{"offered_qos_profiles", quality}}});
  }

  static void check_frame(std::string_view name) {
    if (name.starts_with('/'))
      throw SettingError("DriveBag (frame)", text::joined({" is '", name, "': expected a name that begins without /"}));
  }
  [[nodiscard]] std::uint64_t stamp(const Tick& tick) const {
    return ros::stamp_ns(start_time_, tick, "DriveBag::start_time + tick");
  }
  [[nodiscard]] ros::Header header(const Tick& tick, std::string_view frame_id) const {
    return {ros::Time::of(stamp(tick)), frame_id};
  }

  void put_frames(const BagTopic<ros::TFMessage>& topic, std::span<ros::TransformStamped> frames, const Tick& tick) {
    for (ros::TransformStamped& frame : frames) {
      check_frame(frame.header.frame_id);
      check_frame(frame.child_frame_id);
      frame.header = header(tick, frame.header.frame_id);
    }
    ros::serialize(ros::TFMessage{frames}, message_);
    keep(topic.channel, tick, tick);
  }

  /// Keeps the message until those of earlier times have come.
  void keep(std::uint16_t channel, const Tick& tick, const Tick& complete) {
    const std::uint64_t log_time = stamp(complete);
    if (log_time < end_)
      throw SettingError("DriveBag::write (time)", complete.seconds(), "s", "not before that of the last advance");
    waiting_.push_back({log_time, stamp(tick), bytes_.size(), message_.size(), channel});
    bytes_.insert(bytes_.end(), message_.begin(), message_.end());
  }

  /// Writes what is complete up to a time [ns].
  void put_until(std::uint64_t limit) {
    std::ranges::sort(waiting_, {}, [](const Waiting& w) { return std::pair(w.log_time, w.at); });
    left_.clear();
    std::size_t kept = 0;
    for (Waiting& w : waiting_) {
      const auto own = std::span(bytes_).subspan(w.at, w.size);
      if (w.log_time <= limit) {
        file_.write(w.channel, w.log_time, w.publish_time, own);
      } else {
        w.at = left_.size();
        left_.insert(left_.end(), own.begin(), own.end());
        waiting_[kept++] = w;
      }
    }
    waiting_.resize(kept);
    bytes_.swap(left_);
  }

  McapWriter file_;
  double start_time_;
  BagTopic<ros::Clock> clock_;
  BagTopic<ros::TFMessage> tf_, fixed_;
  std::vector<Waiting> waiting_;
  std::vector<std::byte> message_, bytes_, left_;  // message under construction; those that wait, and wait on
  std::uint64_t end_ = 0;                          // time up to which all is written [ns]
};

}  // namespace PULSECAST_NAMESPACE::io

#endif
