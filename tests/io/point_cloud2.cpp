// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/point_cloud2.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include <doctest/doctest.h>
#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>

#include <pulsecast/base/error.hpp>

#include "support/allocations.hpp"
#include "support/every_column.hpp"
#include "support/generators.hpp"

namespace pulsecast::io {
namespace {

using support::Generator;

struct Field {
  std::string name;
  std::uint32_t offset = 0;
  std::uint8_t type = 0;
  std::uint32_t count = 0;
  friend bool operator==(const Field&, const Field&) = default;
};

/// sensor_msgs/msg/PointCloud2.
struct Message {
  std::int32_t seconds = 0;
  std::uint32_t nanoseconds = 0;
  std::string frame_id;
  std::uint32_t height = 0, width = 0;
  std::vector<Field> fields;
  bool is_bigendian = false;
  std::uint32_t point_step = 0, row_step = 0;
  std::vector<std::uint8_t> data;
  bool is_dense = false;
  friend bool operator==(const Message&, const Message&) = default;
};

/// Decodes by the rules of CDR alone: a number is aligned to its size, counted from the end of the encapsulation
/// header; padding is zero.
class Rules {
 public:
  explicit Rules(const std::vector<std::byte>& message) : bytes_(message.begin() + 4, message.end()) {
    const std::vector<std::byte> header(message.begin(), message.begin() + 4);
    if (header != std::vector<std::byte>{std::byte{0}, std::byte{1}, std::byte{0}, std::byte{0}})
      throw std::runtime_error("encapsulation");
  }

  template <class Number>
  Rules& operator>>(Number& number) requires std::is_arithmetic_v<Number> {
    for (; at_ % sizeof number != 0; ++at_)
      if (bytes_.at(at_) != std::byte{0}) throw std::runtime_error("padding");
    if (at_ + sizeof number > bytes_.size()) throw std::runtime_error("end");
    std::memcpy(&number, bytes_.data() + at_, sizeof number);
    at_ += sizeof number;
    return *this;
  }

  Rules& operator>>(bool& value) {
    std::uint8_t byte = 0;
    *this >> byte;
    if (byte > 1) throw std::runtime_error("boolean");
    value = byte == 1;
    return *this;
  }

  Rules& operator>>(std::string& text) {
    std::uint32_t length = 0;
    *this >> length;
    for (text.clear(); text.size() + 1 < length; ++at_) text += static_cast<char>(bytes_.at(at_));
    if (length == 0 || bytes_.at(at_++) != std::byte{0}) throw std::runtime_error("string without its zero");
    return *this;
  }

  Rules& operator>>(std::vector<std::uint8_t>& data) {
    std::uint32_t length = 0;
    *this >> length;
    for (data.clear(); data.size() < length; ++at_) data.push_back(static_cast<std::uint8_t>(bytes_.at(at_)));
    return *this;
  }

  void end() const {
    if (at_ != bytes_.size()) throw std::runtime_error("bytes behind the message");
  }

