// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_LAS_POINTS_HPP
#define PULSECAST_IO_DETAIL_LAS_POINTS_HPP

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <vector>

#include <pulsecast/base/vector.hpp>
#include <pulsecast/io/input_file.hpp>

namespace PULSECAST_NAMESPACE::io {

/// Reader of the points of a LAS file, versions 1.0 to 1.4, point formats 0 to 10. Points marked as
/// withheld (deleted) are skipped; bounds in the header are ignored. Throws a `FileError` with path
/// and byte. Source: ASPRS LAS 1.4 R15, and 1.0 to 1.3 for headers.
class LasPoints {
 public:
  /// True if the file begins with the LAS signature.
  [[nodiscard]] static bool is_las(InputFile& file) {
    file.seek(0);
    const bool is = file.take(4) == "LASF";
    file.seek(0);
    return is;
  }

  explicit LasPoints(InputFile file) : file_(std::move(file)) { read_header(); }

  /// Advances to the next point; false at the end.
  [[nodiscard]] bool next() {
    while (taken_ < count_) {
      at_ = file_.position();
      record_ = file_.take(record_size_);
      if (record_.size() < record_size_)
        file_.fail_at_byte(at_, "unexpected end: the file has changed while it was read");
      ++taken_;
      if (!withheld()) return true;
      ++withheld_;
    }
    return false;
  }

  /// Position of the current point, which should be in metres. Throws a `FileError` beyond 1e12.
  [[nodiscard]] Vec3 position() const {
    Vec3 p{};
    for (int k = 0; k < 3; ++k)
      p[k] = number<std::int32_t>(record_, 4 * static_cast<std::size_t>(k)) * scale_[k] + offset_[k];
    if (!(max_norm(p) <= 1e12)) fail_here("has a point beyond 1e12 m: expected coordinates up to 1e12 m");
    return p;
  }

  [[nodiscard]] bool has_normals() const noexcept { return false; }
  [[nodiscard]] Vec3 normal() const noexcept { return {}; }
  [[nodiscard]] bool has_colours() const noexcept { return colour_at_ != 0; }

  /// Red, green and blue of the current point, from 0 to `max_colour`.
  [[nodiscard]] Vec3 colour() const noexcept {
    const auto [red, green, blue] = number<std::array<std::uint16_t, 3>>(record_, colour_at_);
    return {red, green, blue};
  }
  static constexpr double max_colour = 65535;

  /// Oddities that could still be read; complete after the last point.
  [[nodiscard]] std::vector<std::string> warnings() const {
    if (withheld_ == 0) return {};
    return {file_.path() + ": " + std::to_string(withheld_) + " of " + std::to_string(count_) +
            " points are marked as withheld and left out"};
  }

  [[noreturn]] void fail_here(const std::string& problem) const { file_.fail_at_byte(at_, problem); }
  [[nodiscard]] const std::string& path() const noexcept { return file_.path(); }

 private:
  static_assert(std::endian::native == std::endian::little,
                "LAS files are little-endian, and are read as the numbers lie in memory");

  template <class Number>
  [[nodiscard]] static Number number(std::string_view bytes, std::size_t position) noexcept {
    Number value;
    std::memcpy(&value, bytes.data() + position, sizeof value);
    return value;
  }

  [[noreturn]] void fail(std::size_t byte, std::initializer_list<std::string_view> problem) const {
    file_.fail_at_byte(byte, text::joined(problem));
  }

  void read_header() {
    constexpr std::array<std::size_t, 5> header_sizes{227, 227, 227, 235, 375};  // by minor version
    constexpr std::array<std::size_t, 11> sizes{20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
    constexpr std::array<std::size_t, 11> colours{0, 0, 20, 28, 0, 28, 0, 30, 30, 0, 30};

    const std::string bytes(file_.take(header_sizes.back()));
    if (bytes.size() < header_sizes.front())
      file_.fail_at_byte(bytes.size(), "the file ends: expected the 227 bytes of a LAS header");
    const auto major = number<std::uint8_t>(bytes, 24);
    minor_ = number<std::uint8_t>(bytes, 25);
    if (major != 1 || minor_ > 4)
      fail(24, {"is LAS ", std::to_string(major), ".", std::to_string(minor_), ": expected a version from 1.0 to 1.4"});
    const std::size_t header_size = number<std::uint16_t>(bytes, 94);
    if (header_size < header_sizes[minor_] || bytes.size() < header_sizes[minor_])
      fail(94, {"the header has ", std::to_string(std::min(header_size, bytes.size())), " bytes: expected at least ",
                std::to_string(header_sizes[minor_])});
    format_ = number<std::uint8_t>(bytes, 104);
    if (format_ >= 128)  // mark of LASzip
      fail(104, {"the points are compressed (LAZ): expected LAS; laszip and pdal translate convert it"});
    if (format_ >= sizes.size())
      fail(104, {"has the point format ", std::to_string(format_), ": expected one from 0 to 10"});
    colour_at_ = colours[format_];
    record_size_ = number<std::uint16_t>(bytes, 105);
    if (record_size_ < sizes[format_])
      fail(105, {"a point has ", std::to_string(record_size_), " bytes: expected at least the ",
                 std::to_string(sizes[format_]), " of format ", std::to_string(format_)});

    const std::uint64_t begin = number<std::uint32_t>(bytes, 96);
    count_ = minor_ == 4 ? number<std::uint64_t>(bytes, 247) : 0;
    const std::size_t count_at = count_ > 0 ? 247 : 107;
    if (count_ == 0) count_ = number<std::uint32_t>(bytes, 107);
    const std::string first = std::to_string(begin), size = std::to_string(file_.size());
    if (begin < header_size || begin > file_.size())
      fail(96, {"the points begin at byte ", first, ": expected one from ", std::to_string(header_size),
                " to the file's size of ", size});
    if (count_ == 0) file_.fail_at_byte(107, "holds no point: expected at least one");
    if (count_ > (file_.size() - begin) / record_size_)
      fail(count_at, {"claims ", std::to_string(count_), " points of ", std::to_string(record_size_),
                      " bytes from byte ", first, ": expected no more than fit into the file's ", size, " bytes"});
    scale_ = number<Vec3>(bytes, 131);
    offset_ = number<Vec3>(bytes, 155);
    for (int k = 0; k < 3; ++k) {
      const auto at = static_cast<std::size_t>(131 + 8 * k);
      if (!(scale_[k] > 0) || !std::isfinite(scale_[k]))
        file_.fail_at_byte(at, "the scale is " + text::to_text(scale_[k]) + ": expected one above 0");
      if (!std::isfinite(offset_[k]))
        file_.fail_at_byte(at + 24, "the offset is " + text::to_text(offset_[k]) + ": expected a finite one");
    }
    file_.seek(begin);
  }

  /// True if the current point is marked as withheld; LAS 1.0 has no such bit.
  [[nodiscard]] bool withheld() const noexcept {
    const auto bits = number<std::uint8_t>(record_, 15);
    return format_ >= 6 ? (bits & 4U) != 0 : minor_ > 0 && (bits & 128U) != 0;
  }

  InputFile file_;
  unsigned minor_ = 0, format_ = 0;
  std::size_t record_size_ = 0, colour_at_ = 0;  // [byte]; 0 without colours
  Vec3 scale_{}, offset_{};
  std::uint64_t count_ = 0, taken_ = 0, withheld_ = 0;
  std::uint64_t at_ = 0;  // offset of the current point [byte]
  std::string_view record_;
};

}  // namespace PULSECAST_NAMESPACE::io

#endif
