// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_COLOUR_HPP
#define PULSECAST_IO_COLOUR_HPP

#include <pulsecast/echo.hpp>
#include <pulsecast/material/image.hpp>

namespace PULSECAST_NAMESPACE::io {

/// Linear red, green and blue, 1 for the maximum of a screen; sums and multiples are meaningful.
using Colour = Vec3;

/// Red, green and blue as in files and screens, gamma-encoded.
using Srgb = std::array<std::uint8_t, 3>;

/// Decodes sRGB to linear light, as `srgb_decoded`.
[[nodiscard]] inline Colour from_srgb(const Srgb& bytes) noexcept {
  using pulsecast::detail::linear_share;
  return {linear_share(bytes[0]), linear_share(bytes[1]), linear_share(bytes[2])};
}

/// Nearest colour of a screen. Source: IEC 61966-2-1, sRGB.
[[nodiscard]] inline Srgb to_srgb(const Colour& c) noexcept {
  Srgb bytes{};
  for (int k = 0; k < 3; ++k) {
    const double coded = pulsecast::detail::srgb_encoded(std::clamp(c[k], 0.0, 1.0));
    bytes[static_cast<std::size_t>(k)] = static_cast<std::uint8_t>(std::lround(255 * coded));
  }
  return bytes;
}

/// Linear interpolation in a colour scale from 0 (first) to 1 (last), clamped; NaN counts as 0.
[[nodiscard]] inline Colour along(std::span<const Srgb> scale, double t) noexcept {
  const double place = (t > 0 ? std::min(t, 1.0) : 0.0) * static_cast<double>(scale.size() - 1);
  const std::size_t i = std::min(static_cast<std::size_t>(place), scale.size() - 2);
  const double part = place - static_cast<double>(i);
  return from_srgb(scale[i]) * (1 - part) + from_srgb(scale[i + 1]) * part;
}

/// Scale from violet to yellow. Source: viridis, Smith & van der Walt 2015 (CC0), every 32nd entry.
inline constexpr std::array<Srgb, 9> viridis{{{68, 1, 84},
                                              {71, 44, 122},
                                              {59, 81, 139},
                                              {44, 113, 142},
                                              {33, 144, 141},
                                              {39, 173, 129},
                                              {92, 200, 99},
                                              {170, 220, 50},
                                              {253, 231, 37}}};

/// Scale from black to white, without the extremes.
inline constexpr std::array<Srgb, 2> greys{{{24, 24, 24}, {250, 250, 250}}};

/// Colours distinct for every colour vision. Source: Okabe & Ito 2008.
inline constexpr std::array<Srgb, 7> okabe_ito{
    {{0, 114, 178}, {230, 159, 0}, {0, 158, 115}, {213, 94, 0}, {86, 180, 233}, {204, 121, 167}, {240, 228, 66}}};

/// Colour of a hue in [0, 1), at constant lightness and chroma. Source: Ottosson 2020, Oklab.
[[nodiscard]] inline Colour of_hue(double hue) noexcept {
  constexpr double lightness = 0.72, chroma = 0.13;
  const double a = chroma * std::cos(2 * pi * hue), b = chroma * std::sin(2 * pi * hue);
  const double l = std::pow(lightness + 0.3963377774 * a + 0.2158037573 * b, 3);
  const double m = std::pow(lightness - 0.1055613458 * a - 0.0638541728 * b, 3);
  const double s = std::pow(lightness - 0.0894841775 * a - 1.2914855480 * b, 3);
  return {4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
          -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
          -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s};
}

/// Colour of a point class, about as on maps. Source: ASPRS LAS 1.4 R15, table 17; own from 64 on.
[[nodiscard]] inline Srgb of_class(std::uint16_t classification) noexcept {
  constexpr Srgb other{176, 176, 176}, ground{158, 124, 88}, low{160, 196, 72}, medium{104, 168, 62}, high{58, 136, 66};
  constexpr Srgb building{226, 104, 56}, water{64, 132, 196}, road{120, 124, 132};
  constexpr std::array standard{other,    other, ground, low,   medium, high,  // vegetation
                                building, other, other,  water, other,  road};
  constexpr std::array<Srgb, 6> own{
      {{158, 108, 72}, {216, 196, 156}, {204, 121, 167}, {86, 180, 233}, {230, 159, 0}, {0, 158, 115}}};
  if (classification >= 64) return own[(classification - 64u) % own.size()];
  return classification < standard.size() ? standard[classification] : other;
}

/// Colours by `ReflectionKind`, distinct for every colour vision. Source: Okabe & Ito 2008.
inline constexpr std::array<Srgb, reflection_kind_count> kind_colours{
    {{184, 184, 184}, {86, 180, 233}, {0, 114, 178}, {213, 94, 0}, {204, 121, 167}, {240, 228, 66}}};

}  // namespace PULSECAST_NAMESPACE::io

#endif
