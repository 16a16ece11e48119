// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Cost of a pulse on one thread, stage by stage [ns]: an airplane over hills, a tripod beside a tree, a car in a
// street. A survey runs repeatedly, each time with one more of its stages; the results of the others are recorded
// before. So every stage is measured in place, and the stages sum to the whole survey. Rows are named
// survey/subrays/stage; `--only` is compared with survey/subrays/. They are printed only after the accelerator has
// given the same hits as `Linear` on a sample, and the survey of recorded hits the same echoes.

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <pulsecast/accel/linear.hpp>
#include <pulsecast/io/las.hpp>
#include <pulsecast/pulsecast.hpp>

#include "report.hpp"
#include "scenes.hpp"
#include "surveys.hpp"

using namespace bench;

namespace {

/// A map in which nothing is met.
struct Nothing {
  void closest(const RayBundle& rays, std::span<Hit> hits) const noexcept {
    std::fill_n(hits.begin(), rays.size, Hit{});
  }
};

/// The hits of all pulses, as many a pulse as it has subrays.
struct Known {
  std::vector<Hit> hits;
  std::size_t subrays;

  [[nodiscard]] std::size_t place(const RayBundle& rays) const noexcept {
    return rays.pulse * subrays + rays.first_subray;
  }
  void closest(const RayBundle& rays, std::span<Hit> to) const noexcept {
    std::copy_n(hits.begin() + static_cast<std::ptrdiff_t>(place(rays)), rays.size, to.begin());
  }
};

/// A scene, and a note of what is met in it, and by which rays.
struct Noting {
  const Scene<Mesh>& scene;
  Known& known;
  Bundles& bundles;

  void closest(const RayBundle& rays, std::span<Hit> hits) const noexcept {
    scene.closest(rays, hits);
    std::copy_n(hits.begin(), rays.size, known.hits.begin() + static_cast<std::ptrdiff_t>(known.place(rays)));
    bundles.add(rays);
  }
};

/// Rays are traced, but their hits are recorded ones.
struct Traced {
  const Mesh& mesh;
  const Known& known;

  void closest(const RayBundle& rays, std::span<Hit> hits) const noexcept {
    ClosestHits nearest(rays);
    mesh.closest(rays, nearest);
    keep(nearest);
    known.closest(rays, hits);
  }
};

/// A detector that sees nothing.
struct Blind {
  struct Workspace {};
  [[nodiscard]] Workspace workspace(std::size_t) const { return {}; }
  [[nodiscard]] Detection detect(const DetectorInput&, Workspace&) const noexcept { return {}; }
};

/// Goes through all pulses; the sum of the echoes' ranges.
template <class S>
double go(const S& survey) {
  auto workspace = survey.workspace();
  double sum = 0;
  for (PulseIndex i = 0; i < survey.size(); ++i) {
    const Outcome outcome = survey(i, workspace);
    for (const Echo& echo : outcome.echoes) sum += echo.range;
    keep(outcome);
  }
  return sum;
}

/// Pieces of work, each of which does what the one before it does, and more.
struct Stages {
  std::vector<std::string> names;
  std::vector<std::function<void()>> works;

