// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_PAGE_DETAIL_JSON_HPP
#define PULSECAST_PAGE_DETAIL_JSON_HPP

#include <cmath>
#include <concepts>

#include <pulsecast/base/error.hpp>

namespace PULSECAST_NAMESPACE::page::detail {

/// JSON writer, token by token; it sets the commas. Source: RFC 8259.
///
/// Texts are escaped for HTML, too. A number that is not finite becomes `null`.
class JsonWriter {
 public:
  JsonWriter& begin_object() { return open('{'); }
  JsonWriter& end_object() { return close('}'); }
  JsonWriter& begin_array() { return open('['); }
  JsonWriter& end_array() { return close(']'); }

  /// Writes the name of a member; its value follows.
  JsonWriter& key(std::string_view name) {
    value(name);
    text_ += ':';
    return *this;
  }

  JsonWriter& value(std::string_view text) {
    separate();
    append_escaped(text);
    return *this;
  }
  JsonWriter& value(const char* text) { return value(std::string_view(text)); }
  JsonWriter& value(bool truth) { return token(truth ? "true" : "false"); }
  JsonWriter& value(std::integral auto number) { return token(std::to_string(number)); }
  JsonWriter& value(double number) { return token(std::isfinite(number) ? text::to_text(number) : "null"); }

  template <class T, std::size_t N>
  JsonWriter& value(const std::array<T, N>& values) {
    return array(N, [&values](std::size_t i) { return values[i]; });
  }

  JsonWriter& member(std::string_view name, const auto& its_value) { return key(name).value(its_value); }

  /// Writes an array of `item(0)` to `item(count - 1)`.
  JsonWriter& array(std::size_t count, const auto& item) {
    begin_array();
    for (std::size_t i = 0; i < count; ++i) value(item(i));
    return end_array();
  }

  [[nodiscard]] const std::string& text() const noexcept { return text_; }  ///< UTF-8

 private:
  /// Writes a comma, except before a first item or the value of a member.
  void separate() {
    constexpr std::string_view none_after = "{[:";
    if (!text_.empty() && none_after.find(text_.back()) == std::string_view::npos) text_ += ',';
  }

  JsonWriter& open(char bracket) { return token({&bracket, 1}); }

  JsonWriter& close(char bracket) {
    text_ += bracket;
    return *this;
  }

  JsonWriter& token(std::string_view text) {
    separate();
    text_ += text;
    return *this;
  }

  void append_escaped(std::string_view text) {
    constexpr std::string_view digits = "0123456789abcdef", escaped = "\"\\<>&";
    text_ += '"';
    for (const char c : text) {
      const auto code = static_cast<unsigned char>(c);
      if (code < 32 || code == 127 || escaped.find(c) != std::string_view::npos) {
        text_ += "\\u00";
        text_ += digits[code / 16];
        text_ += digits[code % 16];
      } else {
        text_ += c;
      }
    }
    text_ += '"';
  }

  std::string text_;
};

}  // namespace PULSECAST_NAMESPACE::page::detail

#endif
