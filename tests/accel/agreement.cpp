// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <string>
#include <vector>

#include <pulsecast/accel/bvh.hpp>
#include <pulsecast/accel/kd_tree.hpp>
#include <pulsecast/accel/linear.hpp>
#include <pulsecast/shape/triangle_mesh.hpp>

#include "support/scenes.hpp"

// The law of `Accelerator`, one implementation against another: the trees find what testing all finds, bit for bit.

using namespace pulsecast;
using namespace pulsecast::support;

namespace {

const Vec3 utm{4.7e5, 5.4e6, 300};

/// A tree that was told of boxes smaller than what they hold.
struct ShrunkBvh : Bvh<float> {
  explicit ShrunkBvh(std::span<const Box> boxes) : Bvh(shrunk(boxes)) {}
  static std::vector<Box> shrunk(std::span<const Box> boxes) {
    std::vector<Box> all(boxes.begin(), boxes.end());
    for (Box& box : all) box.max = box.max - box.size() * 1e-3;
    return all;
  }
};

/// A tree that passes over every seventh primitive.
struct HastyBvh : Bvh<float> {
  using Bvh::Bvh;
  template <class Test>
  void closest(const RayBundle& rays, const Test& test, ClosestHits& nearest) const noexcept {
    Bvh::closest(
        rays,
        [&](std::span<const PrimitiveIndex> p) {
          if (p[0] % 7 != 0) test(p);
        },
        nearest);
  }
};

Comparison all_trees(const MeshData& data, std::uint64_t seed, std::size_t times) {
  const TriangleMesh<Linear<>> all(data);
  const TriangleMesh<Bvh<>> bvh(data);
  const TriangleMesh<Bvh<double>> exact_bvh(data);
  const TriangleMesh<KdTree<>> kd_tree(data);
  const TriangleMesh<KdTree<double>> exact_kd_tree(data);
  Generator random(seed);
  Comparison result;
  for (std::size_t time = 0; time < times; ++time) {
    for (const std::size_t size : {1U, 1U, 1U, 19U, 64U}) {
      const RayBundle rays = bundle(random, data, all.bounds(), size);
      Comparison others;  // counted once, compared four times
      compare(all, bvh, "Bvh<float>", rays, result);
      compare(all, exact_bvh, "Bvh<double>", rays, others);
      compare(all, kd_tree, "KdTree<float>", rays, others);
      compare(all, exact_kd_tree, "KdTree<double>", rays, others);
      if (others.different > 0 && result.different == 0) result.first = others.first;
      result.different += others.different;
    }
  }
  return result;
}

}  // namespace

TEST_CASE("all accelerators find the same triangle at the same range, bit for bit, for a million rays") {
  struct Scene {
    std::string name;
    MeshData data;
  };
  Generator random(20);
  const std::vector<Scene> scenes{
      {"soup", soup(random, 300, 10)},
      {"a millimetre of soup", soup(random, 300, 1e-3)},
      {"a thousand kilometres of soup", soup(random, 300, 1e6)},
      {"soup far from the origin", moved(soup(random, 300, 100), utm)},
      {"slivers", slivers(random, 300, 10)},
      {"slivers far from the origin", moved(slivers(random, 300, 10), utm)},
      {"every triangle twice", doubled(soup(random, 150, 10))},
      {"a plane of squares", doubled(plane(10))},
      {"a plane of squares far from the origin", moved(plane(12), utm)},
      {"walls along the axes", walls(random, 300, 8)},
      {"a fan of needles", spindle(150, 5, 1e-3)},
      {"a fan of needles far from the origin", moved(spindle(150, 5, 20), utm)},
      {"a sphere", icosphere(2)},
      {"bumpy ground", moved(block(random, 6), utm)},
  };
  std::uint64_t rays = 0;
  for (std::size_t s = 0; s < scenes.size(); ++s) {
    const Comparison result = all_trees(scenes[s].data, 100 + s, 850);
    CAPTURE(scenes[s].name);
    CAPTURE(100 + s);
    INFO(result.first);
    CHECK(result.different == 0);
    CHECK(result.met * 10 > result.rays);
    rays += result.rays;
  }
  CHECK(rays >= 1000000);
}

TEST_CASE("the comparison notices a tree of boxes that are a thousandth too small, and one that skips primitives") {
  Generator random(21);
  const MeshData data = doubled(soup(random, 150, 10));
  const TriangleMesh<Linear<>> all(data);
  const TriangleMesh<ShrunkBvh> shrunk(data);
  const TriangleMesh<HastyBvh> hasty(data);
  Comparison of_shrunk, of_hasty;
  for (int time = 0; time < 300; ++time) {
    const RayBundle rays = bundle(random, data, all.bounds(), 19);
    compare(all, shrunk, "shrunk", rays, of_shrunk);
    compare(all, hasty, "hasty", rays, of_hasty);
  }
  CHECK(of_shrunk.different > 0);
  CHECK(of_hasty.different > 0);
}
