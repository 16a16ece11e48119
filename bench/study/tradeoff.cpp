// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Errors and times of settings: the library's defaults, each knob turned, and XML surveys, in scenes with a truth of
// their own, and in ones with a reference. Prints the tables of docs/tables/tradeoff.md, which docs/tradeoff.md
// explains; `bench/study/tradeoff.sh` renews it. A file on the command line takes the scores by numbers of subrays as
// CSV.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "../report.hpp"
#include "places.hpp"
#include "settings.hpp"

using namespace tradeoff;

namespace {

constexpr std::size_t dense = 100'000;  // points of the quadrature

/// A setting in a scene, and what was found.
struct Row {
  Setting setting;
  Clusters clusters{};
  std::vector<double> sizes{};   ///< of the errors of ranges [m]
  std::vector<double> scores{};  ///< of all clusters, and of each draw [m]
  bench::Times times{};          ///< round by round; empty if not measured [s]
};

/// A scene with its settings, as claims need them.
struct Measured {
  std::string name;
  bool held_out;
  double resolution;
  std::vector<Row> rows;

  [[nodiscard]] const Row* find(const std::string& setting) const {
    const auto at = std::find_if(rows.begin(), rows.end(), [&](const Row& r) { return r.setting.name == setting; });
    return at == rows.end() ? nullptr : &*at;
  }
};

Row compared(const Setting& setting, const Results& truth, const Results& found, double resolution) {
  Row row{setting};
  for (std::size_t c = 0; c < truth.size(); ++c) {
    row.clusters.emplace_back();
    for (std::size_t i = 0; i < truth[c].size(); ++i)
      row.clusters.back().add(truth[c][i], found[c][i], resolution, row.sizes);
  }
  return row;
}

/// Ratios of two scores, draw by draw. A millionth of the resolution is added: two settings without errors are alike.
std::vector<double> ratios(const Row& a, const Row& b, double resolution) {
  std::vector<double> all;
  for (std::size_t d = 0; d < a.scores.size(); ++d)
    all.push_back((a.scores[d] + 1e-6 * resolution) / (b.scores[d] + 1e-6 * resolution));
  return all;
}
std::vector<double> time_ratios(const Row& a, const Row& b) {
  std::vector<double> all;
  for (std::size_t r = 0; r < std::min(a.times.size(), b.times.size()); ++r) all.push_back(a.times[r] / b.times[r]);
  return all;
}

/// A figure to three digits.
std::string rounded(double x) {
  if (std::isnan(x)) return "";
  const double size = std::fabs(x);
  char text[64];
  std::snprintf(text, sizeof text, "%.*f",
                size >= 100 || size < 5e-5 ? 0
                : size >= 10               ? 1
                : size >= 1                ? 2
                : size >= 0.01             ? 3
                                           : 4,
                x);
  return text;
}
std::string shown(const Interval& i, double unit = 1) {
  if (std::isnan(i.middle)) return "";
  return rounded(unit * i.middle) + " [" + rounded(unit * i.low) + ", " + rounded(unit * i.high) + "]";
}
std::string shown_median(const std::vector<double>& repeated) {
  return repeated.empty() ? "" : shown(median_of(repeated));
}

void print_heading(const std::string& title, const std::vector<std::string>& columns) {
  std::printf("\n## %s\n\n|", title.c_str());
  for (const auto& column : columns) std::printf(" %s |", column.c_str());
  std::printf("\n|");
  for (std::size_t k = 0; k < columns.size(); ++k) std::printf("---|");
  std::printf("\n");
}

void print(const Row& row, const Row& standard, double resolution) {
  Sums all;
  for (const Sums& sums : row.clusters) all.add(sums, 1);
  std::printf(
      "| %s | %s | %s | %s | %s | %s | %s | %s | %s |\n", row.setting.name.c_str(), rounded(1e3 * all.range()).c_str(),
      rounded(1e3 * percentile(row.sizes, 0.95)).c_str(), rounded(100 * all.lost / all.echoes).c_str(),
      rounded(100 * all.invented / all.echoes).c_str(), rounded(all.intensity()).c_str(),
      shown(interval_of(row.scores), 1e3).c_str(),
      &row == &standard || row.clusters.empty() ? "" : shown(interval_of(ratios(row, standard, resolution))).c_str(),
      &row == &standard ? "" : shown_median(time_ratios(row, standard)).c_str());
  std::fflush(stdout);
}

Measured measure(const bench::Report& report, const Scenario& scenario, std::uint32_t number) {
  const double resolution = scenario.instrument.resolution();
  const Bootstrap bootstrap(scenario.clusters.size(), number);
  const auto scored = [&](Row row) {
    row.scores = bootstrap(row.clusters, [](const Sums& s) { return s.score(); });
    return row;
  };
  std::array<Results, 2> truth, other;
  if (scenario.has_truth()) {
    truth = truth_of(scenario, dense);
    other = truth_of(scenario, dense / 4);
  } else {
    truth = {results_of(scenario, reference(false, sunflower(2001))),
             results_of(scenario, reference(true, sunflower(2001)))};
    other[0] = results_of(scenario, reference(false, lattice(1999)));
  }
  Measured found{scenario.name, scenario.held_out, resolution, {}};
  std::vector<std::function<void()>> works;
  for (const Setting& setting : all_settings()) {
    if (setting.exact && !scenario.clusters.front().exact) continue;
    found.rows.push_back(scored(compared(setting, truth[setting.xml], results_of(scenario, setting), resolution)));
    works.push_back(work_of(scenario, setting));
  }
  const std::vector<bench::Times> times = report.by_turns(works);
  for (std::size_t i = 0; i < times.size(); ++i) found.rows[i].times = times[i];

  std::size_t echoes = 0, pulses = 0;
  for (const auto& cluster : truth[0]) {
    pulses += cluster.size();
    for (const Points& points : cluster) echoes += points.size();
  }
  print_heading("`" + scenario.name + "`: " + scenario.title,
                {"setting", "range: rms, mm", "95 % within, mm", "lost, %", "invented, %", "intensity, %",
                 "score, mm an echo", "score by default", "time by default"});
  const Row& standard = found.rows.front();
  print(
      scored(compared({scenario.has_truth() ? "*truth of a quarter of the points*" : "*reference of another pattern*"},
                      truth[0], other[0], resolution)),
      standard, resolution);
  print(scored(compared({"*definition of XML surveys*"}, truth[0], truth[1], resolution)), standard, resolution);
  for (const Row& row : found.rows) print(row, standard, resolution);
  std::printf("\n%zu pulses with %zu echoes by the %s; by default %s us a pulse; for %s.\n", pulses, echoes,
              scenario.has_truth() ? "truth" : "reference",
              rounded(1e6 * bench::median(standard.times) / static_cast<double>(timed_pulses(scenario))).c_str(),
              scenario.held_out ? "showing" : "choosing");
  return found;
}

/// A setting by another one, over the scenes of one half: the geometric mean of the ratios of their scores.
Interval pooled(const std::vector<Measured>& scenes, bool held_out, const std::string& a, const std::string& b) {
  std::vector<double> logs(Bootstrap::draws + 1);
  double number = 0;
  for (const Measured& scene : scenes) {
    const Row *one = scene.find(a), *other = scene.find(b);
    if (scene.held_out != held_out || !one || !other) continue;
    const std::vector<double> all = ratios(*one, *other, scene.resolution);
    for (std::size_t d = 0; d < all.size(); ++d) logs[d] += std::log(all[d]);
    number += 1;
  }
  for (double& log : logs) log = std::exp(log / number);
  return interval_of(logs);
}
std::vector<double> pooled_times(const std::vector<Measured>& scenes, const std::string& a, const std::string& b) {
  std::vector<double> logs;
  double number = 0;
  for (const Measured& scene : scenes) {
    const Row *one = scene.find(a), *other = scene.find(b);
    if (!one || !other) continue;
    const std::vector<double> all = time_ratios(*one, *other);
    logs.resize(all.size());
    for (std::size_t r = 0; r < all.size(); ++r) logs[r] += std::log(all[r]);
    number += 1;
  }
  for (double& log : logs) log = std::exp(log / number);
  return logs;
}

void print_claims(const std::vector<Measured>& scenes) {
  print_heading("Claims", {"setting", "by", "score: scenes for choosing", "held-out scenes", "claim",
                           "scenes better, worse", "time: all scenes"});
  const std::pair<std::string, std::string> pairs[]{{"lattice 19", "rings 19"},
                                                    {"lattice 19", "sunflower 19"},
                                                    {"lattice 7", "rings 7"},
                                                    {"lattice 9", "rings 19"},
                                                    {"rings 37", "rings 19"},
                                                    {"rings 130", "rings 37"},
                                                    {"lattice 37", "rings 37"},
                                                    {"lattice 19", "rings 37"},
                                                    {"lattice 127", "rings 130"},
                                                    {"lattice 19, turned", "lattice 19"},
                                                    {"lattice 3", "lattice 1"},
                                                    {"lattice 7", "lattice 1"},
                                                    {"lattice 19", "lattice 7"},
                                                    {"lattice 37", "lattice 19"},
                                                    {"lattice 127", "lattice 37"},
                                                    {"lattice 1", "single ray, first hit"},
                                                    {"analytic, lattice 7", "lattice 7"},
                                                    {"analytic, lattice 19", "lattice 19"},
                                                    {"analytic, lattice 37", "lattice 37"},
                                                    {"analytic, lattice 127", "lattice 127"},
                                                    {"bins of 1/40 pulse", "lattice 19"},
                                                    {"lattice 19", "bins of 1/8 pulse"},
                                                    {"bins of 1/8 pulse", "bins of 1/4 pulse"},
                                                    {"bins of 1/4 pulse", "bins of 1/2 pulse"},
                                                    {"lattice 19", "without spread"},
                                                    {"lattice 19", "prominence of the threshold"},
                                                    {"lattice 19", "XML: rings 19, mean range"},
                                                    {"receiver: noise, prominence", "receiver: and noise"},
                                                    {"receiver: and noise", "receiver: noise, 8 times the bandwidth"},
                                                    {"lattice 19", "traversal in double"}};
  for (const auto& [a, b] : pairs) {
    const Interval chosen = pooled(scenes, false, a, b), shown_on = pooled(scenes, true, a, b);
    int better = 0, worse = 0;
    for (const Measured& scene : scenes)
      if (const Row* one = scene.find(a), *other = scene.find(b); one && other) {
        const Interval here = interval_of(ratios(*one, *other, scene.resolution));
        better += here.less() ? 1 : 0;
        worse += here.more() ? 1 : 0;
      }
    const char* claim = chosen.less() && shown_on.less()   ? "better"
                        : chosen.more() && shown_on.more() ? "worse"
                                                           : "none";
    std::printf("| %s | %s | %s | %s | %s | %d, %d | %s |\n", a.c_str(), b.c_str(), shown(chosen).c_str(),
                shown(shown_on).c_str(), claim, better, worse, shown_median(pooled_times(scenes, a, b)).c_str());
  }
}

/// The steps at other places and sizes, by the analytic detector: the same echoes, to rounding.
void print_extremes() {
  print_heading("Extremes: `step` at other places and of other sizes",
                {"scene", "traversal", "lost, invented, %", "score, 1/1000 of the resolution",
                 "echoes more or less than here", "largest difference from here, nm of 60 cm"});
  const Frame frames[]{{}, {.place = {512'000, 5'403'000, 300}}, {.place = {1e7, 1e7, 1e7}}, {.scale = 1e-6}, {}};
  const char* names[]{"1,000 m away, at the origin", "at UTM coordinates", "17,000 km from the origin",
                      "1 mm away: steps of 50 to 600 nm, pulses of 4 fs", "400 km away"};
  Results first;
  for (std::size_t k = 0; k < std::size(frames); ++k) {
    Scenario scenario = steps("step", frames[k], k == 4 ? 400e3 : 1000);
    const double resolution = scenario.instrument.resolution(), away = k == 4 ? 400e3 : 1000 * frames[k].scale;
    const Bootstrap bootstrap(scenario.clusters.size(), 0);
    const Results truth = truth_of(scenario, dense / 4)[0];
    for (Cluster& cluster : scenario.clusters) cluster.exact = in_double(cluster.map);
    for (const bool exact : {false, true}) {
      const Setting setting{.name = names[k], .detector = DetectorKind::analytic, .exact = exact};
      const Results found = results_of(scenario, setting);
      if (first.empty()) first = found;
      const Row row = compared(setting, truth, found, resolution);
      Sums all;
      for (const Sums& sums : row.clusters) all.add(sums, 1);
      double largest = 0;
      std::size_t others = 0;
      for (std::size_t c = 0; c < found.size(); ++c)
        for (std::size_t i = 0; i < found[c].size(); ++i) {
          const Points &here = found[c][i], &there = first[c][i];
          others += here.size() != there.size() ? 1 : 0;
          for (std::size_t e = 0; e < here.size() && here.size() == there.size(); ++e)
            largest = std::fmax(largest, std::fabs((here[e].range - away) / frames[k].scale - (there[e].range - 1000)));
        }
      std::printf("| %s | %s | %s, %s | %s | %zu | %s |\n", names[k], exact ? "`double`" : "`float`",
                  rounded(100 * all.lost / all.echoes).c_str(), rounded(100 * all.invented / all.echoes).c_str(),
                  shown(interval_of(bootstrap(row.clusters, [](const Sums& s) { return s.score(); })), 1e3 / resolution)
                      .c_str(),
                  others, rounded(1e9 * largest).c_str());
    }
  }
}

}  // namespace

int main(int count, char** words) {
  bench::Report report("tradeoff", count, words);
  auto makers = true_scenes();
  for (auto& maker : reference_scenes()) makers.push_back(std::move(maker));
  std::vector<Measured> scenes;
  const double start = bench::wall_seconds();
  for (std::uint32_t number = 0; number < makers.size(); ++number) {
    if (!report.wanted(makers[number].first)) continue;
    std::fprintf(stderr, "%4.0f s: %s\n", bench::wall_seconds() - start, makers[number].first.c_str());
    scenes.push_back(measure(report, makers[number].second(), number));
  }
  print_claims(scenes);
  if (report.wanted("extremes")) print_extremes();
  std::fprintf(stderr, "%4.0f s: done\n", bench::wall_seconds() - start);
  if (report.files().empty()) return 0;
  std::FILE* csv = std::fopen(report.files()[0].c_str(), "w");
  if (csv == nullptr) return 1;
  for (const Measured& scene : scenes)
    for (const Row& row : scene.rows)
      if (const Interval s = interval_of(row.scores);
          row.setting.name == row.setting.footprint.kind() + " " + std::to_string(row.setting.footprint.size()))
        std::fprintf(csv, "%s,%s,%zu,%.6g,%.6g,%.6g\n", scene.name.c_str(), row.setting.footprint.kind().c_str(),
                     row.setting.footprint.size(), 1e3 * s.middle, 1e3 * s.low, 1e3 * s.high);
  std::fclose(csv);
}
