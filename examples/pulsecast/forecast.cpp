// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

#include "forecast.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include <pulsecast/base/parallel.hpp>
#include <pulsecast/base/random.hpp>
#include <pulsecast/helios/survey.hpp>
#include <pulsecast/sample.hpp>

#include "outputs.hpp"

using namespace pulsecast;
using helios::CompiledSurvey;
using helios::ReceiverOverrides;
using helios::Simulation;
using helios::SurveySettings;

namespace {

/// Classes of slots with equal cost.
enum Kind : std::uint8_t { blocked, missed, hit };
constexpr std::size_t kinds = 3;

Kind kind_of(Fate fate) { return fate == Fate::blocked ? blocked : fate == Fate::missed ? missed : hit; }

// ------------------------------------------------------------------------------------------- slots

/// Results of single slots, spread over the whole survey.
struct Census {
  std::array<double, kinds> slots{};  ///< number of slots in the survey, by kind
  Estimate points{};
  Estimate lines{};                                    ///< pulses that count beside the points
  std::array<std::vector<PulseIndex>, kinds> found{};  ///< sampled slots in order
  std::uint64_t sampled = 0;
};

/// Total over a survey of `size` slots from a sample in order. The variance is from differences of neighbours. Source:
/// Cochran 1977, sections 5.3 and 5A.12.
Estimate total_of(const std::vector<double>& sample, std::uint64_t size) {
  if (sample.empty()) return {};
  double sum = 0, differences = 0;
  for (std::size_t i = 0; i < sample.size(); ++i) {
    sum += sample[i];
    if (i > 0) differences += std::pow(sample[i] - sample[i - 1], 2);
  }
  const double n = static_cast<double>(sample.size()), all = static_cast<double>(size), each = all / n,
               value = sum * each;
  const double deviation = n < 2 ? 0 : each * std::sqrt((1 - n / all) * n * differences / (2 * (n - 1)));
  // Upper limit after n trials without success: 3 in n. Source: Hanley & Lippman-Hand 1983.
  const double none = sample.size() == size ? 0 : 3 * each;
  return {value, std::max(sum, value - 2 * deviation), sum > 0 ? value + 2 * deviation : none};
}

/// Stratified random sample: one slot from each of many equal strata. Rounds visit the strata, each spread over the
/// whole survey. A small survey is counted in full.
Census take_census(const Simulation& simulation, PulseLines counted, std::uint64_t seed, unsigned threads,
                   double workers) {
  constexpr std::uint64_t rounds = 64, max_size = rounds << 12;
  const std::uint64_t size = simulation.compiled().source.size(), strata = std::min(size, max_size),
                      each_round = (strata + rounds - 1) / rounds;
  std::vector<std::optional<SlotCount>> counts(strata);
  std::vector<PulseIndex> places(strata);
  const Allowance allowance(0.35, workers);
  for (std::uint64_t round = 0; round < rounds && (round == 0 || allowance.left()); ++round) {
    std::vector<std::uint64_t> numbers;
    std::vector<PulseIndex> slots;
    for (std::uint64_t k = 0; k < each_round; ++k) {
      const auto turn = static_cast<std::uint64_t>(uniform({.seed = seed, .pulse = k, .subray = 1}) * rounds);
      const std::uint64_t i = k * rounds + (round * 37 + turn) % rounds;  // 37 has no divisor in common with the rounds
      if (i >= strata) continue;
      const double from = static_cast<double>(size) * static_cast<double>(i) / static_cast<double>(strata);
      const double width = static_cast<double>(size) / static_cast<double>(strata);
      const double place =
          strata == size ? static_cast<double>(i) : from + width * uniform({.seed = seed, .pulse = i, .subray = 2});
      numbers.push_back(i);
      slots.push_back(std::min(size - 1, static_cast<PulseIndex>(place)));
    }
    const std::vector<SlotCount> found = count_echoes(simulation.survey(), slots, threads);
    for (std::size_t k = 0; k < slots.size(); ++k) {
      counts[numbers[k]] = found[k];
      places[numbers[k]] = slots[k];
    }
  }
  Census census;
  std::vector<double> echoes, lines;  // of the sampled slots in order
  for (std::uint64_t i = 0; i < strata; ++i) {
    if (!counts[i]) continue;
    const Kind kind = kind_of(counts[i]->fate);
    echoes.push_back(counts[i]->echoes);
    const bool counts_beside = counted == PulseLines::all || (counted == PulseLines::empty && counts[i]->echoes == 0);
    lines.push_back(kind != blocked && counts_beside ? 1 : 0);
    census.found[kind].push_back(places[i]);
  }
  census.sampled = echoes.size();
  census.points = total_of(echoes, size);
  census.lines = total_of(lines, size);
  for (std::size_t k = 0; k < kinds && census.sampled > 0; ++k)
    census.slots[k] =
        static_cast<double>(census.found[k].size()) * static_cast<double>(size) / static_cast<double>(census.sampled);
  return census;
}

/// Element of a list by golden-section steps: any number of first steps is spread over the whole list. Source: Weyl
/// 1916.
PulseIndex spread_over(const std::vector<PulseIndex>& list, std::uint64_t number, double start) {
  const double at = start + static_cast<double>(number) * 0.6180339887498949;
  return list[std::min(list.size() - 1,
                       static_cast<std::size_t>((at - std::floor(at)) * static_cast<double>(list.size())))];
}

// -------------------------------------------------------------------------------------------- time

/// Blocks of consecutive slots, each with a first slot of one kind.
std::vector<SampleBlock> blocks_at(const Census& census, Kind kind, std::uint64_t first, std::uint64_t end,
                                   PulseIndex before, PulseIndex length, std::uint64_t seed, PulseIndex size) {
  std::vector<SampleBlock> blocks;
  const std::vector<PulseIndex>& all = census.found[kind];
  const double start = uniform({.seed = seed, .pulse = kind, .subray = 3});
  for (std::uint64_t k = first; k < end && !all.empty(); ++k) {
    const PulseIndex from = spread_over(all, k, start);
    blocks.push_back({from - std::min(from, before), from, std::min(size, from + length)});
  }
  return blocks;
}

/// Number of slots in a block by kind.
std::array<double, kinds> kinds_in(const Sample& sample) {
  std::array<double, kinds> n{};
  for (std::size_t f = 0; f < fate_count; ++f)
    n[kind_of(static_cast<Fate>(f))] += static_cast<double>(sample.counts.fates[f]);
  return n;
}

/// Cost of a slot of each kind [s], calibrated to the total of all slots: weighted least squares over blocks. A cost
/// may be below zero, as costs vary within a kind and blocks mix kinds. Source: Sarndal, Swensson & Wretman 1992, Model
/// Assisted Survey Sampling, chapter 6, the regression estimator.
std::array<double, kinds> cost_of_kinds(std::span<const Sample> kinds_of, std::span<const Sample> times,
                                        std::span<const double> weights) {
  std::array<std::array<double, kinds + 1>, kinds> m{};
  for (std::size_t b = 0; b < kinds_of.size(); ++b) {
    const auto n = kinds_in(kinds_of[b]);
    for (std::size_t i = 0; i < kinds; ++i) {
      for (std::size_t j = 0; j < kinds; ++j) m[i][j] += weights[b] * n[i] * n[j];
      m[i][kinds] += weights[b] * n[i] * times[b].seconds;
    }
  }
  double trace = 0;
  for (std::size_t i = 0; i < kinds; ++i) trace += m[i][i];
  for (std::size_t i = 0; i < kinds; ++i) m[i][i] += 1e-9 * trace;
  for (std::size_t i = 0; i < kinds; ++i)  // Gaussian elimination; the matrix is positive definite
    for (std::size_t row = 0; row < kinds; ++row) {
      if (row == i || !(m[i][i] > 0)) continue;
      const double factor = m[row][i] / m[i][i];
      for (std::size_t j = i; j <= kinds; ++j) m[row][j] -= factor * m[i][j];
    }
  std::array<double, kinds> cost{};
  for (std::size_t i = 0; i < kinds; ++i) cost[i] = m[i][i] > 0 ? m[i][kinds] / m[i][i] : 0;
  return cost;
}

/// Sampling weights: number of blocks of the survey per block of a sample, by the kind of its first slot. Source:
/// Horvitz & Thompson 1952.
std::vector<double> weights_of(const Census& census, std::span<const Kind> begin_at) {
  std::array<double, kinds> number{};
  for (const Kind kind : begin_at) ++number[kind];
  std::vector<double> weights;
  for (const Kind kind : begin_at) weights.push_back(census.slots[kind] / number[kind]);
  return weights;
}

double dot(const std::array<double, kinds>& a, const std::array<double, kinds>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < kinds; ++i) sum += a[i] * b[i];
  return sum;
}

