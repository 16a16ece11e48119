// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

#include "forecast_report.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <initializer_list>
#include <iomanip>
#include <iostream>
#include <limits>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include <pulsecast/base/parallel.hpp>

#include "accuracy.hpp"
#include "error_report.hpp"
#include "estimate_text.hpp"
#include "forecast.hpp"
#include "outputs.hpp"

namespace {

using pulsecast::ErrorFigure;

/// Chooses settings, with reasons.
class SettingsChooser {
 public:
  SettingsChooser(const Options& options, const pulsecast::helios::SurveySettings& survey, const Forecasts& found)
      : options_(options), asked_(options.forecast), survey_(survey), found_(found) {}

  [[nodiscard]] const Forecast* choose() const {
    std::vector<const Forecast*> able;
    for (const Forecast& f : found_.all)
      if (worst(f) <= 1) able.push_back(&f);
    if (able.empty()) return nullptr;
    // Differences below a twentieth are ties. Ties go to the survey's own settings, then to the other criterion.
    constexpr double same = 1.05;
    const auto best = [&](const auto& first, const auto& second) {
      const auto by = [](const auto& figure) {
        return [&figure](const Forecast* a, const Forecast* b) { return figure(*a) < figure(*b); };
      };
      const double limit = same * first(**std::min_element(able.begin(), able.end(), by(first)));
      std::erase_if(able, [&](const Forecast* f) { return first(*f) > limit; });
      if (able.front() == &found_.all.front()) return able.front();
      return *std::min_element(able.begin(), able.end(), by(second));
    };
    const auto seconds = [](const Forecast& f) { return f.seconds.value; };
    const auto error = [](const Forecast& f) { return f.errors[ErrorFigure::range_95].value; };
    return options_.accuracy ? best(seconds, error) : best(error, seconds);
  }

  /// Forecast with the smallest violation of the limits.
  [[nodiscard]] const Forecast& nearest() const {
    return *std::min_element(found_.all.begin(), found_.all.end(),
                             [&](const Forecast& a, const Forecast& b) { return worst(a) < worst(b); });
  }

  [[nodiscard]] int rings(const Forecast& f) const {
    return f.overrides.rings.value_or(survey_.scanner.channels.front().waveform.rings);
  }
  [[nodiscard]] double bin_size(const Forecast& f) const {
    return f.overrides.bin_size.value_or(survey_.scanner.channels.front().waveform.bin_size);
  }

  [[nodiscard]] std::string settings(const Forecast& f) const {
    return text_of(pulsecast::helios::ReceiverOverrides{rings(f), bin_size(f), f.overrides.orders, f.overrides.paths});
  }

  [[nodiscard]] std::string demands() const {
    std::string all = options_.accuracy ? text_of(*options_.accuracy) : "";
    const auto add = [&](const char* name, const std::optional<double>& asked, const Unit& unit) {
      if (asked)
        all += (all.empty() ? "" : ", ") + std::string(name) + ' ' + digits(*asked / unit.size) + ' ' + unit.name;
    };
    add("a run time of", asked_.time, time_unit(asked_.time.value_or(1)));
    add("a memory of", asked_.memory, bytes_unit(asked_.memory.value_or(1)));
    return all;
  }

  void print() const {
    const Forecast& as_is = found_.all.front();
    std::cout << "survey   " << survey_.name << ": " << found_.slots << " pulses, "
              << pulsecast::thread_count(options_.threads) << " threads, points as " << options_.format << "\nsample   "
              << found_.sampled << " pulses; the scene took " << digits(found_.loading) << " s to load\n\n";
    print("current settings: ", as_is);
    std::cout << "\n"
                 "  beamSampleQuality  subrays  binSize_ns    time [s]      points  range error [mm]  intensity error "
                 "[%]  lost [%]  false [%]\n";
    for (const Forecast* f : table()) {
      const auto column = [](int width, const std::string& text) { std::cout << std::setw(width) << text; };
      std::cout << (f == &as_is ? "  *" : "   ");
      column(16, std::to_string(rings(*f)));
      column(9, std::to_string(f->subrays));
      column(12, digits(bin_size(*f) * 1e9));
      column(12, digits(f->seconds.value));
      column(12, digits(f->points.value));
      column(18, digits(f->errors[ErrorFigure::range_95].value * 1e3));
      column(21, digits(f->errors[ErrorFigure::intensity_95].value * 1e2));
      column(10, digits(f->errors[ErrorFigure::lost].value * 1e2));
      column(11, digits(f->errors[ErrorFigure::invented].value * 1e2));
      std::cout << '\n';
    }
    std::cout << "  * current settings\n";
  }

