// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_ACCURACY_HPP
#define PULSECAST_ACCURACY_HPP

#include <functional>

#include <pulsecast/run_errors.hpp>

/// The cheapest settings of a survey that reach an accuracy, found by trial on random samples of its slots:
///
///     const SettingsChoice choice = choose_settings({.range = 5_mm}, adjustable);
///     const AnySurvey survey = adjustable.survey(choice.values);
namespace PULSECAST_NAMESPACE {

/// Greatest errors of 95 % of the echoes, and greatest shares of echoes that are lost or invented.
struct Accuracy {
  static constexpr double any = std::numeric_limits<double>::infinity();  ///< no limit
  double range = any;                                                     ///< difference in range [m]
  double position = any;                                                  ///< distance of the points [m]
  double intensity = any;                                                 ///< relative difference in amplitude
  double echoes = 0.01;  ///< share of the expected echoes that are lost, and of the found ones that are invented

  void validate() const {
    const auto require = [](const char* name, double limit, const char* unit) {
      if (limit != any) require_positive(name, limit, unit);
    };
    require("Accuracy::range", range, "m");
    require("Accuracy::position", position, "m");
    require("Accuracy::intensity", intensity, "");
    require("Accuracy::echoes", echoes, "");
  }

  /// Limit of a figure; `any` for none.
  [[nodiscard]] double limit(ErrorFigure f) const noexcept {
    switch (f) {
      case ErrorFigure::range_95:
        return range;
      case ErrorFigure::position_95:
        return position;
      case ErrorFigure::intensity_95:
        return intensity;
      case ErrorFigure::lost:
      case ErrorFigure::invented:
        return echoes;
      default:
        return any;
    }
  }

  /// Greatest ratios of figures, of their lower and of their upper limits to what is asked: the accuracy is certainly
  /// reached if `high` is at most 1, and certainly not if `low` is more.
  [[nodiscard]] Estimate share_of_limits(const EchoErrors& errors) const noexcept {
    Estimate most{};
    for (std::size_t f = 0; f < error_figure_count; ++f) {
      const double of = limit(static_cast<ErrorFigure>(f));
      if (of == any) continue;
      const Estimate& e = errors.figures[f];
      most = {std::max(most.value, e.value / of), std::max(most.low, e.low / of), std::max(most.high, e.high / of)};
    }
    return most;
  }
};

/// A setting that trades accuracy for speed, such as the number of subrays.
struct SettingLadder {
  std::string name;            ///< for messages
  std::vector<double> values;  ///< from the least to the most exact
  double reference;            ///< value of the reference, more exact than all
};

/// Survey with settings to choose. The functions take a value of each ladder.
struct AdjustableSurvey {
  using Values = std::span<const double>;     ///< one value of each ladder
  std::vector<SettingLadder> ladders{};       ///< at least one
  std::function<AnySurvey(Values)> survey{};  ///< with these settings; the slots do not depend on them
  std::function<double(Values)> effort{};     ///< relative time of a pulse; empty: the number of subrays

  void validate() const {
    require_within("AdjustableSurvey::ladders (number)", ladders.size(), 1, 16, "");
    double all = 1;
    for (const SettingLadder& ladder : ladders) {
      require_within(text::joined({"SettingLadder::values (number) of '", ladder.name, "'"}), ladder.values.size(), 1,
                     1000, "");
      all *= static_cast<double>(ladder.values.size());
    }
    require_within("AdjustableSurvey::ladders (settings)", all, 1, 1e6, "");
    if (!survey) throw SettingError("AdjustableSurvey::survey", 0, "", "a function");
  }
};

/// Settings that were tried.
struct SettingsTrial {
  std::vector<double> values{};  ///< of each ladder
  double effort = 0;             ///< relative time of a pulse
  EchoErrors errors{};           ///< against the reference
};

/// Result of `choose_settings`.
struct SettingsChoice : SettingsTrial {
  bool reached = false;                 ///< false: no settings are known to reach the accuracy; these come nearest
  std::uint64_t slots = 0;              ///< slots of the last sample
  double sampled_share = 0;             ///< its part of the survey
  std::size_t subrays = 0;              ///< subrays of a pulse in the reference
  std::vector<SettingsTrial> trials{};  ///< on the last sample, by effort
};

namespace detail {

/// Search for the cheapest settings on samples. A finer value is taken to have no greater errors: settings that are in
/// no respect finer than some that certainly fail are not tried.
class SettingsSearch {
 public:
  SettingsSearch(const Accuracy& accuracy, const AdjustableSurvey& adjustable)
      : accuracy_(accuracy), adjustable_(adjustable) {
    Steps steps(adjustable.ladders.size(), 0);
    for (std::size_t k = 0; k < steps.size();) {  // counts up, the first setting fastest
      const std::vector<double> of = values(steps);
      all_.emplace_back(
          adjustable.effort ? adjustable.effort(of) : static_cast<double>(adjustable.survey(of).subrays()), steps);
      for (k = 0; k < steps.size() && ++steps[k] == adjustable.ladders[k].values.size(); ++k) steps[k] = 0;
    }
    std::ranges::sort(all_);
  }

