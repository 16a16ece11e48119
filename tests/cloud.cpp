// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/cloud.hpp>

#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/concepts.hpp>

using namespace pulsecast;

static_assert(EchoSink<Cloud&>);

TEST_CASE("a cloud keeps every echo of every batch, with its point, pulse and tick") {
  const std::vector<Echo> echoes{
      {.range = 10, .object = 1}, {.range = 20, .object = 2, .number = 2}, {.range = 30, .object = 3}};
  const std::vector<Shot> shots{{.index = 4,
                                 .tick = {1, 0.5},
                                 .origin = {0, 0, 100},
                                 .direction = -axis::up,
                                 .fate = Fate::returned,
                                 .first_echo = 0,
                                 .echoes = 2},
                                {.index = 5, .direction = -axis::up, .first_echo = 2},
                                {.index = 6,
                                 .tick = {2, 0},
                                 .origin = {1, 0, 0},
                                 .direction = axis::forward,
                                 .fate = Fate::returned,
                                 .first_echo = 2,
                                 .echoes = 1}};
  Cloud cloud;
  CHECK(cloud.size() == 0);
  const EchoBatch batch{shots, echoes, {}, 0};
  cloud(batch);
  cloud(batch);
  REQUIRE(cloud.size() == 6);
  CHECK(cloud.points[0] == Vec3{0, 0, 90});
  CHECK(cloud.points[1] == Vec3{0, 0, 80});
  CHECK(cloud.points[2] == Vec3{1, 30, 0});
  CHECK(cloud.pulses == std::vector<PulseIndex>{4, 4, 6, 4, 4, 6});
  CHECK(cloud.echoes[1].object == 2);
  CHECK(cloud.echoes[1].number == 2);
  CHECK(cloud.ticks[1] == Tick{1, 0.5});
  CHECK(cloud.ticks[2] == Tick{2, 0});
  CHECK(cloud.points[5] == Vec3{1, 30, 0});
}
