// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/geometry/detail/bundle_interval.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <limits>
#include <vector>

#include <pulsecast/geometry/triangle.hpp>

#include "support/generators.hpp"

using namespace pulsecast;
using namespace pulsecast::support;

namespace {

/// The stretch of a ray inside a box, in long double; empty if entry > exit.
struct Stretch {
  long double entry, exit;
};
Stretch stretch(const Box& box, const Vec3& origin, const Vec3& direction) {
  constexpr long double infinity = std::numeric_limits<long double>::infinity();
  Stretch s{-infinity, infinity};
  for (int k = 0; k < 3; ++k) {
    const long double d = direction[k],
                      low = static_cast<long double>(box.min[k]) - static_cast<long double>(origin[k]),
                      high = static_cast<long double>(box.max[k]) - static_cast<long double>(origin[k]);
    if (d == 0) {
      if (low > 0 || high < 0) return {infinity, -infinity};
      continue;
    }
    s.entry = std::max(s.entry, std::min(low / d, high / d));
    s.exit = std::min(s.exit, std::max(low / d, high / d));
  }
  return s;
}

template <class Real>
bool holds(const typename BundleInterval<Real>::Span& span, long double range) {
  return static_cast<long double>(span.entry) <= range && range <= static_cast<long double>(span.exit);
}

/// Boxes that an interval meets up to a limit.
template <class Real>
struct Met {
  unsigned found;
  std::array<Real, 8> entries;
};
template <class Real>
Met<Real> met_by(const BundleInterval<Real>& interval, const Box8<Real>& boxes, Real limit) {
  Met<Real> met;
  met.found = interval.inside(boxes, limit, met.entries);
  return met;
}
/// As above, by the keys, which must have room for a tag, and order as ranges do.
template <class Real>
Met<Real> met_by(const RayInterval<Real>& interval, const Box8<Real>& boxes, Real limit) {
  using Interval = RayInterval<Real>;
  Met<Real> met;
  typename Interval::Keys keys;
  met.found = interval.inside(boxes, limit, keys);
  for (std::size_t i = 0; i < 8; ++i) {
    met.entries[i] = std::bit_cast<Real>(keys[i]);
    if ((met.found >> i & 1U) == 0) continue;
    CHECK((keys[i] & 7) == 0);
    CHECK((keys[i] | 7) <= Interval::last_key(limit));
    for (std::size_t k = 0; k < i; ++k)
      if ((met.found >> k & 1U) != 0) CHECK((met.entries[i] < met.entries[k]) == (keys[i] < keys[k]));
  }
  return met;
}

RayBundle random_rays(Generator& random, const Vec3& origin, const Vec3& aim) {
  static constexpr double angles[] = {0, 1e-9, 1e-5, 1e-2, 0.5, 3};
  const std::uint64_t kind = random.whole(4);
  Vec3 axis = kind == 0 ? random.unit() : normalize(aim - origin);
  if (kind == 1) {  // along an axis, or in a plane of two
    axis[static_cast<int>(random.whole(3))] = 0;
    if (random.coin()) axis = random.coin() ? axis::forward : -axis::up;
    axis = normalize(axis);
  }
  RayBundle rays = random.cone(origin, axis, angles[random.whole(6)], 1 + random.whole(20));
  if (random.whole(5) == 0) rays.near = length(aim - origin) * random.uniform(0, 1.1);
  return rays;
}

}  // namespace

TEST_CASE_TEMPLATE("one ray is inside a box between its walls", Real, float, double) {
  const Box box{{2, -1, -1}, {5, 1, 1}};
  const auto span = [&](const Ray& ray) {
    return BundleInterval<Real>(bundle_of(ray), box, {}).inside(BoundingBox<Real>::around(box, {}));
  };
  const auto through = span({{}, axis::right});
  CHECK(static_cast<double>(through.entry) == doctest::Approx(2).epsilon(1e-5));
  CHECK(static_cast<double>(through.exit) == doctest::Approx(5).epsilon(1e-5));
  CHECK(span({{}, -axis::right}).empty());
  CHECK(span({{}, axis::forward}).empty());
  CHECK(span({{0, 3, 0}, axis::right}).empty());
  CHECK(span({{}, axis::right, 6}).empty());
  CHECK_FALSE(span({{3, 0, 0}, axis::up}).empty());
}

