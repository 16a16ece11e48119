// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Leaves as masks, two triangles each, against the same leaves cut out, alternating: time, memory and gap fraction of a
// crown seen from below, by single rays and by pulses of 19 subrays. Rows are named subrays/shape.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include <pulsecast/pulsecast.hpp>

#include "report.hpp"
#include "scenes.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

namespace {

constexpr int corners = 32;          // of a leaf
constexpr std::uint32_t side = 256;  // of its picture [pixel]

/// Outline of a leaf in a square from -1 to 1, corner by corner, and its mask.
Vec2 corner(int k) { return {0.95 * std::sin(2 * pi * k / corners), 0.55 * std::cos(2 * pi * k / corners)}; }

Mask outline() {
  Mask mask{side, side, std::vector<std::uint64_t>(std::size_t{side} * side / 64)};
  for (std::size_t i = 0; i < std::size_t{side} * side; ++i) {
    const Vec2 at{2 * (double(i % side) + 0.5) / side - 1, 1 - 2 * (double(i / side) + 0.5) / side};
    bool inside = true;
    for (int k = 0; k < corners; ++k) {
      const Vec2 from = corner(k), along = corner(k + 1) - from, to = at - from;
      inside = inside && along.x * to.y - along.y * to.x <= 0;
    }
    if (inside) mask.bits[i / 64] |= std::uint64_t{1} << i % 64;
  }
  return mask;
}

/// Leaves of half a side of 5 cm at random in a crown of 4 m, as masks or cut out.
MeshData crown(std::size_t leaves, bool masked) {
  MeshData data;
  for (std::size_t i = 0; i < leaves; ++i) {
    const auto any = [&](std::uint32_t k) {
      return uniform({.seed = 1, .pulse = i, .subray = k, .purpose = Purpose::scene});
    };
    const double up = 2 * any(0) - 1, turn = 2 * pi * any(1), spin = 2 * pi * any(2), across = std::sqrt(1 - up * up);
    const Vec3 normal{across * std::cos(turn), across * std::sin(turn), up};
    const Vec3 aside = normalize(cross(normal, std::fabs(up) < 0.9 ? axis::up : axis::right)),
               ahead = cross(normal, aside);
    const Vec3 u = 0.05 * (std::cos(spin) * aside + std::sin(spin) * ahead),
               v = 0.05 * (std::cos(spin) * ahead - std::sin(spin) * aside);
    const Vec3 centre{4 * any(3) - 2, 4 * any(4) - 2, 4 * any(5) + 2};
    const auto first = static_cast<std::uint32_t>(data.vertices.size());
    const auto add = [&](const Vec2& at) { data.vertices.push_back(centre + at.x * u + at.y * v); };
    if (masked) {
      for (const Vec2 at : {Vec2{-1, -1}, Vec2{1, -1}, Vec2{1, 1}, Vec2{-1, 1}}) add(at);
      data.triangles.push_back({first, first + 1, first + 2});
      data.triangles.push_back({first, first + 2, first + 3});
      data.texture.push_back({Vec2{0, 0}, {1, 0}, {1, 1}});
      data.texture.push_back({Vec2{0, 0}, {1, 1}, {0, 1}});
    } else {
      for (int k = 0; k < corners; ++k) add(corner(k));
      for (std::uint32_t k = 2; k < corners; ++k) data.triangles.push_back({first, first + k - 1, first + k});
    }
  }
  if (masked) data.masks = {outline()};
  return data;
}

/// Pulses upwards from the ground below the crown.
bench::Bundles from_below(std::size_t subrays, std::size_t count) {
  const SunflowerFootprint footprint(subrays);
  bench::Bundles all;
  for (std::size_t i = 0; i < count; ++i) {
    const auto any = [&](std::uint32_t k) {
      return 2 * uniform({.seed = 2, .pulse = i, .subray = k, .purpose = Purpose::scene}) - 1;
    };
    const Rotation aim =
        rotation_about(axis::right, 90_deg + any(0) * 30_deg) * rotation_about(axis::up, any(1) * 30_deg);
    RayBundle rays;
    rays.origin = {any(2), any(3), 0};
    rays.size = subrays;
    for (std::size_t j = 0; j < subrays; ++j)
      rays.set_direction(j, aim * subray_direction(footprint.offset(j), 0.5_mrad));
    rays.pad();
    all.add(rays);
  }
  return all;
}

double gap_fraction(const auto& mesh, const bench::Bundles& all) {
  std::size_t gaps = 0, rays = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    ClosestHits nearest(all[i]);
    mesh.closest(all[i], nearest);
    for (std::size_t j = 0; j < all[i].size; ++j) gaps += nearest.met(j) ? 0 : 1;
    rays += all[i].size;
  }
  return static_cast<double>(gaps) / static_cast<double>(rays);
}

}  // namespace

int main(int count, char** words) {
  bench::Report report("masks", count, words);
  const MaskedMesh<> masked(crown(20'000, true));
  const TriangleMesh<> cut(crown(20'000, false));
  report.heading("20,000 leaves");
  for (const std::size_t subrays : {std::size_t{1}, std::size_t{19}}) {
    const bench::Bundles all = from_below(subrays, 400'000 / subrays);
    const std::vector<bench::Times> times = report.by_turns({[&] { bench::keep(bench::sum_of_ranges(cut, all)); },
                                                             [&] { bench::keep(bench::sum_of_ranges(masked, all)); }});
    const std::string number = std::to_string(subrays);
    const double rays = static_cast<double>(all.size() * subrays), gaps = gap_fraction(cut, all);
    report.row(number + "/cut", {{"Mrays/s", rays / bench::median(times[0]) / 1e6}, {"gap fraction", gaps}});
    report.row(number + "/masked", {{"Mrays/s", rays / bench::median(times[1]) / 1e6},
                                    {"gap fraction", gap_fraction(masked, all)},
                                    {"difference", gap_fraction(masked, all) - gaps},
                                    {"times the cost of cut ones", bench::median(times[1]) / bench::median(times[0])}});
  }
  report.row("memory", {{"MB masked", static_cast<double>(masked.memory()) / 1e6},
                        {"MB cut", static_cast<double>(cut.memory()) / 1e6}});
}
