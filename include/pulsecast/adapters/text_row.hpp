// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <charconv>
#include <concepts>
#include <limits>
#include <string>
#include <string_view>

#include <pulsecast/base/error.hpp>

namespace pulsecast::adapters {

/// A row of a text table: numbers with one separator between them, a blank if not told otherwise, written the same whatever the locale.
class TextRow {
 public:
  explicit TextRow(char separator = ' ') noexcept : separator_(separator) {}

  /// A number as short as it can be so that it reads back the same; a zero has no sign.
  TextRow& add(double value) { return append(pulsecast::detail::written(value == 0 ? 0 : value)); }

  /// A number in fixed notation, rounded to nearest; a zero has no sign.
  TextRow& add(double value, int decimals) {
    std::array<char, std::numeric_limits<double>::max_exponent10 + 32> digits{};  // the longest number, its sign, point and decimals
    const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::fixed, decimals);
    std::string_view text(digits.data(), end);
    if (text.find_first_not_of("-0.") == std::string_view::npos && text.front() == '-') text.remove_prefix(1);
    return append(text);
  }

  template <std::integral Integer>
  TextRow& add(Integer value) {
    std::array<char, std::numeric_limits<Integer>::digits10 + 3> digits{};
    const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(), value);
    return append({digits.data(), end});
  }

  /// The row with its line end; what is added next begins another. Valid until then.
  [[nodiscard]] std::string_view end() {
    text_ += '\n';
    ended_ = true;
    return text_;
  }

 private:
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

}  // namespace pulsecast::adapters
