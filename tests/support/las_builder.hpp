// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace pulsecast::support {

/// Makes LAS files byte by byte, of any version and point format, good ones and others. Written from the ASPRS LAS
/// Specification 1.4 R15; shares nothing with the readers.
struct LasBuilder {
  struct Point {
    std::array<std::int32_t, 3> stored{};  ///< coordinates in steps
    std::array<std::uint16_t, 3> colour{};
    bool withheld = false;
    unsigned kind = 0;    ///< class
    unsigned flags = 0;   ///< more bits of the flags: those of classes, from bit 0
    std::string extra{};  ///< first extra bytes
  };
  /// A variable-length record.
  struct Record {
    std::string user;
    unsigned number = 0;
    std::string body;
  };

  unsigned minor = 2, format = 3;
  std::array<double, 3> scale{0.01, 0.01, 0.01}, offset{};
  std::vector<Point> points{};
  std::size_t extra = 0;           ///< bytes after the standard ones of each point
  std::size_t records = 0;         ///< bytes between header and points
  std::vector<Record> more{};      ///< variable-length records before these
  std::vector<Record> extended{};  ///< records behind the points
  unsigned encoding = 0;           ///< global encoding

  [[nodiscard]] std::size_t header_size() const { return minor == 4 ? 375 : minor == 3 ? 235 : 227; }
  [[nodiscard]] std::size_t point_size() const {
    constexpr std::array<std::size_t, 11> sizes{20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
    return sizes.at(format) + extra;
  }

  [[nodiscard]] std::string bytes() const {
    std::string file(header_size(), '\0');
    for (const Record& record : more) file += head(record, 54) + record.body;
    file += std::string(records, '\0');
    file.replace(0, 4, "LASF");
    put(file, 24, 1, 1);
    put(file, 25, minor, 1);
    put(file, 94, header_size(), 2);
    put(file, 96, file.size(), 4);
    if (minor > 0) put(file, 6, encoding, 2);
    put(file, 100, more.size(), 4);
    put(file, 104, format, 1);
    put(file, 105, point_size(), 2);
    if (format < 6) put(file, 107, points.size(), 4);
    if (minor == 4) {
      put(file, 247, points.size(), 8);
      put(file, 255, points.size(), 8);
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      put(file, 131 + 8 * axis, std::bit_cast<std::uint64_t>(scale[axis]), 8);
      put(file, 155 + 8 * axis, std::bit_cast<std::uint64_t>(offset[axis]), 8);
    }
    for (const Point& point : points) {
      std::string record(point_size(), '\x5A');  // what a reader does not ask for may be anything
      for (std::size_t axis = 0; axis < 3; ++axis)
        put(record, 4 * axis, static_cast<std::uint32_t>(point.stored[axis]), 4);
      put(record, 14, format < 6 ? 0x09 : 0x11, 1);
      const unsigned flags = point.flags | (point.withheld ? 4U : 0U);
      put(record, 15, format < 6 ? flags << 5 | (point.kind & 31U) : flags, 1);
      if (format >= 6) put(record, 16, point.kind, 1);
      record.replace(record.size() - extra, point.extra.size(), point.extra);
      if (format >= 6) put(record, 18, 0, 2);
      constexpr std::array<std::size_t, 11> colour_at{0, 0, 20, 28, 0, 28, 0, 30, 30, 0, 30};
      for (std::size_t k = 0; k < 3 && colour_at[format] != 0; ++k)
        put(record, colour_at[format] + 2 * k, point.colour[k], 2);
      file += record;
    }
    if (minor == 4 && !extended.empty()) {
      put(file, 235, file.size(), 8);
      put(file, 243, extended.size(), 4);
      for (const Record& record : extended) file += head(record, 60) + record.body;
    }
    return file;
  }

  /// Descriptor of an extra value. Source: LAS 1.4 R15, Extra Bytes.
  static std::string descriptor(const std::string& name, unsigned type, unsigned options = 0) {
    std::string d(192, '\0');
    put(d, 2, type, 1);
    put(d, 3, options, 1);
    return d.replace(4, name.size(), name);
  }

  static std::string head(const Record& record, std::size_t size) {
    std::string h(size, '\0');
    h.replace(2, record.user.size(), record.user);
    put(h, 18, record.number, 2);
    put(h, 20, record.body.size(), size == 54 ? 2 : 8);
    return h;
  }

  /// Overwrites bytes of a file with a number, its least byte first.
  static void put(std::string& file, std::size_t at, std::uint64_t value, std::size_t size) {
    for (std::size_t i = 0; i < size; ++i) file.at(at + i) = static_cast<char>(value >> (8 * i));
  }
};

}  // namespace pulsecast::support