 private:
  std::vector<std::byte> bytes_;
  std::size_t at_ = 0;
};

template <class Reader>
Message read(Reader& from) {
  Message m;
  std::uint32_t count = 0;
  from >> m.seconds >> m.nanoseconds >> m.frame_id >> m.height >> m.width >> count;
  while (m.fields.size() < count) {  // a wrong number ends with the bytes, and takes no memory before
    Field field;
    from >> field.name >> field.offset >> field.type >> field.count;
    m.fields.push_back(field);
  }
  from >> m.is_bigendian >> m.point_step >> m.row_step >> m.data >> m.is_dense;
  return m;
}

Message by_rules(const std::vector<std::byte>& message) {
  Rules rules(message);
  const Message read_message = read(rules);
  rules.end();
  return read_message;
}

Message by_fastcdr(std::vector<std::byte> message) {
  eprosima::fastcdr::FastBuffer buffer(reinterpret_cast<char*>(message.data() + 4), message.size() - 4);
  eprosima::fastcdr::Cdr cdr(buffer);
  return read(cdr);
}

/// Message that a scan should be.
Message expected(const PointBuffer& scan, const std::string& frame_id, std::int32_t seconds,
                 std::uint32_t nanoseconds) {
  const auto length = static_cast<std::uint32_t>(scan.records().size());
  Message m{seconds, nanoseconds, frame_id, 1, static_cast<std::uint32_t>(scan.size()), {}, false, scan.layout().size,
            length,  {},          true};
  for (const PointField& field : scan.layout().fields)
    m.fields.push_back({field.name, field.offset, static_cast<std::uint8_t>(field.type), 1});
  for (const std::byte b : scan.records()) m.data.push_back(static_cast<std::uint8_t>(b));
  return m;
}

/// Adds pulses with an echo each, in any direction.
void add_points(PointBuffer& points, std::size_t count, Generator& any) {
  for (std::size_t i = 0; i < count; ++i) {
    const Shot shot{
        .index = i, .direction = any.unit(), .channel = static_cast<std::uint16_t>(any.whole(16)), .echoes = 1};
    const Echo echo{.range = any.log_uniform(0.1, 1e4), .reflectance = any.uniform()};
    points({.shots = {&shot, 1}, .echoes = {&echo, 1}, .samples = {}});
  }
}

std::string any_text(std::size_t length, Generator& any) {
  std::string text;
  while (text.size() < length) text += static_cast<char>('a' + any.whole(26));
  return text;
}

/// Layout of up to 9 fields of any types, with gaps, and names of 0 to 9 letters.
PointLayout any_layout(Generator& any) {
  PointLayout layout;
  for (std::uint64_t left = 1 + any.whole(9); left > 0; --left) {
    const auto type = static_cast<NumberType>(1 + any.whole(8));
    const PointColumn* const of = &point_columns[any.whole(point_columns.size())];
    layout.size += static_cast<std::uint32_t>(any.whole(3));
    layout.fields.push_back({any_text(any.whole(10), any), type, of, 1, layout.size});
    layout.size += size_of(type);
  }
  layout.size += static_cast<std::uint32_t>(any.whole(4));
  return layout;
}

TEST_CASE("every column of the table is a field of a message, of 64-bit integers as a double") {
  const support::EveryColumn all;
  std::vector<std::byte> message, in_doubles;
  serialize_point_cloud2(all.records(), "lidar", message);
  serialize_point_cloud2(all.records(false), "lidar", in_doubles);
  CHECK(message == in_doubles);
  const Message found = by_rules(message);
  REQUIRE(found.fields.size() == point_columns.size());
  CHECK(std::string(found.data.begin(), found.data.end()) == all.bytes(all.records(false)));
  for (const Field& field : found.fields) CHECK(field.type <= 8);
}

TEST_CASE("libfastcdr, and a reader by the rules of CDR, read from a message what its scan holds") {
  std::vector<std::byte> message(3, std::byte{0xff});  // reused, so that nothing of a former message may be left in it
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    CAPTURE(seed);
    Generator any(seed);
    const double start_time = static_cast<double>(any.whole(2'000'000'000));
    PointBuffer scan(any_layout(any), {.start_time = start_time});
    const std::uint64_t number = any.whole(100'000);
    scan.begin_scan(Tick::of(number, 8));
    add_points(scan, any.whole(20), any);
    const std::string frame_id = any_text(any.whole(10), any);
    serialize_point_cloud2(scan, frame_id, message);
    const auto seconds = static_cast<std::int32_t>(start_time) + static_cast<std::int32_t>(number / 8);
    const Message told = expected(scan, frame_id, seconds, static_cast<std::uint32_t>(number % 8 * 125'000'000));
    CHECK(by_rules(message) == told);
    CHECK(by_fastcdr(message) == told);
  }
}

TEST_CASE("the reader by the rules of CDR notices whatever is wrong") {
  Generator any(1);
  PointBuffer scan(layouts::velodyne());
  add_points(scan, 3, any);
  std::vector<std::byte> good;
  serialize_point_cloud2(scan, "abcde", good);
  const Message told = by_rules(good);
  for (std::size_t i = 0; i < good.size(); ++i) {
    CAPTURE(i);
    std::vector<std::byte> bad = good;
    bad[i] ^= std::byte{4};
    const auto differs = [&] {
      try {
        return !(by_rules(bad) == told);
      } catch (const std::exception&) {
        return true;
      }
    };
    CHECK(differs());
  }
  good.push_back(std::byte{0});
  CHECK_THROWS(by_rules(good));
}

TEST_CASE("fields of the layouts of drivers have the names, places and types that their subscribers expect") {
  const auto told = [](const PointLayout& layout) {
    std::vector<std::byte> message;
    serialize_point_cloud2(PointBuffer(layout), "lidar", message);
    const Message m = by_fastcdr(message);
    std::string text;
    for (const Field& field : m.fields)
      text += field.name + ' ' + std::to_string(field.offset) + ' ' + std::to_string(field.type) + ", ";
    CHECK((m.row_step == 0 && m.width == 0 && m.data.empty()));
    return text + std::to_string(m.point_step);
  };
  const std::string xyz = "x 0 7, y 4 7, z 8 7, ", xyzi = xyz + "intensity 12 7, ";
  CHECK(told(layouts::xyzi()) == xyzi + "16");
  CHECK(told(layouts::velodyne()) == xyzi + "ring 16 4, time 18 7, 22");
  CHECK(told(layouts::hesai()) == xyzi + "ring 16 4, timestamp 18 8, 26");
  CHECK(told(layouts::livox()) == xyzi + "tag 16 2, line 17 2, timestamp 18 8, 26");
  CHECK(told(layouts::ouster()) ==
        xyz + "intensity 16 7, t 20 6, reflectivity 24 4, ring 26 4, ambient 28 4, range 32 6, 48");
  CHECK(told(layouts::autoware()) == xyz +
                                         "intensity 12 2, return_type 13 2, channel 14 4, azimuth 16 7, elevation 20 "
                                         "7, distance 24 7, time_stamp 28 6, 32");
  CHECK(told(layouts::map()) ==
        "x 0 8, y 8 8, z 16 8, reflectance 24 7, time 28 8, channel 36 4, return_number 38 2, returns 39 2, "
        "classification 40 4, object 42 6, 46");
  CHECK(told(layouts::velodyne().with(layouts::labels())) ==
        xyzi +
            "ring 16 4, time 18 7, classification 22 4, object 24 6, part 28 6, material 32 4, normal_x 34 7, normal_y "
            "38 7, " +
            "normal_z 42 7, velocity_x 46 7, velocity_y 50 7, velocity_z 54 7, 58");
}

TEST_CASE("the stamp is the start of the scan by the clock, exact to the nanosecond") {
  const auto stamp = [](double start_time, Tick start) {
    PointBuffer scan(layouts::xyzi(), {.start_time = start_time});
    scan.begin_scan(start);
    return stamp_ns(scan);
  };
  for (PulseIndex n = 0; n < 10'000; ++n) {
    CAPTURE(n);
    CHECK(stamp(1'700'000'000, Tick::of(n, 10)) == 1'700'000'000'000'000'000 + 100'000'000 * n);
    CHECK(stamp(0.25, Tick::of(n, 20)) == 250'000'000 + 50'000'000 * n);
  }
  CHECK(stamp(0, {}) == 0);
  CHECK(stamp(2'147'483'646, {0, 0.5}) == 2'147'483'646'500'000'000);
  CHECK(stamp(-2, {3, 0.5}) == 1'500'000'000);
  CHECK(stamp(5, {1, 0.9999999999}) == 7'000'000'000);  // rounded up to the next second
  CHECK_THROWS_WITH_AS(stamp(-1, {}), doctest::Contains("PointSettings::start_time + PointBuffer::scan_start is -1 s"),
                       SettingError);
  CHECK_THROWS_AS(stamp(2'147'483'647, {1, 0}), SettingError);
  CHECK_THROWS_AS(stamp(1e300, {}), SettingError);
}

TEST_CASE("the rows of a grid are those of its message, which is not dense") {
  PointBuffer scan(layouts::ouster(), {.rings = {1, 0}}, {.rows = 2, .columns = 5, .column_rate = 100});
  std::vector<std::byte> message;
  scan.begin_scan({3, 0});
  const Shot shot{.tick = {3, 0.025}, .direction = axis::forward, .channel = 0, .echoes = 1};
  const Echo echo{.range = 7};
  scan({.shots = {&shot, 1}, .echoes = {&echo, 1}, .samples = {}});
  serialize_point_cloud2(scan, "os_sensor", message);
  const Message m = by_rules(message);
  CHECK((m.height == 2 && m.width == 5 && m.row_step == 5 * 48 && m.data.size() == 2 * 5 * 48 && !m.is_dense));
  const auto y = [&](std::size_t row, std::size_t column) {
    float number;
    std::memcpy(&number, &m.data[row * m.row_step + column * m.point_step + 4], sizeof number);
    return number;
  };
  for (std::size_t row = 0; row < 2; ++row)
    for (std::size_t column = 0; column < 5; ++column)
      CHECK((row == 1 && column == 2 ? y(row, column) == 7 : std::isnan(y(row, column))));
  CHECK(by_fastcdr(message) == m);
}

TEST_CASE("points of more bytes than the message can count are refused") {
  CHECK(detail::point_cloud2_length(4'294'967'295) == 4'294'967'295);
  CHECK_THROWS_WITH_AS(static_cast<void>(detail::point_cloud2_length(4'294'967'296)),
                       doctest::Contains("as a PointCloud2"), SettingError);
}

TEST_CASE("a message that has grown to the longest scan allocates nothing") {
  Generator any(1);
  PointBuffer longest(layouts::ouster()), shorter(layouts::ouster());
  add_points(longest, 1000, any);
  add_points(shorter, 10, any);
  const std::string frame_id = "a frame whose name is longer than a short string";
  std::vector<std::byte> message;
  serialize_point_cloud2(longest, frame_id, message);
  const std::size_t before = support::allocations;
  for (int k = 0; k < 10; ++k) {
    serialize_point_cloud2(shorter, frame_id, message);
    serialize_point_cloud2(longest, frame_id, message);
  }
  CHECK(support::allocations == before);
}

}  // namespace
}  // namespace pulsecast::io
