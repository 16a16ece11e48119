// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_SETTINGS_FIELDS_HPP
#define PULSECAST_HELIOS_DETAIL_SETTINGS_FIELDS_HPP

#include <filesystem>
#include <functional>
#include <span>
#include <vector>

#include <pulsecast/base/require.hpp>
#include <pulsecast/base/text.hpp>
#include <pulsecast/base/units.hpp>
#include <pulsecast/base/vector.hpp>

/// Tables of settings: `fields(FieldIo&)` of a struct has a row for each member, with its name,
/// unit and limits in documents. Validation, XML, Python and the tables of docs/surveys.md visit them.
namespace PULSECAST_NAMESPACE::helios {

/// Unit of documents: SI value = number * `factor` / `divisor`.
struct XmlUnit {
  const char* symbol = "";  ///< for messages
  double factor = 1;
  double divisor = 1;    ///< makes 0.25 ns the number nearest to 0.25e-9 s
  double usual_max = 0;  ///< SI value beyond which a program may have taken another unit; 0: none

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
inline constexpr XmlUnit degree{"deg", deg}, small_degree{"deg", deg, 1, 0.5}, degree_per_second{"deg/s", deg},
    kilometre{"km", 1e3}, nanosecond{"ns", 1, 1e9}, nanometre{"nm", 1, 1e9}, nanowatt{"nW", 1, 1e9},
    degree_hertz{"deg Hz", deg};
}  // namespace units

/// True for an angle beyond a turn that is whole in radians, as if given in degrees [rad].
[[nodiscard]] inline bool looks_like_degrees(double angle) noexcept {
  return std::fabs(angle) > max_angle && angle == std::round(angle);
}

/// True for degrees that are pi/4, pi/2, pi or, if `turns` may be, 2 pi: given in radians? [rad]
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

/// Visitor of the members of settings, in the order of documents; sets them only if it `reads`. This one does nothing.
class FieldIo {
 public:
  using Fields = std::function<void(FieldIo&)>;
  using EachFields = std::function<void(FieldIo&, std::size_t)>;
  static constexpr double any = std::numeric_limits<double>::infinity();
  static constexpr double max_coordinate = 1e9;  ///< maximum plausible coordinate [m]

  FieldIo() = default;
  FieldIo(const FieldIo&) = delete;
  FieldIo& operator=(const FieldIo&) = delete;
  virtual ~FieldIo() = default;
  [[nodiscard]] virtual bool reads() const noexcept { return false; }
  [[nodiscard]] virtual bool has(const char* /*name*/) const { return false; }  ///< in the document
  [[nodiscard]] virtual bool knows(std::string_view) const { return true; }     ///< named before

  /// Number with its limits, in the unit of documents.
  virtual void number(const char*, double&, const XmlUnit&, double /*low*/, double /*high*/) {}
  virtual void number(const char* name, std::optional<double>& v, const XmlUnit& unit, double low, double high) {
    optional(v, [&](double& found) { number(name, found, unit, low, high); });
  }
  virtual void whole(const char* /*name*/, int& /*value*/, int /*low*/, int /*high*/) {}
  virtual void flag(const char* /*name*/, bool& /*value*/) {}
  virtual void text(const char* /*name*/, std::string& /*value*/) {}
  virtual void text(const char* /*name*/, std::optional<std::string>& /*value*/) {}
  virtual void file(const char* /*name*/, std::filesystem::path& /*value*/) {}
  /// Three numbers, each of at most this magnitude.
  virtual void vector(const char* /*name*/, Vec3& /*value*/, double /*size_max*/) {}
  virtual void vector(const char* name, std::optional<Vec3>& value, double size_max) {
    optional(value, [&](Vec3& v) { vector(name, v, size_max); });
  }
  /// Index of a word; of none, that of another value.
  virtual void word(const char*, std::size_t&, std::span<const std::string_view>, const void* /*member*/) {}

  /// Child element, if there is one; true then.
  virtual bool element(const char* /*name*/, const Fields&) { return false; }
  /// All children of a name, of which there are `size` unless it reads.
  virtual void each(const char* /*name*/, std::size_t /*size*/, const EachFields&) {}

  /// Tells that the settings are wrong or odd, at an attribute.
  virtual void fault(std::string_view /*name*/, std::string /*problem*/) const {}
  virtual void warn(std::string_view /*name*/, const std::string& /*problem*/) const {}
  virtual void require(std::initializer_list<const char*> /*names*/) {}
  virtual void without_effect(std::initializer_list<const char*>, const char* = "has no effect") {}

