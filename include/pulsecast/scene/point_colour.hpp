// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SCENE_POINT_COLOUR_HPP
#define PULSECAST_SCENE_POINT_COLOUR_HPP

#include <pulsecast/material/material.hpp>
#include <pulsecast/scene/surface_query.hpp>

namespace PULSECAST_NAMESPACE {

/// Colour of a point, as a camera beside the scanner would see it: 0 is black, 65535 the brightest.
struct PointColour {
  std::uint16_t red = 0, green = 0, blue = 0;  ///< as displays take them (sRGB)
  std::uint16_t near_infrared = 0;             ///< reflectance in the near infrared, linear

  friend bool operator==(const PointColour&, const PointColour&) = default;
};

/// Colour of an echo of a batch: what a sink asks for the colour of a point. Empty if unknown.
using PointColours = std::function<std::optional<PointColour>(const EchoBatch&, const Shot&, const Echo&)>;

/// Wavelength of the near infrared in `PointColour`, as of band 8 of Sentinel-2 [m].
inline constexpr double near_infrared_wavelength = 842e-9;

/// Colour of a surface: that of its material, times its picture.
[[nodiscard]] inline PointColour colour_of(const SurfaceInteraction& surface) noexcept {
  const Material& material = *surface.material;
  const bool textured = material.picture && surface.texture;
  const Vec3 colour = material.colour * (textured ? material.picture->colour(*surface.texture) : Vec3(1));
  const auto sixteen_bits = [](double share) noexcept {
    return static_cast<std::uint16_t>(std::lround(65535 * std::clamp(share, 0.0, 1.0)));
  };
  return {sixteen_bits(colour.x), sixteen_bits(colour.y), sixteen_bits(colour.z),
          sixteen_bits(material.reflectance_at(near_infrared_wavelength))};
}

/// Colours of the surfaces of a world, which must outlive them, by one more ray per echo as in
/// `surfaces_of`. @throws SettingError
template <SceneQueries World>
[[nodiscard]] PointColours colours_of(const World& world, double tolerance = 0.2) {
  return [of = surfaces_of(world, tolerance)](const EchoBatch& batch, const Shot& shot, const Echo& echo) {
    const std::optional<SurfaceInteraction> surface = of(batch, shot, echo);
    return surface ? std::optional(colour_of(*surface)) : std::nullopt;
  };
}

}  // namespace PULSECAST_NAMESPACE

#endif
