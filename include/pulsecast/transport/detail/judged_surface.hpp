// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_TRANSPORT_DETAIL_JUDGED_SURFACE_HPP
#define PULSECAST_TRANSPORT_DETAIL_JUDGED_SURFACE_HPP

#include <pulsecast/scanner/subray_directions.hpp>

namespace PULSECAST_NAMESPACE::detail {

/// What all subrays of a beam met, by their reflections in order: a plane fitted along the beam by least squares, and
/// the centroid of the power across it.
[[nodiscard]] MetSurface judged_surface(const SubrayDirections& beam, const JudgesSurfaces auto& footprint,
                                        std::span<const Reflection> reflections) noexcept {
  if (!footprint.judges_surfaces()) return MetSurface::unjudged;
  const std::size_t subrays = footprint.size();
  if (reflections.size() != subrays) return MetSurface::mixed;
  const double first = reflections[0].range;  // sums of differences keep more digits
  bool direct = true;
  Vec3 sum{}, squares{}, mixed{};  // of x, y, z; of their squares; of y z, x z, x y
  double power = 0, right = 0, above = 0;
  for (std::size_t j = 0; j < subrays; ++j) {
    const Reflection& r = reflections[j];
    Vec3 p{r.range * beam.x[j], r.range * beam.y[j] - first, r.range * beam.z[j]};
    if (!beam.from_a_point()) p += beam.exits[j];
    sum += p;
    squares += p * p;
    mixed += Vec3{p.y * p.z, p.x * p.z, p.x * p.y};
    power += r.power;
    right += r.power * p.x;
    above += r.power * p.z;
    direct &= r.kind == ReflectionKind::surface;
  }
  const double each = 1 / static_cast<double>(subrays);
  const Vec3 mean = each * sum, variance = each * squares - mean * mean;
  const Vec3 covariance = each * mixed - Vec3{mean.y * mean.z, mean.x * mean.z, mean.x * mean.y};
  const double determinant = variance.x * variance.z - covariance.y * covariance.y;
  const double across = (variance.z * covariance.z - covariance.y * covariance.x) / determinant;
  const double up = (variance.x * covariance.x - covariance.y * covariance.z) / determinant;
  const double off_plane = variance.y - across * covariance.z - up * covariance.x;  // mean square
  constexpr double flat = 0.02, even = 0.05;
  const double wide = 0.5 * (variance.x + variance.z);
  const bool smooth =
      direct && off_plane < flat * flat * wide && right * right + above * above < even * even * wide * power * power;
  return smooth ? MetSurface::smooth : MetSurface::mixed;
}

}  // namespace PULSECAST_NAMESPACE::detail

#endif
