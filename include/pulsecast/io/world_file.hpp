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
  Vec2 step{1, -1};  ///< step to the next column in the east, above 0, and to the next row in the north, below 0 for
                     ///< rows to the south [m]
};

/// Reads a world file: six lines with the east step of a column, its north step, the east step of a row, its north
/// step, and the place of the first pixel's centre. Throws a `FileError` with the line for another number of lines,
/// what is no number, a rotated or sheared picture, columns to the west, and steps or places beyond those of a
/// `Raster`. Source: Esri, ArcGIS documentation, "World files for raster datasets".
[[nodiscard]] WorldFile read_world_file(const std::filesystem::path& path);

/// Paths of world files beside a picture, in the order in which they are looked for: the picture's path with the first
/// and last letter of its extension and a `w`, as in `dem.pgw`, its whole extension and a `w`, or `.wld`; then in
/// capitals.
[[nodiscard]] std::vector<std::filesystem::path> world_files_of(const std::filesystem::path& picture);

/// The first of them that exists; empty if there is none.
[[nodiscard]] std::filesystem::path world_file_of(const std::filesystem::path& picture);

}  // namespace PULSECAST_NAMESPACE::io

#if PULSECAST_DEFINITIONS
#include <pulsecast/io/detail/world_file_reader.hpp>
#endif

#endif
