// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_MATERIAL_TABULATED_HPP
#define PULSECAST_MATERIAL_TABULATED_HPP

#include <pulsecast/base/require.hpp>
#include <pulsecast/base/search.hpp>
#include <pulsecast/base/shared_array.hpp>
#include <pulsecast/base/units.hpp>
#include <pulsecast/material/lambert.hpp>

namespace PULSECAST_NAMESPACE {

/// Row of a table of backscatter.
struct BackscatterAtIncidence {
  double incidence = 0;    ///< angle between light and normal, from 0 to pi/2 [rad]
  double backscatter = 0;  ///< by a white Lambertian surface's at normal incidence, per reflectance
};

/// Measured backscatter. Light into other directions is that of Lambert's law.
struct Tabulated {
  /// Backscatter by incidence: linear between rows, constant beyond them; angles ascend.
  SharedArray<BackscatterAtIncidence> rows{};

  void validate() const {
    require_within("Tabulated::rows (number)", rows.size(), 1, 1e6, "");
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const double at = rows[i].incidence;
      require_within("Tabulated::rows (incidence)", at, 0, pi / 2 * (1 + 1e-6), "rad");
      require_not_negative("Tabulated::rows (backscatter)", rows[i].backscatter, "");
      if (i == 0) continue;
      require_positive("Tabulated::rows (from incidence to incidence)", at - rows[i - 1].incidence, "rad");
    }
  }
  double backscatter(double cosine, const SurfaceLight& light) const noexcept {
    if (rows.empty()) return 0;
    return light.reflectance * detail::interpolated(rows, std::acos(std::clamp(cosine, -1.0, 1.0)),
                                                    &BackscatterAtIncidence::incidence,
                                                    &BackscatterAtIncidence::backscatter);
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