TEST_CASE_TEMPLATE("a plane parts a stretch into what is above and what is below", Real, float, double) {
  const Box bounds{{-10, -10, -10}, {10, 10, 10}};
  const typename BundleInterval<Real>::Span all{0, 100};
  const BundleInterval<Real> rising(bundle_of({{0, 0, -5}, axis::up}), bounds, {});
  CHECK(static_cast<double>(rising.above(all, 2, 1).entry) == doctest::Approx(6).epsilon(1e-5));
  CHECK(rising.above(all, 2, 1).exit == 100);
  CHECK(rising.below(all, 2, 1).entry == 0);
  CHECK(static_cast<double>(rising.below(all, 2, 1).exit) == doctest::Approx(6).epsilon(1e-5));
  CHECK(rising.above(all, 0, 1).empty());  // it never gets there
  CHECK_FALSE(rising.below(all, 0, 1).empty());
  const BundleInterval<Real> falling(bundle_of({{0, 0, 5}, -axis::up}), bounds, {});
  CHECK(static_cast<double>(falling.below(all, 2, 1).entry) == doctest::Approx(4).epsilon(1e-5));
  CHECK(static_cast<double>(falling.above(all, 2, 1).exit) == doctest::Approx(4).epsilon(1e-5));
}

TEST_CASE_TEMPLATE("no box that any ray of a bundle meets is passed over, at any scale", Real, float, double) {
  constexpr std::uint64_t seed = 82;
  CAPTURE(seed);
  Generator random(seed);
  long met = 0, passed = 0;
  for (int time = 0; time < 100000; ++time) {
    const double scale = random.log_uniform(1e-6, 1e7);
    Box box = random.box(scale, 1e-6 * scale, scale);
    if (random.whole(4) == 0) box.max[static_cast<int>(random.whole(3))] = box.min[0];
    for (int k = 0; k < 3; ++k)
      if (box.max[k] < box.min[k] || random.whole(8) == 0) box.max[k] = box.min[k];  // flat
    Box bounds = random.box(scale, scale, 2 * scale);
    bounds.extend(box);
    const Vec3 u{random.uniform(), random.uniform(), random.uniform()};
    Vec3 aim = box.min + box.size() * u;
    if (random.coin()) aim[static_cast<int>(random.whole(3))] = box.min[0];
    Vec3 origin = random.point(scale * random.log_uniform(1e-2, 1e2));
    if (random.whole(6) == 0) origin = aim + random.point(scale * 1e-9);
    const RayBundle rays = random_rays(random, origin, aim);
    const Vec3 centre = bounds.centre();
    const BundleInterval<Real> interval(rays, bounds, centre);
    const auto span = interval.inside(BoundingBox<Real>::around(box, centre));
    const int k = static_cast<int>(random.whole(3));
    const Real wall = random.coin() ? round_down<Real>(box.min[k] - centre[k]) : round_up<Real>(box.max[k] - centre[k]);
    const typename BundleInterval<Real>::Span all{0, std::numeric_limits<Real>::max()};
    for (std::size_t j = 0; j < rays.size; ++j) {
      const Stretch s = stretch(box, origin, rays.direction(j));
      const long double entry = std::max(s.entry, static_cast<long double>(rays.near));
      if (!(entry <= s.exit)) continue;
      ++met;
      bool kept = holds<Real>(span, entry) && holds<Real>(span, s.exit);
      for (const long double range : {entry, s.exit}) {
        const long double at =
            static_cast<long double>(origin[k]) + range * rays.direction(j)[k] - static_cast<long double>(centre[k]);
        if (range <= 0) continue;
        if (at >= static_cast<long double>(wall)) kept = kept && holds<Real>(interval.above(all, k, wall), range);
        if (at <= static_cast<long double>(wall)) kept = kept && holds<Real>(interval.below(all, k, wall), range);
      }
      passed += kept ? 0 : 1;
    }
  }
  CHECK(passed == 0);
  CHECK(met > 100000);
}

