// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Cost of empty slots, on one thread [ns]: a tripod beside a lone tree, in slots that the mirror blocks, in pulses
// beside the tree's bounds, in pulses inside them without hits, and, to compare, in pulses with echoes. Rows are named
// slots/subrays.

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <pulsecast/pulsecast.hpp>

#include "report.hpp"
#include "scenes.hpp"
#include "surveys.hpp"

using namespace bench;

namespace {

/// A tripod 8 m from the tree, with lines from the ground to the sky, in a quarter turn.
auto beside_the_tree(PulseIndex pulses) {
  const Laser laser{.wavelength = 1064_nm, .peak_power = 10_W, .pulse_length = 4_ns, .divergence = 0.3_mrad};
  const Scanner scanner{.pulse_rate = 300_kHz, .pulses = pulses, .laser = laser};
  const RotatingHead head{.angular_rate = 90_deg / scanner.duration().seconds()};
  return Platform{
      Tripod{.position = {8, 0, 0}}, Mount{.lever_arm = {0, 0, 1.7}, .boresight = rotation_about(axis::up, 45_deg)},
      Deflector{head, Deflector{PolygonMirror{.line_rate = 100_Hz, .sweep = 100_deg, .angle_min = -40_deg}, scanner}}};
}

/// Slots of a kind, in order.
struct Slots {
  std::string name;
  std::vector<PulseIndex> numbers{};
};

template <class Survey>
std::vector<Slots> slots_of(const Survey& survey, const Box& bounds) {
  std::vector<Slots> all{{"blocked"}, {"beside the bounds"}, {"inside the bounds, nothing met"}, {"echoes"}};
  auto workspace = survey.workspace();
  for (PulseIndex i = 0; i < survey.size(); ++i) {
    const Outcome outcome = survey(i, workspace);
    const bool beside = RayCone{outcome.shot.origin, outcome.shot.direction, 1e-3}.passes(bounds);
    const Fate fate = outcome.shot.fate;
    if (fate == Fate::blocked) all[0].numbers.push_back(i);
    if (fate == Fate::missed) all[beside ? 1 : 2].numbers.push_back(i);
    if (fate == Fate::returned) all[3].numbers.push_back(i);
  }
  return all;
}

}  // namespace

int main(int count, char** words) {
  Report report("misses", count, words);
  const Scene<Mesh> scene = scene_of(tree());
  const auto source = beside_the_tree(100'000);
  for (const std::size_t subrays : {1U, 19U}) {
    const Survey survey{source, SunflowerFootprint(subrays), scene, Receiver{}, FullWaveform{}};
    report.heading(std::to_string(subrays) + (subrays == 1 ? " subray" : " subrays"));
    for (const Slots& slots : slots_of(survey, scene.bounds())) {
      const std::string name = slots.name + "/" + std::to_string(subrays);
      if (!report.wanted(name)) continue;
      auto workspace = survey.workspace();
      ResultBuffer results;
      const auto each = [&](const auto& work) {
        return [&, work] {
          for (const PulseIndex i : slots.numbers) work(i);
        };
      };
      const std::vector<Times> times = report.by_turns({
          each([&](PulseIndex i) { keep(source.pulse(i)); }),
          each([&](PulseIndex i) { keep(survey(i, workspace)); }),
          [&] {
            results.clear();
            for (const PulseIndex i : slots.numbers) results.append(survey(i, workspace), false);
          },
          [&] {
            results.clear();
            for (const PulseIndex i : slots.numbers) results.append(survey(i, workspace));
          },
      });
      const auto ns = [&](std::size_t k) { return 1e9 * median(times[k]) / static_cast<double>(slots.numbers.size()); };
      report.row(name, {{"slots", static_cast<double>(slots.numbers.size())},
                        {"ns: pulse made", ns(0)},
                        {"outcome", ns(1)},
                        {"counted", ns(2)},
                        {"shot kept", ns(3)}});
    }
  }
}
