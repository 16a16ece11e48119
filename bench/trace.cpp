// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Cost of tracing on one thread: rays a second of beams and of single rays, by scene and accelerator, and beside them
// Embree 3 on the same rays, alternating in the same run. A row is printed only once the accelerator has given the same
// hits as `Linear`, bit by bit, on a sample; for Embree the share of equal ranges is printed.
//
// Rows are named scene/rays/accelerator, as in `--only '*/19/Bvh<float>'`. Rays are beams of 7, 19 and 61 subrays, or
// single ones: along a scan, of a camera, from there to the sun (`shadow`), or between random places (`incoherent`);
// those to the sun, and `incoherent any`, end at any hit. An OBJ file in metres, if one is given, is scanned as a scene
// of its own. A ratio is to the best of Embree's ways for these rays: one by one, or of a beam in packets of 8 or 16,
// in trees of both build qualities; the robust one of its best with the flag `robust`.

#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
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

/// Rays that are traced together: beams of one size, or single rays.
struct Group {
  std::string name;
  Bundles bundles;
  std::size_t subrays;       ///< in each
  std::size_t sampled = 32;  ///< bundles that `Linear` traces, too
  bool any = false;          ///< the rays end at any hit
};

/// Something that rays are traced in.
struct Subject {
  std::string name;
  std::function<double(const Group&)> trace;
  std::function<std::vector<Answer>(const Group&, const Bundles&)> answers;
};

template <class Shape>
Subject subject(const std::string& name, std::shared_ptr<const Shape> shape) {
  return {name,
          [shape](const Group& group) {
            if (group.subrays > 1) return sum_of_ranges(*shape, group.bundles);
            double sum = 0;
            for (std::size_t i = 0; i < group.bundles.size(); ++i)
              sum += answer_alone(*shape, group.bundles.ray(i), group.any).range;
            return sum;
          },
          [shape](const Group& group, const Bundles& some) {
            if (group.subrays > 1) return answers(*shape, some);
            std::vector<Answer> found;
            for (std::size_t i = 0; i < some.size(); ++i) found.push_back(answer_alone(*shape, some.ray(i), group.any));
            return found;
          }};
}

struct Course {
  std::string name;
  MeshData mesh;
  Aims aims;
  double divergence;
  Vec3 eye, at;                                                 ///< place of a camera, and its aim
  std::function<std::shared_ptr<const HeightField>()> field{};  ///< the same ground as one; empty if there is none
};

std::vector<Group> groups(const Course& course) {
  std::vector<Group> all;
  const auto name = [&](const std::string& rays) { return course.name + "/" + rays; };
  for (const std::size_t subrays : {7U, 19U, 61U})
    all.push_back({name(std::to_string(subrays)), beams(course.aims, subrays, course.divergence), subrays, 16});
  all.push_back({name("scan"), beams(course.aims, 1, course.divergence), 1});
  all.push_back({name("camera"), camera_rays(course.eye, course.at), 1});
  all.push_back({name("shadow"), shadow_rays(TriangleMesh<>(course.mesh), all.back().bundles), 1, 32, true});
  all.push_back({name("incoherent"), incoherent_rays(bounds_of(course.mesh), 4 * pulse_count), 1});
  all.push_back({name("incoherent any"), all.back().bundles, 1, 32, true});
  return all;
}

#ifdef PULSECAST_BENCH_EMBREE

/// A tree of Embree's.
struct Rival {
  std::unique_ptr<EmbreeMesh> mesh;
  bool robust;
};

/// Adds the rays of a group, in packets of a width, in all trees.
template <std::size_t Width>
void add_rivals(const Group& group, const std::vector<Rival>& rivals, std::vector<std::function<void()>>& works,
                double& sum) {
  const auto rays = std::make_shared<EmbreeRays<Width>>(group.bundles, group.subrays > 1);
  for (const Rival& rival : rivals)
    works.emplace_back([rays, mesh = rival.mesh.get(), &sum, &group] {
      [[maybe_unused]] const bool any = group.any;
      if constexpr (Width == 1)
        if (any) return void(sum += rays->occluded(*mesh));
      sum += rays->sum_of_ranges(*mesh);
    });
}

/// Shares of the rays that meet something, and of Embree's ranges that equal ours up to single precision.
Figures agreement(Group group, const EmbreeMesh& embree, const Subject& ours) {
  group.any = false;
  const auto theirs = EmbreeRays<1>(group.bundles, true).ranges(embree);
  const auto expected = ours.answers(group, group.bundles);
  std::size_t same = 0, met = 0;
  for (std::size_t i = 0; i < theirs.size(); ++i) {
    const bool both = std::isfinite(theirs[i]) && std::isfinite(expected[i].range);
    met += std::isfinite(expected[i].range) ? 1U : 0U;
    same += both ? std::fabs(theirs[i] - expected[i].range) < 1e-5 * expected[i].range + 1e-3
                 : std::isfinite(theirs[i]) == std::isfinite(expected[i].range);
  }
  const double percent = 100 / static_cast<double>(theirs.size());
  if (percent * static_cast<double>(same) < 98) {
    std::printf("%s: these are not the same rays\n", group.name.c_str());
    std::exit(1);
  }
  return {{"% hit", percent * static_cast<double>(met)}, {"% equal", percent * static_cast<double>(same)}};
}

