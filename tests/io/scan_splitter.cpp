// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/scan_splitter.hpp>

#include <algorithm>
#include <cstddef>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/base/error.hpp>

#include "support/random_pulses.hpp"

namespace pulsecast::io {
namespace {

using support::RandomPulses;

struct Scan {
  double start;
  std::vector<double> pulses, times;
  friend bool operator==(const Scan&, const Scan&) = default;
};

/// Scans of pulses that come in batches of random lengths.
std::vector<Scan> scans_of(const RandomPulses& pulses, double rate, std::uint64_t seed) {
  const PointLayout layout = PointLayout::packed(
      {{"pulse", NumberType::float64, column("pulse")}, {"time", NumberType::float64, column("time")}});
  std::vector<Scan> scans;
  ScanSplitter splitter(PointBuffer(layout), rate, [&](const PointBuffer& points) {
    Scan scan{points.scan_start().seconds(), {}, {}};
    for (std::size_t i = 0; i < points.size(); ++i) {
      scan.pulses.push_back(points.number(i, layout.fields[0]));
      scan.times.push_back(points.number(i, layout.fields[1]));
    }
    scans.push_back(scan);
  });
  support::Generator random(seed);
  for (std::size_t first = 0; first < pulses.shots.size();) {
    const auto wanted = static_cast<std::size_t>(1 + 40 * random.uniform());
    const std::size_t count = std::min(wanted, pulses.shots.size() - first);
    splitter({.shots = {pulses.shots.data() + first, count}, .echoes = pulses.echoes, .samples = {}});
    first += count;
  }
  splitter.close();
  splitter.close();  // passes nothing on again
  return scans;
}

TEST_CASE("scans have equal times, begin at their multiples, and hold every point once, however batches fall") {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    CAPTURE(seed);
    const RandomPulses pulses(1000, seed, 250);
    const std::vector<Scan> scans = scans_of(pulses, 10, seed);
    CHECK(scans == scans_of(pulses, 10, seed + 1000));
    REQUIRE(scans.size() == 40);
    std::size_t points = 0;
    for (std::size_t n = 0; n < scans.size(); ++n) {
      CHECK(scans[n].start == Tick::of(n, 10).seconds());
      for (std::size_t k = 0; k < scans[n].pulses.size(); ++k) {
        CHECK((scans[n].pulses[k] >= 25.0 * static_cast<double>(n) &&
               scans[n].pulses[k] < 25.0 * static_cast<double>(n + 1)));
        CHECK((scans[n].times[k] >= 0 && scans[n].times[k] < 0.1));
      }
      points += scans[n].pulses.size();
    }
    CHECK(points == pulses.echoes.size());
  }
}

TEST_CASE("scans without pulses are left out, those without points are passed on") {
  RandomPulses pulses(30, 1, 10);
  for (Shot& shot : pulses.shots) shot.echoes = 0;
  pulses.shots.erase(pulses.shots.begin() + 10, pulses.shots.begin() + 20);
  const std::vector<Scan> scans = scans_of(pulses, 1, 2);
  REQUIRE(scans.size() == 2);
  CHECK((scans[0].start == 0 && scans[1].start == 2 && scans[1].pulses.empty()));
}

TEST_CASE("a run without pulses has no scans, and a rate of zero is refused") {
  CHECK(scans_of(RandomPulses(0, 0), 10, 0).empty());
  CHECK_THROWS_WITH_AS(ScanSplitter(PointBuffer(layouts::xyzi()), 0, [](const PointBuffer&) {}),
                       doctest::Contains("scan_rate"), SettingError);
}

}  // namespace
}  // namespace pulsecast::io
