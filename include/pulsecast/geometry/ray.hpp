// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <limits>

#include <pulsecast/base/vector.hpp>

namespace pulsecast {

/// A half-line, and the stretch of it that counts.
struct Ray {
  Vec3 origin{};                                         ///< [m]
  Vec3 direction = axis::forward;                        ///< unit
  double near = 0;                                       ///< nothing is met at this distance or before it [m]
  double far = std::numeric_limits<double>::infinity();  ///< nothing is met beyond this distance [m]
};

}  // namespace pulsecast
