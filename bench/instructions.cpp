// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// The same work every time, for `budget.sh` to count its instructions: `bench_instructions trace` or `pipeline`. What is counted happens in
// the function of that name below; what is made before it, is not. Prints a sum over what was found.

#include <cstddef>
#include <cstdio>
#include <cstring>

#include <pulsecast/pulsecast.hpp>

#include "scenes.hpp"
#include "surveys.hpp"

using namespace bench;

extern "C" {

/// Beams and single rays, in a mesh, in a tree's leaves and in a height field.
[[gnu::noinline]] double budget_trace(const Mesh& ground, const HeightField& field, const Bundles& from_above, const Mesh& tree,
                                      const Bundles& from_aside, const Bundles& incoherent) {
  return sum_of_ranges(ground, from_above) + sum_of_ranges(field, from_above) + sum_of_ranges(tree, from_aside) +
         sum_of_ranges(tree, incoherent);
}

/// Two surveys on one thread, from the source to the batches.
[[gnu::noinline]] double budget_pipeline(const Scene<Mesh>& hills, const Scene<Mesh>& street) {
  double sum = 0;
  const auto sink = [&sum](const EchoBatch& batch) {
    for (const Echo& echo : batch.echoes) sum += echo.range;
  };
  run(Survey{airplane(3'000), SunflowerFootprint{19}, hills, Receiver{}, FullWaveform{}}, {.threads = 1}, sink);
  run(Survey{car(3'000), SunflowerFootprint{7}, street, Receiver{}, FullWaveform{}}, {.threads = 1}, sink);
  return sum;
}

}  // extern "C"

int main(int count, char** words) {
  const Raster raster = hills(150);
  const auto some = [](const Bundles& all) { return all.sample(1024); };
  if (count == 2 && std::strcmp(words[1], "trace") == 0) {
    const Mesh ground(raster.mesh()), leaves(tree());
    const HeightField field(raster);
    std::printf("%.9g\n", budget_trace(ground, field, some(beams(from_the_air(), 19, 0.25_mrad)), leaves,
                                       some(beams(from_a_tripod(leaves.bounds()), 19, 0.3_mrad)), incoherent_rays(leaves.bounds(), 2048)));
    return 0;
  }
  if (count == 2 && std::strcmp(words[1], "pipeline") == 0) {
    const auto ground = scene_of(raster.mesh()), town = street::scene(1);
    std::printf("%.9g\n", budget_pipeline(ground, town));
    return 0;
  }
  std::fprintf(stderr, "usage: %s trace|pipeline\n", words[0]);
  return 2;
}
