// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_GEOMETRY_TRIANGLE_HPP
#define PULSECAST_GEOMETRY_TRIANGLE_HPP

#include <pulsecast/geometry/box.hpp>
#include <pulsecast/geometry/single_ray.hpp>

namespace PULSECAST_NAMESPACE {

/// Triangle with corners a, b, c [m]; both sides count.
struct Triangle {
  Vec3 a{}, b{}, c{};  ///< corners [m]

  [[nodiscard]] Box bounds() const noexcept { return {min(min(a, b), c), max(max(a, b), c)}; }

  /// Unit normal, right-handed about a, b, c; NaN without area.
  [[nodiscard]] Vec3 normal() const noexcept { return normalize(cross(b - a, c - a)); }

  /// Barycentric weights at a hit, none negative, that sum to one; a third each without area.
  [[nodiscard]] Vec3 weights(const Vec3& origin, const Vec3& direction) const noexcept {
    const Vec3 to_a = a - origin, to_b = b - origin, to_c = c - origin;
    const Vec3 volumes{dot(direction, cross(c - b, to_c + to_b)), dot(direction, cross(a - c, to_a + to_c)),
                       dot(direction, cross(b - a, to_b + to_a))};
    const double whole = volumes.x + volumes.y + volumes.z;
    const Vec3 shares = max(volumes / whole, Vec3{});  // 0 for NaN
    const double sum = shares.x + shares.y + shares.z;
    return sum > 0 && sum < detail::infinity ? shares / sum : Vec3(1.0 / 3);
  }
};

namespace detail {

struct SolidEverywhere {
  bool operator()(std::size_t, PrimitiveIndex) const noexcept { return true; }
};

/// Corners of a triangle that lie elsewhere [m]: a packet fetches each coordinate where it is used.
struct TriangleRef {
  const Vec3& a;  ///< first corner [m]
  const Vec3& b;  ///< second corner [m]
  const Vec3& c;  ///< third corner [m]
};

}  // namespace detail

/// Triangles tested together, one a lane; idle lanes repeat the last one.
struct TrianglePacket {
  /// One corner of each triangle.
  struct Corner {
    simd::Doubles x, y, z;  ///< coordinates [m]
  };
  Corner a, b, c;  ///< corners of the triangles

  /// At least one triangle; `triangle_of(n)` returns a `Triangle` or `TriangleRef`.
  // always inlined, so that a test reads its operands from registers
  [[gnu::always_inline]] TrianglePacket(std::size_t size, const auto& triangle_of) noexcept {
    const auto triangles = [&]<std::size_t... lane>(std::index_sequence<lane...>) noexcept {
      return std::array{triangle_of(std::min(lane, size - 1))...};
    }
    (std::make_index_sequence<simd::lane_count>());
    const auto corner = [&](const auto& of_triangle) noexcept {
      const auto pair = [&](std::size_t lane) noexcept {
        return simd::load<simd::Vec<double, 2>>(of_triangle(triangles[lane]).x);
      };
      const auto z = [&](std::size_t lane) noexcept { return of_triangle(triangles[lane]).z; };
      if constexpr (simd::lane_count == 2) {
        const auto even = pair(0), odd = pair(1);
        return Corner{simd::shuffle<0, 2>(even, odd), simd::shuffle<1, 3>(even, odd), simd::generate(z)};
      } else {
        const auto even = simd::shuffle<0, 1, 2, 3>(pair(0), pair(2)),
                   odd = simd::shuffle<0, 1, 2, 3>(pair(1), pair(3));
        return Corner{simd::shuffle<0, 4, 2, 6>(even, odd), simd::shuffle<1, 5, 3, 7>(even, odd), simd::generate(z)};
      }
    };
    a = corner([](const auto& triangle) noexcept -> const Vec3& { return triangle.a; });
    b = corner([](const auto& triangle) noexcept -> const Vec3& { return triangle.b; });
    c = corner([](const auto& triangle) noexcept -> const Vec3& { return triangle.c; });
  }
};

namespace detail {

/// Planes through a ray's origin and an edge of each triangle, and the bound below which a side is
/// in doubt: |e||s| in the 1-norm bounds each sum of products, which is at most seven roundings off.
struct EdgePlanes {
  simd::Doubles x, y, z, doubt;

