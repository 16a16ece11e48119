// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// The same work every time, for `budget.sh` to count its instructions: `bench_instructions` runs each function below
// once. What is counted happens in these functions; what is made before them, is not. Prints a sum over what each
// found.

#include <cmath>
#include <cstddef>
#include <cstdio>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <pulsecast/material/phong.hpp>
#include <pulsecast/pulsecast.hpp>
#include <pulsecast/shape/height_field.hpp>

#include "scenes.hpp"
#include "surveys.hpp"

using namespace bench;

namespace {

/// Runs a survey on one thread, from the source to the batches; the sum of its ranges.
template <class Survey>
double sum_of_echoes(const Survey& survey) {
  double sum = 0;
  run(survey, {.threads = 1}, [&sum](const EchoBatch& batch) {
    for (const Echo& echo : batch.echoes) sum += echo.range;
  });
  return sum;
}

/// A scene of one mesh of one material.
Scene<Mesh> scene_of(const std::shared_ptr<const Mesh>& mesh, const Material& material) {
  return Scene<Mesh>({{.geometry = mesh, .materials = material_table({material})}});
}

/// Rays from where a robot drives in the street to anywhere.
std::vector<Ray> rays_of_a_robot(std::size_t count) {
  wood::Dice dice(23, 0);
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < count; ++i) {
    const double turn = dice.between(0, 2 * pi), z = dice.between(-0.4, 0.4), aside = std::sqrt(1 - z * z);
    const Vec3 place = street::on({1.2, dice.between(-60, 60)}) + Vec3{0, 0, 1.1};
    rays.push_back({.origin = place, .direction = {aside * std::cos(turn), aside * std::sin(turn), z}});
  }
  return rays;
}

}  // namespace

extern "C" {

/// Beams and single rays, in a mesh, in a tree's leaves and in a height field.
[[gnu::noinline]] double budget_trace(const Mesh& ground, const HeightField& field, const Bundles& from_above,
                                      const Mesh& tree, const Bundles& from_aside, const Bundles& incoherent) {
  return sum_of_ranges(ground, from_above) + sum_of_ranges(field, from_above) + sum_of_ranges(tree, from_aside) +
         sum_of_ranges(tree, incoherent);
}

/// Two whole surveys.
[[gnu::noinline]] double budget_pipeline(const Scene<Mesh>& hills, const Scene<Mesh>& street) {
  return sum_of_echoes(Survey{airplane(3'000), SunflowerFootprint{19}, hills, Receiver{}, FullWaveform{}}) +
         sum_of_echoes(Survey{car(3'000), SunflowerFootprint{7}, street, Receiver{}, FullWaveform{}});
}

/// The survey of a scene of two triangles: the cost of a pulse outside of the tree.
[[gnu::noinline]] double budget_simple_scene(const Scene<Mesh>& plane) {
  return sum_of_echoes(Survey{airplane(6'000), SunflowerFootprint{19}, plane, Receiver{}, FullWaveform{}});
}

/// A program of its own that asks for one ray at a time, or for one pulse.
[[gnu::noinline]] double budget_single_rays(const Scene<Mesh>& street, std::span<const Ray> rays) {
  double sum = 0;
  Hit hit;
  for (const Ray& ray : rays) {
    street.closest(bundle_of(ray), {&hit, 1});
    sum += hit.met() ? hit.range : 0;
  }
  const Survey survey{car(6'000), SingleRay{}, street, Receiver{}, FirstHit{}};
  auto workspace = survey.workspace();
  for (PulseIndex i = 0; i < survey.size(); ++i)
    for (const Echo& echo : survey(i, workspace).echoes) sum += echo.range;
  return sum;
}

/// The survey of Lambertian surfaces that `budget_glossy_surfaces` makes of glossy ones.
[[gnu::noinline]] double budget_matt_surfaces(const Scene<Mesh>& hills) {
  return sum_of_echoes(Survey{airplane(3'000), SunflowerFootprint{19}, hills, Receiver{}, FullWaveform{}});
}

/// The survey of surfaces with a glossy lobe.
[[gnu::noinline]] double budget_glossy_surfaces(const Scene<Mesh>& hills) {
  return sum_of_echoes(Survey{airplane(3'000), SunflowerFootprint{19}, hills, Receiver{}, FullWaveform{}});
}

}  // extern "C"

int main() {
  const Raster raster = hills(150);
  const auto some = [](const Bundles& all) { return all.sample(1024); };
  const auto ground = std::make_shared<const Mesh>(raster.mesh());
  const Mesh leaves(tree());
  const auto town = street::scene(1);
  std::printf("trace %.9g\n", budget_trace(*ground, HeightField(raster), some(beams(from_the_air(), 19, 0.25_mrad)),
                                           leaves, some(beams(from_a_tripod(leaves.bounds()), 19, 0.3_mrad)),
                                           incoherent_rays(leaves.bounds(), 2048)));
  std::printf("pipeline %.9g\n", budget_pipeline(scene_of(ground, {}), town));

  const auto plane = std::make_shared<const Mesh>(
      MeshData{.vertices = {{-500, -500, 0}, {500, -500, 0}, {500, 500, 0}, {-500, 500, 0}},
               .triangles = {{0, 1, 2}, {0, 2, 3}}});
  std::printf("simple_scene %.9g\n", budget_simple_scene(scene_of(plane, {})));
  std::printf("single_rays %.9g\n", budget_single_rays(town, rays_of_a_robot(6'000)));
  std::printf("matt_surfaces %.9g\n", budget_matt_surfaces(scene_of(ground, {})));
  const Material glossy{.law = Phong{0.5, 10}};
  std::printf("glossy_surfaces %.9g\n", budget_glossy_surfaces(scene_of(ground, glossy)));
}
