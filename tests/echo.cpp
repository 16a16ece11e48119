// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/echo.hpp>

#include <vector>

#include <limits>

#include <doctest/doctest.h>

using namespace pulsecast;

TEST_CASE("an echo stands on the axis of its shot") {
  Shot shot;
  shot.origin = {500000, 5400000, 300};
  shot.direction = {0, 0.6, -0.8};
  Echo echo;
  echo.range = 100;
  CHECK(length(point_of(shot, echo) - Vec3{500000, 5400060, 220}) < 1e-9);
}

TEST_CASE("a batch hands out the echoes and samples of each shot") {
  const std::vector<Echo> echoes{{.range = 1}, {.range = 2}, {.range = 3}};
  const std::vector<float> samples{0.5F, 0.25F};
  const std::vector<Shot> shots{
      {.fate = Fate::returned, .first_echo = 0, .echoes = 1},
      {.fate = Fate::missed, .first_echo = 1},
      {.fate = Fate::returned, .first_echo = 1, .echoes = 2, .first_sample = 0, .samples = 2}};
  const EchoBatch batch{shots, echoes, samples, 1e-9};
  CHECK(batch.subrays_of(1).empty());
  REQUIRE(batch.echoes_of(shots[0]).size() == 1);
  CHECK(batch.echoes_of(shots[0])[0].range == 1);
  CHECK(batch.echoes_of(shots[1]).empty());
  REQUIRE(batch.echoes_of(shots[2]).size() == 2);
  CHECK(batch.echoes_of(shots[2])[1].range == 3);
  CHECK(batch.waveform_of(shots[0]).empty());
  REQUIRE(batch.waveform_of(shots[2]).size() == 2);
  CHECK(batch.waveform_of(shots[2])[1] == 0.25F);
}

TEST_CASE("a batch hands out the subrays of each shot, as many for each") {
  const std::vector<Shot> shots(3);
  std::vector<SubrayRecord> subrays(12);
  for (std::size_t k = 0; k < subrays.size(); ++k) subrays[k].power = static_cast<double>(k);
  const EchoBatch batch{.shots = shots, .echoes = {}, .samples = {}, .subrays = subrays};
  for (std::size_t k = 0; k < 3; ++k) {
    REQUIRE(batch.subrays_of(k).size() == 4);
    CHECK(batch.subrays_of(k)[0].power == 4 * static_cast<double>(k));
  }
}

TEST_CASE("ledgers are added and scaled term by term") {
  const EnergyLedger one{
      .sent = 10, .missed = 1, .out_of_range = 2, .absorbed = 1.5, .scattered = 4, .cut = 1.5, .received = 0.5};
  EnergyLedger sum = one;
  sum.add(one.times(3));
  CHECK(sum == one.times(4));
  CHECK(sum == EnergyLedger{40, 4, 8, 6, 16, 6, 2});
  CHECK(one.share(&EnergyLedger::scattered) == 0.4);
  CHECK(EnergyLedger{}.share(&EnergyLedger::scattered) == 0);
}

TEST_CASE("a range gate includes both its ends") {
  const RangeGate gate{2, 100};
  CHECK(gate.contains(2));
  CHECK(gate.contains(100));
  CHECK_FALSE(gate.contains(1.9999));
  CHECK_FALSE(gate.contains(100.0001));
  CHECK_FALSE(gate.contains(std::numeric_limits<double>::quiet_NaN()));
  CHECK(RangeGate{}.contains(1e300));
}
