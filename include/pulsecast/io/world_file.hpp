// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_WORLD_FILE_HPP
#define PULSECAST_IO_WORLD_FILE_HPP

#include <filesystem>
#include <vector>

#include <pulsecast/base/compiled.hpp>
#include <pulsecast/base/vector.hpp>

namespace PULSECAST_NAMESPACE::io {

/// Placement of the pixels of a picture on the map.
struct WorldFile {
  Vec2 first{};      ///< centre of the first pixel of the file [m east, m north]
  Vec2 step{1, -1};  ///< east step of a column, above 0, and north step of a row, below 0 for rows to the south [m]
};

/// Reads a world file: six lines with the east step of a column, its north step, the east step of a row, its north
/// step, and the place of the first pixel's centre. Throws a `FileError` with the line for another number of lines,
/// what is no number, a rotated or sheared picture, columns to the west, and steps or places beyond those of a
/// `Raster`. Source: Esri, ArcGIS documentation, "World files for raster datasets".
[[nodiscard]] WorldFile read_world_file(const std::filesystem::path& path);

/// Paths of world files beside a picture, in the order of search: the picture's path with the first and last letter of
/// its extension and a `w`, as in `dem.pgw`, its whole extension and a `w`, or `.wld`; then in capitals.
[[nodiscard]] std::vector<std::filesystem::path> world_files_of(const std::filesystem::path& picture);

/// The first of them that exists; empty if there is none.
[[nodiscard]] std::filesystem::path world_file_of(const std::filesystem::path& picture);

}  // namespace PULSECAST_NAMESPACE::io

#if PULSECAST_DEFINES(IO_WORLD_FILE)
#include <array>
#include <cmath>
#include <system_error>

#include <pulsecast/io/detail/text/table.hpp>

namespace PULSECAST_NAMESPACE::io {

PULSECAST_INLINE WorldFile read_world_file(const std::filesystem::path& path) {
  TextTable table(path, "a world file of six lines");
  std::array<double, 6> values{};
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!table.next()) table.fail("ends after " + std::to_string(i) + " numbers: expected six, a line each");
    const std::optional<double> value = text::finite_number_in(table.text());
    if (!value) table.fail_here(text::quoted(table.text()) + ": expected a number, with a decimal point");
    const bool is_place = i >= 4, is_size = i == 0 || i == 3;
    if (is_place && !(std::fabs(*value) <= 1e15))
      table.fail_here(text::quoted(table.text()) + ": expected a place within 1e15 m");
    if (is_size && !(std::fabs(*value) >= 1e-9 && std::fabs(*value) <= 1e6))
      table.fail_here(text::quoted(table.text()) + ": expected the size of a pixel, from 1e-9 m to 1e6 m");
    if (i == 0 && *value < 0) table.fail_here("has columns that go west: expected a positive width of the pixels");
    if (!is_place && !is_size && *value != 0)
      table.fail_here("is rotated or sheared: expected 0; resampling to north up makes it so");
    values[i] = *value;
  }
  if (table.next()) table.fail_here("is a line too many: expected six");
  return {.first = {values[4], values[5]}, .step = {values[0], values[3]}};
}

PULSECAST_INLINE std::vector<std::filesystem::path> world_files_of(const std::filesystem::path& picture) {
  const std::string extension = picture.extension().string();
  std::vector<std::filesystem::path> all;
  if (extension.size() < 3) return all;
  for (const char* const w : {"w", "W"})
    for (const std::string& name :
         {extension.substr(0, 2) + extension.back() + w, extension + w, std::string(*w == 'w' ? ".wld" : ".WLD")})
      all.push_back(std::filesystem::path(picture).replace_extension(name));
  return all;
}

PULSECAST_INLINE std::filesystem::path world_file_of(const std::filesystem::path& picture) {
  std::error_code ignored;
  for (std::filesystem::path& beside : world_files_of(picture))
    if (std::filesystem::exists(beside, ignored)) return std::move(beside);
  return {};
}

}  // namespace PULSECAST_NAMESPACE::io

#endif

#endif
