// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// What a beam with a waist costs, whose subrays are traced one by one, and what it costs to hand on every subray: a tripod in a street,
// 19 subrays, one thread. A figure counts only once the echoes are as many, to a hundredth.

#define CATCH_CONFIG_MAIN
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>

#include <pulsecast/pulsecast.hpp>

#include "../examples/street.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

namespace {

struct Cost {
  double seconds = 1e9;  ///< the best of some runs [s]
  std::uint64_t echoes = 0;
};

template <Footprint Pattern, class Map>
Cost cost(const Pattern& footprint, const Map& map, double waist_diameter) {
  const Laser laser{.divergence = 0.3_mrad, .waist_diameter = waist_diameter};
  const Platform source{Tripod{.position = {1.2, 0, street::height({1.2, 0})}}, Mount{.lever_arm = {0, 0, 1.7}},
                        Deflector{RotatingHead{.rate = 0.5}, Deflector{PolygonMirror{.lines_per_second = 50, .sweep = 80_deg},
                                                                       Scanner{.pulse_rate = 20_kHz, .pulses = 200'000, .laser = laser}}}};
  const Survey survey{source, footprint, map, Receiver{}, FullWaveform{}};
  Cost best;
  for (int time = 0; time < 5; ++time) {
    const RunSummary summary = run(survey, {.threads = 1});
    best.seconds = std::min(best.seconds, summary.seconds);
    best.echoes = summary.echoes;
  }
  return best;
}

}  // namespace

TEST_CASE("waists and recorded subrays") {
  const auto map = street::scene(1);
  const Cost cone = cost(RingFootprint{3}, map, 0), waist = cost(RingFootprint{3}, map, 7_mm);
  const Cost recorded = cost(WithSubrayRecord{RingFootprint{3}}, map, 0);
  CHECK(recorded.echoes == cone.echoes);
  CHECK(std::fabs(static_cast<double>(waist.echoes) / static_cast<double>(cone.echoes) - 1) < 0.01);
  std::printf("a cone from a point: %.2f s; with a waist: %.2f times that; with all subrays handed on: %.2f times\n", cone.seconds,
              waist.seconds / cone.seconds, recorded.seconds / cone.seconds);
}
