// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace pulsecast::support {

/// A value that stands after the standard ones of each point.
struct LasExtraField {
  std::string name, description;
  std::uint8_t type = 0;   ///< 1 to 10: uint8, int8, uint16, int16, uint32, int32, uint64, int64, float, double
  std::size_t offset = 0;  ///< from the beginning of the point record
};

struct LasPoint {
  std::array<std::int32_t, 3> stored{};  ///< coordinates in steps
  std::array<double, 3> place{};         ///< coordinates [m]
  unsigned intensity = 0, return_number = 0, returns = 0, flags = 0, channel = 0, scan_direction = 0, edge = 0, classification = 0,
           user_data = 0, source = 0;
  double scan_angle_deg = 0, gps_time = 0;
  std::string bytes;  ///< the whole record
};

struct LasFile {
  unsigned global_encoding = 0, day = 0, year = 0;
  std::string system, software, wkt;
  unsigned epsg = 0;  ///< of GeoTIFF keys
  std::array<double, 3> scale{}, offset{}, min{}, max{};
  std::uint64_t points_at = 0;  ///< byte at which the points begin
  std::array<std::uint64_t, 15> by_return{};
  std::vector<LasExtraField> extras;
  std::vector<LasPoint> points;

  [[nodiscard]] const LasExtraField& extra(const std::string& name) const {
    for (const LasExtraField& field : extras)
      if (field.name == name) return field;
    throw std::runtime_error("no extra field " + name);
  }
};

namespace detail {

/// Numbers from bytes, whatever the order of bytes in this computer.
class LasInput {
 public:
  explicit LasInput(std::string bytes) : bytes_(std::move(bytes)) {}

  [[nodiscard]] std::size_t size() const { return bytes_.size(); }
  [[nodiscard]] std::string bytes(std::size_t at, std::size_t n) const {
    if (at + n > bytes_.size()) throw std::runtime_error("the file ends before byte " + std::to_string(at + n));
    return bytes_.substr(at, n);
  }
  [[nodiscard]] std::uint64_t whole(std::size_t at, std::size_t n) const {
    const std::string b = bytes(at, n);
    std::uint64_t value = 0;
    for (std::size_t i = n; i-- > 0;) value = value * 256 + static_cast<unsigned char>(b[i]);
    return value;
  }
  [[nodiscard]] double real(std::size_t at) const { return std::bit_cast<double>(whole(at, 8)); }
  [[nodiscard]] std::string text(std::size_t at, std::size_t n) const {
    const std::string b = bytes(at, n);
    return b.substr(0, b.find('\0'));
  }

 private:
  std::string bytes_;
};

inline void las_expect(bool condition, const std::string& what) {
  if (!condition) throw std::runtime_error("not a good LAS file: " + what);
}

}  // namespace detail

/// The value of an extra field as a whole number (types 1, 3, 5, 7).
[[nodiscard]] inline std::uint64_t las_whole(const LasFile& file, const LasPoint& point, const std::string& name) {
  const LasExtraField& field = file.extra(name);
  detail::las_expect(field.type % 2 == 1 && field.type < 8, name + " is not an unsigned number");
  return detail::LasInput(point.bytes).whole(field.offset, std::size_t{1} << (field.type / 2));
}

/// The value of an extra field as a real number (types 9 and 10).
[[nodiscard]] inline double las_real(const LasFile& file, const LasPoint& point, const std::string& name) {
  const LasExtraField& field = file.extra(name);
  const detail::LasInput input(point.bytes);
  if (field.type == 10) return input.real(field.offset);
  detail::las_expect(field.type == 9, name + " is not a real number");
  return double{std::bit_cast<float>(static_cast<std::uint32_t>(input.whole(field.offset, 4)))};
}

