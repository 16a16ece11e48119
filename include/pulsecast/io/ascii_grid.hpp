// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_ASCII_GRID_HPP
#define PULSECAST_IO_ASCII_GRID_HPP

#include <filesystem>

#include <pulsecast/base/compiled.hpp>
#include <pulsecast/base/text.hpp>
#include <pulsecast/io/spatial_reference.hpp>
#include <pulsecast/shape/raster.hpp>

namespace PULSECAST_NAMESPACE::io {

/// Settings for Esri ASCII grids.
struct AsciiGridSettings {
  double vertical_scale = 1;        ///< metres per unit of height [m]
  std::optional<double> missing{};  ///< number of missing heights; default: NODATA_value, or -9999

  void validate() const { require_positive("AsciiGridSettings::vertical_scale", vertical_scale, "m"); }
};

/// Content of an Esri ASCII grid.
struct AsciiGrid {
  Raster raster;                        ///< heights [m]
  std::vector<std::string> warnings{};  ///< oddities that could still be read
  SpatialReference reference{};         ///< that of a file beside it, with its units
};

/// Reads an Esri ASCII grid, a raster of heights as text, in metres. Keywords of any case and order
/// come first: `ncols`, `nrows`, `xllcorner` or `xllcenter`, `yllcorner` or `yllcenter`, `cellsize`
/// or `dx` and `dy`, and perhaps `NODATA_value`. Heights follow row by row from the north. Missing
/// heights, NaN and values not within 1e15 m become NaN. With a `.prj` or `.aux.xml` beside it,
/// coordinates, and heights unless they have a scale by the settings, become metres. @throws FileError
/// with the line if known, for keywords that are unknown, repeated or missing, too few, too many or no
/// heights, and degrees @throws SettingError Source: Esri, ArcGIS documentation, "Esri ASCII raster format"; GDAL
/// manual.
[[nodiscard]] AsciiGrid read_ascii_grid(const std::filesystem::path& path, const AsciiGridSettings& settings = {});

/// True for the extension `.asc`, in any case.
[[nodiscard]] inline bool is_ascii_grid(const std::filesystem::path& path) {
  return text::is_same_word(path.extension().string(), ".asc");
}

}  // namespace PULSECAST_NAMESPACE::io

#if PULSECAST_DEFINES(IO_ASCII_GRID)
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <pulsecast/base/suggestion.hpp>
#include <pulsecast/io/detail/side_files.hpp>
#include <pulsecast/io/detail/text/table.hpp>
#include <pulsecast/io/world_file.hpp>

namespace PULSECAST_NAMESPACE::io {

namespace detail {

class AsciiGridReader {
 public:
  AsciiGridReader(const std::filesystem::path& path, const AsciiGridSettings& settings)
      : settings_(validated(settings)),
        path_(path.string()),
        file_(path, "an Esri ASCII grid, which begins with 'ncols'") {}

  [[nodiscard]] AsciiGrid read() && {
    const bool is_scaled = settings_.vertical_scale != 1;
    grid_.reference = read_side_files(path_, grid_.warnings, is_scaled ? HeightUnit::by_setting : HeightUnit::metre);
    if (!is_scaled) settings_.vertical_scale = grid_.reference.vertical_unit;
    read_keys();
    place();
    read_heights();
    try {
      grid_.raster.validate();
    } catch (const SettingError& error) {
      detail::fail(path_, error.what());
    }
    const std::string question = degrees_question(grid_.raster);
    if (!question.empty() && grid_.reference.wkt.empty()) detail::fail(path_, question);
    return std::move(grid_);
  }

 private:
  // in the order of `ascii_grid_rules`
  enum Key { ncols, nrows, xllcorner, xllcenter, yllcorner, yllcenter, cellsize, dx, dy, nodata_value, keys };

  struct Entry {
    double value = 0;
    std::size_t line = 0;  // 0 if it is not given
  };

