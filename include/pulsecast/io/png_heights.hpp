// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_PNG_HEIGHTS_HPP
#define PULSECAST_IO_PNG_HEIGHTS_HPP

#include <filesystem>

#include <pulsecast/base/compiled.hpp>
#include <pulsecast/base/text.hpp>
#include <pulsecast/shape/raster.hpp>

namespace PULSECAST_NAMESPACE::io {

/// Settings for heights in PNG files.
struct PngHeightSettings {
  double vertical_scale = 1;                      ///< metres per unit of grey [m]
  double vertical_offset = 0;                     ///< height of grey 0, black [m]
  std::optional<std::uint16_t> missing{};         ///< grey of missing heights
  std::optional<Vec2> pixel{};                    ///< size; default: by the world file [m]
  std::optional<Vec2> first{};                    ///< centre of the north-west one; default: as `pixel`, or 0 [m]
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

/// Reads a raster of packed heights from a PNG file of grey, 8 or 16 bits, north up, in metres. The
/// place of pixels is that of the settings, or of a world file (`world_file_of`), in metres or the units
/// of a `.prj` beside it. Checksums are not compared. @throws SettingError @throws FileError for a file that is
/// damaged, coloured, transparent, of fewer bits, too large, without a place, or without a height
[[nodiscard]] Raster read_png_heights(const std::filesystem::path& path, const PngHeightSettings& settings = {});

/// True for the extension `.png`, in any case.
[[nodiscard]] inline bool is_png(const std::filesystem::path& path) {
  return text::is_same_word(path.extension().string(), ".png");
}

}  // namespace PULSECAST_NAMESPACE::io

#if PULSECAST_DEFINES(IO_PNG_HEIGHTS)
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include <stb/stb_image.h>

#include <pulsecast/io/detail/side_files.hpp>
#include <pulsecast/io/world_file.hpp>

namespace PULSECAST_NAMESPACE::io {

namespace detail {

class PngHeightReader {
 public:
  PngHeightReader(const std::filesystem::path& path, const PngHeightSettings& settings)
      : settings_(validated(settings)), path_(path), file_(path) {}

  [[nodiscard]] Raster read() && {
    read_size();
    raster_.packed.scale = settings_.vertical_scale;
    raster_.packed.offset = settings_.vertical_offset;
    raster_.packed.missing = settings_.missing;
    const bool is_northward = place();
    bits_ == 16 ? take(stbi_load_16_from_memory) : take(stbi_load_from_memory);
    auto& numbers = raster_.packed.numbers;
    const auto row = [&](std::uint32_t r) {
      return numbers.begin() + static_cast<std::ptrdiff_t>(std::size_t{r} * raster_.columns);
    };
    for (std::uint32_t r = 0; is_northward && r < raster_.rows / 2; ++r)
      std::swap_ranges(row(r), row(r + 1), row(raster_.rows - 1 - r));
    if (std::ranges::all_of(numbers, [&](std::uint16_t n) { return settings_.missing == n; }))
      fail("has no height: expected at least one pixel of another grey than that of missing heights");
    try {
      raster_.validate();
    } catch (const SettingError& error) {
      fail(error.what());
    }
    return std::move(raster_);
  }

 private:
  [[noreturn]] void fail(const auto&... problem) const { detail::fail(path_, problem...); }
  [[noreturn]] void fail_to_read() const {
    fail("cannot be read (stb_image: ", stbi_failure_reason(), "): expected a PNG file of heights");
  }

  [[nodiscard]] const stbi_uc* data() const noexcept { return reinterpret_cast<const stbi_uc*>(file_.bytes().data()); }
  [[nodiscard]] int size() const noexcept { return static_cast<int>(file_.bytes().size()); }

