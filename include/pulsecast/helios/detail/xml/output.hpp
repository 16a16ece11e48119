// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_XML_OUTPUT_HPP
#define PULSECAST_HELIOS_DETAIL_XML_OUTPUT_HPP

#include <cmath>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <pugixml.hpp>

#include <pulsecast/base/vector.hpp>
#include <pulsecast/helios/detail/xml/number.hpp>

namespace PULSECAST_NAMESPACE::helios {

/// Words with their values.
template <class Value>
using XmlWords = std::initializer_list<std::pair<std::string_view, Value>>;

/// Writes an element, by the same calls as `XmlInput`.
class XmlOutput {
 public:
  static constexpr bool reads = false;

  explicit XmlOutput(pugi::xml_node node, bool params = false) : node_(node), params_(params) {}

  [[nodiscard]] pugi::xml_node node() const noexcept { return node_; }

  /// Writes a number. Infinity is left out: no attribute means no limit.
  void number(const char* name, const double& value, const XmlUnit& unit, double /*low*/, double /*high*/) {
    if (std::isfinite(value)) put(name, "double", xml_number(unit.number(value)));
  }
  void number(const char* name, const std::optional<double>& value, const XmlUnit& unit, double low, double high) {
    if (value) number(name, *value, unit, low, high);
  }
  void whole(const char* name, const int& value, int /*low*/, int /*high*/) { put(name, "integer", std::to_string(value)); }
  void flag(const char* name, const bool& value) { put(name, "boolean", value ? "true" : "false"); }
  void text(const char* name, const std::string& value) { put(name, "string", value); }
  void text(const char* name, const std::optional<std::string>& value) {
    if (value) put(name, "string", *value);
  }

  template <class Value>
  void choice(const char* name, const Value& value, XmlWords<Value> words) {
    for (const auto& [word, meaning] : words) {
      if (meaning != value) continue;
      put(name, "string", std::string(word));
      return;
    }
  }

  void vector(const char* name, const Vec3& value, double /*size_max*/) {
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
  }

  template <class Value, class Fields>
  void children(const char* name, const std::vector<Value>& values, Fields fields) {
    for (const Value& value : values) {
      XmlOutput inner(node_.append_child(name));
      fields(inner, value);
    }
  }

  void without_effect(std::initializer_list<const char*> /*names*/, const char* /*why*/ = "") {}
  void require(std::initializer_list<const char*> /*names*/) {}

 private:
  void put(const char* name, const char* type, const std::string& value) {
    if (!params_) {
      node_.append_attribute(name).set_value(value.c_str());
      return;
    }
    pugi::xml_node param = node_.append_child("param");
    param.append_attribute("type").set_value(type);
    param.append_attribute("key").set_value(name);
    param.append_attribute("value").set_value(value.c_str());
  }

  pugi::xml_node node_;
  bool params_;
};

}  // namespace PULSECAST_NAMESPACE::helios

#endif
