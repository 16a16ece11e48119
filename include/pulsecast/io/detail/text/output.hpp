// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_TEXT_OUTPUT_HPP
#define PULSECAST_IO_DETAIL_TEXT_OUTPUT_HPP

#include <pulsecast/echo.hpp>
#include <pulsecast/io/output_file.hpp>

namespace PULSECAST_NAMESPACE::io {

/// Settings of a text file.
struct TextFileSettings {
  double start_time = 0;  ///< clock time at tick 0 [s]
  /// Samples of each waveform: shorter ones end with zeros, longer ones are cut; 0: as they are
  std::uint32_t waveform_samples = 0;

  void validate() const { require_finite("TextFileSettings::start_time", start_time, "s"); }
};

/// Row of a text table, with a separator between the cells. Independent of the locale.
class TextRow {
 public:
  explicit TextRow(char separator = ' ') noexcept : separator_(separator) {}

  /// Adds a number in the shortest form that reads back the same; zero has no sign.
  TextRow& add(double value) { return append(text::to_text(value == 0 ? 0 : value)); }

  /// Adds a number in fixed notation, rounded to nearest; zero and NaN have no sign.
  TextRow& add(double value, int decimals) {
    if (std::isnan(value)) return append("nan");
    if (decimals >= 0 && decimals < static_cast<int>(powers_of_ten.size())) {  // five times as fast
      const double size = std::fabs(value), unit = powers_of_ten[static_cast<std::size_t>(decimals)];
      const double units = size * unit;
      if (units < 0x1p52) return append_units(value < 0, size, unit, units, decimals);
    }
    std::array<char, std::numeric_limits<double>::max_exponent10 + 32> digits;  // of the longest number
    constexpr auto fixed = std::chars_format::fixed;
    std::string_view text(digits.begin(), std::to_chars(digits.begin(), digits.end(), value, fixed, decimals).ptr);
    if (text.find_first_not_of("-0.") == text.npos && text.front() == '-') text.remove_prefix(1);
    return append(text);
  }

  template <std::integral Integer>
  TextRow& add(Integer value) {
    std::array<char, std::numeric_limits<Integer>::digits10 + 3> digits;
    return append({digits.begin(), std::to_chars(digits.begin(), digits.end(), value).ptr});
  }

  /// Adds a word, which must not contain the separator.
  TextRow& add(std::string_view word) { return append(word); }

  /// Row with line end, valid until the next `add`, which begins a new row.
  [[nodiscard]] std::string_view end() {
    text_ += '\n';
    ended_ = true;
    return text_;
  }

 private:
  static constexpr std::array powers_of_ten{1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9};

  /// Adds a number of units of the last decimal. `units` is rounded to a double; its rounding error
  /// decides ties, and exact ties go to even, so the digits are those of the exact product.
  TextRow& append_units(bool negative, double size, double unit, double units, int decimals) {
    const double below = std::floor(units);
    const double over_half = (units - below - 0.5) + std::fma(size, unit, -units);
    auto whole = static_cast<std::uint64_t>(below);
    if (over_half > 0 || (over_half == 0 && whole % 2 == 1)) ++whole;
    std::array<char, 24> digits;
    char* const end = digits.data() + digits.size();
    char* at = end;
    const bool signed_text = negative && whole != 0;
    for (int i = 0; i < decimals; ++i, whole /= 10) *--at = static_cast<char>('0' + whole % 10);
    if (decimals > 0) *--at = '.';
    do {
      *--at = static_cast<char>('0' + whole % 10);
      whole /= 10;
    } while (whole != 0);
    if (signed_text) *--at = '-';
    return append({at, end});
  }

  TextRow& append(std::string_view text) {
    if (ended_) text_.clear();
    if (!text_.empty()) text_ += separator_;
    text_ += text;
    ended_ = false;
    return *this;
  }

  char separator_;
  std::string text_;
  bool ended_ = false;
};

/// Text table under construction, row by row. The file may be a compressing one: see `gzip_file`.
class TextOutput {
 public:
  explicit TextOutput(OutputFile file) : file_(std::move(file)) {}

  /// Adds a vector. If it is not finite, discards the table and throws a `FileError` about `what`.
  TextOutput& vector(std::string_view what, const Vec3& v, int decimals) {
    if (!finite(v)) reject(what);
    return reals(decimals, v.x, v.y, v.z);
  }

  /// Adds origin and direction of a pulse, with 4 and 9 decimals.
  TextOutput& beam(const Shot& shot) {
    return vector("the origin of a pulse", shot.origin, 4).vector("the direction of a pulse", shot.direction, 9);
  }

  /// Adds numbers with a fixed number of decimals.
  template <std::convertible_to<double>... Reals>
  TextOutput& reals(int decimals, Reals... values) {
    (row_.add(static_cast<double>(values), decimals), ...);
    return *this;
  }

  /// Adds a time [ns] with 4 exact decimals: a double would lose some of them after minutes.
  TextOutput& nanoseconds(const Tick& time) {
    const bool negative = time.second < 0;
    constexpr std::int64_t unit = 10'000;  // per nanosecond: 0.1 ps
    const double fraction = negative ? 1 - time.fraction : time.fraction;
    const auto units = static_cast<std::int64_t>(std::nearbyint(fraction * 1e9 * unit));
    const std::int64_t seconds = negative ? -1 - time.second : time.second;
    const std::string whole = std::to_string(seconds * 1'000'000'000 + units / unit);
    const std::string decimals = std::to_string(unit + units % unit);  // after a leading 1
    row_.add(text::joined({negative ? "-" : "", whole, ".", std::string_view(decimals).substr(1)}));
    return *this;
  }

  template <std::integral... Integers>
  TextOutput& wholes(Integers... values) {
    (row_.add(values), ...);
    return *this;
  }

  TextOutput& word(std::string_view word) {
    row_.add(word);
    return *this;
  }

  [[nodiscard]] TextRow& row() noexcept { return row_; }  ///< row under construction

  void end_row() {
    file_.write(row_.end());
    ++rows_;
  }

  void close() { file_.commit(); }

 private:
  [[noreturn]] void reject(std::string_view what) {
    file_.discard();
    throw FileError(file_.path().string(), "line " + std::to_string(rows_ + 1),
                    text::joined({"cannot be written: ", what, " is not finite; expected finite coordinates"}));
  }

  OutputFile file_;
  TextRow row_;
  std::uint64_t rows_ = 0;
};

}  // namespace PULSECAST_NAMESPACE::io

#endif