  /// Checks size and kind of pixels. Source: PNG, second edition (ISO/IEC 15948), 5.2, 11.2.2.
  void read_size() {
    constexpr std::array<stbi_uc, 8> signature{0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
    constexpr std::size_t depth = 24, colour = 25;  // bytes of the header
    const std::size_t bytes = file_.bytes().size();
    if (bytes > 0x7FFFFFFF) fail("has more than 2^31 bytes: expected fewer");
    if (bytes <= colour || !std::equal(signature.begin(), signature.end(), data()))
      fail("is no PNG file: expected one of heights");
    keep_chunks();
    if (stbi_info_from_memory(data(), size(), &width_, &height_, &channels_) == 0) fail_to_read();
    bits_ = data()[depth];
    if (data()[colour] != 0 || channels_ != 1 || (bits_ != 8 && bits_ != 16))
      fail("has ", channels_, " channels of ", bits_, " bits, colour type ", data()[colour],
           ": expected grey of 8 or 16 bits, without transparency");
    const std::string pixels = text::message(width_, " x ", height_, " pixels");
    if (width_ < 2 || height_ < 2) fail("is of ", pixels, ": expected 2 x 2 or more");
    const double count = static_cast<double>(width_) * height_;
    if (count > static_cast<double>(settings_.max_pixels))
      fail("is of ", pixels, ": expected at most ", settings_.max_pixels, " in all");
    constexpr double deflate = 1032;  // largest ratio; source: zlib, "Maximum Compression Factor"
    if (count * bits_ / 8 > deflate * static_cast<double>(bytes))
      fail("claims ", pixels, ", more than its ", bytes, " bytes can hold");
    raster_.columns = static_cast<std::uint32_t>(width_);
    raster_.rows = static_cast<std::uint32_t>(height_);
  }

  /// Keeps to the rules of the chunks before the pixels. Source: PNG, second edition, 5.3.
  void keep_chunks() {
    const std::string_view all = file_.text();
    for (std::size_t at = 8; at + 8 <= all.size() && all.substr(at + 4, 4) != "IDAT";) {
      std::size_t length = 0;
      for (const char byte : all.substr(at, 4)) length = length << 8 | static_cast<unsigned char>(byte);
      if (rule_of(png_rules, all.substr(at + 4, 4)))
        keep_rule(png_rules, path_, "chunk", all.substr(at + 4, 4), warnings_);
      at += 12 + length;
    }
  }

  /// Sets the place of the pixels; true if the rows of the file go north.
  [[nodiscard]] bool place() {
    raster_.pixel = settings_.pixel.value_or(Vec2{1, 1});
    raster_.first = settings_.first.value_or(Vec2{});
    const bool is_scaled = settings_.vertical_scale != 1;
    const SpatialReference beside_it =
        read_side_files(path_, warnings_, is_scaled ? HeightUnit::by_setting : HeightUnit::metre, !settings_.pixel);
    if (!warnings_.empty() && beside_it.unit == 1)
      fail("is beside a file that is not clear: ", warnings_.front(), "; expected the size of pixels as a setting");
    if (!is_scaled) raster_.packed.scale = beside_it.vertical_unit;
    if (settings_.pixel) return false;
    const std::filesystem::path beside = world_file_of(path_);
    if (beside.empty())
      fail("has no place: expected a world file beside it, as in ",
           std::filesystem::path(path_).replace_extension(".pgw").string(), ", or the size of pixels as a setting");
    const WorldFile world = read_world_file(beside);
    const bool is_northward = world.step.y > 0;
    raster_.pixel = beside_it.unit * Vec2(world.step.x, std::fabs(world.step.y));
    const double south = is_northward ? (raster_.rows - 1) * world.step.y : 0;
    if (!settings_.first) raster_.first = beside_it.unit * (world.first + Vec2(0, south));
    const std::string question = degrees_question(raster_);
    if (!question.empty() && beside_it.wkt.empty())
      fail("by its world file ", question, ", or the size of pixels as a setting");
    return is_northward;
  }

  /// Takes the numbers that a function of stb_image loads.
  void take(const auto& load) {
    auto* const pixels = load(data(), size(), &width_, &height_, &channels_, 1);
    const std::unique_ptr<void, void (*)(void*)> owner(pixels, stbi_image_free);
    if (!pixels) fail_to_read();
    raster_.packed.numbers.assign(pixels, pixels + raster_.pixels());
  }

  PngHeightSettings settings_;
  std::filesystem::path path_;
  MappedFile file_;
  std::vector<std::string> warnings_;
  int width_ = 0, height_ = 0, channels_ = 0, bits_ = 0;
  Raster raster_;
};

}  // namespace detail

PULSECAST_INLINE Raster read_png_heights(const std::filesystem::path& path, const PngHeightSettings& settings) {
  return reading(path, [&] { return detail::PngHeightReader(path, settings).read(); });
}

}  // namespace PULSECAST_NAMESPACE::io

#endif

#endif
