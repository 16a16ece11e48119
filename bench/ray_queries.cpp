// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Queries of single rays in the tree of `bench_trace`, for callgrind to count: each function below asks the same rays,
// spread over the whole tree. Compare the counts of `rays_closest_hit` and `rays_occluded` with that of
// `rays_by_bundle`. Prints what each found.
//
//     g++ -std=c++20 -O2 -DNDEBUG -Iinclude bench/ray_queries.cpp -o ray_queries -pthread
//     valgrind --tool=callgrind --toggle-collect='rays_*' ./ray_queries
//     callgrind_annotate --inclusive=yes callgrind.out.* | grep rays_

#include <cstddef>
#include <cstdio>
#include <memory>
#include <span>
#include <vector>

#include <pulsecast/pulsecast.hpp>

#include "scenes.hpp"

using namespace bench;
using Mesh = TriangleMesh<>;

extern "C" {

/// The closest hit of a bundle of one, with its backscatter, as `Scene::closest` finds it.
[[gnu::noinline]] std::size_t rays_by_bundle(const Scene<Mesh>& scene, std::span<const Ray> rays) {
  std::size_t met = 0;
  Hit hit;
  for (const Ray& ray : rays) {
    scene.closest(bundle_of(ray), {&hit, 1});
    met += hit.met() ? 1U : 0U;
  }
  return met;
}

[[gnu::noinline]] std::size_t rays_closest_hit(const Scene<Mesh>& scene, std::span<const Ray> rays) {
  std::size_t met = 0;
  for (const Ray& ray : rays) met += scene.closest_hit(ray) ? 1U : 0U;
  return met;
}

[[gnu::noinline]] std::size_t rays_occluded(const Scene<Mesh>& scene, std::span<const Ray> rays) {
  std::size_t met = 0;
  for (const Ray& ray : rays) met += scene.occluded(ray) ? 1U : 0U;
  return met;
}

[[gnu::noinline]] std::size_t rays_all_hits(const Scene<Mesh>& scene, std::span<const Ray> rays) {
  std::size_t met = 0;
  for (const Ray& ray : rays) met += scene.all_hits(ray, [](const RayHit&) noexcept {});
  return met;
}

/// The closest hit with its surface.
[[gnu::noinline]] std::size_t rays_surface(const Scene<Mesh>& scene, std::span<const Ray> rays) {
  std::size_t met = 0;
  for (const Ray& ray : rays)
    if (const auto hit = scene.closest_hit(ray)) met += scene.surface(*hit, ray).front ? 1U : 0U;
  return met;
}

}  // extern "C"

int main() {
  const auto leaves = std::make_shared<const Mesh>(tree());
  const MaterialTable materials = material_table(std::vector<Material>(leaves->material_count()));
  const Scene<Mesh> scene({{.geometry = leaves, .materials = materials}});
  const Bundles bundles = incoherent_rays(leaves->bounds(), 20'000);
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < bundles.size(); ++i) rays.push_back(bundles[i].ray(0));
  std::printf("%zu rays: by_bundle %zu, closest_hit %zu, occluded %zu, all_hits %zu, surface %zu\n", rays.size(),
              rays_by_bundle(scene, rays), rays_closest_hit(scene, rays), rays_occluded(scene, rays),
              rays_all_hits(scene, rays), rays_surface(scene, rays));
}