  /// Next word; empty at the end of the file. Words may be any distance apart, as in one long line.
  [[nodiscard]] std::string_view next() noexcept {
    for (; !left_.empty() && is_separator(left_.front()); left_.remove_prefix(1))
      if (left_.front() == '\n') ++lines_;
    const auto end = std::ranges::find_if(left_, is_separator);
    const std::string_view word = left_.substr(0, static_cast<std::size_t>(end - left_.begin()));
    left_.remove_prefix(word.size());
    if (!word.empty()) line_ = lines_;
    return word;
  }

  [[nodiscard]] static bool is_separator(char c) noexcept { return text::is_blank(c) || c == '\n' || c == '\r'; }

  [[noreturn]] void fail(const auto&... problem) const { fail_at(line_, problem...); }
  [[noreturn]] void fail_at(std::size_t line, const auto&... problem) const {
    detail::fail_at(path_, line, problem...);
  }

  /// Reads the keywords; the last word is the first height then.
  void read_keys() {
    for (word_ = next(); is_name(word_); word_ = next()) {
      const auto* const rule = std::ranges::find_if(
          ascii_grid_rules, [&](const FormatRule& one) { return text::is_same_word(one.name, word_); });
      if (rule == ascii_grid_rules.end()) {
        std::vector<std::string> names;
        for (const FormatRule& one : ascii_grid_rules) names.emplace_back(one.name);
        fail(text::quoted(word_), ": expected a keyword of an Esri ASCII grid, or a height",
             text::suggestion(word_, names));
      }
      const auto key = static_cast<Key>(rule - ascii_grid_rules.begin());
      Entry& entry = entries_[key];
      if (entry.line > 0) fail(quoted(key), " is repeated: expected it in line ", entry.line, " only");
      const std::string_view text = next();
      const std::optional<double> value = key == nodata_value ? number(text) : text::finite_number_in(text);
      if (!value) fail(quoted(key), " is ", text::quoted(text), ": expected a number, with a decimal point");
      entry = {*value, line_};
    }
  }

  /// True for what is a keyword or a misspelt one, and no number.
  [[nodiscard]] static bool is_name(std::string_view word) {
    const char first = word.empty() ? '0' : text::lower(word.front());
    return first >= 'a' && first <= 'z' && !number(word);
  }

  /// Number, infinite or NaN too.
  [[nodiscard]] static std::optional<double> number(std::string_view word) noexcept {
    if (text::is_same_word(word, "nan") || text::is_same_word(word, "-nan"))
      return std::numeric_limits<double>::quiet_NaN();
    return text::number_in<double>(word);
  }

  void place() {
    Raster& raster = grid_.raster;
    raster.columns = count(ncols);
    raster.rows = count(nrows);
    const Key west = one_of(xllcorner, xllcenter), south = one_of(yllcorner, yllcenter);
    raster.pixel = {spacing(one_of(cellsize, dx)), spacing(one_of(cellsize, dy))};
    raster.first = {entries_[west].value + (west == xllcorner ? 0.5 : 0) * raster.pixel.x,
                    entries_[south].value + (raster.rows - (south == yllcorner ? 0.5 : 1)) * raster.pixel.y};
    raster.pixel *= grid_.reference.unit;
    raster.first *= grid_.reference.unit;
    // a height takes a digit and, but for the last, a separator
    const std::uint64_t most = file_.bytes().size() / 2 + 1;
    if (pixels() > most)
      fail_at(std::max(entries_[ncols].line, entries_[nrows].line), "'ncols' times 'nrows' is ", pixels(),
              ": expected at most ", most, ", which a file of this size can hold");
  }

  [[nodiscard]] std::size_t pixels() const noexcept { return std::size_t{grid_.raster.columns} * grid_.raster.rows; }

