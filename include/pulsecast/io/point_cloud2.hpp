// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_POINT_CLOUD2_HPP
#define PULSECAST_IO_POINT_CLOUD2_HPP

#include <pulsecast/io/ros_messages.hpp>

/// Scans as ROS 2 messages, without ROS. Recording with `io/mcap` and `io/scan_splitter`:
///
///     McapWriter bag("scans.mcap");
///     const auto points = bag.add_channel({.topic = "/points", .schema_name = point_cloud2_type,
///                                          .schema = point_cloud2_definition});
///     std::vector<std::byte> message;
///     ScanSplitter scans(PointBuffer(layouts::velodyne(), settings), 10, [&](const PointBuffer& scan) {
///       serialize_point_cloud2(scan, "lidar", message);
///       bag.write(points, stamp_ns(scan), stamp_ns(scan), message);
///     });
///     run(survey, {}, scans);
///     scans.close();
///     bag.close();
namespace PULSECAST_NAMESPACE::io {

namespace ros {

/// Field of the points of a message.
struct PointField {
  std::string_view name{};    ///< name
  std::uint32_t offset = 0;   ///< position in a point [byte]
  std::uint8_t datatype = 0;  ///< as `NumberType`
  std::uint32_t count = 1;    ///< numbers
  PULSECAST_ROS_MESSAGE("sensor_msgs/msg/PointField", name, offset, datatype, count)
};

/// Fields of a layout as those of a message, which has no 64-bit integers.
struct PointFields {
  using value_type = PointField;         ///< of the range
  std::span<const io::PointField> of{};  ///< of a layout

  [[nodiscard]] std::size_t size() const noexcept { return of.size(); }
  [[nodiscard]] PointField operator[](std::size_t i) const noexcept {
    return {of[i].name, of[i].offset, static_cast<std::uint8_t>(std::min(of[i].type, NumberType::float64))};
  }
};

/// Points: records in rows.
struct PointCloud2 {
  Header header{};                    ///< time and frame of the points
  std::uint32_t height = 1;           ///< number of rows
  std::uint32_t width = 0;            ///< points of a row
  PointFields fields{};               ///< of a point
  bool is_bigendian = false;          ///< false: little-endian
  std::uint32_t point_step = 0;       ///< size of a point [byte]
  std::uint32_t row_step = 0;         ///< size of a row [byte]
  std::span<const std::byte> data{};  ///< records
  bool is_dense = true;               ///< true if all coordinates are finite
  PULSECAST_ROS_MESSAGE("sensor_msgs/msg/PointCloud2", header, height, width, fields, is_bigendian, point_step,
                        row_step, data, is_dense)
};

}  // namespace ros

inline constexpr const char* point_cloud2_type = ros::type_of<ros::PointCloud2>;  ///< name of the message type
/// Definition of the message type and its parts, in the encoding "ros2msg".
inline constexpr const char* point_cloud2_definition = ros::definition_of<ros::PointCloud2>;

/// Start of a scan by the clock, which is the stamp of its message, to the nearest nanosecond [ns].
/// @throws SettingError for a time that ROS does not hold: before 0 s or after 2^31 - 1 s
[[nodiscard]] inline std::uint64_t stamp_ns(const PointBuffer& scan) {
  return ros::stamp_ns(scan.settings().start_time, scan.scan_start(),
                       "PointSettings::start_time + PointBuffer::scan_start");
}

namespace detail {

/// Length of the data of a message. @throws SettingError for more than its field holds
[[nodiscard]] inline std::uint32_t point_cloud2_length(std::size_t bytes) {
  const auto size = static_cast<double>(bytes);
  require_within("PointBuffer::records (size), as a PointCloud2", size, 0, 4'294'967'295, "byte");
  return static_cast<std::uint32_t>(bytes);
}

/// Writes a scan with a header: see `serialize_point_cloud2`.
inline void serialize_points(const PointBuffer& scan, const ros::Header& header, std::vector<std::byte>& message) {
  const PointLayout& layout = scan.layout();
  const std::uint32_t length = point_cloud2_length(scan.records().size()), rows = scan.grid().rows;
  const std::uint32_t height = std::max(rows, std::uint32_t{1}), row = length / height;
  const bool is_dense = rows == 0;  // echoes have finite coordinates
  ros::serialize(
      ros::PointCloud2{
          header, height, row / layout.size, {layout.fields}, false, layout.size, row, scan.records(), is_dense},
      message);
  std::byte* const data = message.data() + message.size() - sizeof is_dense - length;
  for (const PointField& field : layout.fields)  // a message has no 64-bit integers
    for (std::size_t i = 0; field.type >= NumberType::int64 && i < scan.size(); ++i)
      store_number<double>(scan.number(i, field), data + i * layout.size + field.offset);
}

}  // namespace detail

/// Writes a scan as a serialized sensor_msgs/msg/PointCloud2 into `message`: see `ros::serialize`. The scan is stamped
/// by `stamp_ns`; it is one row, or the rows of its grid, which is not dense. 64-bit integers become `float64`.
/// @throws SettingError for more than 2^32 - 1 bytes of points, and as `stamp_ns`
inline void serialize_point_cloud2(const PointBuffer& scan, const std::string& frame_id,
                                   std::vector<std::byte>& message) {
  detail::serialize_points(scan, {ros::Time::of(stamp_ns(scan)), frame_id}, message);
}

}  // namespace PULSECAST_NAMESPACE::io

#endif
