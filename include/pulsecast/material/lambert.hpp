// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_MATERIAL_LAMBERT_HPP
#define PULSECAST_MATERIAL_LAMBERT_HPP

#include <algorithm>

#include <pulsecast/material/scattering_law.hpp>

namespace PULSECAST_NAMESPACE {

/// Lambert's law: backscatter is the reflectance times the cosine. Source: Lambert 1760.
struct Lambert {
  double backscatter(double cosine, const SurfaceLight& in) const noexcept { return in.reflectance * cosine; }
  double scattered_share(double, const SurfaceLight& in) const noexcept { return std::min(in.reflectance, 1.0); }
  double scattered(const Vec3&, const Vec3& out, const Vec3& normal, const SurfaceLight& in) const noexcept {
    return scattered_share(1, in) * dot(out, normal);
  }
};

/// Backscatter equal to the reflectance at any incidence. Other light is that of Lambert's law.
struct DirectionIndependent : Lambert {
  double backscatter(double, const SurfaceLight& light) const noexcept { return light.reflectance; }
};

}  // namespace PULSECAST_NAMESPACE

#endif
