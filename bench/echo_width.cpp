// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// What the measure of echo widths costs in the run of a whole survey: a tripod and an airplane scan a wood with 19 subrays a pulse, by the
// sampling and by the analytic detector, on one thread. Prints the processor time a pulse, and its ratio to that without widths: medians of
// rounds in which all take turns.

#define CATCH_CONFIG_MAIN
#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <vector>

#include <pulsecast/detector/analytic_waveform.hpp>
#include <pulsecast/detector/gaussian_fit.hpp>
#include <pulsecast/pulsecast.hpp>

#include "../examples/wood.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

namespace {

constexpr std::uint64_t seed = 1;

auto tripod() {
  const Laser laser{.wavelength = 1550_nm, .peak_power = 10_W, .pulse_length = 4_ns, .divergence = 0.35_mrad};
  const double step = 1_deg;
  const Scanner scanner{.pulse_rate = 100_kHz, .pulses = static_cast<PulseIndex>(180_deg / step * 360_deg / step), .laser = laser};
  const PolygonMirror mirror{.lines_per_second = scanner.pulse_rate * step / 180_deg, .sweep = 90_deg, .angle_min = -70_deg};
  const RotatingHead head{.rate = 360_deg / scanner.duration().seconds()};
  return Platform{Tripod{.position = wood::glades(seed).front()}, Mount{.lever_arm = {0, 0, 1.7}},
                  Deflector{head, Deflector{mirror, scanner}}};
}

auto airplane() {
  const Laser laser{.wavelength = 1550_nm, .peak_power = 10000_W, .pulse_length = 4_ns, .divergence = 0.5_mrad};
  const Scanner scanner{.pulse_rate = 100_kHz, .pulses = 20'000, .laser = laser};
  const StraightLine line{.from = {-30, 0, 600}, .to = {30, 0, 600}, .speed = 30};
  return Platform{line, Mount{.boresight = extrinsic({{axis::right, -90_deg}, {axis::up, -90_deg}})},
                  Deflector{OscillatingMirror{.cycles_per_second = 50, .half_angle = 3_deg}, scanner}};
}

/// Processor time of a run of a survey [s]; `echoes` is set.
template <class Source, class D>
double seconds(const Source& source, const wood::Scene& scene, const D& detector, std::uint64_t& echoes) {
  const Survey survey{source, RingFootprint{3}, scene, Receiver{}, detector, seed};
  const std::clock_t start = std::clock();
  echoes = run(survey, {.threads = 1}, [](const EchoBatch&) {}).echoes;
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

template <class Source>
void compare(const char* name, const Source& source, const wood::Scene& scene) {
  constexpr std::size_t rounds = 11;
  const std::array<const char*, 6> names{"FullWaveform",     "  MomentWidth", "  GaussianFit",
                                         "AnalyticWaveform", "  MomentWidth", "  GaussianFit"};
  std::array<std::vector<double>, 6> times;
  std::array<std::uint64_t, 6> echoes{};
  for (std::size_t round = 0; round < rounds; ++round) {
    times[0].push_back(seconds(source, scene, FullWaveform{}, echoes[0]));
    times[1].push_back(seconds(source, scene, FullWaveform<MomentWidth>{}, echoes[1]));
    times[2].push_back(seconds(source, scene, FullWaveform<GaussianFit>{}, echoes[2]));
    times[3].push_back(seconds(source, scene, AnalyticWaveform{}, echoes[3]));
    times[4].push_back(seconds(source, scene, AnalyticWaveform<MomentWidth>{}, echoes[4]));
    times[5].push_back(seconds(source, scene, AnalyticWaveform<GaussianFit>{}, echoes[5]));
  }
  std::printf("%s: %.0f pulses, %.0f echoes\n", name, static_cast<double>(source.size()), static_cast<double>(echoes[0]));
  for (std::size_t k = 0; k < names.size(); ++k) {
    REQUIRE(echoes[k] == echoes[k / 3 * 3]);
    std::array<double, rounds> ratios{};
    for (std::size_t round = 0; round < rounds; ++round) ratios[round] = times[k][round] / times[k / 3 * 3][round];
    std::sort(times[k].begin(), times[k].end());
    std::sort(ratios.begin(), ratios.end());
    std::printf("  %-18s %7.2f us a pulse, ratio %.2f\n", names[k], times[k][rounds / 2] / static_cast<double>(source.size()) * 1e6,
                ratios[rounds / 2]);
  }
}

}  // namespace

TEST_CASE("echo widths") {
  const wood::Scene scene = wood::scene(seed);
  compare("tripod", tripod(), scene);
  compare("airplane", airplane(), scene);
}
