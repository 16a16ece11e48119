// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <concepts>
#include <cstdarg>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <limits>
#include <memory>
#include <new>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <tiffio.h>

#include <pulsecast/base/require.hpp>
#include <pulsecast/io/input_file.hpp>
#include <pulsecast/scene/height_field.hpp>

namespace pulsecast::io {

/// Settings for GeoTIFF files.
struct GeoTiffSettings {
  std::uint16_t band = 1;                               ///< band of the heights, from 1
  std::optional<double> vertical_scale = std::nullopt;  ///< metres per unit of height; by default from the file's vertical unit, or 1
  std::optional<double> missing = std::nullopt;         ///< value of missing heights; by default from the file (GDAL_NODATA)

  void validate() const {
    require_within("GeoTiffSettings::band", band, 1, 65535, "");
    if (vertical_scale) require_positive("GeoTiffSettings::vertical_scale", *vertical_scale, "m");
  }
};

/// Content of a GeoTIFF file.
struct GeoTiff {
  Raster raster;                        ///< heights [m]
  std::optional<std::uint16_t> epsg{};  ///< code of the projected reference system, if any
  std::vector<std::string> warnings{};  ///< oddities that could still be read
};

/// Reads a raster of heights in a projected reference system in metres: the first image of a TIFF file, classic or BigTIFF, of either byte
/// order, in strips or tiles, of integers of 8 to 64 bits or floating-point numbers of 16 to 64, with any compression of libtiff.
/// Heights become `float`. NaN, values not within 1e15 m, and the value for missing ones become NaN.
/// Throws a `FileError`, with the byte if known, for a raster that is incomplete, rotated, sheared, in degrees or feet, or without a
/// georeference. Memory is the raster and one strip or row of tiles, as far as read, not as claimed by the header.
/// Source: TIFF 6.0; OGC GeoTIFF 1.1 (19-008r4); for GDAL_NODATA and tiles that are left out, the GDAL manual, GTiff driver.
[[nodiscard]] GeoTiff read_geotiff(const std::filesystem::path& path, const GeoTiffSettings& settings = {});

/// EPSG code of the projected reference system of a file, if any; reads no heights. Throws as `read_geotiff`.
[[nodiscard]] std::optional<std::uint16_t> read_geotiff_epsg(const std::filesystem::path& path);

namespace detail {

/// Tags and keys by number. Source: OGC GeoTIFF 1.1, annex B and 7.1; GDAL manual.
namespace geotiff {
inline constexpr ttag_t pixel_scale = 33550, tie_points = 33922, transformation = 34264, key_directory = 34735, nodata = 42113;
enum Key : std::uint16_t { model_type = 1024, raster_type = 1025, projected = 3072, linear_unit = 3076, vertical_unit = 4099 };
inline constexpr std::uint16_t user_defined = 32767;
}  // namespace geotiff

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

class GeoTiffReader {
 public:
  GeoTiffReader(const std::filesystem::path& path, const GeoTiffSettings& settings)
      : settings_(validated(settings)), file_(path, "a GeoTIFF"), tiff_(open()) {}

  [[nodiscard]] std::optional<std::uint16_t> epsg() {
    read_keys();
    return result_.epsg;
  }

  [[nodiscard]] GeoTiff read() {
    read_layout();
    read_keys();
    place();
    const std::optional<double> missing = settings_.missing ? settings_.missing : missing_value();
    switch (layout_.format) {
      case SAMPLEFORMAT_IEEEFP:
        if (layout_.bits == 16) return finished<Half>(missing);
        return layout_.bits == 32 ? finished<float>(missing) : finished<double>(missing);
      case SAMPLEFORMAT_INT:
        return whole<std::int8_t, std::int16_t, std::int32_t, std::int64_t>(missing);
      default:
        return whole<std::uint8_t, std::uint16_t, std::uint32_t, std::uint64_t>(missing);
    }
  }

 private:
  enum class Half : std::uint16_t {};

