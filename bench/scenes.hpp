// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <variant>
#include <vector>

#include <pulsecast/material/variation.hpp>
#include <pulsecast/pulsecast.hpp>
#include <pulsecast/shape/height_field.hpp>

#include "../examples/street.hpp"
#include "../examples/tree.hpp"

/// Scenes and pulses of the benchmarks.
namespace bench {

using namespace pulsecast;
using namespace pulsecast::literals;

/// Rough hills, 1 km by 1 km about the origin; two triangles a cell.
[[nodiscard]] inline Raster hills(std::uint32_t cells) {
  Raster raster{.columns = cells + 1, .rows = cells + 1, .first = {-500, 500}, .pixel = {1_km / cells, 1_km / cells}};
  raster.heights.reserve(std::size_t{raster.columns} * raster.rows);
  for (std::uint32_t r = 0; r <= cells; ++r)
    for (std::uint32_t c = 0; c <= cells; ++c) {
      const double x = c * raster.pixel.x, y = r * raster.pixel.y;
      const double rough = uniform({.seed = 1, .pulse = raster.heights.size(), .purpose = Purpose::scene});
      raster.heights.push_back(
          static_cast<float>(20 * std::sin(x / 90) * std::cos(y / 70) + 2 * std::sin(x / 7 + y / 11) + 0.2 * rough));
    }
  return raster;
}

[[nodiscard]] inline MeshData tree() { return wood::broadleaf({}, wood::Dice(1, 0)); }

/// The parts of a scene as one mesh.
template <class Mesh>
[[nodiscard]] MeshData flattened(const Scene<Mesh>& scene) {
  MeshData all;
  for (const auto& part : scene.parts()) {
    const Mesh& mesh = *part.geometry;
    for (std::size_t i = 0; i < mesh.size(); ++i) {
      const Triangle t = mesh.triangle(static_cast<PrimitiveIndex>(i));
      const auto first = static_cast<std::uint32_t>(all.vertices.size());
      for (const Vec3& corner : {t.a, t.b, t.c}) all.vertices.push_back(part.placement.point(corner));
      all.triangles.push_back({first, first + 1, first + 2});
    }
  }
  return all;
}

[[nodiscard]] inline Box bounds_of(const MeshData& mesh) {
  Box box;
  for (const Vec3& vertex : mesh.vertices) box.extend(vertex);
  return box;
}

/// Origin and direction of a pulse: the y axis of its own frame.
struct Aim {
  Vec3 place;
  Rotation rotation;
};
using Aims = std::vector<Aim>;

inline constexpr std::size_t pulse_count = 4096;

/// From an airplane that flies north over a square of 1 km, 1,250 m above its middle: lines across, a pulse a metre.
[[nodiscard]] inline Aims from_the_air() {
  constexpr std::size_t lines = 4, in_line = pulse_count / lines;
  Aims all;
  for (std::size_t line = 0; line < lines; ++line)
    for (std::size_t i = 0; i < in_line; ++i) {
      const double across = -480 + 960.0 * static_cast<double>(i) / in_line,
                   along = -450 + 900.0 * static_cast<double>(line) / lines;
      const double y = along + 50.0 / lines * static_cast<double>(i) / in_line;
      all.push_back({{0, y, 1250},
                     rotation_about(axis::forward, -std::atan(across / 1250)) * rotation_about(axis::right, -90_deg)});
    }
  return all;
}

/// From a tripod beside something: up and down in steps of azimuth, as far as its box reaches.
[[nodiscard]] inline Aims from_a_tripod(const Box& box) {
  constexpr std::size_t sweeps = 4, in_sweep = pulse_count / sweeps;
  const Vec3 place{box.max.x + 0.5 * box.size().z, box.centre().y, box.min.z + 1.7};
  double min_turn = 0, max_turn = 0, low = 90_deg, high = -90_deg;
  for (int i = 0; i < 8; ++i) {
    const Vec3 to =
        Vec3{i & 1 ? box.min.x : box.max.x, i & 2 ? box.min.y : box.max.y, i & 4 ? box.min.z : box.max.z} - place;
    const double turn = std::atan2(to.y, -to.x), elevation = std::atan2(to.z, std::hypot(to.x, to.y));
    min_turn = std::min(min_turn, turn);
    max_turn = std::max(max_turn, turn);
    low = std::min(low, elevation);
    high = std::max(high, elevation);
  }
  Aims all;
  for (std::size_t sweep = 0; sweep < sweeps; ++sweep)
    for (std::size_t i = 0; i < in_sweep; ++i) {
      const double turn = std::lerp(min_turn, max_turn, (static_cast<double>(sweep) + 0.5) / sweeps);
      const double share = static_cast<double>(i) / in_sweep,
                   elevation = std::lerp(low, high, sweep % 2 == 0 ? share : 1 - share);
      all.push_back({place, rotation_about(axis::up, 90_deg - turn) * rotation_about(axis::right, elevation)});
    }
  return all;
}

/// From a car that drives north: whole turns about the line of travel.
[[nodiscard]] inline Aims from_a_car() {
  constexpr std::size_t turns = 4, in_turn = pulse_count / turns;
  Aims all;
  for (std::size_t i = 0; i < pulse_count; ++i) {
    const double turn = static_cast<double>(i) / in_turn, y = -70 + 140 * turn / turns;
    const Vec3 place = street::on({2, y}) + Vec3{0, 0, 2.3};
    all.push_back({place, rotation_about(axis::forward, 360_deg * turn) * rotation_about(axis::right, -90_deg)});
  }
  return all;
}

/// Bundles side by side, each in as much memory as it needs, so that reading many of them costs little. A requested one
/// is made in place, as in a survey: in the nearest cache, and with the ranges of directions found by `pad`.
class Bundles {
 public:
  void add(const RayBundle& rays) {
    origins_.push_back(rays);
    first_.push_back(directions_.size());
    for (const RayBundle::Column* column : {&rays.x, &rays.y, &rays.z})
      directions_.insert(directions_.end(), column->begin(), column->begin() + static_cast<std::ptrdiff_t>(rays.size));
  }

