// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/detector/detail/sample_window.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

#include <doctest/doctest.h>

#include "support/generators.hpp"

using namespace pulsecast;

namespace {

/// Peaks of samples, numbered from `first` on.
std::vector<Peak> peaks_of(const std::vector<double>& samples, const WaveformSettings& settings, double first = 0,
                           double delay = 0) {
  SampleWindow<NoWidth> window;
  const NoWidth width;
  std::vector<Peak> peaks;
  peaks.reserve(100'000);
  const SampleWindow<NoWidth>::Search search{settings, width, settings.separation, delay};
  for (std::size_t i = 0; i < samples.size(); ++i)
    window.take(first + static_cast<double>(i), samples[i], i + 1 < samples.size(), search, peaks);
  return peaks;
}

const WaveformSettings units{.sample_interval = 1, .threshold = 1, .window = 0};

}  // namespace

TEST_CASE("peaks have times from the first sample's number, less the receiver's delay") {
  const std::vector<double> y{0, 0, 1, 3, 5, 3, 1, 0, 0, 2, 4, 2, 0, 0};
  const auto peaks = peaks_of(y, units, 100, 7);
  REQUIRE(peaks.size() == 2);
  CHECK(peaks[0].time == doctest::Approx(97));
  CHECK(peaks[0].mark == peaks[0].time);
  CHECK(peaks[0].height == doctest::Approx(5));
  CHECK(peaks[1].time == doctest::Approx(103));
  CHECK(peaks[0].before == 0);
  CHECK(peaks[0].after == 0);
}

TEST_CASE("a plateau is one peak, in its middle; a step of the rise is none") {
  const auto flat = peaks_of({0, 0, 2, 4, 4, 4, 4, 2, 0, 0}, units);
  REQUIRE(flat.size() == 1);
  CHECK(flat[0].time == 4.5);
  CHECK(flat[0].height == 4);
  CHECK(flat[0].end >= 8);
  const auto stepped = peaks_of({0, 0, 2, 2, 2, 5, 7, 5, 2, 0, 0}, units);
  REQUIRE(stepped.size() == 1);
  CHECK(stepped[0].time == doctest::Approx(6));
}

TEST_CASE("a peak that rises too little above the valley merges with its neighbour") {
  const std::vector<double> y{0, 0, 4, 8, 6.5, 7, 3, 0, 0, 5, 0, 0, 0};
  WaveformSettings s = units;
  CHECK(peaks_of(y, s).size() == 3);
  s.prominence = 1;
  const auto merged = peaks_of(y, s);
  REQUIRE(merged.size() == 2);
  CHECK(merged[0].time == doctest::Approx(3).epsilon(0.2));
  CHECK(merged[0].height >= 8);
  CHECK(merged[1].height >= 5);
}

TEST_CASE("marks are where the timing says") {
  std::vector<double> y(80);
  for (std::size_t i = 0; i < y.size(); ++i)
    y[i] = 8 * std::exp(-0.5 * std::pow((static_cast<double>(i) - 40.3) / 6, 2));
  WaveformSettings s = units;
  s.timing = EchoTiming::constant_fraction;
  s.fraction = 0.25;
  const auto peaks = peaks_of(y, s);
  REQUIRE(peaks.size() == 1);
  CHECK(std::fabs(peaks[0].mark - (40.3 - 6 * std::sqrt(2 * std::log(4.0)))) < 1e-3);
}

TEST_CASE("peaks do not depend on where the window is cut") {
  std::vector<double> y(SampleWindow<NoWidth>::capacity + 50'000);
  for (std::size_t i = 0; i < y.size(); ++i) y[i] = 2 + std::cos(2 * std::numbers::pi * static_cast<double>(i) / 37.3);
  const auto peaks = peaks_of(y, units);
  const double cycles = static_cast<double>(y.size()) / 37.3;
  CHECK(std::fabs(static_cast<double>(peaks.size()) - cycles) < 2);
  for (std::size_t k = 1; k < peaks.size(); ++k) REQUIRE(std::fabs(peaks[k].time - peaks[k - 1].time - 37.3) < 0.01);
}

TEST_CASE("every maximum of any number of samples is found") {
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    std::vector<double> y(5 + any.whole(40));
    for (double& sample : y) sample = any.uniform(1, 2);
    std::vector<std::size_t> expected;
    for (std::size_t i = 2; i + 2 < y.size(); ++i)
      if (y[i] > y[i - 1] && y[i] > y[i + 1]) expected.push_back(i);
    const auto peaks = peaks_of(y, {.sample_interval = 1, .threshold = 1, .separation = 0, .window = 0});
    REQUIRE(peaks.size() == expected.size());
    for (std::size_t k = 0; k < peaks.size(); ++k)
      CHECK(std::fabs(peaks[k].time - static_cast<double>(expected[k])) <= 1);
  }
}
