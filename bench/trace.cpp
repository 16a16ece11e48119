// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Cost of tracing on one thread: beams and rays a second, by scene, accelerator, precision and subrays a beam, and
// beside them Embree 3 on the same rays, alternating in the same run. A row is printed only once the accelerator has
// given the same hits as `Linear`, bit by bit, on a sample; for Embree the share of equal ranges is printed.
//
// Rows are named scene/subrays/accelerator, with `alone` for a `SingleRayPacket` in place of a bundle: `--only
// '*/19/Bvh<float>' --only
// '*/19/Embree*'`. An OBJ file in metres, if one is given, is scanned as a scene of its own. A beam's ratio is to the
// best of Embree's rows; a single ray's, to the best of `rtcIntersect1`.

#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <pulsecast/accel/kd_tree.hpp>
#include <pulsecast/accel/linear.hpp>
#include <pulsecast/io/obj.hpp>
#include <pulsecast/pulsecast.hpp>
#include <pulsecast/shape/height_field.hpp>

#include "report.hpp"
#include "scenes.hpp"
#ifdef PULSECAST_BENCH_EMBREE
#include "embree.hpp"
#endif

using namespace bench;

namespace {

/// Something that rays are traced in.
struct Subject {
  std::string name;
  std::function<double(const Bundles&)> trace;
  std::function<std::vector<Answer>(const Bundles&)> answers;
  bool single = false;  ///< takes single rays only
};

template <class Shape>
Subject subject(const std::string& name, std::shared_ptr<const Shape> shape) {
  return {name, [shape](const Bundles& all) { return sum_of_ranges(*shape, all); },
          [shape](const Bundles& all) { return bench::answers(*shape, all); }};
}

/// The same shape, asked by single rays.
template <class Shape>
Subject single_subject(const std::string& name, std::shared_ptr<const Shape> shape) {
  return {name, [shape](const Bundles& all) { return sum_of_single_ranges(*shape, all); },
          [shape](const Bundles& all) { return single_answers(*shape, all); }, true};
}

struct Course {
  std::string name;
  MeshData mesh;
  Aims aims;
  double divergence;
  std::function<std::shared_ptr<const HeightField>()> field{};  ///< the same ground as one; empty if there is none
};

/// Rays that are traced together: beams of one size, or rays that have nothing in common.
struct Group {
  std::string name;
  Bundles bundles;
  std::size_t subrays;  ///< in each
  std::size_t sampled;  ///< bundles that `Linear` traces, too
};

std::vector<Group> groups(const Course& course) {
  std::vector<Group> all;
  for (const std::size_t subrays : {1U, 7U, 19U, 61U})
    all.push_back(
        {course.name + "/" + std::to_string(subrays), beams(course.aims, subrays, course.divergence), subrays, 16});
  all.push_back({course.name + "/incoherent", incoherent_rays(bounds_of(course.mesh), 4 * pulse_count), 1, 64});
  return all;
}

#ifdef PULSECAST_BENCH_EMBREE

struct EmbreeSubject {
  std::string name;
  std::unique_ptr<EmbreeMesh> mesh;
};

template <std::size_t Width>
void add_embree(const Report& report, const Group& group, const std::vector<EmbreeSubject>& subjects,
                std::vector<std::string>& names, std::vector<std::function<void()>>& works, double& sum) {
  if (Width > 1 && group.subrays == 1) return;  // there is no packet in a single ray
  const auto rays = std::make_shared<EmbreeRays<Width>>(group.bundles, group.subrays > 1);
  for (const EmbreeSubject& subject : subjects) {
    const std::string name = group.name + "/" + subject.name + " " + std::to_string(Width);
    if (!subject.mesh || !report.wanted(name)) continue;
    names.push_back(name);
    works.emplace_back([rays, mesh = subject.mesh.get(), &sum] { sum += rays->sum_of_ranges(*mesh); });
  }
}

/// Number of Embree's ranges that equal ours up to single precision.
void print_agreement(const Report& report, const Group& group, const EmbreeSubject& embree, const Subject& ours) {
  const auto theirs = EmbreeRays<1>(group.bundles, true).ranges(*embree.mesh);
  const auto expected = ours.answers(group.bundles);
  std::size_t same = 0, met = 0;
  for (std::size_t i = 0; i < theirs.size(); ++i) {
    const bool both = std::isfinite(theirs[i]) && std::isfinite(expected[i].range);
    met += std::isfinite(expected[i].range) ? 1U : 0U;
    same += both ? std::fabs(theirs[i] - expected[i].range) < 1e-5 * expected[i].range + 1e-3
                 : std::isfinite(theirs[i]) == std::isfinite(expected[i].range);
  }
  const double all = static_cast<double>(theirs.size()), share = static_cast<double>(same) / all;
  char note[128];
  std::snprintf(note, sizeof note, "%.1f %% of %zu rays meet something; Embree gives the same range for %.3f %%",
                100 * static_cast<double>(met) / all, theirs.size(), 100 * share);
  report.note(note);
  if (share < 0.98) {
    std::printf("these are not the same rays\n");
    std::exit(1);
  }
}

#endif

class Races {
 public:
  Races(Report& report, const Course& course) : report_(report), course_(course), groups_(groups(course)) {
    add<Bvh<float>>("Bvh<float>");
    if (wanted("Bvh<float> alone"))
      subjects_.push_back(single_subject("Bvh<float> alone", std::make_shared<const TriangleMesh<>>(course_.mesh)));
    add<Bvh<double>>("Bvh<double>");
    add<KdTree<float>>("KdTree<float>");
    add<KdTree<double>>("KdTree<double>");
    if (course.field && wanted("HeightField")) subjects_.push_back(subject("HeightField", course.field()));
#ifdef PULSECAST_BENCH_EMBREE
    for (const auto& [name, quality, robust] : {std::tuple{"Embree", RTC_BUILD_QUALITY_MEDIUM, false},
                                                std::tuple{"Embree high", RTC_BUILD_QUALITY_HIGH, false},
                                                std::tuple{"Embree high robust", RTC_BUILD_QUALITY_HIGH, true}})
      if (wanted(std::string(name) + " 1") || wanted(std::string(name) + " 8") || wanted(std::string(name) + " 16"))
        embree_.push_back({name, std::make_unique<EmbreeMesh>(course.mesh, quality, robust)});
#endif
  }

