// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/detector/photon_counting.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <vector>

#include <doctest/doctest.h>

#include "support/laws.hpp"

using namespace pulsecast;

static_assert(Detector<PhotonCounting<>>);

namespace {

constexpr double geiger = std::numeric_limits<double>::infinity();
const Laser laser{.wavelength = 1.064e-6, .pulse_length = 1e-9};
const Emitter emitter{.laser = laser};

/// Received power that gives so many photoelectrons on average.
double power_for(double photoelectrons, double efficiency) {
  return photoelectrons * 6.62607015e-34 * speed_of_light / laser.wavelength / efficiency / laser.pulse_length;
}

template <class Form>
std::vector<std::vector<Echo>> pulses_of(const PhotonCountingSettings& settings, const Form& form,
                                         std::vector<Reflection> reflections, int count, RangeGate gate = {0, 1000}) {
  PhotonCounting<Form> detector(settings, form);
  detector.prepare(laser);
  auto w = detector.workspace(reflections.size());
  std::vector<std::vector<Echo>> all;
  for (int k = 0; k < count; ++k) {
    const Detection d =
        detector.detect({emitter, gate, reflections, {.seed = 7, .pulse = static_cast<std::uint64_t>(k)}}, w);
    all.emplace_back(d.echoes.begin(), d.echoes.end());
  }
  return all;
}

}  // namespace

TEST_CASE("a pulse is detected with the probability that one photoelectron or more is there") {
  constexpr int pulses = 10'000;
  for (const double mean : {0.05, 0.5, 2.0}) {
    int detected = 0;
    for (const auto& echoes : pulses_of({.efficiency = 0.4, .dead_time = geiger}, GammaPulse{},
                                        {{.range = 100, .power = power_for(mean, 0.4)}}, pulses))
      detected += !echoes.empty();
    const double expected = 1 - std::exp(-mean);
    CAPTURE(mean);
    CHECK(std::fabs(detected / static_cast<double>(pulses) - expected) <
          3 * std::sqrt(expected * (1 - expected) / pulses));
  }
}

TEST_CASE("the first photon of many is early") {
  const double mean = 8, s = laser.pulse_length / std::sqrt(8 * std::numbers::ln2);
  // Source: density of the first of a Poisson process, N f(t) exp(-N F(t)), with the Gaussian's f and F, integrated
  double sum = 0, first = 0, second = 0;
  for (int i = -6000; i <= 6000; ++i) {
    const double x = i * 1e-3, f = std::exp(-0.5 * x * x) / std::sqrt(2 * std::numbers::pi),
                 F = 0.5 * std::erfc(-x / std::numbers::sqrt2);
    const double density = mean * f * std::exp(-mean * F);
    sum += density;
    first += density * x;
    second += density * x * x;
  }
  const double expected = first / sum, deviation = std::sqrt(second / sum - expected * expected);
  constexpr int pulses = 10'000;
  double times = 0;
  int detected = 0;
  for (const auto& echoes :
       pulses_of({.dead_time = geiger}, GaussianPulse{}, {{.range = 100, .power = power_for(mean, 0.3)}}, pulses)) {
    if (echoes.empty()) continue;
    times += 2 * (echoes[0].range - 100) / speed_of_light / s;
    ++detected;
  }
  CHECK(expected < -1);
  CHECK(std::fabs(times / detected - expected) < 3 * deviation / std::sqrt(static_cast<double>(detected)));
}

TEST_CASE("dead time lowers a count rate as a renewal process does") {
  const double rate = 2e7, dead = 30e-9, gate = 4e-6;
  constexpr int pulses = 400;
  std::size_t counts = 0;
  for (const auto& echoes : pulses_of({.dark_rate = rate, .dead_time = dead, .bin = 1e-11, .returns_max = 255},
                                      GammaPulse{}, {}, pulses, {0, 0.5 * speed_of_light * gate}))
    counts += echoes.size();
  // Source: renewal theory, Cox 1962: a rate of r / (1 + r d), and a variance of r T / (1 + r d)^3; the first count has
  // no dead time
  const double slower = 1 + rate * dead, once = rate * dead * (1 - 0.5 * rate * dead / slower) / slower;
  const double expected = pulses * (rate * gate / slower + 0.5 * once * once / slower),
               deviation = std::sqrt(pulses * rate * gate / std::pow(slower, 3));
  CHECK(std::fabs(static_cast<double>(counts) - expected) < 3 * deviation + 0.3 * pulses);
  CHECK(static_cast<double>(counts) < 0.7 * pulses * rate * gate);
}

TEST_CASE("many pixels see more of a strong pulse") {
  constexpr int pulses = 2000;
  const double mean = 20;
  for (const std::size_t pixels : {1UL, 8UL, 64UL}) {
    double counts = 0;
    for (const auto& echoes : pulses_of({.pixels = pixels, .dead_time = geiger, .bin = 100e-9}, GammaPulse{},
                                        {{.range = 105, .power = power_for(mean, 0.3)}}, pulses))
      for (const Echo& echo : echoes) counts += echo.amplitude / power_for(1, 0.3);
    const double n = static_cast<double>(pixels), expected = n * (1 - std::exp(-mean / n));
    CAPTURE(pixels);
    CHECK(std::fabs(counts / pulses - expected) < 3 * std::sqrt(mean / pulses));
  }
}

