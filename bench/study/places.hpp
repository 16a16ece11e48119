// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <pulsecast/material/water_types.hpp>
#include <pulsecast/pulsecast.hpp>

#include "../../examples/street.hpp"
#include "../../examples/wood.hpp"
#include "../surveys.hpp"
#include "scenes.hpp"

/// Scenes without a closed form, which take a reference of the library by far more subrays.
namespace tradeoff {

/// Pulses whose beams hit more than one object: of the rays out to 1.2 radii some differ in their objects, or in range
/// by a hand's breadth.
[[nodiscard]] inline auto meets_an_edge(const Whole& scene, const Laser& laser) {
  return [scene, laser, footprint = SunflowerFootprint(37),
          hits = std::vector<Hit>(RayBundle::capacity)](const Pulse<frame::World>& pulse) mutable {
    RayBundle rays;
    rays.origin = pulse.origin();
    rays.size = footprint.size();
    for (std::size_t j = 0; j < rays.size; ++j)
      rays.set_direction(j, pulse.pose.rotation * subray_direction(0.8 * footprint.offset(j), laser.divergence));
    rays.pad();
    scene->closest(rays, hits);
    for (std::size_t j = 1; j < rays.size; ++j)
      if (hits[j].met() != hits[0].met() || hits[j].object != hits[0].object ||
          std::fabs(hits[j].range - hits[0].range) > 0.05)
        return true;
    return false;
  };
}

/// Runs of neighbouring pulses from everywhere in a survey, of those that are wanted.
template <class Source, class Wanted>
[[nodiscard]] Scenario place(Scenario s, const Whole& whole, const Source& source, double threshold, Wanted wanted) {
  s.instrument.threshold = threshold;
  const Exact exact = s.follows_light ? nullptr : in_double(whole);
  for (Pulses& run : runs_of(source, 96, 16, wanted))
    s.clusters.push_back({.map = whole, .exact = exact, .pulses = std::move(run)});
  return s;
}
template <class Source>
[[nodiscard]] Scenario place(Scenario s, const Whole& whole, const Source& source, double threshold) {
  return place(std::move(s), whole, source, threshold, [](const Pulse<frame::World>&) { return true; });
}

[[nodiscard]] inline Platform<StraightLine, Deflector<OscillatingMirror, Scanner>> flight(double height, double length,
                                                                                          double speed, double swath,
                                                                                          const Laser& laser) {
  const double duration = length / speed, rate = 200e3;
  return Platform{
      StraightLine{.from = {0, -length / 2, height}, .to = {0, length / 2, height}, .speed = speed},
      Mount{.boresight = extrinsic({{axis::right, -90_deg}, {axis::up, -90_deg}})},
      Deflector{OscillatingMirror{.cycle_rate = 20_Hz, .half_angle = swath},
                Scanner{.pulse_rate = rate, .pulses = static_cast<PulseIndex>(duration * rate), .laser = laser}}};
}

/// The street with another material for its windows, from a car.
[[nodiscard]] inline Scenario street_from_a_car(Scenario s, const Material& windows) {
  const auto whole = std::make_shared<const Scene<Mesh>>(bench::town_with(windows));
  const Laser laser{.wavelength = 905_nm, .peak_power = 75_W, .pulse_length = 5_ns, .divergence = 0.5_mrad};
  const Platform car{StraightLine{.from = street::on({2, -70}), .to = street::on({2, 70}), .speed = 10},
                     Mount{.lever_arm = {0, 0, 2.1}, .boresight = rotation_about(axis::up, 45_deg)},
                     Deflector{PolygonMirror{.line_rate = 60_Hz, .sweep = 180_deg},
                               Scanner{.pulse_rate = 100_kHz, .pulses = 1'400'000, .laser = laser}}};
  s.instrument.laser = laser;
  s.gate = {1, 300};
  if (!s.follows_light) return place(std::move(s), whole, car, 5000e-9);
  const auto meets_glass = [&](const Pulse<frame::World>& pulse) {
    const Ray ray{.origin = pulse.origin(), .direction = pulse.direction()};
    const auto hit = whole->closest_hit(ray);
    return hit && whole->surface(*hit, ray).material->smooth.passes_light();
  };
  return place(std::move(s), whole, car, 500e-9, meets_glass);
}

/// Broadleaved trees of two kinds on the ground of the wood, which is object 0.
[[nodiscard]] inline Whole grove(const std::array<std::shared_ptr<const Mesh>, 2>& kinds) {
  const wood::Terrain terrain(1);
  const auto table = material_table(wood::materials());
  std::vector<Scene<Mesh>::Part> parts{{.geometry = std::make_shared<const Mesh>(terrain.mesh()), .materials = table}};
  wood::Dice dice(1, 60);
  for (double x = -26; x <= 26; x += 6.5)
    for (double y = -26; y <= 26; y += 6.5) {
      const Vec2 at{x + dice.between(-1.5, 1.5), y + dice.between(-1.5, 1.5)};
      const auto& kind = kinds[dice.between(0, 1) < 0.5 ? 0 : 1];
      const Placement placement{rotation_about(axis::up, dice.between(0, 360_deg)), dice.between(0.8, 1.1),
                                terrain.on(at)};
      parts.push_back({kind, table, placement, static_cast<ObjectId>(parts.size())});
    }
  return std::make_shared<const Scene<Mesh>>(std::move(parts));
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

[[nodiscard]] inline Scenario wood_from_a_drone(Scenario s) {
  const std::array kinds{
      std::make_shared<const Mesh>(wood::broadleaf({}, wood::Dice(1, 1))),
      std::make_shared<const Mesh>(wood::broadleaf(
          {.height = 21, .girth = 0.24, .crown_base = 0.42, .spread = 3.8, .steepness = 0.75}, wood::Dice(1, 2)))};
  s.instrument.laser = {.wavelength = 1550_nm, .peak_power = 100_W, .pulse_length = 3_ns, .divergence = 0.5_mrad};
  s.gate = {10, 150};
  const auto drone = flight(45, 48, 6, 25_deg, s.instrument.laser);
  return place(std::move(s), grove(kinds), drone, 1500e-9);
}

/// Two houses of the street, with wires, a railing and a scaffold before them; pulses that meet an edge.
[[nodiscard]] inline Scenario facade(Scenario s) {
  MeshData ground, wires;
  street::add_face(ground, {{-40, -45, 0}, {40, -45, 0}, {40, 5, 0}, {-40, 5, 0}}, street::paving);
  for (int k = 0; k < 6; ++k)
    add_wire(wires, {-14, -1.5 - 0.4 * k, 4.0 + 1.3 * k}, {14, -1.5 - 0.3 * k, 4.2 + 1.3 * k}, k % 2 == 0 ? 0 : 0.3,
             0.002 + 0.002 * k);
  for (int k = 0; k < 5; ++k) add_wire(wires, {-12.0 + 6 * k, -1, 0}, {-9.0 + 6 * k, -0.6, 12}, 0, 0.006);  // guys
  for (int k = 0; k < 60; ++k)
    street::add_tube(wires, {-6 + 0.2 * k, -2, 0}, {-6 + 0.2 * k, -2, 1.1}, 0.006, 0.006, 6, street::metal);
  for (int k = 0; k < 4; ++k) {
    street::add_tube(wires, {-14.0 + 2.5 * k, -1.2, 0}, {-14.0 + 2.5 * k, -1.2, 10}, 0.024, 0.024, 8, street::metal);
    street::add_tube(wires, {-14, -1.2, 2.0 + 2 * k}, {-6.5, -1.2, 2.0 + 2 * k}, 0.024, 0.024, 8, street::metal);
  }
  const auto table = material_table(street::materials());
  const auto model = [](const MeshData& data) { return std::make_shared<const Mesh>(data); };
  const auto whole = std::make_shared<const Scene<Mesh>>(std::vector<Scene<Mesh>::Part>{
      {model(ground), table, {}, 0},
      {model(street::house({5, 3, street::brick})), table, {.translation = {-14, 0, 0}}, 1},
      {model(street::house({4, 4, street::plaster})), table, {.translation = {0.5, 0.4, 0}}, 2},
      {model(wires), table, {}, 3}});
  s.instrument.laser = terrestrial;
  s.gate = {1, 100};
  const Scanner scanner{.pulse_rate = 100_kHz, .pulses = 4'000'000, .laser = terrestrial};
  const Platform tripod{
      Tripod{.position = {0, -35, 0}}, Mount{.lever_arm = {0, 0, 1.7}},
      Deflector{RotatingHead{.angular_rate = -50_deg / scanner.duration().seconds(), .start = 25_deg},
                Deflector{PolygonMirror{.line_rate = 100_Hz, .sweep = 14_deg, .angle_min = -3_deg}, scanner}}};
  return place(std::move(s), whole, tripod, 500e-9, meets_an_edge(whole, terrestrial));
}

/// Water with waves over a bed that falls from the shore to 6 m, with boulders, by green light.
[[nodiscard]] inline Scenario river(Scenario s) {
  MeshData surface, bed;
  Dice dice(3, 9);
  constexpr double cell = 0.5;
  const auto wave = [](double x, double y) {
    return Vec3{x, y, 0.05 * std::sin(2 * pi * (0.8 * x + 0.6 * y) / 5) + 0.02 * std::sin(2 * pi * (x - 2 * y) / 3)};
  };
  for (double x = -40; x < 40; x += cell)
    for (double y = -30; y < 30; y += cell)
      street::add_face(surface, {wave(x, y), wave(x + cell, y), wave(x + cell, y + cell), wave(x, y + cell)},
                       street::asphalt);
  street::add_face(bed, {{-40, -30, -0.3}, {40, -30, -6}, {40, 30, -6}, {-40, 30, -0.3}}, street::asphalt);
  for (int k = 0; k < 600; ++k) {
    const double x = dice.between(-38, 38), y = dice.between(-28, 28), depth = 3.15 + 2.85 * x / 40;
    street::add_tube(bed, {x, y, -depth - 0.1}, {x, y, -depth + dice.between(0.1, 0.5) * std::fmin(depth, 1.5)},
                     dice.between(0.1, 0.5), dice.between(0.1, 0.4), 8, street::asphalt);
  }
  const Medium water = pulsecast::water(JerlovType::oceanic_iii, 532_nm);
  const auto whole = std::make_shared<const Scene<Mesh>>(std::vector<Scene<Mesh>::Part>{
      {std::make_shared<const Mesh>(surface),
       material_table({{.reflectance = 0.02, .smooth = SmoothInterface::water(water)}}),
       {},
       0},
      {std::make_shared<const Mesh>(bed), material_table({{.reflectance = 0.2}}), {}, 1}});
  s.instrument.laser = {.wavelength = 532_nm, .peak_power = 5000_W, .pulse_length = 1.5_ns, .divergence = 1_mrad};
  s.gate = {350, 450};
  const auto airplane = flight(400, 50, 50, 4_deg, s.instrument.laser);
  return place(std::move(s), whole, airplane, 0.002 * s.instrument.power(1, 400));
}

/// Makers of all scenes with a reference, by name.
[[nodiscard]] inline std::vector<std::pair<std::string, std::function<Scenario()>>> reference_scenes() {
  return {{"street",
           [] {
             return street_from_a_car({.name = "street", .title = "A street from a car"},
                                      street::materials()[street::glass]);
           }},
          {"facade", [] { return facade({.name = "facade", .title = "Edges and wires of a facade, from a tripod"}); }},
          {"wood", [] { return wood_from_a_drone({.name = "wood", .title = "A wood from a drone"}); }},
          {"glass",
           [] {
             return street_from_a_car(
                 {.name = "glass", .title = "Windows of a street, from a car", .held_out = true, .follows_light = true},
                 {.reflectance = 0.02, .smooth = SmoothInterface::pane()});
           }},
          {"water", [] {
             return river({.name = "water",
                           .title = "Water of 0.3 to 6 m with waves, from the air",
                           .held_out = true,
                           .follows_light = true});
           }}};
}

}  // namespace tradeoff
