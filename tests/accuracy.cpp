// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/accuracy.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include "support/generators.hpp"
#include "support/listed_survey.hpp"
#include "support/relative.hpp"

using namespace pulsecast;
using support::echo_at;
using support::Listed;

namespace {

/// Errors of settings: a share of the slots loses its echo, one has another echo, and ranges err by so much.
struct Errs {
  double lost = 0, invented = 0, range = 0, amplitude = 0;
};

/// Survey of an echo at 10 m in each slot but for these errors; which slots err depends on the slot alone.
Listed survey_of(const Errs& errs, PulseIndex slots, std::size_t rays = 1) {
  const auto echoes = [errs](PulseIndex i) {
    std::vector<Echo> all;
    if (uniform({.seed = 7, .pulse = i}) >= errs.lost) all.push_back(echo_at(10 + errs.range, 1 + errs.amplitude));
    if (uniform({.seed = 8, .pulse = i}) < errs.invented) all.push_back(echo_at(20));
    return all;
  };
  return {.slots = slots, .echoes = echoes, .rays = rays};
}

/// One setting whose error is `of` its value; 1000 is the reference.
template <class Of>
AdjustableSurvey adjustable_by(std::vector<double> values, const Of& of, PulseIndex slots = 400'000) {
  AdjustableSurvey adjustable{.ladders = {{"n", std::move(values), 1000}}};
  adjustable.survey = [of, slots](AdjustableSurvey::Values v) {
    return survey_of(v[0] == 1000 ? Errs{} : of(v[0]), slots, static_cast<std::size_t>(v[0]));
  };
  return adjustable;
}

EchoErrors figures(double range_95, double lost, double invented) {
  EchoErrors e;
  const auto set = [&](ErrorFigure f, double value) {
    e.figures[static_cast<std::size_t>(f)] = {value, 0.5 * value, 2 * value};
  };
  set(ErrorFigure::range_95, range_95);
  set(ErrorFigure::lost, lost);
  set(ErrorFigure::invented, invented);
  return e;
}

TEST_CASE("an accuracy is reached if the upper limits of all asked figures are within theirs") {
  const Accuracy asked{.range = 0.01, .echoes = 0.02};
  CHECK(asked.share_of_limits(figures(0.002, 0.004, 0)).high == support::relative(0.4, 1e-12));
  CHECK(asked.share_of_limits(figures(0.002, 0.004, 0.02)).high == support::relative(2, 1e-12));
  CHECK(asked.share_of_limits(figures(0.03, 0.004, 0)).low == support::relative(1.5, 1e-12));
  CHECK(Accuracy{.echoes = Accuracy::any}.share_of_limits(figures(9, 1, 1)).high == 0);
  CHECK(asked.limit(ErrorFigure::range_68) == Accuracy::any);
}

TEST_CASE("the cheapest settings that keep all limits are chosen") {
  const std::vector<double> values{1, 2, 4, 8, 16, 32, 64};
  // ranges err by 1 m / n, a tenth / n is lost, a twentieth / n is invented
  const auto adjustable = adjustable_by(values, [](double n) { return Errs{0.1 / n, 0.05 / n, 1 / n, 0.2 / n}; });
  const auto chosen = [&](const Accuracy& asked) { return choose_settings(asked, adjustable, {.reach = 2}).values[0]; };
  CHECK(chosen({.range = 0.3, .echoes = 1}) == 4);
  CHECK(chosen({.position = 0.1, .echoes = 1}) == 16);
  CHECK(chosen({.intensity = 0.11, .echoes = 1}) == 2);
  CHECK(chosen({.echoes = 0.015}) == 8);
  CHECK(chosen({.range = 0.3, .echoes = 0.015}) == 8);  // echoes that are lost count beside ranges
  const SettingsChoice choice = choose_settings({.range = 0.3}, adjustable, {.reach = 2});
  CHECK(choice.reached);
  CHECK(choice.subrays == 1000);
  CHECK(choice.effort == 16);
  CHECK(choice.errors[ErrorFigure::lost].high < 0.01);
  CHECK(choice.trials.back().values == choice.values);
}

TEST_CASE("of several settings, those of the least effort are chosen that an exhaustive trial finds") {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    // errors and effort of each value of two settings; all slots are in the sample, so errors are known
    std::array<std::vector<double>, 2> ranges, efforts;
    for (std::size_t k = 0; k < 2; ++k)
      for (int i = 0; i < 5; ++i) {
        ranges[k].push_back((i > 0 ? ranges[k].back() : 1) * any.uniform(0.2, 1));
        efforts[k].push_back((i > 0 ? efforts[k].back() : 0) + any.log_uniform(0.1, 5));
      }
    const auto at = [](AdjustableSurvey::Values v, std::size_t k) { return static_cast<std::size_t>(v[k]); };
    AdjustableSurvey adjustable{.ladders = {{"a", {0, 1, 2, 3, 4}, 9}, {"b", {0, 1, 2, 3, 4}, 9}}};
    adjustable.survey = [&](AdjustableSurvey::Values v) {
      return survey_of({.range = v[0] == 9 ? 0 : ranges[0][at(v, 0)] + ranges[1][at(v, 1)]}, 200);
    };
    adjustable.effort = [&](AdjustableSurvey::Values v) { return efforts[0][at(v, 0)] + efforts[1][at(v, 1)]; };
    const double limit = any.log_uniform(0.02, 1);
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < 5; ++i)
      for (std::size_t j = 0; j < 5; ++j)
        if (ranges[0][i] + ranges[1][j] <= limit) least = std::fmin(least, efforts[0][i] + efforts[1][j]);
    const SettingsChoice choice = choose_settings({.range = limit}, adjustable, {.reach = 5});
    CHECK(choice.sampled_share == 1);
    CHECK(choice.reached == std::isfinite(least));
    if (choice.reached) CHECK(choice.effort == least);
  }
}

