// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_BASE_TEXT_HPP
#define PULSECAST_BASE_TEXT_HPP

#include <algorithm>
#include <cmath>
#include <concepts>
#include <optional>
#include <system_error>

#include <pulsecast/base/error.hpp>

/// Lines, words and numbers of text. Letters are those of ASCII; the locale has no influence.
namespace PULSECAST_NAMESPACE::text {

inline constexpr std::string_view blanks = " \t";  ///< blank and tab

/// True for a blank or a tab.
[[nodiscard]] constexpr bool is_blank(char c) noexcept { return c == ' ' || c == '\t'; }

/// Text without the blanks around it.
[[nodiscard]] constexpr std::string_view trimmed(std::string_view text) noexcept {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

/// Text without the byte order mark of UTF-8 at its beginning.
[[nodiscard]] inline std::string_view without_byte_order_mark(std::string_view text) noexcept {
  constexpr std::string_view mark = "\xEF\xBB\xBF";
  if (text.starts_with(mark)) text.remove_prefix(mark.size());
  return text;
}

/// Small letter of a capital; other characters are kept.
[[nodiscard]] constexpr char lower(char c) noexcept {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

/// Text in small letters.
[[nodiscard]] inline std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = lower(c);
  return out;
}

/// True if two texts differ in case at most.
[[nodiscard]] inline bool is_same_word(std::string_view a, std::string_view b) noexcept {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) { return lower(x) == lower(y); });
}

/// Quotation for a message, on one line; cut after 80 bytes.
[[nodiscard]] inline std::string quoted(std::string_view text) {
  constexpr std::size_t longest = 80;
  std::string out(text.substr(0, longest));
  for (char& c : out) c = static_cast<unsigned char>(c) < ' ' ? ' ' : c;
  return text::joined({"'", out, text.size() > longest ? "...'" : "'"});
}

/// Removes the first word and the separators after. Returns it, empty if a separator comes first.
inline std::string_view take_word(std::string_view& text, std::string_view separators = blanks) noexcept {
  const std::string_view word = text.substr(0, text.find_first_of(separators));
  text.remove_prefix(std::min(text.find_first_not_of(separators, word.size()), text.size()));
  return word;
}

/// Removes the first line from a text, and its end (LF or CR LF). Returns the line without its end.
inline std::string_view take_line(std::string_view& text) noexcept {
  std::string_view line = text.substr(0, text.find('\n'));
  text.remove_prefix(std::min(line.size() + 1, text.size()));
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

/// Removes a number from the beginning of a text. Empty, and the text is kept, if there is none
/// that `Number` can hold. `format` may limit its notation, as in `std::chars_format::fixed`.
template <class Number, class... Format>
std::optional<Number> take_number(std::string_view& text, Format... format) noexcept {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, format...);
  if (error != std::errc{}) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return value;
}

/// Number that makes up a whole text, perhaps with a plus sign. Empty for all else, and NaN.
template <class Number>
[[nodiscard]] std::optional<Number> number_in(std::string_view text) noexcept {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  const std::optional<Number> value = take_number<Number>(text);
  if (!value || !text.empty()) return std::nullopt;
  if constexpr (std::floating_point<Number>) {
    if (std::isnan(*value)) return std::nullopt;
  }
  return value;
}

/// Part of a message: a text as it is, a character, or a number in its shortest form.
[[nodiscard]] inline std::string_view part(std::string_view text) noexcept { return text; }
[[nodiscard]] inline std::string part(char c) { return {c}; }
[[nodiscard]] inline std::string part(double number) { return to_text(number); }
[[nodiscard]] std::string part(std::integral auto number) { return std::to_string(number); }

/// Message of texts and numbers.
[[nodiscard]] std::string message(const auto&... parts) { return joined({part(parts)...}); }

/// Finite number that makes up a whole text; empty for anything else.
[[nodiscard]] inline std::optional<double> finite_number_in(std::string_view text) noexcept {
  const std::optional<double> value = number_in<double>(text);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

}  // namespace PULSECAST_NAMESPACE::text

#endif
