// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/run_errors.hpp>

#include <cmath>
#include <functional>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include "../bench/error_scenes.hpp"
#include "support/counting_executor.hpp"
#include "support/generators.hpp"
#include "support/listed_survey.hpp"
#include "support/relative.hpp"

using namespace pulsecast;
using support::echo_at;
using support::Listed;

namespace {

std::vector<Echo> echoes_at(const std::vector<double>& ranges) {
  std::vector<Echo> all;
  for (const double range : ranges) all.push_back(echo_at(range));
  return all;
}

/// Pairs of numbers in order; -1 for none.
std::vector<std::pair<int, int>> matched(const std::vector<double>& expected, const std::vector<double>& found,
                                         double reach) {
  std::vector<std::pair<int, int>> all;
  const std::vector<Echo> e = echoes_at(expected), f = echoes_at(found);
  detail::EchoMatcher(reach).match(e, f, [&](const Echo* one, const Echo* other) {
    all.emplace_back(one ? static_cast<int>(one - e.data()) : -1, other ? static_cast<int>(other - f.data()) : -1);
  });
  std::sort(all.begin(), all.end());
  return all;
}
using Matches = std::vector<std::pair<int, int>>;

bool holds(const Estimate& e, double truth) { return e.low <= truth && truth <= e.high; }

const EchoErrors errors_between(const Listed& expected, const Listed& found, const ErrorSampleOptions& options = {}) {
  return errors_of_run(expected, std::vector<ErrorStep>{{"found", found}}, options).parts.front().all;
}

TEST_CASE("echoes are paired one to one in order, and those farther apart than the reach are lost and invented") {
  CHECK(matched({10}, {10.2}, 0.3) == Matches{{0, 0}});
  CHECK(matched({10}, {10.5}, 0.3) == Matches{{-1, 0}, {0, -1}});
  CHECK(matched({10}, {10.5}, 0.5) == Matches{{0, 0}});  // at the reach: a pair
  CHECK(matched({}, {1, 2}, 1) == Matches{{-1, 0}, {-1, 1}});
  CHECK(matched({1, 2}, {}, 1) == Matches{{0, -1}, {1, -1}});
  // the nearest to the first would leave the second without a partner
  CHECK(matched({10, 10.3}, {10.2, 10.45}, 0.3) == Matches{{0, 0}, {1, 1}});
  CHECK(matched({10, 10.25}, {10.24}, 0.3) == Matches{{0, -1}, {1, 0}});
  CHECK(matched({10.24}, {10, 10.25}, 0.3) == Matches{{-1, 0}, {0, 1}});
}

TEST_CASE("no other pairing costs less, for random echoes") {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    support::Generator any(seed);
    std::vector<double> expected, found;
    for (std::uint64_t k = any.whole(5); k > 0; --k) expected.push_back(any.uniform());
    for (std::uint64_t k = any.whole(5); k > 0; --k) found.push_back(any.uniform());
    std::sort(expected.begin(), expected.end());
    std::sort(found.begin(), found.end());
    const double reach = any.log_uniform(0.05, 1);
    // all injections, also those out of order
    const std::function<double(std::size_t, std::set<std::size_t>)> best = [&](std::size_t i,
                                                                               const std::set<std::size_t>& taken) {
      if (i == expected.size()) return reach / 2 * static_cast<double>(found.size() - taken.size());
      double least = reach / 2 + best(i + 1, taken);
      for (std::size_t j = 0; j < found.size(); ++j) {
        if (taken.contains(j)) continue;
        std::set<std::size_t> more = taken;
        more.insert(j);
        least = std::min(least, std::fabs(found[j] - expected[i]) + best(i + 1, more));
      }
      return least;
    };
    double cost = 0;
    for (const auto& [i, j] : matched(expected, found, reach))
      cost += i < 0 || j < 0 ? reach / 2
                             : std::fabs(found[static_cast<std::size_t>(j)] - expected[static_cast<std::size_t>(i)]);
    CHECK_MESSAGE(std::fabs(cost - best(0, {})) < 1e-12, "seed ", seed);
  }
}

