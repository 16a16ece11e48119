// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/sample.hpp>

#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/base/units.hpp>
#include <pulsecast/cloud.hpp>
#include <pulsecast/deflector/deflector.hpp>
#include <pulsecast/deflector/polygon_mirror.hpp>
#include <pulsecast/detector/first_hit.hpp>
#include <pulsecast/platform/platform.hpp>
#include <pulsecast/platform/tripod.hpp>
#include <pulsecast/run.hpp>
#include <pulsecast/scanner/scanner.hpp>

#include "support/archetypes.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

namespace {

const support::LeastRayTarget plane;

/// A mirror that looks down for a part of its sweep, and at the sky for another; with noise.
auto survey() {
  return Survey{
      Platform{Tripod{.position = {0, 0, 10}}, Mount{},
               Deflector{PolygonMirror{.line_rate = 10, .sweep = 170_deg, .angle_min = -160_deg, .angle_max = 80_deg},
                         Scanner{.pulse_rate = 10_kHz, .pulses = 3000}}},
      SingleRay{},
      plane,
      Receiver{.range_errors = {.deviation = 0.1}},
      FirstHit{},
      3};
}

TEST_CASE("samples and counts are those of a run, on any number of threads") {
  const ResultBuffer all = [] {
    ResultBuffer buffer;
    const auto s = survey();
    auto workspace = s.workspace();
    for (PulseIndex i = 0; i < s.size(); ++i) buffer.append(s(i, workspace));
    return buffer;
  }();
  REQUIRE(all.counts.count(Fate::returned) > 500);
  REQUIRE(all.counts.count(Fate::missed) > 100);
  const std::vector<SampleBlock> blocks{{0, 10, 20}, {990, 1000, 2500}, {2000, 2000, 2000}, {0, 0, 3000}};
  const std::vector<PulseIndex> slots{3, 2999, 700, 1500, 701};
  for (const unsigned threads : {1U, 2U}) {
    CAPTURE(threads);
    const std::vector<Sample> samples = sample(survey(), blocks, threads);
    REQUIRE(samples.size() == blocks.size());
    for (std::size_t k = 0; k < blocks.size(); ++k) {
      CAPTURE(k);
      CHECK(samples[k].counts.slots == blocks[k].end - blocks[k].from);
      std::vector<double> expected, found;
      const EchoBatch every = all.batch(0), some = samples[k].batch();
      for (const Shot& shot : every.shots)
        if (shot.index >= blocks[k].from && shot.index < blocks[k].end)
          for (const Echo& echo : every.echoes_of(shot)) expected.push_back(echo.range);
      for (const Echo& echo : some.echoes) found.push_back(echo.range);
      CHECK(found == expected);
    }
    CHECK(samples.back().counts.fates == all.counts.fates);
    const std::vector<SlotCount> counts = count_echoes(survey(), slots, threads);
    REQUIRE(counts.size() == slots.size());
    const auto s = survey();
    auto workspace = s.workspace();
    for (std::size_t k = 0; k < slots.size(); ++k) {
      const Outcome outcome = s(slots[k], workspace);
      CHECK(counts[k].fate == outcome.shot.fate);
      CHECK(counts[k].echoes == outcome.echoes.size());
    }
  }
}

TEST_CASE("a sample counts shots without echoes, and keeps them where they are read") {
  const AnySurvey s = survey();
  const std::vector<SampleBlock> blocks{{0, 0, 3000, true}, {0, 0, 3000, false}};
  const std::vector<Sample> samples = sample(s, blocks);
  CHECK(samples[0].counts.fates == samples[1].counts.fates);
  CHECK(samples[0].shots.size() == samples[0].counts.pulses());
  CHECK(samples[1].shots.size() == samples[1].counts.count(Fate::returned));
  CHECK(samples[0].echoes.size() == samples[1].echoes.size());
}

}  // namespace
