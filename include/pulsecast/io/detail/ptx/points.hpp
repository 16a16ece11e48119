// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_PTX_POINTS_HPP
#define PULSECAST_IO_DETAIL_PTX_POINTS_HPP

#include <pulsecast/base/vector.hpp>
#include <pulsecast/io/detail/text/table.hpp>
#include <pulsecast/io/format_rules.hpp>

namespace PULSECAST_NAMESPACE::io {

namespace detail {
/// Items of PTX files. Source: Leica Geosystems, PTX file format (Cyclone export).
inline constexpr std::array<FormatRule, 5> ptx_rules{{
    {"scan", FormatUse::read, "a grid of points; several may follow each other"},
    {"transform", FormatUse::read, "places the points; the last of its four rows is the translation"},
    {"scanner pose", FormatUse::noted, "differs from the transform, which places the points"},
    {"miss", FormatUse::read, "a point at 0 0 0 is left out"},
    {"colour", FormatUse::read, "red, green, blue after the intensity, from 0 to 255"},
}};
}  // namespace detail

/// Reader of the points of a PTX file: scans of columns x rows, placed by transforms. @throws FileError with path, line
class PtxPoints {
 public:
  /// True if the file begins as a scan: two lines are whole numbers, and the third is none.
  [[nodiscard]] static bool is_ptx(InputFile& file) {
    std::string_view head = text::without_byte_order_mark(file.take(64));
    const auto is_count = [&] { return text::number_in<std::uint32_t>(text::trimmed(text::take_line(head))); };
    const bool is = is_count() && is_count() && !is_count();
    file.seek(0);
    return is;
  }

  explicit PtxPoints(InputFile file) : file_(std::move(file)) {}

  /// Advances to the next point that is no miss; false at the end.
  [[nodiscard]] bool next() {
    while (left_ > 0 || read_header()) {
      if (left_ == 0) continue;
      --left_;
      (void)take(colours_ ? 7 : 3);
      if (!std::exchange(begun_, true)) colours_ = row_.cells().size() >= 7;
      if (place_ = vector(0); place_ != Vec3{}) return true;
    }
    return false;
  }

  /// Position of the current point, by the transform of its scan. Throws a `FileError` beyond 1e12.
  [[nodiscard]] Vec3 position() const {
    const Vec3 p = axes_ * place_ + translation_;
    if (!is_within(p, 1e12)) fail_here("has a point beyond 1e12 m: expected coordinates up to 1e12 m");
    return p;
  }

  [[nodiscard]] bool has_normals() const noexcept { return false; }
  [[nodiscard]] Vec3 normal() const noexcept { return {}; }
  [[nodiscard]] bool has_colours() const noexcept { return colours_; }  ///< as the first point of the file
  [[nodiscard]] Vec3 colour() const { return vector(4); }
  static constexpr double max_colour = 255;
  [[nodiscard]] bool has_class() const noexcept { return false; }
  [[nodiscard]] std::uint32_t classification() const noexcept { return 0; }
  [[nodiscard]] bool has_object() const noexcept { return false; }
  [[nodiscard]] std::uint32_t object() const noexcept { return 0; }

  /// Oddities that could still be read; complete after the last point.
  [[nodiscard]] std::vector<std::string> warnings() const { return warnings_; }
  [[noreturn]] void fail_here(const std::string& problem) const { file_.fail_at_line(problem); }
  [[nodiscard]] const std::string& path() const noexcept { return file_.path(); }

 private:
  /// Splits the next line that is not blank, into this many cells at least; false at the end.
  [[nodiscard]] bool take(std::size_t cells, bool may_end = false) {
    while (const std::optional<std::string_view> line = file_.take_line()) {
      if (text::trimmed(*line).empty()) continue;
      if (row_.split(*line, 8).size() < cells) file_.fail_at_line("has too few numbers: expected ", cells);
      return true;
    }
    if (!may_end) file_.fail("the file ends: expected ", left_ + 1, " more points, or the rest of a header");
    return false;
  }

  [[nodiscard]] double number(std::size_t column) const {
    const std::optional<double> value = text::number_in<double>(row_.cells()[column]);
    if (!value || !(std::fabs(*value) <= 1e12))
      file_.fail_at_column(column, text::quoted(row_.cells()[column]), ": expected a number within 1e12");
    return *value;
  }
  [[nodiscard]] Vec3 vector(std::size_t column) const {
    return {number(column), number(column + 1), number(column + 2)};
  }

  /// Reads the ten lines before the points of a scan; false at the end of the file.
  [[nodiscard]] bool read_header() {
    if (!take(1, true)) return false;
    const double columns = number(0);
    (void)take(1);
    const double points = columns * number(0);
    const auto room = static_cast<double>(file_.size() - file_.position());
    if (!(columns >= 0 && points >= 0 && points <= room / 6 && points == std::floor(points)))  // "0 0 0\n" [byte]
      fail_here(text::message("claims ", points, " points: expected columns and rows that fit into the file"));
    (void)take(3);
    const Vec3 scanner = vector(0);
    Matrix3 axes{1};
    for (int axis = 0; axis < 3; ++axis) {
      (void)take(3);
      axes[axis] = vector(0);
    }
    for (int row = 0; row < 4; ++row) {
      (void)take(4);
      (row < 3 ? axes_[row] : translation_) = vector(0);
      if (number(3) != (row < 3 ? 0 : 1))
        fail_here("is no row of an affine transform: expected 0 0 0 1 as the last column of the four rows");
    }
    bool differs = max_norm(scanner - translation_) > 1e-3;
    for (int axis = 0; axis < 3; ++axis) differs = differs || max_norm(axes[axis] - axes_[axis]) > 1e-3;
    if (differs) (void)keep_rule(detail::ptx_rules, path(), "item", "scanner pose", warnings_);
    left_ = static_cast<std::uint64_t>(points);
    return true;
  }

  InputFile file_;
  RowCells row_{text::blanks, true};
  std::vector<std::string> warnings_;
  Matrix3 axes_{1};
  Vec3 translation_{}, place_{};
  std::uint64_t left_ = 0;                // points of the scan
  bool begun_ = false, colours_ = false;  // at the first point
};

}  // namespace PULSECAST_NAMESPACE::io

#endif
