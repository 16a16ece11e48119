// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_FORECAST_HPP
#define PULSECAST_FORECAST_HPP

#include <ctime>

#include <pulsecast/run_errors.hpp>

/// Forecasts of whole runs from samples of their slots, in about a second each:
///
///     const RunForecaster forecaster(survey, {.seed = 1});
///     const RunEstimate run = forecaster.estimate();  // echoes, processor time
namespace PULSECAST_NAMESPACE {

/// Budget of processor time. Samples thus do not depend on other load.
class ProcessorBudget {
 public:
  /// `seconds` of so many `workers` at the same time.
  ProcessorBudget(double seconds, double workers) : ticks_(seconds * workers * CLOCKS_PER_SEC) {}
  /// True until it is spent.
  [[nodiscard]] bool left() const { return static_cast<double>(std::clock() - start_) < ticks_; }

 private:
  std::clock_t start_ = std::clock();
  double ticks_;
};

/// Options of a forecast.
struct ForecastOptions {
  std::uint64_t seed = 0;    ///< seed of the choice of slots
  unsigned threads = 0;      ///< threads, at most `max_threads`; 0: all of the machine
  bool empty_shots = false;  ///< true: shots without echoes are kept, as in a run whose sinks read them
};

/// Totals of a run.
struct RunEstimate {
  Estimate echoes{};          ///< echoes of all pulses
  Estimate pulses{};          ///< pulses sent
  Estimate empty_pulses{};    ///< of these, pulses without echoes
  Estimate seconds{};         ///< processor time without sinks, of all threads [s]
  std::uint64_t sampled = 0;  ///< slots that were simulated
};

/// Forecasts a run of a survey from a stratified random sample of its slots, and its time from blocks of consecutive
/// ones. A small survey is counted in full.
class RunForecaster {
 public:
  /// Simulates for some 1.4 s on all threads. @throws SettingError for threads out of range
  explicit RunForecaster(AnySurvey survey, const ForecastOptions& options = {})
      : survey_(std::move(survey)),
        options_(options),
        workers_(std::min(thread_count(options.threads), thread_count(0))),
        size_(survey_.size()) {
    count_slots();
    measure_time();
  }

  [[nodiscard]] const RunEstimate& estimate() const noexcept { return estimate_; }  ///< as measured so far

  /// Slots that are spread over the results of a run: those of hits, with `empty_shots` also of misses.
  [[nodiscard]] std::vector<PulseIndex> spread_results(std::size_t count) const {
    std::vector<PulseIndex> results = found_[Kind::hit], slots;
    if (options_.empty_shots || results.empty())
      results.insert(results.end(), found_[Kind::missed].begin(), found_[Kind::missed].end());
    if (results.empty()) results = found_[Kind::blocked];
    std::sort(results.begin(), results.end());
    const double start = uniform({.seed = options_.seed, .subray = 4});
    for (std::uint64_t k = 0; k < count && !results.empty(); ++k)
      slots.push_back(detail::spread_over(results, k, start));
    return slots;
  }

 private:
  friend class VariantForecaster;
  using Kind = detail::SlotKind;

  /// One slot from each of many equal strata. Rounds visit the strata, each spread over the whole survey.
  void count_slots() {
    constexpr std::uint64_t rounds = 64, max_size = rounds << 12;
    const std::uint64_t strata = std::min(size_, max_size), each_round = (strata + rounds - 1) / rounds;
    std::vector<std::optional<SlotCount>> counts(strata);
    std::vector<PulseIndex> places(strata);
    const ProcessorBudget budget(0.35, workers_);
    for (std::uint64_t round = 0; round < rounds && (round == 0 || budget.left()); ++round) {
      std::vector<std::uint64_t> numbers;
      std::vector<PulseIndex> slots;
      for (std::uint64_t k = 0; k < each_round; ++k) {
        const auto turn =
            static_cast<std::uint64_t>(uniform({.seed = options_.seed, .pulse = k, .subray = 1}) * rounds);
        const std::uint64_t i = k * rounds + (round * 37 + turn) % rounds;  // 37 has no divisor in common with rounds
        if (i >= strata) continue;
        const double width = static_cast<double>(size_) / static_cast<double>(strata);
        const double from = static_cast<double>(size_) * static_cast<double>(i) / static_cast<double>(strata);
        const double place = strata == size_ ? static_cast<double>(i)
                                             : from + width * uniform({.seed = options_.seed, .pulse = i, .subray = 2});
        numbers.push_back(i);
        slots.push_back(std::min(size_ - 1, static_cast<PulseIndex>(place)));
      }
      const std::vector<SlotCount> found = count_echoes(survey_, slots, options_.threads);
      for (std::size_t k = 0; k < slots.size(); ++k) {
        counts[numbers[k]] = found[k];
        places[numbers[k]] = slots[k];
      }
    }
    std::vector<double> echoes, pulses, empty;  // of the sampled slots in order
    for (std::uint64_t i = 0; i < strata; ++i) {
      if (!counts[i]) continue;
      const Kind::Value kind = Kind::of(counts[i]->fate);
      echoes.push_back(counts[i]->echoes);
      pulses.push_back(kind != Kind::blocked ? 1 : 0);
      empty.push_back(kind != Kind::blocked && counts[i]->echoes == 0 ? 1 : 0);
      found_[kind].push_back(places[i]);
    }
    estimate_.sampled = echoes.size();
    estimate_.echoes = detail::total_of(echoes, size_);
    estimate_.pulses = detail::total_of(pulses, size_);
    estimate_.empty_pulses = detail::total_of(empty, size_);
    for (std::size_t k = 0; k < Kind::count && !echoes.empty(); ++k)
      slots_[k] =
          static_cast<double>(found_[k].size()) * static_cast<double>(size_) / static_cast<double>(echoes.size());
  }

