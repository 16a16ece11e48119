// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_SIDE_FILES_HPP
#define PULSECAST_IO_DETAIL_SIDE_FILES_HPP

#include <pulsecast/io/detail/raster_rules.hpp>
#include <pulsecast/io/spatial_reference.hpp>
#include <pulsecast/io/world_file.hpp>

namespace PULSECAST_NAMESPACE::io::detail {

/// Metres a unit, the last of a part of well-known text: that of its axes; empty if it has none.
[[nodiscard]] inline std::optional<double> last_unit(std::string_view part) {
  const std::size_t at = part.rfind("UNIT[");
  const std::size_t comma = at == part.npos ? at : part.find("\",", at);
  if (comma == part.npos) return std::nullopt;
  part = text::trimmed(part.substr(comma + 2));
  const std::optional<double> metres = text::finite_number_in(text::trimmed(part.substr(0, part.find_first_of(",]"))));
  return metres && *metres >= 1e-6 && *metres <= 1e6 ? metres : std::nullopt;
}

/// Reference system by its well-known text; heights without a unit have the unit 1. Source: OGC 01-009, 7; OGC 18-010.
[[nodiscard]] inline SpatialReference reference_of(std::string_view wkt, const std::filesystem::path& path,
                                                   std::vector<std::string>& warnings) {
  const auto keep = [&](std::string_view name) { keep_rule(side_file_rules, path, "item", name, warnings); };
  const auto find = [wkt](auto... keys) { return std::min({wkt.find(keys)...}); };
  const std::size_t projected = find("PROJCS[", "PROJCRS[", "PROJECTEDCRS["), local = find("LOCAL_CS[", "ENGCRS["),
                    compound = find("COMPD_CS[", "COMPOUNDCRS["), target = find("TARGETCRS["),
                    vertical = find("VERT_CS[", "VERTCS[", "VERTCRS[", "VERTICALCRS["),
                    globe = find("GEOGCS[", "GEOCCS[", "GEOGCRS[", "GEODCRS[", "GEOGRAPHIC", "Geographic");
  if (projected == wkt.npos && local == wkt.npos && globe != wkt.npos) keep("reference system in degrees");
  const std::string_view up = wkt.substr(std::min(vertical, wkt.size()));
  if (up.find(",DOWN") != up.npos || up.find(",down") != up.npos || up.find("\"Direction\",-1") != up.npos)
    keep("reference system of depths");
  const std::optional<double> unit = last_unit(wkt.substr(0, std::min(vertical, target))), height = last_unit(up);
  if (!unit) keep("reference system without a unit");
  const std::size_t begin = std::min({projected, local, compound, wkt.size()}), end = wkt.rfind(']') + 1;
  SpatialReference made{.unit = unit.value_or(1), .vertical_unit = height.value_or(1)};
  if (begin < end) made.wkt = wkt.substr(begin, end - begin);
  if (made.unit != 1 && !height) keep("reference system not in metres, without heights");
  return made;
}

/// Reads the files beside a raster, but masks and world files. `is_silent`: the raster names no system of its own.
/// @throws FileError by the rules
[[nodiscard]] inline SpatialReference read_side_files(const std::filesystem::path& raster,
                                                      std::vector<std::string>& warnings, bool is_silent = true) {
  const auto is_file = [](const std::filesystem::path& path) {
    std::error_code ignored;
    return std::filesystem::is_regular_file(path, ignored) && std::filesystem::file_size(path, ignored) > 0;
  };
  const auto [aux, prj, upper_prj, mask] = side_files_of(raster);
  std::string wkt;
  if (is_file(aux)) {
    const MappedFile file(aux);
    std::string_view text = file.text();
    for (const FormatRule& rule : side_file_rules)
      if (rule.name.starts_with('<') && text.find(rule.name) != text.npos)
        keep_rule(side_file_rules, aux, "element", rule.name, warnings);
    text = text.substr(std::min(text.find("<SRS"), text.size()));
    text = text.substr(0, std::min(text.find("</SRS>"), InputFile::block_size));
    for (; !text.empty(); text.remove_prefix(1)) {
      wkt += text.starts_with("&quot;") ? '"' : text.front();
      if (text.starts_with("&quot;")) text.remove_prefix(5);
    }
  }
  if (!is_silent) return {};
  if (!wkt.empty()) return reference_of(wkt, aux, warnings);
  for (const std::filesystem::path& path : {prj, upper_prj})
    if (is_file(path))
      return reference_of(InputFile(path, "a reference system").take(InputFile::block_size), path, warnings);
  return {};
}

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
