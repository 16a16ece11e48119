// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/detector/echo_width.hpp>

#include <cmath>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/detector/pulse_shape.hpp>

#include "support/relative.hpp"

using namespace pulsecast;

static_assert(EchoWidth<NoWidth> && EchoWidth<MomentWidth>);

TEST_CASE("no width is zero") { CHECK(NoWidth{}.width(std::vector<double>{1, 2, 1}, 1e-9) == 0); }

TEST_CASE("the width by moments of a Gaussian is its standard deviation") {
  const double interval = 0.5e-9, deviation = 3e-9;
  std::vector<double> samples;
  for (int i = -60; i <= 60; ++i) samples.push_back(5e-6 * std::exp(-0.5 * std::pow(i * interval / deviation, 2)));
  CHECK(MomentWidth{}.width(samples, interval) == support::relative(deviation, 1e-6));
}

TEST_CASE("the width by moments of a pulse is the pulse's deviation") {
  const PulseShape shape(4e-9);
  const double interval = 0.1e-9;
  std::vector<double> samples;
  for (int i = -100; i < 600; ++i) samples.push_back(shape(i * interval));
  CHECK(MomentWidth{}.width(samples, interval) == support::relative(shape.deviation(), 1e-4));
}

TEST_CASE("two samples of the same power are half an interval from their mean") {
  CHECK(MomentWidth{}.width(std::vector<double>{2, 2}, 1e-9) == support::relative(0.5e-9, 1e-12));
}

TEST_CASE("one sample, none, or no power at all have no width") {
  CHECK(MomentWidth{}.width(std::vector<double>{1}, 1e-9) == 0);
  CHECK(MomentWidth{}.width(std::vector<double>{}, 1e-9) == 0);
  CHECK(MomentWidth{}.width(std::vector<double>{0, 0, 0}, 1e-9) == 0);
}

TEST_CASE("moments of stretches add up to those of the whole") {
  WaveformMoments whole, parts;
  const double samples[] = {1, 4, 2, 7, 1, 3};
  for (int i = 0; i < 6; ++i) {
    const double t = i;
    whole.add({samples[i], samples[i] * t, samples[i] * t * t}, 0);
    parts.add({samples[i], 0, 0}, t);
  }
  CHECK(parts.energy == whole.energy);
  CHECK(parts.first == support::relative(whole.first, 1e-14));
  CHECK(parts.second == support::relative(whole.second, 1e-14));
  CHECK(MomentWidth{}.width(whole) == support::relative(MomentWidth{}.width(samples, 1), 1e-14));
  CHECK(MomentWidth{}.width(WaveformMoments{}) == 0);
}

TEST_CASE("the outgoing pulse has the width that a surface met squarely gives") {
  const PulseShape shape(4e-9);
  CHECK(pulse_width(NoWidth{}, shape, 0.25e-9) == 0);
  CHECK(pulse_width(MomentWidth{}, shape, 0.25e-9) == support::relative(shape.deviation(), 1e-3));
  CHECK(pulse_width(MomentWidth{}, shape, 0.05e-9) == support::relative(shape.deviation(), 1e-4));
}
