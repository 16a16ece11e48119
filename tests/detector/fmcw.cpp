// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/detector/fmcw.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <doctest/doctest.h>

#include "support/detect.hpp"
#include "support/generators.hpp"
#include "support/laws.hpp"

using namespace pulsecast;

static_assert(Detector<Fmcw> && ReadsVelocity<Fmcw>);

namespace {

const Laser laser{.wavelength = 1.55e-6};

std::vector<Echo> echoes(const Fmcw& detector, std::vector<Reflection> reflections, std::uint64_t pulse = 0) {
  auto w = detector.workspace(reflections.size());
  const Detection d = support::detect(detector, laser, reflections, w, {.seed = 4, .pulse = pulse});
  return {d.echoes.begin(), d.echoes.end()};
}

}  // namespace

TEST_CASE("a surface has its range and radial velocity") {
  const Fmcw detector;
  for (const double range : {0.0, 1.0, 37.123, 100.05, 250.4})
    for (const double velocity : {-30.0, -0.02, 0.0, 0.5, 12.3}) {
      INFO(range, " m, ", velocity, " m/s");
      const std::vector<Echo> found =
          echoes(detector, {{.range = range, .power = 1e-6, .object = 5, .velocity = velocity}});
      if (range == 0 && found.empty()) continue;  // beyond the start by rounding
      REQUIRE(found.size() == 1);
      CHECK(std::fabs(found[0].range - range) < 1e-4);
      CHECK(std::fabs(found[0].velocity - velocity) < 1e-3);
      CHECK(found[0].amplitude == doctest::Approx(1e-6).epsilon(1e-3));
      CHECK(found[0].object == 5);
    }
}

TEST_CASE("two plates merge at half of c / 2B, and part at twice") {
  for (const double bandwidth : {2e8, 1e9, 4e9}) {
    const Fmcw detector({.bandwidth = bandwidth});
    const double unit = 299'792'458 / (2 * bandwidth);
    for (int i = 0; i < 20; ++i) {
      const double near = 20 + 0.05 * i * unit;
      INFO(bandwidth, " Hz, at ", near);
      const auto merged =
          echoes(detector, {{.range = near, .power = 1e-6}, {.range = near + 0.5 * unit, .power = 1e-6}});
      REQUIRE(merged.size() == 1);
      CHECK(merged[0].range == doctest::Approx(near + 0.25 * unit));
      const auto parted =
          echoes(detector, {{.range = near, .power = 1e-6}, {.range = near + 2 * unit, .power = 2e-6, .object = 1}});
      REQUIRE(parted.size() == 2);
      CHECK(std::fabs(parted[0].range - near) < 0.05 * unit);
      CHECK(std::fabs(parted[1].range - near - 2 * unit) < 0.05 * unit);
      CHECK(parted[1].object == 1);
      CHECK(parted[1].number == 2);
    }
  }
}

TEST_CASE("a moving surface before a still one: each has its own velocity") {
  const Fmcw detector;
  const auto found = echoes(detector, {{.range = 40, .power = 1e-6}, {.range = 20, .power = 1e-6, .velocity = 5}});
  REQUIRE(found.size() == 2);
  CHECK(std::fabs(found[0].velocity - 5) < 1e-3);
  CHECK(std::fabs(found[1].velocity) < 1e-3);
}

TEST_CASE("a car before a wall is paired by its power, at any speed; where powers are equal, both are flagged") {
  const Fmcw detector;
  for (const double speed : {-30.0, -5.0, 0.0, 5.0, 14.0, 30.0}) {
    CAPTURE(speed);
    const auto found =
        echoes(detector, {{.range = 50, .power = 2e-6, .velocity = speed}, {.range = 53, .power = 1e-6}});
    REQUIRE(found.size() == 2);
    CHECK(std::fabs(found[0].range - 50) < 1e-3);
    CHECK(std::fabs(found[1].range - 53) < 1e-3);
    CHECK(std::fabs(found[0].velocity - speed) < 1e-3);
    CHECK(std::fabs(found[1].velocity) < 1e-3);
    CHECK_FALSE(found[0].ambiguous);
    CHECK_FALSE(found[1].ambiguous);
    const auto equal =
        echoes(detector, {{.range = 50, .power = 1e-6, .velocity = speed}, {.range = 53, .power = 1e-6}});
    REQUIRE(equal.size() == 2);
    CHECK(equal[0].ambiguous);
    CHECK(equal[1].ambiguous);
  }
}

TEST_CASE("two peaks that are one in the other sweep are flagged") {
  const FmcwSettings settings;
  const double speed = settings.velocity_resolution(laser.wavelength), metres = settings.resolution();
  const auto found = echoes(Fmcw{settings}, {{.range = 50, .power = 2e-6, .velocity = 20 * speed},
                                             {.range = 50 + 20 * metres, .power = 1e-6}});
  REQUIRE(found.size() == 1);
  CHECK(found[0].ambiguous);
}

