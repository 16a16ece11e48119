// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_GEOTIFF_RASTER_LAYOUT_HPP
#define PULSECAST_IO_DETAIL_GEOTIFF_RASTER_LAYOUT_HPP

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <type_traits>

#include <tiffio.h>

#include <pulsecast/io/detail/geotiff/tiff_file.hpp>
#include <pulsecast/shape/raster.hpp>

namespace PULSECAST_NAMESPACE::io::detail {

/// Half-precision number as its bits.
enum class Half : std::uint16_t {};

/// Converts a half-precision number. Source: IEEE 754-2019, 3.4, binary16.
[[nodiscard]] inline float from_half(std::uint16_t half) noexcept {
  const int exponent = half >> 10 & 0x1F;
  const auto fraction = static_cast<float>(half & 0x3FF);
  float value = 0;
  if (exponent == 31)
    value = fraction == 0 ? std::numeric_limits<float>::infinity() : std::numeric_limits<float>::quiet_NaN();
  else
    value = exponent == 0 ? std::ldexp(fraction, -24) : std::ldexp(1024 + fraction, exponent - 25);
  return (half & 0x8000) != 0 ? -value : value;
}

/// Value of the sample that begins at a byte.
template <class Sample>
[[nodiscard]] double sample_at(const unsigned char* bytes) noexcept {
  if constexpr (std::is_same_v<Sample, Half>) {
    std::uint16_t half = 0;
    std::memcpy(&half, bytes, sizeof half);
    return static_cast<double>(from_half(half));
  } else {
    Sample sample{};
    std::memcpy(&sample, bytes, sizeof sample);
    return static_cast<double>(sample);
  }
}

/// True for the value of missing heights, which may have more digits than a sample.
template <class Sample>
[[nodiscard]] bool is_missing(double value, double missing) noexcept {
  if constexpr (std::is_same_v<Sample, float>)
    return value == missing || static_cast<float>(value) == static_cast<float>(missing);
  return value == missing;
}

/// True for numbers that often mark missing heights. Source: Esri, NODATA_value (-9999); Rodriguez
/// et al. 2005, JPL D-31639, on SRTM (-32768); GDAL manual, DTED driver (-32767).
[[nodiscard]] inline bool may_be_missing(double value) noexcept {
  return value == -9999 || value == -32768 || value == -32767 || value == -99999 || value == -999999;
}

/// Layout of the samples of a raster: in strips as wide as the raster, or in tiles.
struct RasterLayout {
  std::uint32_t columns = 0, rows = 0;              ///< size of the raster
  std::uint32_t chunk_columns = 0, chunk_rows = 0;  ///< size of a strip or tile
  std::uint64_t chunk_bytes = 0;                    ///< size of a strip or tile, decoded [byte]
  std::uint16_t samples = 1, bits = 1;              ///< samples of a pixel, and bits of a sample
  std::uint16_t format = SAMPLEFORMAT_UINT, planes = PLANARCONFIG_CONTIG;
  bool tiled = false;

  /// Reads and checks the layout of a file with heights in `band`, from 1. @throws FileError
  RasterLayout(const TiffFile& file, std::uint16_t band) {
    columns = file.tag<std::uint32_t>(TIFFTAG_IMAGEWIDTH, 0);
    rows = file.tag<std::uint32_t>(TIFFTAG_IMAGELENGTH, 0);
    samples = file.tag<std::uint16_t>(TIFFTAG_SAMPLESPERPIXEL, 1);
    bits = file.tag<std::uint16_t>(TIFFTAG_BITSPERSAMPLE, 1);
    format = file.tag<std::uint16_t>(TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT);
    planes = file.tag<std::uint16_t>(TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
    const std::string size = text::message(columns, " x ", rows, " pixels");
    if (columns < 2 || rows < 2) file.fail("is of ", size, ": expected 2 x 2 or more");
    if (band > samples) file.fail("has ", samples, " bands: expected ", band, ", or another setting of the band");
    check_samples(file);

    tiled = TIFFIsTiled(file.handle()) != 0;
    if (tiled) {
      chunk_columns = file.tag<std::uint32_t>(TIFFTAG_TILEWIDTH, 0);
      chunk_rows = file.tag<std::uint32_t>(TIFFTAG_TILELENGTH, 0);
      chunk_bytes = TIFFTileSize64(file.handle());
    } else {
      chunk_columns = columns;
      chunk_rows = std::min(file.tag<std::uint32_t>(TIFFTAG_ROWSPERSTRIP, rows), rows);
      chunk_bytes = TIFFStripSize64(file.handle());
    }
    const std::uint64_t pixels = std::uint64_t{columns} * rows;
    const std::uint64_t needed = std::uint64_t{chunk_columns} * chunk_rows;  // pixels of a strip or tile
    if (needed == 0 || chunk_bytes / (bits / 8U) / stride() != needed || chunk_bytes % (bits / 8U) != 0)
      file.fail("has a ", chunk(), "with a size of zero or too large", file.complaint());
    const std::uint64_t chunks = tiled ? TIFFNumberOfTiles(file.handle()) : TIFFNumberOfStrips(file.handle());
    if (pixels > file.max_bytes() / sizeof(float) || chunk_bytes > file.max_bytes() || chunks > file.size())
      file.fail("claims ", size, ", more than its ", file.size(), " bytes can hold");
    constexpr std::uint32_t most = pulsecast::detail::max_pixels;
    if (columns > most || rows > most || !((columns - 1.0) * (rows - 1.0) <= 2147483647))
      file.fail("is of ", size, ": expected at most 2^27 in a row or column, and 2^31 cells between them");
  }

  /// Distance between samples of one band [samples].
  [[nodiscard]] std::size_t stride() const noexcept { return planes == PLANARCONFIG_CONTIG ? samples : 1; }
  /// Name of a strip or tile, in front of its number.
  [[nodiscard]] const char* chunk() const noexcept { return tiled ? "tile " : "strip "; }

 private:
  void check_samples(const TiffFile& file) const {
    const bool real = format == SAMPLEFORMAT_IEEEFP;
    const bool whole = format == SAMPLEFORMAT_INT || format == SAMPLEFORMAT_UINT || format == SAMPLEFORMAT_VOID;
    if ((!real && !whole) || !(bits == 8 || bits == 16 || bits == 32 || bits == 64) || (real && bits == 8))
      file.fail("has samples of ", bits, " bits, format ", format,
                ": expected whole numbers of 8, 16, 32 or 64 bits, or floating-point numbers of 16, 32 or 64");
    const auto compression = file.tag<std::uint16_t>(TIFFTAG_COMPRESSION, COMPRESSION_NONE);
    if (TIFFIsCODECConfigured(compression) == 0)
      file.fail("is compressed by scheme ", compression, ": expected one that this libtiff can read");
    const auto meaning = file.tag<std::uint16_t>(TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
    if (meaning == PHOTOMETRIC_YCBCR || meaning == PHOTOMETRIC_LOGL || meaning == PHOTOMETRIC_LOGLUV)
      file.fail("holds a picture (photometric interpretation ", meaning, "): expected heights");
  }
};

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
