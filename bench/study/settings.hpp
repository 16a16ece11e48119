// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <pulsecast/detector/analytic_waveform.hpp>
#include <pulsecast/detector/gaussian_fit.hpp>
#include <pulsecast/pulsecast.hpp>

#include "../report.hpp"
#include "errors.hpp"
#include "scenarios.hpp"

/// The knobs, and what is measured of a setting of all of them.
namespace tradeoff {

enum class Width : std::uint8_t { none, moments, fit };

struct Setting {
  std::string knob;   ///< the one that is not at its default; `both` for subrays and bins
  std::string value;  ///< where it stands
  Pattern footprint = lattice(19);
  double bin = 0.25e-9;  ///< 0 for the analytic detector [s]
  Width width = Width::none;
  Map map{};
  std::size_t stride = 1;  ///< every which pulse is sent
  bool comparable = true;  ///< does the whole work on the whole scene: may be on the front
  bool is_default = false;
};

[[nodiscard]] inline std::string text_of(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", value);
  return text;
}

[[nodiscard]] inline std::string bin_name(double bin) { return bin == 0 ? "analytic" : text_of(bin * 1e9) + " ns"; }

/// Every setting of a scenario that is measured, the default first.
[[nodiscard]] inline std::vector<Setting> settings_for(const Scenario& scenario) {
  std::vector<Setting> all{{.knob = "default", .value = "", .map = scenario.map, .is_default = true}};
  all[0].value =
      all[0].footprint.kind() + " " + std::to_string(all[0].footprint.size()) + " (" + bin_name(all[0].bin) + ")";
  const auto add = [&](const std::string& knob, const std::string& value, auto change) {
    Setting setting = all[0];
    setting.knob = knob;
    setting.value = value;
    setting.is_default = false;
    change(setting);
    all.push_back(std::move(setting));
  };
  std::vector<Pattern> patterns;
  for (std::size_t circles = 1; circles <= 10; ++circles) patterns.push_back(rings(circles));
  const std::size_t as_many[]{1,  3,  4,  7,  9,  13,  18,
                              19, 31, 37, 62, 93, 130, 279};  // as in rings, and half as many as in the first ones
  for (const std::size_t subrays : as_many)
    for (const Pattern& pattern : {sunflower(subrays), lattice(subrays)}) patterns.push_back(pattern);
  for (const Pattern& pattern : patterns)
    add("subrays", pattern.kind() + " " + std::to_string(pattern.size()), [&](Setting& s) { s.footprint = pattern; });
  if (scenario.turned)
    for (const Pattern& pattern : {rings(2), rings(3), rings(4), sunflower(9), sunflower(13), sunflower(19), lattice(9),
                                   lattice(13), lattice(19)})
      add("turned", pattern.kind() + " " + std::to_string(pattern.size()), [&](Setting& s) {
        s.footprint = pattern.turned(30_deg);
        s.comparable = false;
      });

  add("precision", "double", [&](Setting& s) { s.map = scenario.exact; });
  for (const double bin : {0.05e-9, 0.1e-9, 0.5e-9, 1e-9, 2e-9, 0.0})
    add("bins", bin_name(bin), [&](Setting& s) { s.bin = bin; });
  for (const std::size_t subrays : {1U, 4U, 7U, 37U, 62U})
    for (const double bin : {0.1e-9, 0.5e-9, 1e-9, 0.0})
      add("both", "lattice " + std::to_string(subrays) + " (" + bin_name(bin) + ")", [&](Setting& s) {
        s.footprint = lattice(subrays);
        s.bin = bin;
      });
  for (const double bin : {0.25e-9, 0.0})
    for (const Width width : {Width::moments, Width::fit})
      add("width", std::string(width == Width::fit ? "fit" : "moments") + " (" + bin_name(bin) + ")", [&](Setting& s) {
        s.width = width;
        s.bin = bin;
        s.comparable = false;
      });
  for (const Form& form : scenario.forms)
    add("form", form.name, [&](Setting& s) {
      s.map = form.map;
      s.comparable = false;
    });
  for (const std::size_t stride : {2U, 4U, 8U, 16U})
    add("preview", "every " + std::to_string(stride), [&](Setting& s) {
      s.stride = stride;
      s.comparable = false;
    });
  return all;
}

/// Calls a function with the detector of a setting.
template <class Function>
auto with_detector(double bin, Width width, double threshold, Function function) {
  // by true ranges, and with the divisor of the peer: the study measures the cost of sampling, not the effects of
  // receivers
  WaveformSettings settings{.threshold = threshold, .timing = EchoTiming::true_range, .shape_divisor = 3.5};
  if (bin > 0) settings.sample_interval = bin;
  const auto with_width = [&](auto measure) {
    using Measure = decltype(measure);
    return bin > 0 ? function(FullWaveform<Measure>(settings)) : function(AnalyticWaveform<Measure>(settings));
  };
  switch (width) {
    case Width::moments:
      return with_width(MomentWidth{});
    case Width::fit:
      return with_width(GaussianFit{});
    default:
      return with_width(NoWidth{});
  }
}

/// Results of a setting. Widths are always measured, as they do not change the echoes.
[[nodiscard]] inline Results results_of(const Scenario& scenario, const Setting& setting) {
  const Width width = setting.width == Width::fit ? Width::fit : Width::moments;
  return std::visit(
      [&](const auto& map) {
        return with_detector(setting.bin, width, scenario.threshold, [&](const auto& detector) {
          return results_of(Survey(scenario.pulses, WithSubrayRecord(setting.footprint), *map, Receiver{}, detector, 1),
                            setting.footprint);
        });
      },
      setting.map);
}

/// A go of a setting through runs of the pulses of a scenario, fewer where one takes long; and how many pulses that
/// are.
struct Work {
  std::function<void()> go;
  std::size_t pulses;
};
[[nodiscard]] inline Work work_of(const Scenario& scenario, const Setting& setting) {
  const std::size_t every = 4 * (1 + setting.footprint.size() / 40);
  std::size_t pulses = 0;
  for (std::size_t run = 0; run < scenario.pulses.size(); run += every * run_length)
    pulses += std::min(run_length, scenario.pulses.size() - run);
  return {std::visit(
              [&](const auto& map) {
                return with_detector(setting.bin, setting.width, scenario.threshold, [&](const auto& detector) {
                  const Survey survey(scenario.pulses, setting.footprint, *map, Receiver{}, detector, 1);
                  return std::function<void()>([survey, every, map, workspace = survey.workspace()]() mutable {
                    std::size_t echoes = 0;
                    for (PulseIndex run = 0; run < survey.size(); run += every * run_length)
                      for (PulseIndex i = run; i < std::min(run + run_length, survey.size()); ++i)
                        echoes += survey(i, workspace).echoes.size();
                    bench::keep(echoes);
                  });
                });
              },
              setting.map),
          pulses};
}

[[nodiscard]] inline std::size_t memory_of(const Map& map) {
  return std::visit([](const auto& scene) { return scene->memory(); }, map);
}

}  // namespace tradeoff
