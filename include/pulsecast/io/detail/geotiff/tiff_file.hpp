// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_GEOTIFF_TIFF_FILE_HPP
#define PULSECAST_IO_DETAIL_GEOTIFF_TIFF_FILE_HPP

#include <cstdarg>
#include <cstdio>
#include <memory>

#include <tiffio.h>

#include <pulsecast/base/vector.hpp>
#include <pulsecast/io/detail/geotiff/rules.hpp>

namespace PULSECAST_NAMESPACE::io::detail {

/// Image of a TIFF file, the first by default, opened by libtiff, with the file's errors and warnings.
class TiffFile : public InputFile {
 public:
  explicit TiffFile(const std::filesystem::path& path, std::uint16_t image = 0)
      : InputFile(path, "a GeoTIFF"), tiff_(open(image)) {}
  TiffFile(const TiffFile&) = delete;
  TiffFile& operator=(const TiffFile&) = delete;

  [[nodiscard]] TIFF* handle() const noexcept { return tiff_.get(); }

  /// Number of the image that is the mask of the first; 0 if there is none.
  [[nodiscard]] std::uint16_t mask() const noexcept { return mask_; }

  /// Keeps to the rule for an item. True if it is to be read. @throws FileError by the rule
  bool keep(std::string_view name) { return keep_rule(geotiff_rules, path(), "item", name, warnings_); }

  void warn(const auto&... oddity) { warnings_.push_back(warning(path(), 0, oddity...)); }
  [[nodiscard]] std::vector<std::string>& warnings() noexcept { return warnings_; }
  [[nodiscard]] std::vector<std::string> take_warnings() noexcept { return std::exchange(warnings_, {}); }

  /// Error of libtiff, to end a sentence.
  [[nodiscard]] std::string complaint() const {
    return complaint_[0] == '\0' ? "" : std::string(" (libtiff: ") + complaint_.data() + ')';
  }

  /// Upper limit of the decoded size of a strip or tile: deflate reaches 1,032 to 1, others more; a
  /// tile of 256 by 256 that is left out or uniform is 16,384 times its entry in the lists.
  [[nodiscard]] std::uint64_t max_bytes() const noexcept { return (std::uint64_t{1} << 26) + 4096 * size(); }

  template <class Number>
  [[nodiscard]] Number tag(ttag_t number, Number otherwise) const {
    Number value{};
    return TIFFGetFieldDefaulted(tiff_.get(), number, &value) == 1 ? value : otherwise;
  }

  /// Values of an array tag; empty if missing or of another type. libtiff defines these tags as it
  /// reads them; their counts may have another form if GDAL or libgeotiff defined them.
  template <class Number>
  [[nodiscard]] std::span<const Number> tags(ttag_t number) const {
    constexpr TIFFDataType type = std::is_same_v<Number, double> ? TIFF_DOUBLE
                                  : std::is_same_v<Number, char> ? TIFF_ASCII
                                                                 : TIFF_SHORT;
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

 private:
  using Handle = std::unique_ptr<TIFF, void (*)(TIFF*)>;

  /// Keeps the first error; warnings concern irrelevant tags. Nothing is printed.
  static int keep_error(TIFF*, void* self, const char*, const char* format, std::va_list arguments) noexcept {
    auto& complaint = static_cast<TiffFile*>(self)->complaint_;
    if (complaint[0] == '\0') (std::vsnprintf)(complaint.data(), complaint.size(), format, arguments);
    return 1;
  }
  static int drop_warning(TIFF*, void*, const char*, const char*, std::va_list) noexcept { return 1; }

  [[nodiscard]] Handle open(std::uint16_t image) {
    const std::shared_ptr<TIFFOpenOptions> options(TIFFOpenOptionsAlloc(), TIFFOpenOptionsFree);
    if (!options) throw std::bad_alloc();
    TIFFOpenOptionsSetErrorHandlerExtR(options.get(), keep_error, this);
    TIFFOpenOptionsSetWarningHandlerExtR(options.get(), drop_warning, this);
    TIFFOpenOptionsSetMaxSingleMemAlloc(options.get(), static_cast<tmsize_t>(max_bytes()));
    // not mapped, as the file may be truncated
    Handle tiff(TIFFOpenExt(path().c_str(), "rm", options.get()), TIFFClose);
    if (!tiff) fail("is not a TIFF file that can be read", complaint(), ": expected a GeoTIFF");
    if (image == 0) look_at_images(*tiff);
    if (TIFFSetDirectory(tiff.get(), image) != 1) fail("cannot be read again", complaint());
    // of a strip or tile with more than it needs, libdeflate leaves the end unread; zlib reads all
    std::uint16_t scheme = COMPRESSION_NONE;
    TIFFGetFieldDefaulted(tiff.get(), TIFFTAG_COMPRESSION, &scheme);
    if (scheme == COMPRESSION_ADOBE_DEFLATE || scheme == COMPRESSION_DEFLATE)
      TIFFSetField(tiff.get(), TIFFTAG_DEFLATE_SUBCODEC, DEFLATE_SUBCODEC_ZLIB);
    return tiff;
  }

  /// Looks at the kinds of all images. An error of the others is none of the first. Source: TIFF 6.0, NewSubfileType.
  void look_at_images(TIFF& tiff) {
    constexpr std::uint16_t most = 64;
    bool is_other = false;
    for (std::uint16_t i = 0; i < most && (i == 0 || (TIFFLastDirectory(&tiff) == 0 && TIFFReadDirectory(&tiff) == 1));
         ++i) {
      std::uint32_t kind = 0;
      TIFFGetFieldDefaulted(&tiff, TIFFTAG_SUBFILETYPE, &kind);
      const bool is_mask = (kind & FILETYPE_MASK) != 0, is_overview = (kind & FILETYPE_REDUCEDIMAGE) != 0;
      if (i == 0 && (is_mask || is_overview)) keep("first image = overview");
      if (is_mask && !is_overview && mask_ == 0) mask_ = i;
      is_other = is_other || (i > 0 && !is_mask && !is_overview);
    }
    complaint_ = {};
    if (is_other) keep("other image");
  }

  std::array<char, 256> complaint_{};  ///< first error of libtiff
  std::uint16_t mask_ = 0;             ///< number of an image
  std::vector<std::string> warnings_;
  Handle tiff_;
};

/// Colours of a palette picture by the value of a pixel, channels from 0 to 1; empty for other
/// pictures. Values are of 16 bits; of 8 if none is above 255, as some programs write them. Source:
/// TIFF 6.0, section 5, `ColorMap`; for 8 bits, libtiff, tif_getimage.c, `checkcmap`.
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
