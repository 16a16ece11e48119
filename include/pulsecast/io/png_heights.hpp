// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_PNG_HEIGHTS_HPP
#define PULSECAST_IO_PNG_HEIGHTS_HPP

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>

#include <pulsecast/base/compiled.hpp>
#include <pulsecast/base/require.hpp>
#include <pulsecast/base/text.hpp>
#include <pulsecast/base/vector.hpp>
#include <pulsecast/shape/raster.hpp>

namespace PULSECAST_NAMESPACE::io {

/// Settings for heights in PNG files.
struct PngHeightSettings {
  double vertical_scale = 1;               ///< metres per unit of grey [m]
  double vertical_offset = 0;              ///< height of grey 0, black [m]
  std::optional<std::uint16_t> missing{};  ///< grey of missing heights
  std::optional<Vec2>
      pixel{};  ///< spacing of the pixels, to the east and the south [m]; by default from the world file
  std::optional<Vec2>
      first{};  ///< centre of the pixel in the north-west [m]; by default from the world file, or (0, 0) beside `pixel`
  std::size_t max_pixels = std::size_t{1} << 28;  ///< pixels at most

  void validate() const {
    require_positive("PngHeightSettings::vertical_scale", vertical_scale, "m");
    require_within("PngHeightSettings::vertical_offset", vertical_offset, -1e15, 1e15, "m");
    for (const double size : {pixel ? pixel->x : 1, pixel ? pixel->y : 1})
      require_within("PngHeightSettings::pixel", size, 1e-9, 1e6, "m");
    for (const double place : {first ? first->x : 0, first ? first->y : 0})
      require_within("PngHeightSettings::first", place, -1e15, 1e15, "m");
  }
};

/// Reads a raster of heights from a PNG file of grey, 8 or 16 bits, north up. Its heights are packed: two bytes a
/// pixel. Coordinates are in metres; the place of pixels is that of the settings, or of a world file beside the picture
/// (`world_file_of`). Memory is twice the raster, as far as the size of the file allows. Checksums of the file are not
/// compared.
/// @throws SettingError for settings out of range
/// @throws FileError for a file that is damaged, coloured, transparent, of fewer bits, or too large, without a place,
/// or without a height
[[nodiscard]] Raster read_png_heights(const std::filesystem::path& path, const PngHeightSettings& settings = {});

/// True for the extension `.png`, in any case.
[[nodiscard]] inline bool is_png(const std::filesystem::path& path) {
  return text::is_same_word(path.extension().string(), ".png");
}

}  // namespace PULSECAST_NAMESPACE::io

#if PULSECAST_DEFINITIONS
#include <pulsecast/io/detail/png_heights_reader.hpp>
#endif

#endif