  void print(const char* title, const Forecast& f) const {
    const auto line = [](const char* name, const std::string& text) {
      std::cout << "  " << std::left << std::setw(17) << name << std::right << text << '\n';
    };
    std::cout << title << settings(f) << '\n';
    line("run time", text_of(f.seconds, time_unit(f.seconds.value)));
    line("memory", text_of(f.memory, bytes_unit(f.memory.value)));
    line("points", text_of(f.points, one));
    line("files", text_of(f.bytes, bytes_unit(f.bytes.value)));
    for (const ErrorFigure figure : {ErrorFigure::range_95, ErrorFigure::position_95, ErrorFigure::intensity_95,
                                     ErrorFigure::lost, ErrorFigure::invented})
      line(label_of(figure), text_of(f.errors, figure));
  }

 private:
  /// Greatest ratio of upper estimate to limit; all limits hold up to 1.
  [[nodiscard]] double worst(const Forecast& f) const {
    double most = 0;
    const auto hold = [&](const pulsecast::Estimate& e, const std::optional<double>& asked) {
      if (asked) most = std::max(most, e.high / *asked);
    };
    if (options_.accuracy) most = options_.accuracy->share_of_limits(f.errors).high;
    hold(f.seconds, asked_.time);
    hold(f.memory, asked_.memory);
    return most;
  }

  /// Own settings and the Pareto front of speed and errors; all settings if verbose.
  [[nodiscard]] std::vector<const Forecast*> table() const {
    std::vector<const Forecast*> rows;
    for (const Forecast& f : found_.all) {
      const bool dominated = std::any_of(found_.all.begin(), found_.all.end(), [&](const Forecast& other) {
        const auto no_worse = [&](ErrorFigure figure) { return other.errors[figure].value <= f.errors[figure].value; };
        return other.seconds.value < f.seconds.value && no_worse(ErrorFigure::range_95) &&
               no_worse(ErrorFigure::intensity_95) && no_worse(ErrorFigure::lost) && no_worse(ErrorFigure::invented);
      });
      if (!dominated || options_.verbose || &f == &found_.all.front()) rows.push_back(&f);
    }
    std::sort(rows.begin(), rows.end(),
              [](const Forecast* a, const Forecast* b) { return a->seconds.value < b->seconds.value; });
    return rows;
  }

  const Options& options_;
  const ForecastLimits& asked_;
  const pulsecast::helios::SurveySettings& survey_;
  const Forecasts& found_;
};

}  // namespace

bool forecast(const Options& options, const SurveyFile& file, const Loading& loading, Notes& notes) {
  const auto start = std::chrono::steady_clock::now();
  std::vector<std::string> scene_notes;
  const std::unique_ptr<pulsecast::helios::Simulation> simulation = load(file.survey, loading, scene_notes);
  const double loading_time = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  notes.warn(simulation->warnings());
  notes.require_none();
  if (simulation->compiled().source.size() == 0) {
    std::cerr << "error: no leg is active: a forecast needs a leg with pulses\n";
    return false;
  }
  Options all = options;
  take_columns(all, file.survey, *simulation);
  const Forecasts found = forecasts_of(*simulation, file.survey, all, loading.settings.seed, loading_time);
  const SettingsChooser chooser(options, file.survey, found);
  chooser.print();
  if (options.verbose)
    std::cout << "forecast in "
              << digits(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() - loading_time)
              << " s\n";
  if (!options.accuracy && !options.forecast.time && !options.forecast.memory) return true;

  std::cout << '\n';
  const Forecast* const chosen = chooser.choose();
  if (chosen == nullptr) {
    chooser.print("nearest: ", chooser.nearest());
    std::cerr << "error: no settings meet the limits: " << chooser.demands() << '\n';
    return false;
  }
  chooser.print("best within the limits: ", *chosen);
  if (options.accuracy)
    print(simulation->with_receivers(chosen->overrides)
              ->errors({.seed = loading.settings.seed, .threads = options.threads}),
          options.verbose);
  if (options.forecast.apply) {
    const std::filesystem::path& to = options.forecast.apply_to.empty() ? options.survey : options.forecast.apply_to;
    write_survey_file(options, file, {chooser.rings(*chosen), chooser.bin_size(*chosen)}, to);
    if (!options.quiet) std::cout << "written to " << to.string() << '\n';
  }
  return true;
}
