// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_GEOMETRY_RAY_HPP
#define PULSECAST_GEOMETRY_RAY_HPP

#include <limits>

#include <pulsecast/base/vector.hpp>

namespace pulsecast {

/// Ray with the interval of distances that counts.
struct Ray {
  Vec3 origin{};                                         ///< origin [m]
  Vec3 direction = axis::forward;                        ///< unit vector
  double near = 0;                                       ///< only hits beyond this distance count [m]
  double far = std::numeric_limits<double>::infinity();  ///< only hits up to this distance count [m]
};

}  // namespace pulsecast

#endif
