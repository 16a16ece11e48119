// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/geotiff.hpp>

#include <doctest/doctest.h>
#include <tiffio.h>

#include <bit>
#include <cmath>
#include <cstdarg>
#include <cstring>
#include <fstream>
#include <functional>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include <pulsecast/io/detail/geotiff/raster_layout.hpp>
#include <pulsecast/io/detail/geotiff/rules.hpp>
#include <pulsecast/shape/height_field.hpp>

#include "support/data_folder.hpp"
#include "support/file_errors.hpp"
#include "support/format_cases.hpp"
#include "support/generators.hpp"
#include "support/reference_database.hpp"
#include "support/relative.hpp"
#include "support/temporary_folder.hpp"

using namespace pulsecast;
using namespace pulsecast::io;
using support::contains;
using support::TemporaryFolder;

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();
using Codes = std::vector<std::uint16_t>;
constexpr std::uint32_t columns = 37, rows = 23;  // neither a multiple of the tiles nor of the strips

/// How a raster is laid down in its file.
struct Form {
  std::uint16_t format = SAMPLEFORMAT_IEEEFP, bits = 32, compression = COMPRESSION_NONE, predictor = 1, samples = 1,
                planes = PLANARCONFIG_CONTIG, photometric = PHOTOMETRIC_MINISBLACK;
  bool tiled = false;
  const char* mode = "w";
  std::uint32_t padding = 0;           ///< rows after the last, which the header does not count
  std::vector<std::uint16_t> extra{};  ///< kinds of the samples after the first
  std::uint16_t orientation = ORIENTATION_TOPLEFT;
  std::uint32_t depth = 1, kind = 0;  ///< of the first image
  std::uint32_t masked = 0;           ///< columns in the west that a second image hides
  std::uint16_t mask_bits = 1;        ///< of that image
  bool mask_tiled = false;
  std::uint32_t mask_rows = rows, second_kind = FILETYPE_MASK;
  std::set<std::uint32_t> left_out{};  ///< tiles
  std::vector<std::uint16_t> red{}, green{}, blue{};
};

/// What a file says of where its pixels are.
struct Place {
  std::vector<double> scale{2, 3, 0}, ties{0, 0, 0, 1000, 2000, 0}, matrix{};
  std::vector<std::uint16_t> keys{1, 1, 0, 3, 1024, 0, 1, 1, 1025, 0, 1, 1, 3072, 0, 1, 32633};
  std::string nodata{}, metadata{}, texts{};
  std::vector<double> numbers{};
};

/// A file's place with more keys than its model.
Place keyed(std::vector<std::uint16_t> more, std::uint16_t model = 1) {
  Place place{.keys = {1, 1, 0, static_cast<std::uint16_t>(1 + more.size() / 4), 1024, 0, 1, model}};
  place.keys.insert(place.keys.end(), more.begin(), more.end());
  return place;
}

/// An item of GDAL's metadata.
std::string item(const std::string& role, const std::string& value, int band = 0) {
  return "  <Item name=\"" + role + "\" sample=\"" + std::to_string(band) + "\" role=\"" + role + "\">" + value +
         "</Item>\n";
}
Place told(const std::string& items) { return {.metadata = "<GDALMetadata>\n" + items + "</GDALMetadata>\n"}; }

/// Fits every kind of sample, and has all its values different from those of its neighbours.
double height(std::uint32_t column, std::uint32_t row, std::uint16_t) { return 60.0 + column - row; }

/// A whole number of at most 11 bits, or what is not finite, as binary16.
std::uint16_t to_half(double value) {
  if (value == 0) return 0;
  if (std::isnan(value)) return 0x7E00;
  const std::uint16_t sign = value < 0 ? 0x8000 : 0;
  if (std::isinf(value)) return sign | 0x7C00;
  int exponent = 0;
  const double fraction = std::frexp(std::fabs(value), &exponent);  // in [0.5, 1)
  return static_cast<std::uint16_t>(sign | (exponent + 14) << 10 | static_cast<int>((2 * fraction - 1) * 1024));
}

template <class Number>
void put(std::vector<unsigned char>& bytes, Number value) {
  bytes.resize(bytes.size() + sizeof value);
  std::memcpy(bytes.data() + bytes.size() - sizeof value, &value, sizeof value);
}

void put_sample(std::vector<unsigned char>& bytes, const Form& form, double value) {
  if (form.format == SAMPLEFORMAT_IEEEFP) {
    if (form.bits == 16) return put(bytes, to_half(value));
    return form.bits == 32 ? put(bytes, static_cast<float>(value)) : put(bytes, value);
  }
  const auto whole = static_cast<std::int64_t>(value);
  if (form.bits == 8) return put(bytes, static_cast<std::int8_t>(whole));
  if (form.bits == 16) return put(bytes, static_cast<std::int16_t>(whole));
  return form.bits == 32 ? put(bytes, static_cast<std::int32_t>(whole)) : put(bytes, whole);
}

/// Adds an image that is 0 in the columns that `form` hides, and not 0 elsewhere.
void put_mask(TIFF* tiff, const Form& form) {
  REQUIRE(TIFFWriteDirectory(tiff) == 1);
  TIFFSetField(tiff, TIFFTAG_SUBFILETYPE, form.second_kind);
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, columns);
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, form.mask_rows);
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, form.mask_bits);
  TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MASK);
  TIFFSetField(tiff, TIFFTAG_COMPRESSION, COMPRESSION_ADOBE_DEFLATE);
  const std::uint32_t wide = form.mask_tiled ? 32 : columns, high = form.mask_tiled ? 16 : 7;
  if (form.mask_tiled) {
    TIFFSetField(tiff, TIFFTAG_TILEWIDTH, wide);
    TIFFSetField(tiff, TIFFTAG_TILELENGTH, high);
  } else
    TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, high);
  for (std::uint32_t north = 0; north < form.mask_rows; north += high)
    for (std::uint32_t west = 0; west < columns; west += wide) {
      const std::uint32_t all = form.mask_tiled ? high : std::min(high, form.mask_rows - north);
      const std::size_t row_bytes = (wide * form.mask_bits + 7U) / 8U;
      std::vector<unsigned char> bytes(row_bytes * all);
      for (std::uint32_t r = 0; r < all; ++r)
        for (std::uint32_t c = 0; c < wide; ++c) {
          if (west + c < form.masked) continue;
          if (form.mask_bits == 1)
            bytes[r * row_bytes + c / 8] |= static_cast<unsigned char>(0x80U >> c % 8);
          else
            bytes[r * row_bytes + c] = 255;
        }
      const auto size = static_cast<tmsize_t>(bytes.size());
      const std::uint32_t chunk =
          form.mask_tiled ? TIFFComputeTile(tiff, west, north, 0, 0) : TIFFComputeStrip(tiff, north, 0);
      REQUIRE((form.mask_tiled ? TIFFWriteEncodedTile(tiff, chunk, bytes.data(), size)
                               : TIFFWriteEncodedStrip(tiff, chunk, bytes.data(), size)) == size);
    }
}

using Heights = std::function<double(std::uint32_t, std::uint32_t, std::uint16_t)>;