  /// Layout of the samples: in strips as wide as the raster, or in tiles.
  struct Layout {
    std::uint32_t columns = 0, rows = 0;              ///< size of the raster
    std::uint32_t chunk_columns = 0, chunk_rows = 0;  ///< size of a strip or tile
    std::uint16_t samples = 1, bits = 1, format = SAMPLEFORMAT_UINT, planes = PLANARCONFIG_CONTIG;
    bool tiled = false;
    std::uint64_t chunk_bytes = 0;

    /// Distance between samples of one band, in samples.
    [[nodiscard]] std::size_t stride() const noexcept { return planes == PLANARCONFIG_CONTIG ? samples : 1; }
    [[nodiscard]] const char* chunk() const noexcept { return tiled ? "tile " : "strip "; }
  };

  struct Close {
    void operator()(TIFF* tiff) const noexcept { TIFFClose(tiff); }
  };
  using Handle = std::unique_ptr<TIFF, Close>;

  [[noreturn]] void fail(const std::string& problem) const { file_.fail(problem); }

  /// Error of libtiff, to end a sentence.
  [[nodiscard]] std::string complaint() const { return complaint_[0] == '\0' ? "" : std::string(" (libtiff: ") + complaint_.data() + ')'; }

  /// Keeps the first error; warnings concern irrelevant tags. Nothing is printed.
  static int keep_error(TIFF*, void* self, const char*, const char* format, std::va_list arguments) noexcept {
    auto& complaint = static_cast<GeoTiffReader*>(self)->complaint_;
    if (complaint[0] == '\0') (std::vsnprintf)(complaint.data(), complaint.size(), format, arguments);
    return 1;
  }
  static int drop_warning(TIFF*, void*, const char*, const char*, std::va_list) noexcept { return 1; }

  /// Upper limit of the decoded size of any strip or tile: deflate reaches 1,032 to 1, LZW and others somewhat more. A tile of 256 by 256
  /// that is left out or uniform is 16,384 times its entry in the lists of tiles.
  [[nodiscard]] std::uint64_t max_bytes() const noexcept { return (std::uint64_t{1} << 26) + 4096 * file_.size(); }

  [[nodiscard]] Handle open() {
    const std::unique_ptr<TIFFOpenOptions, void (*)(TIFFOpenOptions*)> options(TIFFOpenOptionsAlloc(), TIFFOpenOptionsFree);
    if (!options) throw std::bad_alloc();
    TIFFOpenOptionsSetErrorHandlerExtR(options.get(), keep_error, this);
    TIFFOpenOptionsSetWarningHandlerExtR(options.get(), drop_warning, this);
    TIFFOpenOptionsSetMaxSingleMemAlloc(options.get(), static_cast<tmsize_t>(max_bytes()));
    Handle tiff(TIFFOpenExt(file_.path().c_str(), "rm", options.get()));  // not memory-mapped, as the file may be truncated meanwhile
    if (!tiff) fail("is not a TIFF file that can be read" + complaint() + ": expected a GeoTIFF");
    return tiff;
  }

  template <class Number>
  [[nodiscard]] Number tag(ttag_t number, Number otherwise) const {
    Number value{};
    return TIFFGetFieldDefaulted(tiff_.get(), number, &value) == 1 ? value : otherwise;
  }

  /// Values of an array tag; empty if missing or of another type. libtiff does not know these tags, and defines them as it reads them; if
  /// GDAL or libgeotiff defined them, their counts may have another form.
  template <class Number>
  [[nodiscard]] std::span<const Number> tags(ttag_t number) const {
    constexpr TIFFDataType type = std::is_same_v<Number, double> ? TIFF_DOUBLE : std::is_same_v<Number, char> ? TIFF_ASCII : TIFF_SHORT;
    const TIFFField* field = TIFFFindField(tiff_.get(), number, TIFF_ANY);
    const Number* values = nullptr;
    std::uint32_t count = 0;
    if (field == nullptr || TIFFFieldDataType(field) != type) return {};
    if (TIFFFieldPassCount(field) == 0) {
      if (type != TIFF_ASCII || TIFFGetField(tiff_.get(), number, &values) != 1 || values == nullptr) return {};
      while (values[count] != Number{}) ++count;
    } else if (TIFFFieldReadCount(field) == TIFF_VARIABLE2) {
      if (TIFFGetField(tiff_.get(), number, &count, &values) != 1) return {};
    } else {
      std::uint16_t few = 0;
      if (TIFFGetField(tiff_.get(), number, &few, &values) != 1) return {};
      count = few;
    }
    return {values, values == nullptr ? 0 : count};
  }

