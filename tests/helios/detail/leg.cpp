// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/helios/detail/leg.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/base/units.hpp>

#include "support/laws.hpp"

namespace pulsecast::helios {
namespace {

using namespace literals;

/// Leg of a scanner that turns its head.
SurveyLeg leg_with(const SurveyNoise& noise, const ErrorFormulas& errors = {}) {
  ScannerSettings scanner{.id = "turning", .pulse_rates = {1000}};
  scanner.channels = {{.optic = RotatingOptic{}, .head_rate_max = radians(360), .errors = errors}};
  LegScannerSettings settings;
  settings.pulse_rate = 1000;
  settings.scan_rate = 3;
  settings.head_rate = radians(90);
  const Mount mount{.lever_arm = {0.3, 0.2, 0.1}, .boresight = rotation_about({3, 1, 2}, 1)};
  return {{.path = Tripod{.position = {10, 20, 30}, .heading = 0.7}}, mount, Instrument{scanner, settings, 1}, noise};
}

NoiseSettings normal_noise(double deviation, int lifespan = 1) {
  return {.deviation = deviation, .lifespan = lifespan};
}

NoiseSettings uniform_noise(double low, double high) {
  return {.distribution = NoiseDistribution::uniform, .low = low, .high = high};
}

}  // namespace

TEST_CASE("points err as a leg states of the noise in its document") {
  NoiseSettings clipped = normal_noise(0.02, 7);
  clipped.clipped = true;
  clipped.clip_low = -0.01;
  clipped.clip_high = 0.03;
  const std::vector<SurveyNoise> kinds{
      {.position = {normal_noise(0.01), normal_noise(0.02, 0), uniform_noise(-0.03, 0.03)}},
      {.position = {std::nullopt, NoiseSettings{.mean = 0.03, .deviation = 0.01}, std::nullopt}},
      {.position = {std::nullopt, std::nullopt, clipped}},
      {.position = {uniform_noise(0.01, 0.05), std::nullopt, std::nullopt}},
      {.attitude = {normal_noise(1e-4), normal_noise(2e-4), normal_noise(3e-4, 0)}},
      {.attitude = {uniform_noise(-1e-4, 3e-4), std::nullopt, std::nullopt}},
      {.errors = {.position_drift = {0.01, 0.02, 0.03}, .drift_time = 5}},
      {.errors = {.attitude_drift = {1e-4, 2e-4, 3e-4}, .angular_jitter = 1e-4}},
      {.errors = {.lever_arm_deviation = {0.01, 0.02, 0.03}, .boresight_deviation = {1e-4, 2e-4, 3e-4}}}};
  for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
    CAPTURE(kind);
    const auto seeded = [&](std::uint64_t seed) {
      SurveyNoise noise = kinds[kind];
      noise.seed = noise.survey_seed = seed;
      return leg_with(noise);
    };
    CHECK(support::error_laws(seeded, 100 + 50 * kind, 200) == "");
  }
}

TEST_CASE("errors of a known size are stated with their sign: of the mount, and by formulas of the scanner") {
  SurveyNoise mounted;
  mounted.mount = {.position = {0.01, -0.02, 0.03}, .roll = 1e-5, .pitch = 2e-5, .heading = -3e-5};
  const ErrorFormulas formulas{.deflection = "0.00001*THETA", .head = "0.00002", .range = "0.001"};
  for (const SurveyLeg& leg : {leg_with(mounted), leg_with({}, formulas), leg_with(mounted, formulas)}) {
    int asked = 0;
    for (PulseIndex i = 0; i < leg.size(); i += 29) {
      const auto p = leg.pulse(i);
      if (!p) continue;
      const Vec3 ray{0, 100, 0}, point = p->pose.point(ray);
      Vec3 rest = p->reported->point(ray) - point;
      leg.visit_errors(i, p->tick, [&](const PoseError<frame::World>& error) noexcept {
        rest -= support::detail::displaced(error, *p, point);
      });
      CHECK(length(p->reported->point(ray) - point) > 1e-4);
      CHECK(length(rest) < 1e-6);
      ++asked;
    }
    CHECK(asked > 10);
  }
}

}  // namespace pulsecast::helios
