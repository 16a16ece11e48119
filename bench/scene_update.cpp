// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Cost of a world that changes, in instructions: 10,000 parts placed anew, movers made, a mesh refitted. What is counted happens in the
// functions `update_*`:
//   valgrind --tool=callgrind --toggle-collect='update_*' bench_scene_update
//   callgrind_annotate --inclusive=yes callgrind.out.* | grep update_
// Prints the counts to divide by, and a sum over what was found.

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <memory>
#include <utility>
#include <vector>

#include <pulsecast/pulsecast.hpp>
#include <pulsecast/scene/deforming_mesh.hpp>
#include <pulsecast/scene/moving_scene.hpp>

#include "../examples/tree.hpp"

using namespace pulsecast;

namespace {

using Mesh = TriangleMesh<>;
using World = Scene<Mesh>;

constexpr std::size_t part_count = 10'000, mover_count = 1000;
constexpr std::uint32_t cells = 224;  // 100,352 triangles

std::shared_ptr<const Mesh> tent() {
  return std::make_shared<const Mesh>(
      MeshData{{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {0, 0, 2}}, {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}}});
}

std::vector<Similarity> anywhere(wood::Dice& dice) {
  std::vector<Similarity> all(part_count);
  for (Similarity& one : all)
    one = {rotation_about(axis::up, dice.between(0, 2 * pi)),
           dice.between(0.5, 2),
           {dice.between(-500, 500), dice.between(-500, 500), dice.between(0, 20)}};
  return all;
}

std::vector<Similarity> nudged(std::vector<Similarity> all, wood::Dice& dice) {
  for (Similarity& one : all) one.translation = one.translation + Vec3{dice.between(-1, 1), dice.between(-1, 1), 0};
  return all;
}

std::vector<Vec3> waves(double time) {
  std::vector<Vec3> vertices;
  for (std::uint32_t y = 0; y <= cells; ++y)
    for (std::uint32_t x = 0; x <= cells; ++x) vertices.push_back({x, y, std::sin(0.1 * x + time) + std::cos(0.13 * y + time)});
  return vertices;
}

MeshData sea() {
  MeshData mesh{.vertices = waves(0)};
  for (std::uint32_t y = 0; y < cells; ++y)
    for (std::uint32_t x = 0; x < cells; ++x) {
      const std::uint32_t a = y * (cells + 1) + x, c = a + cells + 1;
      mesh.triangles.push_back({a, a + 1, c + 1});
      mesh.triangles.push_back({a, c + 1, c});
    }
  return mesh;
}

/// Rays from above, over all of the world.
template <class Map>
double sum_of_ranges(const Map& map, double reach) {
  wood::Dice dice(5, 0);
  double sum = 0;
  std::array<Hit, 1> hits;
  for (int i = 0; i < 20'000; ++i) {
    const Vec3 from{dice.between(-reach, reach), dice.between(-reach, reach), 60};
    map.closest(bundle_of({from, normalize(Vec3{dice.between(-1, 1), dice.between(-1, 1), -1})}), hits);
    if (hits[0].met()) sum += hits[0].range;
  }
  return sum;
}

}  // namespace

extern "C" {

[[gnu::noinline]] void update_built(std::vector<World::Part> parts, World& to) { to = World(std::move(parts)); }

[[gnu::noinline]] void update_nudged(const World& world, const std::vector<Similarity>& placements, World& to) {
  to = world.with_placements(placements, std::move(to));
}

[[gnu::noinline]] void update_anywhere(const World& world, const std::vector<Similarity>& placements, World& to) {
  to = world.with_placements(placements, std::move(to));
}

[[gnu::noinline]] void update_movers(std::vector<MovingScene<Mesh>::Part> parts, double& top) {
  top = MovingScene<Mesh>(std::move(parts), {.to = 0.1}).bounds().max.z;
}

[[gnu::noinline]] void update_mesh(DeformingMesh& mesh, const std::vector<Vec3>& vertices) { mesh.refit(vertices); }

[[gnu::noinline]] double update_trace_built(const World& world) { return sum_of_ranges(world, 500); }
[[gnu::noinline]] double update_trace_nudged(const World& world) { return sum_of_ranges(world, 500); }
[[gnu::noinline]] double update_trace_anywhere(const World& world) { return sum_of_ranges(world, 500); }

}  // extern "C"

int main() {
  wood::Dice dice(3, 0);
  const auto shape = tent();
  const std::vector<Similarity> first = anywhere(dice);
  std::vector<World::Part> parts;
  for (const Similarity& placement : first) parts.push_back({.geometry = shape, .placement = placement});
  World now({}), next({});
  update_built(parts, now);
  World unused = now.with_placements(first);
  double sum = update_trace_built(now);
  unused = now.with_placements(first, std::move(unused));
  next = unused.with_placements(first);
  update_nudged(unused, nudged(first, dice), next);
  sum += update_trace_nudged(next);
  for (int tick = 0; tick < 2; ++tick) {  // the first allocates
    World moved = now.with_placements(anywhere(dice), std::move(unused));
    unused = std::exchange(now, std::move(moved));
  }
  next = std::move(unused);
  update_anywhere(now, anywhere(dice), next);
  sum += update_trace_anywhere(next);

  std::vector<MovingScene<Mesh>::Part> movers;
  for (std::size_t i = 0; i < mover_count; ++i)
    movers.push_back({.geometry = shape,
                      .placement = first[i],
                      .motion = std::make_shared<const PartMotion>(
                          SteadyMotion{.velocity = {dice.between(-10, 10), dice.between(-10, 10), 0}, .rate = dice.between(-1, 1)})});
  double top = 0;
  update_movers(std::move(movers), top);

  DeformingMesh mesh(sea(), 1);
  mesh.refit(waves(0.1));
  mesh.refit(waves(0.2));
  update_mesh(mesh, waves(0.3));
  sum += sum_of_ranges(World({{.geometry = mesh.mesh()}}), cells);
  std::printf("%zu parts, %zu movers, %zu triangles; sum %g\n", part_count, mover_count, mesh.mesh()->size(), sum + top);
}
