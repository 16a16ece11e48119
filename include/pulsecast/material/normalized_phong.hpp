// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_MATERIAL_NORMALIZED_PHONG_HPP
#define PULSECAST_MATERIAL_NORMALIZED_PHONG_HPP

#include <pulsecast/material/phong.hpp>

namespace PULSECAST_NAMESPACE {

/// Lambert's law and a specular lobe that holds its share of the energy. Light into directions
/// other than back is that of Lambert's law. Source: Lafortune & Willems 1994.
struct NormalizedPhong {
  double share = 0;      ///< share of the reflectance in the lobe, in [0, 1]
  double exponent = 10;  ///< exponent of the lobe, at least 0

  void validate() const {
    require_within("NormalizedPhong::share", share, 0, 1, "");
    require_not_negative("NormalizedPhong::exponent", exponent, "");
  }
  simd::Doubles backscatter(const simd::Doubles& cosine, const SurfaceLight& light) const noexcept {
    const double height = share * (exponent + 2) / 2;
    return light.reflectance * cosine * (1 - share + height * detail::mirror_lobe(cosine, exponent));
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
