// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Cost of a pulse of 19 subrays on one thread, stage by stage [ns], beside its floor: the time of a program that does
// no more than the task needs, derived in docs/performance.md, at the peak rates of this machine, which are measured in
// the same rounds. An airplane over hills, a tripod beside a tree, a car in a street. A run is repeated, each time with
// one more of its stages; the results of the others are recorded before. So every stage is measured in place, and the
// stages sum to the whole run. Rows are named survey/stage; `--only` is compared with survey/. They are printed only
// after the accelerator has given the same hits as `Linear` on a sample, and the survey of recorded hits as many
// echoes.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <memory>
#include <set>
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

constexpr std::size_t subrays = 19;

/// A map in which nothing is met.
struct Nothing {
  void closest(const RayBundle& rays, std::span<Hit> hits) const noexcept {
    std::fill_n(hits.begin(), rays.size, Hit{});
  }
};

/// The hits of all pulses, as many a pulse as it has subrays.
struct Known {
  std::vector<Hit> hits;

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
  const Scene<Mesh>& scene;  ///< of one part
  const Known& known;
  using refinements = refines<tag::MissesCones>;

  void closest(const RayBundle& rays, std::span<Hit> hits) const noexcept {
    ClosestHits nearest(rays);
    scene.parts()[0].geometry->closest(rays, nearest);
    keep(nearest);
    known.closest(rays, hits);
  }
  [[nodiscard]] bool misses_cone(const RayCone& cone) const noexcept { return scene.misses_cone(cone); }
};

/// A detector that sees nothing.
struct Blind {
  struct Workspace {};
  [[nodiscard]] Workspace workspace(std::size_t) const { return {}; }
  [[nodiscard]] Detection detect(const DetectorInput&, Workspace&) const noexcept { return {}; }
};

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
    for (PulseIndex i = 0; i < source.size(); i += simd::lane_count) keep(find_pulses(source, i, simd::lane_count));
  });
}

/// What the tasks of a survey are: numbers a slot.
struct Amounts {
  double pulses = 0, met = 0;     ///< pulses that are sent, and that hit anything
  double hits = 0, surfaces = 0;  ///< hits, and triangles that are hit, each once a pulse
  double echoes = 0, levels = 0;  ///< echoes; levels of a tree of eight children a node, over all triangles
  double result_bytes = 0, file_bytes = 0;
};

/// What a stage needs at least: operations in double precision, and bytes.
struct Floor {
  double operations = 0, bytes = 0;
};

/// Floors by stage. Source: docs/performance.md, section 7, which derives each number.
Floor floor_of(const std::string& stage, const Amounts& n) {
  constexpr double direction = 15, rotation = 28, sine_and_cosine = 34, exponential = 22;
  if (stage == "laser") return {2};
  if (stage == "mirror") return {sine_and_cosine * n.pulses};
  if (stage == "head") return {(sine_and_cosine + rotation) * n.pulses};
  if (stage == "platform") return {(rotation + 6) * n.pulses};
  if (stage == "rays") return {(24 + subrays * direction) * n.pulses};
  if (stage.starts_with("tracing")) {
    Floor all{72 * n.levels * n.met + 45 * n.surfaces + 21 * n.hits, 72 * n.surfaces};
    if (stage != "tracing") all.operations += floor_of("describing hits", n).operations;
    return all;
  }
  if (stage == "describing hits") return {20 * n.surfaces + 6 * n.hits};
  if (stage == "link budget and fates") return {10 * n.hits};
  if (stage == "detection") return {(3 + exponential) * n.hits + 10 * n.echoes};
  if (stage == "batches") return {0, n.result_bytes};
  return {0, n.file_bytes};  // writing LAS
}

void write_las(const Recording& recording, const std::filesystem::path& path) {
  io::LasWriter las(path);
  las(recording.batch());
  las.close();
}

#ifdef __AVX512F__
constexpr std::size_t lanes = 24 * 4;
#else
constexpr std::size_t lanes = 12 * 4;  ///< of twelve vectors
#endif

constexpr std::size_t peak_rounds = 100'000, near_size = 1U << 15;  // 256 kB

/// Fused multiplications and additions in vectors, each of which waits for its own only.
void multiply() {
  std::array<double, lanes> sums{};
  for (std::size_t i = 0; i < peak_rounds; ++i)
    for (double& sum : sums) sum = std::fma(sum, 0.5, 1.0);
  keep(sums);
}

/// Reads an array, eight sums at a time.
void read(const std::vector<std::uint64_t>& all) {
  std::array<std::uint64_t, 32> sums{};
  for (std::size_t i = 0; i + sums.size() <= all.size(); i += sums.size())
    for (std::size_t k = 0; k < sums.size(); ++k) sums[k] += all[i + k];
  keep(sums);
}

/// Adds up what the pulses of a survey need, from what they hit.
template <class Survey>
Amounts amounts_of(const Survey& survey, const Bundles& bundles, const Mesh& flat, const Recording& recording) {
  const double slots = static_cast<double>(survey.size());
  Amounts n;
  n.levels = std::log(static_cast<double>(flat.size())) / std::log(8.0);
  for (std::size_t i = 0; i < bundles.size(); ++i) {
    const RayBundle rays = bundles[i];
    ClosestHits nearest(rays);
    flat.closest(rays, nearest);
    std::set<std::uint64_t> surfaces;
    for (std::size_t j = 0; j < rays.size; ++j)
      if (nearest.met(j)) {
        surfaces.insert(nearest.id[j]);
        n.hits += 1 / slots;
      }
    n.pulses += 1 / slots;
    n.met += surfaces.empty() ? 0 : 1 / slots;
    n.surfaces += static_cast<double>(surfaces.size()) / slots;
  }
  n.echoes = static_cast<double>(recording.echoes.size()) / slots;
  n.result_bytes = sizeof(Shot) * static_cast<double>(recording.shots.size()) / slots + sizeof(Echo) * n.echoes;
  return n;
}