  EdgePlanes() = default;
  [[gnu::always_inline]] EdgePlanes(const TrianglePacket::Corner& from, const TrianglePacket::Corner& to,
                                    double direction_length) noexcept {
    const simd::Doubles tolerance = simd::Doubles{} + 4 * std::numeric_limits<double>::epsilon() * direction_length;
    using simd::magnitude;
    const simd::Doubles ex = to.x - from.x, ey = to.y - from.y, ez = to.z - from.z;
    const simd::Doubles sx = to.x + from.x, sy = to.y + from.y, sz = to.z + from.z;
    x = ey * sz - ez * sy;
    y = ez * sx - ex * sz;
    z = ex * sy - ey * sx;
    doubt =
        (magnitude(ex) + magnitude(ey) + magnitude(ez)) * (magnitude(sx) + magnitude(sy) + magnitude(sz)) * tolerance;
  }

  // bounds of the side of all rays of a bundle; always inlined, as products are then shared
  [[nodiscard, gnu::always_inline]] simd::Doubles most(const auto& rays) const noexcept {
    return simd::max(x * rays.direction_min(0), x * rays.direction_max(0)) +
           simd::max(y * rays.direction_min(1), y * rays.direction_max(1)) +
           simd::max(z * rays.direction_min(2), z * rays.direction_max(2));
  }
  [[nodiscard, gnu::always_inline]] simd::Doubles least(const auto& rays) const noexcept {
    return simd::min(x * rays.direction_min(0), x * rays.direction_max(0)) +
           simd::min(y * rays.direction_min(1), y * rays.direction_max(1)) +
           simd::min(z * rays.direction_min(2), z * rays.direction_max(2));
  }
};

/// Bit mask of the triangles that a single ray's line may hit, idle lanes included.
[[nodiscard, gnu::noinline]] inline unsigned on_one_side(const TrianglePacket& triangles, const auto& ray) noexcept {
  using Corner = TrianglePacket::Corner;
  const auto from_origin = [&](const Corner& p) noexcept -> Corner {
    return {p.x - ray.origin.x, p.y - ray.origin.y, p.z - ray.origin.z};
  };
  const Corner a = from_origin(triangles.a), b = from_origin(triangles.b), c = from_origin(triangles.c);
  const EdgePlanes ab(a, b, ray.direction_length), bc(b, c, ray.direction_length), ca(c, a, ray.direction_length);
  const Vec3 d = ray.direction(0);
  const auto side = [&](const EdgePlanes& p) noexcept { return simd::Doubles(d.x * p.x + d.y * p.y + d.z * p.z); };
  const simd::Doubles u = side(ab), v = side(bc), w = side(ca);
  return simd::bits(((u >= -ab.doubt) & (v >= -bc.doubt) & (w >= -ca.doubt)) |
                    ((u <= ab.doubt) & (v <= bc.doubt) & (w <= ca.doubt)));
}

}  // namespace detail

/// Intersects the triangles of primitives with every ray of a bundle, or with a `SingleRayPacket`:
/// the deciding test, always in double precision. A ray is inside if it is on the same side of the
/// three planes through the origin and an edge. The planes depend on the bundle alone, so a ray
/// costs three dot products, and none where the whole bundle passes a plane on one side. If
/// rounding leaves it in doubt, a ray counts as inside, so none slips between two triangles that
/// share an edge or a corner. A hit lies in the triangle's own box, widened by a few roundings, so
/// that no box of an accelerator hides it. Beside an edge it lies by at most 32 roundings of the
/// distance by the sine of the angle between ray and plane; its range errs by that times one more
/// than the aspect. A ray within 1e-12 rad of the plane misses, as does every ray if two edges are
/// parallel to within 8 roundings (no area). Hits of ray j count with `solid(j, primitive)`,
/// outside the holes of a mask. A single ray is known to be on one side of the planes of the
/// triangles in the mask `certain`, if that is not 0, and to pass the others. Never inlined: every accelerator gets the
/// same bits. Source: volume test of Amanatides & Choi 1997 in the edge-symmetric form of Shevtsov, Soupikov & Kapustin
/// 2007; interval inside the box: Kay & Kajiya 1986; bounds: Higham 2002, ch. 3.
template <class Rays, class Hits, class Solid = detail::SolidEverywhere>
[[gnu::noinline]] void intersect(const TrianglePacket& triangles, std::span<const PrimitiveIndex> primitives,
                                 const Rays& rays, Hits& nearest, [[maybe_unused]] const Solid& solid = {},
                                 [[maybe_unused]] unsigned certain = 0) noexcept {
  static_assert(RayBundle::lanes % simd::lane_count == 0);
  constexpr bool single = Rays::capacity == 1;  // a lane a triangle, not a lane a ray
  constexpr bool with_holes = !std::is_same_v<Solid, detail::SolidEverywhere>;
  constexpr double unit = std::numeric_limits<double>::epsilon();
  using Corner = TrianglePacket::Corner;
  using simd::magnitude;
  const auto from_origin = [&](const Corner& p) noexcept -> Corner {
    return {p.x - rays.origin.x, p.y - rays.origin.y, p.z - rays.origin.z};
  };
  const Corner a = from_origin(triangles.a), b = from_origin(triangles.b), c = from_origin(triangles.c);

  [[maybe_unused]] detail::EdgePlanes ab, bc, ca;
  unsigned candidates = (1U << primitives.size()) - 1;

  // no ray is inside where all pass one plane on its right and one on its left; once more rounding
  if constexpr (single) {
    candidates &= certain != 0 ? certain : detail::on_one_side(triangles, rays);
  } else {
    ab = detail::EdgePlanes(a, b, rays.direction_length);
    bc = detail::EdgePlanes(b, c, rays.direction_length);
    ca = detail::EdgePlanes(c, a, rays.direction_length);
    candidates &= simd::bits(
        ((ab.most(rays) >= -4 * ab.doubt) & (bc.most(rays) >= -4 * bc.doubt) & (ca.most(rays) >= -4 * ca.doubt)) |
        ((ab.least(rays) <= 4 * ab.doubt) & (bc.least(rays) <= 4 * bc.doubt) & (ca.least(rays) <= 4 * ca.doubt)));
  }
  if (candidates == 0) return;

  // planes and boxes of the triangles, the boxes widened by the roundings of a hit
  const auto cross_of = [](const Corner& u, const Corner& v) noexcept -> Corner {
    return {u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
  };
  const auto minus = [](const Corner& u, const Corner& v) noexcept -> Corner {
    return {u.x - v.x, u.y - v.y, u.z - v.z};
  };
  const auto square = [](const Corner& v) noexcept { return v.x * v.x + v.y * v.y + v.z * v.z; };
  const Corner from_a = minus(triangles.b, triangles.a),
               to_a = minus(triangles.a, triangles.c);  // unaffected by the distance
  const Corner normals = cross_of(from_a, to_a);
  const simd::Doubles offsets = normals.x * a.x + normals.y * a.y + normals.z * a.z, area = square(normals);
  const simd::Mask flat = area <= 8 * unit * square(from_a) * (8 * unit * square(to_a));  // zero angle
  const simd::Doubles grazing =
      flat ? simd::Doubles{} + detail::infinity : 1e-12 * 1e-12 * rays.direction_length * rays.direction_length * area;
  const Corner lowest{simd::min(a.x, simd::min(b.x, c.x)), simd::min(a.y, simd::min(b.y, c.y)),
                      simd::min(a.z, simd::min(b.z, c.z))};
  const Corner highest{simd::max(a.x, simd::max(b.x, c.x)), simd::max(a.y, simd::max(b.y, c.y)),
                       simd::max(a.z, simd::max(b.z, c.z))};
  const simd::Doubles extent = simd::max(simd::max(simd::max(magnitude(lowest.x), magnitude(highest.x)),
                                                   simd::max(magnitude(lowest.y), magnitude(highest.y))),
                                         simd::max(magnitude(lowest.z), magnitude(highest.z)));

  // Ranges at which rays cross planes, moved into the boxes; `inside` loses rays that miss these. By
  // far most crossings are in boxes widened by half as much, which takes no division: they stay.
  struct Walls {
    Corner low, high;
    simd::Doubles margin;
  };
  const Walls walls{lowest, highest, 8 * unit * extent};
  const auto widened = [](const Walls& box, double part) noexcept -> Walls {
    const simd::Doubles by = part * box.margin;
    const auto& [low, high, margin] = box;
    return {{low.x - by, low.y - by, low.z - by}, {high.x + by, high.y + by, high.z + by}, margin};
  };
  const auto crossings = [&](const Corner& d, const simd::Doubles& offset, const simd::Doubles& slope,
                             const Walls& inner, const auto& box, simd::Mask& inside, unsigned lanes) noexcept {
    const simd::Doubles at = offset / slope;
    const auto within = [&](simd::Doubles Corner::*axis) noexcept {
      const simd::Doubles place = at * (d.*axis);
      return simd::Mask((place >= inner.low.*axis) & (place <= inner.high.*axis));
    };
    const simd::Mask outside = inside & ~(within(&Corner::x) & within(&Corner::y) & within(&Corner::z));
    if ((simd::bits(outside) & lanes) == 0) [[likely]]
      return at;
    const Walls outer = widened(box(), 1);
    simd::Doubles exit = simd::Doubles{} + detail::infinity, entry = -exit;
    for (const auto axis : {&Corner::x, &Corner::y, &Corner::z}) {
      // a zero direction is made so small that its walls lie at infinity
      const simd::Doubles along = d.*axis, tiny = simd::Doubles{} + 1e-300;
      const simd::Doubles per_metre = 1 / (along * along > 0 ? along : tiny);
      const simd::Doubles to_low = outer.low.*axis * per_metre, to_high = outer.high.*axis * per_metre;
      entry = simd::max(simd::min(to_low, to_high), entry);
      exit = simd::min(simd::max(to_low, to_high), exit);
    }
    inside &= entry <= exit;
    const simd::Doubles after_entry = at < entry ? entry : at;
    return simd::Doubles(after_entry > exit ? exit : after_entry);
  };
  if constexpr (single) {
    const Vec3 d = rays.direction(0);
    const Corner along{d.x - simd::Doubles{}, d.y - simd::Doubles{}, d.z - simd::Doubles{}};
    const simd::Doubles slope = along.x * normals.x + along.y * normals.y + along.z * normals.z;
    simd::Mask hit = slope * slope > grazing;
    const simd::Doubles at = crossings(
        along, offsets, slope, widened(walls, 0.5), [&] { return walls; }, hit, candidates);
    hit &= at > rays.near;
    for (candidates &= simd::bits(hit); candidates != 0; candidates &= candidates - 1) {
      const auto t = static_cast<std::size_t>(std::countr_zero(candidates));
      if constexpr (with_holes)
        if (!(at[t] <= nearest.limit_of(0)) || !solid(0, primitives[t])) continue;
      nearest.offer(0, at[t], primitives[t]);
    }
  } else {
    // triangles that all rays hit between the edges, certainly
    const unsigned around = simd::bits(
        ((ab.least(rays) > 4 * ab.doubt) & (bc.least(rays) > 4 * bc.doubt) & (ca.least(rays) > 4 * ca.doubt)) |
        ((ab.most(rays) < -4 * ab.doubt) & (bc.most(rays) < -4 * bc.doubt) & (ca.most(rays) < -4 * ca.doubt)));
    for (; candidates != 0; candidates &= candidates - 1) {
      const auto t = static_cast<std::size_t>(std::countr_zero(candidates));
      const PrimitiveIndex primitive = primitives[t];
      const auto of_one = [&]() noexcept -> Walls {
        const auto one = [t](const Corner& p) noexcept -> Corner {
          return {simd::Doubles{} + p.x[t], simd::Doubles{} + p.y[t], simd::Doubles{} + p.z[t]};
        };
        return {one(lowest), one(highest), simd::Doubles{} + walls.margin[t]};
      };
      const Walls inner = widened(of_one(), 0.5);
      for (std::size_t j = 0; j < rays.size; j += simd::lane_count) {
        const Corner d{simd::load<simd::Doubles>(rays.x[j]), simd::load<simd::Doubles>(rays.y[j]),
                       simd::load<simd::Doubles>(rays.z[j])};
        simd::Mask inside = simd::Mask{} - 1;
        if ((around >> t & 1) == 0) {
          const simd::Doubles u = d.x * ab.x[t] + d.y * ab.y[t] + d.z * ab.z[t];
          const simd::Doubles v = d.x * bc.x[t] + d.y * bc.y[t] + d.z * bc.z[t];
          const simd::Doubles w = d.x * ca.x[t] + d.y * ca.y[t] + d.z * ca.z[t];
          const simd::Mask on_left = (u >= -ab.doubt[t]) & (v >= -bc.doubt[t]) & (w >= -ca.doubt[t]);
          const simd::Mask on_right = (u <= ab.doubt[t]) & (v <= bc.doubt[t]) & (w <= ca.doubt[t]);
          inside = on_left | on_right;
          if (simd::bits(inside) == 0) continue;
        }

        const simd::Doubles slope = d.x * normals.x[t] + d.y * normals.y[t] + d.z * normals.z[t];
        inside &= slope * slope > grazing[t];
        const simd::Doubles at = crossings(d, simd::Doubles{} + offsets[t], slope, inner, of_one, inside, ~0U);

        const simd::Doubles best = simd::load<simd::Doubles>(nearest.range[j]);
        const simd::Ids best_id = simd::load<simd::Ids>(nearest.id[j]),
                        own_id = simd::Ids{} + (nearest.part | primitive);
        const simd::Mask nearer = (at < best) | ((at == best) & (own_id < best_id));
        simd::Mask hit = inside & (at > rays.near_of(j)) & nearer;
        if constexpr (with_holes)
          for (unsigned lanes = simd::bits(hit); lanes != 0; lanes &= lanes - 1)
            if (const auto lane = static_cast<std::size_t>(std::countr_zero(lanes)); !solid(j + lane, primitive))
              hit[lane] = 0;
        simd::store(hit ? at : best, nearest.range[j]);
        simd::store(hit ? own_id : best_id, nearest.id[j]);
      }
    }
  }
}

/// Intersects as many triangles as there are primitives; `triangle_of(n)` returns the n-th.
template <class TriangleOf, class Rays, class Hits, class Solid = detail::SolidEverywhere>
void intersect(std::span<const PrimitiveIndex> primitives, const TriangleOf& triangle_of, const Rays& rays,
               Hits& nearest, const Solid& solid = {}) noexcept {
  for (std::size_t first = 0; first < primitives.size(); first += simd::lane_count) {
    const std::size_t count = std::min(simd::lane_count, primitives.size() - first);
    const auto of_packet = [&](std::size_t n) noexcept { return triangle_of(first + n); };
    intersect(TrianglePacket(count, of_packet), primitives.subspan(first, count), rays, nearest, solid);
    if constexpr (detail::EndsEarly<Hits>)
      if (nearest.done()) return;
  }
}

/// Intersects one triangle.
void intersect(const Triangle& triangle, PrimitiveIndex i, const auto& rays, auto& nearest) noexcept {
  const auto triangle_of = [&](std::size_t) noexcept { return triangle; };
  intersect(std::span(&i, 1), triangle_of, rays, nearest);
}

}  // namespace PULSECAST_NAMESPACE

#endif
