// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/result_buffer.hpp>

#include <array>
#include <cstddef>

#include <doctest/doctest.h>

using namespace pulsecast;

TEST_CASE("results of slots are kept in order, and counted by fate") {
  const std::array<Echo, 2> echoes{Echo{.range = 5}, Echo{.range = 7}};
  const std::array<float, 3> samples{1, 2, 3};
  ResultBuffer buffer;
  for (const bool empty_shots : {false, true}) {
    buffer.clear();
    Outcome returned{}, missed{}, blocked{};
    returned.shot.fate = Fate::returned;
    returned.shot.index = 4;
    returned.echoes = echoes;
    returned.waveform = samples;
    returned.energy.sent = 2;
    missed.shot.fate = Fate::missed;
    missed.energy.sent = missed.energy.missed = 2;
    blocked.shot.fate = Fate::blocked;
    for (const Outcome& outcome : {returned, missed, blocked, returned}) buffer.append(outcome, empty_shots);
    buffer.append_blocked(3);

    CHECK(buffer.counts.slots == 7);
    CHECK(buffer.counts.count(Fate::blocked) == 4);
    CHECK(buffer.counts.pulses() == 3);
    CHECK(buffer.counts.echoes == 4);
    CHECK(buffer.counts.energy.sent == 6);
    CHECK(buffer.counts.energy.missed == 2);
    const EchoBatch batch = buffer.batch(1e-9);
    REQUIRE(batch.shots.size() == (empty_shots ? 3 : 2));
    CHECK(batch.shots.back().first_echo == 2);
    CHECK(batch.shots.back().first_sample == 3);
    CHECK(batch.echoes.size() == 4);
    CHECK(batch.samples.size() == 6);
    CHECK(batch.sample_interval == 1e-9);
  }
}

TEST_CASE("totals of two runs add up") {
  RunSummary a{.slots = 3, .echoes = 2, .rays = 5, .seconds = 1},
      b{.slots = 4, .echoes = 1, .rays = 6, .seconds = 2, .complete = false};
  a.fates[static_cast<std::size_t>(Fate::blocked)] = 1;
  b.fates[static_cast<std::size_t>(Fate::blocked)] = 2;
  a.add(b);
  CHECK(a.slots == 7);
  CHECK(a.pulses() == 4);
  CHECK(a.echoes == 3);
  CHECK(a.rays == 11);
  CHECK(a.seconds == 3);
  CHECK_FALSE(a.complete);
}