  void read_layout() {
    Layout& l = layout_;
    l.columns = tag<std::uint32_t>(TIFFTAG_IMAGEWIDTH, 0), l.rows = tag<std::uint32_t>(TIFFTAG_IMAGELENGTH, 0);
    l.samples = tag<std::uint16_t>(TIFFTAG_SAMPLESPERPIXEL, 1), l.bits = tag<std::uint16_t>(TIFFTAG_BITSPERSAMPLE, 1);
    l.format = tag<std::uint16_t>(TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT);
    l.planes = tag<std::uint16_t>(TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
    const std::string size = std::to_string(l.columns) + " x " + std::to_string(l.rows) + " pixels";
    if (l.columns < 2 || l.rows < 2) fail("is of " + size + ": expected 2 x 2 or more");
    if (settings_.band > l.samples)
      fail("has " + std::to_string(l.samples) + " bands: expected " + std::to_string(settings_.band) + ", or another setting of the band");
    check_samples();

    l.tiled = TIFFIsTiled(tiff_.get()) != 0;
    if (l.tiled) {
      l.chunk_columns = tag<std::uint32_t>(TIFFTAG_TILEWIDTH, 0), l.chunk_rows = tag<std::uint32_t>(TIFFTAG_TILELENGTH, 0);
      l.chunk_bytes = TIFFTileSize64(tiff_.get());
    } else {
      l.chunk_columns = l.columns, l.chunk_rows = std::min(tag<std::uint32_t>(TIFFTAG_ROWSPERSTRIP, l.rows), l.rows);
      l.chunk_bytes = TIFFStripSize64(tiff_.get());
    }
    const std::uint64_t pixels = std::uint64_t{l.columns} * l.rows;
    const std::uint64_t needed = std::uint64_t{l.chunk_columns} * l.chunk_rows;  // pixels of a strip or tile
    if (needed == 0 || l.chunk_bytes / (l.bits / 8U) / l.stride() != needed || l.chunk_bytes % (l.bits / 8U) != 0)
      fail(std::string("has a ") + l.chunk() + "with a size of zero or too large" + complaint());
    const std::uint64_t chunks = l.tiled ? TIFFNumberOfTiles(tiff_.get()) : TIFFNumberOfStrips(tiff_.get());
    if (pixels > max_bytes() / sizeof(float) || l.chunk_bytes > max_bytes() || chunks > file_.size())
      fail("claims " + size + ", more than its " + std::to_string(file_.size()) + " bytes can hold");
    constexpr std::uint32_t most = pulsecast::detail::max_pixels;
    if (l.columns > most || l.rows > most || !((l.columns - 1.0) * (l.rows - 1.0) <= 2147483647))
      fail("is of " + size + ": expected at most 2^27 in a row or column, and 2^31 cells between them");
  }

  void check_samples() const {
    const Layout& l = layout_;
    const bool real = l.format == SAMPLEFORMAT_IEEEFP;
    const bool known = real || l.format == SAMPLEFORMAT_INT || l.format == SAMPLEFORMAT_UINT || l.format == SAMPLEFORMAT_VOID;
    if (!known || !(l.bits == 8 || l.bits == 16 || l.bits == 32 || l.bits == 64) || (real && l.bits == 8))
      fail("has samples of " + std::to_string(l.bits) + " bits, format " + std::to_string(l.format) +
           ": expected whole numbers of 8, 16, 32 or 64 bits, or floating-point numbers of 16, 32 or 64");
    const auto compression = tag<std::uint16_t>(TIFFTAG_COMPRESSION, COMPRESSION_NONE);
    if (TIFFIsCODECConfigured(compression) == 0)
      fail("is compressed by scheme " + std::to_string(compression) + ": expected one that this libtiff can read");
    const auto meaning = tag<std::uint16_t>(TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
    if (meaning == PHOTOMETRIC_YCBCR || meaning == PHOTOMETRIC_LOGL || meaning == PHOTOMETRIC_LOGLUV)
      fail("holds a picture (photometric interpretation " + std::to_string(meaning) + "): expected heights");
  }

  /// Value of a key. Source: OGC GeoTIFF 1.1, 7.1.2 (requirements class GeoKeyDirectory).
  [[nodiscard]] std::uint16_t key(geotiff::Key wanted, std::uint16_t otherwise) const {
    const auto keys = tags<std::uint16_t>(geotiff::key_directory);
    for (std::size_t i = 4; i + 4 <= keys.size() && i / 4 <= keys[3]; i += 4)
      if (keys[i] == wanted && keys[i + 1] == 0) return keys[i + 3];
    return otherwise;
  }

  void read_keys() {
    constexpr std::uint16_t metre = 9001, foot = 9002, us_foot = 9003;  // EPSG codes of units
    const std::uint16_t model = key(geotiff::model_type, 1), unit = key(geotiff::linear_unit, metre);
    const std::uint16_t projected = key(geotiff::projected, 0);
    if (model == 2) fail("is in degrees (a geographic reference system): expected a projected one, in metres");
    if (model == 3) fail("is in a geocentric reference system: expected a projected one, in metres");
    if (unit == foot || unit == us_foot) fail("has coordinates in feet: expected metres");
    if (unit != metre) warn("the unit of its coordinates has the code " + std::to_string(unit) + "; metres are assumed");
    if (projected != 0 && projected != geotiff::user_defined) result_.epsg = projected;
    const std::uint16_t vertical = key(geotiff::vertical_unit, metre);
    if (settings_.vertical_scale) {
      scale_ = *settings_.vertical_scale;
    } else if (vertical == foot || vertical == us_foot) {
      scale_ = vertical == foot ? 0.3048 : 1200.0 / 3937.0;  // source: EPSG registry, units 9002 and 9003
      warn("heights in feet become metres");
    } else if (vertical != metre && vertical != geotiff::user_defined) {
      warn("the unit of its heights has the code " + std::to_string(vertical) + "; metres are assumed");
    }
  }

  /// Finds the position of the pixels. Source: OGC GeoTIFF 1.1, 7.1.1 (raster to model) and 7.1.3 (PixelIsArea, PixelIsPoint).
  void place() {
    const double to_centre = key(geotiff::raster_type, 1) == 2 ? 0 : 0.5;
    const auto scale = tags<double>(geotiff::pixel_scale), ties = tags<double>(geotiff::tie_points),
               matrix = tags<double>(geotiff::transformation);
    double step_x = 0, step_y = 0, x = 0, y = 0;  // step of a column to the east, of a row to the north; first corner
    if (matrix.size() >= 16) {
      step_x = matrix[0], step_y = matrix[5], x = matrix[3], y = matrix[7];
      const double turn = std::max(std::fabs(matrix[1]) * layout_.rows, std::fabs(matrix[4]) * layout_.columns);
      if (!(turn <= 1e-3 * std::min(std::fabs(step_x), std::fabs(step_y))))  // in pixels, over the whole raster
        fail("is rotated or sheared: expected rows to the east; resampling to north up makes them so");
    } else if (scale.size() >= 2 && ties.size() >= 6) {
      step_x = scale[0], step_y = -std::fabs(scale[1]), x = ties[3] - ties[0] * step_x, y = ties[4] - ties[1] * step_y;
      if (scale[1] < 0) warn("ModelPixelScale has a negative height of the pixel; its magnitude is taken, as GDAL does");
      if (scale[0] < 0) fail("has pixels of a negative width: expected a positive one");
      if (scale.size() >= 3 && scale[2] != 0 && scale[2] != 1)
        warn("the vertical scale of ModelPixelScale is ignored; vertical_scale is a setting");
    } else if (ties.size() > 6) {
      fail("is placed by control points: expected rows to the east (ModelPixelScale and ModelTiepoint)");
    } else {
      fail("has no georeference: expected ModelPixelScale and ModelTiepoint, or ModelTransformation");
    }
    westward_ = step_x<0, northward_ = step_y> 0;
    const double column = westward_ ? layout_.columns - 1.0 : 0, row = northward_ ? layout_.rows - 1.0 : 0;
    Raster& raster = result_.raster;
    raster.columns = layout_.columns, raster.rows = layout_.rows;
    raster.first = {x + (column + to_centre) * step_x, y + (row + to_centre) * step_y};
    raster.pixel = {std::fabs(step_x), std::fabs(step_y)};
    const auto sound = [](double first, double pixel) { return std::fabs(first) <= 1e15 && pixel >= 1e-9 && pixel <= 1e6; };
    if (!sound(raster.first.x, raster.pixel.x) || !sound(raster.first.y, raster.pixel.y))
      fail("has its first pixel or the size of pixels out of bounds: expected within 1e15 m, and from 1e-9 m to 1e6 m");
  }

  [[nodiscard]] std::optional<double> missing_value() {
    const auto text = tags<char>(geotiff::nodata);
    std::string_view word(text.data(), text.size());
    word = word.substr(0, word.find('\0'));
    while (!word.empty() && (word.front() == ' ' || word.front() == '+')) word.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error == std::errc()) return value;
    if (!word.empty()) warn("its value for missing heights is not a number, and is ignored");
    return std::nullopt;
  }

  template <class One, class Two, class Four, class Eight>
  [[nodiscard]] GeoTiff whole(std::optional<double> missing) {
    switch (layout_.bits) {
      case 8:
        return finished<One>(missing);
      case 16:
        return finished<Two>(missing);
      case 32:
        return finished<Four>(missing);
      default:
        return finished<Eight>(missing);
    }
  }

  template <class Sample>
  [[nodiscard]] GeoTiff finished(std::optional<double> missing) {
    read_heights<Sample>(missing);
    std::vector<float>& heights = result_.raster.heights;
    const auto row = [&](std::uint32_t r) { return heights.begin() + static_cast<std::ptrdiff_t>(std::size_t{r} * layout_.columns); };
    for (std::uint32_t r = 0; northward_ && r < layout_.rows / 2; ++r) std::swap_ranges(row(r), row(r + 1), row(layout_.rows - 1 - r));
    for (std::uint32_t r = 0; westward_ && r < layout_.rows; ++r) std::reverse(row(r), row(r + 1));
    if (there_ == 0) fail("has no height: expected at least one pixel with a height");
    if (strange_ > 0) warn(std::to_string(strange_) + " values beyond 1e15 m, or infinite, count as missing");
    return std::move(result_);
  }

  /// Reads strip by strip, or rows of tiles; the raster grows meanwhile.
  template <class Sample>
  void read_heights(std::optional<double> missing) {
    const Layout& l = layout_;
    const std::size_t stride = l.stride(), first = l.planes == PLANARCONFIG_CONTIG ? settings_.band - 1U : 0;
    std::vector<float>& heights = result_.raster.heights;
    const bool in_place = !l.tiled && stride == 1 && std::is_same_v<Sample, float>;
    std::vector<unsigned char> buffer;
    try {
      heights.reserve(std::size_t{l.columns} * l.rows);
      if (!in_place) buffer.resize(l.chunk_bytes);
    } catch (const std::bad_alloc&) {
      fail("does not fit into memory: its raster has " + std::to_string(l.columns) + " x " + std::to_string(l.rows) + " pixels");
    }
    for (std::uint32_t north = 0; north < l.rows; north += std::min(l.chunk_rows, l.rows - north)) {
      const std::uint32_t rows = std::min(l.chunk_rows, l.rows - north);
      heights.resize(std::size_t{l.columns} * (north + rows), std::numeric_limits<float>::quiet_NaN());
      for (std::uint32_t west = 0; west < l.columns; west += std::min(l.chunk_columns, l.columns - west)) {
        const std::uint32_t columns = std::min(l.chunk_columns, l.columns - west);
        float* to = heights.data() + std::size_t{north} * l.columns + west;
        auto* from = in_place ? reinterpret_cast<unsigned char*>(to) : buffer.data();
        if (!read_chunk(west, north, from, l.tiled ? l.chunk_bytes : l.chunk_bytes / l.chunk_rows * rows)) continue;
        for (std::uint32_t row = 0; row < rows; ++row) {
          const unsigned char* samples = from + (std::size_t{row} * l.chunk_columns * stride + first) * sizeof(Sample);
          for (std::uint32_t i = 0; i < columns; ++i, samples += stride * sizeof(Sample))
            to[std::size_t{row} * l.columns + i] = height<Sample>(samples, missing);
        }
      }
    }
  }

  /// Reads a strip or tile; false if it was left out.
  [[nodiscard]] bool read_chunk(std::uint32_t west, std::uint32_t north, unsigned char* to, std::uint64_t bytes) {
    const auto plane = static_cast<std::uint16_t>(layout_.planes == PLANARCONFIG_CONTIG ? 0 : settings_.band - 1);
    TIFF* tiff = tiff_.get();
    const std::uint32_t chunk = layout_.tiled ? TIFFComputeTile(tiff, west, north, 0, plane) : TIFFComputeStrip(tiff, north, plane);
    const std::uint64_t begin = TIFFGetStrileOffset(tiff, chunk), length = TIFFGetStrileByteCount(tiff, chunk);
    if (length == 0) return false;
    const std::string what = layout_.chunk() + std::to_string(chunk);
    if (begin > file_.size() || length > file_.size() - begin)
      file_.fail_at_byte(begin, what + " should end at byte " + std::to_string(begin + length) + ", but the file has " +
                                    std::to_string(file_.size()) + ": expected a complete file");
    const auto size = static_cast<tmsize_t>(bytes);
    const tmsize_t read = layout_.tiled ? TIFFReadEncodedTile(tiff, chunk, to, size) : TIFFReadEncodedStrip(tiff, chunk, to, size);
    if (read != size) file_.fail_at_byte(begin, what + " cannot be read" + complaint() + ": expected a complete file");
    return true;
  }

  template <class Sample>
  [[nodiscard]] float height(const unsigned char* bytes, const std::optional<double>& missing) noexcept {
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    double value = 0;
    if constexpr (std::is_same_v<Sample, Half>) {
      std::uint16_t half = 0;
      std::memcpy(&half, bytes, sizeof half);
      value = static_cast<double>(from_half(half));
    } else {
      Sample sample{};
      std::memcpy(&sample, bytes, sizeof sample);
      value = static_cast<double>(sample);
    }
    if (std::isnan(value) || (missing && is_missing<Sample>(value, *missing))) return nan;
    value *= scale_;
    if (!(std::fabs(value) <= 1e15)) {
      ++strange_;
      return nan;
    }
    ++there_;
    return static_cast<float>(value);
  }

  /// True for the value of missing heights, which may be written with more digits than a single-precision sample has.
  template <class Sample>
  static bool is_missing(double value, double missing) noexcept {
    if constexpr (std::is_same_v<Sample, float>) return value == missing || static_cast<float>(value) == static_cast<float>(missing);
    return value == missing;
  }

  void warn(const std::string& what) { result_.warnings.push_back(file_.path() + ": " + what); }

  GeoTiffSettings settings_;
  std::array<char, 256> complaint_{};
  InputFile file_;
  Handle tiff_;
  Layout layout_;
  GeoTiff result_;
  double scale_ = 1;                           // metres per unit of height
  bool westward_ = false, northward_ = false;  // direction of columns and rows in the file
  std::uint64_t there_ = 0, strange_ = 0;      // number of heights, and of values out of bounds
};

}  // namespace detail

inline GeoTiff read_geotiff(const std::filesystem::path& path, const GeoTiffSettings& settings) {
  return detail::GeoTiffReader(path, settings).read();
}

inline std::optional<std::uint16_t> read_geotiff_epsg(const std::filesystem::path& path) { return detail::GeoTiffReader(path, {}).epsg(); }

}  // namespace pulsecast::io
