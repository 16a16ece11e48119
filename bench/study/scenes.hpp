// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <pulsecast/pulsecast.hpp>
#include <pulsecast/transport/light_paths.hpp>

#include "../../examples/tree.hpp"
#include "pulses.hpp"
#include "truth.hpp"

/// Scenes whose echoes are known: objects in closed form, and the same as meshes for the library.
namespace tradeoff {

using namespace pulsecast::literals;
using wood::Dice;
using wood::MaterialIndex;

using Mesh = TriangleMesh<>;
using ExactMesh = TriangleMesh<Bvh<double>>;
using Whole = std::shared_ptr<const Scene<Mesh>>;
using Exact = std::shared_ptr<const Scene<ExactMesh>>;

/// Pulses that hit one object, or neighbours.
struct Cluster {
  Whole map{};
  Exact exact{};  ///< the same, traversed in `double`; null in most scenes
  Pulses pulses{};
  std::vector<Surface> surfaces{};  ///< the same as the map; empty in a scene with a reference
  std::vector<Axes> axes{};         ///< of the pulses
};

struct Scenario {
  std::string name, title;
  bool held_out = false;  ///< shows what was chosen on the others
  Instrument instrument{};
  Fog fog{};
  bool follows_light = false;  ///< by `LightPaths`, not `DirectLight`
  RangeGate gate{};            ///< of the receiver [m]
  std::vector<Cluster> clusters{};

