// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Angular laws of reflection, measured: a plate of triangles that is turned before a scanner, by the reflectance of its
// echoes.

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include <doctest/doctest.h>

#include <pulsecast/base/units.hpp>
#include <pulsecast/material/phong.hpp>
#include <pulsecast/scene/scene.hpp>
#include <pulsecast/shape/triangle_mesh.hpp>

#include "validation/one_pulse.hpp"
#include "validation/table.hpp"

using namespace pulsecast;
using namespace pulsecast::validation;

namespace {

/// Reflectance of a plate 10 m ahead that is turned by an angle.
double measured(const Material& material, double angle) {
  using Mesh = TriangleMesh<>;
  const Vec3 across = rotation_about(axis::up, angle) * axis::right, centre{0, 10, 0};
  const MeshData plate{
      {centre - across - 3.0 * axis::up, centre + across - 3.0 * axis::up, centre + 2.0 * axis::up}, {{0, 1, 2}}, {}};
  const Scene<Mesh> scene({{std::make_shared<const Mesh>(plate), material_table({material}), {}, 1}});
  const Result result = one_pulse(scene, SingleRay{}, Laser{}, Receiver{});
  return result.echoes.empty() ? 0 : result.echoes[0].reflectance;
}

std::string at(double angle_deg) { return std::to_string(static_cast<int>(angle_deg)) + " degrees"; }

}  // namespace

TEST_CASE("Lambert against incidence") {
  const Material lambert{.reflectance = 0.5};
  for (const double angle_deg : {0.0, 20.0, 45.0, 60.0, 80.0, 89.0})
    row("Lambert, reflectance 0.5, " + at(angle_deg), 0.5 * std::cos(radians(angle_deg)),
        measured(lambert, radians(angle_deg)), 1e-6);
}

TEST_CASE("Phong against incidence") {
  const Material phong{.reflectance = 0.5, .law = Phong{0.3, 10}};
  for (const double angle_deg : {0.0, 20.0, 45.0, 60.0, 80.0}) {
    const double a = radians(angle_deg);
    // Source: Jutzi & Gross 2009; the lobe ends 90 degrees from the mirror direction
    const double closed = 0.5 * (0.7 * std::cos(a) + 0.3 * std::pow(std::max(0.0, std::cos(2 * a)), 10));
    row("Phong, reflectance 0.5, share 0.3, exponent 10, " + at(angle_deg), closed, measured(phong, a), 1e-6);
  }
}

TEST_CASE("a surface that is the same from everywhere") {
  const Material same{.reflectance = 0.5, .law = DirectionIndependent{}};
  for (const double angle_deg : {0.0, 60.0})
    row("direction independent, reflectance 0.5, " + at(angle_deg), 0.5, measured(same, radians(angle_deg)), 1e-6);
}
