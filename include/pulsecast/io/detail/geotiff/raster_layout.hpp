// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_GEOTIFF_RASTER_LAYOUT_HPP
#define PULSECAST_IO_DETAIL_GEOTIFF_RASTER_LAYOUT_HPP

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

/// Layout of the samples of a raster: in strips as wide as the raster, or in tiles.
struct RasterLayout {
  std::uint32_t columns = 0, rows = 0;              ///< size of the raster
  std::uint32_t chunk_columns = 0, chunk_rows = 0;  ///< size of a strip or tile
  std::uint64_t chunk_bytes = 0;                    ///< size of a strip or tile, decoded [byte]
  std::uint16_t samples = 1, bits = 1;              ///< samples of a pixel, and bits of a sample
  std::uint16_t format = SAMPLEFORMAT_UINT, planes = PLANARCONFIG_CONTIG;
  bool tiled = false;

  /// Reads and checks the layout of a file with heights in `band`, from 1, or a mask, which may be of 1 bit.
  /// @throws FileError
  RasterLayout(TiffFile& file, std::uint16_t band, bool is_mask = false) {
    columns = file.tag<std::uint32_t>(TIFFTAG_IMAGEWIDTH, 0);
    rows = file.tag<std::uint32_t>(TIFFTAG_IMAGELENGTH, 0);
    samples = file.tag<std::uint16_t>(TIFFTAG_SAMPLESPERPIXEL, 1);
    bits = file.tag<std::uint16_t>(TIFFTAG_BITSPERSAMPLE, 1);
    format = file.tag<std::uint16_t>(TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT);
    planes = file.tag<std::uint16_t>(TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
    const std::string size = text::message(columns, " x ", rows, " pixels");
    if (columns < 2 || rows < 2) file.fail("is of ", size, ": expected 2 x 2 or more");
    if (band > samples) file.fail("has ", samples, " bands: expected ", band, ", or another setting of the band");
    if (!is_mask) check_kind(file, band);
    check_samples(file, is_mask);

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
    const std::uint64_t row = (std::uint64_t{chunk_columns} * stride() * bits + 7) / 8;  // bytes
    if (row == 0 || chunk_rows == 0 || chunk_bytes / row != chunk_rows || chunk_bytes % row != 0)
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
  /// Source: TIFF 6.0, PhotometricInterpretation, Orientation; libtiff, ImageDepth.
  static void check_kind(TiffFile& file, std::uint16_t band) {
    const auto meaning = file.tag<std::uint16_t>(TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
    if (meaning != PHOTOMETRIC_MINISBLACK && meaning != PHOTOMETRIC_MINISWHITE && meaning != PHOTOMETRIC_PALETTE)
      file.keep(band == 1 ? "colours" : "colours, another band");
    if (file.tag<std::uint16_t>(TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT) != ORIENTATION_TOPLEFT) file.keep("tag 274");
    if (file.tag<std::uint32_t>(TIFFTAG_IMAGEDEPTH, 1) > 1) file.keep("tag 32997");
  }

  void check_samples(TiffFile& file, bool is_mask) const {
    const bool real = format == SAMPLEFORMAT_IEEEFP;
    const bool whole = format == SAMPLEFORMAT_INT || format == SAMPLEFORMAT_UINT || format == SAMPLEFORMAT_VOID;
    const bool is_bit = is_mask && bits == 1;
    if ((!real && !whole) || !(is_bit || bits == 8 || bits == 16 || bits == 32 || bits == 64) || (real && bits == 8))
      file.fail("has samples of ", bits, " bits, format ", format,
                ": expected whole numbers of 8, 16, 32 or 64 bits, or floating-point numbers of 16, 32 or 64; "
                "gdal_translate -ot Float32 makes these");
    const auto compression = file.tag<std::uint16_t>(TIFFTAG_COMPRESSION, COMPRESSION_NONE);
    if (TIFFIsCODECConfigured(compression) == 0)
      file.fail("is compressed by scheme ", compression, ": expected one that this libtiff can read");
  }
};

/// Number of the strip or tile of a band at a pixel.
[[nodiscard]] inline std::uint32_t chunk_at(const TiffFile& file, const RasterLayout& l, std::uint16_t band,
                                            std::uint32_t west, std::uint32_t north) {
  const auto plane = static_cast<std::uint16_t>(l.planes == PLANARCONFIG_CONTIG ? 0 : band - 1);
  TIFF* tiff = file.handle();
  return l.tiled ? TIFFComputeTile(tiff, west, north, 0, plane) : TIFFComputeStrip(tiff, north, plane);
}

/// Reads strip or tile `chunk`; false if it was left out. @throws FileError if it is not complete
[[nodiscard]] inline bool read_chunk(const TiffFile& file, const RasterLayout& l, std::uint32_t chunk,
                                     unsigned char* to, std::uint64_t bytes) {
  TIFF* tiff = file.handle();
  const std::uint64_t begin = TIFFGetStrileOffset(tiff, chunk), length = TIFFGetStrileByteCount(tiff, chunk);
  if (length == 0) return false;
  const auto fail = [&](const auto&... problem) {
    file.fail_at_byte(begin, l.chunk(), chunk, problem..., ": expected a complete file");
  };
  if (begin > file.size() || length > file.size() - begin)
    fail(" should end at byte ", begin + length, ", but the file has ", file.size());
  const auto size = static_cast<tmsize_t>(bytes);
  const auto read = l.tiled ? TIFFReadEncodedTile : TIFFReadEncodedStrip;
  if (read(tiff, chunk, to, size) != size) fail(" cannot be read", file.complaint());
  return true;
}

/// Calls `take(west, north, columns, rows)` for each strip or tile of a raster, from the north.
void each_chunk(const RasterLayout& l, const auto& take) {
  for (std::uint32_t north = 0; north < l.rows; north += std::min(l.chunk_rows, l.rows - north))
    for (std::uint32_t west = 0; west < l.columns; west += std::min(l.chunk_columns, l.columns - west))
      take(west, north, std::min(l.chunk_columns, l.columns - west), std::min(l.chunk_rows, l.rows - north));
}

/// Pixels whose number in a band is 0, or that were left out, by row.
[[nodiscard]] inline std::vector<bool> zeros_of(const TiffFile& file, const RasterLayout& l, std::uint16_t band) {
  std::vector<bool> zeros;
  std::vector<unsigned char> chunk(l.chunk_bytes);
  const std::size_t row_bytes = l.chunk_bytes / l.chunk_rows, first = l.stride() > 1 ? band - 1U : 0;
  each_chunk(l, [&](std::uint32_t west, std::uint32_t north, std::uint32_t columns, std::uint32_t rows) {
    zeros.resize(std::size_t{l.columns} * (north + rows), true);
    const std::size_t bytes = l.tiled ? l.chunk_bytes : rows * row_bytes;
    if (!read_chunk(file, l, chunk_at(file, l, band, west, north), chunk.data(), bytes)) return;
    for (std::size_t r = 0; r < rows; ++r)
      for (std::size_t c = 0; c < columns; ++c) {
        const std::size_t bit = (c * l.stride() + first) * l.bits;
        const unsigned char* const from = chunk.data() + r * row_bytes + bit / 8;
        const bool is_set = l.bits == 1 ? (*from >> (7 - bit % 8) & 1) != 0
                                        : std::any_of(from, from + l.bits / 8, [](unsigned char b) { return b != 0; });
        zeros[(north + r) * l.columns + west + c] = !is_set;
      }
  });
  return zeros;
}

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
