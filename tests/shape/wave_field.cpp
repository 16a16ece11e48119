// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/shape/wave_field.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>
#include <utility>
#include <vector>

#include "support/laws.hpp"
#include "support/relative.hpp"

using namespace pulsecast;
using namespace pulsecast::support;

static_assert(std::copyable<WaveField>);

namespace {

WaveField field_of(std::vector<SineWave> waves) { return WaveField(std::move(waves)); }

/// Waves of all lengths and directions.
std::vector<SineWave> some_waves(Generator& random, std::size_t count) {
  std::vector<SineWave> waves;
  for (std::size_t i = 0; i < count; ++i) {
    const double wavelength = random.log_uniform(2e-3, 300);
    waves.push_back(
        {random.uniform(0.001, 0.03) * wavelength, wavelength, random.uniform(-pi, pi), random.uniform(0, 2 * pi)});
  }
  return waves;
}

/// Height of waves, term by term by the C library.
double height_of(const std::vector<SineWave>& waves, const Vec2& place, double time) {
  double sum = 0;
  for (const SineWave& wave : waves) {
    const double k = 2 * pi / wave.wavelength;
    const double along = std::cos(wave.toward) * place.x + std::sin(wave.toward) * place.y;
    sum += wave.amplitude * std::sin(k * along - wave_frequency(k) * time + wave.phase);
  }
  return sum;
}

}  // namespace

TEST_CASE("a wave is level at the origin, and its crest a quarter of its length ahead") {
  const WaveField field = field_of({{.amplitude = 0.5, .wavelength = 100, .toward = pi / 2}});
  CHECK(std::fabs(field.height({0, 0}, {})) < 1e-15);
  CHECK(field.height({0, 25}, {}) == relative(0.5, 1e-14));
  CHECK(field.height({7, 75}, {}) == relative(-0.5, 1e-14));
  CHECK(field.slope({3, 0}, {}).y == relative(0.5 * 2 * pi / 100, 1e-14));
  CHECK(std::fabs(field.slope({3, 0}, {}).x) < 1e-15);
  CHECK(field.highest() == 0.5);
  CHECK(field.steepest() == relative(pi / 100, 1e-14));
}

TEST_CASE("no waves are level water") {
  for (const WaveField& field : {WaveField(), field_of({}), field_of({{.amplitude = 0}})}) {
    CHECK(field.empty());
    CHECK(field.height({3, 4}, Tick::of_seconds(5)) == 0);
    CHECK(field.slope({3, 4}, Tick::of_seconds(5)) == Vec2{});
    CHECK(field.highest() == 0);
    CHECK(field.memory() == 0);
  }
}

TEST_CASE("long waves run as gravity has them, short ones as surface tension has them") {
  CHECK(wave_frequency(2 * pi / 100) == relative(std::sqrt(9.80665 * 2 * pi / 100), 1e-6));
  CHECK(wave_frequency(2 * pi / 1e-3) == relative(std::sqrt(72.74e-3 / 998.2 * std::pow(2 * pi / 1e-3, 3)), 1e-2));
  // the slowest waves run at 0.23 m/s and are 17 mm long (Lamb 1932, article 267)
  double least = 1, at = 0;
  for (double k = 100; k < 1000; k += 0.5)
    if (wave_frequency(k) / k < least) {
      least = wave_frequency(k) / k;
      at = k;
    }
  CHECK(least == relative(0.23, 0.01));
  CHECK(2 * pi / at == relative(0.0171, 0.01));
}

TEST_CASE("a wave moves at its phase speed, after a year as in the first second") {
  const double k = 2 * pi / 150, speed = wave_frequency(k) / k, toward = 0.7;
  CHECK(speed == relative(15.3, 0.01));
  const WaveField field = field_of({{.amplitude = 1.5, .wavelength = 150, .toward = toward, .phase = 0.3}});
  const Vec2 ahead{std::cos(toward), std::sin(toward)};
  for (const std::int64_t start : {0, 40, 31536000})
    for (const double later : {0.1, 0.7, 3.0, 20.0}) {
      const Tick now{start, 0.25}, then = now + Tick::of_seconds(later);
      const Vec2 place{12, -34};
      CHECK(std::fabs(field.height(place + speed * later * ahead, then) - field.height(place, now)) < 1e-11);
    }
  // whole periods, of which rounding in one number would lose some 1e-7 after a year
  const WaveField quick = field_of({{.amplitude = 1, .wavelength = 0.01}});
  const double hertz = wave_frequency(2 * pi / 0.01) / (2 * pi);
  for (const std::int64_t second : {1, 86400, 31536000}) {
    const Tick t{second, 0};
    CHECK(std::fabs(quick.height({}, t) + std::sin(2 * pi * t.phase(hertz))) <
          3e-9 + 1e-15 * static_cast<double>(second) * hertz);
  }
}