  /// Measures the time of slots by kind.
  void measure_time() {
    constexpr std::uint64_t max_rounds = 48;
    std::vector<Sample> samples;
    std::vector<Kind::Value> begin_at;
    const ProcessorBudget budget(1.0, workers_);
    for (std::uint64_t round = 0; round < max_rounds && (round == 0 || budget.left()); ++round)
      for (const Kind::Value kind : {Kind::hit, Kind::missed, Kind::blocked}) {
        const std::uint64_t each = kind == Kind::hit ? 16 : 4;
        std::vector<SampleBlock> some = blocks(kind, round * each, (round + 1) * each, 128, 896);
        for (SampleBlock& block : some) block.empty_shots = options_.empty_shots;
        for (Sample& one : sample(survey_, some, options_.threads)) {
          samples.push_back(std::move(one));
          begin_at.push_back(kind);
        }
      }
    const std::vector<double> weights = weights_of(begin_at);
    const detail::BySlotKind cost = detail::cost_of_kinds(samples, samples, weights);
    double rest = 0, sum = 0;
    for (std::size_t b = 0; b < samples.size(); ++b) {
      rest += std::pow(weights[b] * (samples[b].seconds - detail::dot(detail::kinds_in(samples[b]), cost)), 2);
      sum += weights[b] * samples[b].seconds;
      estimate_.sampled += samples[b].counts.slots;
    }
    const double seconds = std::max(0.0, detail::dot(slots_, cost));
    const double unsure = std::hypot(0.1, sum > 0 ? 2 * std::sqrt(rest) / sum : 0);  // 10 %: caches of a sample
    estimate_.seconds = {seconds, (1 - unsure) * seconds, (1 + unsure) * seconds};
    hit_cost_ = std::max({cost[Kind::hit], cost[Kind::missed], 1e-8});
  }

  /// Blocks of consecutive slots, each with a first slot of one kind.
  [[nodiscard]] std::vector<SampleBlock> blocks(Kind::Value kind, std::uint64_t first, std::uint64_t end,
                                                PulseIndex before, PulseIndex length) const {
    std::vector<SampleBlock> blocks;
    const double start = uniform({.seed = options_.seed, .pulse = kind, .subray = 3});
    for (std::uint64_t k = first; k < end && !found_[kind].empty(); ++k) {
      const PulseIndex from = detail::spread_over(found_[kind], k, start);
      blocks.push_back({from - std::min(from, before), from, std::min(size_, from + length)});
    }
    return blocks;
  }

  /// Blocks of the survey per block of a sample, by the kind of its first slot. Source: Horvitz & Thompson 1952.
  [[nodiscard]] std::vector<double> weights_of(std::span<const Kind::Value> begin_at) const {
    detail::BySlotKind number{};
    for (const Kind::Value kind : begin_at) ++number[kind];
    std::vector<double> weights;
    for (const Kind::Value kind : begin_at) weights.push_back(slots_[kind] / number[kind]);
    return weights;
  }

