// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

#include "forecast.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <pulsecast/base/parallel.hpp>
#include <pulsecast/base/units.hpp>
#include <pulsecast/helios/survey.hpp>
#include <pulsecast/scanner/footprint.hpp>

#include "outputs.hpp"

using namespace pulsecast;
using helios::ReceiverOverrides;
using helios::Simulation;
using helios::SurveySettings;

namespace {

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
        options_(options),
        seed_(seed),
        workers_(std::min(thread_count(options.threads), thread_count(0))),
        loading_(loading),
        channels_(file_channels(options, survey)),
        counted_(pulse_lines(options, channels_)),
        trial_(trial_run(simulation, options, channels_, counted_)),
        run_(simulation.survey(),
             {.seed = seed, .threads = options.threads, .empty_shots = counted_ != PulseLines::none}),
        own_(run_.estimate()) {
    if (counted_ != PulseLines::none) lines_ = counted_ == PulseLines::all ? own_.pulses : own_.empty_pulses;
    for (const helios::ChannelSettings& channel : survey.scanner.channels) {
      pulse_length_ = std::min(pulse_length_, channel.pulse_length);
      rings_ = std::max(rings_, channel.waveform.rings);
      bin_size_ = std::min(bin_size_, channel.waveform.bin_size);
    }
    writing_ = writing_costs(simulation, options, channels_, counted_, run_.spread_results(24));
    if (!trial_.complete) return;
    own_.echoes = {trial_.points, trial_.points, trial_.points};
    lines_ = {trial_.lines, trial_.lines, trial_.lines};
    writing_.bytes.scale_to(trial_.bytes, trial_.points, trial_.lines);
  }

  [[nodiscard]] Forecasts all() const {
    const ReceiverOverrides finest = simulation_.reference();
    Forecasts out{.loading = loading_,
                  .slots = simulation_.survey().size(),
                  .sampled = own_.sampled,
                  .finest = subrays_of(*finest.rings)};
    std::optional<SettingsChoice> choice;
    if (options_.accuracy)
      choice = simulation_.choose(*options_.accuracy, {.seed = seed_, .threads = options_.threads});
    const std::vector<ReceiverOverrides> candidates =
        choice ? std::vector<ReceiverOverrides>{{}, ReceiverOverrides::of(choice->values)} : this->candidates();
    const auto effort = [&, own = static_cast<double>(subrays_of(rings_))](int rings) {
      return 0.3 + 0.7 * static_cast<double>(subrays_of(rings)) / own;
    };
    double efforts = 0;
    for (const ReceiverOverrides& overrides : candidates) efforts += effort(overrides.rings.value_or(rings_));
    const VariantForecaster variants(run_, own_, simulation_.with_receivers(finest)->survey(), effort(*finest.rings),
                                     efforts);
    for (const ReceiverOverrides& overrides : candidates) out.all.push_back(forecast(overrides, variants));
    if (choice) out.all.back().errors = choice->errors;
    return out;
  }

 private:
  /// Own settings of the survey, then all other plausible ones.
  [[nodiscard]] std::vector<ReceiverOverrides> candidates() const {
    std::vector<ReceiverOverrides> all{{}};
    std::vector<double> bins = round_numbers(pulse_length_ * 1e9 / 64, pulse_length_ * 1e9 / 4);
    for (double& bin : bins) bin /= 1e9;
    bins.push_back(bin_size_);
    for (const int rings : {1, 2, 3, 4, 5, 6, 8, 10})
      for (const double bin : bins)
        if (rings != rings_ || bin != bin_size_) all.push_back({.rings = rings, .bin_size = bin});
    return all;
  }

  [[nodiscard]] Forecast forecast(const ReceiverOverrides& overrides, const VariantForecaster& variants) const {
    ReceiverOverrides ideal = overrides;
    ideal.ideal = true;
    const double reach = 0.25 * speed_of_light * pulse_length_;  // half a pulse length, two-way
    const bool other = overrides != ReceiverOverrides{};
    const RunEstimate run = other ? variants.estimate(simulation_.with_receivers(overrides)->survey()) : own_;
    Forecast f{.overrides = overrides,
               .subrays = subrays_of(overrides.rings.value_or(rings_)),
               .points = run.echoes,
               .errors = variants.errors(simulation_.with_receivers(ideal)->survey(), reach).all};
    entire(f, run.seconds);
    return f;
  }

  /// Estimates time, memory and files from the measurements.
  void entire(Forecast& f, const Estimate& computing) const {
    const double repetitions = simulation_.repetitions();
    const auto seconds = [&](double points, double unsure) {
      const double writing = writing_.seconds.growing(points, lines_.value);
      // One thread writes at a time, while the others compute.
      return repetitions *
             (loading_ + unsure * (writing_.seconds.fixed + std::max(writing, (computing.value + writing) / workers_)));
    };
    const double unsure = own_.seconds.value > 0 ? own_.seconds.high / own_.seconds.value - 1 : 0.1;
    f.seconds = {seconds(f.points.value, 1), seconds(f.points.low, 1 - unsure), seconds(f.points.high, 1 + unsure)};
    const WritingCost& bytes = writing_.bytes;
    const double growing = bytes.growing(f.points.value, lines_.value), value = bytes.fixed + growing;
    const auto margin = [&](double points, double lines) {
      return std::sqrt(std::pow(bytes.unsure * growing, 2) + std::pow(bytes.point * (points - f.points.value), 2) +
                       std::pow(bytes.line * (lines - lines_.value), 2));
    };
    f.bytes = {repetitions * value, repetitions * std::max(bytes.fixed, value - margin(f.points.low, lines_.low)),
               repetitions * (value + margin(f.points.high, lines_.high))};
    f.memory = trial_.memory(f.points.high, options_);
    for (double* end : {&f.points.value, &f.points.low, &f.points.high}) *end *= repetitions;
  }

  const Simulation& simulation_;
  const Options& options_;
  std::uint64_t seed_;
  double workers_;  ///< threads that run at the same time
  double loading_;
  std::vector<std::string> channels_;  ///< see `file_channels`
  PulseLines counted_;
  TrialRun trial_;
  RunForecaster run_;
  RunEstimate own_;   ///< with the survey's own settings
  Estimate lines_{};  ///< pulses that count beside the points
  WritingCosts writing_{};
  double pulse_length_ = std::numeric_limits<double>::infinity(), bin_size_ = std::numeric_limits<double>::infinity();
  int rings_ = 1;
};

}  // namespace

Forecasts forecasts_of(const Simulation& simulation, const SurveySettings& survey, const Options& options,
                       std::uint64_t seed, double loading) {
  return Forecaster(simulation, survey, options, seed, loading).all();
}
