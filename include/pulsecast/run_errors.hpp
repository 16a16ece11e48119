// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_RUN_ERRORS_HPP
#define PULSECAST_RUN_ERRORS_HPP

#include <map>

#include <pulsecast/detail/cluster_statistics.hpp>

/// Errors of the echoes of a run: a random sample of its slots is simulated again by better surveys of the same slots.
///
///     const RunErrors errors = errors_of_run(reference, {{"sampling", ideal}, {"instrument", survey}});
///     const Estimate range = errors.parts.back().all[ErrorFigure::range_95];  // of 95 % of the echoes [m]
namespace PULSECAST_NAMESPACE {

/// Figures of the differences between found echoes and expected ones: quantiles over pairs of equal echoes of the
/// absolute difference in range [m], of the distance between the two points [m], and of the relative difference in
/// amplitude; then shares: of the expected echoes those that were not found, of the found echoes those that were not
/// expected. The 68.3 % quantile is the standard deviation of normal differences. No root mean square: it depends on
/// few great differences, which a sample may lack. Source: Hohle & Hohle 2009.
enum class ErrorFigure { range_68, range_95, position_68, position_95, intensity_68, intensity_95, lost, invented };
/// Names of the figures, in order.
inline constexpr std::array<std::string_view, 8> error_figure_names{
    "range_68", "range_95", "position_68", "position_95", "intensity_68", "intensity_95", "lost", "invented"};
/// Their units; empty for a ratio.
inline constexpr std::array<std::string_view, 8> error_figure_units{"m", "m", "m", "m", "", "", "", ""};
inline constexpr std::size_t error_figure_count = error_figure_names.size();  ///< number of figures

/// Errors of echoes.
struct EchoErrors {
  std::array<Estimate, error_figure_count> figures{};  ///< by `ErrorFigure`
  std::uint64_t pairs = 0, lost = 0, invented = 0;     ///< numbers in the sample

  [[nodiscard]] const Estimate& operator[](ErrorFigure f) const noexcept {
    return figures[static_cast<std::size_t>(f)];
  }
};

/// Errors of all echoes and by class.
struct ErrorsByClass {
  std::string name{};                             ///< of their cause
  EchoErrors all{};                               ///< of all echoes
  std::map<std::uint16_t, EchoErrors> classes{};  ///< by class of the expected echo, or of the invented one
};

/// Errors of a run.
struct RunErrors {
  std::vector<ErrorsByClass> parts{};  ///< of each step from the reference to the run, then `together`
  std::uint64_t slots = 0;             ///< number of slots in the sample
  std::size_t clusters = 0;            ///< number of clusters in the sample
  double sampled_share = 0;            ///< share of the run's slots in the sample
  std::size_t subrays = 0;             ///< subrays of a pulse in the reference
};

/// Options of a sample of slots.
struct ErrorSampleOptions {
  std::uint64_t seed = 0;                                   ///< seed of the choice of clusters
  std::size_t clusters = 1024;                              ///< number of clusters with echoes, at least 2
  PulseIndex length = 4;                                    ///< consecutive slots in a cluster, at least 1
  PulseIndex first = 0;                                     ///< first slot of the run
  PulseIndex end = std::numeric_limits<PulseIndex>::max();  ///< one past its last slot, at most the survey's size
  double reach = 0.3;      ///< greatest difference in range of equal echoes: half a pulse length of 4 ns [m]
  unsigned threads = 0;    ///< threads, at most `max_threads`; 0: all of the executor or the hardware
  ExecutorRef executor{};  ///< runs the work, as in `RunOptions`

