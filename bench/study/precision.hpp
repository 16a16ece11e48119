// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <pulsecast/pulsecast.hpp>
#include <pulsecast/shape/height_field.hpp>

#include "../../examples/wood.hpp"
#include "../report.hpp"
#include "../scenes.hpp"
#include "errors.hpp"

/// `float` against `double` on scenes of 10 km.
namespace tradeoff {

/// Ten kilometres of hills about a place, in cells of 10 m.
[[nodiscard]] inline MeshData ten_kilometres(const Vec3& place) {
  constexpr std::uint32_t cells = 1000;
  constexpr double side = 10e3;
  Raster raster{.columns = cells + 1,
                .rows = cells + 1,
                .first = {place.x - side / 2, place.y + side / 2},
                .pixel = {side / cells, side / cells}};
  for (std::uint32_t r = 0; r <= cells; ++r)
    for (std::uint32_t c = 0; c <= cells; ++c)
      raster.heights.push_back(static_cast<float>(place.z + 300 * wood::noise(21, c / 160.0, r / 160.0) +
                                                  20 * wood::noise(22, c / 9.0, r / 9.0) +
                                                  2 * wood::noise(23, c / 1.3, r / 1.3)));
  return raster.mesh();
}

/// Beams of 19 from 1,500 m above anywhere in a scene, to anywhere in it: steep and grazing.
[[nodiscard]] inline bench::Bundles beams_across(const Box& box, std::size_t count) {
  wood::Dice dice(23, 0);
  const LatticeFootprint footprint(19);
  bench::Bundles all;
  for (std::size_t i = 0; i < count; ++i) {
    const auto anywhere = [&](double z) {
      return Vec3{dice.between(box.min.x, box.max.x), dice.between(box.min.y, box.max.y), z};
    };
    const Vec3 place = anywhere(box.max.z + 1500), towards = normalize(anywhere(box.centre().z) - place);
    const Rotation rotation =
        rotation_about(axis::up, std::atan2(-towards.x, towards.y)) * rotation_about(axis::right, std::asin(towards.z));
    RayBundle rays;
    rays.origin = place;
    rays.size = footprint.size();
    for (std::size_t j = 0; j < rays.size; ++j)
      rays.set_direction(j, rotation * subray_direction(footprint.offset(j), 0.3e-3));
    rays.pad();
    all.add(rays);
  }
  return all;
}

inline void measure_precision(bench::Report& report) {
  if (!report.wanted("precision")) return;
  report.heading("float against double: hills of 10 km, beams of 19 from 1,500 m above them to anywhere");
  for (const auto& [name, place] :
       {std::pair{"about the origin", Vec3{}}, std::pair{"at UTM coordinates", Vec3{512'000, 5'403'000, 300}}}) {
    const MeshData data = ten_kilometres(place);
    const TriangleMesh<Bvh<float>> single(data);
    const TriangleMesh<Bvh<double>> exact(data);
    const bench::Bundles beams = beams_across(single.bounds(), 20'000);
    const auto a = bench::answers(single, beams), b = bench::answers(exact, beams);
    std::vector<double> differences;
    std::size_t others = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      const bool met = a[i].id != ClosestHits::none, as_well = b[i].id != ClosestHits::none;
      others += met != as_well ? 1 : 0;
      if (met && as_well) differences.push_back(1e3 * std::fabs(a[i].range - b[i].range));
    }
    const auto times = report.by_turns({[&] { bench::keep(bench::sum_of_ranges(single, beams)); },
                                        [&] { bench::keep(bench::sum_of_ranges(exact, beams)); }});
    report.row(std::string("precision/") + name,
               {{"rays", static_cast<double>(a.size())},
                {"met by one only", static_cast<double>(others)},
                {"99.99 % of differences within, mm", percentile(differences, 0.9999)},
                {"largest, mm", percentile(differences, 1)},
                {"times as fast", bench::speed_ratio(times[0], times[1])},
                {"MiB, float", static_cast<double>(single.memory()) / (1 << 20)},
                {"MiB, double", static_cast<double>(exact.memory()) / (1 << 20)}});
  }
}

}  // namespace tradeoff
