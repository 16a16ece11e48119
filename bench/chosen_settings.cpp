// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Does what `choose_settings` promises hold, and is its choice cheap? In each scene all settings simulate all slots of
// a survey once; then 100 choices by samples of their own are compared with what all slots say: the shares of choices
// that reach all limits and that exceed one by a quarter, and the time of the chosen settings by that of the cheapest
// that reach the limits, the median and the greatest.
//
//     bench_chosen_settings [CHOICES [SCENE]]

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <pulsecast/accuracy.hpp>
#include <pulsecast/detector/analytic_waveform.hpp>

#include "../examples/street.hpp"
#include "error_scenes.hpp"

namespace {

using namespace pulsecast;
using namespace pulsecast::literals;

constexpr PulseIndex in_line = 256, slots = 256 * in_line;
constexpr double analytic = 0;  // in place of the size of a bin

/// Results of all slots of a survey, as a survey.
struct Recorded {
  struct Workspace {
    std::vector<Echo> echoes;
  };
  std::shared_ptr<const Sample> all;
  std::size_t rays = 1;

  Workspace workspace() const { return {}; }
  PulseIndex size() const noexcept { return slots; }
  std::size_t subrays() const noexcept { return rays; }
  std::size_t recorded_subrays() const noexcept { return 0; }
  double sample_interval() const noexcept { return 0; }
  Outcome operator()(PulseIndex i, Workspace& w) const noexcept {
    Outcome outcome;
    outcome.shot = all->shots[i];
    const std::span<const Echo> echoes = all->batch().echoes_of(outcome.shot);
    w.echoes.assign(echoes.begin(), echoes.end());
    outcome.echoes = w.echoes;
    return outcome;
  }
};
static_assert(PulseSurvey<Recorded>);

/// Settings, and all that they find.
struct Candidate {
  std::vector<double> values;
  Recorded survey;
  double seconds = 0;
  EchoErrors truth{};
};

using Make = std::function<AnySurvey(std::size_t subrays, double bin)>;

template <class Target>
Make surveys_of(std::shared_ptr<const Target> target, const stated::Lines& lines) {
  return [target, lines](std::size_t subrays, double bin) {
    const auto with = [&](auto detector) {
      return AnySurvey(Survey(lines, LatticeFootprint(subrays), *target, Receiver{}, std::move(detector), 1), target);
    };
    return bin == analytic ? with(AnalyticWaveform<>()) : with(FullWaveform<>({.sample_interval = bin}));
  };
}

struct Place {
  std::string name;
  Make survey;
  std::array<Accuracy, 2> asked{Accuracy{.range = 5_mm}, Accuracy{.range = 2_cm, .intensity = 0.05, .echoes = 0.02}};
};

stated::Lines lines_of(double spacing, bool from_above) {
  stated::Lines lines{.in_line = in_line, .slots = slots};
  lines.laser = {.wavelength = 1064_nm, .peak_power = 1000_W, .pulse_length = 4_ns, .divergence = 1e-3};
  lines.across = lines.up = spacing;
  if (!from_above) return lines;
  lines.from = {0, -0.5 * 100 * spacing * in_line, 100};
  lines.base = rotation_about(axis::right, -90_deg);
  lines.up = 0;
  lines.step = {0, 100 * spacing / in_line, 0};
  return lines;
}

std::vector<Place> places() {
  std::vector<Place> all;
  for (const stated::ErrorScene& scene : stated::error_scenes())
    if (scene.name == "fence" || scene.name == "facade" || scene.name == "wood" || scene.name == "hills from above")
      all.push_back({scene.name == "hills from above" ? "terrain" : scene.name,
                     surveys_of(stated::Surveyed(scene).map(), lines_of(1.1e-3, scene.from_above))});
  stated::Lines lines = lines_of(3e-3, false);
  // edges of a street, and leaves, make faint echoes that a hundred subrays miss
  for (Place& place : all)
    if (place.name == "wood")
      place.asked = {Accuracy{.range = 1_cm, .echoes = 0.12}, Accuracy{.range = 2_cm, .intensity = 0.8, .echoes = 0.2}};
  lines.from = street::on({2, -30}) + Vec3{0, 0, 2};
  all.push_back({"street",
                 surveys_of(std::make_shared<const street::Scene>(street::scene(1)), lines),
                 {Accuracy{.range = 5_mm, .echoes = 0.04}, Accuracy{.range = 2_cm, .intensity = 0.1, .echoes = 0.05}}});
  return all;
}

/// Simulates all slots in blocks, by all threads.
Candidate simulated(const Make& make, double subrays, double bin) {
  const AnySurvey survey = make(static_cast<std::size_t>(subrays), bin);
  std::vector<SampleBlock> blocks;
  for (PulseIndex i = 0; i < slots; i += in_line) blocks.push_back({i, i, i + in_line});
  const auto all = std::make_shared<Sample>();
  for (const Sample& block : sample(survey, blocks)) {
    all->seconds += block.seconds;
    for (Shot shot : block.shots) {
      shot.first_echo += static_cast<std::uint32_t>(all->echoes.size());
      all->shots.push_back(shot);
    }
    all->echoes.insert(all->echoes.end(), block.echoes.begin(), block.echoes.end());
  }
  return {{subrays, bin}, {all, survey.subrays()}, all->seconds};
}

struct Tally {
  std::size_t choices = 0, reached = 0, kept = 0, exceeded = 0;
  std::vector<double> times{};  // of reached choices by that of the cheapest
  double slots = 0;