  void run() {
    for (const Group& group : groups_) run(group);
  }

 private:
  [[nodiscard]] bool wanted(const std::string& subject) const {
    return std::ranges::any_of(groups_, [&](const Group& group) { return report_.wanted(group.name + "/" + subject); });
  }

  template <class Index>
  void add(const std::string& name) {
    if (wanted(name)) subjects_.push_back(subject(name, std::make_shared<const TriangleMesh<Index>>(course_.mesh)));
  }

  void check(const Group& group, const Subject& subject, std::vector<Answer>& expected, const Bundles& some) {
    if (!linear_) linear_ = std::make_unique<TriangleMesh<Linear<>>>(course_.mesh);
    if (expected.empty()) expected = bench::answers(*linear_, some);
    auto found = subject.answers(some);
    if (subject.name == "HeightField")  // its triangles have other numbers
      for (std::size_t i = 0; i < found.size(); ++i)
        found[i].id = found[i].range == expected[i].range ? expected[i].id : found[i].id;
    if (found != expected) {
      std::printf("%s/%s DIFFERS from Linear\n", group.name.c_str(), subject.name.c_str());
      std::exit(1);
    }
  }

  void run(const Group& group) {
    std::vector<std::string> names;
    std::vector<std::function<void()>> works;
    double sum = 0;
    std::vector<Answer> expected;
    const Bundles some = group.bundles.sample(group.sampled);
    [[maybe_unused]] const Subject* checked = nullptr;
    for (const Subject& subject : subjects_) {
      const std::string name = group.name + "/" + subject.name;
      if (!report_.wanted(name) || (subject.single && group.subrays > 1)) continue;
      check(group, subject, expected, some);
      checked = &subject;
      names.push_back(name);
      works.emplace_back([&] { sum += subject.trace(group.bundles); });
    }
    const std::size_t ours = works.size();
#ifdef PULSECAST_BENCH_EMBREE
    add_embree<1>(report_, group, embree_, names, works, sum);
    add_embree<8>(report_, group, embree_, names, works, sum);
    add_embree<16>(report_, group, embree_, names, works, sum);
#endif
    if (works.empty()) return;
    report_.heading(group.name + ": " + std::to_string(course_.mesh.triangles.size()) + " triangles, " +
                    std::to_string(group.bundles.size()) + " bundles of " + std::to_string(group.subrays));
#ifdef PULSECAST_BENCH_EMBREE
    if (checked && !embree_.empty()) print_agreement(report_, group, embree_.back(), *checked);
#endif
    const std::vector<Times> times = report_.by_turns(works);
    keep(sum);
    std::size_t best = ours;  // of Embree's
    for (std::size_t i = ours; i < times.size(); ++i)
      if (median(times[i]) < median(times[best])) best = i;
    for (std::size_t i = 0; i < times.size(); ++i) {
      const double per_second = static_cast<double>(group.bundles.size()) / median(times[i]) / 1e6;
      Figures figures;
      if (group.subrays > 1) figures.emplace_back("Mbeams/s", per_second);
      figures.emplace_back("Mrays/s", per_second * static_cast<double>(group.subrays));
      if (best < times.size()) figures.emplace_back("of Embree's best", speed_ratio(times[i], times[best]));
      report_.row(names[i], figures);
    }
  }

  Report& report_;
  const Course& course_;
  std::vector<Group> groups_;
  std::vector<Subject> subjects_;
  std::unique_ptr<TriangleMesh<Linear<>>> linear_;
#ifdef PULSECAST_BENCH_EMBREE
  std::vector<EmbreeSubject> embree_;
#endif
};

}  // namespace

int main(int count, char** words) {
  Report report("trace", count, words);
  const auto race = [&](const Course& course) { Races(report, course).run(); };
  const auto beside = [&](const std::string& name, MeshData mesh) {
    const Box box = bounds_of(mesh);
    race({name, std::move(mesh), from_a_tripod(box), 0.3_mrad});
  };
  const Raster ground = hills(866);
  race(
      {"hills", ground.mesh(), from_the_air(), 0.25_mrad, [&] { return std::make_shared<const HeightField>(ground); }});
  beside("tree", tree());
  for (const std::string& file : report.files())
    beside(std::filesystem::path(file).stem().string() + ".obj", io::read_obj(file).mesh);
  race({"street", flattened(street::scene(1)), from_a_car(), 0.3_mrad});
}