void write(const std::filesystem::path& path, const Form& form = {}, const Place& place = {},
           const Heights& heights = height) {
  TIFF* tiff = TIFFOpen(path.c_str(), form.mode);
  REQUIRE(tiff != nullptr);
  TIFFSetWarningHandler(nullptr);  // it warns of the older number for deflate
  static const std::vector<TIFFFieldInfo> fields{
      {33550, -1, -1, TIFF_DOUBLE, FIELD_CUSTOM, 1, 1, const_cast<char*>("scale")},
      {33922, -1, -1, TIFF_DOUBLE, FIELD_CUSTOM, 1, 1, const_cast<char*>("ties")},
      {34264, -1, -1, TIFF_DOUBLE, FIELD_CUSTOM, 1, 1, const_cast<char*>("matrix")},
      {34735, -1, -1, TIFF_SHORT, FIELD_CUSTOM, 1, 1, const_cast<char*>("keys")},
      {34736, -1, -1, TIFF_DOUBLE, FIELD_CUSTOM, 1, 1, const_cast<char*>("numbers")},
      {34737, -1, -1, TIFF_ASCII, FIELD_CUSTOM, 1, 0, const_cast<char*>("texts")},
      {42112, -1, -1, TIFF_ASCII, FIELD_CUSTOM, 1, 0, const_cast<char*>("metadata")},
      {42113, -1, -1, TIFF_ASCII, FIELD_CUSTOM, 1, 0, const_cast<char*>("nodata")}};
  TIFFMergeFieldInfo(tiff, fields.data(), static_cast<std::uint32_t>(fields.size()));
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, columns);
  const std::uint32_t all_rows = rows + form.padding;
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, all_rows);
  TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, form.samples);
  TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, form.planes);
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, form.bits);
  TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, form.format);
  TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, form.photometric);
  TIFFSetField(tiff, TIFFTAG_COMPRESSION, form.compression);
  if (!form.red.empty()) TIFFSetField(tiff, TIFFTAG_COLORMAP, form.red.data(), form.green.data(), form.blue.data());
  if (form.compression == COMPRESSION_LZMA)
    TIFFSetField(tiff, TIFFTAG_LZMAPRESET, 0);  // without 100 MB of memory for each strip
  if (form.compression == COMPRESSION_ZSTD) TIFFSetField(tiff, TIFFTAG_ZSTD_LEVEL, 1);
  if (form.predictor != 1) TIFFSetField(tiff, TIFFTAG_PREDICTOR, form.predictor);
  if (!place.scale.empty()) TIFFSetField(tiff, 33550, static_cast<int>(place.scale.size()), place.scale.data());
  if (!place.ties.empty()) TIFFSetField(tiff, 33922, static_cast<int>(place.ties.size()), place.ties.data());
  if (!place.matrix.empty()) TIFFSetField(tiff, 34264, static_cast<int>(place.matrix.size()), place.matrix.data());
  if (!place.keys.empty()) TIFFSetField(tiff, 34735, static_cast<int>(place.keys.size()), place.keys.data());
  if (!form.extra.empty())
    TIFFSetField(tiff, TIFFTAG_EXTRASAMPLES, static_cast<int>(form.extra.size()), form.extra.data());
  if (form.orientation != ORIENTATION_TOPLEFT) TIFFSetField(tiff, TIFFTAG_ORIENTATION, form.orientation);
  if (form.depth != 1) TIFFSetField(tiff, TIFFTAG_IMAGEDEPTH, form.depth);
  if (form.kind != 0) TIFFSetField(tiff, TIFFTAG_SUBFILETYPE, form.kind);
  if (!place.texts.empty()) TIFFSetField(tiff, 34737, place.texts.c_str());
  if (!place.numbers.empty()) TIFFSetField(tiff, 34736, static_cast<int>(place.numbers.size()), place.numbers.data());
  if (!place.metadata.empty()) TIFFSetField(tiff, 42112, place.metadata.c_str());
  if (!place.nodata.empty()) TIFFSetField(tiff, 42113, place.nodata.c_str());
  const std::uint32_t wide = form.tiled ? 16 : columns, high = form.tiled ? 16 : 5;
  if (form.tiled) {
    TIFFSetField(tiff, TIFFTAG_TILEWIDTH, wide);
    TIFFSetField(tiff, TIFFTAG_TILELENGTH, high);
  } else
    TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, high);
  const bool apart = form.planes == PLANARCONFIG_SEPARATE;
  for (std::uint16_t plane = 0; plane < (apart ? form.samples : 1); ++plane)
    for (std::uint32_t north = 0; north < all_rows; north += high)
      for (std::uint32_t west = 0; west < columns; west += wide) {
        std::vector<unsigned char> bytes;
        for (std::uint32_t r = north; r < (form.tiled ? north + high : std::min(north + high, all_rows)); ++r)
          for (std::uint32_t c = west; c < west + wide; ++c)
            for (std::uint16_t s = 0; s < (apart ? 1 : form.samples); ++s)
              put_sample(bytes, form, heights(std::min(c, columns - 1), std::min(r, all_rows - 1), apart ? plane : s));
        if (form.predictor == PREDICTOR_FLOATINGPOINT &&
            std::string_view(form.mode).ends_with('b'))  // libtiff 4.5 writes these wrongly:
          for (auto at = bytes.begin(); at != bytes.end(); at += form.bits / 8)
            std::reverse(at, at + form.bits / 8);  // turned once too often
        const auto size = static_cast<tmsize_t>(bytes.size());
        const std::uint32_t chunk =
            form.tiled ? TIFFComputeTile(tiff, west, north, 0, plane) : TIFFComputeStrip(tiff, north, plane);
        if (form.left_out.count(chunk) != 0) continue;
        REQUIRE((form.tiled ? TIFFWriteEncodedTile(tiff, chunk, bytes.data(), size)
                            : TIFFWriteEncodedStrip(tiff, chunk, bytes.data(), size)) == size);
      }
  if (form.masked > 0) put_mask(tiff, form);
  TIFFClose(tiff);
  if (form.padding == 0) return;
  std::string bytes = support::content(path);
  const std::size_t entry = bytes.find(std::string("\x01\x01\x03\0\x01\0\0\0", 8) + static_cast<char>(all_rows));
  REQUIRE(entry != bytes.npos);
  bytes[entry + 8] = static_cast<char>(rows);
  std::filesystem::remove(path);
  std::ofstream(path, std::ios::binary) << bytes;
}

struct File {
  TemporaryFolder folder;
  std::filesystem::path path = folder / "terrain.tif";

  [[nodiscard]] GeoTiff read(const Form& form = {}, const Place& place = {}, const Heights& heights = height,
                             const GeoTiffSettings& settings = {}) const {
    write(path, form, place, heights);
    return read_geotiff(path, settings);
  }

  /// What the refusal says; empty if the file is read.
  [[nodiscard]] std::string refusal(const Form& form = {}, const Place& place = {},
                                    const GeoTiffSettings& settings = {}) const {
    write(path, form, place);
    return refusal_of(settings);
  }

  [[nodiscard]] std::string refusal_of(const GeoTiffSettings& settings = {}) const {
    try {
      (void)read_geotiff(path, settings);
      return {};
    } catch (const FileError& error) {
      CHECK(error.path() == path.string());
      return error.problem();
    }
  }
};

/// The pixels that are not as they should be.
std::size_t wrong(const Raster& raster, const Heights& heights, std::uint16_t sample = 0) {
  std::size_t count = 0;
  for (std::uint32_t r = 0; r < rows; ++r)
    for (std::uint32_t c = 0; c < columns; ++c) {
      const auto expected = static_cast<float>(heights(c, r, sample));
      const float found = raster.heights[std::size_t{r} * columns + c];
      count += found == expected || (std::isnan(found) && std::isnan(expected)) ? 0 : 1;
    }
  return count;
}

