// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <sstream>
#include <string>
#include <vector>

namespace pulsecast::support {

/// PLY file from what it holds.
struct PlyBuilder {
  struct Element {
    std::string name;
    std::vector<std::string> properties;      ///< as in "float x", "list uchar int vertex_indices"
    std::vector<std::vector<double>> rows{};  ///< numbers; those of a list after their count
  };
  std::vector<Element> elements;
  std::string format = "ascii";
  std::string remarks{};  ///< further lines of the header

  [[nodiscard]] std::string bytes() const {
    std::string text = "ply\nformat " + format + " 1.0\n" + remarks;
    for (const Element& one : elements) {
      text += "element " + one.name + ' ' + std::to_string(one.rows.size()) + '\n';
      for (const std::string& property : one.properties) text += "property " + property + '\n';
    }
    text += "end_header\n";
    for (const Element& one : elements)
      for (const std::vector<double>& row : one.rows) put_row(text, one, row);
    return text;
  }

  /// This file in another format.
  [[nodiscard]] std::string bytes(const std::string& other) const {
    PlyBuilder copy = *this;
    copy.format = other;
    return copy.bytes();
  }

 private:
  void put_row(std::string& text, const Element& of, const std::vector<double>& row) const {
    if (format == "ascii") {
      for (std::size_t k = 0; k < row.size(); ++k) {
        std::array<char, 40> number{};
        std::snprintf(number.data(), number.size(), "%.17g", row[k]);
        text += (k > 0 ? " " : "") + std::string(number.data());
      }
      text += '\n';
      return;
    }
    auto value = row.begin();
    for (const std::string& property : of.properties) {
      std::istringstream words(property);
      std::string type, item;
      words >> type;
      if (type != "list") {
        put(text, type, *value++);
        continue;
      }
      words >> type >> item;
      const double count = *value++;
      put(text, type, count);
      for (double k = 0; k < count; ++k) put(text, item, *value++);
    }
  }

  void put(std::string& text, const std::string& type, double value) const {
    const auto is = [&](const char* a, const char* b) { return type == a || type == b; };
    if (is("char", "int8")) add(text, static_cast<std::int8_t>(value));
    if (is("uchar", "uint8")) add(text, static_cast<std::uint8_t>(value));
    if (is("short", "int16")) add(text, static_cast<std::int16_t>(value));
    if (is("ushort", "uint16")) add(text, static_cast<std::uint16_t>(value));
    if (is("int", "int32")) add(text, static_cast<std::int32_t>(value));
    if (is("uint", "uint32")) add(text, static_cast<std::uint32_t>(value));
    if (is("float", "float32")) add(text, static_cast<float>(value));
    if (is("double", "float64")) add(text, value);
  }

  template <class Number>
  void add(std::string& text, Number value) const {
    auto raw = std::bit_cast<std::array<char, sizeof(Number)>>(value);
    if ((format == "binary_big_endian") == (std::endian::native == std::endian::little)) std::ranges::reverse(raw);
    text.append(raw.data(), raw.size());
  }
};

/// Three places of vertices as numbers of a type, and a triangle of them.
[[nodiscard]] inline PlyBuilder ply_triangle(const std::string& type = "float") {
  return {.elements = {{"vertex", {type + " x", type + " y", type + " z"}, {{0, 0, 5}, {3, 0, 5}, {0, 2, 5}}},
                       {"face", {"list uchar int vertex_indices"}, {{3, 0, 1, 2}}}}};
}

}  // namespace pulsecast::support
