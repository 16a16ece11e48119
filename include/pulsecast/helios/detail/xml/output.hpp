// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_XML_OUTPUT_HPP
#define PULSECAST_HELIOS_DETAIL_XML_OUTPUT_HPP

#include <pugixml.hpp>

#include <pulsecast/helios/detail/settings/fields.hpp>

namespace PULSECAST_NAMESPACE::helios {

/// Writes an element as `XmlInput` reads it: what that refuses is a `SettingError`, what it warns of a note.
class XmlOutput final : public FieldCheck {
 public:
  explicit XmlOutput(pugi::xml_node node, bool params = false) : node_(node), params_(params) {}

  [[nodiscard]] pugi::xml_node node() const noexcept { return node_; }

  using FieldCheck::number, FieldCheck::vector, FieldCheck::text;
  /// Writes a number. Infinity is left out: no attribute means no limit.
  void number(const char* name, double& v, const XmlUnit& unit, double low, double high) override {
    const double number = document_number(name, v, unit, low, high);
    if (std::isfinite(v)) put(name, xml_number(number), "double");
    ask_for_degrees(*this, name, v, unit);
  }
  void whole(const char* name, int& value, int low, int high) override {
    FieldCheck::whole(name, value, low, high);
    put(name, std::to_string(value), "integer");
  }
  void flag(const char* name, bool& v) override { put(name, v ? "true" : "false", "boolean"); }
  void text(const char* name, std::string& value) override { put(name, value); }
  void text(const char* name, std::optional<std::string>& value) override {
    if (value) put(name, *value);
  }
  void word(const char* name, std::size_t& index, std::span<const std::string_view> words,
            const void* /*member*/) override {
    if (index < words.size()) put(name, std::string(words[index]));
  }
  void vector(const char* name, Vec3& v, double size_max) override {
    FieldCheck::vector(name, v, size_max);
    put(name, xml_number(v.x) + ";" + xml_number(v.y) + ";" + xml_number(v.z), "vec3");
  }
  void file(const char* name, std::filesystem::path& value) override {
    if (!value.empty()) put(name, std::filesystem::absolute(value).string());
  }
  bool element(const char* name, const Fields& fields) override {
    child(name, "", fields);
    return true;
  }
  void each(const char* name, std::size_t size, const EachFields& fields) override {
    for (std::size_t i = 0; i < size; ++i)
      child(name, name + (" " + std::to_string(i)), [&](XmlOutput& inner) { fields(inner, i); });
  }
  void warn(std::string_view /*name*/, const std::string& problem) const override { notes_.push_back(problem); }

  /// Writes a child, whose errors and notes begin with a title, if that is not empty.
  void child(const char* name, const std::string& title, const std::function<void(XmlOutput&)>& write) {
    XmlOutput inner(node_.append_child(name));
    if (title.empty())
      write(inner);
    else
      naming(title, [&] { write(inner); });
    for (const std::string& note : inner.notes_) notes_.push_back(title + (title.empty() ? "" : ": ") + note);
  }
  /// Writes a text.
  void put(const char* name, const std::string& value, const char* type = "string") {
    if (!params_) return void(node_.append_attribute(name).set_value(value.c_str()));
    pugi::xml_node param = node_.append_child("param");
    param.append_attribute("type").set_value(type);
    param.append_attribute("key").set_value(name);
    param.append_attribute("value").set_value(value.c_str());
  }

  /// Of this element and those in it.
  [[nodiscard]] const std::vector<std::string>& notes() const noexcept { return notes_; }

 private:
  pugi::xml_node node_;
  bool params_;
  mutable std::vector<std::string> notes_;
};

}  // namespace PULSECAST_NAMESPACE::helios

#endif
