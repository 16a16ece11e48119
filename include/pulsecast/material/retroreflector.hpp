// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_MATERIAL_RETROREFLECTOR_HPP
#define PULSECAST_MATERIAL_RETROREFLECTOR_HPP

#include <pulsecast/base/require.hpp>
#include <pulsecast/base/units.hpp>
#include <pulsecast/material/lambert.hpp>

namespace PULSECAST_NAMESPACE {

/// Glass beads: what they return falls as a power of the cosine of the entrance angle.
struct Beads {
  double half_angle = pi / 6;  ///< entrance angle of half of it, from 0.01 to 1.5 [rad]

  void validate() const { require_within("Beads::half_angle", half_angle, 0.01, 1.5, "rad"); }
  /// Light returned at a cosine greater than 0, by that along the normal.
  [[nodiscard]] double returned(double cosine) const noexcept {
    return std::pow(cosine, std::log(0.5) / std::log(std::cos(half_angle)));
  }
};

/// Cube corners: what they return falls with their open area, inside glass by Snell's law. Source:
/// open area of a round cube corner, Chang, Currie, Alley & Pittman 1971, as in Degnan 1993.
struct CubeCorners {
  double index = 1;  ///< refractive index, from 1 to 4: 1 of mirrors, 1.5 of prisms

  void validate() const { require_within("CubeCorners::index", index, 1, 4, ""); }
  /// As of `Beads`; none beyond 35.3 degrees of an index of 1.
  [[nodiscard]] double returned(double cosine) const noexcept {
    const double sine2 = (1 - cosine * cosine) / (index * index), tangent2 = sine2 / (1 - sine2),
                 open = 1 - 2 * tangent2;
    if (!(open > 0)) return 0;
    return 2 / pi * cosine * (std::asin(std::sqrt(open)) - std::sqrt(2 * tangent2 * open));
  }
};

/// Lambert's law, and light that returns to its source, as of sheeting and road marks.
template <class Optics = Beads>
struct Retroreflector {
  /// Coefficient of retroreflection R_A, for light along the normal, at most 1e6 [cd/(lx m^2)].
  /// That of a white Lambertian surface is 1/pi; beaded sheeting has some 70, prismatic 300 to
  /// 1,000. The budget holds from a few apertures' diameters on. Source: ASTM E808, CIE 54.2.
  double coefficient = 0;
  /// Half angle at 1/e^2 of the light that returns, from 0 to 0.1; 0: wide, energy unknown [rad].
  double half_angle = 0;
  Optics optics{};  ///< law by entrance angle

  void validate() const {
    require_within("Retroreflector::coefficient", coefficient, 0, 1e6, "cd/(lx m^2)");
    require_within("Retroreflector::half_angle", half_angle, 0, 0.1, "rad");
    optics.validate();
  }
  double backscatter(double cosine, const SurfaceLight& light) const noexcept {
    const double returned = cosine > 0 ? pi * coefficient * optics.returned(cosine) : 0;
    return light.reflectance * cosine + returned;
  }
  double scattered_share(double, const SurfaceLight& light) const noexcept {
    return std::min(std::min(light.reflectance, 1.0) + returned_share(), 1.0);
  }
  double scattered(const Vec3& in, const Vec3& out, const Vec3& normal, const SurfaceLight& light) const noexcept {
    return Lambert{}.scattered(in, out, normal, light);
  }
  [[nodiscard]] double returned_share() const noexcept { return coefficient * pi / 2 * half_angle * half_angle; }
  [[nodiscard]] double returned_half_angle() const noexcept { return half_angle; }
};

}  // namespace PULSECAST_NAMESPACE

#endif
