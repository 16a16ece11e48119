// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_SIDE_FILES_HPP
#define PULSECAST_IO_DETAIL_SIDE_FILES_HPP

#include <pulsecast/io/detail/raster_rules.hpp>
#include <pulsecast/io/detail/reference_reader.hpp>
#include <pulsecast/io/world_file.hpp>

namespace PULSECAST_NAMESPACE::io::detail {

/// Reads the files beside a raster, but masks and world files. `is_silent`: the raster names no system of its own;
/// `heights`: unit of heights without one. @throws FileError by the rules
[[nodiscard]] inline SpatialReference read_side_files(const std::filesystem::path& raster,
                                                      std::vector<std::string>& warnings, HeightUnit heights,
                                                      bool is_silent = true) {
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
    text = text.substr(text.rfind('>', text.find('[')) + 1);  // of an element in it, as Esri writes
    text = text.substr(0, text.find('<'));
    for (; !text.empty(); text.remove_prefix(1)) {
      wkt += text.starts_with("&quot;") ? '"' : text.front();
      if (text.starts_with("&quot;")) text.remove_prefix(5);
    }
  }
  if (!is_silent) return {};
  if (!wkt.empty()) return ReferenceReader(aux, heights, warnings).by_text(wkt);
  for (const std::filesystem::path& path : {prj, upper_prj})
    if (is_file(path))
      return ReferenceReader(path, heights, warnings)
          .by_text(InputFile(path, "a reference system").take(InputFile::block_size));
  return {};
}

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