/// Reads a LAS 1.4 file of point format 6 and checks all that it says twice: sizes against the file's length, numbers and bounds in the
/// header against the points, return numbers against their count. Throws `std::runtime_error` at the first thing that is not so.
/// Written from the ASPRS LAS Specification 1.4 R15; shares nothing with the writer.
[[nodiscard]] inline LasFile read_las(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  detail::las_expect(stream.good(), "cannot be opened");
  const detail::LasInput in(std::string(std::istreambuf_iterator<char>(stream), {}));
  using detail::las_expect;

  LasFile file;
  las_expect(in.bytes(0, 4) == "LASF", "signature");
  las_expect(in.whole(24, 1) == 1 && in.whole(25, 1) == 4, "version");
  las_expect(in.whole(94, 2) == 375, "header size");
  las_expect(in.whole(104, 1) == 6, "point format");
  file.global_encoding = static_cast<unsigned>(in.whole(6, 2));
  las_expect((file.global_encoding & ~17U) == 0, "global encoding claims what is not there");
  file.system = in.text(26, 32), file.software = in.text(58, 32);
  file.day = static_cast<unsigned>(in.whole(90, 2)), file.year = static_cast<unsigned>(in.whole(92, 2));
  for (std::size_t at = 107; at < 131; at += 4) las_expect(in.whole(at, 4) == 0, "legacy numbers are not zero");
  las_expect(in.whole(227, 8) == 0 && in.whole(235, 8) == 0 && in.whole(243, 4) == 0, "waveforms or extended records");
  for (std::size_t axis = 0; axis < 3; ++axis) {
    file.scale[axis] = in.real(131 + 8 * axis), file.offset[axis] = in.real(155 + 8 * axis);
    file.max[axis] = in.real(179 + 16 * axis), file.min[axis] = in.real(187 + 16 * axis);
    las_expect(file.scale[axis] > 0, "scale");
  }

  const std::size_t record = in.whole(105, 2);
  std::size_t at = 375, expected_record = 30;
  for (std::uint64_t i = in.whole(100, 4); i > 0; --i) {
    const std::string user = in.text(at + 2, 16);
    const std::uint64_t id = in.whole(at + 18, 2);
    const std::size_t length = in.whole(at + 20, 2), body = at + 54;
    las_expect(in.whole(at, 2) == 0, "reserved bytes");
    if (user == "LASF_Projection" && id == 2112) {
      file.wkt = in.bytes(body, length);
      las_expect(!file.wkt.empty() && file.wkt.back() == '\0', "the WKT has no end");
      file.wkt.pop_back();
    } else if (user == "LASF_Projection" && id == 34735) {
      las_expect(length % 8 == 0 && length >= 8 && in.whole(body, 2) == 1 && in.whole(body + 6, 2) == length / 8 - 1, "GeoTIFF keys");
      for (std::size_t k = body + 8; k < body + length; k += 8) {
        las_expect(in.whole(k + 2, 2) == 0 && in.whole(k + 4, 2) == 1, "a GeoTIFF key that is not read here");
        las_expect(k == body + 8 || in.whole(k, 2) > in.whole(k - 8, 2), "GeoTIFF keys are not in order");
        if (in.whole(k, 2) == 3072) file.epsg = static_cast<unsigned>(in.whole(k + 6, 2));
        if (in.whole(k, 2) == 1024) las_expect(in.whole(k + 6, 2) == 1, "not a projected reference system");
        if (in.whole(k, 2) == 3076) las_expect(in.whole(k + 6, 2) == 9001, "not in metres");
      }
    } else if (user == "LASF_Spec" && id == 4) {
      las_expect(length % 192 == 0, "extra bytes record");
      for (std::size_t d = body; d < body + length; d += 192) {
        constexpr std::array<std::size_t, 11> sizes{0, 1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
        las_expect(in.whole(d, 2) == 0 && in.whole(d + 3, 1) == 0, "options of an extra field that are not read here");
        const auto type = static_cast<std::uint8_t>(in.whole(d + 2, 1));
        las_expect(type >= 1 && type <= 10, "type of an extra field");
        file.extras.push_back({in.text(d + 4, 32), in.text(d + 160, 32), type, expected_record});
        expected_record += sizes[type];
      }
    } else {
      las_expect(false, "unknown record " + user);
    }
    at = body + length;
  }
  file.points_at = in.whole(96, 4);
  las_expect(at == file.points_at, "points do not begin where the records end");
  las_expect(record == expected_record, "record length");
  las_expect(((file.global_encoding & 16U) != 0) == (file.epsg == 0), "the WKT bit belongs to format 6, unless there are GeoTIFF keys");
  const std::uint64_t count = in.whole(247, 8);
  las_expect(in.size() >= at && (in.size() - at) % record == 0 && (in.size() - at) / record == count, "number of points");

  std::array<std::uint64_t, 15> counted{};
  std::array<std::int32_t, 3> least{}, most{};
  file.points.reserve(count);
  for (; at < in.size(); at += record) {
    LasPoint p;
    p.bytes = in.bytes(at, record);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      p.stored[axis] = static_cast<std::int32_t>(in.whole(at + 4 * axis, 4));
      p.place[axis] = p.stored[axis] * file.scale[axis] + file.offset[axis];
      least[axis] = file.points.empty() ? p.stored[axis] : std::min(least[axis], p.stored[axis]);
      most[axis] = file.points.empty() ? p.stored[axis] : std::max(most[axis], p.stored[axis]);
    }
    p.intensity = static_cast<unsigned>(in.whole(at + 12, 2));
    const auto numbers = static_cast<unsigned>(in.whole(at + 14, 1)), bits = static_cast<unsigned>(in.whole(at + 15, 1));
    p.return_number = numbers % 16, p.returns = numbers / 16;
    p.flags = bits % 16, p.channel = bits / 16 % 4, p.scan_direction = bits / 64 % 2, p.edge = bits / 128;
    p.classification = static_cast<unsigned>(in.whole(at + 16, 1));
    p.user_data = static_cast<unsigned>(in.whole(at + 17, 1));
    p.scan_angle_deg = static_cast<std::int16_t>(in.whole(at + 18, 2)) * 0.006;
    p.source = static_cast<unsigned>(in.whole(at + 20, 2));
    p.gps_time = in.real(at + 22);
    las_expect(p.return_number >= 1 && p.return_number <= p.returns, "return number");
    las_expect(std::fabs(p.scan_angle_deg) <= 180 + 1e-9, "scan angle");
    ++counted[p.return_number - 1];
    file.points.push_back(std::move(p));
  }
  for (std::size_t i = 0; i < 15; ++i) {
    file.by_return[i] = in.whole(255 + 8 * i, 8);
    las_expect(file.by_return[i] == counted[i], "number of points of return " + std::to_string(i + 1));
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const bool empty = file.points.empty();
    const auto fits = [&](double bound, std::int32_t stored) {  // to rounding, not to a step
      const double error = empty ? bound : bound - (stored * file.scale[axis] + file.offset[axis]);
      return std::fabs(error) <= 1e-15 * (std::fabs(bound) + std::fabs(file.offset[axis]));
    };
    las_expect(fits(file.min[axis], least[axis]) && fits(file.max[axis], most[axis]), "bounds");
  }
  return file;
}

}  // namespace pulsecast::support