// ------------------------------------------------------------------------------------------ errors

/// 95 % quantile, with confidence limits by order statistics. Source: David & Nagaraja 2003, section 7.1, with the
/// normal approximation of the binomial distribution.
Estimate exceeded_by_few(std::vector<double>& all) {
  if (all.empty()) return {0, 0, std::numeric_limits<double>::infinity()};
  std::sort(all.begin(), all.end());
  constexpr double share = 0.95;
  const double n = static_cast<double>(all.size()), margin = 2 * std::sqrt(n * share * (1 - share));
  const auto at = [&](double rank) { return all[static_cast<std::size_t>(std::clamp(rank, 0.0, n - 1))]; };
  return {at(n * share), at(n * share - margin), at(n * share + margin)};
}

/// Differences between the echoes of pulses and those of a finer simulation.
struct Differences {
  std::vector<double> range{}, intensity{};  ///< [m], and relative; of echoes in both
  double of_finer = 0, of_other = 0;         ///< number of echoes

  /// Matches each echo of the finer simulation with the nearest one within `reach` [m].
  void add(std::span<const Echo> finer, std::span<const Echo> other, double reach) {
    std::size_t next = 0;
    for (const Echo& echo : finer) {
      const auto distance = [&](std::size_t k) { return std::fabs(other[k].range - echo.range); };
      std::size_t nearest = next;
      for (std::size_t k = next; k < other.size(); ++k)
        if (distance(k) < distance(nearest)) nearest = k;
      if (nearest >= other.size() || distance(nearest) > reach) continue;
      range.push_back(distance(nearest));
      intensity.push_back(std::fabs(other[nearest].amplitude / echo.amplitude - 1));
      next = nearest + 1;
    }
    of_finer += static_cast<double>(finer.size());
    of_other += static_cast<double>(other.size());
  }
};

