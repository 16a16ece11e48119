// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_XML_OUTPUT_HPP
#define PULSECAST_HELIOS_DETAIL_XML_OUTPUT_HPP

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <initializer_list>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <pugixml.hpp>

#include <pulsecast/base/error.hpp>
#include <pulsecast/base/require.hpp>
#include <pulsecast/base/vector.hpp>
#include <pulsecast/helios/detail/xml/number.hpp>

namespace PULSECAST_NAMESPACE::helios {

/// Words with their values.
template <class Value>
using XmlWords = std::initializer_list<std::pair<std::string_view, Value>>;

/// Writes an element, by the same calls as `XmlInput`. What that would refuse is a `SettingError`, and what it would
/// note is a note here, so that writing a survey checks its settings.
class XmlOutput {
 public:
  static constexpr bool reads = false;

  explicit XmlOutput(pugi::xml_node node, bool params = false) : node_(node), params_(params) {}

  [[nodiscard]] pugi::xml_node node() const noexcept { return node_; }

  /// Writes a number. Infinity is left out: no attribute means no limit.
  void number(const char* name, const double& value, const XmlUnit& unit, double low, double high) {
    double number = unit.number(value);
    if (const double limit = std::clamp(number, low, high); std::fabs(number - limit) <= 1e-12 * std::fabs(limit))
      number = limit;  // beyond it by the rounding of the unit
    if (!(number >= low && number <= high)) refuse(name, value, number, unit, low, high);
    if (std::isfinite(value)) put(name, "double", xml_number(number));
  }
  void number(const char* name, const std::optional<double>& value, const XmlUnit& unit, double low, double high) {
    if (value) number(name, *value, unit, low, high);
  }
  void whole(const char* name, const int& value, int low, int high) {
    require_within(name, value, low, high, "");
    put(name, "integer", std::to_string(value));
  }
  void flag(const char* name, const bool& value) { put(name, "boolean", value ? "true" : "false"); }
  void text(const char* name, const std::string& value) { put(name, "string", value); }
  void text(const char* name, const std::optional<std::string>& value) {
    if (value) put(name, "string", *value);
  }

  template <class Value>
  void choice(const char* name, const Value& value, XmlWords<Value> words) {
    for (const auto& [word, meaning] : words)
      if (meaning == value) return put(name, "string", std::string(word));
  }

  void vector(const char* name, const Vec3& value, double size_max) {
    for (int axis = 0; axis < 3; ++axis) require_within(name, value[axis], -size_max, size_max, "");
    put(name, "vec3", xml_number(value.x) + ";" + xml_number(value.y) + ";" + xml_number(value.z));
  }
  void vector(const char* name, const std::optional<Vec3>& value, double size_max) {
    if (value) vector(name, *value, size_max);
  }

  void file(const char* name, const std::filesystem::path& value) {
    if (!value.empty()) put(name, "string", std::filesystem::absolute(value).string());
  }

  template <class Write>
  void child(const char* name, Write write) {
    XmlOutput inner(node_.append_child(name));
    write(inner);
    take(inner, "");
  }

  template <class Value, class Fields>
  void children(const char* name, const std::vector<Value>& values, Fields fields) {
    for (std::size_t i = 0; i < values.size(); ++i)
      child_of(name, name + (" " + std::to_string(i)), [&](XmlOutput& inner) { fields(inner, values[i]); });
  }

  /// Writes a child whose errors and notes begin with `title`.
  template <class Write>
  void child_of(const char* name, const std::string& title, Write write) {
    XmlOutput inner(node_.append_child(name));
    naming(title, [&] { write(inner); });
    take(inner, title + ": ");
  }

  /// Refuses the settings; `problem` is the sentence of the reader.
  [[noreturn]] void fault(std::string_view name, const std::string& problem) const {
    const bool begins = !name.empty() && problem.starts_with(name);
    throw SettingError(std::string(name),
                       begins || name.empty() ? problem.substr(begins ? name.size() : 0) : ": " + problem);
  }
  void warn(std::string_view /*name*/, std::string problem) { notes_.push_back(std::move(problem)); }

  /// Of this element and those in it.
  [[nodiscard]] const std::vector<std::string>& notes() const noexcept { return notes_; }

  void without_effect(std::initializer_list<const char*> /*names*/, const char* /*why*/ = "") {}
  void require(std::initializer_list<const char*> /*names*/) {}

 private:
  void take(const XmlOutput& inner, const std::string& title) {
    for (const std::string& note : inner.notes_) notes_.push_back(title + note);
  }

  [[noreturn]] static void refuse(const char* name, double value, double number, const XmlUnit& unit, double low,
                                  double high) {
    const std::string bound = high < std::numeric_limits<double>::max() ? " to " + xml_number(high) : "";
    const std::string allowed =
        low > std::numeric_limits<double>::lowest() ? "from " + xml_number(low) + bound : "a number";
    throw SettingError(name, number, unit.symbol,
                       allowed + (std::string_view(unit.symbol) == units::degree.symbol && looks_like_degrees(value)
                                      ? ": given in degrees, not radians?"
                                      : ""));
  }

  void put(const char* name, const char* type, const std::string& value) {
    if (!params_) return void(node_.append_attribute(name).set_value(value.c_str()));
    pugi::xml_node param = node_.append_child("param");
    param.append_attribute("type").set_value(type);
    param.append_attribute("key").set_value(name);
    param.append_attribute("value").set_value(value.c_str());
  }

  pugi::xml_node node_;
  bool params_;
  std::vector<std::string> notes_;
};

}  // namespace PULSECAST_NAMESPACE::helios

#endif
