// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_GEOTIFF_READER_HPP
#define PULSECAST_IO_DETAIL_GEOTIFF_READER_HPP

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <new>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <tiffio.h>

#include <pulsecast/base/require.hpp>
#include <pulsecast/io/detail/geotiff/colour_table.hpp>
#include <pulsecast/io/detail/geotiff/georeference.hpp>
#include <pulsecast/io/detail/geotiff/raster_layout.hpp>
#include <pulsecast/io/detail/geotiff/samples.hpp>
#include <pulsecast/io/detail/geotiff/tiff_file.hpp>
#include <pulsecast/io/geotiff.hpp>
#include <pulsecast/io/input_file.hpp>
#include <pulsecast/scene/raster.hpp>

/// Reading of GeoTIFF files.
namespace PULSECAST_NAMESPACE::io {

namespace detail {

/// Reader of a file's heights, row by row from the north.
class GeoTiffReader {
 public:
  GeoTiffReader(const std::filesystem::path& path, const GeoTiffSettings& settings)
      : settings_(validated(settings)), file_(path), layout_(file_, settings_.band), epsg_(projected_epsg(file_)) {
    scale_ = settings_.vertical_scale ? *settings_.vertical_scale : metres_per_height(file_);
    const RasterCorner corner = raster_corner(file_, layout_);
    westward_ = corner.step_x < 0;
    northward_ = corner.step_y > 0;
    raster_ = placed_raster(file_, layout_, corner);
    missing_ = settings_.missing ? settings_.missing : missing_value();
  }

  [[nodiscard]] GeoTiff read() {
    switch (layout_.format) {
      case SAMPLEFORMAT_IEEEFP:
        if (layout_.bits == 16) return finished<Half>();
        return layout_.bits == 32 ? finished<float>() : finished<double>();
      case SAMPLEFORMAT_INT:
        return whole<std::int8_t, std::int16_t, std::int32_t, std::int64_t>();
      default:
        return whole<std::uint8_t, std::uint16_t, std::uint32_t, std::uint64_t>();
    }
  }

 private:
  /// Value of missing heights by the file. Source: GDAL manual, GTiff driver.
  [[nodiscard]] std::optional<double> missing_value() {
    const auto text = file_.tags<char>(geotiff::nodata);
    std::string_view word(text.data(), text.size());
    word = word.substr(0, word.find('\0'));
    while (!word.empty() && (word.front() == ' ' || word.front() == '+')) word.remove_prefix(1);
    if (const auto value = text::take_number<double>(word)) return value;
    if (!word.empty()) file_.warn("its value for missing heights is not a number, and is ignored");
    return std::nullopt;
  }

  template <class One, class Two, class Four, class Eight>
  [[nodiscard]] GeoTiff whole() {
    switch (layout_.bits) {
      case 8:
        return finished<One>();
      case 16:
        return finished<Two>();
      case 32:
        return finished<Four>();
      default:
        return finished<Eight>();
    }
  }

  template <class Sample>
  [[nodiscard]] GeoTiff finished() {
    if constexpr (std::is_integral_v<Sample> && sizeof(Sample) <= 2)
      if (settings_.packed && pack<Sample>()) return finished<Sample>(raster_.packed.numbers, raster_.packed.missing.value_or(0));
    return finished<Sample>(raster_.heights, std::numeric_limits<float>::quiet_NaN());
  }

  /// Sets the scale of packed heights; false if they cannot be packed.
  template <class Sample>
  [[nodiscard]] bool pack() {
    PackedHeights& packed = raster_.packed;
    packed.scale = scale_;
    packed.zero = std::is_signed_v<Sample> ? 32768 : 0;
    using Limits = std::numeric_limits<Sample>;
    if (missing_ && *missing_ >= Limits::min() && *missing_ <= Limits::max() && std::floor(*missing_) == *missing_)
      packed.missing = static_cast<std::uint16_t>(*missing_ + packed.zero);
    else if (sizeof(Sample) == 1)
      packed.missing = std::numeric_limits<std::uint16_t>::max();
    return 65536 * scale_ <= 1e15 && (packed.missing || is_complete());
  }

  /// True if no strip or tile of the band is left out.
  [[nodiscard]] bool is_complete() {
    for (std::uint32_t north = 0; north < layout_.rows; north += std::min(layout_.chunk_rows, layout_.rows - north))
      for (std::uint32_t west = 0; west < layout_.columns; west += std::min(layout_.chunk_columns, layout_.columns - west))
        if (TIFFGetStrileByteCount(file_.handle(), chunk_at(west, north)) == 0) return false;
    return true;
  }

  /// `pixels`: of the raster, to be filled. `absent`: pixel of missing heights.
  template <class Sample, class Pixel>
  [[nodiscard]] GeoTiff finished(std::vector<Pixel>& pixels, Pixel absent) {
    read_pixels<Sample>(pixels, absent);
    const auto row = [&](std::uint32_t r) { return pixels.begin() + static_cast<std::ptrdiff_t>(std::size_t{r} * layout_.columns); };
    for (std::uint32_t r = 0; northward_ && r < layout_.rows / 2; ++r) std::swap_ranges(row(r), row(r + 1), row(layout_.rows - 1 - r));
    for (std::uint32_t r = 0; westward_ && r < layout_.rows; ++r) std::reverse(row(r), row(r + 1));
    if (there_ == 0) file_.fail("has no height: expected at least one pixel with a height");
    if (strange_ > 0) file_.warn(std::to_string(strange_) + " values beyond 1e15 m, or infinite, count as missing");
    return {.raster = std::move(raster_), .epsg = epsg_, .colours = colour_table(file_), .warnings = file_.take_warnings()};
  }