  std::vector<SettingsTrial> trials{};  ///< on the last sample, by effort
  double uncertain = 0;                 ///< effort of the cheapest of them that may reach the accuracy, or may not

  /// Tries the cheapest settings first, until some certainly reach the accuracy: the last trial. False if none do.
  [[nodiscard]] bool search(const ErrorSample& sample, const std::vector<Sample>& expected) {
    trials.clear();
    uncertain = 0;
    for (const auto& [effort, steps] : all_) {
      if (fails(steps)) continue;
      SettingsTrial& trial = trials.emplace_back(SettingsTrial{values(steps), effort, {}});
      trial.errors = sample.errors("", expected, sample.simulate(adjustable_.survey(trial.values))).all;
      const Estimate share = accuracy_.share_of_limits(trial.errors);
      if (share.high <= 1) return true;
      if (share.low > 1) failed_.push_back(steps);
      if (share.low <= 1 && uncertain == 0) uncertain = effort;
    }
    return false;
  }

 private:
  using Steps = std::vector<std::size_t>;  // positions on the ladders

  [[nodiscard]] std::vector<double> values(const Steps& steps) const {
    std::vector<double> all;
    for (std::size_t k = 0; k < steps.size(); ++k) all.push_back(adjustable_.ladders[k].values[steps[k]]);
    return all;
  }
  [[nodiscard]] bool fails(const Steps& steps) const {
    return std::ranges::any_of(
        failed_, [&](const Steps& other) { return std::ranges::equal(steps, other, std::less_equal<>()); });
  }

  const Accuracy& accuracy_;
  const AdjustableSurvey& adjustable_;
  std::vector<std::pair<double, Steps>> all_{};  // with their efforts, which sort them
  std::vector<Steps> failed_{};
};

}  // namespace detail

/// Cheapest settings of a survey with which the upper limits of all asked errors are within what is asked, against the
/// same slots with the settings of the reference. Samples grow by four, up to 16 times `ErrorSampleOptions::clusters`,
/// while that takes some seconds, or may save more in ten runs of the survey. The same choice on any number of threads.
/// @throws SettingError for settings out of range
[[nodiscard]] inline SettingsChoice choose_settings(const Accuracy& accuracy, const AdjustableSurvey& adjustable,
                                                    const ErrorSampleOptions& options = {}) {
  accuracy.validate();
  adjustable.validate();
  detail::SettingsSearch search(accuracy, adjustable);
  std::vector<double> cheapest, best;
  for (const SettingLadder& ladder : adjustable.ladders) {
    cheapest.push_back(ladder.values.front());
    best.push_back(ladder.reference);
  }
  const AnySurvey pilot = adjustable.survey(cheapest), reference = adjustable.survey(best);
  SettingsChoice choice;
  choice.subrays = reference.subrays();
  ErrorSampleOptions sampled = validated(options);
  const std::size_t most = 16 * sampled.clusters;
  const double for_none = std::fmin(8 / accuracy.echoes, 1e9);  // no event in n clusters: a share of up to 4 in n
  sampled.clusters = std::clamp(static_cast<std::size_t>(for_none), sampled.clusters, most);
  for (bool more = true; more; sampled.clusters = std::min(most, 4 * sampled.clusters)) {
    ++sampled.seed;
    const ErrorSample sample(pilot, sampled);
    choice.reached = search.search(sample, sample.simulate(reference));
    choice.slots = sample.slots();
    choice.sampled_share = sample.share();
    more = sample.share() < 1 && sampled.clusters < most && search.uncertain > 0;
    if (!choice.reached) continue;
    constexpr double few = 5e7;  // rays that take some seconds
    const double cost = 4 * static_cast<double>(choice.slots * choice.subrays), effort = search.trials.back().effort,
                 runs = 10 * static_cast<double>(choice.slots) / choice.sampled_share;
    more = more && effort > 1.1 * search.uncertain && (cost < few || cost < (effort - search.uncertain) * runs);
  }
  choice.trials = std::move(search.trials);
  const auto nearest = [&](const SettingsTrial& a, const SettingsTrial& b) {
    return accuracy.share_of_limits(a.errors).value < accuracy.share_of_limits(b.errors).value;
  };
  if (choice.trials.empty()) return choice;
  static_cast<SettingsTrial&>(choice) =
      choice.reached ? choice.trials.back() : *std::ranges::min_element(choice.trials, nearest);
  return choice;
}

}  // namespace PULSECAST_NAMESPACE

#endif
