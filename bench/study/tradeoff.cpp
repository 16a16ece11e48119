// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Cost and errors of each setting: time, memory, and errors against a reference of 2,001 subrays, double precision and
// the analytic detector, on the same pulses of six scenarios. One knob at a time from the default, and subrays by bins.
// Rows are named scenario/knob/value. Errors have intervals of 95 %, by bootstrap over runs of pulses.
// `bench/study/tradeoff.sh` runs it, draws docs/pictures/tradeoff_*.svg, and writes docs/tables/tradeoff.md.
// Files on the command line: where a CSV file of all settings, and one of footprints on edges and wires, are left.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <pulsecast/pulsecast.hpp>

#include "../report.hpp"
#include "errors.hpp"
#include "precision.hpp"
#include "pulses.hpp"
#include "quadrature.hpp"
#include "scenarios.hpp"
#include "settings.hpp"

using namespace tradeoff;

namespace {

constexpr std::size_t pulse_count = 16'384;
constexpr double mebibyte = 1 << 20;

/// A setting, and what it costs and buys.
struct Point {
  Setting setting;
  double seconds = 0;  ///< of the thread, for a pulse of the survey
  double memory = 0;   ///< of the scene [MiB]
  Errors errors{};
  Intervals intervals{};           ///< of the errors that are drawn
  std::array<bool, 3> on_front{};  ///< by range, by echoes missed and invented, by intensity
};

/// Marks the points that no other one outdoes in time without being outdone in the error.
void find_fronts(std::vector<Point>& points) {
  for (std::size_t by = 0; by < 3; ++by)
    for (Point& point : points) {
      const auto outdoes = [&](const Point& other) {
        const double error = point.errors.drawn()[by], theirs = other.errors.drawn()[by];
        return other.setting.comparable && other.seconds <= point.seconds && theirs <= error &&
               (other.seconds < point.seconds || theirs < error);
      };
      point.on_front[by] = point.setting.comparable && std::none_of(points.begin(), points.end(), outdoes);
    }
}

std::vector<Point> measure(const bench::Report& report, const Scenario& scenario, const Bootstrap& bootstrap) {
  Setting reference{.knob = "reference", .value = "", .footprint = sunflower(2001), .bin = 0, .map = scenario.exact};
  const Results with_moments = results_of(scenario, reference);
  reference.width = Width::fit;
  const Results with_fit = results_of(scenario, reference);
  std::fprintf(stderr, "  %zu pulses, %zu echoes in the reference\n", with_moments.pulses(),
               with_moments.echoes.size());
  const auto canopy_of = [&](const Results& results, std::size_t stride) {
    return scenario.ground ? canopy(results, scenario.pulses, scenario.ground, stride) : Canopy{};
  };
  const Canopy true_canopy = canopy_of(with_moments, 1);

  std::vector<Point> points;
  std::vector<std::function<void()>> works;
  std::vector<std::size_t> pulses;
  for (const Setting& setting : settings_for(scenario)) {
    Point point{.setting = setting, .memory = static_cast<double>(memory_of(setting.map)) / mebibyte};
    const Results found = results_of(scenario, setting);
    if (setting.stride == 1) {
      point.errors = compare(setting.width == Width::fit ? with_fit : with_moments, found, scenario.gate);
      point.intervals = bootstrap.of(point.errors.blocks);
    } else {
      point.errors.echoes = forecast_error(found, setting.stride);
    }
    compare(true_canopy, canopy_of(found, setting.stride), point.errors);
    if (setting.stride == 1) {
      Work work = work_of(scenario, setting);
      works.push_back(std::move(work.go));
      pulses.push_back(work.pulses);
    }
    points.push_back(std::move(point));
  }
  std::fprintf(stderr, "  %zu settings compared; timing %zu by turns\n", points.size(), works.size());
  const std::vector<bench::Times> times = report.by_turns(works);
  for (std::size_t i = 0; i < times.size(); ++i)
    points[i].seconds = bench::median(times[i]) / static_cast<double>(pulses[i]);
  for (Point& point : points)
    if (point.setting.stride > 1) point.seconds = points[0].seconds / static_cast<double>(point.setting.stride);
  find_fronts(points);
  return points;
}

void write_csv(std::FILE* out, const Scenario& scenario, const std::vector<Point>& points) {
  for (const Point& p : points) {
    const Setting& s = p.setting;
    const Errors& e = p.errors;
    std::fprintf(out, "%s,%s,%s,%s,%zu,%s,%d,", scenario.name.c_str(), s.knob.c_str(), s.value.c_str(),
                 s.footprint.kind().c_str(), s.footprint.size(), bin_name(s.bin).c_str(), s.comparable ? 1 : 0);
    const double figures[]{1e9 * p.seconds,      1 / p.seconds,         p.memory,         1e3 * e.range_bias,
                           1e3 * e.range_spread, 1e3 * e.range_rms,     1e3 * e.range_95, e.missed,
                           e.invented,           e.missed + e.invented, e.intensity_bias, e.intensity,
                           1e12 * e.width_bias,  1e12 * e.width,        e.echoes,         e.gap_fraction,
                           e.height_50,          e.height_95,           e.height_99};
    for (const double figure : figures) std::fprintf(out, "%.5g,", figure);
    std::fprintf(out, "%d,%d,%d", p.on_front[0] ? 1 : 0, p.on_front[1] ? 1 : 0, p.on_front[2] ? 1 : 0);
    for (std::size_t k = 0; k < 3; ++k) {
      const double unit = k == 0 ? 1e3 : 1;
      std::fprintf(out, ",%.5g,%.5g", unit * p.intervals[k].low, unit * p.intervals[k].high);
    }
    std::fprintf(out, "\n");
  }
  std::fflush(out);
}

void add_rows(bench::Report& report, const Scenario& scenario, const std::vector<Point>& points) {
  for (const Point& p : points) {
    const Errors& e = p.errors;
    report.row(scenario.name + "/" + p.setting.knob + "/" + p.setting.value, {{"ns/pulse", 1e9 * p.seconds},
                                                                              {"MiB", p.memory},
                                                                              {"range bias, mm", 1e3 * e.range_bias},
                                                                              {"spread, mm", 1e3 * e.range_spread},
                                                                              {"missed, %", e.missed},
                                                                              {"invented, %", e.invented},
                                                                              {"intensity, %", e.intensity},
                                                                              {"width, ps", 1e12 * e.width},
                                                                              {"echoes, %", e.echoes},
                                                                              {"gap fraction, %", e.gap_fraction},
                                                                              {"height at 95 %, m", e.height_95}});
  }
}

/// Settings by pairs, each with its errors by those of the other. An interval with 1 inside is no ranking.
void rank(bench::Report& report, const Scenario& scenario, const std::vector<Point>& points,
          const Bootstrap& bootstrap) {
  const auto named = [&](const std::string& name) {
    return std::find_if(points.begin(), points.end(),
                        [&](const Point& p) { return p.setting.knob + " " + p.setting.value == name; });
  };
  const std::string standard = "default " + points[0].setting.value;
  const std::pair<std::string, std::string> pairs[]{{standard, "subrays rings 7"},
                                                    {standard, "subrays rings 19"},
                                                    {standard, "subrays rings 279"},
                                                    {standard, "subrays sunflower 19"},
                                                    {standard, "subrays lattice 7"},
                                                    {standard, "subrays lattice 37"},
                                                    {standard, "bins 0.1 ns"},
                                                    {standard, "bins 0.5 ns"},
                                                    {standard, "bins analytic"},
                                                    {"subrays lattice 7", "subrays rings 7"},
                                                    {"subrays lattice 4", "subrays rings 7"},
                                                    {"subrays lattice 9", "subrays rings 19"},
                                                    {"subrays lattice 18", "subrays rings 37"},
                                                    {"subrays lattice 31", "subrays rings 62"},
                                                    {"turned lattice 9", "turned rings 19"},
                                                    {"turned lattice 13", "turned rings 19"},
                                                    {"turned lattice 19", "turned rings 37"}};
  for (const auto& [one, other] : pairs) {
    const auto a = named(one), b = named(other);
    if (a == points.end() || b == points.end()) continue;
    const Intervals ratio = bootstrap.of_ratio(a->errors.blocks, b->errors.blocks);
    const auto short_name = [&](const Point& p) {
      return p.setting.knob == "subrays" ? p.setting.value : p.setting.knob + " " + p.setting.value;
    };
    report.row(scenario.name + ": " + short_name(*a) + " by " + short_name(*b), {{"range, from", ratio[0].low},
                                                                                 {"range, to", ratio[0].high},
                                                                                 {"echoes wrong, from", ratio[1].low},
                                                                                 {"echoes wrong, to", ratio[1].high},
                                                                                 {"intensity, from", ratio[2].low},
                                                                                 {"intensity, to", ratio[2].high}});
  }
}

std::FILE* opened(const std::string& path) {
  std::FILE* file = std::fopen(path.c_str(), "w");
  if (file == nullptr) {
    std::fprintf(stderr, "tradeoff: cannot write %s\n", path.c_str());
    std::exit(1);
  }
  return file;
}

}  // namespace