TEST_CASE("the height is the sum of the waves, and its bounds hold") {
  for (const std::size_t count : {1U, 2U, 16U, 17U, 50U, 512U}) {
    CAPTURE(count);
    Generator random(count);
    const std::vector<SineWave> waves = some_waves(random, count);
    const WaveField field(waves);
    for (int time = 0; time < 200; ++time) {
      const Vec2 place{random.uniform(-100, 100), random.uniform(-100, 100)};
      const Tick t = Tick::of_seconds(random.uniform(0, 10));
      const double height = field.height(place, t);
      REQUIRE(std::fabs(height - height_of(waves, place, t.seconds())) < 1e-11 * (1 + field.highest()));
      REQUIRE(std::fabs(height) <= field.highest());
      REQUIRE(length(field.slope(place, t)) <= field.steepest());
    }
  }
  // bounds that are reached: all crests at one place, and all steepest places at another
  const double quarter = pi / 2;
  CHECK(field_of({{1, 10, 0, quarter}, {2, 30, 1, quarter}}).height({}, {}) == relative(3, 1e-14));
  const WaveField steep = field_of({{1, 10, 1}, {2, 30, 1}});
  CHECK(length(steep.slope({}, {})) == relative(steep.steepest(), 1e-14));
}

TEST_CASE("the slope is the derivative of the height") {
  Generator random(3);
  for (int time = 0; time < 300; ++time) {
    CAPTURE(time);
    const WaveField field(some_waves(random, 1 + random.whole(60)));
    const Vec2 place{random.uniform(-10, 10), random.uniform(-10, 10)};
    const Tick t = Tick::of_seconds(random.uniform(0, 100));
    const auto difference = [&](const Vec2& step) {  // of fourth order
      return (8 * (field.height(place + step, t) - field.height(place - step, t)) -
              (field.height(place + 2.0 * step, t) - field.height(place - 2.0 * step, t))) /
             12;
    };
    const double step = 2e-6;
    const Vec2 slope = field.slope(place, t);
    CHECK(std::fabs(difference({step, 0}) / step - slope.x) < 1e-7);
    CHECK(std::fabs(difference({0, step}) / step - slope.y) < 1e-7);
  }
}

TEST_CASE("heights and slopes depend on place and time only, and are those of a copy") {
  Generator random(5);
  const WaveField field(some_waves(random, 40));
  const std::vector<Tick> ticks = some_ticks(6);
  const auto place = [](std::size_t k) {
    return Vec2{0.37 * static_cast<double>(k), -11.0 * static_cast<double>(k % 7)};
  };
  const auto all = [&](const WaveField& f, std::size_t k) {
    const Vec2 slope = f.slope(place(k), ticks[k]);
    return Vec3{slope.x, slope.y, f.height(place(k), ticks[k])};
  };
  CHECK(support::detail::purity_laws(field, ticks.size(), all) == "");
}

TEST_CASE("the order of the waves does not matter, and copies share them") {
  Generator random(9);
  std::vector<SineWave> waves = some_waves(random, 33);
  const WaveField field(waves);
  std::reverse(waves.begin(), waves.end());
  const WaveField other(waves);
  CHECK(field.height({1, 2}, Tick::of_seconds(3)) == other.height({1, 2}, Tick::of_seconds(3)));
  CHECK(field.memory() == (5 * 48 + 4) * sizeof(double));
}

TEST_CASE("waves out of range are refused") {
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_AS(field_of({{.amplitude = -0.1}}), SettingError);
  CHECK_THROWS_AS(field_of({{.amplitude = nothing}}), SettingError);
  CHECK_THROWS_AS(field_of({{.amplitude = 101}}), SettingError);
  CHECK_THROWS_AS(field_of({{.amplitude = 1, .wavelength = 0}}), SettingError);
  CHECK_THROWS_AS(field_of({{.amplitude = 1, .wavelength = 2e6}}), SettingError);
  CHECK_THROWS_AS(field_of({{.amplitude = 1, .toward = 90}}), SettingError);
  CHECK_THROWS_AS(field_of({{.amplitude = 1, .phase = nothing}}), SettingError);
  CHECK_NOTHROW(WaveField(std::vector<SineWave>(512, {.amplitude = 0.01})));
  CHECK_THROWS_AS(WaveField(std::vector<SineWave>(513, {.amplitude = 0.01})), SettingError);
}
