// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_TEXT_POINTS_HPP
#define PULSECAST_IO_DETAIL_TEXT_POINTS_HPP

#include <pulsecast/base/vector.hpp>
#include <pulsecast/io/detail/ply/rules.hpp>
#include <pulsecast/io/detail/text/table.hpp>
#include <pulsecast/io/detail/text/text_point_columns.hpp>

namespace PULSECAST_NAMESPACE::io {

/// Reader of a text of points, one a row. Blank rows, and those that begin with `//` or `#`, are
/// skipped; so is, with a warning, a first row that is a whole number, as a count, or has no
/// number, as the names of columns. If such a row or comment has the names x, y and z, then columns
/// are by names, unless the settings have others than by default, which is noted where they differ. Default separators
/// are semicolons if the first row has any, else commas, else blanks, several as one. Blanks around a cell are ignored.
/// The first row decides on normals and colours. Throws a `FileError` with path, line and column.
class TextPoints {
 public:
  TextPoints(InputFile file, TextPointColumns columns)
      : file_(std::move(file)), columns_(validated(std::move(columns))) {}

  /// Advances to the next point; false at the end.
  [[nodiscard]] bool next() {
    while (const std::optional<std::string_view> line = file_.take_line()) {
      const std::string_view text = text::trimmed(*line);
      if (text.empty()) continue;
      if (text.front() == '#' || text.starts_with("//")) {
        const std::size_t begin = text.find_first_not_of("#/ \t");
        if (!begun_ && begin != text.npos) (void)takes_names(text.substr(begin));
        continue;
      }
      if (!begun_ && is_heading(text)) continue;
      if (!begun_) {
        begin(text);
      } else {
        cells_.split(text, needed_);
        if (cells().size() < needed_) too_few();
      }
      cut_ = file_.line_is_open();
      ++points_;
      return true;
    }
    return false;
  }

  /// Of the current point, in coordinates of the file.
  [[nodiscard]] Vec3 position() const { return vector(columns_.position); }
  [[nodiscard]] bool has_normals() const noexcept { return columns_.normal.has_value(); }
  [[nodiscard]] Vec3 normal() const { return vector(*columns_.normal); }
  [[nodiscard]] bool has_colours() const noexcept { return columns_.colour.has_value(); }
  [[nodiscard]] Vec3 colour() const { return vector(*columns_.colour); }
  static constexpr double max_colour = 255;  ///< default
  [[nodiscard]] bool has_class() const noexcept { return class_.has_value(); }
  [[nodiscard]] std::uint32_t classification() const { return whole(*class_); }
  [[nodiscard]] bool has_object() const noexcept { return object_.has_value(); }
  [[nodiscard]] std::uint32_t object() const { return whole(*object_); }

  /// Oddities that could still be read; complete after the last point.
  [[nodiscard]] std::vector<std::string> warnings() const {
    std::vector<std::string> all = notes_;
    if (count_ && *count_ != points_)
      all.push_back(detail::warning(path(), 0, "announces ", *count_, " points and has ", points_));
    if (cut_) all.push_back(file_.path() + ": the last line has no line end: the file may be truncated");
    return all;
  }

  [[noreturn]] void fail_here(const std::string& problem) const { file_.fail_at_line(problem); }
  [[nodiscard]] const std::string& path() const noexcept { return file_.path(); }

 private:
  using Columns = TextPointColumns::Columns;

  [[nodiscard]] const std::vector<std::string_view>& cells() const noexcept { return cells_.cells(); }

  void note(const std::string& oddity) {
    notes_.push_back(text::joined({file_.path(), ", line ", std::to_string(file_.line()), ": ", oddity}));
  }

  /// Splits a row by the separators of the settings, or those that it has.
  void split(std::string_view text) {
    std::string separators = columns_.separators;
    if (separators.empty()) {
      const auto has = [&](char c) { return text.find(c) != text.npos; };
      separators = has(';') ? ";" : has(',') ? "," : text::blanks;
    }
    cells_ = RowCells(separators, true);
    cells_.split(text, TextPointColumns::max_column + 1);
  }