TEST_CASE_TEMPLATE(
    "no compact box that any ray of a bundle meets is passed over, also along the axes and all but along them", Real,
    float, double) {
  static constexpr double slight[] = {0, -0.0, 1e-300, -1e-300, 1e-40, -1e-40, 1e-20, -1e-20, 1e-9};
  constexpr std::uint64_t seed = 84;
  CAPTURE(seed);
  Generator random(seed);
  long met = 0, passed = 0, late = 0, spared = 0;
  for (int time = 0; time < 30000; ++time) {
    const double scale = random.log_uniform(1e-6, 1e7);
    const Box bounds = random.box(scale, scale, 2 * scale);
    const Vec3 centre = bounds.centre();
    Box node;  // small or large in its tree
    const double share = random.log_uniform(1e-5, 1);
    node.min = bounds.min + bounds.size() * ((1 - share) * random.uniform());
    node.max = node.min + bounds.size() * share;
    std::vector<Box> boxes;
    Box8<Real> packed;
    for (std::size_t i = 0; i < 8; ++i) {
      Box box;
      for (int k = 0; k < 3; ++k) {
        const double low = random.uniform(0, 0.9), high = random.whole(8) == 0 ? low : random.uniform(low, 1);
        box.min[k] = node.min[k] + low * node.size()[k];
        box.max[k] = node.min[k] + high * node.size()[k];
      }
      boxes.push_back(box);
      packed.put(i, BoundingBox<Real>::around(box, centre));
    }
    const Box& aimed_at = boxes[random.whole(8)];
    const Vec3 aim = aimed_at.min + aimed_at.size() * random.uniform();
    Vec3 direction = random.unit();
    for (int k = 0; k < 3; ++k)
      if (random.whole(3) == 0 && max_norm(direction - direction[k] * Vec3(k == 0, k == 1, k == 2)) > 0.1)
        direction[k] = slight[random.whole(9)];
    const Vec3 origin = aim - direction * (scale * random.log_uniform(1e-3, 1e2));
    RayBundle rays = random.cone(origin, direction, random.coin() ? 0 : 1e-3, 1 + random.whole(19));
    if (random.coin()) rays = bundle_of({origin, direction});
    if (random.coin()) rays.near = length(aim - origin) * random.uniform(0, 1.1);
    const auto check = [&](const auto& interval) {
      const auto [found, entries] = met_by(interval, packed, std::numeric_limits<Real>::max());
      for (std::size_t i = 0; i < 8; ++i) {
        spared += (found >> i & 1U) != 0 ? 0 : 1;
        for (std::size_t j = 0; j < rays.size; ++j) {
          const Stretch s = stretch(boxes[i], origin, rays.direction(j));
          const long double entry = std::max(s.entry, static_cast<long double>(rays.near));
          if (!(entry <= s.exit)) continue;
          ++met;
          if ((found >> i & 1U) == 0)
            ++passed;
          else
            late += static_cast<long double>(entries[i]) > entry ? 1 : 0;
        }
      }
    };
    check(BundleInterval<Real>(rays, bounds, centre));
    if (rays.size == 1) check(RayInterval<Real>(rays, bounds, centre));
  }
  CHECK(passed == 0);
  CHECK(late == 0);
  CHECK(met > 100000);
  CHECK(spared > 50000);  // and some are
}

TEST_CASE_TEMPLATE("the limit of an interval is not below the farthest of the nearest hits", Real, float, double) {
  Generator random(85);
  for (int time = 0; time < 1000; ++time) {
    const RayBundle rays = bundle_of({});
    ClosestHits nearest(rays);
    nearest.offer(0, random.log_uniform(1e-30, 1e30), 0);
    CHECK(static_cast<double>(BundleInterval<Real>(rays, {}, {}).limit(rays, nearest)) >= nearest.range[0]);
    CHECK(static_cast<double>(RayInterval<Real>(rays, {}, {}).limit(rays, nearest)) >= nearest.range[0]);
  }
}

