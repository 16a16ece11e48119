// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Shares of pulses that take each short cut, in the surveys of `bench_pipeline`, which measures the cost of the stages
// that are skipped. Nothing is timed here.

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <pulsecast/detector/adaptor.hpp>
#include <pulsecast/pulsecast.hpp>

#include "report.hpp"
#include "scenes.hpp"
#include "surveys.hpp"

using namespace bench;

namespace {

/// Of the pulses that were sent.
struct Counts {
  std::size_t pulses = 0, hits = 0, described = 0, met = 0, described_once = 0, detected = 0, in_closed_form = 0;
};

/// A scene, and a count of how often its surfaces are described.
struct WatchedScene {
  const Scene<Mesh>& scene;
  const Mesh& flat;  ///< its triangles, each with a number of its own
  Counts& counts;

  void closest(const RayBundle& rays, std::span<Hit> hits) const noexcept {
    scene.closest(rays, hits);
    ClosestHits nearest(rays);
    flat.closest(rays, nearest);
    std::size_t met = 0, described = 0;
    std::uint64_t known = ClosestHits::none;
    for (std::size_t j = 0; j < rays.size; ++j) {
      if (!nearest.met(j)) continue;
      ++met;
      if (nearest.id[j] != known) {
        ++described;
        known = nearest.id[j];
      }
    }
    counts.hits += met;
    counts.described += described;
    counts.met += met > 0 ? 1 : 0;
    counts.described_once += described == 1 ? 1 : 0;
  }
};

/// A detector, and a count of how often it does without samples.
struct WatchedDetector : DetectorAdaptor<FullWaveform<>> {
  Counts* counts = nullptr;

  [[nodiscard]] Detection detect(const DetectorInput& input, FullWaveform<>::Workspace& w) const noexcept {
    w.window.clear();
    const Detection detection = inner.detect(input, w);
    ++counts->detected;
    if (w.window.empty()) ++counts->in_closed_form;
    return detection;
  }
};

template <class Source>
void count(Report& report, const std::string& name, const Source& source, const Scene<Mesh>& scene,
           std::size_t subrays) {
  const std::string row = name + "/" + std::to_string(subrays);
  if (!report.wanted(row)) return;
  Counts counts;
  const Mesh flat(flattened(scene));
  const WatchedScene watched{scene, flat, counts};
  const Survey survey{source, SunflowerFootprint(subrays), watched, Receiver{},
                      WatchedDetector{{FullWaveform{}}, &counts}};
  auto workspace = survey.workspace();
  for (PulseIndex i = 0; i < survey.size(); ++i) {
    const Outcome outcome = survey(i, workspace);
    if (outcome.shot.fate == Fate::blocked) continue;
    ++counts.pulses;
  }
  const auto percent = [](std::size_t some, std::size_t all) {
    return 100.0 * static_cast<double>(some) / static_cast<double>(all);
  };
  report.row(row,
             {{"% nothing met: nothing described, no detector", percent(counts.pulses - counts.met, counts.pulses)},
              {"% one surface met: described once", percent(counts.described_once, counts.pulses)},
              {"descriptions a hit", static_cast<double>(counts.described) / static_cast<double>(counts.hits)},
              {"% of detections in closed form, without samples", percent(counts.in_closed_form, counts.detected)}});
}

}  // namespace

int main(int words, char** given) {
  Report report("short_cuts", words, given);
  constexpr PulseIndex pulses = 20'000;
  for (const std::size_t subrays : {1U, 19U, 61U}) {
    count(report, "hills", airplane(pulses), scene_of(hills(866).mesh()), subrays);
    count(report, "tree", tripod(pulses), scene_of(tree()), subrays);
    count(report, "street", car(pulses), street::scene(1), subrays);
  }
}
