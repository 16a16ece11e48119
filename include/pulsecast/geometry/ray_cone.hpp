// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_GEOMETRY_RAY_CONE_HPP
#define PULSECAST_GEOMETRY_RAY_CONE_HPP

#include <algorithm>

#include <pulsecast/base/tick.hpp>
#include <pulsecast/geometry/box.hpp>

namespace PULSECAST_NAMESPACE {

/// Cone around rays from one origin, such as the subrays of a pulse: tests all before one is made.
struct RayCone {
  Vec3 origin{};                   ///< origin of the rays [m]
  Vec3 direction = axis::forward;  ///< unit vector along the cone's axis
  double spread = 0;               ///< bound of the distance of unit directions to `direction`
  Tick tick{};                     ///< time, for parts that move

  static constexpr double near = 0;  ///< as in `BundleOrigin` [m]
  [[nodiscard]] double direction_min(int k) const noexcept { return direction[k] - spread; }
  [[nodiscard]] double direction_max(int k) const noexcept { return direction[k] + spread; }

  /// True only if no ray comes near a box: nearer than a millionth of its distance and size, above
  /// the rounding of primitive tests. False for NaN and infinite boxes. Separating axes, with the
  /// directions as an interval about the axis. Source: Gottschalk, Lin & Manocha 1996, sec. 5.
  [[nodiscard]] bool passes(const Box& box) const noexcept {
    constexpr double rounding = 128 * std::numeric_limits<double>::epsilon();
    const Vec3 half = 0.5 * box.size(), from = origin - box.centre();
    const double scale = std::max(max_norm(origin), std::max(max_norm(box.min), max_norm(box.max)));
    const double margin = 1e-6 * (max_norm(from) + max_norm(half)) + rounding * scale;
    const double aside = spread + rounding;
    double reach[3], away[3], fastest[3];  // half side of the box, distance from its centre, speed
    for (int k = 0; k < 3; ++k) {
      reach[k] = half[k] + margin;
      away[k] = std::fabs(from[k]);
      fastest[k] = std::fabs(direction[k]) + aside;
      if (away[k] > reach[k] && (from[k] > 0 ? direction[k] : -direction[k]) > aside) return true;
    }
    for (int k = 0; k < 3; ++k) {
      const int i = (k + 1) % 3, j = (k + 2) % 3;
      const double offset = std::fabs(from[i] * direction[j] - from[j] * direction[i]);
      const double room = reach[i] * fastest[j] + reach[j] * fastest[i];
      if (offset > room + aside * (away[i] + away[j])) return true;
    }
    return false;
  }
};

}  // namespace PULSECAST_NAMESPACE

#endif