// ---------------------------------------------------------------------------------------- together

/// Round numbers (1, 2, 5, 10 and so on) in an interval.
std::vector<double> round_numbers(double from, double to) {
  std::vector<double> all;
  for (int power = static_cast<int>(std::floor(std::log10(from))); std::pow(10.0, power) <= to; ++power)
    for (const int digit : {1, 2, 5})
      if (const double x = power < 0 ? digit / std::pow(10.0, -power) : digit * std::pow(10.0, power);
          x >= from && x <= to)
        all.push_back(x);
  return all;
}

std::size_t subrays_of(int rings) { return RingFootprint(static_cast<std::size_t>(rings)).size(); }

class Forecaster {
 public:
  Forecaster(const Simulation& simulation, const SurveySettings& survey, const Options& options, std::uint64_t seed,
             double loading)
      : simulation_(simulation),
        survey_(survey),
        compiled_(simulation.compiled()),
        options_(options),
        seed_(seed),
        threads_(thread_count(options.threads)),
        workers_(std::min(threads_, thread_count(0))),
        loading_(loading),
        channels_(file_channels(options, survey)),
        lines_(pulse_lines(options, channels_)),
        trial_(trial_run(simulation, options, channels_, lines_)),
        census_(take_census(simulation, lines_, seed, threads_, workers_)) {
    for (const helios::ChannelSettings& channel : survey_.scanner.channels) {
      pulse_length_ = std::min(pulse_length_, channel.pulse_length);
      rings_ = std::max(rings_, channel.waveform.rings);
      bin_size_ = std::min(bin_size_, channel.waveform.bin_size);
    }
    if (trial_.complete) {
      census_.points = {trial_.points, trial_.points, trial_.points};
      census_.lines = {trial_.lines, trial_.lines, trial_.lines};
    }
    finest_ = {.rings = std::clamp(2 * rings_, 26, 100), .bin_size = pulse_length_ / 128, .ideal = true};
  }

