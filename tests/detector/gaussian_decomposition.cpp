// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/detector/gaussian_decomposition.hpp>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include <pulsecast/detector/band_limited_receiver.hpp>
#include <pulsecast/detector/full_waveform.hpp>

#include <doctest/doctest.h>

#include "support/laws.hpp"

using namespace pulsecast;

namespace {

constexpr double power = 1e-6;
const Laser laser{.pulse_length = 4e-9};
const Emitter emitter{.laser = laser};
const double of_pulse = laser.pulse_length / std::sqrt(8 * std::numbers::ln2);  // deviation [s]

auto detector(const ReceiverChain& chain = {}) {
  const WaveformSettings settings{.threshold = 0.05 * power, .window = 0, .timing = EchoTiming::peak, .record_length = 300e-9};
  GaussianDecomposition made{FullWaveform{settings, NoWidth{}, BandLimitedReceiver{chain, GaussianPulse{}}}};
  made.prepare(laser);
  return made;
}

template <class D>
std::vector<Echo> echoes(const D& d, std::vector<Reflection> reflections, std::uint64_t pulse = 0) {
  auto w = d.workspace(reflections.size());
  const Detection found = d.detect({emitter, {90, 140}, reflections, {.seed = 1, .pulse = pulse}}, w);
  return {found.echoes.begin(), found.echoes.end()};
}

}  // namespace

TEST_CASE("overlapping echoes have the ranges, amplitudes and widths that they have alone") {
  const auto d = detector();
  const auto peaks = d.inner;
  for (const double apart : {0.95, 1.2, 2.0})
    for (const double second : {0.6, 1.0}) {
      const std::vector<Reflection> two{{.range = 100.1, .power = power, .object = 1},
                                        {.range = 100.1 + apart, .power = second * power, .object = 2}};
      const auto found = echoes(d, two);
      CAPTURE(apart);
      CAPTURE(second);
      REQUIRE(found.size() == 2);
      CHECK(std::fabs(found[0].range - 100.1) < 1e-4);
      CHECK(std::fabs(found[1].range - 100.1 - apart) < 1e-4);
      CHECK(found[0].amplitude == doctest::Approx(power).epsilon(1e-3));
      CHECK(found[1].amplitude == doctest::Approx(second * power).epsilon(1e-3));
      for (const Echo& echo : found) CHECK(echo.width == doctest::Approx(of_pulse * std::numbers::sqrt2).epsilon(1e-3));
      CHECK(found[1].object == 2);
      CHECK(found[1].number == 2);
    }
  // the peaks of the same waveform attract each other
  const auto of_peaks = echoes(peaks, {{.range = 100.1, .power = power}, {.range = 101.05, .power = power}});
  REQUIRE(of_peaks.size() == 2);
  CHECK(of_peaks[0].range > 100.11);
}

TEST_CASE("the width of a slope grows by the spread of its ranges") {
  std::vector<Reflection> slope;
  double squares = 0;
  for (int k = -50; k <= 50; ++k) {
    const double aside = 0.25 * k / 50;
    slope.push_back({.range = 110 + aside, .power = power / 101});
    squares += aside * aside / 101;
  }
  const auto found = echoes(detector(), slope);
  REQUIRE(found.size() == 1);
  CHECK(std::fabs(found[0].range - 110) < 1e-4);
  CHECK(found[0].width ==
        doctest::Approx(std::sqrt(2 * of_pulse * of_pulse + squares * 4 / (speed_of_light * speed_of_light))).epsilon(3e-3));
}

TEST_CASE("in noise, echoes are as near as the Cramer-Rao bound lets them, or fewer") {
  const auto d = detector({.noise_power = power / 300 / std::sqrt(2e9)});
  int both = 0;
  double squares = 0;
  for (std::uint64_t k = 0; k < 200; ++k) {
    const auto found = echoes(d, {{.range = 100.1, .power = power}, {.range = 101.3, .power = power}}, k);
    if (found.size() != 2) continue;
    ++both;
    squares += std::pow(found[0].range - 100.1, 2);
  }
  CHECK(both > 190);
  CHECK(std::sqrt(squares / both) < 5e-3);
}

TEST_CASE("without a record, outside of it, or in a crowd, echoes stay what they were") {
  FullWaveform plain{WaveformSettings{.threshold = 0.05 * power, .timing = EchoTiming::peak}, NoWidth{},
                     BandLimitedReceiver{ReceiverChain{}, GaussianPulse{}}};
  GaussianDecomposition d{plain};
  d.prepare(laser);
  plain.prepare(laser);
  const std::vector<Reflection> one{{.range = 100.1, .power = power}};
  CHECK(echoes(d, one)[0].range == echoes(plain, one)[0].range);
  const auto recorded = detector();
  CHECK(std::fabs(echoes(recorded, {{.range = 95, .power = power}, {.range = 139, .power = power}})[1].range - 139) <
        5e-3);  // 44 m: the record has ended
  std::vector<Reflection> crowd;
  for (int k = 0; k < 9; ++k) crowd.push_back({.range = 100 + 1.3 * k, .power = power});
  CHECK(echoes(recorded, crowd).size() >= 7);
  const std::vector<std::vector<Reflection>> cases{one, {}, crowd};
  CHECK(support::detector_laws(recorded, laser, cases) == "");
}
