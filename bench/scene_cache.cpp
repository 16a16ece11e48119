// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Time saved by a scene cache: hills as an OBJ file, loaded and built, and then opened from their cache. Usage:
// bench_scene_cache [TRIANGLES], by default 6,000,000. The files are in the system's folder for temporary files, and
// are removed.

#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <pulsecast/io/detail/text/output.hpp>
#include <pulsecast/io/obj.hpp>
#include <pulsecast/io/output_file.hpp>
#include <pulsecast/io/scene_cache.hpp>
#include <pulsecast/pulsecast.hpp>

using namespace pulsecast;
using namespace pulsecast::io;

namespace {

using Terrain = Scene<TriangleMesh<>>;

/// Hills, 1 km by 1 km, of 2 * cells^2 triangles.
void write_hills(const std::filesystem::path& path, int cells) {
  OutputFile file(path);
  TextRow row;
  const double step = 1000.0 / cells;
  for (int j = 0; j <= cells; ++j)
    for (int i = 0; i <= cells; ++i) {
      const double x = i * step, y = j * step;
      file.write("v ");
      file.write(
          row.add(x, 3).add(y, 3).add(20 * std::sin(x / 90) * std::cos(y / 70) + std::sin(x / 7 + y / 11), 3).end());
    }
  for (int j = 0; j < cells; ++j)
    for (int i = 1; i <= cells; ++i) {
      const int a = j * (cells + 1) + i, c = a + cells + 1;
      file.write("f ");
      file.write(row.add(a).add(a + 1).add(c + 1).end());
      file.write("f ");
      file.write(row.add(a).add(c + 1).add(c).end());
    }
  file.commit();
}

struct Run {
  double seconds, height;
  bool from_cache;
};

Run run(const std::filesystem::path& obj, const std::filesystem::path& cache) {
  const auto begin = std::chrono::steady_clock::now();
  const auto made = cached_scene<Terrain>(cache, {.files = {obj}}, [&] {
    ObjModel model = read_obj(obj);
    model.materials[0].ground = true;
    return std::vector<Terrain::Part>{{.geometry = std::make_shared<const TriangleMesh<>>(std::move(model.mesh)),
                                       .materials = material_table(std::move(model.materials))}};
  });
  const std::chrono::duration<double> time = std::chrono::steady_clock::now() - begin;
  if (!made.warning.empty()) std::printf("%s\n", made.warning.c_str());
  return {time.count(), made.scene.ground_height({333, 444}).value_or(-1e9), made.from_cache};
}

}  // namespace

int main(int count, char** arguments) {
  const double triangles = count > 1 ? std::atof(arguments[1]) : 6e6;
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "pulsecast_bench_scene_cache";
  std::filesystem::create_directory(folder);
  const std::filesystem::path obj = folder / "hills.obj", cache = folder / "hills.cache";
  std::filesystem::remove(cache);
  write_hills(obj, static_cast<int>(std::ceil(std::sqrt(triangles / 2))));

  const Run built = run(obj, cache);
  std::printf("%.0f triangles: OBJ of %.0f MB, cache of %.0f MB\n", triangles,
              static_cast<double>(file_size(obj)) / 1e6, static_cast<double>(file_size(cache)) / 1e6);
  std::printf("loading, building and saving: %.2f s\n", built.seconds);
  int wrong = built.from_cache ? 1 : 0;
  for (int i = 0; i < 5; ++i) {
    const Run opened = run(obj, cache);
    wrong += !opened.from_cache || opened.height != built.height ? 1 : 0;
    std::printf("opening: %.3f s, 1 / %.0f\n", opened.seconds, built.seconds / opened.seconds);
  }
  std::filesystem::remove_all(folder);
  if (wrong > 0) std::printf("%d runs were not from where they should be, or differ\n", wrong);
  return wrong;
}
