// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_ASCII_GRID_HPP
#define PULSECAST_IO_ASCII_GRID_HPP

#include <filesystem>
#include <vector>

#include <pulsecast/base/compiled.hpp>
#include <pulsecast/base/require.hpp>
#include <pulsecast/base/text.hpp>
#include <pulsecast/shape/raster.hpp>

namespace PULSECAST_NAMESPACE::io {

/// Settings for Esri ASCII grids.
struct AsciiGridSettings {
  double vertical_scale = 1;        ///< metres per unit of height [m]
  std::optional<double> missing{};  ///< number of missing heights in the file; by default NODATA_value, or -9999

  void validate() const { require_positive("AsciiGridSettings::vertical_scale", vertical_scale, "m"); }
};

/// Content of an Esri ASCII grid.
struct AsciiGrid {
  Raster raster;                        ///< heights [m]
  std::vector<std::string> warnings{};  ///< oddities that could still be read
};

/// Reads an Esri ASCII grid, a raster of heights as text, whose coordinates are in metres; the file has no reference
/// system. Keywords of any case and order come first: `ncols`, `nrows`, `xllcorner` or `xllcenter`, `yllcorner` or
/// `yllcenter`, `cellsize` or `dx` and `dy`, and perhaps `NODATA_value`. Heights follow row by row from the north; line
/// ends count as blanks. NaN, values not within 1e15 m, and the value for missing ones become NaN. Memory is the
/// raster, whose size the size of the file bounds. @throws SettingError for settings out of range @throws FileError
/// with the line if known, for a keyword that is unknown, repeated or missing, and for too few, too many or no heights
/// Source: Esri, ArcGIS documentation, "Esri ASCII raster format"; for `dx` and `dy`, the GDAL manual, AAIGrid driver.
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
#include <pulsecast/io/detail/degrees.hpp>
#include <pulsecast/io/detail/text/table.hpp>
#include <pulsecast/io/input_file.hpp>

namespace PULSECAST_NAMESPACE::io {

namespace detail {

/// Words of a file, between blanks and line ends. They may be any distance apart: a grid may be one long line.
class FileWords {
 public:
  FileWords(const std::filesystem::path& path, std::string_view expected)
      : path_(path.string()), file_(path, expected), left_(text::without_byte_order_mark(file_.text())) {}

  /// Next word; empty at the end of the file.
  [[nodiscard]] std::string_view next() noexcept {
    for (; !left_.empty() && is_separator(left_.front()); left_.remove_prefix(1))
      if (left_.front() == '\n') ++lines_;
    const auto end = std::find_if(left_.begin(), left_.end(), is_separator);
    const std::string_view word = left_.substr(0, static_cast<std::size_t>(end - left_.begin()));
    left_.remove_prefix(word.size());
    if (!word.empty()) line_ = lines_;
    return word;
  }

  [[nodiscard]] const std::string& path() const noexcept { return path_; }
  [[nodiscard]] std::uint64_t size() const noexcept { return file_.bytes().size(); }  ///< size of the file [byte]
  [[nodiscard]] std::size_t line() const noexcept { return line_; }  ///< number of the line of the last word, from 1
  /// True if the file ends with a word.
  [[nodiscard]] bool is_open() const noexcept { return !is_separator(file_.text().back()); }

  /// Throws a `FileError` about the line of the last word, another one, or the whole file.
  [[noreturn]] void fail(const std::string& problem) const { fail_at(line_, problem); }
  [[noreturn]] void fail_at(std::size_t line, const std::string& problem) const {
    throw FileError(path_, TextTable::place(line), problem);
  }
  [[noreturn]] void fail_whole(const std::string& problem) const { throw FileError(path_, "", problem); }

 private:
  [[nodiscard]] static bool is_separator(char c) noexcept { return text::is_blank(c) || c == '\n' || c == '\r'; }

  std::string path_;
  MappedFile file_;
  std::string_view left_;             // of the file
  std::size_t lines_ = 1, line_ = 1;  // of the next byte, and of the last word
};

class AsciiGridReader {
 public:
  AsciiGridReader(const std::filesystem::path& path, const AsciiGridSettings& settings)
      : settings_(validated(settings)), words_(path, "an Esri ASCII grid, which begins with 'ncols'") {}

  [[nodiscard]] AsciiGrid read() && {
    read_keys();
    place();
    read_heights();
    try {
      grid_.raster.validate();
    } catch (const SettingError& error) {
      words_.fail_whole(error.what());
    }
    if (const std::string question = degrees_question(grid_.raster); !question.empty())
      grid_.warnings.push_back(words_.path() + ": " + question);
    return std::move(grid_);
  }

 private:
  enum Key { ncols, nrows, xllcorner, xllcenter, yllcorner, yllcenter, cellsize, dx, dy, nodata_value, keys };

  struct Entry {
    double value = 0;
    std::size_t line = 0;  // 0 if it is not given
  };