  Forecasts all() {
    Forecasts out{.loading = loading_, .slots = compiled_.source.size(), .finest = subrays_of(*finest_.rings)};
    if (compiled_.source.size() == 0) return out;
    measure_as_is();
    out.sampled = sampled_;
    prepare_others();
    for (const ReceiverOverrides& overrides : candidates()) out.all.push_back(forecast(overrides));
    return out;
  }

 private:
  using ByKind = std::array<double, kinds>;

  [[nodiscard]] std::vector<SampleBlock> blocks(Kind kind, std::uint64_t first, std::uint64_t end, PulseIndex before,
                                                PulseIndex length) const {
    return blocks_at(census_, kind, first, end, before, length, seed_, compiled_.source.size());
  }

  /// Measures the survey with its own settings: cost of slots by kind, and cost of writing the results.
  void measure_as_is() {
    constexpr std::uint64_t max_rounds = 48;
    std::vector<Sample> samples;
    std::vector<Kind> begin_at;
    const Allowance allowance(1.0, workers_);
    for (std::uint64_t round = 0; round < max_rounds && (round == 0 || allowance.left()); ++round)
      for (const Kind kind : {hit, missed, blocked}) {
        const std::uint64_t each = kind == hit ? 16 : 4;
        std::vector<SampleBlock> subset = blocks(kind, round * each, (round + 1) * each, 128, 896);
        for (SampleBlock& block : subset) block.empty_shots = lines_ != PulseLines::none;
        for (Sample& sample : sample(simulation_.survey(), subset, threads_)) {
          samples.push_back(std::move(sample));
          begin_at.push_back(kind);
        }
      }
    const std::vector<double> weights = weights_of(census_, begin_at);
    const ByKind cost = cost_of_kinds(samples, samples, weights);
    double rest = 0, sum = 0;
    sampled_ = census_.sampled;
    for (std::size_t b = 0; b < samples.size(); ++b) {
      const Sample& sample = samples[b];
      rest += std::pow(weights[b] * (sample.seconds - dot(kinds_in(sample), cost)), 2);
      sum += weights[b] * sample.seconds;
      sampled_ += sample.counts.slots;
    }
    computing_ = std::max(0.0, dot(census_.slots, cost));
    hit_cost_ = std::max({cost[hit], cost[missed], 1e-8});
    unsure_ = sum > 0 ? 2 * std::sqrt(rest) / sum : 0;
    measure_writing();
  }

  /// Measures the cost of writing stretches that are spread over all results.
  void measure_writing() {
    std::vector<PulseIndex> results = census_.found[hit], starts;
    if (lines_ != PulseLines::none || results.empty())
      results.insert(results.end(), census_.found[missed].begin(), census_.found[missed].end());
    if (results.empty()) results = census_.found[blocked];
    std::sort(results.begin(), results.end());
    for (std::uint64_t k = 0; k < 24; ++k)
      starts.push_back(spread_over(results, k, uniform({.seed = seed_, .subray = 4})));
    writing_ = writing_costs(simulation_, options_, channels_, lines_, starts);
    if (trial_.complete) writing_.bytes.scale_to(trial_.bytes, trial_.points, trial_.lines);
  }

