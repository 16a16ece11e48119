// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_LAS_UNITS_HPP
#define PULSECAST_IO_DETAIL_LAS_UNITS_HPP

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string>
#include <vector>

#include <pulsecast/base/vector.hpp>
#include <pulsecast/io/detail/las/rules.hpp>

namespace PULSECAST_NAMESPACE::io::detail {

/// Node of well-known text: `KEYWORD[content]`. Source: OGC 01-009, 7; OGC 18-010.
struct WktNode {
  std::string keyword;
  std::string_view content;
};

/// First node of a text; empty if it is not complete.
[[nodiscard]] inline WktNode wkt_node(std::string_view text) {
  const auto is_of_word = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
  std::size_t open = text.npos, depth = 0;
  bool is_quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '"') is_quoted = !is_quoted;
    if (is_quoted) continue;
    if (text[i] == '[' && depth++ == 0) open = i;
    if (text[i] != ']' || depth == 0 || --depth > 0) continue;
    std::size_t begin = open;
    while (begin > 0 && is_of_word(text[begin - 1])) --begin;
    return {std::string(text.substr(begin, open - begin)), text.substr(open + 1, i - open - 1)};
  }
  return {};
}

/// Metres per unit of length in the content of a node: the last one there, after those of parameters; 0 if unknown.
[[nodiscard]] inline double wkt_unit(std::string_view content) {
  for (std::size_t at = content.rfind("UNIT["); at != content.npos;
       at = at > 0 ? content.rfind("UNIT[", at - 1) : content.npos) {
    if (at > 0 && std::isalpha(static_cast<unsigned char>(content[at - 1])) != 0 &&
        !content.substr(0, at).ends_with("LENGTH"))
      continue;
    std::string_view rest = content.substr(std::min(content.find("\",", at), content.size()));
    rest.remove_prefix(std::min<std::size_t>(rest.size(), 2));
    rest = text::trimmed(rest);
    return text::take_number<double>(rest).value_or(0);
  }
  return 0;
}

/// Units of the coordinates of a LAS file by its well-known text, or else its GeoTIFF keys.
class LasUnits {
 public:
  LasUnits(const std::string& path, std::vector<std::string>& warnings) : path_(path), warnings_(warnings) {}

  /// Metres per unit of x, y and z. @throws FileError for a system that is refused
  [[nodiscard]] Vec3 by_wkt(std::string_view text) {
    WktNode node = wkt_node(text);
    while (node.keyword == "COMPD_CS" || node.keyword == "COMPOUNDCRS" || node.keyword == "BOUNDCRS" ||
           node.keyword == "SOURCECRS")
      node = wkt_node(node.content);
    ask("WKT " + node.keyword);
    const std::size_t vertical = std::min(text.find("VERT_CS["), text.find("VERTCRS["));
    const double unit = wkt_unit(node.content);
    return in_metres(unit > 0 ? unit : 1,
                     vertical < text.size() ? wkt_unit(wkt_node(text.substr(vertical)).content) : 0);
  }

  /// As `by_wkt`; `keys` are the body of a record. Source: OGC GeoTIFF 1.1, 7.1.2, annex B; EPSG.
  [[nodiscard]] Vec3 by_keys(std::string_view keys) {
    double unit = 1, vertical = 0;
    for (std::size_t at = 8; at + 8 <= keys.size(); at += 8) {
      std::array<std::uint16_t, 4> key{};  // number, place, count, value
      std::memcpy(key.data(), keys.data() + at, sizeof key);
      if (key[1] != 0) continue;
      if (key[0] == 1024) ask(text::message("GeoKey 1024: ", key[3]));
      if (key[0] == 3076) unit = by_code(key[3]);
      if (key[0] == 4099) vertical = by_code(key[3]);
    }
    return in_metres(unit, vertical);
  }

 private:
  void ask(const std::string& item) { keep_rule(las_rules, path_, "item", item, warnings_); }

  [[nodiscard]] double by_code(std::uint16_t code) {
    if (code != 9001 && code != 9002 && code != 9003) ask(text::message("other unit of EPSG:", code));
    return code == 9002 ? 0.3048 : code == 9003 ? 1200.0 / 3937.0 : 1;
  }

  [[nodiscard]] Vec3 in_metres(double unit, double vertical) {
    if (!(vertical > 0)) vertical = unit;
    for (const double u : {unit, vertical})
      if (!(u >= 1e-3 && u <= 1e3)) ask(text::message("other unit of ", u, " m"));
    if (unit != 1 || vertical != 1) ask(text::message("unit of ", unit, " m, of z ", vertical, " m"));
    return {unit, unit, vertical};
  }

  std::string path_;
  std::vector<std::string>& warnings_;
};

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
