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
#include <map>
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

/// Where in a file of packets the waveform of a point is. Source: LAS 1.4 R15, Point Data Record Format 4.
struct LasWavePacket {
  unsigned descriptor = 0;  ///< 0 if there is none
  std::uint64_t offset = 0, size = 0;
  double location_ps = 0;             ///< from the anchor to the return
  std::array<double, 3> direction{};  ///< [m/ps]
};

/// How the packets of a kind are to be read.
struct LasWaveDescriptor {
  unsigned index = 0, bits = 0;
  std::uint64_t samples = 0, spacing_ps = 0;
  double gain = 0, offset = 0;
};

struct LasPoint {
  std::array<std::int32_t, 3> stored{};  ///< coordinates in steps
  std::array<double, 3> place{};         ///< coordinates [m]
  unsigned intensity = 0, return_number = 0, returns = 0, flags = 0, channel = 0, scan_direction = 0, edge = 0,
           classification = 0, user_data = 0, source = 0;
  double scan_angle_deg = 0, gps_time = 0;
  std::array<unsigned, 4> colour{};  ///< red, green, blue, near infrared; 0 where the format has none
  LasWavePacket wave;
  std::string bytes;  ///< the whole record
};

struct LasFile {
  unsigned minor = 0, format = 0, global_encoding = 0, day = 0, year = 0;
  std::string system, software, wkt;
  unsigned epsg = 0;                    ///< of GeoTIFF keys
  std::map<unsigned, unsigned> keys{};  ///< GeoTIFF keys
  std::array<double, 3> scale{}, offset{}, min{}, max{};
  std::uint64_t points_at = 0;  ///< byte at which the points begin
  std::array<std::uint64_t, 15> by_return{};
  std::vector<LasExtraField> extras;
  std::vector<LasWaveDescriptor> descriptors;
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
  [[nodiscard]] double short_real(std::size_t at) const {
    return double{std::bit_cast<float>(static_cast<std::uint32_t>(whole(at, 4)))};
  }
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
  return input.short_real(field.offset);
}

namespace detail {

/// Reader of a LAS file from beginning to end.
class LasReader {
 public:
  explicit LasReader(std::string bytes) : in_(std::move(bytes)) {}

  [[nodiscard]] LasFile read() {
    read_header();
    record_ = in_.whole(105, 2);
    standard_ = (old_ ? 28 : 30) +
                (file_.format == 7   ? 6U
                 : file_.format == 8 ? 8U
                                     : 0U) +
                std::size_t{waves_ ? 29U : 0U};
    expected_record_ = standard_;
    at_ = file_.minor == 0 ? 227 : 375;
    read_records();
    check_beginning();
    for (; at_ < in_.size(); at_ += record_) read_point();
    check_counts();
    check_bounds();
    return std::move(file_);
  }

 private:
  void read_header() {
    las_expect(in_.bytes(0, 4) == "LASF", "signature");
    file_.minor = static_cast<unsigned>(in_.whole(25, 1));
    file_.format = static_cast<unsigned>(in_.whole(104, 1));
    las_expect(in_.whole(24, 1) == 1 && (file_.minor == 0 || file_.minor == 4), "version");
    las_expect(in_.whole(94, 2) == (file_.minor == 0 ? 227 : 375), "header size");
    las_expect(
        file_.format == 1 || (file_.minor == 4 && (file_.format == 4 || (file_.format >= 6 && file_.format <= 9))),
        "point format");
    old_ = file_.format < 6;
    waves_ = file_.format == 4 || file_.format == 9;
    file_.global_encoding = static_cast<unsigned>(in_.whole(6, 2));
    las_expect((file_.global_encoding & ~(waves_ ? 21U : 17U)) == 0, "global encoding claims what is not there");
    las_expect(!waves_ || (file_.global_encoding & 4U) != 0, "waveforms are neither here nor there");
    las_expect(file_.minor == 4 || in_.whole(4, 4) == 0, "reserved bytes");
    file_.system = in_.text(26, 32);
    file_.software = in_.text(58, 32);
    file_.day = static_cast<unsigned>(in_.whole(90, 2));
    file_.year = static_cast<unsigned>(in_.whole(92, 2));
    for (std::size_t at = 107; !old_ && at < 131; at += 4)
      las_expect(in_.whole(at, 4) == 0, "legacy numbers are not zero");
    if (file_.minor == 4)
      las_expect(in_.whole(227, 8) == 0 && in_.whole(235, 8) == 0 && in_.whole(243, 4) == 0,
                 "waveforms inside, or extended records");
    for (std::size_t axis = 0; axis < 3; ++axis) {
      file_.scale[axis] = in_.real(131 + 8 * axis);
      file_.offset[axis] = in_.real(155 + 8 * axis);
      file_.max[axis] = in_.real(179 + 16 * axis);
      file_.min[axis] = in_.real(187 + 16 * axis);
      las_expect(file_.scale[axis] > 0, "scale");
    }
  }

