// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// What a raster costs as a height field, against the same raster as a mesh in a `Bvh`: memory, and rays a second from the air and from a
// tripod, by medians of turns about. Both must give the same ranges. With `large` as its argument: a raster of 20,000 x 20,000 alone.

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string_view>
#include <vector>

#include <pulsecast/pulsecast.hpp>
#include <pulsecast/scene/height_field.hpp>

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
      raster.heights[std::size_t{r} * columns + c] =
          static_cast<float>(300 + 20 * std::sin(c / 90.0) * std::cos(r / 70.0) + 2 * std::sin(c / 7.0 + r / 11.0) + 0.3 * rough);
    }
  return raster;
}

using Pulses = std::vector<RayBundle>;

RayBundle pulse(const Vec3& place, const Rotation& aim, std::size_t subrays) {
  const SunflowerFootprint footprint(subrays);
  RayBundle rays;
  rays.origin = place;
  rays.size = subrays;
  for (std::size_t j = 0; j < subrays; ++j) rays.set_direction(j, aim * subray_direction(footprint.offset(j), 0.3_mrad));
  rays.pad();
  return rays;
}

/// Lines across the raster from 800 m above it, 30 degrees to both sides.
Pulses from_the_air(const Box& ground, std::size_t subrays, std::size_t count) {
  Pulses all;
  const Vec3 size = ground.size();
  for (std::size_t i = 0; i < count; ++i) {
    const double along = static_cast<double>(i) / static_cast<double>(count), line = 200 * along - std::floor(200 * along);
    const Vec3 place{ground.min.x + 0.5 * size.x, ground.min.y + along * size.y, ground.max.z + 800};
    all.push_back(pulse(place, rotation_about(axis::forward, (2 * line - 1) * 30_deg) * rotation_about(axis::right, -90_deg), subrays));
  }
  return all;
}

/// All around a tripod on the ground in the middle, from 30 degrees below the horizon to 5 above.
Pulses from_a_tripod(const HeightField& ground, std::size_t subrays, std::size_t count) {
  const Vec3 middle = ground.bounds().centre();
  const RayBundle down = bundle_of({.origin = {middle.x, middle.y, ground.bounds().max.z + 1}, .direction = -axis::up});
  ClosestHits nearest(down);
  ground.closest(down, nearest);
  const Vec3 place{middle.x, middle.y, down.origin.z - nearest.range[0] + 1.8};
  Pulses all;
  for (std::size_t i = 0; i < count; ++i) {
    const double turn = static_cast<double>(i) / static_cast<double>(count), line = 100 * turn - std::floor(100 * turn);
    all.push_back(pulse(place, rotation_about(axis::up, 2 * pi * turn) * rotation_about(axis::right, -30_deg + line * 35_deg), subrays));
  }
  return all;
}

double sum_of_ranges(const auto& ground, const Pulses& all) {
  double sum = 0;
  for (const RayBundle& rays : all) {
    ClosestHits nearest(rays);
    ground.closest(rays, nearest);
    for (std::size_t j = 0; j < rays.size; ++j) sum += nearest.met(j) ? nearest.range[j] : 0;
  }
  return sum;
}

/// Of this program alone [s]; adds the sum of ranges.
double time_of(const auto& ground, const Pulses& all, double& sum) {
  const std::clock_t start = std::clock();
  sum += sum_of_ranges(ground, all);
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

void measure(const char* what, const HeightField& field, const TriangleMesh<>* mesh, const Pulses& all) {
  std::vector<double> of_field, of_mesh, ratios;
  double sum = 0, expected = 0;
  for (int turn = 0; turn < (mesh ? 21 : 3); ++turn) {
    of_field.push_back(time_of(field, all, sum));
    if (!mesh) continue;
    of_mesh.push_back(time_of(*mesh, all, expected));
    ratios.push_back(of_mesh.back() / of_field.back());
  }
  const double rays = static_cast<double>(all.size() * all[0].size) / 1e6;
  std::printf("%-14s bundles of %2zu: %7.3f million rays/s", what, all[0].size, rays / median(of_field));
  if (mesh) std::printf(", mesh %7.3f, mesh's time over the field's %5.2f", rays / median(of_mesh), median(ratios));
  std::printf("\n");
  if (mesh && sum != expected) {
    std::printf("the two DIFFER: %.17g, mesh %.17g\n", sum, expected);
    std::exit(1);
  }
}

void measure_all(const HeightField& field, const TriangleMesh<>* mesh) {
  for (const std::size_t subrays : {std::size_t{1}, std::size_t{19}}) {
    measure("from the air", field, mesh, from_the_air(field.bounds(), subrays, 100'000 / subrays));
    measure("from a tripod", field, mesh, from_a_tripod(field, subrays, 100'000 / subrays));
  }
}

}  // namespace

int main(int count, const char** words) {
  const bool large = count > 1 && std::string_view(words[1]) == "large";
  Raster raster = large ? hills(20'000, 20'000) : hills(1041, 713);
  if (large) {
    const HeightField field(std::move(raster));
    measure_all(field, nullptr);
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    std::printf("20,000 x 20,000 pixels: %.3f bytes a cell, at most %.3f GB in all\n",
                static_cast<double>(field.memory()) / (19999.0 * 19999.0), static_cast<double>(usage.ru_maxrss) * 1024e-9);
    return 0;
  }
  const TriangleMesh<> mesh(raster.mesh());
  const HeightField field(std::move(raster));
  std::printf("1,041 x 713 pixels: %.3f MB, %.2f bytes a cell; mesh %.1f MB, %.1f times as much\n",
              static_cast<double>(field.memory()) / 1e6, static_cast<double>(field.memory()) / (1040.0 * 712.0),
              static_cast<double>(mesh.memory()) / 1e6, static_cast<double>(mesh.memory()) / static_cast<double>(field.memory()));
  measure_all(field, &mesh);
}