TEST_CASE("an afterpulse may have one of its own") {
  constexpr int pulses = 4000;
  const double share = 0.3;
  std::size_t counts = 0;
  for (const auto& echoes : pulses_of({.dead_time = 20e-9, .afterpulse = share, .bin = 1e-10, .returns_max = 255},
                                      GammaPulse{}, {{.range = 100, .power = power_for(50, 0.3)}}, pulses))
    counts += echoes.size();
  CHECK(static_cast<double>(counts) / pulses ==
        doctest::Approx(1 / (1 - share)).epsilon(3 * std::sqrt(share) / (1 - share) / std::sqrt(1.0 * pulses)));
}

TEST_CASE("nothing is detected outside the gate: afterpulses, dark counts, jitter, and the ends of pulses") {
  constexpr int pulses = 4000;
  const double share = 0.3, dead = 20e-9, late = 100e-9, gate = 60;
  std::size_t after = 0;
  for (const auto& echoes :
       pulses_of({.dead_time = dead, .afterpulse = share, .afterpulse_time = late, .bin = 1e-10, .returns_max = 255},
                 GaussianPulse{}, {{.range = 40, .power = power_for(50, 0.3)}}, pulses, {0, gate}))
    for (const Echo& echo : echoes) {
      CHECK(echo.range <= gate);
      after += echo.number == 2;
    }
  const double inside =
      share * (1 - std::exp(-(2 * (gate - 40) / speed_of_light - dead) / late));  // of the exponential distribution
  CHECK(std::fabs(static_cast<double>(after) / pulses - inside) < 4 * std::sqrt(inside * (1 - inside) / pulses));

  // the pulse of a wall at the start of the gate arrives half before it, as a Gaussian; that of one at its end, half
  // after it
  for (const double wall : {30.0, 60.0}) {
    int detected = 0;
    for (const auto& echoes : pulses_of({.dead_time = geiger}, GaussianPulse{},
                                        {{.range = wall, .power = power_for(1, 0.3)}}, pulses, {30, gate}))
      detected += !echoes.empty();
    const double expected = 1 - std::exp(-0.5);
    CHECK(std::fabs(detected / static_cast<double>(pulses) - expected) <
          4 * std::sqrt(expected * (1 - expected) / pulses));
  }

  for (const auto& echoes : pulses_of({.dark_rate = 1e8, .jitter = 20e-9, .bin = 1e-10, .returns_max = 255},
                                      GammaPulse{}, {}, 200, {30, 60}))
    for (const Echo& echo : echoes) {
      CHECK(echo.range >= 30);
      CHECK(echo.range <= 60);
    }
}

TEST_CASE("a histogram of many shots finds a weak echo in sunlight") {
  const PhotonCountingSettings settings{
      .background = power_for(1, 0.3) * laser.pulse_length / 1e-6, .shots = 400, .threshold = 20};
  for (const auto& echoes :
       pulses_of(settings, GammaPulse{}, {{.range = 300, .power = power_for(0.3, 0.3), .object = 5}}, 20, {0, 600})) {
    REQUIRE(echoes.size() == 1);
    CHECK(std::fabs(echoes[0].range - 300) < 0.05);
    CHECK(echoes[0].object == 5);
    CHECK(echoes[0].number == 1);
  }
}

TEST_CASE("jitter spreads the times of single photons") {
  const double s = laser.pulse_length / std::sqrt(8 * std::numbers::ln2), jitter = 2e-9;
  constexpr int pulses = 5000;
  double squares = 0;
  int detected = 0;
  for (const auto& echoes : pulses_of({.dead_time = geiger, .jitter = jitter}, GaussianPulse{},
                                      {{.range = 100, .power = power_for(0.1, 0.3)}}, pulses))
    for (const Echo& echo : echoes) {
      squares += std::pow(2 * (echo.range - 100) / speed_of_light, 2);
      ++detected;
    }
  CHECK(std::sqrt(squares / detected) == doctest::Approx(std::hypot(s, jitter)).epsilon(0.15));
}

TEST_CASE("the laws of detectors, and settings that are refused") {
  PhotonCounting<> detector;
  detector.prepare(laser);
  const std::vector<std::vector<Reflection>> cases{
      {{.range = 100, .power = power_for(3, 0.3)}}, {}, {{.range = 10, .power = power_for(1, 0.3)}}};
  CHECK(support::detector_laws(detector, laser, cases) == "");
  CHECK_THROWS_AS(PhotonCounting{{.efficiency = 0}}, SettingError);
  CHECK_THROWS_AS(PhotonCounting{{.pixels = 0}}, SettingError);
  CHECK_THROWS_AS(PhotonCounting{{.afterpulse = 1}}, SettingError);
  CHECK_THROWS_AS(PhotonCounting{{.threshold = 0}}, SettingError);
}