/// A little-endian TIFF file by its entries: (tag, type, count, value), the value as it stands in the entry.
std::string bare(const std::vector<std::array<std::uint32_t, 4>>& entries, const std::string& rest = {}) {
  std::vector<unsigned char> bytes{'I', 'I', 42, 0, 8, 0, 0, 0};
  put(bytes, static_cast<std::uint16_t>(entries.size()));
  for (const auto& [tag, type, count, value] : entries) {
    put(bytes, static_cast<std::uint16_t>(tag));
    put(bytes, static_cast<std::uint16_t>(type));
    put(bytes, count);
    put(bytes, value);
  }
  put(bytes, std::uint32_t{0});
  return std::string(bytes.begin(), bytes.end()) + rest;
}

void keep(const std::filesystem::path& path, const std::string& bytes) {
  std::filesystem::remove(path);
  std::ofstream(path, std::ios::binary) << bytes;
}

}  // namespace

TEST_CASE("a raster is read as it was written, whatever its samples, layout, compression and byte order") {
  const File file;
  std::size_t forms = 0;
  for (const std::uint16_t format : Codes{SAMPLEFORMAT_IEEEFP, SAMPLEFORMAT_INT, SAMPLEFORMAT_UINT})
    for (const std::uint16_t bits : Codes{8, 16, 32, 64})
      for (const std::uint16_t compression :
           Codes{COMPRESSION_NONE, COMPRESSION_LZW, COMPRESSION_PACKBITS, COMPRESSION_ADOBE_DEFLATE,
                 COMPRESSION_DEFLATE, COMPRESSION_ZSTD, COMPRESSION_LZMA, COMPRESSION_LERC})
        for (const std::uint16_t predictor : Codes{PREDICTOR_NONE, PREDICTOR_HORIZONTAL, PREDICTOR_FLOATINGPOINT})
          for (const bool tiled : {false, true})
            for (const char* mode : {"wl", "wb", "w8l", "w8b"}) {
              const bool real = format == SAMPLEFORMAT_IEEEFP;
              if (real && bits == 8) continue;
              if (predictor == PREDICTOR_FLOATINGPOINT && !real) continue;
              if (predictor != PREDICTOR_NONE &&
                  (compression == COMPRESSION_NONE || compression == COMPRESSION_PACKBITS ||
                   compression == COMPRESSION_LERC))
                continue;
              if (compression == COMPRESSION_LERC && (bits == 64 || bits == 16) && (!real || bits == 16))
                continue;  // not known to it
              if (TIFFIsCODECConfigured(compression) == 0) continue;
              CAPTURE(format);
              CAPTURE(bits);
              CAPTURE(compression);
              CAPTURE(predictor);
              CAPTURE(tiled);
              CAPTURE(std::string(mode));
              const GeoTiff found = file.read({.format = format,
                                               .bits = bits,
                                               .compression = compression,
                                               .predictor = predictor,
                                               .tiled = tiled,
                                               .mode = mode});
              CHECK(wrong(found.raster, height) == 0);
              CHECK(found.warnings.empty());
              ++forms;
            }
  CHECK(forms > 500);
}

TEST_CASE("whole numbers of 8 and 16 bits may stay packed, with the heights that they have otherwise") {
  const File file;
  const auto same = [](const Raster& a, const Raster& b) {
    return a.heights.size() == b.heights.size() &&
           std::memcmp(a.heights.data(), b.heights.data(), sizeof(float) * a.heights.size()) == 0 &&
           a.first == b.first && a.pixel == b.pixel;
  };
  const auto packed_like = [&](const std::optional<double>& scale, const std::optional<double>& missing,
                               bool expected) {
    const Raster wide = read_geotiff(file.path, {.vertical_scale = scale, .missing = missing}).raster;
    const Raster packed = read_geotiff(file.path, {.vertical_scale = scale, .missing = missing, .packed = true}).raster;
    CHECK_FALSE(wide.is_packed());
    CHECK(packed.is_packed() == expected);
    CHECK(packed.heights.empty() == expected);
    CHECK(same(packed.unpacked(), wide));
  };
  const Heights hills = [](std::uint32_t c, std::uint32_t r, std::uint16_t) { return 20.0 + 3 * c - r; };
  for (const std::uint16_t format : Codes{SAMPLEFORMAT_INT, SAMPLEFORMAT_UINT})
    for (const std::uint16_t bits : Codes{8, 16, 32})
      for (const bool tiled : {false, true})
        for (const std::uint16_t samples : Codes{1, 2})
          for (const char* mode : {"wl", "wb"}) {
            CAPTURE(format);
            CAPTURE(bits);
            const Form form{.format = format, .bits = bits, .samples = samples, .tiled = tiled, .mode = mode};
            write(file.path, form,
                  {.scale = {}, .ties = {}, .matrix = {-2, 0, 0, 1000, 0, 3, 0, 900, 0, 0, 0, 0, 0, 0, 0, 1}}, hills);
            packed_like({}, {}, bits < 32);
            packed_like(0.1, {}, bits < 32);
            packed_like(1.0 / 3, 21, bits < 32);
            packed_like(1e14, {}, false);
            write(file.path, form, {.nodata = "40"}, hills);
            packed_like({}, {}, bits < 32);
            packed_like(0.3048, -9999, bits < 32);
            packed_like({}, 20.5, bits < 32);
          }
  const Heights below = [](std::uint32_t c, std::uint32_t r, std::uint16_t) { return -32768.0 + 10 * c + r; };
  write(file.path, {.format = SAMPLEFORMAT_INT, .bits = 16}, {.nodata = "-32768"}, below);
  packed_like(0.01, {}, true);
  for (const std::uint16_t bits : Codes{8, 16})
    for (const std::string nodata : {"", "50"}) {  // two tiles are left out
      write(file.path, {.format = SAMPLEFORMAT_UINT, .bits = bits, .tiled = true, .left_out = {1, 3}},
            {.nodata = nodata}, height);
      packed_like({}, {}, bits == 8 || !nodata.empty());
    }
  const Heights all_missing = [](std::uint32_t, std::uint32_t, std::uint16_t) { return 7.0; };
  write(file.path, {.format = SAMPLEFORMAT_UINT, .bits = 16}, {.nodata = "7"}, all_missing);
  CHECK(contains(file.refusal_of({.packed = true}), "has no height"));
}

TEST_CASE("a picture with a colour table is a raster of its numbers, with the colours of the table") {
  const File file;
  const Heights codes = [](std::uint32_t c, std::uint32_t r, std::uint16_t) { return (c + 5 * r) % 7 * 3.0; };
  for (const std::uint16_t bits : Codes{8, 16})
    for (const std::uint16_t most : Codes{255, 65535})
      for (const bool tiled : {false, true})
        for (const char* mode : {"wl", "wb"}) {
          CAPTURE(bits);
          CAPTURE(most);
          const std::size_t count = std::size_t{1} << bits;
          Form form{.format = SAMPLEFORMAT_UINT,
                    .bits = bits,
                    .photometric = PHOTOMETRIC_PALETTE,
                    .tiled = tiled,
                    .mode = mode};
          form.red.resize(count, 0);
          form.green.resize(count, 0);
          form.blue.resize(count, 0);
          form.red[3] = form.blue[18] = form.blue[255] = most;
          form.green[3] = most / 5;
          const GeoTiff found = file.read(form, {.nodata = "18"}, codes, {.packed = true});
          REQUIRE(found.colours.size() == count);
          CHECK(found.colours[0] == Vec3{});
          CHECK(found.colours[3] == Vec3{1, 0.2, 0});
          CHECK(found.colours[18] == Vec3{0, 0, 1});
          CHECK(found.colours[255] == Vec3{0, 0, 1});
          const Heights expected = [&](std::uint32_t c, std::uint32_t r, std::uint16_t s) {
            return codes(c, r, s) == 18 ? none : codes(c, r, s);
          };
          CHECK(wrong(found.raster.unpacked(), expected) == 0);
        }
  CHECK(file.read().colours.empty());
  // a palette without a table, which libtiff adds no default for
  CHECK(file.read({.format = SAMPLEFORMAT_UINT, .bits = 8, .photometric = PHOTOMETRIC_PALETTE}).colours.empty());
}

