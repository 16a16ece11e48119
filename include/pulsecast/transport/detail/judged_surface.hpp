// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_TRANSPORT_DETAIL_JUDGED_SURFACE_HPP
#define PULSECAST_TRANSPORT_DETAIL_JUDGED_SURFACE_HPP

#include <pulsecast/scanner/subray_directions.hpp>

namespace PULSECAST_NAMESPACE::detail {

using FourSubrays = simd::Vec<double, 4>;  ///< of four subrays, so that sums are the same for every instruction set

/// Sets means from four sums by lane.
[[gnu::always_inline]] inline void set_means(const FourSubrays& a, const FourSubrays& b, const FourSubrays& c,
                                             const FourSubrays& d, double each, FourSubrays& means) noexcept {
  const auto sum = [](const FourSubrays& v) { return (v[0] + v[1]) + (v[2] + v[3]); };
  means = each * FourSubrays{sum(a), sum(b), sum(c), sum(d)};
}

/// True for places near a plane along y, and an even power, by their means: of x, y, z, power; of the squares of x, y,
/// z, and power x; of y z, x z, x y, and power z.
[[nodiscard, gnu::always_inline]] inline bool smooth(const FourSubrays& mean, const FourSubrays& squares,
                                                     const FourSubrays& products) noexcept {
  const double x = mean[0], y = mean[1], z = mean[2], power = mean[3], right = squares[3], above = products[3];
  const double xx = squares[0] - x * x, yy = squares[1] - y * y, zz = squares[2] - z * z;
  const double yz = products[0] - y * z, xz = products[1] - x * z, xy = products[2] - x * y;
  const double determinant = xx * zz - xz * xz;
  const double across = (zz * xy - xz * yz) / determinant, up = (xx * yz - xz * xy) / determinant;
  const double off_plane = yy - across * xy - up * yz;  // mean square
  constexpr double flat = 0.02, even = 0.05;
  const double wide = 0.5 * (xx + zz);
  return off_plane < flat * flat * wide && right * right + above * above < even * even * wide * power * power;
}

/// What all subrays of a beam met, by their reflections in order: a plane fitted along the beam by least squares, and
/// the centroid of the power across it. Three always lie on a plane, and are not judged.
[[nodiscard]] MetSurface judged_surface(const SubrayDirections& beam, const JudgesSurfaces auto& footprint,
                                        std::span<const Reflection> reflections) noexcept {
  const std::size_t subrays = footprint.size();
  if (!footprint.judges_surfaces() || subrays < 4) return MetSurface::unjudged;
  if (reflections.size() != subrays) return MetSurface::mixed;
  const double first = reflections[0].range;  // sums of differences keep more digits
  FourSubrays sx{}, sy{}, sz{}, sxx{}, syy{}, szz{}, syz{}, sxz{}, sxy{}, sp{}, spx{}, spz{};
  unsigned kinds = 0;
  // adds four subrays, from one on, or the first so many of them
  const auto add = [&](std::size_t j, double count) __attribute__((always_inline)) {
    const Reflection* const r = &reflections[j];
    const FourSubrays range{r[0].range, r[1].range, r[2].range, r[3].range};
    FourSubrays p{r[0].power, r[1].power, r[2].power, r[3].power}, x, y, z;
    for (std::size_t k = 0; k < 4; ++k) kinds |= static_cast<unsigned>(r[k].kind);
    simd::fill(x, beam.x[j]);
    simd::fill(y, beam.y[j]);
    simd::fill(z, beam.z[j]);
    x = x * range;
    y = y * range - first;
    z = z * range;
    if (!beam.from_a_point()) {
      const Vec3* const exit = beam.exits + j;
      x += FourSubrays{exit[0].x, exit[1].x, exit[2].x, exit[3].x};
      y += FourSubrays{exit[0].y, exit[1].y, exit[2].y, exit[3].y};
      z += FourSubrays{exit[0].z, exit[1].z, exit[2].z, exit[3].z};
    }
    const auto counts = FourSubrays{0, 1, 2, 3} < count;
    x = counts ? x : 0.0;
    y = counts ? y : 0.0;
    z = counts ? z : 0.0;
    p = counts ? p : 0.0;
    sx += x;
    sy += y;
    sz += z;
    sp += p;
    sxx += x * x;
    syy += y * y;
    szz += z * z;
    syz += y * z;
    sxz += x * z;
    sxy += x * y;
    spx += p * x;
    spz += p * z;
  };
  const std::size_t fresh = (subrays - 1) % 4 + 1;  // of the first four, those that the next do not repeat
  add(0, static_cast<double>(fresh));
  for (std::size_t j = fresh; j < subrays; j += 4) add(j, 4);
  const double each = 1 / static_cast<double>(subrays);
  FourSubrays mean, squares, products;
  set_means(sx, sy, sz, sp, each, mean);
  set_means(sxx, syy, szz, spx, each, squares);
  set_means(syz, sxz, sxy, spz, each, products);
  const bool direct = kinds == static_cast<unsigned>(ReflectionKind::surface);
  return direct && smooth(mean, squares, products) ? MetSurface::smooth : MetSurface::mixed;
}

}  // namespace PULSECAST_NAMESPACE::detail

#endif