  /// Prepares the reference for other settings, with few enough pulses to try all settings in about a second.
  void prepare_others() {
    double trials = 0;  // in units of the survey's own settings
    const auto own = static_cast<double>(subrays_of(rings_));
    const auto effort = [&](int rings) { return 0.3 + 0.7 * static_cast<double>(subrays_of(rings)) / own; };
    for (const ReceiverOverrides& overrides : candidates()) trials += effort(overrides.rings.value_or(rings_));
    const auto affordable = [&](double seconds, double each, double low, double high) {
      return static_cast<std::uint64_t>(std::clamp(seconds * workers_ / (each * hit_cost_), low, high));
    };
    const std::uint64_t n = affordable(0.8, 1.4 * 80 * trials, 8, 96);
    for (const Kind kind : {hit, missed, blocked})
      for (const SampleBlock& block : blocks(kind, 0, kind == hit ? n : n / 4, 16, 64)) {
        blocks_.push_back(block);
        kind_of_block_.push_back(kind);
      }
    weights_ = weights_of(census_, kind_of_block_);
    own_ = sample(simulation_.survey(), blocks_, threads_);
    own_cost_ = dot(census_.slots, cost_of_kinds(own_, own_, weights_));
    compared_ = blocks(hit, 0, affordable(0.5, effort(*finest_.rings) + trials, 128, 2048), 0, 1);
    finer_ = sampled_with(finest_, compared_);
  }

  /// Own settings of the survey, then all other plausible ones.
  [[nodiscard]] std::vector<ReceiverOverrides> candidates() const {
    std::vector<ReceiverOverrides> all{{}};
    std::vector<double> bins = round_numbers(pulse_length_ * 1e9 / 64, pulse_length_ * 1e9 / 4);
    for (double& bin : bins) bin /= 1e9;
    bins.push_back(bin_size_);
    for (const int rings : {1, 2, 3, 4, 5, 6, 8, 10})
      for (const double bin : bins)
        if (rings != rings_ || bin != bin_size_) all.push_back({rings, bin});
    return all;
  }

  [[nodiscard]] std::vector<Sample> sampled_with(const ReceiverOverrides& overrides,
                                                 std::span<const SampleBlock> blocks) const {
    return sample(simulation_.with_receivers(overrides)->survey(), blocks, threads_);
  }

  Forecast forecast(const ReceiverOverrides& overrides) const {
    Forecast f{
        .overrides = overrides, .subrays = subrays_of(overrides.rings.value_or(rings_)), .points = census_.points};
    const bool other = overrides != ReceiverOverrides{};
    double computing = computing_;
    if (other) {
      const std::vector<Sample> samples = sampled_with(overrides, blocks_);
      if (own_cost_ > 0)
        computing *= std::max(0.0, dot(census_.slots, cost_of_kinds(own_, samples, weights_)) / own_cost_);
      add_points(samples, f.points);
    }
    entire(f, computing);
    compare(sampled_with({overrides.rings, overrides.bin_size, true}, compared_), f);
    return f;
  }

  /// Adds the difference in points from the survey's own settings, measured on the same pulses.
  void add_points(const std::vector<Sample>& samples, Estimate& points) const {
    double more = 0, variance = 0;
    for (const Kind kind : {hit, missed}) {
      double sum = 0, number = 0, squares = 0;
      std::vector<std::pair<double, double>> all;
      for (std::size_t b = 0; b < blocks_.size(); ++b) {
        if (kind_of_block_[b] != kind) continue;
        auto& [difference, slots] = all.emplace_back(0, 0);
        for (std::size_t k = 0; k < own_[b].shots.size(); ++k) {
          if (kind_of(own_[b].shots[k].fate) != kind) continue;
          difference += static_cast<double>(samples[b].shots[k].echoes) - static_cast<double>(own_[b].shots[k].echoes);
          ++slots;
        }
        sum += difference;
        number += slots;
      }
      if (number == 0) continue;
      for (const auto& [difference, slots] : all) squares += std::pow(difference - sum / number * slots, 2);
      more += census_.slots[kind] * sum / number;
      variance += std::pow(census_.slots[kind] / number, 2) * squares;
    }
    const auto margin = [&](double end) { return std::sqrt(std::pow(end - points.value, 2) + 4 * variance); };
    const double low = margin(points.low), high = margin(points.high);
    points.value = std::max(0.0, points.value + more);
    points.low = std::max(0.0, points.value - low);
    points.high = points.value + high;
  }

