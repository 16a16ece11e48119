// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/detector/detail/filtered_noise.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

#include <doctest/doctest.h>

using namespace pulsecast;

namespace {
FilteredNoise noise_of(const LowPass& filter, PulseIndex pulse) {
  return {filter, {.seed = 1, .pulse = pulse, .purpose = Purpose::receiver_noise}};
}
}  // namespace

TEST_CASE("a low-pass passes half of the power at its bandwidth, and white noise as a rectangle 6.4 % wider") {
  const LowPass filter = LowPass::of_bandwidth(1e9);
  // |H|^2 = exp(-(2 pi f s)^2)
  CHECK(std::exp(-std::pow(2 * std::numbers::pi * 1e9 * filter.deviation, 2)) == doctest::Approx(0.5).epsilon(1e-12));
  // the integral of exp(-ln 2 f^2) from 0 to infinity is sqrt(pi / ln 2) / 2
  CHECK(filter.noise_bandwidth() ==
        doctest::Approx(0.5 * std::sqrt(std::numbers::pi / std::numbers::ln2) * 1e9).epsilon(1e-12));
}

TEST_CASE("noise behind a low-pass is normal with the autocorrelation of its filter") {
  const LowPass filter = LowPass::of_bandwidth(2e9);
  const double step = 0.5 * filter.deviation;
  constexpr std::size_t pulses = 400, samples = 500;
  std::vector<double> products(9);
  double sum = 0, fourth = 0;
  for (PulseIndex pulse = 0; pulse < pulses; ++pulse) {
    FilteredNoise noise = noise_of(filter, pulse);
    std::vector<double> values;
    for (std::size_t i = 0; i < samples + products.size(); ++i) values.push_back(noise(static_cast<double>(i) * step));
    for (std::size_t i = 0; i < samples; ++i) {
      sum += values[i];
      fourth += std::pow(values[i], 4);
      for (std::size_t lag = 0; lag < products.size(); ++lag) products[lag] += values[i] * values[i + lag];
    }
  }
  // about one in seven values is independent: standard errors of 6e-3 and less
  const double count = pulses * samples;
  CHECK(std::fabs(sum / count) < 0.02);
  CHECK(std::fabs(fourth / count - 3) < 0.1);
  for (std::size_t lag = 0; lag < products.size(); ++lag) {
    CAPTURE(lag);
    const double apart = 0.5 * static_cast<double>(lag);
    CHECK(std::fabs(products[lag] / count - std::exp(-0.25 * apart * apart)) < 0.02);
  }
}

TEST_CASE("noise is a function of time, whatever the times asked for") {
  const LowPass filter{0.3e-9};
  FilteredNoise fine = noise_of(filter, 7), coarse = noise_of(filter, 7), late = noise_of(filter, 7);
  std::vector<double> values;
  for (int i = 0; i < 4000; ++i) values.push_back(fine(-50e-9 + 0.03125e-9 * i));
  for (int i = 0; i < 4000; i += 64) REQUIRE(coarse(-50e-9 + 0.03125e-9 * i) == values[static_cast<std::size_t>(i)]);
  CHECK(late(-50e-9 + 0.03125e-9 * 3999) == values.back());
  CHECK(noise_of(filter, 8)(0) != noise_of(filter, 7)(0));
}

TEST_CASE("the deviation is the same at every time, also between impulses") {
  const LowPass filter{1e-9};
  for (const double place : {0.0, 0.2, 0.5, 0.7}) {
    double squares = 0;
    constexpr std::size_t pulses = 40'000;
    for (PulseIndex pulse = 0; pulse < pulses; ++pulse)
      squares += std::pow(noise_of(filter, pulse)(0.75e-9 * (1000 + place)), 2);
    CAPTURE(place);
    CHECK(std::fabs(squares / pulses - 1) < 4 * std::sqrt(2.0 / pulses));
  }
}

TEST_CASE("noise rises through a level as often as Rice's formula says") {
  // Source: Rice 1945, eq. 3.3-14: exp(-u^2 / 2) sqrt(-R''(0)) / (2 pi), with R''(0) = -1 / (2 deviation^2)
  const LowPass filter = LowPass::of_bandwidth(1e9);
  const double step = 0.05 * filter.deviation, duration = 10e-6;
  for (const double level : {1.0, 2.0, 3.0}) {
    std::size_t crossings = 0;
    constexpr std::size_t pulses = 6;
    for (PulseIndex pulse = 0; pulse < pulses; ++pulse) {
      FilteredNoise noise = noise_of(filter, pulse);
      double before = noise(0);
      for (double i = 1; i * step < duration; ++i) {
        const double now = noise(i * step);
        crossings += before < level && now >= level ? 1U : 0U;
        before = now;
      }
    }
    const double rate =
        std::exp(-0.5 * level * level) / (2 * std::numbers::pi * std::numbers::sqrt2 * filter.deviation);
    const double expected = rate * duration * pulses;
    CAPTURE(level);
    CHECK(std::fabs(static_cast<double>(crossings) - expected) < 3.5 * std::sqrt(expected));
  }
}
