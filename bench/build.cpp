// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Cost of building a mesh: million triangles a second, by wall-clock and processor time, and bytes a triangle, for tree
// and triangles together; beside it Embree 3, at its medium and its high build quality, alternating in the same run. A
// row is printed only once the mesh has given the same answers as `Linear` on a sample. Rows are named
// scene/accelerator/threads. An OBJ file in metres, if one is given, is a scene of its own. Embree's bytes are those of
// its tree with vertices and corners in single precision; its peak memory stands beside them.

#include <concepts>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <string>
#include <thread>
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

/// A builder among others: what it took, round by round.
struct Entrant {
  std::string name;
  std::function<void(Entrant&)> go;
  Times wall{}, processor{};
  double bytes = 0, max_bytes = 0;
};

template <class Shape>
void check(const std::string& name, const Shape& shape, const MeshData& mesh) {
  const Bundles some = incoherent_rays(bounds_of(mesh), 32);
  if (answers(shape, some) == answers(TriangleMesh<Linear<>>(mesh), some)) return;
  std::printf("%s DIFFERS from Linear\n", name.c_str());
  std::exit(1);
}

/// On `threads` threads, if the number can be set.
template <class Shape>
Shape build(MeshData mesh, [[maybe_unused]] unsigned threads) {
  if constexpr (std::constructible_from<Shape, MeshData, unsigned>)
    return Shape(std::move(mesh), threads);
  else
    return Shape(std::move(mesh));
}

template <class Shape>
Entrant ours(const std::string& name, const MeshData& mesh, unsigned threads) {
  return {name, [&mesh, threads](Entrant& self) {
            MeshData data = mesh;  // the mesh takes it over: a copy is not its cost
            const double wall = wall_seconds(), processor = process_seconds();
            const Shape made = build<Shape>(std::move(data), threads);
            self.wall.push_back(wall_seconds() - wall);
            self.processor.push_back(process_seconds() - processor);
            if (self.bytes == 0) check(self.name, made, mesh);
            self.bytes = static_cast<double>(made.memory());
          }};
}

/// Adds it for one thread, and for all if the number can be set.
template <class Shape>
void add(std::vector<Entrant>& all, const std::string& name, const MeshData& mesh) {
  all.push_back(ours<Shape>(name + "/1", mesh, 1));
  const unsigned most = std::thread::hardware_concurrency();
  if constexpr (std::constructible_from<Shape, MeshData, unsigned>)
    if (most > 1) all.push_back(ours<Shape>(name + "/" + std::to_string(most), mesh, most));
}

#ifdef PULSECAST_BENCH_EMBREE
void add_embree(std::vector<Entrant>& all, const std::string& name, const MeshData& mesh, RTCBuildQuality quality) {
  const unsigned most = std::thread::hardware_concurrency();
  for (unsigned threads = 1; threads <= most; threads = threads == most ? most + 1 : most)
    all.push_back({name + "/" + std::to_string(threads), [&mesh, quality, threads](Entrant& self) {
                     const EmbreeMesh made(mesh, quality, false, threads);
                     self.wall.push_back(made.build_wall_seconds());
                     self.processor.push_back(made.build_seconds());
                     self.bytes = made.bytes();
                     self.max_bytes = made.max_bytes();
                   }});
}
#endif

void measure(Report& report, const std::string& scene, const MeshData& mesh) {
  std::vector<Entrant> all;
  add<TriangleMesh<Bvh<float>>>(all, scene + "/Bvh<float>", mesh);
  add<TriangleMesh<Bvh<double>>>(all, scene + "/Bvh<double>", mesh);
  add<TriangleMesh<KdTree<float>>>(all, scene + "/KdTree<float>", mesh);
#ifdef PULSECAST_BENCH_EMBREE
  add_embree(all, scene + "/" + embree_name(), mesh, RTC_BUILD_QUALITY_MEDIUM);
  add_embree(all, scene + "/" + embree_name() + " high", mesh, RTC_BUILD_QUALITY_HIGH);
#endif
  std::erase_if(all, [&](const Entrant& entrant) { return !report.wanted(entrant.name); });
  if (all.empty()) return;
  const double count = static_cast<double>(mesh.triangles.size());
  report.heading(scene + ": " + std::to_string(mesh.triangles.size()) + " triangles, " +
                 std::to_string(mesh.vertices.size()) + " vertices");
  const int rounds = count > 5e5 ? (report.rounds() + 1) / 2 : report.rounds();
  for (int round = 0; round < rounds; ++round)
    for (Entrant& entrant : all) entrant.go(entrant);
  for (const Entrant& entrant : all) {
    Figures figures{{"Mtriangles/s", count / median(entrant.wall) / 1e6},
                    {"by processor time", count / median(entrant.processor) / 1e6},
                    {"bytes/triangle", entrant.bytes / count}};
    if (entrant.max_bytes > 0) figures.emplace_back("bytes/triangle at most", entrant.max_bytes / count);
    report.row(entrant.name, figures);
  }
}

}  // namespace

int main(int count, char** words) {
  Report report("build", count, words);
  measure(report, "hills", hills(866).mesh());
  measure(report, "tree", tree());
  for (const std::string& file : report.files())
    measure(report, std::filesystem::path(file).stem().string() + ".obj", io::read_obj(file).mesh);
  measure(report, "street", flattened(street::scene(1)));
  const Raster raster = hills(866);
  if (report.wanted("hills/HeightField/1")) {
    Times times;
    std::size_t bytes = 0;
    for (int round = 0; round < report.rounds(); ++round) {
      Raster copy = raster;
      const double start = wall_seconds();
      const HeightField field(std::move(copy));
      times.push_back(wall_seconds() - start);
      bytes = field.memory();
    }
    const double triangles = 2 * 866.0 * 866.0;
    report.heading("the same hills as a raster");
    report.row("hills/HeightField/1", {{"Mtriangles/s", triangles / median(times) / 1e6},
                                       {"bytes/triangle", static_cast<double>(bytes) / triangles}});
  }
}
