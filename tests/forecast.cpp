// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/forecast.hpp>

#include <cmath>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/run.hpp>

#include "support/relative.hpp"

using namespace pulsecast;

namespace {

/// A survey whose slots have so many echoes, in stretches that repeat; `offset` moves them all [m].
struct Pattern {
  struct Workspace {
    std::vector<Echo> echoes;
  };
  PulseIndex slots = 100'000;
  std::vector<int> echoes{1};  ///< of the slots of a stretch; -1: blocked
  PulseIndex stretch = 1;      ///< length [slots]
  double offset = 0;

  Workspace workspace() const { return {.echoes = std::vector<Echo>(8)}; }
  PulseIndex size() const noexcept { return slots; }
  std::size_t subrays() const noexcept { return 1; }
  std::size_t recorded_subrays() const noexcept { return 0; }
  double sample_interval() const noexcept { return 0; }
  int at(PulseIndex i) const noexcept { return echoes[(i / stretch) % echoes.size()]; }
  Outcome operator()(PulseIndex i, Workspace& w) const noexcept {
    Outcome outcome;
    outcome.shot.index = i;
    outcome.shot.fate = at(i) < 0 ? Fate::blocked : at(i) == 0 ? Fate::missed : Fate::returned;
    const auto n = static_cast<std::size_t>(std::max(0, at(i)));
    for (std::size_t k = 0; k < n; ++k) {
      w.echoes[k].range = 10 * static_cast<double>(k + 1) + offset;
      w.echoes[k].amplitude = 1 + offset;
    }
    outcome.echoes = std::span(w.echoes).first(n);
    return outcome;
  }
};
static_assert(PulseSurvey<Pattern>);

bool holds(const Estimate& estimate, double truth) { return estimate.low <= truth && truth <= estimate.high; }

TEST_CASE("a survey of equal pulses is forecast exactly, by whatever sample") {
  for (const int echoes : {1, 3}) {
    const RunEstimate all = RunForecaster(Pattern{.echoes = {echoes}}).estimate();
    for (const double end : {all.echoes.value, all.echoes.low, all.echoes.high})
      CHECK(end == support::relative(1e5 * echoes, 1e-12));
    CHECK(all.pulses.value == support::relative(1e5, 1e-12));
    CHECK(all.empty_pulses.value == 0);
    CHECK(all.sampled > 0);
    CHECK(all.seconds.value >= 0);
    CHECK(all.seconds.low <= all.seconds.value);
    CHECK(all.seconds.value <= all.seconds.high);
  }
}

TEST_CASE("a survey without slots, or without pulses, has a forecast, too") {
  CHECK(RunForecaster(Pattern{.slots = 0}).estimate().echoes.high == 0);
  const RunForecaster blocked(Pattern{.echoes = {-1}});
  CHECK(blocked.estimate().pulses.value == 0);
  CHECK(blocked.spread_results(5).size() == 5);
}

TEST_CASE("the limits of a forecast hold the totals of the run, for most seeds") {
  const Pattern survey{.slots = 400'000, .echoes = {-1, 0, 1, 2, 1, 0, 0}, .stretch = 333};
  const RunSummary run = pulsecast::run(survey, {});
  int held = 0;
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const RunEstimate all = RunForecaster(survey, {.seed = seed}).estimate();
    held += holds(all.echoes, static_cast<double>(run.echoes)) ? 1 : 0;
    held += holds(all.pulses, static_cast<double>(run.pulses())) ? 1 : 0;
    held += holds(all.empty_pulses, static_cast<double>(run.count(Fate::missed))) ? 1 : 0;
  }
  CHECK(held >= 12);  // 19 of 20 are expected
}

TEST_CASE("slots that are spread over the results have some") {
  const Pattern survey{.echoes = {-1, 0, 1}, .stretch = 100};
  for (const bool empty_shots : {false, true})
    for (const PulseIndex slot : RunForecaster(survey, {.empty_shots = empty_shots}).spread_results(24))
      CHECK(survey.at(slot) >= (empty_shots ? 0 : 1));
}

TEST_CASE("variants are forecast by what they change on the same pulses, and differ from a finer survey by as much") {
  const Pattern survey{.echoes = {1, 0}, .stretch = 50}, more{.echoes = {3, 0}, .stretch = 50},
      moved{.echoes = {1, 0}, .stretch = 50, .offset = 0.125};
  const RunForecaster forecaster(survey);
  RunEstimate known = forecaster.estimate();
  known.echoes = {5e4, 5e4, 5e4};
  const VariantForecaster variants(forecaster, known, survey, 1, 3);
  CHECK(variants.estimate(survey).echoes.value == 5e4);
  CHECK(std::fabs(variants.estimate(more).echoes.value / 1.5e5 - 1) < 0.1);
  const auto errors = [&](const Pattern& variant, double reach) { return variants.errors(variant, reach).all; };
  const EchoErrors same = errors(survey, 1), other = errors(moved, 1), far = errors(moved, 0.1),
                   twice = errors(more, 1);
  CHECK(same[ErrorFigure::range_95].value == 0);
  CHECK(same[ErrorFigure::lost].value == 0);
  CHECK(other[ErrorFigure::range_95].value == 0.125);
  CHECK(other[ErrorFigure::intensity_95].value == 0.125);
  CHECK(other[ErrorFigure::lost].value == 0);
  CHECK(far[ErrorFigure::lost].value == 1);
  CHECK(far[ErrorFigure::invented].value == 1);
  CHECK(std::isinf(far[ErrorFigure::range_95].high));
  CHECK(twice[ErrorFigure::lost].value == 0);
  CHECK(twice[ErrorFigure::invented].value == support::relative(2.0 / 3, 1e-12));
}

}  // namespace