TEST_CASE("heights pass through lossy JPEG with little change") {
  if (TIFFIsCODECConfigured(COMPRESSION_JPEG) == 0) return;
  const File file;
  const GeoTiff found =
      file.read({.format = SAMPLEFORMAT_UINT, .bits = 8, .compression = COMPRESSION_JPEG, .tiled = true});
  for (std::uint32_t i = 0; i < columns * rows; ++i)
    CHECK(std::fabs(static_cast<double>(found.raster.heights[i]) - height(i % columns, i / columns, 0)) < 8);
}

TEST_CASE("one band is chosen of several, side by side or one after the other") {
  const File file;
  const Heights heights = [](std::uint32_t c, std::uint32_t r, std::uint16_t s) { return 10.0 * s + c % 7 + r % 3; };
  for (const std::uint16_t planes : Codes{PLANARCONFIG_CONTIG, PLANARCONFIG_SEPARATE})
    for (const bool tiled : {false, true})
      for (const std::uint16_t bits : Codes{16, 32})
        for (const std::uint16_t band : Codes{1, 2, 3}) {
          const Form form{.bits = bits, .compression = COMPRESSION_LZW, .samples = 3, .planes = planes, .tiled = tiled};
          CHECK(wrong(file.read(form, {}, heights, {.band = band}).raster, heights,
                      static_cast<std::uint16_t>(band - 1)) == 0);
        }
  CHECK(contains(file.refusal({.samples = 3}, {}, {.band = 4}), "has 3 bands: expected 4"));
}

TEST_CASE("halves are read to the last bit") {
  for (std::uint32_t half = 0; half < 65536; ++half) {
    const float value = io::detail::from_half(static_cast<std::uint16_t>(half));
    const int exponent = static_cast<int>(half >> 10 & 31U);
    const double fraction = (half & 1023U) / 1024.0, sign = half < 32768 ? 1 : -1;
    CAPTURE(half);
    if (exponent == 31)
      CHECK((fraction == 0 ? std::isinf(value) && std::signbit(value) == (sign < 0) : std::isnan(value)));
    else
      CHECK(static_cast<double>(value) ==
            sign * (exponent == 0 ? std::ldexp(fraction, -14) : std::ldexp(1 + fraction, exponent - 15)));
  }
}

TEST_CASE("the sample file is where and what it should be") {
  const GeoTiff found = read_geotiff(support::data_folder / "terrain.tif");
  const Raster& raster = found.raster;
  CHECK((raster.columns == 101 && raster.rows == 81));
  CHECK(raster.first == Vec2{476005, 5474805});
  CHECK(raster.pixel == Vec2{10, 10});
  CHECK(found.epsg == 32632);
  CHECK(read_geotiff_epsg(support::data_folder / "terrain.tif") == 32632);
  CHECK(read_geotiff_reference(support::data_folder / "terrain.tif") == SpatialReference{.epsg = 32632});
  CHECK(found.warnings.empty());
  CHECK(static_cast<double>(raster.heights[0]) == support::relative(118.55, 1e-5));
  const HeightField field(raster);
  CHECK(field.bounds().max.y == 5474805);
}

TEST_CASE("pixels are areas or points, tied anywhere") {
  const File file;
  Place place;
  CHECK(file.read({}, place).raster.first == Vec2{1001, 1998.5});
  CHECK(file.read({}, place).raster.pixel == Vec2{2, 3});
  place.keys[11] = 2;  // PixelIsPoint
  CHECK(file.read({}, place).raster.first == Vec2{1000, 2000});
  place.ties = {10, 20, 0, 1000, 2000, 0};
  CHECK(file.read({}, place).raster.first == Vec2{980, 2060});
  place.keys.clear();  // an area unless told otherwise
  CHECK(file.read({}, place).raster.first == Vec2{981, 2058.5});
  CHECK_FALSE(file.read({}, place).epsg);
}

TEST_CASE("a transformation places the raster; rows and columns that go the other way are turned about") {
  const File file;
  const auto matrix = [](double a, double e, double turn = 0) {
    return Place{.scale = {}, .ties = {}, .matrix = {a, turn, 0, 1000, turn, e, 0, 2000, 0, 0, 0, 0, 0, 0, 0, 1}};
  };
  const auto west = [](std::uint32_t c, std::uint32_t r, std::uint16_t s) { return height(columns - 1 - c, r, s); };
  const auto north = [](std::uint32_t c, std::uint32_t r, std::uint16_t s) { return height(c, rows - 1 - r, s); };
  for (const bool tiled : {false, true}) {
    Raster raster = file.read({.tiled = tiled}, matrix(2, -3)).raster;
    CHECK(raster.first == Vec2{1001, 1998.5});
    CHECK(wrong(raster, height) == 0);
    raster = file.read({.tiled = tiled}, matrix(-2, -3)).raster;
    CHECK(raster.first == Vec2{1000 - 36.5 * 2, 1998.5});
    CHECK(raster.pixel == Vec2{2, 3});
    CHECK(wrong(raster, west) == 0);
    raster = file.read({.tiled = tiled}, matrix(2, 3)).raster;
    CHECK(raster.first == Vec2{1001, 2000 + 22.5 * 3});
    CHECK(wrong(raster, north) == 0);
  }
  CHECK(contains(file.refusal({}, matrix(2, -3, 0.1)), "is rotated or sheared"));
  CHECK(contains(file.refusal({}, matrix(0, 0, 2)), "is rotated or sheared"));
  CHECK(contains(file.refusal({}, matrix(none, -3)), "is rotated or sheared"));
  CHECK(contains(file.refusal({}, matrix(2, -1e9)), "out of bounds"));
  CHECK(file.refusal({}, matrix(2, -3, 1e-9)).empty());
}

TEST_CASE("a raster without a place of its own is refused") {
  const File file;
  CHECK(contains(file.refusal({}, {.scale = {}, .ties = {}}), "has no georeference"));
  CHECK(contains(file.refusal({}, {.ties = {}}), "has no georeference"));
  CHECK(contains(file.refusal({}, {.scale = {}}), "has no georeference"));
  CHECK(contains(file.refusal({}, {.scale = {}, .ties = std::vector<double>(18)}), "control points"));
  CHECK(contains(file.refusal({}, {.scale = {-2, 3, 0}}), "negative width"));
  CHECK(contains(file.refusal({}, {.scale = {0, 3, 0}}), "out of bounds"));
  CHECK(contains(file.refusal({}, {.scale = {2, infinite, 0}}), "out of bounds"));
  CHECK(contains(file.refusal({}, {.ties = {0, 0, 0, none, 0, 0}}), "out of bounds"));
  const GeoTiff south = file.read({}, {.scale = {2, -3, 0}});  // as GDAL takes it
  CHECK(south.raster.first == Vec2{1001, 1998.5});
  CHECK(south.warnings.size() == 1);
  CHECK(file.read({}, {.scale = {2, 3, 10}}).warnings.size() == 1);
}

