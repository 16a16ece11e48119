// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Cost of measuring echo widths in a whole survey: a tripod and an airplane scan a wood with 19 subrays a pulse, by the
// sampling and by the analytic detector, on one thread. `--benchmark-samples 11` takes some minutes.

#define CATCH_CONFIG_ENABLE_BENCHMARKING
#define CATCH_CONFIG_MAIN
#include <catch2/catch.hpp>

#include <cstdint>
#include <string>

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
  const Scanner scanner{
      .pulse_rate = 100_kHz, .pulses = static_cast<PulseIndex>(180_deg / step * 360_deg / step), .laser = laser};
  const PolygonMirror mirror{.line_rate = scanner.pulse_rate * step / 180_deg, .sweep = 90_deg, .angle_min = -70_deg};
  const RotatingHead head{.angular_rate = 360_deg / scanner.duration().seconds()};
  return Platform{Tripod{.position = wood::glades(seed).front()}, Mount{.lever_arm = {0, 0, 1.7}},
                  Deflector{head, Deflector{mirror, scanner}}};
}

auto airplane() {
  const Laser laser{.wavelength = 1550_nm, .peak_power = 10000_W, .pulse_length = 4_ns, .divergence = 0.5_mrad};
  const Scanner scanner{.pulse_rate = 100_kHz, .pulses = 20'000, .laser = laser};
  const StraightLine line{.from = {-30, 0, 600}, .to = {30, 0, 600}, .speed = 30};
  return Platform{line, Mount{.boresight = extrinsic({{axis::right, -90_deg}, {axis::up, -90_deg}})},
                  Deflector{OscillatingMirror{.cycle_rate = 50, .half_angle = 3_deg}, scanner}};
}

/// Times a survey with a detector. Widths change no echo: there are as many as without.
template <class Source, class D>
void measure(const std::string& name, const Source& source, const wood::Scene& scene, const D& detector,
             std::uint64_t echoes) {
  const Survey survey{source, RingFootprint{3}, scene, Receiver{}, detector, seed};
  const auto go = [&] { return run(survey, {.threads = 1}, [](const EchoBatch&) {}).echoes; };
  REQUIRE(go() == echoes);
  BENCHMARK(std::string(name)) { return go(); };
}

template <EchoWidth Width>
using Sampled = FullWaveform<Width>;

template <template <EchoWidth> class Detector, class Source>
void compare(const std::string& name, const Source& source, const wood::Scene& scene) {
  const std::uint64_t echoes =
      run(Survey{source, RingFootprint{3}, scene, Receiver{}, Detector<NoWidth>{}, seed}, {}).echoes;
  measure(name, source, scene, Detector<NoWidth>{}, echoes);
  measure(name + "<MomentWidth>", source, scene, Detector<MomentWidth>{}, echoes);
  measure(name + "<GaussianFit>", source, scene, Detector<GaussianFit>{}, echoes);
}

template <class Source>
void compare(const Source& source) {
  const wood::Scene scene = wood::scene(seed);
  compare<Sampled>("FullWaveform", source, scene);
  compare<AnalyticWaveform>("AnalyticWaveform", source, scene);
}

}  // namespace

TEST_CASE("64,800 pulses from a tripod") { compare(tripod()); }
TEST_CASE("20,000 pulses from an airplane") { compare(airplane()); }