  AnySurvey survey_;
  ForecastOptions options_;
  double workers_;  // threads that run at the same time
  PulseIndex size_;
  RunEstimate estimate_{};
  std::array<std::vector<PulseIndex>, Kind::count> found_{};  // sampled slots in order, by kind
  detail::BySlotKind slots_{};                                // number of slots of the survey
  double hit_cost_ = 0;                                       // of a slot [s]
};

/// Forecasts variants of a survey, such as other receivers, from the same pulses, and their errors by a finer one.
class VariantForecaster {
 public:
  /// `efforts` is the work of all variants to come, `finer_effort` that of the finer survey, in units of the survey's
  /// own: samples are then small enough for some 1.3 s on all threads. `of_survey` may know more than the forecaster.
  VariantForecaster(const RunForecaster& survey, const RunEstimate& of_survey, const AnySurvey& finer,
                    double finer_effort, double efforts)
      : survey_(survey), estimate_(of_survey) {
    const auto affordable = [&](double seconds, double each, double low, double high) {
      return static_cast<std::uint64_t>(std::clamp(seconds * survey.workers_ / (each * survey.hit_cost_), low, high));
    };
    const std::uint64_t n = affordable(0.8, 1.4 * 80 * efforts, 8, 96);
    for (const Kind::Value kind : {Kind::hit, Kind::missed, Kind::blocked})
      for (const SampleBlock& block : survey.blocks(kind, 0, kind == Kind::hit ? n : n / 4, 16, 64)) {
        blocks_.push_back(block);
        kinds_.push_back(kind);
      }
    weights_ = survey.weights_of(kinds_);
    own_ = sampled(survey.survey_, blocks_);
    own_cost_ = detail::dot(survey.slots_, detail::cost_of_kinds(own_, own_, weights_));
    compared_ = survey.blocks(Kind::hit, 0, affordable(0.5, finer_effort + efforts, 128, 2048), 0, 1);
    finer_ = sampled(finer, compared_);
  }

  /// Estimates of a variant: echoes and time.
  [[nodiscard]] RunEstimate estimate(const AnySurvey& variant) const {
    const std::vector<Sample> samples = sampled(variant, blocks_);
    RunEstimate estimate = estimate_;
    const double cost = detail::dot(survey_.slots_, detail::cost_of_kinds(own_, samples, weights_));
    if (own_cost_ > 0)
      for (double* s : {&estimate.seconds.value, &estimate.seconds.low, &estimate.seconds.high})
        *s *= std::max(0.0, cost / own_cost_);
    add_echoes(samples, estimate.echoes);
    return estimate;
  }

  /// Errors of a variant against the finer survey, whose echoes are the same within `reach` [m].
  [[nodiscard]] ErrorsByClass errors(const AnySurvey& variant, double reach) const {
    return detail::errors_by_class("", detail::matches_of(finer_, sampled(variant, compared_), reach), compared_.size(),
                                   0);
  }

 private:
  using Kind = detail::SlotKind;

  [[nodiscard]] std::vector<Sample> sampled(const AnySurvey& survey, std::span<const SampleBlock> blocks) const {
    return sample(survey, blocks, survey_.options_.threads);
  }

  /// Adds the difference in echoes from the survey itself, measured on the same pulses.
  void add_echoes(std::span<const Sample> samples, Estimate& echoes) const {
    double more = 0, variance = 0;
    for (const Kind::Value kind : {Kind::hit, Kind::missed}) {
      double sum = 0, number = 0, squares = 0;
      std::vector<std::pair<double, double>> all;
      for (std::size_t b = 0; b < blocks_.size(); ++b) {
        if (kinds_[b] != kind) continue;
        auto& [difference, slots] = all.emplace_back(0, 0);
        for (std::size_t k = 0; k < own_[b].shots.size(); ++k) {
          if (Kind::of(own_[b].shots[k].fate) != kind) continue;
          difference += static_cast<double>(samples[b].shots[k].echoes) - static_cast<double>(own_[b].shots[k].echoes);
          ++slots;
        }
        sum += difference;
        number += slots;
      }
      if (number == 0) continue;
      for (const auto& [difference, slots] : all) squares += std::pow(difference - sum / number * slots, 2);
      more += survey_.slots_[kind] * sum / number;
      variance += std::pow(survey_.slots_[kind] / number, 2) * squares;
    }
    const auto margin = [&](double end) { return std::sqrt(std::pow(end - echoes.value, 2) + 4 * variance); };
    const double low = margin(echoes.low), high = margin(echoes.high);
    echoes.value = std::max(0.0, echoes.value + more);
    echoes.low = std::max(0.0, echoes.value - low);
    echoes.high = echoes.value + high;
  }

  const RunForecaster& survey_;
  RunEstimate estimate_;
  std::vector<SampleBlock> blocks_{}, compared_{};
  std::vector<Kind::Value> kinds_{};  // of the first slot of each block
  std::vector<double> weights_{};
  std::vector<Sample> own_{}, finer_{};
  double own_cost_ = 0;  // of all slots [s]
};

}  // namespace PULSECAST_NAMESPACE

#endif