  /// Reads strip by strip, or rows of tiles; the raster grows meanwhile.
  template <class Sample, class Pixel>
  void read_pixels(std::vector<Pixel>& pixels, Pixel absent) {
    const RasterLayout& l = layout_;
    const std::size_t stride = l.stride(), first = l.planes == PLANARCONFIG_CONTIG ? settings_.band - 1U : 0;
    const bool in_place = !l.tiled && stride == 1 && std::is_same_v<Sample, Pixel>;
    std::vector<unsigned char> buffer;
    try {
      pixels.reserve(std::size_t{l.columns} * l.rows);
      if (!in_place) buffer.resize(l.chunk_bytes);
    } catch (const std::bad_alloc&) {
      file_.fail("does not fit into memory: its raster has " + std::to_string(l.columns) + " x " + std::to_string(l.rows) + " pixels");
    }
    for (std::uint32_t north = 0; north < l.rows; north += std::min(l.chunk_rows, l.rows - north)) {
      const std::uint32_t rows = std::min(l.chunk_rows, l.rows - north);
      pixels.resize(std::size_t{l.columns} * (north + rows), absent);
      for (std::uint32_t west = 0; west < l.columns; west += std::min(l.chunk_columns, l.columns - west)) {
        const std::uint32_t columns = std::min(l.chunk_columns, l.columns - west);
        Pixel* to = pixels.data() + std::size_t{north} * l.columns + west;
        auto* from = in_place ? reinterpret_cast<unsigned char*>(to) : buffer.data();
        if (!read_chunk(west, north, from, l.tiled ? l.chunk_bytes : l.chunk_bytes / l.chunk_rows * rows)) continue;
        for (std::uint32_t row = 0; row < rows; ++row) {
          const unsigned char* samples = from + (std::size_t{row} * l.chunk_columns * stride + first) * sizeof(Sample);
          for (std::uint32_t i = 0; i < columns; ++i, samples += stride * sizeof(Sample))
            to[std::size_t{row} * l.columns + i] = pixel<Sample, Pixel>(samples);
        }
      }
    }
  }

  /// Number of the strip or tile of the band at a pixel.
  [[nodiscard]] std::uint32_t chunk_at(std::uint32_t west, std::uint32_t north) const {
    const auto plane = static_cast<std::uint16_t>(layout_.planes == PLANARCONFIG_CONTIG ? 0 : settings_.band - 1);
    TIFF* tiff = file_.handle();
    return layout_.tiled ? TIFFComputeTile(tiff, west, north, 0, plane) : TIFFComputeStrip(tiff, north, plane);
  }

  /// Reads a strip or tile; false if it was left out.
  [[nodiscard]] bool read_chunk(std::uint32_t west, std::uint32_t north, unsigned char* to, std::uint64_t bytes) {
    TIFF* tiff = file_.handle();
    const std::uint32_t chunk = chunk_at(west, north);
    const std::uint64_t begin = TIFFGetStrileOffset(tiff, chunk), length = TIFFGetStrileByteCount(tiff, chunk);
    if (length == 0) return false;
    const std::string what = layout_.chunk() + std::to_string(chunk);
    if (begin > file_.size() || length > file_.size() - begin)
      file_.fail_at_byte(begin, what + " should end at byte " + std::to_string(begin + length) + ", but the file has " +
                                    std::to_string(file_.size()) + ": expected a complete file");
    const auto size = static_cast<tmsize_t>(bytes);
    const tmsize_t read = layout_.tiled ? TIFFReadEncodedTile(tiff, chunk, to, size) : TIFFReadEncodedStrip(tiff, chunk, to, size);
    if (read != size) file_.fail_at_byte(begin, what + " cannot be read" + file_.complaint() + ": expected a complete file");
    return true;
  }

  template <class Sample, class Pixel>
  [[nodiscard]] Pixel pixel(const unsigned char* bytes) noexcept {
    if constexpr (std::is_same_v<Pixel, float>) {
      return height<Sample>(bytes);
    } else {
      const auto number = static_cast<Pixel>(sample_at<Sample>(bytes) + raster_.packed.zero);
      if (raster_.packed.missing != number) ++there_;
      return number;
    }
  }

  template <class Sample>
  [[nodiscard]] float height(const unsigned char* bytes) noexcept {
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    double value = sample_at<Sample>(bytes);
    if (std::isnan(value) || (missing_ && is_missing<Sample>(value, *missing_))) return nan;
    value *= scale_;
    if (!(std::fabs(value) <= 1e15)) {
      ++strange_;
      return nan;
    }
    ++there_;
    return static_cast<float>(value);
  }

  GeoTiffSettings settings_;
  TiffFile file_;
  RasterLayout layout_;
  std::optional<std::uint16_t> epsg_;
  Raster raster_;
  double scale_ = 1;                           ///< metres per unit of height
  std::optional<double> missing_;              ///< value of missing heights
  bool westward_ = false, northward_ = false;  ///< direction of columns and rows in the file
  std::uint64_t there_ = 0, strange_ = 0;      ///< number of heights, and of values out of bounds
};

}  // namespace detail

PULSECAST_INLINE GeoTiff read_geotiff(const std::filesystem::path& path, const GeoTiffSettings& settings) {
  return reading(path, [&] { return detail::GeoTiffReader(path, settings).read(); });
}

PULSECAST_INLINE std::optional<std::uint16_t> read_geotiff_epsg(const std::filesystem::path& path) {
  detail::TiffFile file(path);
  return detail::projected_epsg(file);
}

}  // namespace PULSECAST_NAMESPACE::io

#endif
