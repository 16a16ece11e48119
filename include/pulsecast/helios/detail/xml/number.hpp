// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_XML_NUMBER_HPP
#define PULSECAST_HELIOS_DETAIL_XML_NUMBER_HPP

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <numbers>

#include <pulsecast/base/error.hpp>
#include <pulsecast/base/require.hpp>
#include <pulsecast/base/text.hpp>
#include <pulsecast/base/units.hpp>
#include <pulsecast/base/vector.hpp>

/// Numbers and units in documents.
namespace PULSECAST_NAMESPACE::helios {

/// Unit of documents: SI value = number * `factor` / `divisor`.
struct XmlUnit {
  const char* symbol = "";  ///< for messages
  double factor = 1;
  double divisor = 1;  ///< makes 0.25 ns the number nearest to 0.25e-9 s

  [[nodiscard]] double si(double number) const noexcept { return number * factor / divisor; }

  /// Shortest number for which `si` gives the value again; the nearest if there is none.
  [[nodiscard]] double number(double value) const noexcept {
    const double about = value * divisor / factor;
    if (factor == 1 && divisor == 1) return value;
    for (const int digits : {15, 16, 17}) {
      std::array<char, 40> text;
      const char* const end =
          std::to_chars(text.data(), text.data() + text.size(), about, std::chars_format::general, digits).ptr;
      const double rounded = text::number_in<double>({text.data(), end}).value_or(about);
      if (si(rounded) == value) return rounded;
    }
    double below = about, above = about;
    for (int step = 0; step < 4; ++step) {
      below = std::nextafter(below, -std::numeric_limits<double>::infinity());
      above = std::nextafter(above, std::numeric_limits<double>::infinity());
      if (si(below) == value) return below;
      if (si(above) == value) return above;
    }
    return about;
  }
};

namespace units {
inline constexpr double deg = std::numbers::pi / 180;
inline constexpr XmlUnit one{}, metre{"m"}, square_metre{"m^2"}, per_metre{"1/m"}, per_metre_steradian{"1/(m sr)"},
    second{"s"}, hertz{"Hz"}, radian{"rad"}, watt{"W"}, metre_per_second{"m/s"}, millimetre_per_hour{"mm/h"};
inline constexpr XmlUnit degree{"deg", deg}, degree_per_second{"deg/s", deg}, kilometre{"km", 1e3},
    nanosecond{"ns", 1, 1e9}, nanometre{"nm", 1, 1e9}, nanowatt{"nW", 1, 1e9}, degree_hertz{"deg Hz", deg};
}  // namespace units

/// True for an angle beyond a turn that is whole in radians, as if given in degrees [rad].
[[nodiscard]] inline bool looks_like_degrees(double angle) noexcept {
  return std::fabs(angle) > max_angle && angle == std::round(angle);
}

/// True for an angle whose degrees are an eighth, a quarter, half of a turn or, if `turns` may be, a whole one in
/// radians, as if given in them [rad].
[[nodiscard]] inline bool looks_like_radians(double angle, bool turns) noexcept {
  const double given = std::fabs(degrees(angle)), eighths = std::round(given / (pi / 4));
  const bool is_usual = eighths == 1 || eighths == 2 || eighths == 4 || (turns && eighths == 8);
  return is_usual && std::fabs(given - eighths * pi / 4) < 6e-4 * given;  // of 3.14, off by 5e-4
}

/// Number as text, without an exponent where that is legible.
[[nodiscard]] inline std::string xml_number(double value) {
  if (value == 0) return "0";
  const double size = std::abs(value);
  if (!(size >= 1e-6 && size < 1e15)) return text::to_text(value);
  std::array<char, 64> digits;
  return {digits.data(),
          std::to_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::fixed).ptr};
}

/// Number of a document for a value. @throws SettingError out of its limits, rounding aside
[[nodiscard]] inline double document_number(std::string_view name, double value, const XmlUnit& unit, double low,
                                            double high) {
  const double number = unit.number(value), limit = std::clamp(number, low, high);
  if (number >= low && number <= high) return number;
  if (std::fabs(number - limit) <= 1e-12 * std::fabs(limit)) return limit;
  using limits = std::numeric_limits<double>;
  const std::string bound = high < limits::max() ? " to " + xml_number(high) : "";
  const std::string allowed = low > limits::lowest() ? "from " + xml_number(low) + bound : "a number";
  const bool in_degrees = std::string_view(unit.symbol).starts_with("deg") && looks_like_degrees(value);
  throw SettingError(std::string(name), number, unit.symbol,
                     allowed + (in_degrees ? ": given in degrees, not radians?" : ""));
}

/// Parses a whole text as a number, except for blanks around it.
[[nodiscard]] inline std::optional<double> number_of(std::string_view text) noexcept {
  return text::number_in<double>(text::trimmed(text));
}

/// Parses three numbers with a separator between them, and any number of blanks.
[[nodiscard]] inline std::optional<Vec3> vector_of(std::string_view text, char separator, double size_max) {
  Vec3 found{};
  for (int i = 0; i < 3; ++i) {
    text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
    const std::size_t end = i < 2 ? text.find(separator) : text.size();
    const auto component = end == text.npos ? std::nullopt : number_of(text.substr(0, end));
    if (!component || !(std::abs(*component) <= size_max)) return std::nullopt;
    found[i] = *component;
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return found;
}

}  // namespace PULSECAST_NAMESPACE::helios

#endif
