// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_OBJ_POLYGON_HPP
#define PULSECAST_IO_DETAIL_OBJ_POLYGON_HPP

#include <algorithm>
#include <array>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include <pulsecast/base/vector.hpp>

namespace PULSECAST_NAMESPACE::io::detail {

inline constexpr std::size_t max_polygon_corners = 4096;  ///< limit, as the time is quadratic

/// Triangles of a polygon, as corner indices, by ear clipping (tinyobjloader 2.0 rc10 loses parts
/// of concave polygons); a convex one becomes the fan about its first corner. Empty if the outline
/// crosses itself. Source: Meisters 1975, every simple polygon has two ears.
[[nodiscard]] inline std::vector<std::array<std::size_t, 3>> triangulated(const std::vector<Vec3>& corners) {
  // projection along the axis nearest to the normal. Source: Newell, in Sutherland et al. 1974
  Vec3 normal{};
  for (std::size_t i = 0; i < corners.size(); ++i)
    normal += cross(corners[i] - corners[0], corners[(i + 1) % corners.size()] - corners[0]);
  int axis = 2;
  for (const int k : {1, 0})
    if (std::fabs(normal[k]) > std::fabs(normal[axis])) axis = k;
  std::vector<Vec2> flat;
  for (const Vec3& corner : corners) {
    const Vec3 p = corner - corners[0];
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    flat.push_back(normal[axis] < 0 ? Vec2{p[v], p[u]} : Vec2{p[u], p[v]});
  }
  const auto left = [&](std::size_t a, std::size_t b, std::size_t c) {  // positive: to the left
    const Vec2 ab = flat[b] - flat[a], ac = flat[c] - flat[a];
    return ab.x * ac.y - ab.y * ac.x;
  };

  std::vector<std::size_t> ring(corners.size());
  std::iota(ring.begin(), ring.end(), std::size_t{0});
  const auto neighbours = [&](std::size_t i) {
    return std::pair{ring[(i + ring.size() - 1) % ring.size()], ring[(i + 1) % ring.size()]};
  };
  const auto is_ear = [&](std::size_t i) {
    const auto [before, after] = neighbours(i);
    if (!(left(before, ring[i], after) > 0)) return false;
    return std::ranges::none_of(ring, [&, a = before, b = ring[i], c = after](std::size_t p) {
      return flat[p] != flat[a] && flat[p] != flat[b] && flat[p] != flat[c] && left(a, b, p) >= 0 &&
             left(b, c, p) >= 0 && left(c, a, p) >= 0;
    });
  };
  const auto is_straight = [&](std::size_t i) {
    const auto [before, after] = neighbours(i);
    return left(before, ring[i], after) == 0;
  };

  std::vector<std::array<std::size_t, 3>> triangles;
  std::size_t start = 1;
  while (ring.size() >= 3) {
    std::size_t i = start;
    while (i < start + ring.size() && !is_ear(i % ring.size())) ++i;
    if (i < start + ring.size()) {
      i %= ring.size();
      const auto [before, after] = neighbours(i);
      triangles.push_back({before, ring[i], after});
    } else {  // the rest may be folded flat
      for (i = 0; i < ring.size() && !is_straight(i);) ++i;
      if (i == ring.size()) return {};
    }
    ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(i));
    start = i;
  }
  return triangles;
}

/// Writes the n - 2 triangles of a polygon with these vertices, some without area. False if its outline crosses itself.
/// `place_of` is the place of a vertex.
[[nodiscard]] bool cut_polygon(std::span<const std::uint32_t> c, const auto& place_of,
                               std::array<std::uint32_t, 3>* to) {
  for (std::size_t k = 2; k < c.size(); ++k) to[k - 2] = {c[0], c[k - 1], c[k]};
  if (c.size() == 3) return true;
  std::vector<Vec3> corners;
  for (const std::uint32_t vertex : c) corners.push_back(place_of(vertex));
  if (corners.size() == 4) {  // a convex one, as most polygons are, without a search
    const Vec3 normal = cross(corners[2] - corners[0], corners[3] - corners[1]);
    const auto turns_left = [&](std::size_t k) {
      const Vec3 &a = corners[k], &b = corners[(k + 1) % 4], &after = corners[(k + 2) % 4];
      return dot(cross(b - a, after - b), normal) > 0;
    };
    if (turns_left(0) && turns_left(1) && turns_left(2) && turns_left(3)) return true;
  }
  const auto cuts = triangulated(corners);
  for (std::size_t k = 0; k + 2 < corners.size() && !cuts.empty(); ++k)
    for (std::size_t i = 0; i < 3; ++i) to[k][i] = k < cuts.size() ? c[cuts[k][i]] : c[0];
  return !cuts.empty();
}

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
