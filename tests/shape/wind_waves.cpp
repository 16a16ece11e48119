// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/shape/wind_waves.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "support/generators.hpp"
#include "support/relative.hpp"

using namespace pulsecast;
using namespace pulsecast::support;

namespace {

/// Slope of a wave at its steepest, along and across a direction.
Vec2 slope_of(const SineWave& wave, double direction) {
  const double steepest = 2 * pi / wave.wavelength * wave.amplitude, angle = wave.toward - direction;
  return {steepest * std::cos(angle), steepest * std::sin(angle)};
}

double height_variance(const std::vector<SineWave>& waves) {
  double sum = 0;
  for (const SineWave& wave : waves) sum += 0.5 * wave.amplitude * wave.amplitude;
  return sum;
}

/// Significant wave height of a spectrum between two wavenumbers: four standard deviations of the height.
double significant_height(const pulsecast::detail::WindSpectrum& spectrum, double from, double to) {
  const int steps = 50000;
  const double step = std::log(to / from) / steps;
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    const double k = from * std::exp(step * (i + 0.5));
    sum += step * spectrum.curvature(k) / (k * k);
  }
  return 4 * std::sqrt(sum);
}

}  // namespace

TEST_CASE("variances of slopes are those of Cox & Munk, wave by wave") {
  for (const double speed : {0.01, 0.3, 1.0, 2.0, 5.0, 10.0, 15.0, 30.0})
    for (const double fetch : {std::numeric_limits<double>::infinity(), 2e4, 100.0})
      for (const std::size_t components : {16U, 96U, 512U}) {
        CAPTURE(speed);
        CAPTURE(fetch);
        CAPTURE(components);
        const double toward = 2.5;
        double along = 0, mixed = 0, across = 0;
        for (const SineWave& wave : waves_of({.wind_speed = speed,
                                    .toward = toward,
                                    .fetch = fetch,
                                    .components = components,
                                    .seed = components})) {
          const Vec2 slope = slope_of(wave, toward);
          along += 0.5 * slope.x * slope.x;
          mixed += 0.5 * slope.x * slope.y;
          across += 0.5 * slope.y * slope.y;
        }
        CHECK(along == relative(0.00316 * speed, 1e-10));
        CHECK(across == relative(0.003 + 0.00192 * speed, 1e-10));
        CHECK(std::fabs(mixed) < 1e-10 * across);
      }
}

TEST_CASE("slopes of the surface have the variances of Cox & Munk and are nearly normal") {
  for (const double speed : {2.0, 5.0, 10.0, 15.0}) {
    CAPTURE(speed);
    const double toward = -0.4;
    const WaveField field(waves_of({.wind_speed = speed, .toward = toward, .seed = 4}));
    Generator random(11);
    const int count = 200000;
    double second[2] = {}, fourth[2] = {}, mixed = 0, height = 0;
    for (int i = 0; i < count; ++i) {
      const Vec2 place{random.uniform(-1e5, 1e5), random.uniform(-1e5, 1e5)};
      const Vec2 slope = field.slope(place, {0, 0.5});
      const double axes[2] = {std::cos(toward) * slope.x + std::sin(toward) * slope.y,
                              std::cos(toward) * slope.y - std::sin(toward) * slope.x};
      for (int k = 0; k < 2; ++k) {
        const double square = axes[k] * axes[k];
        second[k] += square / count;
        fourth[k] += square * square / count;
      }
      mixed += axes[0] * axes[1] / count;
      if (i % 10 == 0) height += 10 * std::pow(field.height(place, {0, 0.5}), 2) / count;
    }
    CHECK(second[0] == relative(0.00316 * speed, 0.02));
    CHECK(second[1] == relative(0.003 + 0.00192 * speed, 0.02));
    CHECK(std::fabs(mixed) < 0.01 * second[1]);
    for (int k = 0; k < 2; ++k) CHECK(fourth[k] / (second[k] * second[k]) == relative(3, 0.04));
    CHECK(height == relative(height_variance(waves_of({.wind_speed = speed, .toward = toward, .seed = 4})), 0.04));
  }
}

TEST_CASE("the significant wave height is that of the spectrum") {
  for (const double speed : {3.0, 5.0, 10.0, 15.0, 30.0})
    for (const double fetch : {std::numeric_limits<double>::infinity(), 3e4, 3e3}) {
      CAPTURE(speed);
      CAPTURE(fetch);
      const pulsecast::detail::WindSpectrum spectrum(speed, fetch);
      const double whole = significant_height(spectrum, spectrum.peak() / 50, 2 * pi / 3e-3);
      for (const std::size_t components : {32U, 96U})
        CHECK(
            4 * std::sqrt(height_variance(waves_of({.wind_speed = speed, .fetch = fetch, .components = components}))) ==
            relative(whole, 0.02));
    }
  // in light winds slopes of all waves are less than those of the spectrum, and heights with them
  const double light = 4 * std::sqrt(height_variance(waves_of({.wind_speed = 2})));
  CHECK(light < significant_height(pulsecast::detail::WindSpectrum(2, 1e9), 0.05, 2e3));
  CHECK(light > 0.7 * significant_height(pulsecast::detail::WindSpectrum(2, 1e9), 0.05, 2e3));
}