  [[nodiscard]] std::size_t size() const noexcept { return origins_.size(); }
  [[nodiscard]] RayBundle operator[](std::size_t i) const noexcept {
    RayBundle rays(origins_[i]);
    const double* from = directions_.data() + first_[i];
    for (RayBundle::Column* column : {&rays.x, &rays.y, &rays.z}) {
      std::copy_n(from, rays.size, column->data());
      from += rays.size;
    }
    rays.pad();
    return rays;
  }

  /// The first ray of bundle i, alone.
  [[nodiscard]] SingleRayPacket ray(std::size_t i) const noexcept {
    const BundleOrigin& from = origins_[i];
    const double* const d = directions_.data() + first_[i];
    return SingleRayPacket(
        Ray{.origin = from.origin, .direction = {d[0], d[from.size], d[2 * from.size]}, .near = from.near});
  }

  /// Some of them, from everywhere among them.
  [[nodiscard]] Bundles sample(std::size_t count) const {
    Bundles some;
    for (std::size_t i = 0; i < count; ++i) some.add((*this)[(2 * i + 1) * size() / (2 * count)]);
    return some;
  }

 private:
  std::vector<BundleOrigin> origins_;
  std::vector<std::size_t> first_;  ///< of its directions
  std::vector<double> directions_;  ///< of a bundle: x, y, z
};

/// The beams of pulses; a beam of more subrays than a bundle holds comes in several.
[[nodiscard]] inline Bundles beams(const Aims& aims, std::size_t subrays, double divergence) {
  const SunflowerFootprint footprint(subrays);
  Bundles all;
  for (const Aim& aim : aims)
    for (std::size_t first = 0; first < subrays; first += RayBundle::capacity) {
      RayBundle rays;
      rays.origin = aim.place;
      rays.size = std::min(subrays - first, RayBundle::capacity);
      rays.first_subray = static_cast<std::uint32_t>(first);
      for (std::size_t j = 0; j < rays.size; ++j)
        rays.set_direction(j, aim.rotation * subray_direction(footprint.offset(first + j), divergence));
      rays.pad();
      all.add(rays);
    }
  return all;
}

/// Single rays from anywhere in a box to anywhere.
[[nodiscard]] inline Bundles incoherent_rays(const Box& box, std::size_t count) {
  wood::Dice dice(17, 0);
  Bundles all;
  for (std::size_t i = 0; i < count; ++i) {
    Ray ray;
    for (int k = 0; k < 3; ++k) ray.origin[k] = dice.between(box.min[k], box.max[k]);
    const double z = dice.between(-1, 1), turn = dice.between(0, 2 * pi), aside = std::sqrt(1 - z * z);
    ray.direction = {aside * std::cos(turn), aside * std::sin(turn), z};
    all.add(bundle_of(ray));
  }
  return all;
}

/// Single rays of a camera with 128 x 128 pixels, line by line.
[[nodiscard]] inline Bundles camera_rays(const Vec3& eye, const Vec3& at) {
  constexpr int pixels = 128;
  const Vec3 ahead = normalize(at - eye), right = normalize(cross(ahead, axis::up)), up = cross(right, ahead);
  Bundles all;
  for (int y = 0; y < pixels; ++y)
    for (int x = 0; x < pixels; ++x)
      all.add(bundle_of(
          {.origin = eye, .direction = normalize(ahead + ((x - 63.5) / 110) * right + ((63.5 - y) / 110) * up)}));
  return all;
}

/// Single rays from what others hit towards the sun.
template <class Shape>
[[nodiscard]] Bundles shadow_rays(const Shape& shape, const Bundles& rays) {
  Bundles all;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const RayBundle from = rays[i];
    ClosestHits nearest(from);
    shape.closest(from, nearest);
    if (nearest.met(0))
      all.add(bundle_of({.origin = from.origin + nearest.range[0] * from.direction(0),
                         .direction = normalize(Vec3{0.5, 0.3, 0.6}),
                         .near = 1e-3}));
  }
  return all;
}

