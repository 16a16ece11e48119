// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <pulsecast/helios/settings.hpp>

/// The rows of settings as text, for pages and docstrings: each attribute with its values and default.
class FieldList final : public pulsecast::helios::FieldIo {
 public:
  struct Row {
    std::string name{};                  ///< in documents
    const void* member = nullptr;        ///< its place in the settings
    std::string values{};                ///< as in `deg, 0 to 180`
    std::optional<std::string> value{};  ///< what the settings have; none if it is absent

    /// True if it is a member of settings, or a part of one.
    template <class Member>
    [[nodiscard]] bool is_of(const Member& of) const {
      const auto *const begin = reinterpret_cast<const char*>(&of), *const place = static_cast<const char*>(member);
      return std::less_equal()(begin, place) && std::less()(place, begin + sizeof of);
    }
  };

  /// Of settings, with their values as defaults.
  template <class Settings>
  explicit FieldList(Settings& settings) {
    settings.fields(*this);
  }

  [[nodiscard]] const std::vector<Row>& rows() const noexcept { return rows_; }
  [[nodiscard]] bool is_required(std::string_view name) const {
    return std::find(required_.begin(), required_.end(), name) != required_.end();
  }

  using XmlUnit = pulsecast::helios::XmlUnit;
  using Vec3 = pulsecast::Vec3;
  void number(const char* name, double& value, const XmlUnit& unit, double low, double high) override {
    add(name, &value, range(unit, low, high), text_of(unit, value));
  }
  void number(const char* name, std::optional<double>& value, const XmlUnit& unit, double low, double high) override {
    add(name, &value, range(unit, low, high), value ? text_of(unit, *value) : std::nullopt);
  }
  void whole(const char* name, int& value, int low, int high) override {
    add(name, &value, range({}, low, high), std::to_string(value));
  }
  void flag(const char* name, bool& value) override { add(name, &value, "flag", value ? "`true`" : "`false`"); }
  void text(const char* name, std::string& value) override {
    add(name, &value, "text", value.empty() ? std::nullopt : std::optional(value));
  }
  void text(const char* name, std::optional<std::string>& value) override { add(name, &value, "text", value); }
  void file(const char* name, std::filesystem::path& value) override { add(name, &value, "path", std::nullopt); }
  void vector(const char* name, Vec3& value, double) override { add(name, &value, "vector", vector_text(value)); }
  void vector(const char* name, std::optional<Vec3>& value, double) override {
    add(name, &value, "vector", value ? std::optional(vector_text(*value)) : std::nullopt);
  }
  void word(const char* name, std::size_t& index, std::span<const std::string_view> words,
            const void* member) override {
    std::string all;
    for (const std::string_view word : words) all.append(all.empty() ? "`" : ", `").append(word).append("`");
    add(name, member, all, index < words.size() ? std::optional("`" + std::string(words[index]) + "`") : std::nullopt);
  }
  bool element(const char*, const std::function<void(FieldIo&)>&) override { return false; }  // has a list of its own
  void each(const char*, std::size_t, const std::function<void(FieldIo&, std::size_t)>&) override {}
  void fault(std::string_view, std::string) const override {}
  void require(std::initializer_list<const char*> names) override {
    required_.insert(required_.end(), names.begin(), names.end());
  }

 private:
  void add(const char* name, const void* member, std::string values, std::optional<std::string> value) {
    rows_.push_back({name, member, std::move(values), std::move(value)});
  }

  /// Shortest number, of at most six digits.
  static std::string number_text(double value) {
    std::array<char, 32> digits{};
    std::string all(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr);
    if (all.size() > 9)
      all.assign(digits.data(),
                 std::to_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::general, 4).ptr);
    if (value >= 1000 && all.find_last_not_of('0') == 0)
      all = std::string(1, all.front()) + "e" + std::to_string(all.size() - 1);
    for (const char* const part : {"e+0", "e+", "e-0"})
      if (const std::size_t at = all.find(part); at != std::string::npos)
        all.replace(at, std::string_view(part).size(), part[1] == '-' ? "e-" : "e");
    return all;
  }

  static std::optional<std::string> text_of(const XmlUnit& unit, double value) {
    if (value == any) return std::nullopt;
    return number_text(unit.number(value));
  }
  static std::string vector_text(const Vec3& v) {
    return number_text(v.x) + ";" + number_text(v.y) + ";" + number_text(v.z);
  }

  static std::string range(const XmlUnit& unit, double low, double high) {
    std::string symbol = unit.symbol;
    if (const std::size_t square = symbol.find("^2"); square != std::string::npos) symbol.replace(square, 2, "²");
    const std::string limits = low <= -1e300  ? ""
                               : high > 1e300 ? "from " + number_text(low)
                                              : number_text(low) + " to " + number_text(high);
    if (symbol.empty()) return limits.empty() ? "number" : limits;
    return limits.empty() ? symbol : symbol + ", " + limits;
  }

  std::vector<Row> rows_;
  std::vector<std::string> required_;
};