  void read_records() {
    for (std::uint64_t i = in_.whole(100, 4); i > 0; --i) {
      const std::string user = in_.text(at_ + 2, 16);
      const std::uint64_t id = in_.whole(at_ + 18, 2);
      const std::size_t length = in_.whole(at_ + 20, 2), body = at_ + 54;
      las_expect(in_.whole(at_, 2) == (file_.minor == 0 ? 0xAABB : 0), "record signature, or reserved bytes");
      if (user == "LASF_Projection" && id == 2112) {
        file_.wkt = in_.bytes(body, length);
        las_expect(!file_.wkt.empty() && file_.wkt.back() == '\0', "the WKT has no end");
        file_.wkt.pop_back();
      } else if (user == "LASF_Projection" && id == 34735) {
        read_keys(body, length);
      } else if (user == "LASF_Spec" && id == 4) {
        read_extra_fields(body, length);
      } else if (user == "LASF_Spec" && id >= 100 && id < 355) {
        las_expect(waves_ && length == 26 && in_.whole(body + 1, 1) == 0, "waveform descriptor");
        file_.descriptors.push_back({static_cast<unsigned>(id - 99), static_cast<unsigned>(in_.whole(body, 1)),
                                     in_.whole(body + 2, 4), in_.whole(body + 6, 4), in_.real(body + 10),
                                     in_.real(body + 18)});
      } else if (user == "LASF_Spec" && id == 7) {
        las_expect(waves_, "room for descriptors");
      } else {
        las_expect(false, "unknown record " + user);
      }
      at_ = body + length;
    }
  }

  void read_keys(std::size_t body, std::size_t length) {
    las_expect(length % 8 == 0 && length >= 8 && in_.whole(body, 2) == 1 && in_.whole(body + 6, 2) == length / 8 - 1,
               "GeoTIFF keys");
    for (std::size_t k = body + 8; k < body + length; k += 8) {
      las_expect(in_.whole(k + 2, 2) == 0 && in_.whole(k + 4, 2) == 1, "a GeoTIFF key that is not read here");
      las_expect(k == body + 8 || in_.whole(k, 2) > in_.whole(k - 8, 2), "GeoTIFF keys are not in order");
      file_.keys[static_cast<unsigned>(in_.whole(k, 2))] = static_cast<unsigned>(in_.whole(k + 6, 2));
      if (in_.whole(k, 2) == 1024) las_expect(in_.whole(k + 6, 2) == 1, "not a projected reference system");
    }
    file_.epsg = file_.keys[3072];
  }

  void read_extra_fields(std::size_t body, std::size_t length) {
    las_expect(length % 192 == 0, "extra bytes record");
    for (std::size_t d = body; d < body + length; d += 192) {
      constexpr std::array<std::size_t, 11> sizes{0, 1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
      las_expect(in_.whole(d, 2) == 0 && in_.whole(d + 3, 1) == 0, "options of an extra field that are not read here");
      const auto type = static_cast<std::uint8_t>(in_.whole(d + 2, 1));
      las_expect(type >= 1 && type <= 10, "type of an extra field");
      file_.extras.push_back({in_.text(d + 4, 32), in_.text(d + 160, 32), type, expected_record_});
      expected_record_ += sizes[type];
    }
  }

  /// Checks that points begin where the records end, and are as many as the header says.
  void check_beginning() {
    if (file_.minor == 0) {
      las_expect(in_.whole(at_, 2) == 0xCCDD, "point data start signature");
      at_ += 2;
    }
    file_.points_at = in_.whole(96, 4);
    las_expect(at_ == file_.points_at, "points do not begin where the records end");
    las_expect(record_ == expected_record_, "record length");
    const bool wkt_bit = (file_.global_encoding & 16U) != 0;
    las_expect(wkt_bit == (!old_ || !file_.wkt.empty()), "the WKT bit belongs to formats 6 to 10, and to text");
    las_expect(old_ || file_.keys.empty(), "GeoTIFF keys do not belong to formats 6 to 10");
    const std::uint64_t count = file_.minor == 0 ? in_.whole(107, 4) : in_.whole(247, 8);
    las_expect(!old_ || in_.whole(107, 4) == count, "legacy number of points");
    las_expect(in_.size() >= at_ && (in_.size() - at_) % record_ == 0 && (in_.size() - at_) / record_ == count,
               "number of points");
    file_.points.reserve(count);
  }

  void read_point() {
    LasPoint p;
    p.bytes = in_.bytes(at_, record_);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      p.stored[axis] = static_cast<std::int32_t>(in_.whole(at_ + 4 * axis, 4));
      p.place[axis] = p.stored[axis] * file_.scale[axis] + file_.offset[axis];
      least_[axis] = file_.points.empty() ? p.stored[axis] : std::min(least_[axis], p.stored[axis]);
      most_[axis] = file_.points.empty() ? p.stored[axis] : std::max(most_[axis], p.stored[axis]);
    }
    p.intensity = static_cast<unsigned>(in_.whole(at_ + 12, 2));
    p.user_data = static_cast<unsigned>(in_.whole(at_ + 17, 1));
    read_fields(p);
    if (const std::size_t w = at_ + standard_ - 29; waves_) {
      p.wave = {
          static_cast<unsigned>(in_.whole(w, 1)), in_.whole(w + 1, 8), in_.whole(w + 9, 4), in_.short_real(w + 13), {}};
      for (std::size_t axis = 0; axis < 3; ++axis) p.wave.direction[axis] = in_.short_real(w + 17 + 4 * axis);
    }
    las_expect(p.return_number >= 1 && p.return_number <= p.returns, "return number");
    las_expect(std::fabs(p.scan_angle_deg) <= (old_ ? 90 : 180) + 1e-9, "scan angle");
    ++counted_[p.return_number - 1];
    file_.points.push_back(std::move(p));
  }

