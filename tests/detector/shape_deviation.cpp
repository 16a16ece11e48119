// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/detector/shape_deviation.hpp>

#include <cmath>
#include <cstddef>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/detector/band_limited_receiver.hpp>

#include "support/detect.hpp"
#include "support/laws.hpp"

using namespace pulsecast;

namespace {

const Laser laser{.pulse_length = 4e-9};
const WaveformSettings settings{.threshold = 1e-9, .record_length = 200e-9};

template <class D>
std::vector<double> deviations(D detector, std::vector<Reflection> reflections) {
  detector.prepare(laser);
  auto w = detector.workspace(reflections.size());
  std::vector<double> all;
  for (const Echo& echo : support::detect(detector, laser, reflections, w).echoes) all.push_back(echo.shape_deviation);
  return all;
}

std::vector<Reflection> slope(double length) {
  std::vector<Reflection> all;
  for (int i = 0; i <= 40; ++i) all.push_back({.range = 60.0123 + length * (i / 40.0 - 0.5), .power = 1e-7});
  return all;
}

/// Mean distance of the sum of shifted pulses from a pulse, both by their maxima, within a pulse length of the maximum
/// [1/1000].
double by_quadrature(double length) {
  const double tau = 4e-9 / 3.3946806708465;
  const auto pulse = [&](double t) {
    const double u = t / tau + 2;
    return u > 0 ? u * u * std::exp(2 - u) / 4 : 0.0;
  };
  const auto sum = [&](double t) {
    double all = 0;
    for (int i = 0; i <= 40; ++i) all += pulse(t - 2 * length * (i / 40.0 - 0.5) / 299'792'458);
    return all;
  };
  return 1000 * support::mean_distance(sum, pulse, 4e-9, {.reach = 5e-9, .step = 1e-13, .count = 4000});
}

}  // namespace

TEST_CASE("the echo of a flat target has no deviation, wherever it is between two samples") {
  for (double range = 30; range < 30.1; range += 0.0037) {
    const auto ideal = deviations(ShapeDeviation(FullWaveform{settings}), {{.range = range, .power = 1e-6}});
    REQUIRE(ideal.size() == 1);
    CHECK(ideal[0] < 1);
    using Banded = FullWaveform<NoWidth, BandLimitedReceiver<GammaPulse>>;
    const auto banded =
        deviations(ShapeDeviation(Banded(settings, {}, BandLimitedReceiver<GammaPulse>{ReceiverChain{}})),
                   {{.range = range, .power = 1e-6}});
    REQUIRE(banded.size() == 1);
    CHECK(banded[0] < 1);
  }
}

TEST_CASE("the echo of a slope deviates as by quadrature") {
  for (const double length : {0.2, 0.5, 1.0}) {
    const auto found = deviations(ShapeDeviation(FullWaveform{settings}), slope(length));
    REQUIRE(found.size() == 1);
    CHECK(found[0] == doctest::Approx(by_quadrature(length)).epsilon(0.05));
  }
}

TEST_CASE("echoes beyond the record have none, nor those of other detectors") {
  const auto far =
      deviations(ShapeDeviation(FullWaveform{settings}), {{.range = 10, .power = 1e-6}, {.range = 80, .power = 1e-6}});
  REQUIRE(far.size() == 2);
  CHECK(far[0] < 1);
  CHECK(std::isnan(far[1]));
  FullWaveform plain{settings};
  CHECK(std::isnan(deviations(plain, {{.range = 10, .power = 1e-6}}).at(0)));
}

TEST_CASE("the laws of detectors; one that keeps no waveform is refused") {
  ShapeDeviation detector{FullWaveform{settings}};
  detector.prepare(laser);
  const std::vector<std::vector<Reflection>> cases{slope(0.3), {}, {{.range = 3, .power = 1e-6}}};
  CHECK(support::detector_laws(detector, laser, cases) == "");
  CHECK_THROWS_AS(ShapeDeviation(FullWaveform{}), SettingError);
}
