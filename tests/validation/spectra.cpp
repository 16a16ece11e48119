// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Reflectance at the laser's wavelength, by hand from the samples of a leaf-like spectrum.

#include <memory>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/base/units.hpp>
#include <pulsecast/scene/scene.hpp>
#include <pulsecast/shape/triangle_mesh.hpp>

#include "validation/one_pulse.hpp"
#include "validation/table.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;
using namespace pulsecast::validation;

TEST_CASE("reflectance of a leaf by wavelength") {
  using Mesh = TriangleMesh<>;
  Material leaf;
  leaf.spectrum = std::make_shared<const Spectrum>(std::vector<SpectralSample>{
      {400_nm, 0.05}, {700_nm, 0.08}, {750_nm, 0.45}, {1000_nm, 0.50}, {1400_nm, 0.30}, {1600_nm, 0.35}});
  const MeshData plate{{{-5, 10, -5}, {5, 10, -5}, {0, 10, 5}}, {{0, 1, 2}}, {}};
  const Scene<Mesh> scene({{std::make_shared<const Mesh>(plate), material_table({leaf}), {}, 1}});
  struct Case {
    double wavelength_nm, reflectance;
  };
  for (const Case& c :
       {Case{300, 0.05}, {532, 0.0632}, {725, 0.265}, {905, 0.481}, {1064, 0.468}, {1550, 0.3375}, {2000, 0.35}}) {
    const Result result = one_pulse(scene, SingleRay{}, Laser{.wavelength = c.wavelength_nm * 1e-9});
    REQUIRE(result.echoes.size() == 1);
    row("spectrum of six samples at " + std::to_string(static_cast<int>(c.wavelength_nm)) + " nm: reflectance",
        c.reflectance, result.echoes[0].reflectance, 1e-6);
  }
}
