// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SCENE_REFLECTANCE_MAP_HPP
#define PULSECAST_SCENE_REFLECTANCE_MAP_HPP

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <pulsecast/base/require.hpp>
#include <pulsecast/base/vector.hpp>
#include <pulsecast/scene/image.hpp>

namespace PULSECAST_NAMESPACE {

/// Linear share of light of a sample of a picture, both from 0 to 1. Source: IEC 61966-2-1 (sRGB).
[[nodiscard]] inline double linear_share(double sample) noexcept {
  return sample <= 0.04045 ? sample / 12.92 : std::pow((sample + 0.055) / 1.055, 2.4);
}

/// Reflectance of a surface by its picture. Channels are taken as linear shares of light (sRGB) at wavelengths of their own; between these
/// the reflectance is linear, beyond them constant. A grey picture is the same at all wavelengths.
struct ReflectanceMap {
  Image image{};                                              ///< picture
  std::array<double, 3> wavelengths{612e-9, 549e-9, 465e-9};  ///< of red, green and blue, descending [m]. Source: CIE 015:2018 (primaries)
  /// True if the picture tells the pattern alone: the reflectance of the material at the wavelength is multiplied by the ratio of a pixel
  /// to the mean of all pixels, and at most 1. For light that the picture does not show, as of 1064 nm.
  bool relative = false;

  /// @throws SettingError for values out of range
  void validate() const {
    image.validate();
    for (const double wavelength : wavelengths) require_within("ReflectanceMap::wavelengths", wavelength, 1e-8, 1e-3, "m");
    require_positive("ReflectanceMap::wavelengths (from green to red)", wavelengths[0] - wavelengths[1], "m");
    require_positive("ReflectanceMap::wavelengths (from blue to green)", wavelengths[1] - wavelengths[2], "m");
  }
};

}  // namespace PULSECAST_NAMESPACE

#endif
