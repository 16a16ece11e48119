// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/helios/detail/leg.hpp>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include "support/relative.hpp"

namespace pulsecast::helios {
namespace {

using support::relative;

/// A beam straight ahead at 1 kHz.
SurveyChannel ahead(PulseIndex pulses, SurveyOptic optic = {}) { return {optic, Scanner{.pulse_rate = 1000, .pulses = pulses}}; }

SurveyLeg leg_of(std::vector<SurveyChannel> channels, const SurveyNoise& noise = {}) {
  return SurveyLeg({Tripod{{1, 2, 3}}, {}}, {}, std::move(channels), Tick::of_seconds(10), noise);
}

TEST_CASE("channels take turns, and fire at the same time") {
  SurveyOptic above;
  above.emitter.position = {0, 0, 0.3};
  const SurveyLeg leg = leg_of({ahead(100), ahead(100, above)});
  CHECK(leg.size() == 200);
  const auto a = leg.pulse(20), b = leg.pulse(21);
  REQUIRE((a && b));
  CHECK(a->index == 20);
  CHECK(b->index == 21);
  CHECK(a->tick == b->tick);
  CHECK(a->channel == 0);
  CHECK(b->channel == 1);
  CHECK(length(b->pose.position - a->pose.position - Vec3{0, 0, 0.3}) < 1e-12);
  CHECK_FALSE(a->reported);
  CHECK_THROWS_AS((void)leg_of({}), SettingError);
}

TEST_CASE("a path begins at any moment of its plan") {
  const SurveyPath line{StraightLine{{0, 0, 0}, {0, 100, 0}, 10}, Tick::of_seconds(2)};
  CHECK(length(line.at(Tick::of_seconds(3)).position - Vec3{0, 50, 0}) < 1e-9);
}

TEST_CASE("noise moves what is reported, and has the distribution asked for") {
  SurveyNoise noise{.seed = 4};
  CHECK(noise.none());
  noise.position[0] = NoiseSettings{.deviation = 0.1};
  noise.position[1] = NoiseSettings{.distribution = NoiseDistribution::uniform, .low = 1, .high = 3};
  noise.position[2] = NoiseSettings{.mean = 5, .deviation = 0, .clipped = true, .clip_low = 0, .clip_high = 2};
  CHECK_FALSE(noise.none());
  const SurveyLeg leg = leg_of({ahead(10'000)}, noise);
  double sum = 0, squares = 0, least = 9, most = -9;
  for (PulseIndex i = 0; i < 10'000; ++i) {
    const auto p = leg.pulse(i);
    CHECK(p->pose.position == Vec3(1, 2, 3));
    const Vec3 off = p->reported.value().position - p->pose.position;
    sum += off.x;
    squares += off.x * off.x;
    least = std::min(least, off.y);
    most = std::max(most, off.y);
    CHECK(off.z == 2);
  }
  CHECK(std::fabs(sum / 10'000) < 0.004);
  CHECK(std::sqrt(squares / 10'000) == relative(0.1, 0.03));
  CHECK(least == relative(1, 0.01));
  CHECK(most == relative(3, 0.01));
}

TEST_CASE("a number serves as many pulses as it should; noise of the attitude turns the beam that is reported") {
  SurveyNoise noise;
  noise.position[0] = NoiseSettings{.lifespan = 3};
  const SurveyLeg slow = leg_of({ahead(100)}, noise);
  const auto off = [&](PulseIndex i) { return slow.pulse(i)->reported->position.x; };
  CHECK(off(0) == off(2));
  CHECK(off(2) != off(3));
  SurveyNoise turn;
  turn.attitude[2] = NoiseSettings{.mean = pi / 2, .deviation = 0};
  const auto pulse = leg_of({ahead(1)}, turn).pulse(0);
  CHECK(length(pulse->direction() - axis::forward) < 1e-12);
  CHECK(length(pulse->reported->direction(axis::forward) + axis::right) < 1e-12);
}

}  // namespace
}  // namespace pulsecast::helios
