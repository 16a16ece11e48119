// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include <doctest/doctest.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <pulsecast/echo.hpp>
#include <pulsecast/io/point_records.hpp>

#include "support/random_pulses.hpp"

namespace pulsecast::io {

/// Points of PCL's own type that are not those of the echoes, in order; there must be as many.
[[nodiscard]] inline std::size_t wrong_points(const pcl::PointCloud<pcl::PointXYZI>& cloud,
                                              const support::RandomPulses& pulses) {
  REQUIRE(cloud.size() == pulses.echoes.size());
  std::size_t i = 0, wrong = 0;
  for (const Shot& shot : pulses.shots)
    for (const Echo& echo : pulses.batch().echoes_of(shot)) {
      const Vec3 at = point_of(shot, echo);
      const pcl::PointXYZI& point = cloud[i++];
      wrong += point.x != static_cast<float>(at.x) || point.y != static_cast<float>(at.y) ||
               point.z != static_cast<float>(at.z) ||
               point.intensity != static_cast<float>(reflectivity_byte(echo.reflectance));
    }
  return wrong;
}

}  // namespace pulsecast::io