/// Traces them all; the sum of ranges is there so that no work is left out.
template <class Shape>
double sum_of_ranges(const Shape& shape, const Bundles& all) noexcept {
  double sum = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const RayBundle rays = all[i];
    ClosestHits nearest(rays);
    shape.closest(rays, nearest);
    for (std::size_t j = 0; j < rays.size; ++j) sum += nearest.met(j) ? nearest.range[j] : 0;
  }
  return sum;
}

/// Hits of every ray of some bundles: range, and number of the primitive.
struct Answer {
  double range;
  std::uint64_t id;
  friend bool operator==(const Answer&, const Answer&) = default;
};
template <class Shape>
[[nodiscard]] std::vector<Answer> answers(const Shape& shape, const Bundles& all) {
  std::vector<Answer> found;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const RayBundle rays = all[i];
    ClosestHits nearest(rays);
    shape.closest(rays, nearest);
    for (std::size_t j = 0; j < rays.size; ++j) found.push_back({nearest.range[j], nearest.id[j]});
  }
  return found;
}
/// Hit of one ray by itself: the closest, or any, whose range and number are not known and given as 0.
template <class Shape>
[[nodiscard]] Answer answer_alone(const Shape& shape, const SingleRayPacket& ray, bool any) noexcept {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (any) {
    AnyHit hit(infinity);
    shape.closest(ray, hit);
    return {hit.found ? 0 : infinity, 0};
  }
  ClosestHit nearest(infinity);
  shape.closest(ray, nearest);
  return {nearest.range[0], nearest.id[0]};
}

}  // namespace bench