TEST_CASE_TEMPLATE("the range at which a triangle is met is inside the span of its box, however it is seen", Real,
                   float, double) {
  constexpr std::uint64_t seed = 83;
  CAPTURE(seed);
  Generator random(seed);
  long met = 0, outside = 0;
  for (int time = 0; time < 200000; ++time) {
    const double scale = random.log_uniform(1e-6, 1e7);
    Triangle t{random.point(scale), random.point(scale), random.point(scale)};
    if (random.whole(3) == 0)
      t.c = t.a + (t.b - t.a) * random.uniform() + random.point(scale * random.log_uniform(1e-12, 1e-2));
    Vec3 origin = random.point(scale);
    if (random.coin())  // edge on
      origin = t.a + (t.b - t.a) * random.uniform(-3, 3) + (t.c - t.a) * random.uniform(-3, 3) +
               random.point(scale * random.log_uniform(1e-12, 0.1));
    double u = random.uniform(), v = random.uniform(0, 1 - u);
    if (random.whole(5) == 0) u = 0;
    if (random.whole(5) == 0) v = 0;
    const Vec3 aim = t.a + (t.b - t.a) * u + (t.c - t.a) * v;
    const RayBundle rays = random.cone(origin, normalize(aim - origin), random.coin() ? 1e-12 : 1e-4, 4);
    ClosestHits nearest(rays);
    intersect(t, 0, rays, nearest);
    const Box box = t.bounds();
    const Vec3 centre = box.centre();
    const auto span = BundleInterval<Real>(rays, box, centre).inside(BoundingBox<Real>::around(box, centre));
    for (std::size_t j = 0; j < rays.size; ++j) {
      if (!nearest.met(j)) continue;
      ++met;
      outside += holds<Real>(span, static_cast<long double>(nearest.range[j])) ? 0 : 1;
    }
  }
  CHECK(outside == 0);
  CHECK(met > 200000);
}

TEST_CASE_TEMPLATE("rays that are not numbers do not hide what the others meet, and alone they meet nothing", Real,
                   float, double) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Box box{{-1, 4, -1}, {1, 6, 1}};
  const auto around = BoundingBox<Real>::around(box, {});
  RayBundle rays = bundle_of({{}, axis::forward});
  rays.size = 3;
  rays.set_direction(0, {nan, nan, nan});
  rays.set_direction(1, axis::forward);
  rays.set_direction(2, {0, 1, nan});
  rays.pad();
  CHECK(holds<Real>(BundleInterval<Real>(rays, box, {}).inside(around), 5));
  rays.set_direction(1, {nan, nan, nan});
  rays.pad();
  CHECK(BundleInterval<Real>(rays, box, {}).inside(around).empty());
  CHECK(BundleInterval<Real>(bundle_of({{nan, 0, 0}, axis::forward}), box, {}).inside(around).empty());
  Box8<Real> boxes;
  boxes.put(0, around);
  const auto found = [&](const Ray& ray) {
    return met_by(RayInterval<Real>(bundle_of(ray), box, {}), boxes, Real{100}).found;
  };
  CHECK(found({{}, axis::forward}) == 1);
  CHECK(found({{}, {0, 1, nan}}) == 0);
  CHECK(found({{nan, 0, 0}, axis::forward}) == 0);
  CHECK(found({{}, {-0.0, 1, -0.0}}) == 1);
  CHECK(found({{}, axis::forward, -0.0}) == 1);
}

TEST_CASE_TEMPLATE("an empty box is never met", Real, float, double) {
  const Box bounds{{-1, -1, -1}, {1, 1, 1}};
  const auto nothing = BoundingBox<Real>::around(Box{}, {});
  for (const Vec3& d : {axis::right, axis::forward, axis::up, normalize(Vec3{1, 1, 1}), normalize(Vec3{-1, 2, -3})})
    CHECK(BundleInterval<Real>(bundle_of({{}, d}), bounds, {}).inside(nothing).empty());
}
