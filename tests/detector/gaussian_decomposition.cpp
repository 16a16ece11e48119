// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/detector/gaussian_decomposition.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <utility>
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
  const WaveformSettings settings{
      .threshold = 0.05 * power, .window = 0, .timing = EchoTiming::peak, .record_length = 300e-9};
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

TEST_CASE(
    "plates that overlap, in the default pulse: each is in its place, of its power and object, also without a peak of "
    "its own") {
  const double length = 0.5 * speed_of_light * laser.pulse_length;
  const WaveformSettings settings{
      .threshold = 0.02 * power, .window = 0, .timing = EchoTiming::peak, .record_length = 300e-9};
  const auto check = [&](const auto& inside, double error) {
    GaussianDecomposition d{inside};
    d.prepare(laser);
    for (const double apart : {1.0, 1.5, 2.0})
      for (const auto& shares : {std::pair{1.0, 1.0}, {1.0, 0.3}, {0.3, 1.0}}) {
        const double first = shares.first, second = shares.second;
        INFO(apart, " pulse lengths apart, ", first, " to ", second);
        const double ranges[]{100.1, 100.1 + apart * length}, powers[]{first * power, second * power};
        const auto found = echoes(d, {{.range = ranges[0], .power = powers[0], .object = 1},
                                      {.range = ranges[1], .power = powers[1], .object = 2}});
        REQUIRE(found.size() == 2);
        for (std::size_t k = 0; k < 2; ++k) {
          CHECK(std::fabs(found[k].range - ranges[k]) < error);
          CHECK(found[k].amplitude == doctest::Approx(powers[k]).epsilon(1e-3));
          CHECK(found[k].number == k + 1);
        }
      }
  };
  check(FullWaveform{settings}, 2e-5);
  check(FullWaveform{settings, NoWidth{}, BandLimitedReceiver{}}, 2e-6);
  check(FullWaveform{settings, NoWidth{}, BandLimitedReceiver{ReceiverChain{.bandwidth = 350e6}}}, 2e-6);
  check(FullWaveform{settings, NoWidth{}, BandLimitedReceiver{ReceiverChain{.matched_filter = true}}}, 2e-5);
}

TEST_CASE("a slope of one plane is one echo, of its middle and spread, whatever its length") {
  GaussianDecomposition d{FullWaveform{WaveformSettings{.threshold = 0.02 * power, .record_length = 300e-9}, NoWidth{},
                                       BandLimitedReceiver{}}};
  d.prepare(laser);
  for (const double lengths : {0.05, 0.2, 0.5, 1.0, 2.0, 3.0, 5.0}) {
    CAPTURE(lengths);
    const double spread = lengths * 0.5 * speed_of_light * laser.pulse_length;
    std::vector<Reflection> slope;
    for (int k = 0; k < 500; ++k)
      slope.push_back({.range = 110 + spread * ((k + 0.5) / 500 - 0.5), .power = power / 500});
    const auto found = echoes(d, slope);
    REQUIRE(found.size() == 1);
    CHECK(std::fabs(found[0].range - 110) < 1e-3);
  }
}

TEST_CASE("ranges do not depend on the length of the record, as long as it holds the echo") {
  for (const double noise : {0.0, 1e-5})
    for (const double length : {290e-9, 300e-9, 390e-9, 420e-9, 2e-6}) {
      CAPTURE(noise);
      CAPTURE(length);
      GaussianDecomposition d{
          FullWaveform{WaveformSettings{.threshold = 0.1 * power, .record_length = length}, NoWidth{},
                       BandLimitedReceiver{ReceiverChain{.noise_power = noise * power / std::sqrt(2e9)}}}};
      d.prepare(laser);
      auto w = d.workspace(1);
      std::vector<Reflection> wall{{.range = 500, .power = power}};  // 267 ns after the start of the gate
      const Detection found = d.detect({emitter, {460, 540}, wall, {.seed = 1}}, w);
      REQUIRE(found.echoes.size() == 1);
      CHECK(std::fabs(found.echoes[0].range - 500) < 1e-5);
      CHECK(found.echoes[0].width > 0);
    }
}

TEST_CASE(
    "in noise, overlapping plates are unbiased; those a pulse length apart are two echoes for most pulses, else one") {
  // samples whose noise is a hundredth of the greater echo
  const LowPass filter = ReceiverChain{}.filter(laser.pulse_length);
  const double gain = ReceivedPulse(GammaPulse{}, laser.pulse_length, filter, 0.25e-9).gain();
  const double noise = 0.01 * power * gain / std::sqrt(filter.noise_bandwidth());
  GaussianDecomposition d{FullWaveform{
      WaveformSettings{.threshold = 0.06 * power, .prominence = 0.06 * power, .window = 0, .record_length = 200e-9},
      NoWidth{}, BandLimitedReceiver{ReceiverChain{.noise_power = noise}}}};
  d.prepare(laser);
  const double length = 0.5 * speed_of_light * laser.pulse_length;
  constexpr int pulses = 200;
  for (const double apart : {1.0, 1.5, 2.0})
    for (const double second : {1.0, 0.3}) {
      int both = 0;
      double sums[2]{}, squares[2]{};
      for (int k = 0; k < pulses; ++k) {
        const double ranges[]{100 + 0.0375 * k / pulses, 100 + 0.0375 * k / pulses + apart * length};
        const auto found =
            echoes(d, {{.range = ranges[0], .power = power}, {.range = ranges[1], .power = second * power}},
                   static_cast<std::uint64_t>(k));
        if (found.size() != 2) {
          CHECK(found.size() == 1);
          continue;
        }
        ++both;
        for (std::size_t e = 0; e < 2; ++e) {
          sums[e] += found[e].range - ranges[e];
          squares[e] += (found[e].range - ranges[e]) * (found[e].range - ranges[e]);
        }
      }
      INFO(apart, " pulse lengths apart, 1 to ", second, ": both in ", both, " of ", pulses);
      CHECK(both > (apart > 1 ? 0.99 : 0.8) * pulses);
      for (std::size_t e = 0; e < 2 && apart > 1; ++e) {
        const double mean = sums[e] / both, deviation = std::sqrt(squares[e] / both - mean * mean);
        CHECK(std::fabs(mean) < 3.5 * deviation / std::sqrt(static_cast<double>(both)));
      }
    }
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
        doctest::Approx(std::sqrt(2 * of_pulse * of_pulse + squares * 4 / (speed_of_light * speed_of_light)))
            .epsilon(3e-3));
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
