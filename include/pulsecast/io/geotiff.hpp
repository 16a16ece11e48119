// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_GEOTIFF_HPP
#define PULSECAST_IO_GEOTIFF_HPP

#include <filesystem>

#include <pulsecast/base/compiled.hpp>
#include <pulsecast/io/spatial_reference.hpp>
#include <pulsecast/shape/raster.hpp>

namespace PULSECAST_NAMESPACE::io {

/// Settings for GeoTIFF files.
struct GeoTiffSettings {
  std::uint16_t band = 1;                  ///< band of the heights, from 1
  std::optional<double> vertical_scale{};  ///< metres per unit of numbers; default: by the tags
  std::optional<double> missing{};         ///< value of missing heights; default: GDAL_NODATA
  bool packed = false;                     ///< whole numbers of 8 and 16 bits as `Raster::packed`

  void validate() const {
    require_within("GeoTiffSettings::band", band, 1, 65535, "");
    if (vertical_scale) require_positive("GeoTiffSettings::vertical_scale", *vertical_scale, "m");
  }
};

/// Content of a GeoTIFF file.
struct GeoTiff {
  Raster raster;                        ///< heights [m]
  std::optional<std::uint16_t> epsg{};  ///< code of the projected reference system in metres, if any
  std::vector<Vec3> colours{};          ///< colour table by value (sRGB, from 0 to 1); or empty
  std::vector<std::string> warnings{};  ///< oddities that could still be read
  SpatialReference reference{};         ///< that of the file, with its units
};

/// Reads a raster of heights in a projected reference system: the first image of a TIFF file, of integers of 8 to 64
/// bits or floating-point numbers of 16 to 64, with any compression of libtiff. Coordinates and heights in feet and
/// other units become metres. Heights become `float`; missing ones, those of a mask or of alpha 0, NaN and values not
/// within 1e15 m become NaN. With `packed`, whole numbers of 8 and 16 bits stay so, but not if pixels are left out or
/// masked and no number of 16 bits marks missing heights. A picture with a colour table, such as a map of land cover,
/// is a raster of numbers. docs/formats.md lists what is read. Throws a `FileError`, with the byte if known, for a
/// raster that is incomplete, rotated, sheared, in degrees, of depths, of colours, or without a place. Source:
/// TIFF 6.0; OGC GeoTIFF 1.1 (19-008r4); GDAL manual, GTiff driver.
[[nodiscard]] GeoTiff read_geotiff(const std::filesystem::path& path, const GeoTiffSettings& settings = {});

/// Reference system of a file, empty if unknown. @throws FileError as `read_geotiff`
[[nodiscard]] SpatialReference read_geotiff_reference(const std::filesystem::path& path);

/// EPSG code of the projected reference system in metres, if any. @throws FileError as `read_geotiff`
[[nodiscard]] std::optional<std::uint16_t> read_geotiff_epsg(const std::filesystem::path& path);

}  // namespace PULSECAST_NAMESPACE::io

#if PULSECAST_DEFINES(IO_GEOTIFF)
#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <system_error>
#include <type_traits>

#include <tiffio.h>

#include <pulsecast/io/detail/geotiff/georeference.hpp>

namespace PULSECAST_NAMESPACE::io {

namespace detail {

/// Code of a horizontal system in metres.
[[nodiscard]] inline std::optional<std::uint16_t> metric_epsg(const SpatialReference& reference) noexcept {
  return reference.epsg != 0 && reference.unit == 1 ? std::optional(reference.epsg) : std::nullopt;
}

/// Reader of a file's heights, row by row from the north.
class GeoTiffReader {
 public:
  GeoTiffReader(const std::filesystem::path& path, const GeoTiffSettings& settings)
      : settings_(validated(settings)),
        file_(path),
        reference_(reference_of(file_, settings_.vertical_scale ? HeightUnit::by_setting : HeightUnit::metre)),
        layout_(file_, settings_.band) {
    const BandItems items = band_items(file_, settings_.band, layout_.samples, reference_.vertical_unit);
    const auto& [scale, offset, unit] = items.heights;
    const bool is_scaled_by_place = layout_.samples == 1 && reference_.vertical_epsg != 0 && scale == 1 && offset == 0;
    const RasterCorner corner = raster_corner(file_, layout_, is_scaled_by_place);
    scale_ = settings_.vertical_scale ? HeightScale{*settings_.vertical_scale}
                                      : HeightScale{scale * corner.step_z * unit, (offset + corner.z) * unit};
    westward_ = corner.step_x < 0;
    northward_ = corner.step_y > 0;
    raster_ = placed_raster(file_, layout_, corner, reference_.unit);
    const std::string question = degrees_question(raster_);
    if (!question.empty() && geo_keys(file_).code(1024) != 0)
      file_.warn(question);
    else if (!question.empty() && reference_.wkt.empty())
      file_.fail(question);
    missing_ = settings_.missing ? settings_.missing : missing_value();
    read_masks(items.alpha);
  }