TEST_CASE("keys tell the reference system, and the unit of the coordinates") {
  const File file;
  CHECK(file.read({}, keyed({3072, 0, 1, 25832})).epsg == 25832);
  CHECK(file.read({}, keyed({3072, 0, 1, 25832})).warnings.empty());
  CHECK_FALSE(file.read({}, keyed({3072, 0, 1, 32767})).epsg);  // user-defined
  CHECK_FALSE(file.read({}, keyed({3072, 34736, 1, 25832})).epsg);
  CHECK_FALSE(file.read({}, keyed({3072, 0, 1})).epsg);  // cut off
  CHECK(contains(file.refusal({}, keyed({2048, 0, 1, 4326}, 2)), "not degrees"));
  Place no_model = keyed({2048, 0, 1, 4326});
  no_model.keys[4] = 1025;
  CHECK(contains(file.refusal({}, no_model), "not degrees"));

  constexpr double us_foot = 1200.0 / 3937;
  const support::WithDatabase no_database(nullptr);
  struct Case {
    std::vector<std::uint16_t> keys;
    double unit;
    std::string texts{};
    std::vector<double> numbers{};
  };
  for (const Case& c : {Case{{3076, 0, 1, 9001}, 1},
                        {{3072, 0, 1, 2263, 3076, 0, 1, 9003}, us_foot},
                        {{3072, 0, 1, 2222, 3076, 0, 1, 9002}, 0.3048},
                        {{3076, 0, 1, 9036}, 1000},
                        {{3076, 0, 1, 9096}, 0.9144},
                        {{3076, 0, 1, 32767, 3077, 34736, 1, 1}, 0.5, "", {7, 0.5}},
                        {{3077, 34736, 1, 0}, 0.25, "", {0.25}},
                        {{1026, 34737, 20, 0, 3072, 0, 1, 2263}, us_foot, "NAD83 / New York (ftUS)|"},
                        {{3072, 0, 1, 28992}, 1}}) {
    CAPTURE(c.keys);
    Place place = keyed(c.keys);
    place.texts = c.texts;
    place.numbers = c.numbers;
    const GeoTiff found = file.read({}, place);
    CHECK(found.reference.unit == support::relative(c.unit, 1e-15));
    CHECK(found.raster.pixel.x == support::relative(2 * c.unit, 1e-15));
    CHECK(found.raster.pixel.y == support::relative(3 * c.unit, 1e-15));
    CHECK(found.raster.first.x == support::relative(1001 * c.unit, 1e-15));
    CHECK(found.raster.first.y == support::relative(1998.5 * c.unit, 1e-15));
    CHECK(found.raster.heights[0] == 60);
    CHECK(found.warnings.size() == (c.unit == 1 ? 0 : 1));  // the unit of the heights is unknown
    const std::uint16_t system = found.reference.epsg;
    CHECK(found.epsg == (c.unit == 1 && system != 0 ? std::optional(system) : std::nullopt));
    CHECK(read_geotiff_epsg(file.path) == found.epsg);
    CHECK(read_geotiff_reference(file.path) == found.reference);
    CHECK(read_geotiff(file.path, {.vertical_scale = 1}).warnings.empty());
  }
  CHECK(file.read({}, keyed({3072, 0, 1, 2263})).warnings.size() == 1);  // no unit and no name
  Place paris = keyed({1026, 34737, 20, 0, 3072, 0, 1, 2154});
  paris.texts = "RGF93 v1 / Lambert-93 + NGF-IGN69 height|";
  CHECK(file.read({}, paris).warnings.empty());
  const auto heights_of = [&](std::uint16_t unit, const GeoTiffSettings& settings = {}) {
    return static_cast<double>(file.read({}, keyed({4099, 0, 1, unit}), height, settings).raster.heights[0]);
  };
  CHECK(heights_of(9001) == 60);
  CHECK(heights_of(9002) == support::relative(60 * 0.3048, 1e-7));
  CHECK(heights_of(9003) == support::relative(60 * us_foot, 1e-7));
  CHECK(heights_of(9003, {.vertical_scale = 0.5}) == 30);
  CHECK(heights_of(9999, {.vertical_scale = 0.5}) == 30);
  CHECK(file.read({}, keyed({4099, 0, 1, 9003})).warnings.empty());
}

TEST_CASE("a vertical or a compound system tells the unit of the heights, where no key does") {
  const File file;
  const support::WithDatabase database([](const SpatialReference&, const std::string&) {
    return SpatialReference{.epsg = 2263, .vertical_epsg = 6360, .unit = 0.25, .vertical_unit = 0.5};
  });
  const GeoTiff found = file.read({}, keyed({3072, 0, 1, 8712}));
  CHECK(found.reference == SpatialReference{.epsg = 8712, .unit = 0.25, .vertical_unit = 0.5});
  CHECK(found.raster.heights[0] == 30);
  CHECK(found.raster.pixel == Vec2{0.5, 0.75});
  CHECK(file.read({}, keyed({4096, 0, 1, 6360})).raster.heights[0] == 30);
  CHECK(read_geotiff_reference(file.path).vertical_epsg == 6360);
  CHECK(file.read({}, keyed({4096, 0, 1, 6360, 4099, 0, 1, 9001})).raster.heights[0] == 60);
  CHECK(read_geotiff(file.path, {.vertical_scale = 1}).warnings.empty());
  CHECK(contains(file.refusal({}, keyed({4096, 0, 1, 5715})), "expected heights, not depths"));
  CHECK(file.refusal({}, keyed({4096, 0, 1, 5715}), {.vertical_scale = 1}).empty());
}

TEST_CASE("scale, offset and unit of a band are applied, to packed heights alike") {
  const File file;
  struct Case {
    std::string items;
    double scale = 1, offset = 0;
    std::size_t notes = 0;
  };
  const std::string other = "  <Item name=\"AREA\">Alps</Item>\n";
  for (const Case& c : {Case{other},
                        {other + item("scale", "0.0100000000000000002"), 0.01},
                        {item("offset", "-100") + item("scale", "0.1"), 0.1, -100},
                        {item("offset", "12.5"), 1, 12.5},
                        {item("scale", "5", 1)},
                        {item("unittype", "m")},
                        {item("unittype", "FT"), 0.3048},
                        {item("unittype", "US survey foot") + item("offset", "10"), 1200.0 / 3937, 12000.0 / 3937},
                        {item("unittype", "cm"), 0.01},
                        {item("unittype", "ell"), 1, 0, 1},
                        {"<Item name=\"x#scale_factor\" sample=\"0\">0.1</Item>", 1, 0, 1},
                        {"<Item name=\"add_offset\">0.1</Item>" + item("offset", "2"), 1, 2},
                        {item("scale", "-1"), -1}})
    for (const std::uint16_t format : Codes{SAMPLEFORMAT_INT, SAMPLEFORMAT_IEEEFP}) {
      CAPTURE(c.items);
      const Form form{.format = format, .bits = 16};
      const auto expected = [&](std::uint32_t x, std::uint32_t y, std::uint16_t s) {
        return c.offset + c.scale * height(x, y, s);
      };
      const GeoTiff found = file.read(form, told(c.items));
      for (std::uint32_t x = 0; x < columns; ++x)
        CHECK(static_cast<double>(found.raster.heights[x]) == support::relative(expected(x, 0, 0), 1e-6));
      CHECK(found.warnings.size() == c.notes);
      const Raster packed = read_geotiff(file.path, {.packed = true}).raster.unpacked();
      CHECK(std::memcmp(packed.heights.data(), found.raster.heights.data(), sizeof(float) * packed.heights.size()) ==
            0);
    }
  const Place centimetres = told(item("scale", "0.01"));
  CHECK(file.read({}, centimetres, height, {.vertical_scale = 2}).raster.heights[0] ==
        120);  // of the numbers as they are
  Place hole = centimetres;
  hole.nodata = "60";  // a number, not a height
  CHECK(std::isnan(file.read({}, hole).raster.heights[0]));
  for (const char* bad : {"0", "one", "1e400"})
    CHECK(contains(file.refusal({}, told(item("scale", bad))), "of heights: expected"));
}

