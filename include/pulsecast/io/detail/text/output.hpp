// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_TEXT_OUTPUT_HPP
#define PULSECAST_IO_DETAIL_TEXT_OUTPUT_HPP

#include <array>
#include <charconv>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include <pulsecast/base/tick.hpp>
#include <pulsecast/base/vector.hpp>
#include <pulsecast/io/detail/text/row.hpp>
#include <pulsecast/io/output_file.hpp>

namespace PULSECAST_NAMESPACE::io {

/// Text table under construction, row by row. The file may be a compressing one: see `gzip_file`.
class TextOutput {
 public:
  explicit TextOutput(OutputFile file) : file_(std::move(file)) {}

  /// Adds a position or direction. One that is not finite discards the table and throws a `FileError`; `what` names it
  /// there.
  TextOutput& vector(std::string_view what, const Vec3& v, int decimals) {
    if (!finite(v)) reject(what);
    return reals(decimals, v.x, v.y, v.z);
  }

  /// Adds numbers with a fixed number of decimals.
  template <std::convertible_to<double>... Reals>
  TextOutput& reals(int decimals, Reals... values) {
    (row_.add(static_cast<double>(values), decimals), ...);
    return *this;
  }

  /// Adds a time [ns] with 4 decimals, rounded to nearest, all exact: a double would lose some of them after minutes.
  TextOutput& nanoseconds(const Tick& time) {
    const bool negative = time.second < 0;
    constexpr std::int64_t unit = 10'000;  // per nanosecond: 0.1 ps
    const auto units =
        static_cast<std::int64_t>(std::nearbyint((negative ? 1 - time.fraction : time.fraction) * 1e9 * unit));
    const std::int64_t whole = (negative ? -1 - time.second : time.second) * 1'000'000'000 + units / unit;
    std::array<char, 32> digits;
    char* end = digits.data();
    if (negative) *end++ = '-';
    end = std::to_chars(end, digits.data() + digits.size(), whole).ptr;
    *end = '.';
    for (std::int64_t i = 4, rest = units % unit; i > 0; --i, rest /= 10) end[i] = static_cast<char>('0' + rest % 10);
    row_.add(std::string_view(digits.data(), end + 5));
    return *this;
  }

  /// Adds a number in the shortest form that reads back the same.
  TextOutput& shortest(double value) {
    std::isnan(value) ? row_.add("nan") : row_.add(value);
    return *this;
  }

  /// Adds integers.
  template <std::integral... Integers>
  TextOutput& wholes(Integers... values) {
    (row_.add(values), ...);
    return *this;
  }

  /// Adds a word without blanks.
  TextOutput& word(std::string_view word) {
    row_.add(word);
    return *this;
  }

  void end_row() {
    file_.write(row_.end());
    ++rows_;
  }

  void close() { file_.commit(); }

 private:
  [[noreturn]] void reject(std::string_view what) {
    file_.discard();
    throw FileError(file_.path().string(), "line " + std::to_string(rows_ + 1),
                    "cannot be written: " + std::string(what) + " is not finite; expected finite coordinates");
  }

  OutputFile file_;
  TextRow row_;
  std::uint64_t rows_ = 0;
};

}  // namespace PULSECAST_NAMESPACE::io

#endif