/// Prints the rows of a survey: `names` are the peaks, the stages in order, and writing, which is not of the run.
void print(Report& report, const std::string& name, const std::vector<std::string>& names,
           const std::vector<Times>& times, double slots, const Amounts& n) {
  const double peak = 2.0 * lanes * peak_rounds / (1e9 * median(times[0])),
               bandwidth = 8.0 * near_size / (1e9 * median(times[1]));
  char text[256];
  std::snprintf(
      text, sizeof text,
      "%s: %.0f slots, of which %.0f %% are pulses; %.2f hits, %.2f triangles, %.2f echoes a slot. Peak of one "
      "thread: %.0f operations/ns, %.0f bytes/ns",
      name.c_str(), slots, 100 * n.pulses, n.hits, n.surfaces, n.echoes, peak, bandwidth);
  report.heading(text);
  const std::size_t last = names.size() - 1;
  const auto ns = [&](std::size_t i) { return 1e9 * median(times[i]) / slots; };
  const auto row = [&](const std::string& stage, double cost, const Floor& floor) {
    const double least = std::max(floor.operations / peak, floor.bytes / bandwidth);
    report.row(name + "/" + stage, {{"ns/slot", cost},
                                    {"% of the run", 100 * cost / ns(last - 1)},
                                    {"operations", floor.operations},
                                    {"bytes", floor.bytes},
                                    {"floor, ns", least},
                                    {"times the floor", cost / least}});
  };
  Floor sum;
  for (std::size_t i = 2; i < last; ++i) {
    const Floor floor = floor_of(names[i], n);
    sum = {sum.operations + floor.operations, sum.bytes + floor.bytes};
    row(names[i], ns(i) - (i == 2 ? 0 : ns(i - 1)), floor);
  }
  row("the run", ns(last - 1), sum);
  row(names[last], ns(last), floor_of(names[last], n));
}

template <class Source>
void measure(Report& report, const std::string& name, const Source& source, const Scene<Mesh>& scene,
             const std::vector<std::string>& sources) {
  const std::string prefix = name + "/";
  if (!report.wanted(prefix)) return;
  const auto survey_of = [&](const auto& map, const auto& detector) {
    return Survey{source, SunflowerFootprint(subrays), map, DirectLight{.spread_planes = false}, Receiver{}, detector};
  };
  const RunOptions alone{.threads = 1};
  Known known{std::vector<Hit>(source.size() * subrays)};
  Bundles bundles;
  const Nothing nothing;
  const Noting noting{scene, known, bundles};
  const std::uint64_t echoes = run(survey_of(noting, FullWaveform{}), alone).echoes;
  const MeshData flat = flattened(scene);
  const Bundles some = bundles.sample(16);
  if (answers(Mesh(flat), some) != answers(TriangleMesh<Linear<>>(flat), some) ||
      run(survey_of(known, FullWaveform{}), alone).echoes != echoes) {
    std::printf("%s DIFFERS from Linear, or gives other echoes by its known hits\n", prefix.c_str());
    std::exit(1);
  }

  const auto whole = survey_of(scene, FullWaveform{});
  const Traced traced{scene, known};
  const std::vector<std::uint64_t> near(near_size, 1);
  Stages stages;
  stages.add("peak", multiply);
  stages.add("bandwidth", [&] { read(near); });
  add_sources(source, sources, stages);
  stages.add("rays", [&, survey = survey_of(nothing, Blind{})] { run(survey, alone); });
  stages.add("link budget and fates", [&, survey = survey_of(known, Blind{})] { run(survey, alone); });
  const bool one_part = scene.parts().size() == 1;
  if (one_part) stages.add("tracing", [&, survey = survey_of(traced, Blind{})] { run(survey, alone); });
  stages.add(one_part ? "describing hits" : "tracing and describing hits",
             [&, survey = survey_of(scene, Blind{})] { run(survey, alone); });
  stages.add("detection", [&] { run(whole, alone); });
  stages.add("batches", [&] { run(whole, alone, [](const EchoBatch& batch) { keep(batch); }); });
  Recording recording;
  run(whole, alone, recording);
  const std::filesystem::path file = std::filesystem::temp_directory_path() / "pulsecast_bench_pipeline.las";
  stages.add("writing LAS", [&] { write_las(recording, file); });
  Amounts amounts = amounts_of(whole, bundles, Mesh(flat), recording);
  const std::vector<Times> times = report.by_turns(stages.works, process_seconds);
  amounts.file_bytes = static_cast<double>(std::filesystem::file_size(file)) / static_cast<double>(source.size());
  std::filesystem::remove(file);
  print(report, name, stages.names, times, static_cast<double>(source.size()), amounts);
}

}  // namespace

int main(int count, char** words) {
  Report report("pipeline", count, words);
  constexpr PulseIndex pulses = 10'000;
  measure(report, "hills", airplane(pulses), scene_of(hills(866).mesh()), {"laser", "mirror", "platform"});
  measure(report, "tree", tripod(pulses), scene_of(tree()), {"laser", "mirror", "head", "platform"});
  measure(report, "street", car(pulses), street::scene(1), {"laser", "mirror", "platform"});
}
