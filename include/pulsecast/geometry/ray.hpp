// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_GEOMETRY_RAY_HPP
#define PULSECAST_GEOMETRY_RAY_HPP

#include <pulsecast/base/tick.hpp>
#include <pulsecast/base/vector.hpp>

namespace PULSECAST_NAMESPACE {

/// Ray with the interval of distances that counts, its time, and the key of its random numbers.
struct Ray {
  Vec3 origin{};                   ///< origin [m]
  Vec3 direction = axis::forward;  ///< unit vector
  double near = 0;                 ///< only hits beyond count [m]
  double far = detail::infinity;   ///< only hits up to it count [m]
  Tick tick{};                     ///< time, for parts that move
  std::uint64_t seed = 0;          ///< key, with the next two, of random numbers in tracing
  PulseIndex pulse = 0;            ///< index of its pulse
  std::uint32_t subray = 0;        ///< number among the subrays of its pulse
};

}  // namespace PULSECAST_NAMESPACE

#endif
