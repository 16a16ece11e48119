// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Cost of slots that need little, on one thread [ns]: pulses made without tracing, in SIMD batches, as in a run, and
// one by one; the directions of 19 subrays; runs of nothing but blocked slots; and pulses beside a lone tree's bounds,
// inside them without a hit, and with echoes.

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <pulsecast/deflector/risley_prisms.hpp>
#include <pulsecast/pulsecast.hpp>

#include "report.hpp"
#include "scenes.hpp"
#include "surveys.hpp"

using namespace bench;

namespace {

constexpr PulseIndex slots = 100'000;

/// Some optic on a head, 8 m from the tree, in a quarter turn.
template <class Optic>
auto beside_the_tree(const Optic& optic) {
  const Laser laser{.wavelength = 1064_nm, .peak_power = 10_W, .pulse_length = 4_ns, .divergence = 0.3_mrad};
  const Scanner scanner{.pulse_rate = 300_kHz, .pulses = slots, .laser = laser};
  const RotatingHead head{.angular_rate = 90_deg / scanner.duration().seconds()};
  return Platform{Tripod{.position = {8, 0, 0}},
                  Mount{.lever_arm = {0, 0, 1.7}, .boresight = rotation_about(axis::up, 45_deg)},
                  Deflector{head, Deflector{optic, scanner}}};
}

const PolygonMirror to_the_sky{.line_rate = 100_Hz, .sweep = 100_deg, .angle_min = -40_deg};
const PolygonMirror open_mirror{.line_rate = 100_Hz, .sweep = 60_deg};
const PolygonMirror blind_mirror{.line_rate = 100_Hz, .sweep = 60_deg, .angle_min = 59.9_deg, .angle_max = 60_deg};
const RisleyPrisms prisms{.prisms = {{.rotation_rate = 100}, {.rotation_rate = -77}}};

/// Pieces of work over a number of slots each.
struct Works {
  std::vector<std::string> names{};
  std::vector<double> numbers{};
  std::vector<std::function<void()>> works{};

  void add(const std::string& name, std::size_t number, std::function<void()> work) {
    names.push_back(name);
    numbers.push_back(static_cast<double>(number));
    works.push_back(std::move(work));
  }

  void measure(Report& report) const {
    const std::vector<Times> times = report.by_turns(works);
    for (std::size_t i = 0; i < works.size(); ++i) report.row(names[i], {{"ns", 1e9 * median(times[i]) / numbers[i]}});
  }
};

template <class Source>
void add_source(Works& works, const std::string& name, const Source& source) {
  works.add("pulse by " + name, slots, [source] {
    for (PulseIndex i = 0; i < slots; i += simd::lane_count) {
      const auto pulses = source.pulse_lanes(i, simd::lane_count);
      for (std::size_t lane = 0; lane < pulses.size; ++lane) keep(pulses[lane]);
    }
  });
  works.add("pulse by " + name + ", alone", slots, [source] {
    for (PulseIndex i = 0; i < slots; ++i) keep(source.pulse(i));
  });
}

void add_directions(Works& works) {
  const Emitter emitter;
  const SubrayDirections beam(SunflowerFootprint(19), emitter);
  works.add("directions of 19 subrays", slots, [beam] {
    RayBundle rays;
    rays.size = 19;
    const Matrix3 turn = matrix_of(rotation_about(axis::up, 20_deg));
    for (PulseIndex i = 0; i < slots; ++i) {
      keep(turn);
      beam.to_world(turn, 0, rays);
      keep(rays);
    }
  });
}

/// Adds the slots of a survey beside the tree by their fates.
template <class Survey>
void add_fates(Works& works, const Survey& survey, const Box& bounds) {
  std::array<std::vector<PulseIndex>, 3> kinds;
  auto workspace = survey.workspace();
  for (PulseIndex i = 0; i < survey.size(); ++i) {
    const Outcome outcome = survey(i, workspace);
    const bool beside = RayCone{outcome.shot.origin, outcome.shot.direction, 1e-3}.passes(bounds);
    if (outcome.shot.fate == Fate::missed) kinds[beside ? 0 : 1].push_back(i);
    if (outcome.shot.fate == Fate::returned) kinds[2].push_back(i);
  }
  const std::string subrays = " of " + std::to_string(survey.subrays());
  const std::array<std::string, 3> names{"beside the bounds", "inside the bounds, no hit", "echoes"};
  for (std::size_t k = 0; k < kinds.size(); ++k)
    works.add("pulse" + subrays + ": " + names[k], kinds[k].size(), [&survey, some = kinds[k], workspace]() mutable {
      for (const PulseIndex i : some) keep(survey(i, workspace));
    });
}

}  // namespace

int main(int count, char** words) {
  Report report("slots", count, words);
  const Scene<Mesh> scene = scene_of(tree());
  const auto survey_of = [&](const auto& optic, const auto& footprint) {
    return Survey{beside_the_tree(optic), footprint, scene, Receiver{}, FullWaveform{}};
  };
  const auto blocked = survey_of(blind_mirror, SingleRay{});
  const auto single = survey_of(to_the_sky, SingleRay{});
  const auto beam = survey_of(to_the_sky, SunflowerFootprint{19});
  Works works;
  add_source(works, "a mirror on a head", beside_the_tree(open_mirror));
  add_source(works, "two prisms on a head", beside_the_tree(prisms));
  add_directions(works);
  works.add("blocked slot, mean over a sweep, in a run", slots, [&] { run(blocked, {.threads = 1}); });
  add_fates(works, single, scene.bounds());
  add_fates(works, beam, scene.bounds());
  report.heading("slots");
  works.measure(report);
}
