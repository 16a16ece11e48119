// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/shape/detail/voxel_index.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <vector>

#include <pulsecast/shape/voxel_grid.hpp>

#include "support/generators.hpp"

using namespace pulsecast;
using namespace pulsecast::support;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Different cells in clusters of all sizes, some far from each other.
VoxelData clusters(Generator& random, std::size_t n, std::uint32_t size) {
  VoxelData data{.corner = {0.5, -8, 100}, .edge = 0.25};
  std::set<std::array<std::uint32_t, 3>> taken;
  std::array<std::uint32_t, 3> cell{};
  while (taken.size() < n) {
    const double reach = random.log_uniform(1, size);
    for (std::uint32_t& c : cell) {
      const double moved = static_cast<double>(c) + random.uniform(-reach, reach);
      c = static_cast<std::uint32_t>(std::clamp(moved, 0.0, size - 1.0));
    }
    if (taken.insert(cell).second) data.cells.push_back(cell);
  }
  return data;
}

struct Visited {
  std::uint32_t number;
  Crossing in, out;
  friend bool operator==(const Visited& a, const Visited& b) {
    return a.number == b.number && a.in.range == b.in.range && a.in.axis == b.in.axis && a.out.range == b.out.range &&
           a.out.axis == b.out.axis;
  }
};

/// What a ray goes through, by asking every cell.
std::vector<Visited> by_every_cell(const VoxelIndex& index, const LatticeRay& ray, double near, double limit) {
  std::vector<Visited> all;
  const Crossing begin{near, Crossing::begin};
  for (std::uint32_t i = 0; i < index.size(); ++i) {
    const LatticeCell c = index.cell(i);
    std::array<double, 3> low, high;
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = c[k];
      high[k] = c[k] + 1;
    }
    LatticeRay::Passage cell = ray.through(low, high);
    if (cell.in.before(begin)) cell.in = begin;
    if (cell.in.before(cell.out) && cell.in.range <= limit) all.push_back({i, cell.in, cell.out});
  }
  std::sort(all.begin(), all.end(), [](const Visited& a, const Visited& b) { return a.in.before(b.in); });
  return all;
}

}  // namespace

TEST_CASE("numbers stand for the cells that the order says") {
  Generator random(442);
  for (const std::uint32_t size : {3U, 20U, 300U, 2097152U}) {
    const VoxelData data = clusters(random, size == 3 ? 20 : 2000, size);
    std::vector<std::uint32_t> order;
    const VoxelIndex index(data, order);
    REQUIRE(index.size() == data.cells.size());
    REQUIRE(order.size() == data.cells.size());
    std::array<std::uint32_t, 3> least = data.cells[0];
    for (const auto& cell : data.cells)
      for (std::size_t k = 0; k < 3; ++k) least[k] = std::min(least[k], cell[k]);
    for (std::uint32_t i = 0; i < index.size(); ++i)
      for (std::size_t k = 0; k < 3; ++k)
        CHECK(static_cast<std::uint32_t>(index.cell(i)[k]) == data.cells[order[i]][k] - least[k]);
  }
}

TEST_CASE("a ray visits every occupied cell that it goes through, in order, and no other") {
  std::size_t visits = 0;
  for (std::uint64_t seed = 443; seed < 453; ++seed) {
    Generator random(seed);
    CAPTURE(seed);
    for (const std::uint32_t size : {4U, 17U, 100U, 1000U, 100000U, 2097152U}) {
      CAPTURE(size);
      const VoxelData data = clusters(random, size == 4 ? 30 : 1 + random.whole(700), size);
      std::vector<std::uint32_t> order;
      const VoxelIndex index(data, order);
      for (int i = 0; i < 150; ++i) {
        const auto place = [&] {
          const LatticeCell c = index.cell(static_cast<std::uint32_t>(random.whole(index.size())));
          const double part = random.coin() ? 0.5 : random.coin() ? 0 : random.uniform();
          return index.bounds().min + index.edge() * (Vec3(c[0], c[1], c[2]) + part);
        };
        Vec3 from = place(), d = place() - from;
        if (random.uniform() < 0.3) d[static_cast<int>(random.whole(3))] = 0;
        if (!(length(d) > 0)) d = {1, random.coin() ? 1 : 0, -1};
        if (random.coin()) from -= d * random.uniform(0, 3);
        RayBundle rays = bundle_of({from, normalize(d)});
        const LatticeRay ray = index.ray(rays, 0);
        const double near = random.coin() ? 0 : random.uniform(0, length(d)),
                     limit = random.coin() ? infinity : near + length(d);
        std::vector<Visited> visited;
        index.walk(ray, near, limit,
                   [&](std::uint32_t number, const LatticeCell& cell, const Crossing& in, const Crossing& out) {
                     CHECK(cell == index.cell(number));
                     visited.push_back({number, in, out});
                     return infinity;
                   });
        CHECK(visited == by_every_cell(index, ray, near, limit));
        visits += visited.size();
      }
    }
  }
  CHECK(visits > 10000);
}

TEST_CASE("a walk ends where its visitor says") {
  VoxelData data{.edge = 1};
  for (std::uint32_t x = 0; x < 40; ++x) data.cells.push_back({x, 0, 0});
  std::vector<std::uint32_t> order;
  const VoxelIndex index(data, order);
  const RayBundle rays = bundle_of({{-1, 0.5, 0.5}, axis::right});
  const auto visits = [&](double limit, auto answer) {
    int n = 0;
    index.walk(index.ray(rays, 0), 0, limit, [&](auto, const LatticeCell&, const Crossing& in, auto) {
      ++n;
      return answer(in);
    });
    return n;
  };
  CHECK(visits(infinity, [](const Crossing&) { return infinity; }) == 40);
  CHECK(visits(infinity, [](const Crossing&) { return -infinity; }) == 1);
  CHECK(visits(10.5, [](const Crossing&) { return infinity; }) == 10);
  CHECK(visits(infinity, [](const Crossing& in) { return in.range == 7 ? 9 : infinity; }) == 9);
  CHECK(visits(0.5, [](const Crossing&) { return infinity; }) == 0);
}

TEST_CASE("a ray that all but stands still ends its walk") {
  VoxelData data{.edge = 1, .cells = {{0, 0, 0}, {9, 9, 9}}};
  std::vector<std::uint32_t> order;
  const VoxelIndex index(data, order);
  for (const Vec3& origin : {Vec3{0.5, 0.5, 0.5}, Vec3{5.5, 5.5, 5.5}})
    for (const Vec3& d : {Vec3{0, 1e-308, 0}, Vec3{0, 1e-320, 0}, Vec3{0, 0, 0}, Vec3{0, -1e-308, 1e-308}}) {
      int n = 0;
      const RayBundle rays = bundle_of({origin, d});
      index.walk(index.ray(rays, 0), 0, infinity, [&](auto, const LatticeCell&, auto, auto) {
        ++n;
        return infinity;
      });
      CHECK(n <= 1);
    }
}
