// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/detector/detail/by_pulse_length.hpp>

#include <doctest/doctest.h>

using namespace pulsecast;

TEST_CASE("what was prepared is found by the pulse length alone") {
  ByPulseLength<int> known;
  CHECK(known.find(Laser{}) == nullptr);
  known.add(Laser{.pulse_length = 4e-9}, 7);
  known.add(Laser{.pulse_length = 1e-9}, 8);
  REQUIRE(known.find(Laser{.wavelength = 5e-7, .pulse_length = 4e-9}) != nullptr);
  CHECK(*known.find(Laser{.pulse_length = 4e-9}) == 7);
  CHECK(*known.find(Laser{.pulse_length = 1e-9}) == 8);
  CHECK(known.find(Laser{.pulse_length = 2e-9}) == nullptr);
  int sum = 0;
  known.each([&](int prepared) { sum += prepared; });
  CHECK(sum == 15);
}
