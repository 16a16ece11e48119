// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_GEOTIFF_HPP
#define PULSECAST_IO_GEOTIFF_HPP

#include <filesystem>
#include <optional>
#include <vector>

#include <pulsecast/base/compiled.hpp>
#include <pulsecast/base/require.hpp>
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
  std::optional<std::uint16_t> epsg{};  ///< code of the projected reference system, if any
  std::vector<Vec3> colours{};          ///< colour table by value (sRGB, from 0 to 1); or empty
  std::vector<std::string> warnings{};  ///< oddities that could still be read
};

/// Reads a raster of heights in a projected reference system in metres: the first image of a TIFF file, of
/// integers of 8 to 64 bits or floating-point numbers of 16 to 64, with any compression of libtiff. Heights
/// become `float`; missing ones, NaN and values not within 1e15 m become NaN. With `packed`, whole numbers of 8 and 16
/// bits stay so, but not if tiles of 16 bits without a value for missing heights are left out. A picture with a colour
/// table, such as a map of land cover, is a raster of numbers. Masks and alpha bands are not applied, with a warning.
/// Throws a `FileError`, with the byte if known, for a raster that is incomplete, rotated, sheared, in degrees, in feet
/// but for its heights, of depths, or without a place. Source: TIFF 6.0; OGC GeoTIFF 1.1 (19-008r4); GDAL manual, GTiff
/// driver.
[[nodiscard]] GeoTiff read_geotiff(const std::filesystem::path& path, const GeoTiffSettings& settings = {});

/// EPSG code of the projected reference system, if any. @throws FileError as `read_geotiff`
[[nodiscard]] std::optional<std::uint16_t> read_geotiff_epsg(const std::filesystem::path& path);

/// Codes of the horizontal and the vertical reference system, 0 if unknown. @throws FileError as `read_geotiff`
[[nodiscard]] SpatialReference read_geotiff_reference(const std::filesystem::path& path);

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

/// Reader of a file's heights, row by row from the north.
class GeoTiffReader {
 public:
  GeoTiffReader(const std::filesystem::path& path, const GeoTiffSettings& settings)
      : settings_(validated(settings)), file_(path), layout_(file_, settings_.band), epsg_(projected_epsg(file_)) {
    const auto& scale = settings_.vertical_scale;
    scale_ = scale ? HeightScale{*scale} : height_scale(file_, settings_.band);
    const RasterCorner corner = raster_corner(file_, layout_);
    westward_ = corner.step_x < 0;
    northward_ = corner.step_y > 0;
    raster_ = placed_raster(file_, layout_, corner);
    if (const std::string question = degrees_question(raster_); !question.empty()) file_.warn(question);
    missing_ = settings_.missing ? settings_.missing : missing_value();
    note_picture();
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

  /// Notes tags without effect. Source: TIFF 6.0, PhotometricInterpretation and ExtraSamples.
  void note_picture() {
    const auto meaning = file_.tag<std::uint16_t>(TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
    if (meaning != PHOTOMETRIC_MINISBLACK && meaning != PHOTOMETRIC_MINISWHITE && meaning != PHOTOMETRIC_PALETTE)
      file_.warn("is a picture of colours (photometric interpretation ", meaning, "); the numbers of band ",
                 settings_.band, " are taken as heights");
    std::uint16_t count = 0;
    const std::uint16_t* kinds = nullptr;
    if (TIFFGetField(file_.handle(), TIFFTAG_EXTRASAMPLES, &count, &kinds) != 1 || kinds == nullptr) count = 0;
    const bool has_alpha = std::any_of(
        kinds, kinds + count, [](auto k) { return k == EXTRASAMPLE_ASSOCALPHA || k == EXTRASAMPLE_UNASSALPHA; });
    std::error_code ignored;
    if (has_alpha || file_.has_mask() || std::filesystem::exists(file_.path() + ".msk", ignored))
      file_.warn("has ", has_alpha ? "an alpha band" : "a mask",
                 ", which is not applied: pixels without a height keep their numbers, unless these are those of "
                 "missing heights");
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
    return scale_.scale > 0 && is_small && (packed.missing || is_complete());
  }

  /// True if no strip or tile of the band is left out.
  [[nodiscard]] bool is_complete() {
    const RasterLayout& l = layout_;
    for (std::uint32_t north = 0; north < l.rows; north += std::min(l.chunk_rows, l.rows - north))
      for (std::uint32_t west = 0; west < l.columns; west += std::min(l.chunk_columns, l.columns - west))
        if (TIFFGetStrileByteCount(file_.handle(), chunk_at(west, north)) == 0) return false;
    return true;
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
    return {std::move(raster_), epsg_, colour_table(file_), file_.take_warnings()};
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
    for (std::uint32_t north = 0; north < l.rows; north += std::min(l.chunk_rows, l.rows - north)) {
      const std::uint32_t rows = std::min(l.chunk_rows, l.rows - north);
      pixels.resize(std::size_t{l.columns} * (north + rows), absent);
      for (std::uint32_t west = 0; west < l.columns; west += std::min(l.chunk_columns, l.columns - west)) {
        const std::uint32_t columns = std::min(l.chunk_columns, l.columns - west);
        Pixel* to = pixels.data() + std::size_t{north} * l.columns + west;
        auto* from = in_place ? reinterpret_cast<unsigned char*>(to) : buffer.data();
        const std::uint64_t bytes = l.tiled ? l.chunk_bytes : l.chunk_bytes / l.chunk_rows * rows;
        if (!read_chunk(west, north, from, bytes)) continue;
        for (std::size_t row = 0; row < rows; ++row) {
          const unsigned char* samples = from + (row * l.chunk_columns * stride + first) * sizeof(Sample);
          for (std::uint32_t i = 0; i < columns; ++i, samples += stride * sizeof(Sample))
            to[row * l.columns + i] = pixel<Sample, Pixel>(samples);
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
    const auto fail = [&](const auto&... problem) {
      file_.fail_at_byte(begin, layout_.chunk(), chunk, problem..., ": expected a complete file");
    };
    if (begin > file_.size() || length > file_.size() - begin)
      fail(" should end at byte ", begin + length, ", but the file has ", file_.size());
    const auto size = static_cast<tmsize_t>(bytes);
    const auto read = layout_.tiled ? TIFFReadEncodedTile : TIFFReadEncodedStrip;
    if (read(tiff, chunk, to, size) != size) fail(" cannot be read", file_.complaint());
    return true;
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
  RasterLayout layout_;
  std::optional<std::uint16_t> epsg_;
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

PULSECAST_INLINE std::optional<std::uint16_t> read_geotiff_epsg(const std::filesystem::path& path) {
  detail::TiffFile file(path);
  return detail::projected_epsg(file);
}

PULSECAST_INLINE SpatialReference read_geotiff_reference(const std::filesystem::path& path) {
  detail::TiffFile file(path);
  const std::uint16_t vertical = detail::geo_key(file, detail::geotiff::vertical, 0);
  return {.epsg = detail::projected_epsg(file).value_or(0),
          .vertical_epsg = vertical == detail::geotiff::user_defined ? std::uint16_t{0} : vertical};
}

}  // namespace PULSECAST_NAMESPACE::io

#endif

#endif