TEST_CASE("surfaces of random speeds and powers: whatever is not flagged is right, and little is flagged") {
  constexpr std::uint64_t seed = 3;
  constexpr int pulses = 3000;
  support::Generator any(seed);
  constexpr double photon = 6.62607015e-34 * 299'792'458 / 1.55e-6,
                   noise = photon / 10e-6;  // power of the noise in a period [W]
  for (const bool shot_noise : {false, true}) {
    const Fmcw detector({.threshold = 30 * noise, .shot_noise = shot_noise});
    int sure = 0, right = 0;
    for (int i = 0; i < pulses; ++i) {
      std::vector<Reflection> true_ones;
      for (int k = 0; k < 2; ++k)
        true_ones.push_back({.range = any.uniform(20, 80),
                             .power = any.log_uniform(300, 30'000) * noise,
                             .velocity = any.uniform(-30, 30)});
      for (const Echo& echo : echoes(detector, true_ones, static_cast<std::uint64_t>(i))) {
        if (echo.ambiguous) continue;
        ++sure;
        for (const Reflection& r : true_ones)
          right += std::fabs(echo.range - r.range) < 0.05 && std::fabs(echo.velocity - r.velocity) < 0.05;
      }
    }
    INFO("seed ", seed, ": ", sure, " sure of ", 2 * pulses, ", ", right, " right");
    CHECK(sure > (shot_noise ? 1.5 : 1.8) * pulses);
    CHECK(right >= (shot_noise ? 0.995 : 1) * sure);
  }
}

// The deviation of a peak's frequency: that of the maximum of a windowed transform in white noise, to first order. The
// window is 1 + cos.
TEST_CASE("shot noise of the reference beam: deviation of range and velocity") {
  constexpr double photon = 6.62607015e-34 * 299'792'458 / 1.55e-6;
  const FmcwSettings settings{.quantum_efficiency = 0.5, .shot_noise = true};
  const Fmcw detector(settings);
  const double ratio = 1000, power = ratio * photon / (0.5 * settings.sweep_time);
  const double square = 1.0 / 12 - 1 / (2 * pi * pi), weighted = 0.125 - 1 / (pi * pi) + 1 / (16 * pi * pi);
  const double of_beat = std::sqrt(weighted / (8 * pi * pi * ratio)) / square;
  double range = 0, velocity = 0, mean = 0;
  constexpr int pulses = 3000;
  for (int i = 0; i < pulses; ++i) {
    const auto found = echoes(Fmcw({.threshold = power / 4, .quantum_efficiency = 0.5, .shot_noise = true}),
                              {{.range = 50 + 0.01 * (i % 15), .power = power}}, static_cast<std::uint64_t>(i));
    REQUIRE(found.size() == 1);
    const double error = found[0].range - 50 - 0.01 * (i % 15);
    mean += error / pulses;
    range += error * error / pulses;
    velocity += found[0].velocity * found[0].velocity / pulses;
  }
  CHECK(std::fabs(mean) < 4 * std::sqrt(range / pulses));
  CHECK(std::sqrt(range) == doctest::Approx(of_beat / std::sqrt(2.0) * settings.resolution()).epsilon(0.06));
  CHECK(std::sqrt(velocity) ==
        doctest::Approx(of_beat / std::sqrt(2.0) * settings.velocity_resolution(1.55e-6)).epsilon(0.06));
}

// Many fields of random phases: an exponential distribution of power, about the sum of the powers. Source: Goodman
// 1975.
TEST_CASE("speckle: the power of a rough surface has the mean of its parts, and as great a deviation") {
  const Fmcw detector({.threshold = 1e-15, .speckle = true});
  double mean = 0, square = 0;
  constexpr int pulses = 4000;
  for (int i = 0; i < pulses; ++i) {
    std::vector<Reflection> parts(32, Reflection{.range = 30, .power = 1e-6 / 32});
    double power = 0;
    for (const Echo& e : echoes(detector, parts, static_cast<std::uint64_t>(i))) power += e.amplitude;
    mean += power / pulses;
    square += power * power / pulses;
  }
  CHECK(mean == doctest::Approx(1e-6).epsilon(4 / std::sqrt(1.0 * pulses)));
  CHECK(std::sqrt(square - mean * mean) == doctest::Approx(mean).epsilon(0.1));
}

TEST_CASE("light below the threshold, and none, is no echo; the strongest are kept") {
  const Fmcw detector({.threshold = 1e-9, .returns_max = 2});
  CHECK(echoes(detector, {}).empty());
  CHECK(echoes(detector, {{.range = 10, .power = 0.9e-9}}).empty());
  const auto found =
      echoes(detector, {{.range = 10, .power = 3e-9}, {.range = 20, .power = 2e-9}, {.range = 30, .power = 4e-9}});
  REQUIRE(found.size() == 2);
  CHECK(found[0].range == doctest::Approx(10));
  CHECK(found[1].range == doctest::Approx(30));
}

TEST_CASE("settings out of range are refused") {
  CHECK_THROWS_AS(Fmcw({.bandwidth = 1}), SettingError);
  CHECK_THROWS_AS(Fmcw({.sweep_time = 0}), SettingError);
  CHECK_THROWS_AS(Fmcw({.threshold = 0}), SettingError);
  CHECK_THROWS_AS(Fmcw({.quantum_efficiency = 2}), SettingError);
  CHECK_THROWS_AS(Fmcw({.returns_max = 0}), SettingError);
}