TEST_CASE("pixels outside a mask and of alpha 0 are missing, packed and not") {
  const File file;
  const auto same = [&](const Heights& expected, const GeoTiffSettings& settings = {}) {
    GeoTiffSettings packed = settings;
    packed.packed = true;
    const GeoTiff found = read_geotiff(file.path, settings);
    return found.warnings.empty() && wrong(found.raster, expected) == 0 &&
           wrong(read_geotiff(file.path, packed).raster.unpacked(), expected) == 0;
  };
  const auto hidden = [](std::uint32_t wide) {
    return [wide](std::uint32_t c, std::uint32_t r, std::uint16_t s) { return c < wide ? none : height(c, r, s); };
  };
  const auto alpha = [](std::uint32_t c, std::uint32_t r, std::uint16_t s) {
    return s == 0 ? height(c, r, s) : c < 19 ? 0.0 : 1.0 + c % 100;
  };
  for (const std::uint16_t bits : Codes{8, 16, 32})
    for (const bool tiled : {false, true})
      for (const std::string nodata : {"", "1"}) {
        CAPTURE(bits);
        const Place place{.nodata = nodata};
        const Form form{.format = SAMPLEFORMAT_UINT, .bits = bits, .tiled = tiled};
        for (const std::uint16_t mask_bits : Codes{1, 8})
          for (const bool mask_tiled : {false, true}) {
            Form masked = form;
            masked.masked = 21;
            masked.mask_bits = mask_bits;
            masked.mask_tiled = mask_tiled;
            write(file.path, masked, place);
            CHECK(same(hidden(21)));
          }
        for (const std::uint16_t planes : Codes{PLANARCONFIG_CONTIG, PLANARCONFIG_SEPARATE})
          for (const std::uint16_t kind : Codes{EXTRASAMPLE_ASSOCALPHA, EXTRASAMPLE_UNASSALPHA}) {
            Form two = form;
            two.samples = 2;
            two.planes = planes;
            two.extra = {kind};
            write(file.path, two, place, alpha);
            CHECK(same(hidden(19)));
            two.extra = {EXTRASAMPLE_UNSPECIFIED};
            write(file.path, two, place, alpha);
            CHECK(same(height));
            Place named = told(item("colorinterp", "Alpha", 1));
            named.nodata = nodata;
            write(file.path, two, named, alpha);
            CHECK(same(hidden(19)));
          }
        write(file.path, form, place);
        write(file.path.string() + ".msk", {.format = SAMPLEFORMAT_UINT, .bits = 8, .tiled = !tiled}, place,
              [](std::uint32_t c, std::uint32_t, std::uint16_t) { return c < 5 ? 0.0 : 255.0; });
        CHECK(same(hidden(5)));
        write(file.path, {.format = SAMPLEFORMAT_UINT, .bits = bits, .masked = 9}, place);
        CHECK(same(hidden(9)));  // both
        std::filesystem::remove(file.path.string() + ".msk");
      }
  // rows and columns of a raster that goes the other way are turned with their mask
  const Place turned{.scale = {}, .ties = {}, .matrix = {-2, 0, 0, 1000, 0, 3, 0, 900, 0, 0, 0, 0, 0, 0, 0, 1}};
  const GeoTiff found = file.read({.masked = 4}, turned);
  CHECK(std::isnan(found.raster.heights[columns - 1]));
  CHECK(found.raster.heights[0] == 60 + columns - 1 - (rows - 1));
  CHECK(contains(file.refusal({.masked = columns}), "has no height"));
  CHECK(contains(file.refusal({.masked = 1, .mask_bits = 8, .mask_rows = rows - 1}), "mask of another size"));
  std::ofstream(file.path.string() + ".msk") << "mask";
  CHECK_THROWS_AS((void)file.read(), FileError);
}

TEST_CASE("numbers that may be missing heights are noted, unless a mask hides them") {
  const File file;
  const Form plain{.format = SAMPLEFORMAT_INT, .bits = 16};
  for (const double number : {-9999.0, -32768.0}) {
    const auto holed = [number](std::uint32_t c, std::uint32_t r, std::uint16_t) {
      return c == 3 ? number : height(c, r, 0);
    };
    const GeoTiff found = file.read(plain, {}, holed);
    REQUIRE(found.warnings.size() == 1);
    CHECK(contains(found.warnings[0], "23 heights are a number that often marks missing ones"));
    CHECK(read_geotiff(file.path, {.packed = true}).warnings.size() == 1);
    CHECK(read_geotiff(file.path, {.missing = number}).warnings.empty());
    Form masked = plain;
    masked.masked = 4;
    CHECK(file.read(masked, {}, holed).warnings.empty());
  }
}

TEST_CASE("each rule has a file that is read, noted or refused as it says") {
  const File file;
  const auto tell = [&](const Place& place, const Form& form = {}, const GeoTiffSettings& settings = {}) {
    return file.read(form, place, height, settings).warnings;
  };
  const auto has = [&](const Place& place, const std::function<bool(const GeoTiff&)>& change) {
    const GeoTiff found = file.read({}, place);
    CHECK(change(found));
    return found.warnings;
  };
  const auto first_is = [](double value) {
    return [value](const GeoTiff& f) {
      return static_cast<double>(f.raster.heights[0]) == support::relative(value, 1e-6);
    };
  };
  Place flat = keyed({3072, 0, 1, 25832});
  flat.scale[2] = 10;
  const Form rgb{.format = SAMPLEFORMAT_UINT, .bits = 8, .samples = 3, .photometric = PHOTOMETRIC_RGB};
  const std::vector<test::FormatCase> cases{
      {"item scale", [&] { return has(told(item("scale", "0.5")), first_is(30)); }},
      {"item offset", [&] { return has(told(item("offset", "5")), first_is(65)); }},
      {"item unittype", [&] { return has(told(item("unittype", "cm")), first_is(0.6)); }},
      {"item unittype = other", [&] { return tell(told(item("unittype", "fathom"))); }},
      {"item colorinterp", [&] { return tell(told(item("colorinterp", "Gray"))); }},
      {"item description", [&] { return tell(told(item("description", "heights"))); }},
      {"item scale_factor, add_offset",
       [&] { return tell(told("<Item name=\"scale_factor\" sample=\"0\">0.01</Item>")); }},
      {"item positive = down", [&] { return tell(told("<Item name=\"Band1#positive\">down</Item>")); }},
      {"mask",
       [&] {
         const GeoTiff found = file.read({.masked = 1});
         CHECK(std::isnan(found.raster.heights[0]));
         return found.warnings;
       }},
      {"mask of another size", [&] { return tell({}, {.masked = 1, .mask_rows = 7}); }},
      {"colours", [&] { return tell({}, rgb); }},
      {"colours, another band", [&] { return tell({}, rgb, {.band = 2}); }},
      {"other image", [&] { return tell({}, {.masked = 1, .second_kind = FILETYPE_PAGE}); }},
      {"first image = overview", [&] { return tell({}, {.kind = FILETYPE_REDUCEDIMAGE}); }},
      {"tag 33550 z", [&] { return tell(flat); }},
      {"tag 32997", [&] { return tell({}, {.depth = 2}); }},
      {"tag 274", [&] { return tell({}, {.orientation = ORIENTATION_BOTLEFT}); }}};
  test::check_rules(io::detail::geotiff_rules, cases);
}

