// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/deflector/cycle.hpp>

#include <initializer_list>

#include <doctest/doctest.h>

using namespace pulsecast;

TEST_CASE("a clockwork at the pulse rate takes one step a pulse, also after a million million pulses") {
  for (const double rate : {1.0, 3.0, 1e5, 300e3, 33333.3, 99999.5, 1e6 / 7}) {
    for (const std::size_t n : {1U, 2U, 3U, 7U, 128U, 2083U, 100000U}) {
      for (const PulseIndex start : {PulseIndex{0}, PulseIndex{123456789}, PulseIndex{1000000000000}}) {
        CAPTURE(rate);
        CAPTURE(n);
        CAPTURE(start);
        for (PulseIndex i = start; i < start + 300; ++i) REQUIRE(step_in_cycle(Tick::of(i, rate), rate, n) == i % n);
      }
    }
  }
}

TEST_CASE("a moment between two steps belongs to the nearer one") {
  CHECK(step_in_cycle({0, 0.1}, 4, 3) == 0);
  CHECK(step_in_cycle({0, 0.13}, 4, 3) == 1);
  CHECK(step_in_cycle({0, 0.62}, 4, 3) == 2);
  CHECK(step_in_cycle({0, 0.63}, 4, 3) == 0);
}