TEST_CASE("errors of all slots are those of the run, with limits of no width") {
  const Listed truth{.echoes = [](PulseIndex) { return std::vector{echo_at(10), echo_at(20, 2, 5)}; }};
  const Listed found{.echoes =
                         [](PulseIndex i) {
                           std::vector<Echo> all{echo_at(i % 10 == 0 ? 10.2 : 10, 1.1)};
                           if (i % 4 == 0) all.push_back(echo_at(15, 1, 7));
                           if (i % 5 != 0) all.push_back(echo_at(20, 2, 6));
                           return all;
                         },
                     .moved = {0.3, 0, 0}};
  const RunErrors run = errors_of_run(truth, std::vector<ErrorStep>{{"found", found}}, {.clusters = 1'000'000});
  CHECK(run.slots == 1000);
  CHECK(run.sampled_share == 1);
  CHECK(run.parts.size() == 2);
  const ErrorsByClass& errors = run.parts.front();
  const auto is = [](const Estimate& e, double value) {
    CHECK(std::fabs(e.value - value) < 1e-12);
    CHECK(std::fabs(e.low - value) < 1e-5);
    CHECK(std::fabs(e.high - value) < 1e-5);
  };
  is(errors.all[ErrorFigure::range_68], 0);
  is(errors.all[ErrorFigure::range_95], 0.2);  // 5.6 % of the pairs
  is(errors.all[ErrorFigure::position_68], 0.3);
  is(errors.all[ErrorFigure::position_95], std::hypot(0.3, 0.2));
  is(errors.all[ErrorFigure::intensity_68], 0.1);  // more than half of the pairs
  is(errors.all[ErrorFigure::intensity_95], 0.1);
  is(errors.all[ErrorFigure::lost], 0.1);
  is(errors.all[ErrorFigure::invented], 250.0 / 2050);
  CHECK(errors.classes.size() == 3);  // of expected echoes, and of invented ones
  is(errors.classes.at(5)[ErrorFigure::lost], 0.2);
  CHECK(errors.classes.at(0).lost == 0);
  CHECK(errors.classes.at(7).invented == 250);
  CHECK(errors.classes.at(7)[ErrorFigure::invented].value == 1);
}

TEST_CASE("steps are compared with those before, and the last with the reference") {
  const auto at = [](double range) {
    return Listed{.echoes = [range](PulseIndex) { return std::vector{echo_at(range)}; }};
  };
  const RunErrors errors =
      errors_of_run(at(10), std::vector<ErrorStep>{{"sampling", at(10.01)}, {"instrument", at(10.03)}});
  CHECK(errors.parts[0].name == "sampling");
  CHECK(errors.parts[0].all[ErrorFigure::range_68].value == support::relative(0.01, 1e-9));
  CHECK(errors.parts[1].all[ErrorFigure::range_68].value == support::relative(0.02, 1e-9));
  CHECK(errors.parts[2].name == "together");
  CHECK(errors.parts[2].all[ErrorFigure::range_68].value == support::relative(0.03, 1e-9));
}

TEST_CASE("clusters are drawn from all parts of a run, each block as often as every other") {
  std::vector<int> drawn(100);
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    const ErrorSample sample(500, {.seed = seed, .clusters = 25, .length = 4, .first = 100, .end = 499});
    CHECK(sample.blocks().size() == 25);
    CHECK(sample.share() == 0.25);
    for (std::size_t k = 0; k < 25; ++k) {
      const SampleBlock& block = sample.blocks()[k];
      CHECK(block.from % 4 == 0);
      CHECK((block.from - 100) / 16 == k);
      CHECK(block.end == std::min<PulseIndex>(499, block.from + 4));
      ++drawn[(block.from - 100) / 4];
    }
  }
  for (const int times : drawn) CHECK(std::abs(times - 500) < 100);  // 5 standard deviations
}