  [[nodiscard]] GeoTiff read() {
    if (layout_.format == SAMPLEFORMAT_INT) return whole<std::int8_t, std::int16_t, std::int32_t, std::int64_t>();
    if (layout_.format != SAMPLEFORMAT_IEEEFP)
      return whole<std::uint8_t, std::uint16_t, std::uint32_t, std::uint64_t>();
    if (layout_.bits == 16) return finished<Half>();
    return layout_.bits == 32 ? finished<float>() : finished<double>();
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

  /// Takes pixels outside masks as missing. Source: GDAL manual, GTiff driver, internal masks; RFC 15 of GDAL.
  void read_masks(const std::vector<std::uint16_t>& alpha) {
    const auto take = [&](const TiffFile& file, const RasterLayout& layout, std::uint16_t band) {
      std::vector<bool> zeros = zeros_of(file, layout, band);
      for (std::size_t i = 0; i < hidden_.size(); ++i) zeros[i] = zeros[i] || hidden_[i];
      hidden_ = std::move(zeros);
    };
    const auto take_image = [&](const std::filesystem::path& path, std::uint16_t image) {
      TiffFile file(path, image);
      const RasterLayout layout(file, 1, true);
      if (layout.columns != layout_.columns || layout.rows != layout_.rows) file_.keep("mask of another size");
      take(file, layout, std::min(settings_.band, layout.samples));
    };
    for (const std::uint16_t band : alpha)
      if (band != settings_.band) take(file_, layout_, band);
    if (file_.mask() != 0) take_image(file_.path(), file_.mask());
    std::error_code ignored;
    if (const auto beside = side_files_of(file_.path()).back(); std::filesystem::exists(beside, ignored))
      take_image(beside, 0);
  }

  template <class One, class Two, class Four, class Eight>
  [[nodiscard]] GeoTiff whole() {
    if (layout_.bits == 8) return finished<One>();
    if (layout_.bits == 16) return finished<Two>();
    return layout_.bits == 32 ? finished<Four>() : finished<Eight>();
  }

  template <class Sample>
  [[nodiscard]] GeoTiff finished() {
    if constexpr (std::is_integral_v<Sample> && sizeof(Sample) <= 2)
      if (settings_.packed && pack<Sample>())
        return finished<Sample>(raster_.packed.numbers, raster_.packed.missing.value_or(0));
    return finished<Sample>(raster_.heights, std::numeric_limits<float>::quiet_NaN());
  }

  /// Sets the scale of packed heights; false if they cannot be packed.
  template <class Sample>
  [[nodiscard]] bool pack() {
    PackedHeights& packed = raster_.packed;
    packed.scale = scale_.scale;
    packed.offset = scale_.offset;
    packed.zero = std::is_signed_v<Sample> ? 32768 : 0;
    using Limits = std::numeric_limits<Sample>;
    if (missing_ && *missing_ >= Limits::min() && *missing_ <= Limits::max() && std::floor(*missing_) == *missing_)
      packed.missing = static_cast<std::uint16_t>(*missing_ + packed.zero);
    else if (sizeof(Sample) == 1)
      packed.missing = std::numeric_limits<std::uint16_t>::max();
    const bool is_small = std::fabs(scale_.offset) + 65536 * scale_.scale <= 1e15;
    return scale_.scale > 0 && is_small && (packed.missing || (hidden_.empty() && is_complete()));
  }

  /// True if no strip or tile of the band is left out.
  [[nodiscard]] bool is_complete() {
    bool is_whole = true;
    each_chunk(layout_, [&](std::uint32_t west, std::uint32_t north, auto...) {
      is_whole = is_whole && TIFFGetStrileByteCount(file_.handle(), chunk_at(west, north)) != 0;
    });
    return is_whole;
  }

  /// `pixels`: of the raster, to be filled. `absent`: pixel of missing heights.
  template <class Sample, class Pixel>
  [[nodiscard]] GeoTiff finished(std::vector<Pixel>& pixels, Pixel absent) {
    read_pixels<Sample>(pixels, absent);
    const auto row = [&](std::uint32_t r) {
      return pixels.begin() + static_cast<std::ptrdiff_t>(std::size_t{r} * layout_.columns);
    };
    for (std::uint32_t r = 0; northward_ && r < layout_.rows / 2; ++r)
      std::swap_ranges(row(r), row(r + 1), row(layout_.rows - 1 - r));
    for (std::uint32_t r = 0; westward_ && r < layout_.rows; ++r) std::reverse(row(r), row(r + 1));
    if (there_ == 0) file_.fail("has no height: expected at least one pixel with a height");
    if (unmarked_ > 0)
      file_.warn(unmarked_,
                 " heights are a number that often marks missing ones, as -9999 or -32768, and the file "
                 "names no number for these; a number of missing heights is a setting");
    if (strange_ > 0) file_.warn(strange_, " values beyond 1e15 m, or infinite, count as missing");
    return {std::move(raster_), metric_epsg(reference_), colour_table(file_), file_.take_warnings(), reference_};
  }

  /// Reads by strips, or rows of tiles; the raster grows meanwhile.
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
      file_.fail("does not fit into memory: its raster has ", l.columns, " x ", l.rows, " pixels");
    }
    each_chunk(l, [&](std::uint32_t west, std::uint32_t north, std::uint32_t columns, std::uint32_t rows) {
      pixels.resize(std::size_t{l.columns} * (north + rows), absent);
      Pixel* const to = pixels.data() + std::size_t{north} * l.columns + west;
      auto* const from = in_place ? reinterpret_cast<unsigned char*>(to) : buffer.data();
      const std::uint64_t bytes = l.tiled ? l.chunk_bytes : l.chunk_bytes / l.chunk_rows * rows;
      if (!read_chunk(file_, l, chunk_at(west, north), from, bytes)) return;
      for (std::size_t row = 0; row < rows; ++row) {
        const unsigned char* samples = from + (row * l.chunk_columns * stride + first) * sizeof(Sample);
        const std::size_t begin = (north + row) * l.columns + west;
        for (std::uint32_t i = 0; i < columns; ++i, samples += stride * sizeof(Sample))
          pixels[begin + i] = is_hidden(begin + i) ? absent : pixel<Sample, Pixel>(samples);
      }
    });
  }

