// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// A user-defined law of scattered light: that of Minnaert (Astrophysical Journal 93, 1941), beside Lambert's.
#include <cmath>
#include <iostream>
#include <memory>

#include <pulsecast/pulsecast.hpp>
#include <pulsecast/transport/light_paths.hpp>

using namespace pulsecast;
using namespace pulsecast::literals;

struct Minnaert {
  using refinements = pulsecast::refines<tag::ScattersBetween, tag::Validated>;
  double k = 2;

  void validate() const { require_within("Minnaert::k", k, 1, 10, ""); }
  double backscatter(double cosine, const SurfaceLight& light) const noexcept {
    return light.reflectance * std::pow(cosine, 2 * k - 1);
  }
  double scattered_share(double cosine, const SurfaceLight& light) const noexcept {
    return 2 / (k + 1) * light.reflectance * std::pow(cosine, k - 1);
  }
  double scattered(const Vec3& in, const Vec3& out, const Vec3& normal, const SurfaceLight& light) const noexcept {
    return light.reflectance * std::pow(dot(in, normal) * dot(out, normal), k - 1) * dot(out, normal);
  }
};
static_assert(ScattersBetween<Minnaert>);

int main() {
  const MeshData ground{.vertices = {{-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}, {-9, 9, 9}, {9, 9, 9}},
                        .triangles = {{0, 1, 2}, {0, 2, 3}, {3, 2, 5}, {3, 5, 4}}};
  const auto mesh = std::make_shared<const TriangleMesh<>>(ground);
  const Deflector mirror{OscillatingMirror{.half_angle = 30_deg}, Scanner{.pulses = 2'000}};
  const Platform platform{Tripod{}, Mount{.lever_arm = {0, 0, 3}, .boresight = rotation_about(axis::right, -20_deg)},
                          mirror};
  const auto scan = [&](const Material& material, const auto& transport) {
    const Scene<TriangleMesh<>> scene({{.geometry = mesh, .materials = material_table({material})}});
    Cloud cloud;
    const EnergyLedger energy =
        run(Survey{platform, SingleRay{}, scene, transport, Receiver{}, FirstHit{}}, {}, cloud).energy;
    double reflectance = 0;
    for (const Echo& echo : cloud.echoes) reflectance += echo.reflectance;
    std::cout << cloud.size() << std::hexfloat << ' ' << reflectance << ' ' << energy.received << ' '
              << energy.scattered << ' ' << energy.absorbed << '\n';
  };
  for (const Material& material : {Material{.name = "snow", .reflectance = 0.7},
                                   Material{.name = "regolith", .reflectance = 0.7, .law = Minnaert{}}}) {
    scan(material, DirectLight{});
    scan(material, LightPaths{.scattering = {.orders = 2}});
  }
}
