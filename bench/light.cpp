// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Pulses from all along a car's survey of the town, for `count.sh light light 3000` to count its instructions:
// `bench_light` runs each function below once. Prints sums of ranges, and the share of the light that hits glass.

#include <cstdio>
#include <memory>
#include <vector>

#include <pulsecast/pulsecast.hpp>
#include <pulsecast/transport/light_paths.hpp>

#include "surveys.hpp"

using namespace bench;

namespace {

template <class Light>
double sum_of_ranges(const Scene<Mesh>& town, const Light& light) {
  const Survey survey{car(1'398'000), LatticeFootprint{19}, town, light, Receiver{}, FullWaveform{}};
  auto workspace = survey.workspace();
  double sum = 0;
  for (PulseIndex i = 0; i < survey.size(); i += 466)
    for (const Echo& echo : survey(i, workspace).echoes) sum += echo.range;
  return sum;
}

LightPaths twice(std::size_t paths) { return {.scattering = {.orders = 2, .paths = paths}}; }

}  // namespace

extern "C" {

[[gnu::noinline]] double light_direct(const Scene<Mesh>& matt) { return sum_of_ranges(matt, DirectLight{}); }
[[gnu::noinline]] double light_paths(const Scene<Mesh>& matt) { return sum_of_ranges(matt, LightPaths{}); }
[[gnu::noinline]] double light_panes(const Scene<Mesh>& glazed) { return sum_of_ranges(glazed, LightPaths{}); }
[[gnu::noinline]] double light_mirrors(const Scene<Mesh>& mirrored) { return sum_of_ranges(mirrored, LightPaths{}); }
[[gnu::noinline]] double light_bodies(const Scene<Mesh>& of_glass) { return sum_of_ranges(of_glass, LightPaths{}); }
[[gnu::noinline]] double light_twice(const Scene<Mesh>& matt) { return sum_of_ranges(matt, twice(8)); }

}  // extern "C"

int main() {
  const auto matt = town_with({}), glazed = town_with({.reflectance = 0.02, .smooth = SmoothInterface::pane()}),
             mirrored = town_with({.reflectance = 0.02, .smooth = SmoothInterface::mirror()}),
             of_glass = town_with({.reflectance = 0.02, .smooth = SmoothInterface::glass()});
  std::printf("direct %.9g\n", light_direct(matt));
  std::printf("paths %.9g\n", light_paths(matt));
  std::printf("panes %.9g\n", light_panes(glazed));
  std::printf("mirrors %.9g\n", light_mirrors(mirrored));
  std::printf("bodies %.9g\n", light_bodies(of_glass));
  std::printf("twice %.9g\n", light_twice(matt));

  const auto absorbed = [](const Scene<Mesh>& town) {
    const Survey survey{car(1'398'000), LatticeFootprint{19}, town, DirectLight{}, Receiver{}, FirstHit{}};
    auto workspace = survey.workspace();
    EnergyLedger all;
    for (PulseIndex i = 0; i < survey.size(); i += 466) all.add(survey(i, workspace).energy);
    return all.share(&EnergyLedger::absorbed);
  };
  std::printf("share of the light that meets windows: %.3f\n",
              absorbed(town_with({.reflectance = 0})) - absorbed(town_with({.reflectance = 1})));
}
