// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/material/media.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <doctest/doctest.h>

#include "support/generators.hpp"

using namespace pulsecast;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

struct Stretch {
  double from, to, absorption, density;
};

std::vector<Stretch> stretches(const Media& media, const Vec3& origin, const Vec3& direction, double near, double far) {
  std::vector<Stretch> all;
  media.along(origin, direction, near, far, [&](double from, double to, const MediumRegion& region, double density) {
    all.push_back({from, to, region.medium.absorption, density});
  });
  return all;
}

Medium grey(double absorption) { return {.absorption = absorption}; }

}  // namespace

TEST_CASE("a ray passes the innermost medium at each of its points") {
  const Media media({{.medium = grey(3), .bounds = {{-1, -1, -1}, {1, 1, 1}}},
                     {.medium = grey(1)},
                     {.medium = grey(2), .bounds = {{-5, -5, -5}, {5, 5, 5}}},
                     {.medium = grey(4), .bounds = {{10, -1, -1}, {11, 1, 1}}}});
  const auto all = stretches(media, {-20, 0, 0}, {1, 0, 0}, 2, 40);
  const std::vector<Stretch> expected{{2, 15, 1, 1},  {15, 19, 2, 1}, {19, 21, 3, 1}, {21, 25, 2, 1},
                                      {25, 30, 1, 1}, {30, 31, 4, 1}, {31, 40, 1, 1}};
  REQUIRE(all.size() == expected.size());
  for (std::size_t k = 0; k < all.size(); ++k) {
    CHECK(all[k].from == doctest::Approx(expected[k].from));
    CHECK(all[k].to == doctest::Approx(expected[k].to));
    CHECK(all[k].absorption == expected[k].absorption);
  }
  const auto up = stretches(media, {0, 0, 0}, {0, 0, 1}, 0, infinity);
  REQUIRE(up.size() == 3);
  CHECK(up.back().to == infinity);
  CHECK(stretches(Media{}, {}, {0, 0, 1}, 0, infinity).empty());
  CHECK(stretches(media, {0, 0, 0}, {0, 0, 1}, 5, 5).empty());
}

TEST_CASE("the cells of a region are met as points along the ray find them") {
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    MediumRegion region{.medium = grey(1), .cells = {3, 4, 5}};
    const Vec3 low = any.point(10);
    region.bounds = {low, low + Vec3{any.uniform(1, 9), any.uniform(1, 9), any.uniform(1, 9)}};
    std::vector<float> densities(60);
    for (float& density : densities) density = any.coin() ? 0 : static_cast<float>(any.uniform(0.1, 2));
    region.densities = densities;
    const Media media({region});
    const Vec3 origin = any.point(12), direction = any.unit();
    const double near = any.uniform(0, 5), far = near + any.uniform(0, 30);
    double optical = 0;
    for (const Stretch& s : stretches(media, origin, direction, near, far)) {
      CHECK(s.from >= near);
      CHECK(s.to <= far);
      optical += s.density * (s.to - s.from);
    }
    double expected = 0;
    const int steps = 40000;
    for (int k = 0; k < steps; ++k) {
      const Vec3 p = origin + (near + (k + 0.5) / steps * (far - near)) * direction - region.bounds.min,
                 size = region.bounds.size();
      if (p.x < 0 || p.y < 0 || p.z < 0 || p.x >= size.x || p.y >= size.y || p.z >= size.z) continue;
      const auto cell = [&](int axis, std::size_t count) {
        return static_cast<std::size_t>(p[axis] / size[axis] * static_cast<double>(count));
      };
      expected += static_cast<double>(densities[cell(0, 3) + 3 * (cell(1, 4) + 4 * cell(2, 5))]) * (far - near) / steps;
    }
    CHECK(std::fabs(optical - expected) < 0.01);
  }
}

TEST_CASE("media that cannot be are refused, with the number of their region") {
  CHECK_THROWS_AS(Media({{.medium = {.index = 1.3}}}), SettingError);
  CHECK_THROWS_AS(Media({{.medium = {.absorption = -1}}}), SettingError);
  CHECK_THROWS_AS(Media({{.medium = {.scattering = -1}}}), SettingError);
  CHECK_THROWS_AS(Media({{.medium = {.scattering = 0.1, .backscatter = 0.2}}}), SettingError);
  CHECK_THROWS_AS(Media({{.bounds = Box{}}}), SettingError);
  CHECK_THROWS_AS(Media({{.densities = std::vector<float>{1}}}), SettingError);
  CHECK_THROWS_AS(Media({{.bounds = {{0, 0, 0}, {1, 1, 1}}, .cells = {1, 2, 1}, .densities = std::vector<float>{1}}}),
                  SettingError);
  CHECK_THROWS_AS(Media({{.bounds = {{0, 0, 0}, {1, 1, 1}}, .densities = std::vector<float>{-1}}}), SettingError);
  const MediumRegion a{.bounds = {{0, 0, 0}, {2, 2, 2}}}, b{.bounds = {{1, 1, 1}, {3, 3, 3}}},
      c{.bounds = {{2, 0, 0}, {3, 1, 1}}};
  CHECK_THROWS_WITH_AS(Media({a, b}),
                       "Media (region) is 1, but must be one that is inside another, around it, or apart from it",
                       SettingError);
  CHECK_THROWS_AS(Media({a, a}), SettingError);
  CHECK_NOTHROW(Media({a, c}));
}
