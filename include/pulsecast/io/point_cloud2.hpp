// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_POINT_CLOUD2_HPP
#define PULSECAST_IO_POINT_CLOUD2_HPP

#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>

#include <pulsecast/io/point_records.hpp>

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

/// Name of the message type.
inline constexpr const char* point_cloud2_type = "sensor_msgs/msg/PointCloud2";

/// Definition of the message type and its parts, in the encoding "ros2msg". Source: ROS 2 packages
/// sensor_msgs, std_msgs and builtin_interfaces; MCAP format registry, ros2msg.
inline constexpr const char* point_cloud2_definition = R"(std_msgs/Header header
uint32 height
uint32 width
sensor_msgs/PointField[] fields
bool is_bigendian
uint32 point_step
uint32 row_step
uint8[] data
bool is_dense
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
================================================================================
MSG: sensor_msgs/PointField
string name
uint32 offset
uint8 datatype
uint32 count
)";

/// Start of a scan by the clock, which is the stamp of its message, to the nearest nanosecond [ns].
/// @throws SettingError for a time that ROS does not hold: before 0 s or after 2^31 - 1 s
[[nodiscard]] inline std::uint64_t stamp_ns(const PointBuffer& scan) {
  const double clock = scan.settings().start_time, time = clock + scan.scan_start().seconds();
  require_within("PointSettings::start_time + PointBuffer::scan_start", time, 0, 2'147'483'647, "s");
  const Tick stamp = Tick::of_seconds(clock) + scan.scan_start();
  const long long rest = std::llround(stamp.fraction * 1e9);
  return static_cast<std::uint64_t>(stamp.second * 1'000'000'000 + rest);
}

namespace detail {

/// Encapsulation header: CDR, little-endian, no options. Source: OMG DDSI-RTPS 2.5, 10, CDR_LE.
inline constexpr std::array<std::byte, 4> cdr_encapsulation{std::byte{0}, std::byte{1}};

/// Length of the data of a message. @throws SettingError for more than its field holds
[[nodiscard]] inline std::uint32_t point_cloud2_length(std::size_t bytes) {
  const auto size = static_cast<double>(bytes);
  require_within("PointBuffer::records (size), as a PointCloud2", size, 0, 4'294'967'295, "byte");
  return static_cast<std::uint32_t>(bytes);
}

}  // namespace detail

/// Writes a scan as a serialized sensor_msgs/msg/PointCloud2 into `message`: little-endian CDR
/// after an encapsulation header, as ROS 2 sends and records it. The scan is one row, stamped by
/// `stamp_ns`; 64-bit integers become `float64`. Allocates nothing but `message`.
/// @throws SettingError for more than 2^32 - 1 bytes of points, and as `stamp_ns`
inline void serialize_point_cloud2(const PointBuffer& scan, const std::string& frame_id,
                                   std::vector<std::byte>& message) {
  const PointLayout& layout = scan.layout();
  const std::span<const std::byte> records = scan.records();
  const std::uint32_t length = detail::point_cloud2_length(records.size());
  const std::uint64_t stamp = stamp_ns(scan), nanoseconds_per_second = 1'000'000'000;
  std::size_t head = 64 + frame_id.size();  // at most, up to the data: numbers of 4 bytes are aligned
  for (const PointField& field : layout.fields) head += 24 + field.name.size();

  message.assign(detail::cdr_encapsulation.begin(), detail::cdr_encapsulation.end());
  message.reserve(message.size() + head + records.size() + 1);
  message.resize(message.size() + head);  // the padding of numbers is zero
  auto* const after = reinterpret_cast<char*>(message.data() + detail::cdr_encapsulation.size());
  eprosima::fastcdr::FastBuffer buffer(after, head);
  eprosima::fastcdr::Cdr cdr(buffer);
  cdr << static_cast<std::int32_t>(stamp / nanoseconds_per_second)
      << static_cast<std::uint32_t>(stamp % nanoseconds_per_second) << frame_id;
  cdr << std::uint32_t{1} << static_cast<std::uint32_t>(scan.size());  // height, width
  cdr << static_cast<std::uint32_t>(layout.fields.size());
  for (const PointField& field : layout.fields)
    cdr << field.name << field.offset << static_cast<std::uint8_t>(std::min(field.type, NumberType::float64))
        << std::uint32_t{1};
  cdr << false << layout.size << length << length;  // is_bigendian, point_step, row_step, data
  message.resize(detail::cdr_encapsulation.size() + cdr.getSerializedDataLength());
  const std::size_t data = message.size();
  message.insert(message.end(), records.begin(), records.end());
  for (const PointField& field : layout.fields)  // a message has no 64-bit integers
    for (std::size_t i = 0; field.type >= NumberType::int64 && i < scan.size(); ++i) {
      std::byte* const at = message.data() + data + i * layout.size + field.offset;
      detail::store_number<double>(scan.number(i, field), at);
    }
  message.push_back(std::byte{1});  // is_dense: echoes have finite coordinates
}

}  // namespace PULSECAST_NAMESPACE::io

#endif
