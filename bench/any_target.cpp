// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Surveys of one scene, as itself and as one of several types of maps, for `count.sh any_target target 2000` to count
// their instructions: `bench_any_target` runs each function below once. Prints a sum over the echoes of each; the two
// are equal.

#include <cstdio>

#include <pulsecast/pulsecast.hpp>
#include <pulsecast/scene/any_target.hpp>
#include <pulsecast/scene/moving_scene.hpp>
#include <pulsecast/shape/height_field.hpp>

#include "surveys.hpp"

using namespace bench;

namespace {

using Still = Scene<Mesh>;
using Any = AnyTarget<Still, MovingScene<Mesh>, Scene<HeightField>>;

/// 2,000 pulses of an airplane over level ground.
template <class Pattern, class Map>
double sum_of_ranges(const Map& map, const Pattern& footprint) {
  const Platform airplane{StraightLine{.from = {0, -450, 1250}, .to = {0, 450, 1250}, .speed = 60},
                          Mount{.boresight = extrinsic({{axis::right, -90_deg}, {axis::up, -90_deg}})},
                          Deflector{OscillatingMirror{.cycle_rate = 50_Hz, .half_angle = 20_deg},
                                    Scanner{.pulses = 2'000, .laser = {.peak_power = 5000_W}}}};
  const Survey survey{airplane, footprint, map, Receiver{}, FirstHit{}};
  auto workspace = survey.workspace();
  double sum = 0;
  for (PulseIndex i = 0; i < survey.size(); ++i)
    for (const Echo& echo : survey(i, workspace).echoes) sum += echo.range;
  return sum;
}

}  // namespace

extern "C" {

[[gnu::noinline]] double target_alone_single(const Still& ground) { return sum_of_ranges(ground, SingleRay{}); }
[[gnu::noinline]] double target_any_single(const Any& ground) { return sum_of_ranges(ground, SingleRay{}); }
[[gnu::noinline]] double target_alone_bundle(const Still& ground) {
  return sum_of_ranges(ground, SunflowerFootprint{19});
}
[[gnu::noinline]] double target_any_bundle(const Any& ground) { return sum_of_ranges(ground, SunflowerFootprint{19}); }

}  // extern "C"

int main() {
  const Still ground = scene_of({.vertices = {{-600, -600, 0}, {600, -600, 0}, {600, 600, 0}, {-600, 600, 0}},
                                 .triangles = {{0, 1, 2}, {0, 2, 3}}});
  const Any any = ground;
  std::printf("single %.9g %.9g\nbundle %.9g %.9g\n", target_alone_single(ground), target_any_single(any),
              target_alone_bundle(ground), target_any_bundle(any));
}