  [[nodiscard]] bool is_hidden(std::size_t index) const { return !hidden_.empty() && hidden_[index]; }

  [[nodiscard]] std::uint32_t chunk_at(std::uint32_t west, std::uint32_t north) const {
    return detail::chunk_at(file_, layout_, settings_.band, west, north);
  }

  template <class Sample, class Pixel>
  [[nodiscard]] Pixel pixel(const unsigned char* bytes) noexcept {
    if constexpr (std::is_same_v<Pixel, float>) {
      return height<Sample>(bytes);
    } else {
      const double value = sample_at<Sample>(bytes);
      const auto number = static_cast<Pixel>(value + raster_.packed.zero);
      if (raster_.packed.missing != number) ++there_;
      if (!missing_ && may_be_missing(value)) ++unmarked_;
      return number;
    }
  }

  template <class Sample>
  [[nodiscard]] float height(const unsigned char* bytes) noexcept {
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    double value = sample_at<Sample>(bytes);
    if (std::isnan(value) || (missing_ && is_missing<Sample>(value, *missing_))) return nan;
    if (!missing_ && may_be_missing(value)) ++unmarked_;
    value = scale_.offset + scale_.scale * value;
    if (!(std::fabs(value) <= 1e15)) {
      ++strange_;
      return nan;
    }
    ++there_;
    return static_cast<float>(value);
  }

  GeoTiffSettings settings_;
  TiffFile file_;
  SpatialReference reference_;
  RasterLayout layout_;
  std::vector<bool> hidden_;  ///< pixels outside masks, in the order of the file; empty without masks
  Raster raster_;
  HeightScale scale_;
  std::optional<double> missing_;              ///< value of missing heights
  bool westward_ = false, northward_ = false;  ///< direction of columns and rows in the file
  std::uint64_t there_ = 0, strange_ = 0;      ///< number of heights, and of values out of bounds
  std::uint64_t unmarked_ = 0;                 ///< number of heights that may be missing ones
};

}  // namespace detail

PULSECAST_INLINE GeoTiff read_geotiff(const std::filesystem::path& path, const GeoTiffSettings& settings) {
  return reading(path, [&] { return detail::GeoTiffReader(path, settings).read(); });
}

PULSECAST_INLINE SpatialReference read_geotiff_reference(const std::filesystem::path& path) {
  detail::TiffFile file(path);
  return detail::reference_of(file, detail::HeightUnit::by_setting);
}

PULSECAST_INLINE std::optional<std::uint16_t> read_geotiff_epsg(const std::filesystem::path& path) {
  return detail::metric_epsg(read_geotiff_reference(path));
}

}  // namespace PULSECAST_NAMESPACE::io

#endif

#endif
