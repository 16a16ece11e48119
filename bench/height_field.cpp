// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Cost of a raster as a height field, against the same raster as a mesh in a `Bvh`: memory, and rays a second from the
// air and from a tripod, alternating. Both must give the same ranges. Rows are named pulses/subrays/shape. With `large`
// on the command line: a raster of 20,000 x 20,000 alone.

#include <sys/resource.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <pulsecast/pulsecast.hpp>
#include <pulsecast/shape/height_field.hpp>

#include "report.hpp"
#include "scenes.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

namespace {

/// Hills and furrows in UTM, a pixel a metre.
Raster hills(std::uint32_t columns, std::uint32_t rows) {
  Raster raster{.columns = columns, .rows = rows, .first = {4.7e5, 5.4e6}};
  raster.heights.resize(std::size_t{columns} * rows);
  for (std::uint32_t r = 0; r < rows; ++r)
    for (std::uint32_t c = 0; c < columns; ++c) {
      const double rough = uniform({.seed = 1, .pulse = std::size_t{r} * columns + c, .purpose = Purpose::scene});
      raster.heights[std::size_t{r} * columns + c] = static_cast<float>(
          300 + 20 * std::sin(c / 90.0) * std::cos(r / 70.0) + 2 * std::sin(c / 7.0 + r / 11.0) + 0.3 * rough);
    }
  return raster;
}

/// The same in 16 bits, in steps of a centimetre.
Raster packed(const Raster& wide) {
  constexpr double step = 0.01;
  Raster raster{
      .columns = wide.columns, .rows = wide.rows, .first = wide.first, .pixel = wide.pixel, .packed = {.scale = step}};
  for (const float height : wide.heights)
    raster.packed.numbers.push_back(static_cast<std::uint16_t>(std::lround(static_cast<double>(height) / step)));
  return raster;
}

RayBundle pulse(const Vec3& place, const Rotation& aim, std::size_t subrays) {
  const SunflowerFootprint footprint(subrays);
  RayBundle rays;
  rays.origin = place;
  rays.size = subrays;
  for (std::size_t j = 0; j < subrays; ++j)
    rays.set_direction(j, aim * subray_direction(footprint.offset(j), 0.3_mrad));
  rays.pad();
  return rays;
}

/// Lines across the raster from 800 m above it, 30 degrees to both sides.
bench::Bundles from_the_air(const Box& ground, std::size_t subrays, std::size_t count) {
  bench::Bundles all;
  const Vec3 size = ground.size();
  for (std::size_t i = 0; i < count; ++i) {
    const double along = static_cast<double>(i) / static_cast<double>(count),
                 line = 200 * along - std::floor(200 * along);
    const Vec3 place{ground.min.x + 0.5 * size.x, ground.min.y + along * size.y, ground.max.z + 800};
    all.add(pulse(place, rotation_about(axis::forward, (2 * line - 1) * 30_deg) * rotation_about(axis::right, -90_deg),
                  subrays));
  }
  return all;
}

/// All around a tripod on the ground in the middle, from 30 degrees below the horizon to 5 above.
bench::Bundles from_a_tripod(const HeightField& ground, std::size_t subrays, std::size_t count) {
  const Vec3 middle = ground.bounds().centre();
  const RayBundle down = bundle_of({.origin = {middle.x, middle.y, ground.bounds().max.z + 1}, .direction = -axis::up});
  ClosestHits nearest(down);
  ground.closest(down, nearest);
  const Vec3 place{middle.x, middle.y, down.origin.z - nearest.range[0] + 1.8};
  bench::Bundles all;
  for (std::size_t i = 0; i < count; ++i) {
    const double turn = static_cast<double>(i) / static_cast<double>(count), line = 100 * turn - std::floor(100 * turn);
    all.add(pulse(place, rotation_about(axis::up, 2 * pi * turn) * rotation_about(axis::right, -30_deg + line * 35_deg),
                  subrays));
  }
  return all;
}

void measure(bench::Report& report, const std::string& name, const HeightField& field, const TriangleMesh<>* mesh,
             const bench::Bundles& all) {
  std::vector<std::function<void()>> works{[&] { bench::keep(bench::sum_of_ranges(field, all)); }};
  if (mesh) {
    works.emplace_back([&] { bench::keep(bench::sum_of_ranges(*mesh, all)); });
    if (bench::sum_of_ranges(field, all) != bench::sum_of_ranges(*mesh, all)) {
      std::printf("%s DIFFERS from the mesh\n", name.c_str());
      std::exit(1);
    }
  }
  const std::vector<bench::Times> times = report.by_turns(works);
  const double rays = static_cast<double>(all.size() * all[0].size);
  for (std::size_t k = 0; k < works.size(); ++k)
    report.row(name + (k == 0 ? "/field" : "/mesh"),
               {{"Mrays/s", rays / bench::median(times[k]) / 1e6},
                {"times as fast as the field", bench::speed_ratio(times[k], times[0])}});
}

void measure_all(bench::Report& report, const HeightField& field, const TriangleMesh<>* mesh) {
  for (const std::size_t subrays : {std::size_t{1}, std::size_t{19}}) {
    const std::string number = std::to_string(subrays);
    measure(report, "air/" + number, field, mesh, from_the_air(field.bounds(), subrays, 100'000 / subrays));
    measure(report, "tripod/" + number, field, mesh, from_a_tripod(field, subrays, 100'000 / subrays));
  }
}

void measure_large(bench::Report& report) {
  const HeightField field(hills(20'000, 20'000));
  report.heading("20,000 x 20,000 pixels");
  measure_all(report, field, nullptr);
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  report.row("memory", {{"bytes/cell", static_cast<double>(field.memory()) / (19999.0 * 19999.0)},
                        {"GB at most in all", static_cast<double>(usage.ru_maxrss) * 1024e-9}});
}

void measure_small(bench::Report& report) {
  Raster raster = hills(1041, 713);
  const TriangleMesh<> mesh(raster.mesh());
  const HeightField field(std::move(raster));
  report.heading("1,041 x 713 pixels");
  measure_all(report, field, &mesh);
  constexpr double cells = 1040.0 * 712.0;
  report.row("memory, field", {{"bytes/cell", static_cast<double>(field.memory()) / cells}});
  report.row("memory, mesh", {{"bytes/cell", static_cast<double>(mesh.memory()) / cells}});
  Raster of_classes = hills(1041, 713);
  for (std::size_t i = 0; i < of_classes.pixels(); ++i) of_classes.materials.push_back(i / 53 % 2 == 0);
  const TriangleMesh<> mesh_of_classes(of_classes.mesh());
  const HeightField classes(std::move(of_classes));
  report.row("memory, field of 2 materials", {{"bytes/cell", static_cast<double>(classes.memory()) / cells}});
  report.row("memory, mesh of 2 materials", {{"bytes/cell", static_cast<double>(mesh_of_classes.memory()) / cells},
                                             {"times that of the field", static_cast<double>(mesh_of_classes.memory()) /
                                                                             static_cast<double>(classes.memory())}});
  const HeightField in_16_bits(packed(hills(1041, 713)));
  report.heading("1,041 x 713 pixels of 16 bits");
  measure_all(report, in_16_bits, nullptr);
  report.row("memory, field", {{"bytes/cell", static_cast<double>(in_16_bits.memory()) / cells}});
}

}  // namespace

int main(int count, char** words) {
  bench::Report report("height_field", count, words);
  if (!report.files().empty() && report.files()[0] == "large")
    measure_large(report);
  else
    measure_small(report);
}