  void add(const std::string& name, std::function<void()> work) {
    names.push_back(name);
    works.push_back(std::move(work));
  }
};

/// The pulses of a source and of all that it stands on, the innermost first.
template <class Source>
void add_sources(const Source& source, std::span<const std::string> names, Stages& stages) {
  if constexpr (requires { source.source(); }) add_sources(source.source(), names.first(names.size() - 1), stages);
  stages.add(names.back(), [&source] {
    for (PulseIndex i = 0; i < source.size(); ++i) keep(source.pulse(i));
  });
}

void write_las(const Recording& recording, const std::filesystem::path& path) {
  io::LasWriter las(path);
  las(recording.batch());
  las.close();
}

template <class Source>
void measure(Report& report, const std::string& name, const Source& source, const Scene<Mesh>& scene,
             const std::vector<std::string>& sources, std::size_t subrays) {
  const std::string prefix = name + "/" + std::to_string(subrays) + "/";
  if (!report.wanted(prefix)) return;
  const auto survey_of = [&](const auto& map, const auto& detector) {
    return Survey{source, SunflowerFootprint(subrays), map, Receiver{}, detector};
  };
  Known known{std::vector<Hit>(source.size() * subrays), subrays};
  Bundles bundles;
  const Nothing nothing;
  const Noting noting{scene, known, bundles};
  const double sum = go(survey_of(noting, FullWaveform{}));
  const MeshData flat = flattened(scene);
  if (const Bundles some = bundles.sample(16);
      answers(Mesh(flat), some) != answers(TriangleMesh<Linear<>>(flat), some)) {
    std::printf("%s DIFFERS from Linear\n", prefix.c_str());
    std::exit(1);
  }
  if (go(survey_of(known, FullWaveform{})) != sum) {
    std::printf("%s gives other echoes by its known hits\n", prefix.c_str());
    std::exit(1);
  }

  const auto whole = survey_of(scene, FullWaveform{});
  const Traced traced{*scene.parts()[0].geometry, known};
  Stages stages;
  add_sources(source, sources, stages);
  stages.add("rays", [&, survey = survey_of(nothing, Blind{})] { keep(go(survey)); });
  stages.add("link budget and fates", [&, survey = survey_of(known, Blind{})] { keep(go(survey)); });
  if (scene.parts().size() == 1) {
    stages.add("tracing", [&, survey = survey_of(traced, Blind{})] { keep(go(survey)); });
    stages.add("describing hits", [&, survey = survey_of(scene, Blind{})] { keep(go(survey)); });
  } else {
    stages.add("tracing and describing hits", [&, survey = survey_of(scene, Blind{})] { keep(go(survey)); });
  }
  stages.add("detection", [&] { keep(go(whole)); });
  stages.add("batches", [&] { run(whole, {.threads = 1}); });
  Recording recording;
  run(whole, {}, recording);
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "pulsecast_bench_pipeline";
  std::filesystem::create_directory(folder);
  auto works = stages.works;
  works.emplace_back([&] { write_las(recording, folder / "points.las"); });
  const std::vector<Times> times = report.by_turns(works, process_seconds);
  std::filesystem::remove_all(folder);

  report.heading(name + ", " + std::to_string(subrays) + " subrays: " + std::to_string(source.size()) + " pulses, " +
                 std::to_string(recording.echoes.size()) + " echoes");
  const auto ns = [&](std::size_t i) { return 1e9 * median(times[i]) / static_cast<double>(source.size()); };
  const std::size_t batches = stages.names.size() - 1;
  const auto row = [&](const std::string& stage, double cost) {
    report.row(prefix + stage, {{"ns/pulse", cost}, {"% of the survey", 100 * cost / ns(batches - 1)}});
  };
  for (std::size_t i = 0; i < batches; ++i) row(stages.names[i], ns(i) - (i == 0 ? 0 : ns(i - 1)));
  row("the survey", ns(batches - 1));
  row(stages.names[batches], ns(batches) - ns(batches - 1));
  row("writing LAS", ns(batches + 1));
}

}  // namespace

int main(int count, char** words) {
  Report report("pipeline", count, words);
  constexpr PulseIndex pulses = 10'000;
  for (const std::size_t subrays : {1U, 19U}) {
    measure(report, "hills", airplane(pulses), scene_of(hills(866).mesh()), {"laser", "mirror", "platform"}, subrays);
    measure(report, "tree", tripod(pulses), scene_of(tree()), {"laser", "mirror", "head", "platform"}, subrays);
    measure(report, "street", car(pulses), street::scene(1), {"laser", "mirror", "platform"}, subrays);
  }
}