  [[nodiscard]] bool has_truth() const noexcept { return !clusters.front().surfaces.empty(); }
};

/// Where a scene is and of which size: what a survey of the same form needs at UTM coordinates, or of a micrometre.
struct Frame {
  double scale = 1;
  Vec3 place{};
};

namespace detail {

inline constexpr int sides = 128;

/// Quadrilateral about a point, between so far along one vector and another.
inline void add_quad(MeshData& mesh, const Vec3& at, const Vec3& from, const Vec3& to, const Vec3& up,
                     MaterialIndex material) {
  wood::add_triangle(mesh, at + from - up, at + to - up, at + to + up, material);
  wood::add_triangle(mesh, at + from - up, at + to + up, at + from + up, material);
}

/// Tube with the corners of its rings on the circle.
inline void add_tube(MeshData& mesh, const Cylinder& c, double reach, MaterialIndex material) {
  const Vec3 a = wood::square_to(c.axis), b = cross(c.axis, a);
  for (int k = 0; k < sides; ++k) {
    const auto rim = [&](int i) {
      return c.radius * (std::cos(2 * pi * i / sides) * a + std::sin(2 * pi * i / sides) * b);
    };
    const Vec3 one = c.point + rim(k), other = c.point + rim(k + 1), along = reach * c.axis;
    wood::add_triangle(mesh, one - along, other - along, other + along, material);
    wood::add_triangle(mesh, one - along, other + along, one + along, material);
  }
}

/// Ball by longitude and latitude, with its corners on the sphere.
inline void add_ball(MeshData& mesh, const Sphere& s, MaterialIndex material) {
  const auto on = [&](int i, int k) {
    const double polar = pi * i / sides, turn = 2 * pi * k / (2 * sides);
    return s.point +
           s.radius * Vec3(std::sin(polar) * std::cos(turn), std::sin(polar) * std::sin(turn), std::cos(polar));
  };
  for (int i = 0; i < sides; ++i)
    for (int k = 0; k < 2 * sides; ++k) {
      if (i > 0) wood::add_triangle(mesh, on(i, k), on(i + 1, k), on(i, k + 1), material);
      if (i + 1 < sides) wood::add_triangle(mesh, on(i + 1, k), on(i + 1, k + 1), on(i, k + 1), material);
    }
}

}  // namespace detail

/// Scene of these surfaces, planes out to `reach` [m].
[[nodiscard]] inline Whole map_of(const std::vector<Surface>& surfaces, double reach, const Frame& frame) {
  MeshData mesh;
  std::vector<Material> materials;
  const auto paint = [&](double reflectance) {
    materials.push_back({.reflectance = reflectance});
    return static_cast<MaterialIndex>(materials.size() - 1);
  };
  for (const Surface& surface : surfaces) {
    if (const auto* plane = std::get_if<Plane>(&surface)) {
      const bool edged = plane->inwards != Vec3{};
      const Vec3 in = reach * (edged ? plane->inwards : wood::square_to(plane->normal)),
                 up = reach * normalize(cross(plane->normal, in));
      detail::add_quad(mesh, plane->point, edged ? Vec3{} : -in, in, up, paint(plane->reflectance));
      if (plane->beyond > 0) detail::add_quad(mesh, plane->point, -in, {}, up, paint(plane->beyond));
    } else if (const auto* tube = std::get_if<Cylinder>(&surface)) {
      detail::add_tube(mesh, *tube, reach, paint(tube->reflectance));
    } else {
      const Sphere& ball = std::get<Sphere>(surface);
      detail::add_ball(mesh, ball, paint(ball.reflectance));
    }
  }
  for (Vec3& vertex : mesh.vertices) vertex = frame.scale * vertex + frame.place;
  return std::make_shared<const Scene<Mesh>>(std::vector<Scene<Mesh>::Part>{
      {.geometry = std::make_shared<const Mesh>(mesh), .materials = material_table(std::move(materials))}});
}

/// The same scene, traversed in `double`.
[[nodiscard]] inline Exact in_double(const Whole& scene) {
  std::map<const void*, std::shared_ptr<const ExactMesh>> made;
  std::vector<Scene<ExactMesh>::Part> parts;
  for (const auto& part : scene->parts()) {
    auto& mesh = made[part.geometry.get()];
    MeshData data;
    for (PrimitiveIndex i = 0; i < part.geometry->size() && !mesh; ++i) {
      const Triangle t = part.geometry->triangle(i);
      wood::add_triangle(data, t.a, t.b, t.c,
                         static_cast<MaterialIndex>(part.geometry->surface(i, RayBundle{}, 0).material_index));
    }
    if (!mesh) mesh = std::make_shared<const ExactMesh>(data);
    parts.push_back({mesh, part.materials, part.placement, part.object});
  }
  return std::make_shared<const Scene<ExactMesh>>(std::move(parts));
}

/// An object before a beam from the origin along y, and where to aim.
struct Object {
  std::vector<Surface> surfaces{};
  std::function<Vec3(Dice&)> aim{};
  double reach = 100;  ///< of planes and wires [m]
};

inline constexpr std::size_t cluster_count = 64, pulses_each = 8;

/// Scene of clusters, each of an object of its own. Beams have any roll; those of `level` objects nearly none.
[[nodiscard]] inline Scenario scene_of(Scenario s, double range, double threshold, std::uint32_t stream,
                                       const std::function<Object(Dice&)>& make, const Frame& frame = {}) {
  const double k = frame.scale;
  Instrument& instrument = s.instrument;
  if (s.gate.near == 0)
    s.gate = {std::fmax(range - 60 * instrument.resolution(), range / 2), range + 60 * instrument.resolution()};
  instrument.laser.pulse_length *= k;
  instrument.laser.waist_diameter *= k;
  instrument.laser.waist_range *= k;
  instrument.diameter = std::fmax(k * instrument.diameter, 1e-4);
  instrument.threshold = threshold * instrument.power(1, k * range);
  s.gate = {k * s.gate.near, k * s.gate.far};
  for (std::uint32_t c = 0; c < cluster_count; ++c) {
    Dice dice(51 + c, stream);
    const Object object = make(dice);
    Cluster cluster{.map = map_of(object.surfaces, object.reach, frame)};
    for (Surface surface : object.surfaces) {
      std::visit(
          [&](auto& it) {
            it.point *= k;
            if constexpr (!std::is_same_v<decltype(it), Plane&>) it.radius *= k;
          },
          surface);
      cluster.surfaces.push_back(surface);
    }
    std::vector<Pulse<frame::World>> pulses;
    for (std::size_t i = 0; i < pulses_each; ++i) {
      const Vec3 ahead = normalize(object.aim(dice));
      const Vec3 level = normalize(cross(ahead, axis::up)), high = cross(level, ahead);
      const double roll = c % 2 == 0 ? dice.between(-1_deg, 1_deg) : dice.between(0, 360_deg);
      const Vec3 across = std::cos(roll) * level + std::sin(roll) * high;
      const Axes axes{{}, across, ahead, cross(across, ahead)};
      cluster.axes.push_back(axes);
      Pulse<frame::World> pulse;
      pulse.pose = {rotation_of(Matrix3(axes.across, axes.ahead, axes.above)), frame.place};
      pulse.tick = Tick::of_seconds(1e-6 * static_cast<double>(i));
      pulses.push_back(pulse);
    }
    cluster.pulses = Pulses(std::move(pulses), {{.laser = instrument.laser}});
    s.clusters.push_back(std::move(cluster));
  }
  return s;
}

/// Unit normal of a plane that a beam along y meets at this incidence, tilted in any direction.
[[nodiscard]] inline Vec3 normal_at(double incidence, double turn) {
  return {std::sin(incidence) * std::cos(turn), -std::cos(incidence), std::sin(incidence) * std::sin(turn)};
}
/// Direction in a plane that looks turned so in the beam.
[[nodiscard]] inline Vec3 within(const Vec3& normal, double turn) {
  const Vec3 seen{std::cos(turn), 0, std::sin(turn)};
  return normalize(seen - (dot(seen, normal) / normal.y) * axis::forward);
}
/// Turn of edges and wires: half of them upright or level to a degree, the others any.
[[nodiscard]] inline double turn_of(Dice& dice) {
  if (dice.between(0, 1) < 0.5) return dice.between(0, 360_deg);
  return std::floor(dice.between(0, 4)) * 90_deg + dice.between(-1_deg, 1_deg);
}
/// Aims within this distance of a point, square to the beam [m].
[[nodiscard]] inline std::function<Vec3(Dice&)> about(const Vec3& point, double reach) {
  return [=](Dice& dice) { return point + Vec3(dice.between(-reach, reach), 0, dice.between(-reach, reach)); };
}
[[nodiscard]] inline double logarithmic(Dice& dice, double low, double high) {
  return low * std::pow(high / low, dice.between(0, 1));
}

/// Sheet with an edge above a plane, both level to `tilt` [rad].
[[nodiscard]] inline Object step(Dice& dice, double range, double radius, double low, double high, double tilt) {
  const Vec3 normal = normal_at(dice.between(0, tilt), dice.between(0, 360_deg)), at{0, range, 0};
  const double height = logarithmic(dice, low, high);
  return {{Plane{at, normal, dice.between(0.2, 0.6), within(normal, turn_of(dice))},
           Plane{at - height * normal, normal, dice.between(0.2, 0.6)}},
          about(at, 1.2 * radius),
          400 * radius};
}
/// Wire before a wall.
[[nodiscard]] inline Object wire(Dice& dice, double range, double radius, double thin, double thick) {
  const double turn = turn_of(dice);
  const Vec3 at{0, range, 0}, along = within(-axis::forward, turn);
  return {{Cylinder{at, along, logarithmic(dice, thin, thick), dice.between(0.2, 0.6)},
           Plane{at + logarithmic(dice, 0.1, 5) * axis::forward, -axis::forward, dice.between(0.2, 0.6)}},
          about(at, 1.2 * radius),
          20 * radius};
}
[[nodiscard]] inline Object slope(Dice& dice, double range, double radius, double least, double most) {
  const double incidence = dice.between(least, most);
  return {{Plane{{0, range, 0}, normal_at(incidence, dice.between(0, 360_deg)), 0.3}},
          about({0, range, 0}, radius),
          40 * radius / std::cos(incidence)};
}
[[nodiscard]] inline Object sphere(Dice& dice) {
  const double radius = dice.between(0.07, 0.15);
  const Vec3 centre{0, 60, 0};
  return {{Sphere{centre, radius, 0.7}, Plane{{0, 62, 0}, -axis::forward, 0.3}},
          [=](Dice& d) {
            const double off = radius * std::sqrt(d.between(0, 1.4)), turn = d.between(0, 360_deg);
            return centre + off * Vec3(std::cos(turn), 0, std::sin(turn));
          },
          20};
}
/// Plane with a border of two paints.
[[nodiscard]] inline Object paint(Dice& dice, double range, double radius) {
  const Vec3 normal = normal_at(dice.between(30_deg, 75_deg), dice.between(0, 360_deg)), at{0, range, 0};
  return {{Plane{at, normal, 0.8, within(normal, turn_of(dice)), 0.1}}, about(at, 1.2 * radius), 200 * radius};
}

inline const Laser airborne{.wavelength = 1064_nm, .peak_power = 5000_W, .pulse_length = 4_ns, .divergence = 0.5_mrad};
inline const Laser terrestrial{.wavelength = 1550_nm, .peak_power = 10_W, .pulse_length = 4_ns, .divergence = 0.6_mrad};

/// Steps from the air, also at another place and of another size.
[[nodiscard]] inline Scenario steps(const std::string& name, const Frame& frame = {}, double range = 1000) {
  Laser laser = airborne;
  laser.divergence = 0.5 / range;
  return scene_of(
      {.name = name, .title = "Steps of 5 to 60 cm in a beam of half a metre", .instrument = {laser}}, range, 0.02, 1,
      [=](Dice& dice) { return step(dice, range, 0.25, 0.05, 0.6, 15_deg); }, frame);
}

/// Makers of all scenes with a truth, by name. Scenes for choosing are those of the kinds by which the defaults were
/// found once, and ones like them; the held-out ones are of other kinds.
[[nodiscard]] inline std::vector<std::pair<std::string, std::function<Scenario()>>> true_scenes() {
  const auto scene = [](Scenario s, double range, double threshold, std::uint32_t stream, auto make) {
    return std::pair<std::string, std::function<Scenario()>>(
        s.name, [=] { return scene_of(s, range, threshold, stream, make); });
  };
  Laser satellite = airborne, collimated = terrestrial, wide = airborne;
  satellite.divergence = 30e-6;
  satellite.pulse_length = 6_ns;
  satellite.peak_power = 1e8;
  collimated.waist_diameter = wide.waist_diameter = 5e-3;
  return {
      {"step", [] { return steps("step"); }},
      scene({.name = "wire",
             .title = "Wires of 4 to 40 mm before a wall, 100 m from a tripod",
             .instrument = {terrestrial}},
            100, 0.02, 2, [](Dice& d) { return wire(d, 100, 0.03, 0.002, 0.02); }),
      scene({.name = "slope", .title = "Planes at up to 75 degrees, 1,000 m from the air", .instrument = {airborne}},
            1000, 0.002, 3, [](Dice& d) { return slope(d, 1000, 0.25, 0, 75_deg); }),
      scene({.name = "fog",
             .title = "Steps behind a bank of fog",
             .instrument = {terrestrial},
             .fog = {20, 40, 0.02, 0.002},
             .follows_light = true,
             .gate = {1, 100}},
            50, 0.005, 4, [](Dice& d) { return step(d, 50, 0.015, 0.05, 3, 30_deg); }),
      scene({.name = "satellite",
             .title = "Edges of 3 to 20 m and slopes of up to 30 degrees, from 400 km, in a beam of 12 m",
             .held_out = true,
             .instrument = {satellite, 1}},
            400e3, 0.005, 5, [](Dice& d) { return step(d, 400e3, 6, 3, 20, 30_deg); }),
      scene({.name = "grazing",
             .title = "Planes at 80 to 86 degrees, 1,000 m from the air",
             .held_out = true,
             .instrument = {airborne}},
            1000, 0.0002, 6, [](Dice& d) { return slope(d, 1000, 0.25, 80_deg, 86_deg); }),
      scene({.name = "sphere",
             .title = "Balls of 14 to 30 cm before a wall, 60 m from a tripod",
             .held_out = true,
             .instrument = {terrestrial}},
            60, 0.02, 7, [](Dice& d) { return sphere(d); }),
      scene({.name = "paint",
             .title = "Borders of two paints on planes at 30 to 75 degrees",
             .held_out = true,
             .instrument = {airborne}},
            1000, 0.002, 8, [](Dice& d) { return paint(d, 1000, 0.25); }),
      scene({.name = "waist wire",
             .title = "Wires of 1 to 8 mm at 20 m, in a beam with a waist of 5 mm",
             .held_out = true,
             .instrument = {collimated}},
            20, 0.02, 9, [](Dice& d) { return wire(d, 20, 0.0065, 0.0005, 0.004); }),
      scene({.name = "waist slope",
             .title = "Planes at 40 to 80 degrees, 3,000 m away, in a beam with a waist of 5 mm",
             .held_out = true,
             .instrument = {wide}},
            3000, 0.001, 10, [](Dice& d) { return slope(d, 3000, 0.75, 40_deg, 80_deg); })};
}

}  // namespace tradeoff
