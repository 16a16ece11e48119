// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_MATERIAL_LAMBERT_HPP
#define PULSECAST_MATERIAL_LAMBERT_HPP

#include <algorithm>

#include <pulsecast/base/vector.hpp>
#include <pulsecast/material/scattering_law.hpp>

namespace PULSECAST_NAMESPACE {

/// Lambert's law: backscatter is the reflectance times the cosine of incidence. Source: Lambert 1760.
struct Lambert {
  double backscatter(double cosine, const SurfaceLight& light) const noexcept { return light.reflectance * cosine; }
  double scattered_share(double, const SurfaceLight& light) const noexcept { return std::min(light.reflectance, 1.0); }
  double scattered(const Vec3&, const Vec3& out, const Vec3& normal, const SurfaceLight& light) const noexcept {
    return scattered_share(1, light) * dot(out, normal);
  }
};

/// Backscatter equal to the reflectance at any incidence. Light into other directions is that of Lambert's law.
struct DirectionIndependent {
  double backscatter(double, const SurfaceLight& light) const noexcept { return light.reflectance; }
  double scattered_share(double cosine, const SurfaceLight& light) const noexcept {
    return Lambert{}.scattered_share(cosine, light);
  }
  double scattered(const Vec3& in, const Vec3& out, const Vec3& normal, const SurfaceLight& light) const noexcept {
    return Lambert{}.scattered(in, out, normal, light);
  }
};

}  // namespace PULSECAST_NAMESPACE

#endif
