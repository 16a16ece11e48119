// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Surveys by devices of one divergence and of two that alternate, for `count.sh emitters emitters 2000` to count their
// instructions: `bench_emitters` runs each function below once. The pulses of the alternating device are, in turn,
// those of the other two. Prints a sum over the echoes of each.

#include <cstdio>
#include <vector>

#include <pulsecast/pulsecast.hpp>

#include "surveys.hpp"

using namespace bench;

namespace {

/// Level ground in the beam of two channels that fire in turn, 1,000 pulses each.
double sum_of_ranges(const Scene<Mesh>& ground, const Divergence& first, const Divergence& second) {
  const auto channel = [](const Divergence& divergence, double delay) {
    return Scanner{.pulses = 1'000, .delay = delay, .laser = {.peak_power = 5000_W, .divergence = divergence}};
  };
  const Platform airplane{StraightLine{.from = {0, -450, 1250}, .to = {0, 450, 1250}, .speed = 60},
                          Mount{.boresight = extrinsic({{axis::right, -90_deg}, {axis::up, -90_deg}})},
                          Deflector{OscillatingMirror{.cycle_rate = 50_Hz, .half_angle = 20_deg},
                                    Channels{std::vector{channel(first, 0), channel(second, 5_us)}}}};
  const Survey survey{airplane, SunflowerFootprint{19}, ground, Receiver{}, FullWaveform{}};
  auto workspace = survey.workspace();
  double sum = 0;
  for (PulseIndex i = 0; i < survey.size(); ++i)
    for (const Echo& echo : survey(i, workspace).echoes) sum += echo.range;
  return sum;
}

constexpr double narrow = 0.2_mrad, wide = 0.3_mrad;

}  // namespace

extern "C" {

[[gnu::noinline]] double emitters_narrow(const Scene<Mesh>& ground) { return sum_of_ranges(ground, narrow, narrow); }
[[gnu::noinline]] double emitters_wide(const Scene<Mesh>& ground) { return sum_of_ranges(ground, wide, wide); }
[[gnu::noinline]] double emitters_both(const Scene<Mesh>& ground) { return sum_of_ranges(ground, narrow, wide); }

}  // extern "C"

int main() {
  const Scene<Mesh> ground = scene_of({.vertices = {{-600, -600, 0}, {600, -600, 0}, {600, 600, 0}, {-600, 600, 0}},
                                       .triangles = {{0, 1, 2}, {0, 2, 3}}});
  std::printf("narrow %.9g\nwide %.9g\nboth %.9g\n", emitters_narrow(ground), emitters_wide(ground),
              emitters_both(ground));
}
