// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/detector/returns.hpp>

#include <cmath>
#include <vector>

#include <pulsecast/detector/full_waveform.hpp>

#include <doctest/doctest.h>

#include "support/detect.hpp"
#include "support/laws.hpp"

using namespace pulsecast;

namespace {

const Laser laser{.pulse_length = 2e-9};
const WaveformSettings settings{.returns_max = 255, .timing = EchoTiming::true_range};

/// Ranges of the echoes, rounded to metres; checks that they are numbered in order.
template <class D>
std::vector<double> ranges(const D& detector, std::vector<Reflection> reflections) {
  auto w = detector.workspace(reflections.size());
  const Detection d = support::detect(detector, laser, reflections, w);
  std::vector<double> found;
  for (std::size_t e = 0; e < d.echoes.size(); ++e) {
    CHECK(d.echoes[e].number == e + 1);
    found.push_back(std::round(d.echoes[e].range));
  }
  return found;
}
std::vector<double> selected(ReturnMode mode, std::vector<Reflection> reflections, std::size_t number = 3) {
  return ranges(SelectedReturns{mode, FullWaveform{settings}, number}, std::move(reflections));
}

using List = std::vector<double>;
const std::vector<Reflection> five{{.range = 10, .power = 2e-6},
                                   {.range = 20, .power = 5e-6},
                                   {.range = 30, .power = 1e-6},
                                   {.range = 40, .power = 4e-6},
                                   {.range = 50, .power = 3e-6}};

}  // namespace

TEST_CASE("each mode keeps its echoes, numbered in order of range") {
  CHECK(selected(ReturnMode::first, five) == List{10});
  CHECK(selected(ReturnMode::last, five) == List{50});
  CHECK(selected(ReturnMode::strongest, five) == List{20});
  CHECK(selected(ReturnMode::first_and_last, five) == List{10, 50});
  CHECK(selected(ReturnMode::strongest_and_last, five) == List{20, 50});
  CHECK(selected(ReturnMode::n_nearest, five, 2) == List{10, 20});
  CHECK(selected(ReturnMode::n_strongest, five, 3) == List{20, 40, 50});
  CHECK(selected(ReturnMode::n_strongest, five, 9) == List{10, 20, 30, 40, 50});
}

TEST_CASE("the strongest that is the last is reported with the second strongest") {
  const std::vector<Reflection> rising{{.range = 10, .power = 1e-6},
                                       {.range = 20, .power = 3e-6},
                                       {.range = 30, .power = 2e-6},
                                       {.range = 40, .power = 5e-6}};
  CHECK(selected(ReturnMode::strongest_and_last, rising) == List{20, 40});
}

TEST_CASE("one echo, and none, stay what they are") {
  for (const ReturnMode mode : {ReturnMode::first, ReturnMode::last, ReturnMode::strongest, ReturnMode::first_and_last,
                                ReturnMode::strongest_and_last}) {
    CHECK(selected(mode, {{.range = 10, .power = 1e-6}}) == List{10});
    CHECK(selected(mode, {}).empty());
  }
}

TEST_CASE("ranges are folded exactly, in order, and lost where the instrument is blind") {
  const double rate = 1e6;
  const MultiplePulsesInAir folded{rate, FullWaveform{settings}};
  const double ambiguity = folded.ambiguity();
  CHECK(ambiguity == doctest::Approx(149.896229));
  auto w = folded.workspace(3);
  std::vector<Reflection> reflections{
      {.range = 100, .power = 1e-6}, {.range = 160, .power = 2e-6}, {.range = 910, .power = 1e-6}};
  const Detection d = support::detect(folded, laser, reflections, w);
  REQUIRE(d.echoes.size() == 3);
  CHECK(d.echoes[1].range == std::fmod(910.0, ambiguity));
  CHECK(d.echoes[0].range == std::fmod(160.0, ambiguity));
  CHECK(d.echoes[2].range == 100);
  CHECK(ranges(MultiplePulsesInAir{rate, FullWaveform{settings}, 10.5},
               {{.range = 100, .power = 1e-6}, {.range = 160, .power = 2e-6}}) == List{100});
}

TEST_CASE("an instrument that resolves multiple pulses in the air has blind zones about multiples of c / 2f") {
  const double ambiguity = 299'792'458 / 2e6;
  std::vector<Reflection> reflections;
  for (const double range : {5.0, 100.0, ambiguity + 5, ambiguity + 20, 6 * ambiguity + 9.9, 6 * ambiguity + 10.1})
    reflections.push_back({.range = range, .power = 1e-6});
  const List seen = ranges(MultiplePulsesInAir{1e6, FullWaveform{settings}, 10, RangeAmbiguity::resolved}, reflections);
  REQUIRE(seen.size() == 3);
  CHECK(seen[0] == 100);
  CHECK(seen[1] == 170);
  CHECK(seen[2] == 909);
}

TEST_CASE("the laws of detectors, and settings that are refused") {
  const std::vector<std::vector<Reflection>> cases{five, {}, {{.range = 3, .power = 1e-6}}};
  CHECK(support::detector_laws(SelectedReturns{ReturnMode::n_strongest, FullWaveform{settings}}, laser, cases) == "");
  CHECK(support::detector_laws(MultiplePulsesInAir{1e5, FullWaveform{settings}}, laser, cases) == "");
  CHECK_THROWS_AS((SelectedReturns{ReturnMode::n_nearest, FullWaveform{settings}, 0}), SettingError);
  CHECK_THROWS_AS((MultiplePulsesInAir{0, FullWaveform{settings}}), SettingError);
}
