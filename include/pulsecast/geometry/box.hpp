// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_GEOMETRY_BOX_HPP
#define PULSECAST_GEOMETRY_BOX_HPP

#include <pulsecast/base/vector.hpp>

namespace PULSECAST_NAMESPACE {

/// Axis-aligned box between two corners [m]; empty by default, so that the first extension sets it.
struct Box {
  Vec3 min = Vec3(detail::infinity);  ///< lower corner [m]
  Vec3 max = -min;                    ///< upper corner [m]

  /// True if a lower coordinate exceeds its upper one.
  [[nodiscard]] bool empty() const noexcept { return !(min.x <= max.x && min.y <= max.y && min.z <= max.z); }
  /// Centre [m].
  [[nodiscard]] Vec3 centre() const noexcept { return min * 0.5 + max * 0.5; }
  [[nodiscard]] Vec3 size() const noexcept { return max - min; }

  /// Extends the box to contain a point [m].
  void extend(const Vec3& p) noexcept {
    min = pulsecast::min(min, p);
    max = pulsecast::max(max, p);
  }
  /// Extends the box to contain another.
  void extend(const Box& b) noexcept {
    min = pulsecast::min(min, b.min);
    max = pulsecast::max(max, b.max);
  }

  /// Half of the surface area, proportional to the probability of a ray hit; 0 if empty [m^2].
  [[nodiscard]] double half_area() const noexcept {
    if (empty()) return 0;
    const Vec3 s = size();
    return s.x * s.y + s.y * s.z + s.z * s.x;
  }

  friend bool operator==(const Box&, const Box&) = default;
};

}  // namespace PULSECAST_NAMESPACE

#endif