  [[nodiscard]] Workers workers() const noexcept { return {executor, threads}; }  ///< threads of the work
  void validate() const {
    require_within("ErrorSampleOptions::clusters", clusters, 2, 1e9, "");
    require_within("ErrorSampleOptions::length", length, 1, 1e9, "");
    require_positive("ErrorSampleOptions::reach", reach, "m");
    require_within("ErrorSampleOptions::threads", threads, 0, max_threads, "");
  }
};

/// One echo of two surveys, or an echo of one of them.
struct EchoMatch {
  /// Echo of both, of the expected ones alone, or of the others alone.
  enum Kind : std::uint8_t { pair, lost, invented };
  std::uint32_t cluster = 0;                      ///< number of its cluster
  std::uint16_t classification = 0;               ///< class of the expected echo, or of the invented one
  Kind kind = pair;                               ///< in both, only expected, only found
  double range = 0, position = 0, intensity = 0;  ///< absolute differences of a pair [m], [m], relative
};

namespace detail {

/// Pairs the echoes of two pulses, each sorted by range. Pairs and echoes without one are chosen so that the sum of
/// the differences in range and of half of `reach` for each echo without a partner is smallest. Source: Rahmathullah,
/// Garcia-Fernandez & Svensson 2017, Generalized optimal sub-pattern assignment metric, with alpha = 2 and p = 1.
class EchoMatcher {
 public:
  explicit EchoMatcher(double reach) : reach_(reach) {}

  /// Calls `visit(expected, found)` with pointers to the echoes of a pair, or null for none, from the last to the
  /// first.
  template <class Visit>
  void match(std::span<const Echo> expected, std::span<const Echo> found, const Visit& visit) {
    const std::size_t row = found.size() + 1;
    const auto paired = [&](std::size_t i, std::size_t j) {
      return costs_[(i - 1) * row + j - 1] + std::fabs(found[j - 1].range - expected[i - 1].range);
    };
    costs_.resize((expected.size() + 1) * row);
    for (std::size_t i = 0; i <= expected.size(); ++i)
      for (std::size_t j = 0; j < row; ++j) {
        double& cost = costs_[i * row + j];
        cost = static_cast<double>(i + j) * reach_ / 2;
        if (i > 0 && j > 0)
          cost = std::min({paired(i, j), costs_[(i - 1) * row + j] + reach_ / 2, costs_[i * row + j - 1] + reach_ / 2});
      }
    for (std::size_t i = expected.size(), j = found.size(); i > 0 || j > 0;) {
      const double cost = costs_[i * row + j];
      const bool pair = i > 0 && j > 0 && cost == paired(i, j),
                 lost = !pair && i > 0 && (j == 0 || cost == costs_[(i - 1) * row + j] + reach_ / 2);
      const Echo* const of_expected = pair || lost ? &expected[--i] : nullptr;
      visit(of_expected, lost ? nullptr : &found[--j]);
    }
  }