#endif

class Races {
 public:
  Races(Report& report, const Course& course) : report_(report), course_(course), groups_(groups(course)) {
    add<Bvh<float>>("Bvh<float>");
    add<Bvh<double>>("Bvh<double>");
    add<KdTree<float>>("KdTree<float>");
    add<KdTree<double>>("KdTree<double>");
    if (course.field && wanted("HeightField")) subjects_.push_back(subject("HeightField", course.field()));
    if (subjects_.empty()) return;
    linear_ = subject("Linear", std::make_shared<const TriangleMesh<Linear<>>>(course.mesh));
#ifdef PULSECAST_BENCH_EMBREE
    for (const bool robust : {false, true})
      for (const RTCBuildQuality quality : {RTC_BUILD_QUALITY_MEDIUM, RTC_BUILD_QUALITY_HIGH})
        rivals_.push_back({std::make_unique<EmbreeMesh>(course.mesh, quality, robust), robust});
#endif
  }

  void run() {
    report_.heading(course_.name + ": " + std::to_string(course_.mesh.triangles.size()) + " triangles, " +
                    std::to_string(pulse_count) + " beams");
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

  void check(const Group& group, const Subject& subject, const std::vector<Answer>& expected, const Bundles& some) {
    auto found = subject.answers(group, some);
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
    const Bundles some = group.bundles.sample(group.sampled);
    std::vector<Answer> expected;
    for (const Subject& subject : subjects_) {
      const std::string name = group.name + "/" + subject.name;
      if (!report_.wanted(name)) continue;
      if (expected.empty()) expected = linear_.answers(group, some);
      check(group, subject, expected, some);
      names.push_back(name);
      works.emplace_back([&] { sum += subject.trace(group); });
    }
    if (works.empty()) return;
#ifdef PULSECAST_BENCH_EMBREE
    add_rivals<1>(group, rivals_, works, sum);
    if (group.subrays > 1) add_rivals<8>(group, rivals_, works, sum);
    if (group.subrays > 1) add_rivals<16>(group, rivals_, works, sum);
#endif
    const std::vector<Times> times = report_.by_turns(works);
    keep(sum);
    const double rays = static_cast<double>(group.bundles.size() * group.subrays);
    for (std::size_t i = 0; i < names.size(); ++i) {
      Figures figures{{"Mrays/s", rays / median(times[i]) / 1e6}};
#ifdef PULSECAST_BENCH_EMBREE
      const std::string embree = embree_name();
      for (const bool robust : {false, true}) {
        const Times* best = nullptr;
        for (std::size_t k = names.size(); k < times.size(); ++k)
          if (rivals_[(k - names.size()) % rivals_.size()].robust == robust &&
              (!best || median(times[k]) < median(*best)))
            best = &times[k];
        if (!robust) figures.emplace_back(embree, rays / median(*best) / 1e6);
        figures.emplace_back("of " + embree + (robust ? " robust" : ""), speed_ratio(times[i], *best));
      }
      for (const auto& share : agreement(group, *rivals_.back().mesh, subjects_.front())) figures.push_back(share);
#endif
      report_.row(names[i], figures);
    }
  }

  Report& report_;
  const Course& course_;
  std::vector<Group> groups_;
  std::vector<Subject> subjects_;
  Subject linear_;
#ifdef PULSECAST_BENCH_EMBREE
  std::vector<Rival> rivals_;
#endif
};

}  // namespace

int main(int count, char** words) {
  Report report("trace", count, words);
  const auto race = [&](const Course& course) { Races(report, course).run(); };
  const auto beside = [&](const std::string& name, MeshData mesh) {
    const Box box = bounds_of(mesh);
    race({name, std::move(mesh), from_a_tripod(box), 0.3_mrad, box.centre() + Vec3{14, 3, -2}, box.centre()});
  };
  const Raster ground = hills(866);
  race({"hills", ground.mesh(), from_the_air(), 0.25_mrad, {-300, -300, 120}, {0, 0, 0}, [&] {
          return std::make_shared<const HeightField>(ground);
        }});
  beside("tree", tree());
  for (const std::string& file : report.files())
    beside(std::filesystem::path(file).stem().string() + ".obj", io::read_obj(file).mesh);
  race({"street", flattened(street::scene(1)), from_a_car(), 0.3_mrad, street::on({1.2, -40}) + Vec3{0, 0, 2},
        street::on({1.2, 20}) + Vec3{0, 0, 1}});
}
