// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/scene/detail/moving_index.hpp>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <set>
#include <vector>

#include <doctest/doctest.h>

#include "support/generators.hpp"

using namespace pulsecast;

namespace {

/// A unit cube that flies straight on.
struct Cube {
  Vec3 place{}, velocity{};

  Box at(double t) const { return {place + t * velocity - Vec3(0.5), place + t * velocity + Vec3(0.5)}; }
  Box swept(const Tick& from, const Tick& to) const {
    Box box = at(from.seconds());
    box.extend(at(to.seconds()));
    return box;
  }
};

MovingIndex index_of(const std::vector<Cube>& cubes, const MovingIndexSettings& time) {
  return {cubes.size(), time,
          [&](PrimitiveIndex i, const Tick& from, const Tick& to) { return cubes[i].swept(from, to); },
          [](PrimitiveIndex) { return 1.0; }};
}

/// The cubes that are offered to a ray straight down at a place and time.
std::multiset<PrimitiveIndex> offered(const MovingIndex& index, const Vec2& place, double t) {
  RayBundle ray = bundle_of({{place.x, place.y, 1000}, -axis::up});
  ray.tick = Tick::of_seconds(t);
  ClosestHits nearest(ray);
  std::multiset<PrimitiveIndex> all;
  index.closest(
      ray, [&](PrimitiveIndex i) { all.insert(i); }, nearest);
  return all;
}

}  // namespace

TEST_CASE(
    "what stands at a place at a time is offered there and then, once, whatever its speed and the time's windows") {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    std::vector<Cube> cubes;
    for (std::uint64_t n = 1 + any.whole(20); cubes.size() < n;)
      cubes.push_back({any.point(50), any.log_uniform(1e-3, 1e3) * any.unit()});
    const double from = any.uniform(-10, 1000), to = from + any.log_uniform(0.1, 1000);
    const MovingIndex index = index_of(cubes, {from, to, any.coin() ? std::size_t{1} << 14 : 1 + any.whole(1000)});
    for (int k = 0; k < 50; ++k) {
      const std::size_t i = any.whole(cubes.size());
      const double t = k == 0 ? from : k == 1 ? to : any.uniform(from - 10, to + 10);
      const Vec3 there = cubes[i].at(t).centre();
      if (there.z > 900) continue;
      const auto all = offered(index, {there.x, there.y}, t);
      REQUIRE(all.count(static_cast<PrimitiveIndex>(i)) == 1);
    }
  }
}

TEST_CASE("who moves fast gets windows of its own, and is not offered where it is not") {
  const std::vector<Cube> cubes{{{0, 0, 0}, {10, 0, 0}}, {{0, 50, 0}, {1e-3, 0, 0}}};
  const MovingIndex index = index_of(cubes, {0, 100});
  CHECK(offered(index, {500, 0}, 50).count(0) == 1);
  CHECK(offered(index, {505, 0}, 50).empty());
  CHECK(offered(index, {495, 0}, 50).empty());
  CHECK(offered(index, {0, 50}, 77).count(1) == 1);
  CHECK(index.bounds().max.x > 1000);
}

TEST_CASE("no speed makes the index larger than it may be") {
  const std::size_t most = 5000;
  for (const double speed : {0.1, 10.0, 1e3, 1e6}) {
    CAPTURE(speed);
    std::vector<Cube> cubes;
    for (int k = 0; k < 100; ++k) cubes.push_back({{0, 10.0 * k, 0}, {k % 2 ? speed : speed / 100, 0, 0}});
    const MovingIndex index = index_of(cubes, {0, 1000, most});
    CHECK(index.memory() < most * 200);
    CHECK(offered(index, {500 * speed, 10}, 500).count(1) == 1);
  }
}

TEST_CASE("windows overlap, so that no rounding of a time leaves it between two") {
  const Cube cube{{0, 0, 0}, {10, 0, 0}};
  std::vector<Tick> starts, ends;  // of the windows, as the index asks for them at last
  const auto swept = [&](PrimitiveIndex, const Tick& from, const Tick& to) {
    if (from < to) {
      starts.push_back(from);
      ends.push_back(to);
    }
    return cube.swept(from, to);
  };
  const MovingIndex index(1, {1e9, 1e9 + 64}, swept, [](PrimitiveIndex) { return 1.0; });
  const auto first = static_cast<std::size_t>(std::min_element(starts.begin() + 20, starts.end()) - starts.begin());
  CHECK(starts.size() - first >= 64);
  for (std::size_t w = first + 1; w < starts.size(); ++w) CHECK(starts[w] < ends[w - 1]);
  CHECK(starts[first] < Tick::of_seconds(1e9));
  CHECK(Tick::of_seconds(1e9 + 64) < ends.back());
}

TEST_CASE("outside of the time everything is offered, and of nothing nothing") {
  const std::vector<Cube> cubes{{{0, 0, 0}, {10, 0, 0}}, {{0, 50, 0}, {0, 1, 0}}};
  CHECK(offered(index_of(cubes, {0, 10}), {-1e3, 0}, 11).size() == 2);
  CHECK(offered(index_of(cubes, {0, 10}), {-1e3, 0}, -1).size() == 2);
  CHECK(offered(index_of({}, {0, 10}), {0, 0}, 5).empty());
  CHECK(index_of({}, {0, 10}).bounds().empty());
}

TEST_CASE("time windows refuse a time that is none") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_NOTHROW(MovingIndexSettings{}.validate());
  CHECK_THROWS_AS((MovingIndexSettings{5, 5}.validate()), SettingError);
  CHECK_THROWS_AS((MovingIndexSettings{nan, 5}.validate()), SettingError);
  CHECK_THROWS_AS((MovingIndexSettings{0, nan}.validate()), SettingError);
  CHECK_THROWS_AS((MovingIndexSettings{0, 1, 0}.validate()), SettingError);
}