 private:
  double reach_;
  std::vector<double> costs_{};  // of the first i expected and j found echoes
};

/// Matches the echoes of samples of the same slots by two surveys.
[[nodiscard]] inline std::vector<EchoMatch> matches_of(std::span<const Sample> expected, std::span<const Sample> found,
                                                       double reach) {
  std::vector<EchoMatch> all;
  EchoMatcher matcher(reach);
  for (std::uint32_t b = 0; b < expected.size(); ++b) {
    const EchoBatch of_expected = expected[b].batch(), of_found = found[b].batch();
    if (of_expected.shots.size() != of_found.shots.size())
      throw std::invalid_argument(
          "errors of a run: the surveys send different pulses: expected surveys of the same slots");
    for (std::size_t k = 0; k < of_expected.shots.size(); ++k) {
      const Shot &right = of_expected.shots[k], &own = of_found.shots[k];
      matcher.match(of_expected.echoes_of(right), of_found.echoes_of(own), [&](const Echo* e, const Echo* f) {
        const auto kind = !f ? EchoMatch::lost : !e ? EchoMatch::invented : EchoMatch::pair;
        EchoMatch& m = all.emplace_back(EchoMatch{b, (e ? e : f)->classification, kind});
        if (kind != EchoMatch::pair) return;
        m.range = std::fabs(f->range - e->range);
        m.position = length(own.origin + f->range * own.direction - (right.origin + e->range * right.direction));
        m.intensity = std::fabs(f->amplitude / e->amplitude - 1);
      });
    }
  }
  return all;
}

/// Quantile `level` of a difference over pairs. Source of the limits: Woodruff 1952, by the share of pairs above it;
/// too few pairs have no upper limit.
[[nodiscard]] inline Estimate quantile_of(std::span<const EchoMatch* const> pairs, double EchoMatch::*difference,
                                          double level, std::size_t clusters, double sampled_share) {
  std::vector<double> all;
  for (const EchoMatch* pair : pairs) all.push_back(pair->*difference);
  if (all.empty()) return {0, 0, std::numeric_limits<double>::infinity()};
  std::sort(all.begin(), all.end());
  const double n = static_cast<double>(all.size());
  const auto at = [&](double share) {
    return all[static_cast<std::size_t>(std::clamp(std::ceil(share * n) - 1, 0.0, n - 1))];
  };
  const double value = at(level);
  if (sampled_share == 1) return {value, value, value};
  std::vector<ClusterSums> sums(clusters);
  for (const EchoMatch* pair : pairs) {
    sums[pair->cluster].part += pair->*difference > value ? 1 : 0;
    sums[pair->cluster].whole += 1;
  }
  const ClusterRatio ratio(sums, sampled_share);
  const Estimate above = ratio.share();
  if (std::pow(level, ratio.trials()) > 0.025) return {value, 0, std::numeric_limits<double>::infinity()};
  return {value, at(1 - above.high), at(1 - above.low + 0.5 / n)};
}

/// Figures of echoes in `clusters` clusters.
[[nodiscard]] inline EchoErrors errors_of(std::span<const EchoMatch* const> matches, std::size_t clusters,
                                          double sampled_share) {
  EchoErrors e;
  std::vector<const EchoMatch*> pairs;
  std::vector<ClusterSums> lost(clusters), invented(clusters);
  for (const EchoMatch* m : matches) {
    if (m->kind == EchoMatch::pair) pairs.push_back(m);
    if (m->kind != EchoMatch::invented) lost[m->cluster].whole += 1;
    if (m->kind != EchoMatch::lost) invented[m->cluster].whole += 1;
    lost[m->cluster].part += m->kind == EchoMatch::lost ? 1 : 0;
    invented[m->cluster].part += m->kind == EchoMatch::invented ? 1 : 0;
    e.lost += m->kind == EchoMatch::lost ? 1 : 0;
    e.invented += m->kind == EchoMatch::invented ? 1 : 0;
  }
  e.pairs = pairs.size();
  auto* out = e.figures.data();
  for (const auto difference : {&EchoMatch::range, &EchoMatch::position, &EchoMatch::intensity})
    for (const double level : {0.683, 0.95}) *out++ = quantile_of(pairs, difference, level, clusters, sampled_share);
  *out++ = ClusterRatio(lost, sampled_share).share();
  *out++ = ClusterRatio(invented, sampled_share).share();
  return e;
}

/// Errors of matched echoes in `clusters` clusters, by class.
[[nodiscard]] inline ErrorsByClass errors_by_class(std::string name, std::span<const EchoMatch> matches,
                                                   std::size_t clusters, double sampled_share) {
  std::vector<const EchoMatch*> all;
  std::map<std::uint16_t, std::vector<const EchoMatch*>> by_class;
  for (const EchoMatch& match : matches) {
    all.push_back(&match);
    by_class[match.classification].push_back(&match);
  }
  ErrorsByClass errors{std::move(name), errors_of(all, clusters, sampled_share)};
  for (const auto& [classification, some] : by_class)
    errors.classes.emplace(classification, errors_of(some, clusters, sampled_share));
  return errors;
}

}  // namespace detail

/// Clusters of consecutive slots, drawn at random: one from each of many equal parts of a run, or all of a short run.
class ErrorSample {
 public:
  /// @throws SettingError for options out of range
  ErrorSample(PulseIndex size, const ErrorSampleOptions& options) : options_(validated(options)) {
    const PulseIndex end = std::min(options.end, size), slots = end - std::min(options.first, end),
                     all = (slots + options.length - 1) / options.length,
                     drawn = std::min<PulseIndex>(options.clusters, all);
    for (PulseIndex k = 0; k < drawn; ++k) {
      const double u = drawn == all ? 0 : uniform({.seed = options.seed, .pulse = k, .subray = 5});
      const double at = (static_cast<double>(k) + u) * static_cast<double>(all) / static_cast<double>(drawn);
      const PulseIndex from =
          options.first + options.length * (drawn == all ? k : std::min(all - 1, static_cast<PulseIndex>(at)));
      blocks_.push_back({from, from, std::min(end, from + options.length)});
    }
    if (slots > 0) share_ = static_cast<double>(drawn) / static_cast<double>(all);
  }

