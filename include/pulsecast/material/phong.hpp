// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_MATERIAL_PHONG_HPP
#define PULSECAST_MATERIAL_PHONG_HPP

#include <pulsecast/base/require.hpp>
#include <pulsecast/base/vector_math.hpp>
#include <pulsecast/material/lambert.hpp>

namespace PULSECAST_NAMESPACE {

namespace detail {

/// Lobe about the mirror direction, where it is 1; 0 from 90 degrees on. Error at most 1e-14.
[[nodiscard, gnu::always_inline]] inline simd::Doubles mirror_lobe(const simd::Doubles& cosine,
                                                                   double exponent) noexcept {
  const simd::Doubles base = 2 * cosine * cosine - 1;
  const simd::Doubles power = exponent <= 64 && exponent == static_cast<unsigned>(exponent)
                                  ? simd::whole_power(base, static_cast<unsigned>(exponent))
                                  : exponential(simd::Doubles(exponent * simd::detail::log_of_normal(base)));
  return base > 0 ? power : simd::Doubles{};
}

}  // namespace detail

/// Lambert's law and a specular lobe as high as a white Lambertian surface, whatever its exponent.
/// Light into directions other than back is that of Lambert's law. Source: Jutzi & Gross 2009.
struct Phong {
  double share = 0;      ///< share of the reflectance in the lobe, in [0, 1]
  double exponent = 10;  ///< exponent of the lobe, at least 0

  void validate() const {
    require_within("Phong::share", share, 0, 1, "");
    require_not_negative("Phong::exponent", exponent, "");
  }
  simd::Doubles backscatter(const simd::Doubles& cosine, const SurfaceLight& light) const noexcept {
    return light.reflectance * ((1 - share) * cosine + share * detail::mirror_lobe(cosine, exponent));
  }
  double backscatter(double cosine, const SurfaceLight& light) const noexcept {
    return backscatter(simd::Doubles{} + cosine, light)[0];
  }
  double scattered_share(double cosine, const SurfaceLight& light) const noexcept {
    return Lambert{}.scattered_share(cosine, light);
  }
  double scattered(const Vec3& in, const Vec3& out, const Vec3& normal, const SurfaceLight& light) const noexcept {
    return Lambert{}.scattered(in, out, normal, light);
  }
};

}  // namespace PULSECAST_NAMESPACE

#endif