  [[nodiscard]] std::uint32_t count(Key key) const {
    const Entry& entry = entries_[key];
    if (entry.line == 0) fail("has no ", quoted(key), " up to here: expected it before the heights");
    const double value = entry.value;
    if (!(value >= 2 && value <= pulsecast::detail::max_pixels && std::floor(value) == value))
      fail_at(entry.line, quoted(key), " is ", value, ": expected a whole number from 2 to 2^27");
    return static_cast<std::uint32_t>(value);
  }

  [[nodiscard]] double spacing(Key key) const {
    const Entry& entry = entries_[key];
    if (!(entry.value > 0)) fail_at(entry.line, quoted(key), " is ", entry.value, ": expected a spacing above 0 m");
    return entry.value;
  }

  /// The one of two keywords that is given.
  [[nodiscard]] Key one_of(Key a, Key b) const {
    const std::size_t line_a = entries_[a].line, line_b = entries_[b].line;
    if (line_a > 0 && line_b > 0)
      fail_at(std::max(line_a, line_b), "gives both ", quoted(a), " and ", quoted(b), ": expected one of them");
    if (line_a == 0 && line_b == 0)
      fail("has neither ", quoted(a), " nor ", quoted(b), " up to here: expected one before the heights");
    return line_a > 0 ? a : b;
  }

  void read_heights() {
    const Entry& given = entries_[nodata_value];
    const double missing = settings_.missing.value_or(given.line > 0 ? given.value : -9999);  // source: Esri
    std::vector<float>& heights = grid_.raster.heights;
    heights.reserve(pixels());
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    bool is_any = false;
    Oddity strange;
    std::size_t unmarked = 0;
    for (; !word_.empty(); word_ = next()) {
      if (heights.size() == pixels())
        fail(text::quoted(word_), " is one height too many: expected ", pixels(), ", 'ncols' times 'nrows'");
      const std::optional<double> value = number(word_);
      if (!value) fail(text::quoted(word_), ": expected a height, with a decimal point, or NaN");
      const double height = *value * settings_.vertical_scale;
      const bool is_missing = std::isnan(height) || *value == missing, is_there = std::fabs(height) <= 1e15;
      if (!is_missing && !is_there) strange.at(line_);
      unmarked += !is_missing && !settings_.missing && given.line == 0 && may_be_missing(*value) ? 1 : 0;
      is_any |= !is_missing && is_there;
      heights.push_back(!is_missing && is_there ? static_cast<float>(height) : nan);
    }
    if (heights.size() < pixels())
      fail("ends after ", heights.size(), " heights: expected ", pixels(), ", 'ncols' times 'nrows'");
    if (!is_any) detail::fail(path_, "has no height that is not missing: expected at least one");
    if (unmarked > 0)
      warn(0, unmarked, " heights are a number that often marks missing ones, as -32768, without NODATA_value");
    if (strange.count > 0)
      warn(strange.first, "a height is beyond 1e15 m, one of ", strange.count, ": they count as missing");
    if (!is_separator(file_.text().back())) warn(line_, "the last line has no line end: the file may be truncated");
  }

  void warn(std::size_t line, const auto&... oddity) { grid_.warnings.push_back(warning(path_, line, oddity...)); }

  [[nodiscard]] std::string quoted(Key key) const { return text::quoted(ascii_grid_rules[key].name); }

  AsciiGridSettings settings_;
  std::string path_;
  MappedFile file_;
  std::string_view left_ = text::without_byte_order_mark(file_.text());  // of the file
  std::size_t lines_ = 1, line_ = 1;                                     // of the next byte, the last word
  std::string_view word_;                                                // the last one
  std::array<Entry, keys> entries_{};
  AsciiGrid grid_;
};

}  // namespace detail

PULSECAST_INLINE AsciiGrid read_ascii_grid(const std::filesystem::path& path, const AsciiGridSettings& settings) {
  return reading(path, [&] { return detail::AsciiGridReader(path, settings).read(); });
}

}  // namespace PULSECAST_NAMESPACE::io

#endif

#endif
