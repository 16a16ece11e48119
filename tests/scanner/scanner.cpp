// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/scanner/scanner.hpp>

#include <cmath>
#include <limits>
#include <vector>

#include <doctest/doctest.h>

#include "support/laws.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

static_assert(BeamSource<Scanner> && FindsSlots<Scanner> && MakesLanes<Scanner>);

TEST_CASE("a scanner sends its pulses at a constant rate, forward, from its origin") {
  const Scanner scanner{.pulse_rate = 100_kHz, .pulses = 1000000, .laser = {.wavelength = 1550_nm}};
  CHECK(scanner.size() == 1000000);
  CHECK(scanner.duration() == Tick{10, 0});
  const auto p = scanner.pulse(250001);
  REQUIRE(p);
  CHECK(p->tick == Tick{2, 50001 / 1e5});
  CHECK(p->origin() == Vec3{});
  CHECK(p->direction() == axis::forward);
  CHECK(p->emitter == 0);
  const Scanner wide{.laser = {.wavelength = 532_nm}, .footprint_scale = 2, .receiver = 3};
  CHECK(wide.emitters() == std::vector<Emitter>{{.laser = wide.laser, .footprint_scale = 2, .receiver = 3}});
}

TEST_CASE("a scanner with a delay sends each pulse that much after its slot begins") {
  const Scanner prompt{.pulse_rate = 100_kHz}, late{.pulse_rate = 100_kHz, .delay = 3_us};
  for (const PulseIndex i : {PulseIndex{0}, PulseIndex{77}, PulseIndex{99999}, PulseIndex{1000000000000}})
    CHECK(late.pulse(i)->tick == prompt.pulse(i)->tick + Tick::of_seconds(3_us));
  CHECK(late.duration() == prompt.duration());
  CHECK(support::source_laws(late) == "");
}

TEST_CASE("a scanner keeps the laws of a source, of any length") {
  for (const PulseIndex pulses : {0ULL, 1ULL, 2ULL, 1000ULL, 1000000000000ULL}) {
    CAPTURE(pulses);
    CHECK(support::source_laws(Scanner{.pulse_rate = 99999.5, .pulses = pulses}) == "");
  }
}

TEST_CASE("a scanner of a pulse in a thousand seconds keeps its time") {
  const Scanner slow{.pulse_rate = 1e-3, .pulses = 5000};
  CHECK(std::fabs(slow.duration().seconds() - 5e6) < 1e-6);
  CHECK(std::fabs(slow.pulse(3)->tick.seconds() - 3000) < 1e-9);
  CHECK(support::source_laws(slow) == "");
}

TEST_CASE("a scanner refuses what no laser can do") {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  CHECK_NOTHROW(Scanner{}.validate());
  CHECK_NOTHROW(Scanner{.pulse_rate = 1e-3}.validate());
  CHECK_THROWS_AS(Scanner{.pulse_rate = 0.99e-3}.validate(), SettingError);
  for (const double bad : {0.0, -1.0, nan, infinity}) {
    CAPTURE(bad);
    CHECK_THROWS_AS(Scanner{.pulse_rate = bad}.validate(), SettingError);
    CHECK_THROWS_AS(Scanner{.laser = {.wavelength = bad}}.validate(), SettingError);
    CHECK_THROWS_AS(Scanner{.laser = {.peak_power = bad}}.validate(), SettingError);
    CHECK_THROWS_AS(Scanner{.laser = {.pulse_length = bad}}.validate(), SettingError);
  }
  for (const double bad : {-0.001, nan, infinity, 4.0})
    CHECK_THROWS_AS(Scanner{.laser = {.divergence = bad}}.validate(), SettingError);
  for (const double bad : {-1e-9, nan, infinity, 10_us})
    CHECK_THROWS_AS((Scanner{.pulse_rate = 100_kHz, .delay = bad}.validate()), SettingError);
  CHECK_NOTHROW(Scanner{.pulse_rate = 100_kHz, .delay = 9.9_us}.validate());
  CHECK_NOTHROW(Scanner{.laser = {.divergence = 0}}.validate());
  CHECK_NOTHROW((Scanner{.laser = {.divergence = {1_mrad, 2_mrad}}}.validate()));
  for (const double bad : {-0.001, nan, 4.0, 0.0}) {
    CAPTURE(bad);
    CHECK_THROWS_AS((Scanner{.laser = {.divergence = {1_mrad, bad}}}.validate()), SettingError);
    CHECK_THROWS_AS((Scanner{.laser = {.divergence = {bad, 1_mrad}}}.validate()), SettingError);
  }
  for (const double bad : {-0.001, nan, infinity})
    CHECK_THROWS_AS(Scanner{.laser = {.waist_diameter = bad}}.validate(), SettingError);
  for (const double bad : {nan, infinity})
    CHECK_THROWS_AS(Scanner{.laser = {.waist_range = bad}}.validate(), SettingError);
  CHECK_NOTHROW((Scanner{.laser = {.waist_diameter = 5_mm, .waist_range = -2}}.validate()));
}
