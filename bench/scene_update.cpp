// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Cost of a world that changes, in instructions: 10,000 parts placed anew, 10,000 movers of each kind of motion made
// (1,000 where they need windows of time), a mesh refitted. What is counted happens in the functions `update_*`, on one
// thread:
//   bash bench/count.sh scene_update update
// Prints the counts to divide by, and a sum over what was found.

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include <pulsecast/pulsecast.hpp>
#include <pulsecast/scene/moving_scene.hpp>
#include <pulsecast/shape/deforming_mesh.hpp>

#include "../examples/tree.hpp"

using namespace pulsecast;

namespace {

using Mesh = TriangleMesh<>;
using World = Scene<Mesh>;
using Movers = MovingScene<Mesh>;

constexpr std::size_t part_count = 10'000;
constexpr std::uint32_t cells = 224;  // 100,352 triangles

std::shared_ptr<const Mesh> tent() {
  return std::make_shared<const Mesh>(MeshData{{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {0, 0, 2}},
                                               {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}}});
}

std::vector<Placement> anywhere(wood::Dice& dice) {
  std::vector<Placement> all(part_count);
  for (Placement& one : all)
    one = {rotation_about(axis::up, dice.between(0, 2 * pi)),
           dice.between(0.5, 2),
           {dice.between(-500, 500), dice.between(-500, 500), dice.between(0, 20)}};
  return all;
}

std::vector<Placement> nudged(std::vector<Placement> all, wood::Dice& dice) {
  for (Placement& one : all) one.translation = one.translation + Vec3{dice.between(-1, 1), dice.between(-1, 1), 0};
  return all;
}

