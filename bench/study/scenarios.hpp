// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <pulsecast/pulsecast.hpp>
#include <pulsecast/shape/height_field.hpp>
#include <pulsecast/shape/leaf_angles.hpp>

#include "../../examples/street.hpp"
#include "../../examples/wood.hpp"
#include "pulses.hpp"
#include "shapes.hpp"

/// Scenes and platforms of the scenarios, and alternative models of the scenes.
namespace tradeoff {

using namespace pulsecast::literals;

/// A scene of any of the kinds that are compared.
using Map = std::variant<std::shared_ptr<const Scene<Mesh>>, std::shared_ptr<const Scene<ExactMesh>>,
                         std::shared_ptr<const Scene<HeightField>>, std::shared_ptr<const Scene<Mesh, Solid>>,
                         std::shared_ptr<const Scene<Mesh, Foliage>>>;

/// Another form of the scene.
struct Form {
  std::string name;
  Map map;
};

struct Scenario {
  std::string name, title;
  Map map{}, exact{};         ///< of meshes, in single and in double precision
  std::vector<Form> forms{};  ///< besides
  Pulses pulses{};
  double threshold = 0;  ///< [W]
  double gate = 0.3;     ///< how far apart echoes of two settings may be and be the same: half the pulse [m]
  std::function<double(const Vec2&)>
      ground{};         ///< height of the ground where plants stand [m]; empty if there are none
  bool turned = false;  ///< footprints are tried turned by 30 degrees, too
};

template <class S>
[[nodiscard]] Map shared(S&& scene) {
  return std::make_shared<const std::remove_cvref_t<S>>(std::forward<S>(scene));
}

/// Pulses whose beams hit more than one object: of the rays out to 1.2 radii some differ in their primitives, or in
/// range by a hand's breadth.
template <class AnyScene>
[[nodiscard]] auto meets_an_edge(const AnyScene& scene, const Laser& laser) {
  return [&scene, &laser, footprint = SunflowerFootprint(37),
          hits = std::vector<Hit>(RayBundle::capacity)](const Pulse<frame::World>& pulse) mutable {
    RayBundle rays;
    rays.origin = pulse.origin();
    rays.size = footprint.size();
    for (std::size_t j = 0; j < rays.size; ++j)
      rays.set_direction(j, pulse.pose.rotation * subray_direction(0.8 * footprint.offset(j), laser.divergence));
    rays.pad();
    scene.closest(rays, hits);
    for (std::size_t j = 1; j < rays.size; ++j)
      if (hits[j].met() != hits[0].met() || hits[j].object != hits[0].object ||
          std::fabs(hits[j].range - hits[0].range) > 0.05)
        return true;
    return false;
  };
}

/// Rough ground, 350 m by 350 m in pixels of half a metre, or of several times that.
[[nodiscard]] inline Raster rough_ground(std::uint32_t every) {
  constexpr double side = 350;
  const std::uint32_t cells = 700 / every;
  const double pixel = side / cells;
  Raster raster{.columns = cells + 1, .rows = cells + 1, .first = {-side / 2, side / 2}, .pixel = {pixel, pixel}};
  for (std::uint32_t r = 0; r <= cells; ++r)
    for (std::uint32_t c = 0; c <= cells; ++c) {
      const double x = c * pixel, y = r * pixel;
      raster.heights.push_back(
          static_cast<float>(25 * wood::noise(11, x / 130, y / 130) + 4 * wood::noise(12, x / 31, y / 31) +
                             0.6 * wood::noise(13, x / 6, y / 6) + 0.15 * wood::noise(14, x / 1.1, y / 1.1)));
    }
  return raster;
}

[[nodiscard]] inline Scenario terrain(std::size_t pulses) {
  Scenario s{.name = "terrain", .title = "Terrain from 1,500 m", .threshold = 20_nW};
  const auto soil = material_table({{.name = "soil", .reflectance = 0.3, .classification = 2, .ground = true}});
  const auto mesh = [&](std::uint32_t every) {
    return Scene<Mesh>({{.geometry = std::make_shared<const Mesh>(rough_ground(every).mesh()), .materials = soil}});
  };
  const auto field = [&](std::uint32_t every) {
    return Scene<HeightField>(
        {{.geometry = std::make_shared<const HeightField>(rough_ground(every)), .materials = soil}});
  };
  const Scene<Mesh> whole = mesh(1);
  s.exact = shared(in_double(whole));
  s.map = shared(whole);
  s.forms.push_back({"height field", shared(field(1))});
  for (const std::uint32_t every : {2U, 4U, 10U}) {
    const std::string pixels = " of " + std::to_string(every / 2) + " m";
    s.forms.push_back({"mesh" + pixels, shared(mesh(every))});
    s.forms.push_back({"height field" + pixels, shared(field(every))});
  }
  const Laser laser{.wavelength = 1550_nm, .peak_power = 5000_W, .pulse_length = 4_ns, .divergence = 0.25_mrad};
  const Platform airplane{StraightLine{.from = {0, -150, 1500}, .to = {0, 150, 1500}, .speed = 60},
                          Mount{.boresight = extrinsic({{axis::right, -90_deg}, {axis::up, -90_deg}})},
                          Deflector{OscillatingMirror{.cycle_rate = 50_Hz, .half_angle = 5.5_deg},
                                    Scanner{.pulse_rate = 100_kHz, .pulses = 500'000, .laser = laser}}};
  s.pulses = sampled(airplane, pulses);
  return s;
}

[[nodiscard]] inline bool is_leaf(std::uint32_t material) noexcept {
  return material == wood::leaf || material == wood::birch_leaf || material == wood::needle;
}

[[nodiscard]] inline Scene<Mesh> with_fewer_leaves(const Scene<Mesh>& scene, std::size_t one_in) {
  return remade<Mesh>(scene, [&](const MeshData& data) { return with_fewer_leaves(data, one_in, is_leaf); });
}

[[nodiscard]] inline Scenario wood_from_a_tripod(std::size_t pulses) {
  Scenario s{.name = "wood_tripod", .title = "A wood from a tripod", .threshold = 500_nW};
  const wood::Scene whole = wood::scene(1);
  s.exact = shared(in_double(whole));
  for (const std::size_t one_in : {2U, 4U, 8U})
    s.forms.push_back({"one leaf in " + std::to_string(one_in), shared(with_fewer_leaves(whole, one_in))});
  s.map = shared(whole);
  s.ground = [terrain = wood::Terrain(1)](const Vec2& at) { return terrain.height(at); };
  const Laser laser{.wavelength = 1550_nm, .peak_power = 10_W, .pulse_length = 4_ns, .divergence = 0.35_mrad};
  const Scanner scanner{.pulse_rate = 100_kHz, .pulses = 3600 * 1800, .laser = laser};
  const Platform tripod{
      Tripod{.position = wood::glades(1).front()}, Mount{.lever_arm = {0, 0, 1.7}},
      Deflector{
          RotatingHead{.angular_rate = 360_deg / scanner.duration().seconds()},
          Deflector{PolygonMirror{.line_rate = 100_kHz * 0.1_deg / 180_deg, .sweep = 90_deg, .angle_min = -70_deg},
                    scanner}}};
  s.pulses = sampled(tripod, pulses);
  return s;
}

/// Broadleaved trees of two kinds on the ground of the wood, which is object 0.
template <class AnyScene, class Plant>
[[nodiscard]] AnyScene grove(Plant plant) {
  const wood::Terrain terrain(1);
  std::vector<typename AnyScene::Part> parts{
      {.geometry = std::make_shared<const Mesh>(terrain.mesh()), .materials = material_table(wood::materials())}};
  wood::Dice dice(1, 60);
  for (double x = -26; x <= 26; x += 6.5)
    for (double y = -26; y <= 26; y += 6.5) {
      const Vec2 at{x + dice.between(-1.5, 1.5), y + dice.between(-1.5, 1.5)};
      const std::size_t kind = dice.between(0, 1) < 0.5 ? 0 : 1;
      const Placement placement{rotation_about(axis::up, dice.between(0, 360_deg)), dice.between(0.8, 1.1),
                                terrain.on(at)};
      for (auto part : plant(kind)) {
        part.materials = material_table(wood::materials());
        part.placement = placement;
        part.object = static_cast<ObjectId>(parts.size());
        parts.push_back(std::move(part));
      }
    }
  return AnyScene(std::move(parts));
}

[[nodiscard]] inline Scenario wood_from_a_drone(std::size_t pulses) {
  Scenario s{.name = "wood_drone", .title = "A wood from a drone", .threshold = 1500_nW, .gate = 0.225};
  const std::array kinds{
      wood::broadleaf({}, wood::Dice(1, 1)),
      wood::broadleaf({.height = 21, .girth = 0.24, .crown_base = 0.42, .spread = 3.8, .steepness = 0.75},
                      wood::Dice(1, 2))};
  const std::array meshes{std::make_shared<const Mesh>(kinds[0]), std::make_shared<const Mesh>(kinds[1])};
  const auto whole =
      grove<Scene<Mesh>>([&](std::size_t kind) { return std::vector<Scene<Mesh>::Part>{{.geometry = meshes[kind]}}; });
  s.exact = shared(in_double(whole));
  s.map = shared(whole);
  for (const std::size_t one_in : {2U, 4U, 8U})
    s.forms.push_back({"one leaf in " + std::to_string(one_in), shared(with_fewer_leaves(whole, one_in))});
  const auto not_leaf = [](std::uint32_t material) { return !is_leaf(material); };
  const std::array stems{std::make_shared<const Mesh>(those_of(kinds[0], not_leaf)),
                         std::make_shared<const Mesh>(those_of(kinds[1], not_leaf))};
  for (const int cm : {5, 10, 20, 50}) {
    const double edge = 0.01 * cm;
    using Solids = Scene<Mesh, Solid>;
    using Leaves = Scene<Mesh, Foliage>;
    const std::array solids{std::make_shared<const Solid>(voxels_of(kinds[0], edge)),
                            std::make_shared<const Solid>(voxels_of(kinds[1], edge))};
    s.forms.push_back({"voxels of " + std::to_string(cm) + " cm", shared(grove<Solids>([&](std::size_t kind) {
                         return std::vector<Solids::Part>{{.geometry = solids[kind]}};
                       }))});
    const auto foliage = [&](const MeshData& tree) {
      return std::make_shared<const Foliage>(voxels_of(those_of(tree, is_leaf), edge),
                                             TransmissiveVoxels{LeafAngles::spherical()});
    };
    const std::array leaves{foliage(kinds[0]), foliage(kinds[1])};
    s.forms.push_back({"leaves by chance of " + std::to_string(cm) + " cm", shared(grove<Leaves>([&](std::size_t kind) {
                         return std::vector<Leaves::Part>{{.geometry = stems[kind]}, {.geometry = leaves[kind]}};
                       }))});
  }
  s.ground = [terrain = wood::Terrain(1)](const Vec2& at) { return terrain.height(at); };
  const Laser laser{.wavelength = 1550_nm, .peak_power = 100_W, .pulse_length = 3_ns, .divergence = 0.5_mrad};
  const Platform drone{StraightLine{.from = {0, -24, 45}, .to = {0, 24, 45}, .speed = 6},
                       Mount{.boresight = extrinsic({{axis::right, -90_deg}, {axis::up, -90_deg}})},
                       Deflector{OscillatingMirror{.cycle_rate = 20_Hz, .half_angle = 25_deg},
                                 Scanner{.pulse_rate = 100_kHz, .pulses = 800'000, .laser = laser}}};
  s.pulses = sampled(drone, pulses);
  return s;
}

[[nodiscard]] inline Scenario street_from_a_car(std::size_t pulses) {
  Scenario s{.name = "street", .title = "A street from a car", .threshold = 5000_nW, .gate = 0.375};
  const street::Scene whole = street::scene(1);
  s.exact = shared(in_double(whole));
  s.map = shared(whole);
  const Laser laser{.wavelength = 905_nm, .peak_power = 75_W, .pulse_length = 5_ns, .divergence = 0.5_mrad};
  const Platform car{StraightLine{.from = street::on({2, -70}), .to = street::on({2, 70}), .speed = 10},
                     Mount{.lever_arm = {0, 0, 2.1}, .boresight = rotation_about(axis::up, 45_deg)},
                     Deflector{PolygonMirror{.line_rate = 60_Hz, .sweep = 180_deg},
                               Scanner{.pulse_rate = 100_kHz, .pulses = 1'400'000, .laser = laser}}};
  s.pulses = sampled(car, pulses);
  return s;
}

/// A rope between two points that hangs through by so much in its middle [m].
inline void add_wire(MeshData& mesh, const Vec3& from, const Vec3& to, double sag, double radius) {
  constexpr int pieces = 16;
  const auto at = [&](int k) {
    const double share = static_cast<double>(k) / pieces;
    return from + share * (to - from) - 4 * sag * share * (1 - share) * axis::up;
  };
  for (int k = 0; k < pieces; ++k) street::add_tube(mesh, at(k), at(k + 1), radius, radius, 6, street::metal);
}

/// Two houses of the street, with wires, a railing and a scaffold before them: many edges upright and level, some
/// aslant.
[[nodiscard]] inline Scenario facade(std::size_t pulses) {
  Scenario s{.name = "facade", .title = "A facade with edges and wires", .threshold = 500_nW, .turned = true};
  MeshData ground, wires;
  street::add_face(ground, {{-40, -45, 0}, {40, -45, 0}, {40, 5, 0}, {-40, 5, 0}}, street::paving);
  for (int k = 0; k < 6; ++k)
    add_wire(wires, {-14, -1.5 - 0.4 * k, 4.0 + 1.3 * k}, {14, -1.5 - 0.3 * k, 4.2 + 1.3 * k}, k % 2 == 0 ? 0 : 0.3,
             0.002 + 0.002 * k);
  for (int k = 0; k < 5; ++k) add_wire(wires, {-12.0 + 6 * k, -1, 0}, {-9.0 + 6 * k, -0.6, 12}, 0, 0.006);  // guys
  for (int k = 0; k < 60; ++k)
    street::add_tube(wires, {-6 + 0.2 * k, -2, 0}, {-6 + 0.2 * k, -2, 1.1}, 0.006, 0.006, 6, street::metal);
  street::add_tube(wires, {-6, -2, 1.1}, {6, -2, 1.1}, 0.02, 0.02, 8, street::metal);
  for (int k = 0; k < 4; ++k) {
    street::add_tube(wires, {-14.0 + 2.5 * k, -1.2, 0}, {-14.0 + 2.5 * k, -1.2, 10}, 0.024, 0.024, 8, street::metal);
    street::add_tube(wires, {-14, -1.2, 2.0 + 2 * k}, {-6.5, -1.2, 2.0 + 2 * k}, 0.024, 0.024, 8, street::metal);
  }
  const MeshData left = street::house({5, 3, street::brick}), right = street::house({4, 4, street::plaster});
  const auto table = material_table(street::materials());
  const auto model = [](const MeshData& data) { return std::make_shared<const Mesh>(data); };
  const Vec3 left_place{-14, 0, 0}, right_place{0.5, 0.4, 0};
  const Scene<Mesh> whole({{model(ground), table, {}, 0},
                           {model(left), table, {.translation = left_place}, 1},
                           {model(right), table, {.translation = right_place}, 2},
                           {model(wires), table, {}, 3}});
  for (const int cm : {5, 10, 20, 50}) {
    const auto solid = [&](const MeshData& data) { return std::make_shared<const Solid>(voxels_of(data, 0.01 * cm)); };
    s.forms.push_back({"voxels of " + std::to_string(cm) + " cm",
                       shared(Scene<Mesh, Solid>({{model(ground), table, {}, 0},
                                                  {solid(left), table, {.translation = left_place}, 1},
                                                  {solid(right), table, {.translation = right_place}, 2},
                                                  {solid(wires), table, {}, 3}}))});
  }
  const Laser laser{.wavelength = 1550_nm, .peak_power = 10_W, .pulse_length = 4_ns, .divergence = 0.6_mrad};
  const Scanner scanner{.pulse_rate = 100_kHz, .pulses = 4'000'000, .laser = laser};
  const Platform tripod{
      Tripod{.position = {0, -35, 0}}, Mount{.lever_arm = {0, 0, 1.7}},
      Deflector{RotatingHead{.angular_rate = -50_deg / scanner.duration().seconds(), .start = 25_deg},
                Deflector{PolygonMirror{.line_rate = 100_Hz, .sweep = 14_deg, .angle_min = -3_deg}, scanner}}};
  s.pulses = sampled(tripod, pulses, meets_an_edge(whole, laser));
  s.exact = shared(in_double(whole));
  s.map = shared(whole);
  return s;
}

/// Slabs that lie about on level ground, 5 cm to 60 cm high, from the air: a beam is half a metre wide there.
[[nodiscard]] inline Scenario step(std::size_t pulses) {
  Scenario s{.name = "step", .title = "A step smaller than the footprint", .threshold = 20_nW, .turned = true};
  MeshData mesh;
  street::add_face(mesh, {{-60, -60, 0}, {60, -60, 0}, {60, 60, 0}, {-60, 60, 0}}, street::paving);
  street::Dice dice(7, 0);
  for (double x = -50; x <= 50; x += 2.5)
    for (double y = -50; y <= 50; y += 2.5) {
      const double turn = dice.between(0, 90_deg), size = dice.between(0.3, 1.0),
                   height = 0.05 * std::pow(12, dice.between(0, 1));
      const Vec3 middle{x, y, height}, along = size * Vec3(std::cos(turn), std::sin(turn), 0),
                                       across = cross(axis::up, along);
      const std::array<Vec3, 4> corners{middle - along - across, middle + along - across, middle + along + across,
                                        middle - along + across};
      street::add_face(mesh, {corners[0], corners[1], corners[2], corners[3]}, street::paving);
      for (std::size_t k = 0; k < 4; ++k) {
        const Vec3 &a = corners[k], &b = corners[(k + 1) % 4];
        street::add_face(mesh, {a, b, b - height * axis::up, a - height * axis::up}, street::paving);
      }
    }
  const Scene<Mesh> whole(
      {{.geometry = std::make_shared<const Mesh>(mesh), .materials = material_table(street::materials())}});
  const Laser laser{.wavelength = 1064_nm, .peak_power = 5000_W, .pulse_length = 4_ns, .divergence = 0.5_mrad};
  const Platform airplane{StraightLine{.from = {0, -48, 1000}, .to = {0, 48, 1000}, .speed = 60},
                          Mount{.boresight = extrinsic({{axis::right, -90_deg}, {axis::up, -90_deg}})},
                          Deflector{OscillatingMirror{.cycle_rate = 50_Hz, .half_angle = 2.5_deg},
                                    Scanner{.pulse_rate = 500_kHz, .pulses = 800'000, .laser = laser}}};
  s.pulses = sampled(airplane, pulses, meets_an_edge(whole, laser));
  s.exact = shared(in_double(whole));
  s.map = shared(whole);
  return s;
}

}  // namespace tradeoff
