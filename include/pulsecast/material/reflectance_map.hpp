// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_MATERIAL_REFLECTANCE_MAP_HPP
#define PULSECAST_MATERIAL_REFLECTANCE_MAP_HPP

#include <pulsecast/material/material.hpp>

namespace PULSECAST_NAMESPACE {

/// Reflectance of a surface by its picture. Red, green and blue are linear shares of light (sRGB)
/// at wavelengths of their own; in between it is linear, beyond them constant.
struct ReflectanceMap final : ReflectanceByTexture {
  Image image{};  ///< picture
  /// Wavelengths of red, green and blue, descending [m]. Source: IEC 61966-2-1 primaries.
  std::array<double, 3> wavelengths{612e-9, 549e-9, 465e-9};
  /// If not zero, the mean of red, green and blue: the picture is a pattern, and the reflectance is
  /// the material's times a pixel by the mean, at most 1. For other wavelengths, such as 1064 nm.
  Vec3 mean{};

  ReflectanceMap() = default;
  /// Map of an image with linear shares of light.
  explicit ReflectanceMap(Image of) noexcept : image(std::move(of)) {}

  /// Map of a pattern: the mean is that of all pixels, and 1 for a channel that is black.
  [[nodiscard]] static ReflectanceMap pattern(Image image) {
    image.validate();
    ReflectanceMap map(std::move(image));
    const std::size_t pixels = std::size_t{map.image.width} * map.image.height;
    for (std::size_t k = 0; k < 3; ++k) {
      double sum = 0;
      for (std::size_t i = 0; i < pixels; ++i)
        sum += detail::linear_share(map.image.samples[i * map.image.channels + map.channel(k)]);
      map.mean[static_cast<int>(k)] = sum > 0 ? sum / static_cast<double>(pixels) : 1;
    }
    return map;
  }

  void validate() const override {
    image.validate();
    for (const double wavelength : wavelengths)
      require_within("ReflectanceMap::wavelengths", wavelength, 1e-8, 1e-3, "m");
    const auto& [red, green, blue] = wavelengths;
    require_positive("ReflectanceMap::wavelengths (from green to red)", red - green, "m");
    require_positive("ReflectanceMap::wavelengths (from blue to green)", green - blue, "m");
    for (int k = 0; k < 3; ++k) require_within("ReflectanceMap::mean", mean[k], 0, 1, "");
    const double least = std::min({mean.x, mean.y, mean.z});
    if (mean != Vec3{}) require_positive("ReflectanceMap::mean (least)", least, "");
  }

  [[nodiscard]] const Image* picture() const noexcept override { return &image; }
  /// Reflectance at a wavelength [m] and texture coordinates, where that of the material is `even`.
  [[nodiscard]] double reflectance(double wavelength, Vec2 texture, double even) const noexcept override {
    const auto pixel = image.at(texture);
    const auto at = [&](std::size_t k) noexcept {
      const double share = detail::linear_share(pixel[channel(k)]);
      return mean == Vec3{} ? share : share / mean[static_cast<int>(k)];
    };
    const auto& w = wavelengths;
    double value = at(0);
    if (wavelength <= w[2])
      value = at(2);
    else if (wavelength < w[0]) {
      const std::size_t k = wavelength < w[1] ? 1 : 0;  // between channels k and k + 1
      const double towards_shorter = (w[k] - wavelength) / (w[k] - w[k + 1]);
      value = at(k) + towards_shorter * (at(k + 1) - at(k));
    }
    return std::min(mean == Vec3{} ? value : value * even, 1.0);
  }

 private:
  [[nodiscard]] std::size_t channel(std::size_t k) const noexcept { return image.channels < 3 ? 0 : k; }
};

}  // namespace PULSECAST_NAMESPACE

#endif