TEST_CASE("choices keep their limits, though they see a sample, in nearly all of random cases") {
  std::size_t kept = 0, exceeded = 0, dear = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    support::Generator any(100 + seed);
    const double lost = any.uniform(0.1, 0.5), asked = 0.02;
    std::vector<double> values{1};
    while (values.back() < 200) values.push_back(std::ceil(1.15 * values.back()));
    const auto adjustable = adjustable_by(values, [&](double n) { return Errs{lost / n, 0, 0, 0}; });
    const SettingsChoice choice = choose_settings({.echoes = asked}, adjustable, {.seed = seed});
    kept += choice.reached && lost / choice.values[0] <= asked ? 1 : 0;
    exceeded += lost / choice.values[0] > 1.25 * asked ? 1 : 0;
    dear += choice.values[0] > 1.3 * 1.15 * lost / asked ? 1 : 0;
  }
  CHECK(kept >= 36);
  CHECK(exceeded <= 1);
  CHECK(dear <= 2);
}

TEST_CASE("what no settings reach is said, with the nearest") {
  const auto adjustable = adjustable_by(
      {1, 2, 4}, [](double n) { return Errs{.range = 1 / n}; }, 2000);
  const SettingsChoice choice = choose_settings({.range = 0.1}, adjustable, {.reach = 2});
  CHECK(!choice.reached);
  CHECK(choice.values == std::vector<double>{4});
  CHECK(choice.errors[ErrorFigure::range_95].value == support::relative(0.25, 1e-9));
  // a share below what a sample can tell is not taken for reached
  const SettingsChoice rare =
      choose_settings({.echoes = 1e-9}, adjustable_by({1}, [](double) { return Errs{}; }), {.clusters = 100});
  CHECK(!rare.reached);
}

TEST_CASE("settings coarser than some that fail are not tried") {
  AdjustableSurvey adjustable{.ladders = {{"a", {0, 1}, 9}, {"b", {0, 1}, 9}}};
  adjustable.survey = [](AdjustableSurvey::Values v) { return survey_of({.range = v[0] < 1 ? 1.0 : 0.0}, 200); };
  adjustable.effort = [](AdjustableSurvey::Values v) { return v[0] == 0 ? 10 - 5 * v[1] : 11 + v[1]; };
  const SettingsChoice choice = choose_settings({.range = 0.1}, adjustable, {.reach = 2});
  CHECK(choice.values == std::vector<double>{1, 0});
  REQUIRE(choice.trials.size() == 2);  // not (0, 0), as (0, 1) failed
  CHECK(choice.trials[0].values == std::vector<double>{0, 1});
}

TEST_CASE("a choice is the same on any number of threads") {
  const auto adjustable = adjustable_by({1, 2, 3, 5, 8, 13}, [](double n) { return Errs{0.05 / n, 0, 0.1 / n, 0}; });
  const auto choice = [&](unsigned threads) {
    return choose_settings({.range = 0.03}, adjustable, {.seed = 3, .reach = 2, .threads = threads});
  };
  const SettingsChoice one = choice(1), many = choice(4);
  CHECK(one.values == many.values);
  CHECK(one.slots == many.slots);
  CHECK(one.errors[ErrorFigure::lost].high == many.errors[ErrorFigure::lost].high);
}

TEST_CASE("samples grow where slots are empty") {
  const auto survey = [](PulseIndex stretch) {
    return Listed{.slots = 1'000'000, .echoes = [stretch](PulseIndex i) {
                    return i / 1000 % stretch == 0 ? std::vector{echo_at(10)} : std::vector<Echo>{};
                  }};
  };
  CHECK(ErrorSample(survey(1), {.clusters = 500}).blocks().size() == 500);
  CHECK(std::fabs(static_cast<double>(ErrorSample(survey(4), {.clusters = 500}).blocks().size()) / 2000 - 1) < 0.2);
  CHECK(ErrorSample(survey(100), {.clusters = 500}).blocks().size() == 4000);  // eight times as many at most
}

TEST_CASE("what cannot be asked or chosen from is refused") {
  const auto adjustable = adjustable_by({1}, [](double) { return Errs{}; });
  for (const double limit : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()})
    CHECK_THROWS_AS((void)choose_settings({.range = limit}, adjustable), SettingError);
  CHECK_THROWS_AS((void)choose_settings({}, AdjustableSurvey{}), SettingError);
  CHECK_THROWS_AS((void)choose_settings({}, adjustable_by({}, [](double) { return Errs{}; })), SettingError);
  AdjustableSurvey without = adjustable;
  without.survey = {};
  CHECK_THROWS_AS((void)choose_settings({}, without), SettingError);
  CHECK_THROWS_AS((void)choose_settings({}, adjustable, {.clusters = 1}), SettingError);
  AdjustableSurvey many = adjustable;
  many.ladders = std::vector(3, SettingLadder{"n", std::vector<double>(200, 1), 1000});  // 8 million settings
  CHECK_THROWS_AS((void)choose_settings({}, many), SettingError);
}

}  // namespace