std::vector<Vec3> waves(double time) {
  std::vector<Vec3> vertices;
  for (std::uint32_t y = 0; y <= cells; ++y)
    for (std::uint32_t x = 0; x <= cells; ++x)
      vertices.push_back({x, y, std::sin(0.1 * x + time) + std::cos(0.13 * y + time)});
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

/// A motion of each kind: at rest, along a line, on a screw about the part's own centre, and between poses twice in the
/// time.
enum class Kind { rest, steady, screw, keyed };

std::shared_ptr<const PartMotion> motion(Kind kind, wood::Dice& dice) {
  const auto speed = [&] { return Vec3{dice.between(-10, 10), dice.between(-10, 10), 0}; };
  if (kind == Kind::rest) return std::make_shared<const PartMotion>(std::vector<TimedPose>{{0, speed(), no_rotation}});
  if (kind == Kind::steady) return std::make_shared<const PartMotion>(SteadyMotion{.velocity = speed()});
  if (kind == Kind::screw)
    return std::make_shared<const PartMotion>(SteadyMotion{.velocity = speed(), .angular_rate = dice.between(-1, 1)});
  const Vec3 to = 0.05 * speed(), from{};
  const Rotation turned = rotation_about(axis::up, dice.between(-1e-4, 1e-4));  // about the world's origin
  return std::make_shared<const PartMotion>(
      std::vector<TimedPose>{{0, from, no_rotation}, {0.05, to, turned}, {1, from, no_rotation}});
}

std::vector<Movers::Part> movers(const std::shared_ptr<const Mesh>& shape, std::span<const Placement> placements,
                                 Kind kind, wood::Dice& dice) {
  std::vector<Movers::Part> all;
  for (const Placement& placement : placements)
    all.push_back({.geometry = shape, .placement = placement, .motion = motion(kind, dice)});
  return all;
}

/// Rays from above, over all of the world and a time.
template <class Map>
double sum_of_ranges(const Map& map, double reach, double seconds = 0) {
  wood::Dice dice(5, 0);
  double sum = 0;
  std::array<Hit, 1> hits;
  for (int i = 0; i < 20'000; ++i) {
    const Vec3 from{dice.between(-reach, reach), dice.between(-reach, reach), 60};
    const Vec3 direction = normalize(Vec3{dice.between(-1, 1), dice.between(-1, 1), -1});
    map.closest(bundle_of({.origin = from, .direction = direction, .tick = Tick::of_seconds(seconds * i / 20'000)}),
                hits);
    if (hits[0].met()) sum += hits[0].range;
  }
  return sum;
}

}  // namespace

extern "C" {

[[gnu::noinline]] void update_built(std::vector<World::Part> parts, World& to) { to = World(std::move(parts), 1); }

[[gnu::noinline]] void update_nudged(const World& world, const std::vector<Placement>& placements, World& to) {
  to = world.with_placements(placements, std::move(to), 1);
}

[[gnu::noinline]] void update_anywhere(const World& world, const std::vector<Placement>& placements, World& to) {
  to = world.with_placements(placements, std::move(to), 1);
}

[[gnu::noinline]] void update_movers_at_rest(std::vector<Movers::Part> parts, Movers& to) {
  to = Movers(std::move(parts), {.to = 0.1}, 1);
}
[[gnu::noinline]] void update_movers_steady(std::vector<Movers::Part> parts, Movers& to) {
  to = Movers(std::move(parts), {.to = 0.1}, 1);
}
[[gnu::noinline]] void update_movers_screws(std::vector<Movers::Part> parts, Movers& to) {
  to = Movers(std::move(parts), {.to = 0.1}, 1);
}
[[gnu::noinline]] void update_movers_keyed(std::vector<Movers::Part> parts, Movers& to) {
  to = Movers(std::move(parts), {.to = 0.1}, 1);
}
[[gnu::noinline]] void update_movers_windows(std::vector<Movers::Part> parts, Movers& to) {
  to = Movers(std::move(parts), {.to = 10}, 1);
}

[[gnu::noinline]] void update_mesh(DeformingMesh<>& mesh, const std::vector<Vec3>& vertices) { mesh.refit(vertices, 1); }

[[gnu::noinline]] double update_trace_movers(const Movers& movers, double seconds) {
  return sum_of_ranges(movers, 500, seconds);
}
[[gnu::noinline]] double update_trace_windows(const Movers& movers, double seconds) {
  return sum_of_ranges(movers, 500, seconds);
}
[[gnu::noinline]] double update_trace_built(const World& world) { return sum_of_ranges(world, 500); }
[[gnu::noinline]] double update_trace_nudged(const World& world) { return sum_of_ranges(world, 500); }
[[gnu::noinline]] double update_trace_anywhere(const World& world) { return sum_of_ranges(world, 500); }

}  // extern "C"

int main() {
  wood::Dice dice(3, 0);
  const auto shape = tent();
  const std::vector<Placement> first = anywhere(dice);
  std::vector<World::Part> parts;
  for (const Placement& placement : first) parts.push_back({.geometry = shape, .placement = placement});
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

  Movers rest({}, {}, 1), steady = rest, screws = rest, keyed = rest, windows = rest;
  update_movers_at_rest(movers(shape, first, Kind::rest, dice), rest);
  update_movers_steady(movers(shape, first, Kind::steady, dice), steady);
  update_movers_screws(movers(shape, first, Kind::screw, dice), screws);
  update_movers_keyed(movers(shape, first, Kind::keyed, dice), keyed);
  update_movers_windows(movers(shape, std::span(first).first(1000), Kind::screw, dice), windows);
  for (const Movers* some : {&rest, &steady, &screws, &keyed}) sum += update_trace_movers(*some, 0.1);
  sum += update_trace_windows(windows, 10);

  DeformingMesh mesh(sea(), 1);
  mesh.refit(waves(0.1), 1);
  mesh.refit(waves(0.2), 1);
  update_mesh(mesh, waves(0.3));
  sum += sum_of_ranges(World({{.geometry = mesh.mesh()}}), cells);
  std::printf("%zu parts, %zu movers, %zu triangles; sum %g\n", part_count, first.size(), mesh.mesh()->size(), sum);
}
