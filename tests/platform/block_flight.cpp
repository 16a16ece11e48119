// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/platform/block_flight.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include <pulsecast/base/units.hpp>

#include <doctest/doctest.h>

#include "support/generators.hpp"
#include "support/relative.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

TEST_CASE("a block is flown in parallel lines, there and back in turn") {
  // 1000 m to the east by 600 m to the north, lines to the north every 200 m: two reach 450 m, five 1050 m
  const BlockFlight block{
      .area = {{0, 0, 50}, {1000, 600, 90}}, .altitude = 800, .swath = 250, .overlap = 0.2, .speed = 70, .run_in = 100};
  const auto lines = plan_block_flight(block);
  REQUIRE(lines.size() == 5);
  for (std::size_t k = 0; k < lines.size(); ++k) {
    CAPTURE(k);
    const double x = 100 + 200 * static_cast<double>(k);
    const Vec3 south{x, -100, 800}, north{x, 700, 800};
    CHECK(length(lines[k].from - (k % 2 == 0 ? south : north)) < 1e-9);
    CHECK(length(lines[k].to - (k % 2 == 0 ? north : south)) < 1e-9);
    CHECK(lines[k].speed == 70);
  }
}

TEST_CASE("one line is enough for an area that its swath covers") {
  const BlockFlight block{.area = {{0, 0, 0}, {1000, 300, 0}}, .swath = 300, .heading = 90_deg};
  const auto lines = plan_block_flight(block);
  REQUIRE(lines.size() == 1);
  CHECK(length(lines[0].from - Vec3{0, 150, 500}) < 1e-9);
  CHECK(length(lines[0].to - Vec3{1000, 150, 500}) < 1e-9);
}

TEST_CASE("every place of the area lies in the swath of a line, and neighbours overlap as set") {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    BlockFlight block{.area = any.box(1e6, 10, 3000), .heading = any.uniform(-2 * pi, 2 * pi)};
    block.swath = any.log_uniform(20, 2000);
    block.overlap = any.uniform(0, 0.9);
    const auto lines = plan_block_flight(block);
    const auto offset = [](const StraightLine& line,
                           const Vec3& p) {  // to the right of the line, and share of its length
      const Vec3 path = line.to - line.from, d{p.x - line.from.x, p.y - line.from.y, 0};
      return Vec2{dot(d, Vec3{path.y, -path.x, 0}) / length(path), dot(d, path) / dot(path, path)};
    };
    for (std::size_t k = 1; k < lines.size(); ++k) {
      const double apart = std::fabs(offset(lines[k - 1], lines[k].from).x);
      CHECK(apart == support::relative(block.swath * (1 - block.overlap), 1e-6));
    }
    for (int k = 0; k < 50; ++k) {
      const Vec3 p{any.uniform(block.area.min.x, block.area.max.x), any.uniform(block.area.min.y, block.area.max.y), 0};
      CHECK(std::any_of(lines.begin(), lines.end(), [&](const StraightLine& line) {
        const Vec2 o = offset(line, p);
        return std::fabs(o.x) <= block.swath / 2 + 1e-6 && o.y > -1e-9 && o.y < 1 + 1e-9;
      }));
    }
  }
}

TEST_CASE("a block flight refuses what cannot be flown") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Box area{{0, 0, 0}, {100, 100, 0}};
  CHECK_NOTHROW(BlockFlight{.area = area}.validate());
  CHECK_THROWS_AS(BlockFlight{}.validate(), SettingError);
  CHECK_THROWS_AS((BlockFlight{.area = {{0, 0, 0}, {nan, 1, 0}}}.validate()), SettingError);
  CHECK_THROWS_WITH((BlockFlight{.area = {{0, 9, 0}, {1, 4, 0}}}.validate()),
                    "BlockFlight::area (side) is -5 m, but must be at least 0");
  CHECK_NOTHROW(BlockFlight{.area = {{0, 0, 70}, {100, 100, 20}}}.validate());  // its heights are ignored
  CHECK_THROWS_AS((BlockFlight{.area = area, .swath = 0}.validate()), SettingError);
  CHECK_THROWS_AS((BlockFlight{.area = area, .overlap = 1}.validate()), SettingError);
  CHECK_THROWS_AS((BlockFlight{.area = area, .heading = nan}.validate()), SettingError);
  CHECK_THROWS_AS((BlockFlight{.area = area, .speed = -1}.validate()), SettingError);
  CHECK_THROWS_AS((void)plan_block_flight({.area = area, .swath = 1e-9}), SettingError);
}