TEST_CASE("a fully developed sea is as high, and peaks where, others have found") {
  for (const double speed : {5.0, 10.0, 20.0}) {
    const pulsecast::detail::WindSpectrum spectrum(speed, std::numeric_limits<double>::infinity());
    // 0.21 U^2/g of the wind at 19.5 m, 1.026 times that at 10 m: Pierson & Moskowitz 1964, as in Stewart 2008,
    // section 16.4
    const double height = 0.21 * std::pow(1.026 * speed, 2) / 9.81;
    CHECK(significant_height(spectrum, spectrum.peak() / 50, 2e3) == relative(height, 0.2));
    // waves at the peak run 1/0.84 times as fast as the wind at 10 m
    CHECK(std::sqrt(9.80665 / spectrum.peak()) == relative(speed / 0.84, 1e-6));
  }
  // the youngest sea that the spectrum describes
  CHECK(pulsecast::detail::WindSpectrum(10, 1).peak() == relative(25 * 9.80665 / 100, 1e-12));
  // less fetch, lower and shorter waves
  double height = 100, peak = 0;
  for (const double fetch : {1e6, 1e5, 1e4, 1e3}) {
    const pulsecast::detail::WindSpectrum spectrum(10, fetch);
    const double lower = significant_height(spectrum, spectrum.peak() / 50, 2e3);
    CHECK(lower < height);
    CHECK(spectrum.peak() > peak);
    height = lower;
    peak = spectrum.peak();
  }
}

TEST_CASE("the spectrum alone has nearly the slopes of Cox & Munk, as it was made to have") {
  for (const double speed : {5.0, 7.0, 10.0, 15.0}) {
    const pulsecast::detail::WindSpectrum spectrum(speed, std::numeric_limits<double>::infinity());
    double sum = 0;
    const int steps = 20000;
    const double from = spectrum.peak() / 20, step = std::log(1e4 / from) / steps;
    for (int i = 0; i < steps; ++i) sum += step * spectrum.curvature(from * std::exp(step * (i + 0.5)));
    CAPTURE(speed);
    CHECK(sum == relative(0.003 + 0.00512 * speed, 0.15));
  }
}

TEST_CASE("waves travel with the wind, and the longest most of all") {
  const double toward = 2;
  for (const SineWave& wave : waves_of({.wind_speed = 8, .toward = toward, .components = 512}))
    CHECK(std::cos(wave.toward - toward) > 0);
  for (const double turn : {-6.28, 6.28}) CHECK_NOTHROW(WaveField(waves_of({.toward = turn})));
  const pulsecast::detail::WindSpectrum spectrum(8, 1e9);
  CHECK(spectrum.spread(spectrum.peak()) > 0.99);
  CHECK(spectrum.spread(10.0) < 0.5);
}

TEST_CASE("angles to the wind are distributed as one and a share of cos(2 angle)") {
  for (const double spread : {0.0, 0.4, 1.0})
    for (const double angle : {-1.5, -0.3, 0.0, 0.8}) {
      const double below = 0.5 + (angle + 0.5 * spread * std::sin(2 * angle)) / pi;
      CHECK(std::fabs(pulsecast::detail::angle_to_wind(spread, below) - angle) < 1e-4);
    }
}

TEST_CASE("waves are as long as asked for, and of the seed only") {
  const std::vector<SineWave> waves = waves_of({.wind_speed = 6, .shortest = 0.05, .components = 200, .seed = 1});
  CHECK(waves.size() == 200);
  for (const SineWave& wave : waves) {
    CHECK(wave.wavelength >= 0.05);
    CHECK(wave.wavelength <= 8 * pi / pulsecast::detail::WindSpectrum(6, 1e12).peak());
  }
  const auto same = [](const std::vector<SineWave>& a, const std::vector<SineWave>& b) {
    bool equal = a.size() == b.size();
    for (std::size_t i = 0; equal && i < a.size(); ++i)
      equal = a[i].amplitude == b[i].amplitude && a[i].wavelength == b[i].wavelength && a[i].toward == b[i].toward &&
              a[i].phase == b[i].phase;
    return equal;
  };
  CHECK(same(waves_of({.seed = 5}), waves_of({.seed = 5})));
  CHECK_FALSE(same(waves_of({.seed = 5}), waves_of({.seed = 6})));
  CHECK(waves_of({.wind_speed = 0}).empty());
}

TEST_CASE("the density of slopes is one in sum, has its variances, and is highest at none") {
  const double toward = 0.9;
  const SlopeDistribution slopes = SlopeDistribution::of(7, toward);
  CHECK(slopes.along == relative(0.00316 * 7, 1e-14));
  CHECK(slopes.across == relative(0.003 + 0.00192 * 7, 1e-14));
  CHECK(slopes.density({}) == relative(1 / (2 * pi * std::sqrt(slopes.along * slopes.across)), 1e-14));
  double sum = 0, along = 0, across = 0;
  const double step = 0.005;
  for (double x = -1.5; x <= 1.5; x += step)
    for (double y = -1.5; y <= 1.5; y += step) {
      const double share = slopes.density({x, y}) * step * step;
      sum += share;
      along += share * std::pow(std::cos(toward) * x + std::sin(toward) * y, 2);
      across += share * std::pow(std::cos(toward) * y - std::sin(toward) * x, 2);
    }
  CHECK(sum == relative(1, 1e-6));
  CHECK(along == relative(slopes.along, 1e-6));
  CHECK(across == relative(slopes.across, 1e-6));
}

TEST_CASE("settings out of range are refused") {
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  const std::vector<WindWaves> bad{{.wind_speed = -1},    {.wind_speed = 31},  {.wind_speed = nothing},
                                   {.toward = 90},        {.toward = nothing}, {.fetch = 0},
                                   {.fetch = nothing},    {.shortest = 1e-3},  {.shortest = 0.2},
                                   {.shortest = nothing}, {.components = 15},  {.components = 513}};
  for (std::size_t i = 0; i < bad.size(); ++i) {
    CAPTURE(i);
    CHECK_THROWS_AS(static_cast<void>(waves_of(bad[i])), SettingError);
  }
}
