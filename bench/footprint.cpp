// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Cost of a beam with a waist, whose subrays are traced one by one, and of recording every subray: a tripod in a
// street, 19 subrays, one thread. The echoes are as many, to a hundredth. `--benchmark-samples 10` takes a minute.

#define CATCH_CONFIG_ENABLE_BENCHMARKING
#define CATCH_CONFIG_MAIN
#include <catch2/catch.hpp>

#include <cstdint>

#include <pulsecast/pulsecast.hpp>

#include "../examples/street.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

namespace {

template <Footprint Pattern>
std::uint64_t echoes(const Pattern& footprint, const street::Scene& map, double waist_diameter) {
  const Laser laser{.divergence = 0.3_mrad, .waist_diameter = waist_diameter};
  const Platform source{Tripod{.position = {1.2, 0, street::height({1.2, 0})}}, Mount{.lever_arm = {0, 0, 1.7}},
                        Deflector{RotatingHead{.angular_rate = 0.5},
                                  Deflector{PolygonMirror{.line_rate = 50, .sweep = 80_deg},
                                            Scanner{.pulse_rate = 20_kHz, .pulses = 200'000, .laser = laser}}}};
  return run(Survey{source, footprint, map, Receiver{}, FullWaveform{}}, {.threads = 1}).echoes;
}

}  // namespace

TEST_CASE("200,000 pulses with waists and recorded subrays") {
  const street::Scene map = street::scene(1);
  const std::uint64_t expected = echoes(RingFootprint{3}, map, 0);
  CHECK(echoes(WithSubrayRecord{RingFootprint{3}}, map, 0) == expected);
  CHECK(static_cast<double>(echoes(RingFootprint{3}, map, 7_mm)) ==
        Approx(static_cast<double>(expected)).epsilon(0.01));
  BENCHMARK("a cone from a point") { return echoes(RingFootprint{3}, map, 0); };
  BENCHMARK("a waist of 7 mm") { return echoes(RingFootprint{3}, map, 7_mm); };
  BENCHMARK("all subrays recorded") { return echoes(WithSubrayRecord{RingFootprint{3}}, map, 0); };
}
