// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/detector/analytic_waveform.hpp>
#include <pulsecast/detector/echo_width.hpp>
#include <pulsecast/detector/first_hit.hpp>
#include <pulsecast/detector/full_waveform.hpp>
#include <pulsecast/detector/gaussian_fit.hpp>

#include "validation/one_pulse.hpp"

namespace pulsecast::extremes {

/// Calls `judge(name, detector)` with every waveform detector and width, timed by true ranges.
template <class Judge>
void for_each_waveform(WaveformSettings settings, const Judge& judge) {
  settings.timing = EchoTiming::true_range;
  judge("FullWaveform", FullWaveform<>(settings));
  judge("FullWaveform, MomentWidth", FullWaveform<MomentWidth>(settings));
  judge("FullWaveform, GaussianFit", FullWaveform<GaussianFit>(settings));
  judge("AnalyticWaveform", AnalyticWaveform<>(settings));
  judge("AnalyticWaveform, MomentWidth", AnalyticWaveform<MomentWidth>(settings));
  judge("AnalyticWaveform, GaussianFit", AnalyticWaveform<GaussianFit>(settings));
}

/// The same, and with FirstHit.
template <class Judge>
void for_each_detector(const WaveformSettings& settings, const Judge& judge) {
  judge("FirstHit", FirstHit{settings.threshold});
  for_each_waveform(settings, judge);
}

/// White, and across the beam.
struct Wall {
  double range;  ///< [m]
  std::optional<Hit> closest_hit(const Ray& ray) const noexcept { return Hit{.range = range / ray.direction.y}; }
};

/// Two white walls, each in one half of the beam.
struct TwoWalls {
  double left, right;  ///< [m]
  std::optional<Hit> closest_hit(const Ray& ray) const noexcept {
    return Hit{.range = (ray.direction.x < 0 ? left : right) / ray.direction.y};
  }
};

/// One ray to either side.
struct TwoRays {
  std::size_t size() const noexcept { return 2; }
  Vec2 offset(std::size_t j) const noexcept { return {j == 0 ? -0.1 : 0.1, 0}; }
  double share(std::size_t) const noexcept { return 0.5; }
};

/// What a wall across the beam sends back in vacuum [W]. Source: radar equation of an extended Lambertian target, and
/// the solid angle of a disc on the axis.
[[nodiscard]] inline double from_wall(const Laser& laser, double range) {
  const Receiver& receiver = validation::vacuum;
  const double reach = std::hypot(range, receiver.diameter / 2);
  return laser.peak_power * (receiver.diameter / reach) * (receiver.diameter / reach) * receiver.efficiency / 4;
}

/// What the echoes of a wall are held against.
struct Width {
  double moment;  ///< standard deviation [s]
  double fit;     ///< of the Gaussian that is fitted [s]
};
/// Of a pulse: sqrt(3) tau, and what the fit gives of one of 4 ns.
[[nodiscard]] inline Width width_of(double pulse_length) {
  const double fit = FullWaveform<GaussianFit>(WaveformSettings{.sample_interval = 4e-9 / 256})
                         .pulse_width(Laser{.pulse_length = 4e-9});
  return {std::sqrt(3.0) * pulse_length / 3.3946806708, fit * (pulse_length / 4e-9)};
}

/// Errors of one echo.
struct Errors {
  double range = 0;      ///< [m]
  double amplitude = 0;  ///< as a share
  double width = 0;      ///< as a share

  /// Looks at the echoes of a pulse that must be one; no echo is an infinite error.
  template <class Detector>
  void add(const Detector&, const std::vector<Echo>& echoes, double expected_range, double expected_power,
           const Width& expected_width) {
    if (echoes.size() != 1) {
      range = amplitude = width = INFINITY;
      return;
    }
    const auto share = [](double found, double expected) {
      const double error = std::fabs(found / expected - 1);
      return std::isnan(error) ? INFINITY : error;
    };
    range = std::max(range, std::fabs(echoes[0].range - expected_range));
    amplitude = std::max(amplitude, share(echoes[0].amplitude, expected_power));
    if constexpr (std::is_same_v<Detector, FullWaveform<MomentWidth>> ||
                  std::is_same_v<Detector, AnalyticWaveform<MomentWidth>>)
      width = std::max(width, share(echoes[0].width, expected_width.moment));
    if constexpr (std::is_same_v<Detector, FullWaveform<GaussianFit>> ||
                  std::is_same_v<Detector, AnalyticWaveform<GaussianFit>>)
      width = std::max(width, share(echoes[0].width, expected_width.fit));
  }
};

/// Every detector before a wall across the beam.
[[nodiscard]] inline Errors errors_at_wall(const Laser& laser, double range, const WaveformSettings& settings) {
  Errors errors;
  const Width width = width_of(laser.pulse_length);
  for_each_detector(settings, [&](const char* name, const auto& detector) {
    CAPTURE(name);
    const auto result = validation::one_pulse(Wall{range}, SingleRay{}, laser, validation::vacuum, detector);
    CHECK(result.echoes.size() == 1);
    errors.add(detector, result.echoes, range, from_wall(laser, range), width);
  });
  return errors;
}

}  // namespace pulsecast::extremes