TEST_CASE("a figure without an event in the sample has an upper limit that falls with the number of clusters") {
  const Listed survey{.slots = 1'000'000, .echoes = [](PulseIndex) { return std::vector{echo_at(10)}; }};
  double before = 1;
  for (const std::size_t clusters : {100U, 400U, 1600U}) {
    const EchoErrors none = errors_between(survey, survey, {.clusters = clusters, .reach = 0.5});
    const Estimate& lost = none[ErrorFigure::lost];
    CHECK(lost.value == 0);
    CHECK(lost.high > 3 / static_cast<double>(clusters));  // the rule of three
    CHECK(lost.high < before / 3);
    before = lost.high;
  }
}

TEST_CASE("nothing that was compared leaves all open") {
  const Listed none{.echoes = [](PulseIndex) { return std::vector<Echo>{}; }};
  const EchoErrors errors = errors_between(none, none);
  CHECK(errors[ErrorFigure::lost].high == 1);
  CHECK(std::isinf(errors[ErrorFigure::range_95].high));
  CHECK(errors_of_run(Listed{.slots = 0, .echoes = none.echoes}, {}).slots == 0);
}

TEST_CASE("a quantile has the limits of order statistics, and none above for too few pairs") {
  const Listed truth{.slots = 400'000, .echoes = [](PulseIndex) { return std::vector{echo_at(10)}; }},
      found{.slots = 400'000,
            .echoes = [](PulseIndex i) { return std::vector{echo_at(10 + 0.1 * uniform({.seed = 5, .pulse = i}))}; }};
  const Estimate e = errors_between(truth, found, {.clusters = 2000, .length = 2})[ErrorFigure::range_95];
  const double deviation = 0.1 * std::sqrt(0.95 * 0.05 / 4000);  // of uniform numbers. Source: David & Nagaraja 2003
  CHECK(std::fabs(e.value - 0.095) < 4 * deviation);
  CHECK(e.high - e.low == support::relative(2 * 1.96 * deviation, 0.3));
  CHECK(std::isinf(errors_between(truth, found, {.clusters = 30, .length = 1})[ErrorFigure::range_95].high));
  CHECK(std::isfinite(errors_between(truth, found, {.clusters = 300, .length = 1})[ErrorFigure::range_95].high));
}

TEST_CASE("limits are those of clusters, not of echoes, where the echoes of a cluster are alike") {
  // all echoes of a block of 50 are lost, or none; a wider margin by nearly the root of 50
  const Listed truth{.slots = 500'000, .echoes = [](PulseIndex) { return std::vector{echo_at(10)}; }};
  const auto random = [](PulseIndex i) { return uniform({.seed = 3, .pulse = i}); };
  const Listed alike{.slots = 500'000, .echoes = [=](PulseIndex i) {
                       return random(i / 50) < 0.2 ? std::vector<Echo>{} : std::vector{echo_at(10)};
                     }};
  const Listed mixed{.slots = 500'000, .echoes = [=](PulseIndex i) {
                       return random(i) < 0.2 ? std::vector<Echo>{} : std::vector{echo_at(10)};
                     }};
  const ErrorSampleOptions options{.clusters = 400, .length = 50};
  const auto width = [&](const Listed& found) {
    const Estimate lost = errors_between(truth, found, options)[ErrorFigure::lost];
    return lost.high - lost.low;
  };
  CHECK(width(mixed) == support::relative(2 * 1.96 * std::sqrt(0.16 / 20000), 0.15));
  CHECK(width(alike) == support::relative(2 * 1.96 * std::sqrt(0.16 / 400), 0.15));
}