TEST_CASE("the place of one band in a vertical system scales and shifts its heights") {
  const File file;
  Place place = keyed({3072, 0, 1, 25832, 4096, 0, 1, 7837});
  const float plain = file.read({}, place).raster.heights[0];
  place.scale[2] = 10;
  place.ties[2] = 3;
  place.ties[5] = 7;
  CHECK(file.read({}, place).raster.heights[0] == doctest::Approx(7 + 10 * (double{plain} - 3)));
  CHECK(file.read({}, place, height, {.vertical_scale = 2}).raster.heights[0] == doctest::Approx(2 * double{plain}));
}

TEST_CASE("keys and roles that no rule names are refused; private keys and other items are not") {
  const File file;
  CHECK(contains(file.refusal({}, keyed({1027, 0, 1, 1})), "which is unknown"));
  CHECK(file.refusal({}, keyed({32768, 0, 1, 1, 65535, 0, 1, 1})).empty());
  CHECK(contains(file.refusal({}, told(item("curvature", "1"))), "'item curvature', which is unknown"));
  CHECK(contains(file.refusal({}, told(item("colorinterp", "Red"))), "has the item 'colours'"));
  CHECK(file.read({}, told("<Item name=\"add_offset\" sample=\"0\">0</Item>")).warnings.empty());
  CHECK(file.read({}, told("<Item name=\"STATISTICS_MEAN\" sample=\"0\">7</Item>")).warnings.empty());
}

TEST_CASE("forty hostile masks, items and keys are refused, or give a sound raster") {
  const File file;
  std::size_t refused = 0;
  const auto try_one = [&](const std::string& bytes) {
    keep(file.path, bytes);
    try {
      read_geotiff(file.path).raster.validate();
    } catch (const FileError& error) {
      CHECK(error.path().starts_with(file.path.string()));
      ++refused;
    }
  };
  write(file.path, {.masked = 6, .mask_tiled = true}, told(item("scale", "2") + item("offset", "1")));
  const std::string whole = support::content(file.path);
  for (std::size_t i = 0; i < 40; ++i) try_one(whole.substr(0, whole.size() - 1 - i * whole.size() / 60));
  support::Generator random(38);
  for (int i = 0; i < 200; ++i) {  // the mask and the tags stand at the end
    std::string bytes = whole;
    for (std::uint64_t n = 1 + random.whole(3); n > 0; --n)
      bytes[bytes.size() - 1 - random.whole(900)] = static_cast<char>(random.whole(256));
    INFO("seed 38, file ", i);
    try_one(bytes);
  }
  CHECK(refused > 60);
  for (const char* text :
       {"<Item ", "<Item name=\"", "<Item role=\"scale\" sample=\"0\"", "<Item role=\"scale\" sample=\"0\">",
        "<Item name=\"a\" sample=\"70000\" role=\"scale\">2</Item>",
        "<Item name=\"a\" sample=\"-1\" role=\"scale\">2</Item>"})
    CHECK(file.read({}, {.metadata = text}).raster.heights[0] == 60);
  Place text = keyed({1026, 34737, 65535, 65535, 3072, 0, 1, 25832});
  text.texts = "ESRI PE String = ";
  CHECK(file.read({}, text).warnings.size() == 1);  // no unit
  text.texts = "ESRI PE String = PROJCS[\"x\",GEOGCS[\"y\",UNIT[\"Degree\",0.017]],UNIT[\"Foot_US\",0.3048006]]|";
  text.keys[15] = 32767;
  const GeoTiff found = file.read({}, text);
  CHECK(found.reference.unit == 0.3048006);
  CHECK(found.reference.wkt.starts_with("PROJCS["));
}

TEST_CASE("a strip with more rows than the raster needs gives the raster's heights") {
  const auto steps = [](std::uint32_t, std::uint32_t r, std::uint16_t) {
    return r < 20 ? 50.0 : 7.0;
  };  // long runs: long matches
  const File file;
  for (const std::uint16_t compression :
       Codes{COMPRESSION_NONE, COMPRESSION_ADOBE_DEFLATE, COMPRESSION_DEFLATE, COMPRESSION_LZW})
    for (const std::uint16_t format : Codes{SAMPLEFORMAT_INT, SAMPLEFORMAT_IEEEFP})
      for (const std::uint32_t padding : {1U, 2U}) {
        CAPTURE(compression);
        const Form form{.format = format, .compression = compression, .padding = padding};
        CHECK(wrong(file.read(form, {}, steps).raster, steps) == 0);
        CHECK(wrong(file.read(form).raster, height) == 0);
      }
}

TEST_CASE("a world file places a raster without tags; pixels that may be in degrees are refused or noted") {
  const File file;
  const auto world = [&](const std::string& text) { std::ofstream(file.folder / "terrain.tfw") << text; };
  world("2\n0\n0\n-3\n1001\n1998.5\n");
  const Place nowhere{.scale = {}, .ties = {}, .keys = {}};
  for (const std::uint16_t kind : Codes{1, 2}) {
    Place place = nowhere;
    place.keys = {1, 1, 0, 1, 1025, 0, 1, kind};
    const GeoTiff found = file.read({}, place);
    CHECK(found.raster.first == Vec2{1001, 1998.5});
    CHECK(found.raster.pixel == Vec2{2, 3});
    CHECK(found.warnings.empty());
  }
  CHECK(wrong(file.read({}, nowhere).raster, height) == 0);
  CHECK(file.read().raster.first == Vec2{1001, 1998.5});  // tags count before the file
  world("2\n0.5\n0\n-3\n1001\n1998.5\n");
  write(file.path, {}, nowhere);
  CHECK_THROWS_AS((void)read_geotiff(file.path), FileError);
  std::filesystem::remove(file.folder / "terrain.tfw");
  Place globe{.scale = {0.000278, 0.000278, 0}, .ties = {0, 0, 0, 8.5, 49.5, 0}, .keys = {}};
  CHECK(contains(file.refusal({}, globe), "is it in degrees?"));
  globe.keys = {1, 1, 0, 1, 1024, 0, 1, 1};  // projected
  const GeoTiff local = file.read({}, globe);
  REQUIRE(local.warnings.size() == 1);
  CHECK(contains(local.warnings[0], "is it in degrees?"));
}

