// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Pulse rate and length: 1 Hz and 1 fs to 10 GHz and 1 ms.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/base/units.hpp>
#include <pulsecast/deflector/deflector.hpp>
#include <pulsecast/deflector/pattern_table.hpp>
#include <pulsecast/scanner/scanner.hpp>

#include "extremes/detectors.hpp"
#include "extremes/row.hpp"

using namespace pulsecast;
using namespace pulsecast::extremes;

namespace {

const std::string quantity = "pulse rate and length";

}  // namespace

TEST_CASE("pulse rates") {
  const std::vector<BeamAngles> entries{{0, 0}, {0.1, 0}, {0.2, 0}, {0.3, 0}, {0.4, 0}, {0.5, 0}, {0.6, 0}};
  struct Case {
    const char* name;
    double rate;
    PulseIndex first;
    double bound;  // of the time [slots]
  };
  for (const auto& [name, rate, first, bound] : {Case{"1 Hz, from pulse 1e12", 1, 1'000'000'000'000, 1e-12},
                                                 {"10 GHz, from pulse 1", 1e10, 1, 1e-5},
                                                 {"10 GHz, from pulse 1e12", 1e10, 1'000'000'000'000, 1e-5}}) {
    const Deflector source{PatternTable{.entries = entries, .entry_rate = rate},
                           Scanner{.pulse_rate = rate, .pulses = first + 100'000}};
    double worst = 0, other_entry = 0;
    for (PulseIndex i = first; i < first + 100'000; ++i) {
      const auto pulse = source.pulse(i);
      REQUIRE(pulse);
      const auto each = static_cast<std::uint64_t>(rate);
      const double exact = static_cast<double>(i % each) / rate;  // of the second
      worst = std::max(worst, std::fabs(static_cast<double>(pulse->tick.second - static_cast<std::int64_t>(i / each)) +
                                        (pulse->tick.fraction - exact)) *
                                  rate);
      other_entry +=
          std::fabs(std::atan2(pulse->direction().x, pulse->direction().y) - entries[i % 7].azimuth) < 1e-9 ? 0 : 1;
    }
    row(quantity, name + std::string(", 100 000 pulses: largest error of the time [slots]"), 0, worst, bound);
    row(quantity, name + std::string(", 100 000 pulses through a table of 7 entries: how many by a wrong one"), 0,
        other_entry, 0);
  }
  refused(quantity, "0 Hz", [] { Scanner{.pulse_rate = 0}.validate(); });
  refused(quantity, "10 us for a rate", [] { Scanner{.pulse_rate = 1e-5}.validate(); });
  refused(quantity, "1e13 Hz", [] { Scanner{.pulse_rate = 1e13}.validate(); });
}

TEST_CASE("pulse lengths, before a wall") {
  struct Case {
    const char* name;
    double length;
  };
  for (const auto& [name, length] :
       {Case{"1 fs", 1e-15}, {"1 ps", 1e-12}, {"1 ns", 1e-9}, {"1 us", 1e-6}, {"1 ms", 1e-3}}) {
    const Laser laser{.pulse_length = length};
    const WaveformSettings settings{.sample_interval = length / 10, .threshold = 0, .window = length / 4};
    const Errors errors = errors_at_wall(laser, 100, settings);
    const std::string pulse = name + std::string(", wall at 100 m, all detectors and widths: ");
    row(quantity, pulse + "largest error of the range [m]", 0, errors.range, 1e-9);
    row(quantity, pulse + "largest error of the amplitude, as a share", 0, errors.amplitude, 1e-3);
    row(quantity, pulse + "largest error of the width, as a share", 0, errors.width, 0.01);
  }
  // a double tells two-way times of 0.27 s from each other by 6e-17 s, a fifth of the tau of 1 fs
  const Laser shortest{.pulse_length = 1e-15};
  const WaveformSettings bins{
      .sample_interval = 1e-16, .threshold = 0, .window = 1e-15, .timing = EchoTiming::true_range};
  const auto far_away = [&](const auto& detector) {
    const auto echoes = validation::one_pulse(Wall{4e7}, SingleRay{}, shortest, validation::vacuum, detector).echoes;
    REQUIRE(echoes.size() == 1);
    CHECK(echoes[0].range == 4e7);
    return echoes[0].amplitude / from_wall(shortest, 4e7);
  };
  row(quantity, "1 fs, wall at 40 000 km, AnalyticWaveform: amplitude, of the right one", 1,
      far_away(AnalyticWaveform<>(bins)), 1e-6);
  row(quantity, "1 fs, wall at 40 000 km, FullWaveform: amplitude, of the right one", 1, far_away(FullWaveform<>(bins)),
      0.1);
}

TEST_CASE("pulse lengths, before two walls") {
  // so short that walls a micrometre apart are two echoes
  const Laser shortest{.pulse_length = 1e-15, .divergence = 1e-6};
  const WaveformSettings fine{.sample_interval = 1e-16, .threshold = 0, .window = 0};
  double worst = 0;
  for_each_waveform(fine, [&](const char* name, const auto& detector) {
    CAPTURE(name);
    const auto echoes =
        validation::one_pulse(TwoWalls{100, 100.000001}, TwoRays{}, shortest, validation::vacuum, detector).echoes;
    REQUIRE(echoes.size() == 2);
    worst = std::max({worst, std::fabs(echoes[0].range - 100), std::fabs(echoes[1].range - 100.000001)});
  });
  row(quantity, "1 fs, walls 1 um apart: largest error of two ranges, all detectors and widths [m]", 0, worst, 1e-8);

  // and so long that walls 10 km apart are one, at the mean that their powers give
  const Laser longest{.pulse_length = 1e-3, .divergence = 1e-6};
  const WaveformSettings coarse{.sample_interval = 1e-6, .threshold = 0};
  const double near = 5000, far = 15000, share = 1 / (near * near) / (1 / (near * near) + 1 / (far * far));
  worst = 0;
  for_each_waveform(coarse, [&](const char* name, const auto& detector) {
    CAPTURE(name);
    const auto echoes =
        validation::one_pulse(TwoWalls{near, far}, TwoRays{}, longest, validation::vacuum, detector).echoes;
    REQUIRE(echoes.size() == 1);
    worst = std::max(worst, std::fabs(echoes[0].range - (share * near + (1 - share) * far)));
  });
  row(quantity, "1 ms, walls 10 km apart: largest error of the mean range, all detectors and widths [m]", 0, worst,
      1e-3);
}

TEST_CASE("pulses that cannot be") {
  refused(quantity, "0.1 fs", [] { Scanner{.laser = {.pulse_length = 1e-16}}.validate(); });
  refused(quantity, "10 s", [] { Scanner{.laser = {.pulse_length = 10}}.validate(); });
}
