// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_WORLD_FILE_HPP
#define PULSECAST_IO_WORLD_FILE_HPP

#include <filesystem>

#include <pulsecast/base/compiled.hpp>
#include <pulsecast/base/text.hpp>
#include <pulsecast/shape/raster.hpp>

namespace PULSECAST_NAMESPACE::io {

/// Placement of the pixels of a picture on the map.
struct WorldFile {
  Vec2 first{};      ///< centre of the first pixel of the file [m east, m north]
  Vec2 step{1, -1};  ///< step of a column to the east, above 0, and of a row to the north [m]
};

/// Reads a world file: six lines with the east and north step of a column, those of a row, and the
/// place of the first pixel's centre. Throws a `FileError` with the line for other lines, a rotated
/// or sheared picture, columns to the west, and steps or places beyond those of a `Raster`. Source:
/// Esri, ArcGIS documentation, "World files for raster datasets".
[[nodiscard]] WorldFile read_world_file(const std::filesystem::path& path);

/// Paths of world files beside a picture, in order of search: with the first and last letter of its
/// extension and a `w`, as in `dem.pgw`, all of it and a `w`, or `.wld`; then in capitals.
[[nodiscard]] std::vector<std::filesystem::path> world_files_of(const std::filesystem::path& picture);

/// The first of them that exists; empty if there is none.
[[nodiscard]] std::filesystem::path world_file_of(const std::filesystem::path& picture);

/// Paths of other files beside a raster that its readers look for: GDAL's `.aux.xml`, `.prj`, also in capitals, and the
/// mask of a GeoTIFF, `.msk`.
[[nodiscard]] inline std::array<std::filesystem::path, 4> side_files_of(const std::filesystem::path& raster) {
  const auto as = [&](const char* extension) { return std::filesystem::path(raster).replace_extension(extension); };
  return {raster.string() + ".aux.xml", as(".prj"), as(".PRJ"), raster.string() + ".msk"};
}

namespace detail {

/// Question about a raster that may be in degrees: on the globe, with pixels up to 0.0083 degrees, of whole minutes
/// that are no whole millimetres, or around the globe; empty for others. Source: USGS, GTOPO30 documentation (30 arc
/// seconds).
[[nodiscard]] inline std::string degrees_question(const Raster& raster) {
  const Vec2 first = raster.first, pixel = raster.pixel;
  const Vec2 last = first + Vec2((raster.columns - 1) * pixel.x, -((raster.rows - 1) * pixel.y));
  const bool on_globe =
      std::max(std::fabs(first.x), std::fabs(last.x)) <= 361 && std::max(std::fabs(first.y), std::fabs(last.y)) <= 91;
  const auto is_whole = [](double number) { return std::fabs(number - std::round(number)) < 1e-3; };
  const bool has_minutes = is_whole(60 * pixel.x) && !is_whole(1000 * pixel.x);
  const bool is_around = std::fabs(raster.columns * pixel.x - 360) < 0.5 * pixel.x;
  if (!on_globe || (pixel.x >= 0.01 && !has_minutes && !is_around)) return {};
  return text::message("has pixels of ", pixel.x, " m at (", first.x, ", ", first.y,
                       "): is it in degrees? Expected metres; gdalwarp -t_srs EPSG:CODE makes them");
}

/// True for numbers that often mark missing heights. Source: Esri, NODATA_value (-9999); Rodriguez
/// et al. 2005, JPL D-31639, on SRTM (-32768); GDAL manual, DTED driver (-32767).
[[nodiscard]] inline bool may_be_missing(double value) noexcept {
  return value == -9999 || value == -32768 || value == -32767 || value == -99999 || value == -999999 || value == 65535;
}

}  // namespace detail

}  // namespace PULSECAST_NAMESPACE::io

#if PULSECAST_DEFINES(IO_WORLD_FILE)
#include <system_error>

#include <pulsecast/io/detail/text/table.hpp>

namespace PULSECAST_NAMESPACE::io {

PULSECAST_INLINE WorldFile read_world_file(const std::filesystem::path& path) {
  TextTable table(path, "a world file of six lines");
  std::array<double, 6> values{};
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!table.next()) table.fail("ends after ", i, " numbers: expected six, a line each");
    const std::optional<double> value = text::finite_number_in(table.text());
    if (!value) table.refuse(table.text(), "a number, with a decimal point");
    const bool is_place = i >= 4, is_size = i == 0 || i == 3;
    const double size = std::fabs(*value);
    if (is_place && !(size <= 1e15)) table.refuse(table.text(), "a place within 1e15 m");
    if (is_size && !(size >= 1e-9 && size <= 1e6))
      table.refuse(table.text(), "the size of a pixel, from 1e-9 m to 1e6 m");
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
  const std::string begin = extension.substr(0, 2) + extension.back();
  using Texts = std::initializer_list<std::string>;
  for (const std::string& name : Texts{begin + "w", extension + "w", ".wld", begin + "W", extension + "W", ".WLD"})
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
