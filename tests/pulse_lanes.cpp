// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/pulse_lanes.hpp>

#include <doctest/doctest.h>

#include <cstddef>

#include "support/archetypes.hpp"

using namespace pulsecast;

namespace {

/// Optic whose position is the second at which it is asked; open in even seconds.
struct Clock {
  Pose<frame::Beam, frame::Instrument> at(Tick t) const noexcept { return {.position = {t.seconds(), 0, 0}}; }
  bool open(Tick t) const noexcept { return t.second % 2 == 0; }
};

}  // namespace

TEST_CASE("a motion without lanes is asked tick by tick, where it is asked and open") {
  const TickLanes ticks = TickLanes::of(10, 1);
  simd::Mask asked = simd::Mask{} - 1;
  asked[0] = 0;
  PoseLanes<frame::Beam, frame::Instrument> poses;
  const simd::Mask open = find_poses(Clock{}, ticks, asked, poses);
  for (std::size_t lane = 0; lane < simd::lane_count; ++lane) {
    CAPTURE(lane);
    CHECK((open[lane] != 0) == (lane > 0 && lane % 2 == 0));
    if (open[lane] != 0) CHECK(poses[lane].position.x == 10 + static_cast<double>(lane));
  }
}

TEST_CASE("a source without lanes gives one pulse at a time") {
  const auto pulses = find_pulses(support::LeastSource<frame::World>{}, 3, simd::lane_count);
  REQUIRE(pulses.size == 1);
  REQUIRE(pulses[0]);
  CHECK(pulses[0]->tick == Tick{3, 0});
}
