// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <pulsecast/helios/detail/xml/element.hpp>

namespace pulsecast::support {

/// What may happen to a document that somebody edits.
enum class DamageKind { attribute_misspelt, number_spoilt, unit_absurd, file_missing, id_wrong };

/// A copy of a document with one thing wrong.
struct Damage {
  DamageKind kind{};
  std::string text{};    ///< of the damaged document
  std::size_t line = 0;  ///< where the damage is, from 1
  std::string wrong{};   ///< what was put there
  std::string mended{};  ///< the name that was misspelt
};

namespace detail {

struct Attribute {
  std::size_t name_begin, name_end, value_begin, value_end;
};

/// All attributes of a document, in order, but for those of the declaration and in comments.
inline std::vector<Attribute> attributes(const std::string& text) {
  std::vector<Attribute> all;
  for (std::size_t at = 0; (at = text.find('<', at)) != std::string::npos;) {
    if (text.compare(at, 4, "<!--") == 0) at = text.find("-->", at);
    const std::size_t end = text.find('>', at);
    if (text[at + 1] != '?' && text[at] == '<')
      for (std::size_t equal = at; (equal = text.find("=\"", equal)) < end;) {
        const std::size_t begin = text.find_last_of(" \n", equal) + 1, value = equal + 2;
        all.push_back({begin, equal, value, text.find('"', value)});
        equal = all.back().value_end;
      }
    at = end;
  }
  return all;
}

/// Whether an attribute holds numbers, rather than names.
inline bool holds_numbers(std::string_view name, std::string_view value) {
  if (name == "id" || name == "stripId" || name == "name") return false;
  return helios::number_of(value.substr(0, value.find_first_of(",;"))).has_value();
}

/// A figure that makes no sense for an attribute; empty if there is none.
inline std::string absurd(std::string_view name) {
  static constexpr std::pair<const char*, const char*> figures[] = {
      {"_deg", "1e9"},    {"_hz", "-20000"},   {"_Hz", "-1e9"}, {"_ns", "-1"},  {"_rad", "3000"}, {"_m", "-3"},
      {"_km", "0"},       {"_nm", "1e9"},      {"_s", "-7"},    {"_w", "-4"},   {"_W", "-1"},     {"angle", "1e9"},
      {"numFibers", "0"}, {"Efficiency", "2"}, {"loop", "-1"},  {"Step", "-1"}, {"drag", "-1"},   {"stdev", "-1"},
      {"Quality", "0"},   {"maxNOR", "-1"},    {"Index", "-1"}};
  for (const auto& [end, figure] : figures)
    if (name.ends_with(end)) return figure;
  return "";
}

}  // namespace detail

/// All copies of a document with one thing wrong that this can think of.
inline std::vector<Damage> damages(const std::string& text) {
  std::vector<Damage> all;
  for (const detail::Attribute& a : detail::attributes(text)) {
    const std::string name = text.substr(a.name_begin, a.name_end - a.name_begin);
    const std::string value = text.substr(a.value_begin, a.value_end - a.value_begin);
    const auto add = [&](DamageKind kind, std::size_t begin, std::size_t end, const std::string& wrong,
                         std::string mended = "") {
      const auto line =
          static_cast<std::size_t>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(begin), '\n')) +
          1;
      all.push_back({kind, std::string(text).replace(begin, end - begin, wrong), line, wrong, std::move(mended)});
    };
    std::string misspelt = name;
    if (name.size() < 3) {
      misspelt += name.back();
    } else if (name[1] != name[2]) {
      std::swap(misspelt[1], misspelt[2]);
    } else {
      misspelt.erase(1, 1);
    }
    add(DamageKind::attribute_misspelt, a.name_begin, a.name_end, misspelt, name);
    if (detail::holds_numbers(name, value)) {
      for (const std::string& spoilt : std::vector<std::string>{value + "x", "", "nan", "1.2.3"}) {
        if (name == "value" && spoilt.empty()) continue;
        add(DamageKind::number_spoilt, a.value_begin, a.value_end, spoilt);
      }
      if (const std::string figure = detail::absurd(name); !figure.empty())
        add(DamageKind::unit_absurd, a.value_begin, a.value_end, figure);
    }
    const bool is_file = value.ends_with(".obj") || value.ends_with(".vox") || value.ends_with(".tif") ||
                         value.ends_with(".mtl") || value.ends_with(".trj") || value.ends_with(".txt") ||
                         value.ends_with(".xyz");
    const std::size_t sign = value.find(".xml#");
    if (is_file || sign != std::string::npos) add(DamageKind::file_missing, a.value_begin, a.value_begin, "missing_");
    if (sign != std::string::npos) add(DamageKind::id_wrong, a.value_begin + sign + 5, a.value_end, "nobody");
    if (name == "template" || name == "next") add(DamageKind::id_wrong, a.value_begin, a.value_end, "nobody");
  }
  return all;
}

}  // namespace pulsecast::support