TEST_CASE("a sample's limits hold the errors of all slots, for most seeds") {
  const auto normal_at = [](PulseIndex i, std::uint32_t k) { return normal({7, i, k, Purpose::range_noise}); };
  const Listed truth{.slots = 20'000, .echoes = [](PulseIndex) { return std::vector{echo_at(10), echo_at(20)}; }};
  const Listed found{.slots = 20'000, .echoes = [=](PulseIndex i) {
                       std::vector<Echo> all{echo_at(10 + 0.02 * normal_at(i, 0), 1 + 0.1 * normal_at(i, 1))};
                       if (normal_at(i / 30, 2) < 1) all.push_back(echo_at(20 + 0.01 * normal_at(i, 3)));
                       return all;
                     }};
  const EchoErrors all = errors_between(truth, found, {.clusters = 1'000'000});
  std::array<int, error_figure_count> held{};
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const EchoErrors some = errors_between(truth, found, {.seed = seed, .clusters = 100});
    for (std::size_t f = 0; f < error_figure_count; ++f)
      held[f] += holds(some.figures[f], all.figures[f].value) ? 1 : 0;
  }
  for (const int times : held) CHECK(times >= 179);
}

TEST_CASE("stated limits hold the errors of all slots of small surveys of a fence, wires and rare poles") {
  constexpr std::size_t surveys = 40;  // bench_stated_errors has more, of 30 scenes
  for (const stated::ErrorScene& scene : stated::error_scenes()) {
    if (scene.name != "fence" && scene.name != "wires before the sky" && scene.name != "rare poles") continue;
    const auto coverage = stated::coverage_of(scene, surveys);
    for (std::size_t f = 0; f < error_figure_count; ++f)
      CHECK_MESSAGE(coverage[f].held >= 34, scene.name, ": ", error_figure_names[f]);
  }
}

TEST_CASE(
    "errors depend neither on the number of threads nor on blocked slots, and surveys of other slots are refused") {
  const auto one = [](PulseIndex i) { return std::vector{echo_at(10 + 1e-3 * static_cast<double>(i % 7))}; };
  const Listed truth{.echoes = [](PulseIndex) { return std::vector{echo_at(10)}; }, .blocked = 3},
      found{.echoes = one, .blocked = 3}, other{.echoes = one, .blocked = 4}, shorter{.slots = 900, .echoes = one};
  const EchoErrors single = errors_between(truth, found, {.clusters = 50, .threads = 1});
  const EchoErrors several = errors_between(truth, found, {.clusters = 50, .threads = 3});
  CHECK(single.pairs == several.pairs);
  for (std::size_t f = 0; f < error_figure_count; ++f) CHECK(single.figures[f].high == several.figures[f].high);
  support::CountingExecutor executor;  // which may end the work between its calls
  const EchoErrors alone = errors_between(truth, found, {.clusters = 700, .length = 1, .threads = 1}),
                   executed = errors_between(truth, found, {.clusters = 700, .length = 1, .executor = executor});
  CHECK(executor.calls() > 2);
  CHECK(alone.pairs == executed.pairs);
  CHECK(alone.figures[0].high == executed.figures[0].high);
  CHECK_THROWS_AS((void)errors_between(truth, other), std::invalid_argument);
  CHECK_THROWS_AS((void)errors_between(truth, shorter), std::invalid_argument);
  CHECK_THROWS_AS((void)errors_between(truth, found, {.clusters = 1}), SettingError);
  CHECK_THROWS_AS((void)errors_between(truth, found, {.reach = 0}), SettingError);
}

TEST_CASE("the quantile of Student's t is exact to 3 %, from 3 degrees of freedom on to 1 %") {
  // source: Abramowitz & Stegun 1964, table 26.10
  for (const auto& [freedom, t] : {std::pair{2.0, 4.303}, {3.0, 3.182}, {5.0, 2.571}, {10.0, 2.228}, {30.0, 2.042}})
    CHECK(detail::student_t(freedom) == support::relative(t, freedom < 3 ? 0.031 : 0.01));
}

}  // namespace