  /// Takes the columns of a row of names, if it has x, y and z; false otherwise. Those of the settings go first.
  [[nodiscard]] bool takes_names(std::string_view text) {
    split(text);
    detail::PointNames names;
    std::size_t named = 0;
    for (std::size_t k = 0; k < cells().size(); ++k) {
      names.add(cells()[k], k);
      if (!cells()[k].empty()) named = k + 1;
    }
    const TextPointColumns usual;
    const bool is_usual = columns_.position == usual.position &&
                          columns_.normal.value_or(*usual.normal) == usual.normal &&
                          columns_.colour.value_or(*usual.colour) == usual.colour;
    if (!names.vector(0)) {
      if (names.refused) fail_here(text::message(text::quoted(text), ": expected ", names.refused->meaning));
      return false;
    }
    if (!is_usual) {
      const auto differs = [](const auto& set, const auto& of_name) { return set && of_name && *set != *of_name; };
      if (names.vector(0) != columns_.position || differs(columns_.normal, names.vector(3)) ||
          differs(columns_.colour, names.vector(6)))
        note(text::quoted(text) + " names other columns than the settings, which are taken");
      return true;
    }
    named_ = named;
    columns_.position = *names.vector(0);
    if (columns_.normal) columns_.normal = names.vector(3);
    if (columns_.colour) columns_.colour = names.vector(6);
    class_ = names.column[9];
    object_ = names.column[10];
    return true;
  }

  /// True for a first row that is a count of points or has the names of columns. Notes it.
  [[nodiscard]] bool is_heading(std::string_view text) {
    if (std::exchange(has_heading_, true)) return false;
    if (std::ranges::any_of(text, [](unsigned char c) { return c < ' ' && c != '\t'; })) return false;
    split(text);
    const bool is_count = cells().size() == 1 && text::number_in<std::uint64_t>(text);
    const auto is_number = [](auto cell) { return text::number_in<double>(cell) || cell == "nan"; };
    const bool has_number = std::ranges::any_of(cells(), is_number);
    if (!is_count && (has_number || cells().size() < 3)) return false;
    if (is_count) count_ = text::number_in<std::uint64_t>(text);
    if (is_count || takes_names(text)) return true;
    note(text::quoted(text) + " is skipped, as names of columns");
    return true;
  }

  /// Detects the separators and columns from the first row.
  void begin(std::string_view text) {
    split(text);
    const auto last = [](const Columns& columns) { return std::ranges::max(columns) + 1; };
    needed_ = last(columns_.position);
    if (cells().size() < needed_) too_few();
    if (cells().size() < named_) note(text::message("has ", cells().size(), " columns, and ", named_, " are named"));
    for (std::optional<Columns>* columns : {&columns_.normal, &columns_.colour}) {
      if (*columns && cells().size() < last(**columns)) columns->reset();
      if (*columns) needed_ = std::max(needed_, last(**columns));
    }
    for (const std::optional<std::size_t>& column : {class_, object_}) {
      if (column && cells().size() <= *column) too_few();
      if (column) needed_ = std::max(needed_, *column + 1);
    }
    begun_ = true;
    if (const double size = has_normals() ? length(normal()) : 0; size > 0 && std::fabs(size - 1) > 0.1)
      note(text::message("has a normal of length ", size, " in the columns from ", (*columns_.normal)[0] + 1,
                         " on: expected about 1, unless these are not normals"));
  }

  [[nodiscard]] Vec3 vector(const Columns& of) const { return {number(of[0]), number(of[1]), number(of[2])}; }

  [[nodiscard]] double number(std::size_t column) const {
    const std::optional<double> value = text::number_in<double>(cells()[column]);
    if (value && std::fabs(*value) <= 1e12) return *value;
    if (std::ranges::any_of(cells()[column], [](unsigned char c) { return c < ' ' && c != '\t'; }))
      fail_here("holds binary data: expected the text of a point cloud");
    file_.fail_at_column(
        column, text::quoted(cells()[column]) + ": expected a finite number, with a decimal point, within 1e12");
  }

  [[nodiscard]] std::uint32_t whole(std::size_t column) const {
    return text::is_same_word(cells()[column], "nan") ? 0 : detail::whole_number(number(column));
  }

  [[noreturn]] void too_few() const {
    fail_here("has " + std::to_string(cells().size()) + " columns: expected at least " + std::to_string(needed_));
  }

  InputFile file_;
  TextPointColumns columns_;
  RowCells cells_{"", true};
  std::size_t needed_ = 0, named_ = 0;    // columns in use; those named
  std::optional<std::uint64_t> count_{};  // of points, as announced
  std::uint64_t points_ = 0;
  std::optional<std::size_t> class_{}, object_{};  // columns
  std::vector<std::string> notes_;
  bool begun_ = false, has_heading_ = false, cut_ = false;  // `has_heading_`: first row looked at
};

}  // namespace PULSECAST_NAMESPACE::io

#endif