  /// One of several words.
  template <class Value>
  void choice(const char* name, Value& value, std::initializer_list<std::pair<std::string_view, Value>> words) {
    std::vector<std::string_view> names;
    std::size_t index = words.size();
    for (const auto& [word, meaning] : words) {
      if (meaning == value && index == words.size()) index = names.size();
      names.push_back(word);
    }
    word(name, index, names, &value);
    if (reads() && index < words.size()) value = (words.begin() + index)->second;
  }
  /// All children of a name.
  template <class Settings>
  void children(const char* name, std::vector<Settings>& values) {
    children(name, values, [](FieldIo& inner, Settings& value) { value.fields(inner); });
  }
  template <class Settings, class Fields>
  void children(const char* name, std::vector<Settings>& values, const Fields& fields) {
    each(name, values.size(),
         [&](FieldIo& io, std::size_t i) { fields(io, reads() ? values.emplace_back() : values[i]); });
  }
  /// Attributes `x`, `y` and `z`.
  void components(Vec3& v, double largest = max_coordinate) {
    number("x", v.x, units::metre, -largest, largest);
    number("y", v.y, units::metre, -largest, largest);
    number("z", v.z, units::metre, -largest, largest);
  }
  /// Child with the components of a direction.
  void direction(const char* name, Vec3& v) {
    if (!reads() && !(length(v) > 0)) fault(name, name + std::string(" has no direction"));
    element(name, [&](FieldIo& inner) {
      Vec3 found = reads() ? Vec3{} : length(v) > 0.1 ? v : normalize(v);
      inner.components(found);
      if (!(length(found) > 0.1))
        return inner.warn("", text::joined({"<", name, "> is shorter than 0.1 and has no effect"}));
      if (reads()) v = found;
    });
  }

 private:
  template <class Value, class Read>
  void optional(std::optional<Value>& value, const Read& read) {
    if (!reads() && !value) return;
    Value found = reads() ? Value(std::numeric_limits<double>::quiet_NaN()) : *value;
    read(found);
    if (reads() && found == found) value = found;  // NaN: was not given
  }
};

/// Asks about an angle that is whole in radians and beyond a turn, or that a program gives and that is unusual [rad].
inline void ask_for_degrees(const FieldIo& io, const char* name, double angle, const XmlUnit& unit) {
  const bool is_unusual = unit.usual_max > 0 && std::fabs(angle) > unit.usual_max && !io.reads();
  if (std::string_view(unit.symbol) != "deg" || !(is_unusual || looks_like_degrees(angle))) return;
  const auto brief = [](double value) { return xml_number(std::round(value * 1e6) / 1e6); };
  io.warn(name, text::joined({name, " is ", brief(degrees(angle)), ", ", brief(angle / (2 * pi)),
                              " turns: given in degrees, not radians?"}));
}

/// `name="text"`, for messages.
[[nodiscard]] inline std::string said(std::string_view name, std::string_view text) {
  return text::joined({name, "=\"", text.substr(0, 80), text.size() > 80 ? "...\"" : "\""});
}

/// Throws a `SettingError` for members beyond their limits.
class FieldCheck : public FieldIo {
 public:
  using FieldIo::number, FieldIo::vector;
  void number(const char* name, double& v, const XmlUnit& unit, double low, double high) override {
    (void)document_number(name, v, unit, low, high);
  }
  void whole(const char* name, int& v, int low, int high) override { require_within(name, v, low, high, ""); }
  void vector(const char* name, Vec3& v, double size_max) override {
    for (int axis = 0; axis < 3; ++axis) require_within(name, v[axis], -size_max, size_max, "");
  }
  bool element(const char* /*name*/, const Fields& fields) override {
    fields(*this);
    return true;
  }
  void each(const char* name, std::size_t size, const EachFields& fields) override {
    for (std::size_t i = 0; i < size; ++i) naming(name + (" " + std::to_string(i)), [&] { fields(*this, i); });
  }
  void fault(std::string_view name, std::string problem) const override {
    const bool begins = problem.starts_with(name);
    throw SettingError(std::string(name), begins ? problem.substr(name.size()) : ": " + problem);
  }
};

/// Throws a `SettingError` for members beyond their limits, and for those that do not go together.
template <class Settings>
void check_fields(const Settings& settings) {
  FieldCheck check;
  const_cast<Settings&>(settings).fields(check);  // changes nothing, as it does not read
}

}  // namespace PULSECAST_NAMESPACE::helios

#endif
