// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_GEOTIFF_COLOUR_TABLE_HPP
#define PULSECAST_IO_DETAIL_GEOTIFF_COLOUR_TABLE_HPP

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <tiffio.h>

#include <pulsecast/base/vector.hpp>
#include <pulsecast/io/detail/geotiff/tiff_file.hpp>

namespace PULSECAST_NAMESPACE::io::detail {

/// Colours of a palette picture by the value of a pixel, channels from 0 to 1; empty for other pictures. Values are of
/// 16 bits; a table without a value above 255 is one of 8 bits, as some programs write it. Source: TIFF 6.0, section 5
/// (palette-color images), `ColorMap`; for 8 bits, libtiff, tif_getimage.c, `checkcmap`.
[[nodiscard]] inline std::vector<Vec3> colour_table(const TiffFile& file) {
  if (file.tag<std::uint16_t>(TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK) != PHOTOMETRIC_PALETTE) return {};
  std::array<const std::uint16_t*, 3> channels{};
  if (TIFFGetField(file.handle(), TIFFTAG_COLORMAP, &channels[0], &channels[1], &channels[2]) != 1) return {};
  const std::size_t count = std::size_t{1} << file.tag<std::uint16_t>(TIFFTAG_BITSPERSAMPLE, 1);
  std::uint16_t greatest = 0;
  for (const std::uint16_t* channel : channels) {
    if (channel == nullptr) return {};
    greatest = std::max(greatest, *std::max_element(channel, channel + count));
  }
  const double most = greatest > 255 ? 65535 : 255;
  std::vector<Vec3> colours(count);
  for (std::size_t i = 0; i < count; ++i)
    colours[i] = {channels[0][i] / most, channels[1][i] / most, channels[2][i] / most};
  return colours;
}

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
