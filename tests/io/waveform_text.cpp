// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/waveform_text.hpp>

#include <cmath>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "support/generators.hpp"
#include "support/temporary_folder.hpp"

namespace pulsecast::io {
namespace {

using support::content;
using support::TemporaryFolder;

std::string written(const EchoBatch& batch, WaveformTextSettings settings = {}) {
  const TemporaryFolder folder;
  WaveformTextWriter writer(folder / "waveforms.txt", settings);
  writer(batch);
  writer.close();
  return content(folder / "waveforms.txt");
}

TEST_CASE("a waveform is a line of ten columns and its samples; times are one-way, in nanoseconds") {  // samples have a float's 7 digits
  Shot shot;
  shot.index = 41;
  shot.tick = {7, 0.25};
  shot.origin = {100, 200, 50};
  shot.direction = {0, 0, -1};
  shot.waveform_start = 200e-9;
  shot.first_sample = 1;
  shot.samples = 3;
  const std::vector<Shot> shots{Shot{}, shot};
  const std::vector<float> samples{99, 0.5e-9F, 0, -0.25e-9F, 99};
  CHECK(written({shots, {}, samples, 2e-9}, {.start_time = 1000}) ==
        "41 100.0000 200.0000 50.0000 0.000000000 0.000000000 -1.000000000 100.000000 102.000000 1007.250000000 "
        "0.499999986 0.000000000 -0.249999993\n");
}

TEST_CASE("each sample is found at the range that its column says, and keeps its power") {
  support::Generator random(1);
  constexpr double interval = 0.25e-9;
  std::vector<Shot> shots;
  std::vector<float> samples;
  for (PulseIndex i = 0; i < 100; ++i) {
    Shot shot;
    shot.index = i;
    shot.origin = random.point(1e6);
    shot.direction = random.unit();
    shot.waveform_start = random.uniform(1e-9, 1e-4);
    shot.first_sample = samples.size();
    shot.samples = static_cast<std::uint32_t>(2 + random.whole(200));
    for (std::uint32_t k = 0; k < shot.samples; ++k) samples.push_back(static_cast<float>(random.log_uniform(1e-12, 1e-3)));
    shots.push_back(shot);
  }
  const EchoBatch batch{shots, {}, samples, interval};
  std::istringstream lines(written(batch));
  for (const Shot& shot : shots) {
    CAPTURE(shot.index);
    std::string line;
    REQUIRE(std::getline(lines, line));
    std::istringstream columns(line);
    std::vector<double> values(10 + shot.samples);
    for (double& value : values) columns >> value;
    REQUIRE(columns);
    CHECK(columns.eof());
    CHECK(values[0] == static_cast<double>(shot.index));
    for (int axis = 0; axis < 3; ++axis) {
      CHECK(std::fabs(values[1 + static_cast<std::size_t>(axis)] - shot.origin[axis]) <= 0.51e-4);
      CHECK(std::fabs(values[4 + static_cast<std::size_t>(axis)] - shot.direction[axis]) <= 0.51e-9);
    }
    for (std::uint32_t k = 0; k < shot.samples; ++k) {
      const double at = values[7] + (values[8] - values[7]) * k / (shot.samples - 1);
      CHECK(std::fabs(at - (shot.waveform_start + k * interval) / 2 * 1e9) <= 1e-6);  // 0.3 um
      CHECK(std::fabs(values[10 + k] - double{batch.waveform_of(shot)[k]} * 1e9) <= 0.5e-9 + 1e-15 * values[10 + k]);
    }
  }
}

TEST_CASE("pulses without a waveform make no lines, those without echoes do; places must be finite") {
  const std::vector<float> samples{1e-9F};
  std::vector<Shot> shots(3);
  CHECK(written({shots, {}, samples, 1e-9}).empty());
  shots[1].samples = 1;
  CHECK(written({shots, {}, samples, 1e-9}) ==
        "0 0.0000 0.0000 0.0000 0.000000000 0.000000000 0.000000000 0.000000 0.000000 0.000000000 0.999999972\n");
  const TemporaryFolder folder;
  shots[1].origin.x = std::numeric_limits<double>::infinity();
  WaveformTextWriter writer(folder / "a.txt");
  CHECK_THROWS_AS(writer(EchoBatch{shots, {}, samples, 1e-9}), FileError);
  CHECK_THROWS_AS(WaveformTextWriter(folder / "b.txt", {.start_time = std::numeric_limits<double>::quiet_NaN()}), SettingError);
  CHECK(folder.empty());
}

}  // namespace
}  // namespace pulsecast::io