  void print(const char* scene, const Accuracy& asked, const Candidate& cheapest) {
    std::sort(times.begin(), times.end());
    std::printf("%-8s %4g mm %4g %% %5g %%  %3zu  %3zu  %3zu  %5.2f %5.2f  %6.0f   %3g subrays, bin %g ns\n", scene,
                1e3 * asked.range, 1e2 * asked.echoes, 1e2 * asked.intensity, reached, kept, exceeded,
                times.empty() ? 0 : times[times.size() / 2], times.empty() ? 0 : times.back(),
                slots / static_cast<double>(choices), cheapest.values[0], cheapest.values[1] * 1e9);
    std::fflush(stdout);
  }
};

void measure(const Place& place, std::size_t choices) {
  const std::vector<double> subrays{1,  2,  4,  5,  6,  7,  9,  11, 13,  16,  19, 23,
                                    28, 33, 40, 48, 57, 69, 83, 99, 119, 143, 171},
      bins{1e-9, 0.5e-9, 0.25e-9, 0.125e-9, analytic};
  const auto best = std::make_shared<const Candidate>(simulated(place.survey, 2001, analytic));
  std::vector<Candidate> all;
  for (const double n : subrays)
    for (const double bin : bins) all.push_back(simulated(place.survey, n, bin));
  const ErrorSample every(slots, {.clusters = slots, .length = 2});
  const auto expected = every.simulate(AnySurvey(best->survey));
  for (Candidate& c : all) c.truth = every.errors("", expected, every.simulate(AnySurvey(c.survey))).all;
  const auto find = [&](std::span<const double> values) -> const Candidate& {
    return *std::ranges::find_if(all, [&](const Candidate& c) { return std::ranges::equal(c.values, values); });
  };
  AdjustableSurvey adjustable{.ladders = {{"subrays", subrays, 2001}, {"bin", bins, analytic}}};
  adjustable.survey = [&](std::span<const double> v) {
    return AnySurvey(v[0] > subrays.back() ? best->survey : find(v).survey);
  };
  adjustable.effort = [](std::span<const double> v) { return v[0] + 10 + (v[1] == analytic ? 0 : 3 + 0.4e-9 / v[1]); };
  for (const Accuracy& asked : place.asked) {
    const Candidate* cheapest = nullptr;
    for (const Candidate& c : all)
      if (asked.share_of_limits(c.truth).value <= 1 && (!cheapest || c.seconds < cheapest->seconds)) cheapest = &c;
    if (!cheapest) {
      std::printf("%-8s no settings reach it\n", place.name.c_str());
      continue;
    }
    Tally tally;
    for (std::uint64_t seed = 0; seed < choices; ++seed) {
      const SettingsChoice choice = choose_settings(asked, adjustable, {.seed = 1000 * seed, .length = 2});
      const Candidate& chosen = find(choice.values);
      const double share = asked.share_of_limits(chosen.truth).value;
      ++tally.choices;
      tally.slots += static_cast<double>(choice.slots);
      tally.reached += choice.reached ? 1 : 0;
      tally.kept += share <= 1 ? 1 : 0;
      tally.exceeded += share > 1.25 ? 1 : 0;
      if (choice.reached) tally.times.push_back(chosen.seconds / cheapest->seconds);
    }
    tally.print(place.name.c_str(), asked, *cheapest);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::size_t choices = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 100;
  std::printf(
      "scene    asked: range, echoes, intensity; choices that say they reach it, that keep all limits, that exceed "
      "one by a quarter; time by cheapest, median, greatest; slots; cheapest\n");
  for (const Place& place : places())
    if (argc < 3 || place.name == argv[2]) measure(place, choices);
}
