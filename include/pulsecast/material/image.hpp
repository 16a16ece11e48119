// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_MATERIAL_IMAGE_HPP
#define PULSECAST_MATERIAL_IMAGE_HPP

#include <pulsecast/base/require.hpp>
#include <pulsecast/base/shared_array.hpp>
#include <pulsecast/base/vector.hpp>

namespace PULSECAST_NAMESPACE {

namespace detail {

/// Linear share of light for a sample of a display, both from 0 to 1. Source: IEC 61966-2-1 (sRGB).
[[nodiscard]] inline double srgb_decoded(double sample) noexcept {
  return sample <= 0.04045 ? sample / 12.92 : std::pow((sample + 0.055) / 1.055, 2.4);
}
/// Sample of a display for a linear share of light, both from 0 to 1. Source: IEC 61966-2-1 (sRGB).
[[nodiscard]] inline double srgb_encoded(double share) noexcept {
  return share <= 0.0031308 ? 12.92 * share : 1.055 * std::pow(share, 1 / 2.4) - 0.055;
}
/// Linear share of light, from 0 to 1, for a sample of a picture.
[[nodiscard]] inline double linear_share(std::uint8_t sample) noexcept {
  static const auto table = [] {
    std::array<double, 256> shares{};
    for (std::size_t i = 0; i < 256; ++i) shares[i] = srgb_decoded(static_cast<double>(i) / 255);
    return shares;
  }();
  return table[sample];
}

}  // namespace detail

/// Number of the pixel, row by row from the top left, at texture coordinates: (0, 0) is the lower
/// left corner, (1, 1) the upper right; beyond, the picture repeats. Source: Wavefront OBJ, `vt`.
[[nodiscard]] inline std::size_t texel_at(std::uint32_t width, std::uint32_t height, const Vec2& at) noexcept {
  const auto place = [](double coordinate, std::uint32_t count) noexcept {
    const double turn = coordinate - std::floor(coordinate);  // perhaps 1 below a whole number
    return std::min(static_cast<std::size_t>(turn * count), std::size_t{count} - 1);
  };
  return (std::size_t{height} - 1 - place(at.y, height)) * width + place(at.x, width);
}

/// Picture of a surface, eight bits a channel.
struct Image {
  std::uint32_t width = 0, height = 0;     ///< size [pixel]
  std::uint32_t channels = 0;              ///< 1: grey; 3: red, green, blue; 2 and 4: with opacity
  SharedArray<std::uint8_t> samples = {};  ///< by pixel, row by row from the top left; shared

  void validate() const {
    require_within("Image::width", width, 1, 65536, "pixel");
    require_within("Image::height", height, 1, 65536, "pixel");
    require_within("Image::channels", channels, 1, 4, "");
    const double count = static_cast<double>(width) * height * channels;
    require_within("Image::samples (number)", samples.size(), count, count, "");
  }

  /// True if pixels have an opacity, as their last channel.
  [[nodiscard]] bool has_opacity() const noexcept { return channels == 2 || channels == 4; }

  /// Channels of the pixel at texture coordinates, see `texel_at`.
  [[nodiscard]] std::span<const std::uint8_t> at(const Vec2& texture) const noexcept {
    return {samples.data() + texel_at(width, height, texture) * channels, channels};
  }
  /// Red, green and blue at texture coordinates, from 0 to 1, as displays take them (sRGB).
  [[nodiscard]] Vec3 colour(const Vec2& texture) const noexcept {
    const auto pixel = at(texture);
    const auto share = [&](std::size_t k) noexcept { return pixel[channels < 3 ? 0 : k] / 255.0; };
    return {share(0), share(1), share(2)};
  }
};

}  // namespace PULSECAST_NAMESPACE

#endif