int main(int count, char** words) {
  bench::Report report("tradeoff", count, words);
  const auto& files = report.files();
  std::FILE* csv = opened(files.empty() ? "/dev/null" : files[0]);
  std::fprintf(csv,
               "scenario,knob,value,footprint,subrays,detector,comparable,ns_per_pulse,pulses_per_second,scene_mib,"
               "range_bias_mm,"
               "range_spread_mm,range_rms_mm,range_95_mm,missed_percent,invented_percent,echoes_wrong_percent,"
               "intensity_bias_percent,"
               "intensity_percent,width_bias_ps,width_ps,echoes_percent,gap_fraction_percent,height_50_m,height_95_m,"
               "height_99_m,"
               "front_range,front_echoes,front_intensity,range_rms_low_mm,range_rms_high_mm,echoes_wrong_low_percent,"
               "echoes_wrong_high_percent,intensity_low_percent,intensity_high_percent\n");
  if (files.size() > 1) {
    std::FILE* edges = opened(files[1]);
    write_quadrature(edges);
    std::fclose(edges);
  }
  const double start = bench::wall_seconds();
  const Bootstrap bootstrap(pulse_count / run_length);
  const std::pair<const char*, Scenario (*)(std::size_t)> scenarios[]{{"terrain", terrain},
                                                                      {"wood_tripod", wood_from_a_tripod},
                                                                      {"wood_drone", wood_from_a_drone},
                                                                      {"street", street_from_a_car},
                                                                      {"facade", facade},
                                                                      {"step", step}};
  for (const auto& [name, make] : scenarios) {
    if (!report.wanted(name)) continue;
    std::fprintf(stderr, "%4.0f s: %s\n", bench::wall_seconds() - start, name);
    const Scenario scenario = make(pulse_count);
    report.heading(scenario.title);
    const std::vector<Point> points = measure(report, scenario, bootstrap);
    add_rows(report, scenario, points);
    write_csv(csv, scenario, points);
    report.heading("Errors of a setting by those of another, " + scenario.name + ": intervals of 95 %");
    rank(report, scenario, points, bootstrap);
  }
  std::fprintf(stderr, "%4.0f s: float against double\n", bench::wall_seconds() - start);
  measure_precision(report);
  std::fprintf(stderr, "%4.0f s: done\n", bench::wall_seconds() - start);
  std::fclose(csv);
}