  /// Fields behind the intensity, which depend on the format.
  void read_fields(LasPoint& p) const {
    const auto numbers = static_cast<unsigned>(in_.whole(at_ + 14, 1)),
               byte_15 = static_cast<unsigned>(in_.whole(at_ + 15, 1));
    if (old_) {
      p.return_number = numbers % 8;
      p.returns = numbers / 8 % 8;
      p.scan_direction = numbers / 64 % 2;
      p.edge = numbers / 128;
      p.classification = byte_15 % 32;
      p.flags = byte_15 / 32;
      p.scan_angle_deg = static_cast<std::int8_t>(in_.whole(at_ + 16, 1));
      p.source = static_cast<unsigned>(in_.whole(at_ + 18, 2));
      p.gps_time = in_.real(at_ + 20);
    } else {
      p.return_number = numbers % 16;
      p.returns = numbers / 16;
      p.flags = byte_15 % 16;
      p.channel = byte_15 / 16 % 4;
      p.scan_direction = byte_15 / 64 % 2;
      p.edge = byte_15 / 128;
      p.classification = static_cast<unsigned>(in_.whole(at_ + 16, 1));
      p.scan_angle_deg = static_cast<std::int16_t>(in_.whole(at_ + 18, 2)) * 0.006;
      p.source = static_cast<unsigned>(in_.whole(at_ + 20, 2));
      p.gps_time = in_.real(at_ + 22);
      for (std::size_t c = 0; c < (file_.format == 7 ? 3U : file_.format == 8 ? 4U : 0U); ++c)
        p.colour[c] = static_cast<unsigned>(in_.whole(at_ + 30 + 2 * c, 2));
    }
  }

  void check_counts() {
    for (std::size_t i = 0; i < (file_.minor == 0 ? 5 : 15); ++i) {
      file_.by_return[i] = file_.minor == 0 ? in_.whole(111 + 4 * i, 4) : in_.whole(255 + 8 * i, 8);
      las_expect(!old_ || i >= 5 || in_.whole(111 + 4 * i, 4) == counted_[i],
                 "legacy number of points of return " + std::to_string(i + 1));
      las_expect(file_.by_return[i] == counted_[i], "number of points of return " + std::to_string(i + 1));
    }
  }

  void check_bounds() const {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const bool empty = file_.points.empty();
      const auto fits = [&](double bound, std::int32_t stored) {  // to rounding, not to a step
        const double error = empty ? bound : bound - (stored * file_.scale[axis] + file_.offset[axis]);
        return std::fabs(error) <= 1e-15 * (std::fabs(bound) + std::fabs(file_.offset[axis]));
      };
      las_expect(fits(file_.min[axis], least_[axis]) && fits(file_.max[axis], most_[axis]), "bounds");
    }
  }

  LasInput in_;
  LasFile file_;
  bool old_ = false, waves_ = false;                             ///< of the format's points
  std::size_t record_ = 0, standard_ = 0, expected_record_ = 0;  ///< sizes of a point [byte]
  std::size_t at_ = 0;
  std::array<std::uint64_t, 15> counted_{};
  std::array<std::int32_t, 3> least_{}, most_{};
};

}  // namespace detail

/// Reads a LAS file, version 1.4 with point format 1, 4 or 6 to 9 or version 1.0 with point format 1, and checks all
/// that it says twice: sizes against the file's length, numbers and bounds in the header against the points, return
/// numbers against their count. Throws `std::runtime_error` at the first thing that is not so. Written from the ASPRS
/// LAS Specification 1.4 R15; shares nothing with the writer.
[[nodiscard]] inline LasFile read_las(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  detail::las_expect(stream.good(), "cannot be opened");
  return detail::LasReader(std::string(std::istreambuf_iterator<char>(stream), {})).read();
}

}  // namespace pulsecast::support