  /// Reads the keywords; the last word is the first height then.
  void read_keys() {
    for (word_ = words_.next(); is_name(word_); word_ = words_.next()) {
      const auto* const name =
          std::find_if(names_.begin(), names_.end(), [&](const auto& one) { return text::is_same_word(one, word_); });
      if (name == names_.end())
        words_.fail(text::quoted(word_) + ": expected a keyword of an Esri ASCII grid, or a height" +
                    text::suggestion(word_, names_));
      const auto key = static_cast<Key>(name - names_.begin());
      Entry& entry = entries_[key];
      if (entry.line > 0)
        words_.fail(quoted(key) + " is repeated: expected it in line " + std::to_string(entry.line) + " only");
      const std::string_view text = words_.next();
      const std::optional<double> value = key == nodata_value ? number(text) : text::finite_number_in(text);
      if (!value) words_.fail(quoted(key) + " is " + text::quoted(text) + ": expected a number, with a decimal point");
      entry = {*value, words_.line()};
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

  /// Sets all of the raster but the heights.
  void place() {
    Raster& raster = grid_.raster;
    raster.columns = count(ncols);
    raster.rows = count(nrows);
    const Key west = one_of(xllcorner, xllcenter), south = one_of(yllcorner, yllcenter);
    raster.pixel = {spacing(one_of(cellsize, dx)), spacing(one_of(cellsize, dy))};
    raster.first = {entries_[west].value + (west == xllcorner ? 0.5 : 0) * raster.pixel.x,
                    entries_[south].value + (raster.rows - (south == yllcorner ? 0.5 : 1)) * raster.pixel.y};
    // a height takes a digit and, but for the last, a separator
    const std::uint64_t most = words_.size() / 2 + 1;
    if (pixels() > most)
      words_.fail_at(std::max(entries_[ncols].line, entries_[nrows].line),
                     "'ncols' times 'nrows' is " + std::to_string(pixels()) + ": expected at most " +
                         std::to_string(most) + ", which a file of this size can hold");
  }

  [[nodiscard]] std::size_t pixels() const noexcept { return std::size_t{grid_.raster.columns} * grid_.raster.rows; }

  [[nodiscard]] std::uint32_t count(Key key) const {
    const Entry& entry = entries_[key];
    if (entry.line == 0) words_.fail("has no " + quoted(key) + " up to here: expected it before the heights");
    if (!(entry.value >= 2 && entry.value <= pulsecast::detail::max_pixels && std::floor(entry.value) == entry.value))
      words_.fail_at(entry.line,
                     quoted(key) + " is " + text::to_text(entry.value) + ": expected a whole number from 2 to 2^27");
    return static_cast<std::uint32_t>(entry.value);
  }

  [[nodiscard]] double spacing(Key key) const {
    const Entry& entry = entries_[key];
    if (!(entry.value > 0))
      words_.fail_at(entry.line, quoted(key) + " is " + text::to_text(entry.value) + ": expected a spacing above 0 m");
    return entry.value;
  }

  /// The one of two keywords that is given.
  [[nodiscard]] Key one_of(Key a, Key b) const {
    const std::size_t line_a = entries_[a].line, line_b = entries_[b].line;
    if (line_a > 0 && line_b > 0)
      words_.fail_at(std::max(line_a, line_b),
                     "gives both " + quoted(a) + " and " + quoted(b) + ": expected one of them");
    if (line_a == 0 && line_b == 0)
      words_.fail("has neither " + quoted(a) + " nor " + quoted(b) + " up to here: expected one before the heights");
    return line_a > 0 ? a : b;
  }

  void read_heights() {
    constexpr double nodata = -9999;  // source: Esri, the default of NODATA_value
    const double missing =
        settings_.missing.value_or(entries_[nodata_value].line > 0 ? entries_[nodata_value].value : nodata);
    std::vector<float>& heights = grid_.raster.heights;
    heights.reserve(pixels());
    bool is_any = false;
    Oddity strange;
    for (; !word_.empty(); word_ = words_.next()) {
      if (heights.size() == pixels())
        words_.fail(text::quoted(word_) + " is one height too many: expected " + std::to_string(pixels()) +
                    ", 'ncols' times 'nrows'");
      const std::optional<double> value = number(word_);
      if (!value) words_.fail(text::quoted(word_) + ": expected a height, with a decimal point, or NaN");
      const double height = *value * settings_.vertical_scale;
      const bool is_missing = std::isnan(height) || *value == missing,
                 is_strange = !is_missing && std::fabs(height) > 1e15;
      if (is_strange) strange.at(words_.line());
      is_any = is_any || !(is_missing || is_strange);
      heights.push_back(is_missing || is_strange ? std::numeric_limits<float>::quiet_NaN()
                                                 : static_cast<float>(height));
    }
    if (heights.size() < pixels())
      words_.fail("ends after " + std::to_string(heights.size()) + " heights: expected " + std::to_string(pixels()) +
                  ", 'ncols' times 'nrows'");
    if (!is_any) words_.fail_whole("has no height that is not missing: expected at least one");
    if (strange.count > 0)
      warn(strange.first,
           "a height is beyond 1e15 m, one of " + std::to_string(strange.count) + ": they count as missing");
    if (words_.is_open()) warn(words_.line(), "the last line has no line end: the file may be truncated");
  }

  void warn(std::size_t line, const std::string& oddity) {
    grid_.warnings.push_back(words_.path() + ", " + TextTable::place(line) + ": " + oddity);
  }

  [[nodiscard]] std::string quoted(Key key) const { return text::quoted(names_[key]); }

  // in the order of `Key`
  const std::array<std::string, keys> names_{"ncols",     "nrows",    "xllcorner", "xllcenter", "yllcorner",
                                             "yllcenter", "cellsize", "dx",        "dy",        "NODATA_value"};
  AsciiGridSettings settings_;
  FileWords words_;
  std::string_view word_;  // the last one
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
