// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Cost of detecting the echoes of a pulse: ns a pulse and a reflection, by detector, number of reflections, and target:
// a plane at normal incidence, a slope, or the leaves of a tree. Rows are named case/reflections/detector. The
// reflections of 1,024 pulses come in the order of their subrays; they are copied for each pass, as the detector sorts
// them, and the copy is part of the figure.

#include <algorithm>
#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include <pulsecast/detector/analytic_waveform.hpp>
#include <pulsecast/detector/band_limited_receiver.hpp>
#include <pulsecast/detector/gaussian_fit.hpp>
#include <pulsecast/pulsecast.hpp>

#include "report.hpp"
#include "scenes.hpp"

using namespace bench;

namespace {

constexpr std::size_t pulses = 1024;

/// The reflections of some pulses, all of the same number.
struct Case {
  std::string name;
  std::size_t number;
  std::vector<Reflection> reflections;
};

/// `range_of` gives the range of a subray from its place in the footprint and a die.
Case made(const std::string& name, std::size_t number,
          const std::function<double(const Vec2&, wood::Dice&)>& range_of) {
  const SunflowerFootprint footprint(number);
  wood::Dice dice(3, static_cast<std::uint32_t>(number));
  Case all{name, number, {}};
  for (std::size_t i = 0; i < pulses; ++i) {
    const double shift = dice.between(0, 1);  // of the pulse in the bins
    for (std::size_t j = 0; j < number; ++j) {
      const double range = 100 + shift + range_of(footprint.offset(j), dice);
      all.reflections.push_back(
          {.range = range, .power = 1e-6 / static_cast<double>(number), .object = 1, .cos_incidence = 0.9});
    }
  }
  return all;
}

template <class D>
void add(const Report& report, const Case& what, const std::string& name, const D& detector,
         std::vector<std::string>& names, std::vector<std::function<void()>>& works, std::vector<std::size_t>& echoes) {
  names.push_back(what.name + "/" + std::to_string(what.number) + "/" + name);
  if (!report.wanted(names.back())) return names.pop_back();
  echoes.push_back(0);
  works.emplace_back([&what, &echoes, k = echoes.size() - 1, detector, workspace = detector.workspace(what.number),
                      scratch = std::vector<Reflection>(what.number)]() mutable {
    const Emitter emitter;
    std::size_t count = 0;
    for (std::size_t i = 0; i < pulses; ++i) {
      std::copy_n(what.reflections.begin() + static_cast<std::ptrdiff_t>(i * what.number), what.number,
                  scratch.begin());
      count += detector.detect(DetectorInput{emitter, {}, scratch}, workspace).echoes.size();
    }
    echoes[k] = count;
  });
}

void measure(Report& report, const Case& what) {
  std::vector<std::string> names;
  std::vector<std::function<void()>> works;
  std::vector<std::size_t> echoes;
  const auto enter = [&](const std::string& name, const auto& detector) {
    add(report, what, name, detector, names, works, echoes);
  };
  enter("FirstHit", FirstHit{});
  enter("FullWaveform", FullWaveform{});
  enter("FullWaveform, true ranges", FullWaveform{{.timing = EchoTiming::true_range}});
  FullWaveform<NoWidth, BandLimitedReceiver<>> band_limited;
  band_limited.prepare(Laser{});
  enter("FullWaveform, band-limited", band_limited);
  enter("FullWaveform<GaussianFit>", FullWaveform<GaussianFit>{});
  enter("FullWaveform, recorded", FullWaveform{{.record_length = 40_ns}});
  enter("AnalyticWaveform", AnalyticWaveform{});
  enter("AnalyticWaveform<GaussianFit>", AnalyticWaveform<GaussianFit>{});
  if (works.empty()) return;
  report.heading(what.name + ", " + std::to_string(what.number) + (what.number == 1 ? " reflection" : " reflections"));
  const std::vector<Times> times = report.by_turns(works);
  for (std::size_t i = 0; i < works.size(); ++i) {
    const double each = 1e9 * median(times[i]) / pulses;
    report.row(names[i], {{"ns/pulse", each},
                          {"ns/reflection", each / static_cast<double>(what.number)},
                          {"echoes/pulse", static_cast<double>(echoes[i]) / pulses}});
  }
}

}  // namespace

int main(int count, char** words) {
  Report report("detect", count, words);
  for (const std::size_t number : {1U, 7U, 19U, 61U, 279U}) {
    measure(report, made("plane", number, [](const Vec2&, wood::Dice&) { return 0.0; }));
    if (number == 1) continue;  // the others are the same
    measure(report, made("slope", number, [](const Vec2& offset, wood::Dice&) { return 0.3 * offset.y; }));
    measure(report, made("tree", number, [](const Vec2&, wood::Dice& dice) {
              const double leaf = dice.between(0, 1);  // some in front, most in the crown, the rest behind it
              return leaf < 0.2 ? dice.between(0, 0.2) : leaf < 0.8 ? dice.between(2, 3.5) : dice.between(9, 9.1);
            }));
  }
}