  /// Estimates time, memory and files from the measurements.
  void entire(Forecast& f, double computing) const {
    const double repetitions = simulation_.repetitions();
    const auto seconds = [&](double points, double unsure) {
      const double writing = writing_.seconds.growing(points, census_.lines.value);
      // One thread writes at a time, while the others compute.
      return repetitions *
             (loading_ + unsure * (writing_.seconds.fixed + std::max(writing, (computing + writing) / workers_)));
    };
    const double unsure = std::hypot(0.1, unsure_);  // sampling misses subset effects: 10 % uncertainty
    f.seconds = {seconds(f.points.value, 1), seconds(f.points.low, 1 - unsure), seconds(f.points.high, 1 + unsure)};
    const WritingCost& bytes = writing_.bytes;
    const double growing = bytes.growing(f.points.value, census_.lines.value), value = bytes.fixed + growing;
    const auto margin = [&](double points, double lines) {
      return std::sqrt(std::pow(bytes.unsure * growing, 2) + std::pow(bytes.point * (points - f.points.value), 2) +
                       std::pow(bytes.line * (lines - census_.lines.value), 2));
    };
    f.bytes = {repetitions * value,
               repetitions * std::max(bytes.fixed, value - margin(f.points.low, census_.lines.low)),
               repetitions * (value + margin(f.points.high, census_.lines.high))};
    f.memory = trial_.memory(f.points.high, options_);
    for (double* end : {&f.points.value, &f.points.low, &f.points.high}) *end *= repetitions;
  }

  void compare(const std::vector<Sample>& samples, Forecast& f) const {
    Differences all;
    const double reach = 0.25 * speed_of_light * pulse_length_;  // half a pulse length, two-way
    for (std::size_t b = 0; b < samples.size(); ++b)
      for (std::size_t k = 0; k < samples[b].shots.size(); ++k)
        all.add(finer_[b].batch().echoes_of(finer_[b].shots[k]), samples[b].batch().echoes_of(samples[b].shots[k]),
                reach);
    const double of_both = static_cast<double>(all.range.size());
    f.range_error = exceeded_by_few(all.range);
    f.intensity_error = exceeded_by_few(all.intensity);
    f.lost = all.of_finer > 0 ? 1 - of_both / all.of_finer : 0;
    f.invented = all.of_other > 0 ? 1 - of_both / all.of_other : 0;
  }

  const Simulation& simulation_;
  const SurveySettings& survey_;
  const CompiledSurvey& compiled_;
  const Options& options_;
  std::uint64_t seed_;
  unsigned threads_;
  double workers_;  ///< threads that run at the same time
  double loading_;
  std::vector<std::string> channels_;  ///< see `file_channels`
  PulseLines lines_;
  TrialRun trial_;
  Census census_;
  double pulse_length_ = std::numeric_limits<double>::infinity(), bin_size_ = std::numeric_limits<double>::infinity();
  int rings_ = 1;
  ReceiverOverrides finest_{};
  // with the survey's own settings
  double computing_ = 0, hit_cost_ = 0, unsure_ = 0;
  std::uint64_t sampled_ = 0;
  WritingCosts writing_{};
  // reference for other settings
  std::vector<SampleBlock> blocks_, compared_;
  std::vector<Kind> kind_of_block_;
  std::vector<double> weights_;
  std::vector<Sample> own_, finer_;
  double own_cost_ = 0;
};

}  // namespace

Forecasts forecasts_of(const Simulation& simulation, const SurveySettings& survey, const Options& options,
                       std::uint64_t seed, double loading) {
  return Forecaster(simulation, survey, options, seed, loading).all();
}
