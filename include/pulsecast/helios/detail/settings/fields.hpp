// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_SETTINGS_FIELDS_HPP
#define PULSECAST_HELIOS_DETAIL_SETTINGS_FIELDS_HPP

#include <filesystem>
#include <functional>
#include <initializer_list>
#include <span>
#include <vector>

#include <pulsecast/helios/detail/xml/number.hpp>

/// Tables of settings: `fields(FieldIo&)` of a struct has a row for each member, with its name,
/// unit and limits in documents. Validation, XML, Python and the tables of docs/surveys.md visit them.
namespace PULSECAST_NAMESPACE::helios {

/// Visitor of the members of settings, in the order of documents; sets them only if it `reads`.
/// This one does nothing.
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