  /// So many clusters of a survey that about `clusters` of them have echoes; up to 8 times as many.
  /// @throws SettingError for options out of range
  ErrorSample(const AnySurvey& survey, const ErrorSampleOptions& options) : ErrorSample(survey.size(), options) {
    const std::vector<Sample> pilot = simulate(survey);
    const auto empty = std::ranges::count_if(pilot, [](const Sample& cluster) { return cluster.counts.echoes == 0; });
    if (empty == 0 || share_ == 1) return;
    const double number = static_cast<double>(pilot.size()), full = number - static_cast<double>(empty);
    options_.clusters = static_cast<std::size_t>(number * std::min(8.0, number / std::max(1.0, full)));
    *this = ErrorSample(survey.size(), options_);
  }

  [[nodiscard]] const std::vector<SampleBlock>& blocks() const noexcept { return blocks_; }  ///< in order
  /// Number of slots in the sample.
  [[nodiscard]] std::uint64_t slots() const noexcept {
    std::uint64_t all = 0;
    for (const SampleBlock& block : blocks_) all += block.end - block.from;
    return all;
  }
  [[nodiscard]] double share() const noexcept { return share_; }  ///< part of the run that is in the sample

  /// Simulates the clusters by a survey of the same slots.
  [[nodiscard]] std::vector<Sample> simulate(const AnySurvey& survey) const {
    constexpr std::size_t at_once = 512;  // in between, an executor may end the work
    std::vector<Sample> all;
    for (std::size_t first = 0; first < blocks_.size(); first += at_once)
      for (Sample& one : sample(survey, std::span(blocks_).subspan(first, std::min(at_once, blocks_.size() - first)),
                                options_.workers()))
        all.push_back(std::move(one));
    return all;
  }

  /// Errors of the echoes of one survey against those of another.
  [[nodiscard]] ErrorsByClass errors(std::string name, std::span<const Sample> expected,
                                     std::span<const Sample> found) const {
    return detail::errors_by_class(std::move(name), detail::matches_of(expected, found, options_.reach), blocks_.size(),
                                   share_);
  }

 private:
  ErrorSampleOptions options_;
  std::vector<SampleBlock> blocks_{};
  double share_ = 0;
};

/// Survey that differs from the one before it in a cause of errors.
struct ErrorStep {
  std::string cause;  ///< such as `sampling`
  AnySurvey survey;   ///< of the same slots
};

/// Errors of a run of the last survey against the reference: of each step against the one before, and of all steps
/// together. May be called while the run goes on.
/// @throws SettingError for options out of range @throws std::invalid_argument for surveys of different slots
[[nodiscard]] inline RunErrors errors_of_run(const AnySurvey& reference, std::span<const ErrorStep> steps,
                                             const ErrorSampleOptions& options = {}) {
  for (const ErrorStep& step : steps)
    if (step.survey.size() != reference.size())
      throw std::invalid_argument(
          text::joined({"errors of a run: the survey of ", step.cause, " has ", std::to_string(step.survey.size()),
                        " slots: expected ", std::to_string(reference.size()), ", as the reference has"}));
  const ErrorSample sample(steps.empty() ? reference : steps.back().survey, options);
  RunErrors errors{.slots = sample.slots(),
                   .clusters = sample.blocks().size(),
                   .sampled_share = sample.share(),
                   .subrays = reference.subrays()};
  const std::vector<Sample> best = sample.simulate(reference);
  std::vector<Sample> before = best;
  for (const ErrorStep& step : steps) {
    std::vector<Sample> now = sample.simulate(step.survey);
    errors.parts.push_back(sample.errors(step.cause, before, now));
    before = std::move(now);
  }
  errors.parts.push_back(sample.errors("together", best, before));
  return errors;
}

}  // namespace PULSECAST_NAMESPACE

#endif