TEST_CASE("what is missing is NaN: by GDAL_NODATA, by the setting, by being none") {
  const File file;
  const auto with = [](double missing) {
    return [missing](std::uint32_t c, std::uint32_t r, std::uint16_t) {
      return (c + r) % 5 == 0 ? missing : height(c, r, 0);
    };
  };
  struct Case {
    double missing;
    std::string nodata;
    Form form{};
    std::optional<double> setting{};
  };
  for (const bool tiled : {false, true})
    for (Case c : std::vector<Case>{
             {-9999, "-9999"},
             {-9999, " -9999.0 "},
             {-9999, "+100", {}, -9999},
             {none, "nan"},
             {none, ""},
             {none, "-9999"},
             {static_cast<double>(-3.4028234663852886e38F), "-3.4028234663852886e+38"},
             {static_cast<double>(-3.4028234663852886e38F), "-3.40282346639e+38"},
             {static_cast<double>(0.1F), "0.1"},
             {-9999, "-9999", {.format = SAMPLEFORMAT_INT, .bits = 16}},
             {-32768, "-32768", {.format = SAMPLEFORMAT_INT, .bits = 32}},
             {255, "255", {.format = SAMPLEFORMAT_UINT, .bits = 8}},
             {-1e300, "-1e300", {.bits = 64}},
             {none, "nan", {.bits = 16}},
         }) {
      CAPTURE(c.nodata);
      c.form.tiled = tiled;
      const GeoTiff found = file.read(c.form, {.nodata = c.nodata}, with(c.missing), {.missing = c.setting});
      CHECK(wrong(found.raster, with(none)) == 0);
      CHECK(found.warnings.empty());
    }
  CHECK(wrong(file.read({}, {.nodata = "-9999"}, with(-9999), {.missing = 1}).raster, with(-9999)) == 0);

  const GeoTiff strange = file.read({}, {}, with(-infinite));
  CHECK(wrong(strange.raster, with(none)) == 0);
  REQUIRE(strange.warnings.size() == 1);
  CHECK(contains(strange.warnings[0], "values beyond 1e15 m, or infinite, count as missing"));
  CHECK(file.read({}, {.nodata = "nothing"}).warnings.size() == 1);

  write(file.path, {}, {.nodata = "1"}, [](std::uint32_t, std::uint32_t, std::uint16_t) { return 1.0; });
  CHECK(contains(file.refusal_of(), "has no height"));
}

TEST_CASE("tiles that are left out are missing") {
  const File file;
  const GeoTiff found = file.read({.tiled = true, .left_out = {1, 3}});
  const auto expected = [](std::uint32_t c, std::uint32_t r, std::uint16_t) {
    const std::uint32_t tile = r / 16 * 3 + c / 16;
    return tile == 1 || tile == 3 ? none : height(c, r, 0);
  };
  CHECK(wrong(found.raster, expected) == 0);
}

TEST_CASE("samples that can be no heights are refused") {
  const File file;
  CHECK(contains(file.refusal({.format = SAMPLEFORMAT_COMPLEXIEEEFP, .bits = 64}), "samples of 64 bits, format 6"));
  // width, height, bits, compression, photometric, offset, samples, rows a strip, bytes
  const auto picture = [&](std::uint32_t bits, std::uint32_t compression, std::uint32_t photometric) {
    keep(file.path, bare({{256, 3, 1, 8},
                          {257, 3, 1, 8},
                          {258, 3, 1, bits},
                          {259, 3, 1, compression},
                          {262, 3, 1, photometric},
                          {273, 4, 1, 8},
                          {277, 3, 1, 1},
                          {278, 3, 1, 8},
                          {279, 4, 1, 64}}));
    return file.refusal_of();
  };
  CHECK(contains(picture(1, 1, 1), "samples of 1 bits"));
  CHECK(contains(picture(12, 1, 1), "samples of 12 bits"));
  CHECK(contains(picture(16, 1, PHOTOMETRIC_LOGL), "not a picture"));
  CHECK(contains(picture(8, 12345, 1), "is compressed by scheme 12345"));
  CHECK(contains(picture(8, 1, 1), "has no georeference"));
}

TEST_CASE("a header that claims more than the file can hold is refused, and nothing is made of it") {
  struct Claim {
    std::uint32_t wide, high, tile, strip_rows;
  };
  const File file;
  for (const Claim& claim : std::vector<Claim>{{1000000, 1000000, 0, 1},
                                               {1000000, 1000000, 0, 1000000},
                                               {1000000, 1000000, 256, 0},
                                               {1000000, 1000000, 1 << 20, 0},
                                               {4294967295, 4294967295, 0, 4294967295},
                                               {4294967295, 4294967295, 4294967280, 0},
                                               {2, 4294967295, 0, 1},
                                               {4294967295, 2, 0, 1},
                                               {100, 100, 4294967280, 0}}) {
    CAPTURE(claim.wide);
    CAPTURE(claim.tile);
    CAPTURE(claim.strip_rows);
    std::vector<std::array<std::uint32_t, 4>> entries{{256, 4, 1, claim.wide}, {257, 4, 1, claim.high}, {258, 3, 1, 32},
                                                      {259, 3, 1, 1},          {262, 3, 1, 1},          {277, 3, 1, 1}};
    if (claim.tile != 0)
      entries.insert(entries.end(),
                     {{322, 4, 1, claim.tile}, {323, 4, 1, claim.tile}, {324, 4, 1, 8}, {325, 4, 1, 64}});
    else
      entries.insert(entries.end(), {{273, 4, 1, 8}, {278, 4, 1, claim.strip_rows}, {279, 4, 1, 64}});
    std::sort(entries.begin(), entries.end());
    keep(file.path, bare(entries, std::string(200, 'x')));
    CHECK_FALSE(file.refusal_of().empty());
  }
}

TEST_CASE("a file that is cut anywhere is refused, and libtiff prints nothing") {
  static int printed = 0;
  const auto count = [](const char*, const char*, std::va_list) { ++printed; };
  const TIFFErrorHandler errors = TIFFSetErrorHandler(count), warnings = TIFFSetWarningHandler(count);
  const File file;
  for (const Form& form : {Form{}, Form{.compression = COMPRESSION_LZW, .tiled = true}, Form{.mode = "w8b"}}) {
    write(file.path, form);
    const std::string whole = support::content(file.path);
    std::size_t refused = 0;
    printed = 0;
    for (std::size_t size = 0; size < whole.size(); size += 1 + size / 50) {
      keep(file.path, whole.substr(0, size));
      const std::string problem = file.refusal_of();
      refused += problem.empty() ? 0 : 1;
      if (problem.empty()) CHECK(size + 64 > whole.size());  // some of the last bytes may not count
    }
    CHECK(refused > 100);
    CHECK(printed == 0);
  }
  TIFFSetErrorHandler(errors);
  TIFFSetWarningHandler(warnings);
  keep(file.path, "");
  CHECK(contains(file.refusal_of(), "is empty"));
  keep(file.path, "x y z\n1 2 3\n");
  CHECK(contains(file.refusal_of(), "is not a TIFF file"));
  std::filesystem::remove(file.path);
  CHECK(contains(file.refusal_of(), "does not exist"));
  std::filesystem::create_directory(file.path);
  CHECK(contains(file.refusal_of(), "is a directory"));
}

TEST_CASE("where a strip is not whole, the error says so, and where it begins") {
  const File file;
  write(file.path, {.compression = COMPRESSION_ADOBE_DEFLATE});
  TIFF* tiff = TIFFOpen(file.path.c_str(), "r");
  const std::uint64_t begin = TIFFGetStrileOffset(tiff, 2);
  TIFFClose(tiff);
  std::string bytes = support::content(file.path);
  for (std::size_t i = 0; i < 8; ++i) bytes[begin + i] = '\xFF';
  keep(file.path, bytes);
  try {
    (void)read_geotiff(file.path);
    FAIL("was read");
  } catch (const FileError& error) {
    CHECK(error.place() == "byte " + std::to_string(begin));
    CHECK(contains(error.problem(), "strip 2 cannot be read"));
  }
}

TEST_CASE("settings that cannot be are refused") {
  const File file;
  write(file.path);
  CHECK_THROWS_AS((void)read_geotiff(file.path, {.band = 0}), SettingError);
  for (const double scale : {0.0, -1.0, none, infinite})
    CHECK_THROWS_AS((void)read_geotiff(file.path, {.vertical_scale = scale}), SettingError);
}
