// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Multi-bounce light. A tripod in a foggy street, where shop windows, the mirrors of a car and a puddle produce ghost
// points; a drone over a river, whose green light passes the waves down to the bed. Writes street.las, street.png,
// river.las and river.png.

#include <cmath>
#include <cstdint>
#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <pulsecast/deflector/palmer_mirror.hpp>
#include <pulsecast/io/las.hpp>
#include <pulsecast/io/png.hpp>
#include <pulsecast/material/water_types.hpp>
#include <pulsecast/material/weather.hpp>
#include <pulsecast/platform/multicopter.hpp>
#include <pulsecast/pulsecast.hpp>
#include <pulsecast/shape/water_surface.hpp>
#include <pulsecast/shape/wind_waves.hpp>
#include <pulsecast/transport/light_paths.hpp>

#include "command_line.hpp"
#include "street.hpp"
#include "summary.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

/// Scans, and writes points and picture as NAME.las and NAME.png.
void scan(const auto& survey, const CommandLine& line, const std::string& name, const io::ImageSettings& view) {
  io::LasWriter las(line.output / (name + ".las"), {.light_kinds = true});
  io::ImageWriter image(line.output / (name + ".png"), view);
  const RunSummary summary = run(survey, {.threads = line.threads, .progress = ProgressLine{}}, las, image);
  las.close();
  image.close();
  std::cout << "The " << name << ":\n";
  print(summary);
}

namespace town {

// materials besides those of a street
constexpr street::MaterialIndex mirror{street::leaf + 1}, prisms{street::leaf + 2}, puddle{street::leaf + 3};

MaterialTable materials(double wavelength) {
  std::vector<Material> all = street::materials();
  all[street::glass] = {.name = "window", .reflectance = 0, .classification = 6, .smooth = SmoothInterface::pane(6_mm)};
  all.push_back({.name = "mirror", .reflectance = 0.01, .classification = 64, .smooth = SmoothInterface::mirror(0.9)});
  all.push_back({.name = "prismatic sheet",
                 .reflectance = 0.1,
                 .scattering = Scattering::retroreflective,
                 .retroreflection = 500,
                 .retroreflector = RetroreflectorKind::prisms,
                 .retroreflection_width = 4_mrad,
                 .classification = 65});
  all.push_back({.name = "puddle",
                 .reflectance = 0.002,
                 .classification = 9,
                 .smooth = SmoothInterface::water(water(JerlovType::coastal_9, wavelength))});
  return material_table(std::move(all));
}

/// A car that drives ahead, with its outside mirrors turned to whom it has overtaken.
MeshData car_with_mirrors() {
  MeshData mesh = street::car();
  for (const double side : {-1.0, 1.0}) {
    const Vec3 middle{side * 1.02, 0.75, 1.02};
    const Vec3 across{0.12, -0.02 * side, 0}, up{0, 0.01, 0.075};
    street::add_face(mesh, {middle - across - up, middle + across - up, middle + across + up, middle - across + up},
                     mirror);
  }
  return mesh;
}

/// A round sign on a post, seen from the south.
MeshData sign() {
  MeshData mesh;
  street::add_tube(mesh, {0, 0.05, 0}, {0, 0.05, 2.9}, 0.04, 0.04, 8, street::metal);
  for (int k = 0; k < 24; ++k) {
    const auto rim = [&](int i) { return Vec3{0.3 * std::cos(i * 15_deg), 0, 2.6 + 0.3 * std::sin(i * 15_deg)}; };
    street::add_face(mesh, {{0, 0, 2.6}, rim(k), rim(k + 1)}, prisms);
  }
  return mesh;
}

/// The southern end of the street, where the road has its hollow: there water stands at the western kerb.
street::Scene scene(std::uint64_t seed, double wavelength) {
  const auto table = materials(wavelength);
  street::Houses shops = street::dwellings;
  for (street::House& house : shops) house.shop = true;
  std::vector<street::Scene::Part> parts = street::parts(seed, shops, table);
  const auto place = [&](const MeshData& mesh, const Vec3& at) {
    parts.push_back({.geometry = std::make_shared<const street::Mesh>(mesh),
                     .materials = table,
                     .placement = {no_rotation, 1, at},
                     .object = static_cast<ObjectId>(parts.size())});
  };
  place(car_with_mirrors(), street::on({1, -71.5}));
  for (const double y : {-70.0, -50.0, -30.0}) place(sign(), street::on({6.6, y}));
  MeshData water;
  const double level = street::height({-5.9, -79}) + 0.02;
  street::add_face(water, {{-6, -91, level}, {-3, -91, level}, {-3, -66, level}, {-6, -66, level}}, puddle);
  place(water, {});
  return street::Scene(std::move(parts));
}

void scan(const CommandLine& line, double visibility, double step) {
  const Laser laser{.wavelength = 905_nm, .peak_power = 75_W, .pulse_length = 3_ns, .divergence = 0.5_mrad};
  const Scanner scanner{
      .pulse_rate = 100_kHz, .pulses = static_cast<PulseIndex>(100_deg / step * 360_deg / step), .laser = laser};
  const PolygonMirror polygon{.line_rate = scanner.pulse_rate * step / 100_deg, .sweep = 100_deg, .angle_min = -60_deg};
  const RotatingHead head{.angular_rate = 360_deg / scanner.duration().seconds()};
  const Vec3 foot = street::on({0.5, -82});
  const Platform tripod{Tripod{.position = foot}, Mount{.lever_arm = {0, 0, 1.7}},
                        Deflector{head, Deflector{polygon, scanner}}};

  const street::Scene map = scene(line.seed, laser.wavelength);
  const LightPaths light{.share_min = 1e-3, .air = Media({{.medium = fog(visibility, laser.wavelength)}})};
  const Survey survey{tripod,   LatticeFootprint{7}, map,
                      light,    Receiver{},          FullWaveform{{.sample_interval = 1_ns, .threshold = 2e-9}},
                      line.seed};
  ::scan(survey, line, "street",
         {.azimuth = -34_deg,
          .elevation = 4_deg,
          .field_of_view = 75_deg,
          .eye = foot + Vec3{2.5, -4.5, 2.9},
          .colour_by = io::ColourBy::kind,
          .point_size = 3});
}

}  // namespace town

namespace river {

/// Height of the ground: a bed that winds between banks, with bars and boulders [m].
double height(const Vec2& at, double depth) {
  const double off = std::fabs(at.x - 12 * std::sin(at.y / 30)), bed = 13 + 2 * std::sin(at.y / 11);
  const double bars = 0.18 * depth * std::sin(at.x / 3.1 + std::sin(at.y / 4)) * std::cos(at.y / 5.3);
  const double across = off / bed;
  if (across < 1) return -(depth + bars) * (1 - across * across) + 0.8 * across * across;
  return 0.8 + 2.2 * (1 - std::exp(-(off - bed) / 6)) + 0.12 * std::sin(at.x / 2.3) * std::sin(at.y / 3.7);
}

constexpr Vec2 half{45, 60};  ///< of the ground [m]

MeshData ground(double depth) {
  MeshData mesh;
  const double step = 0.5;
  const auto columns = static_cast<std::uint32_t>(2 * half.x / step) + 1,
             rows = static_cast<std::uint32_t>(2 * half.y / step) + 1;
  for (std::uint32_t j = 0; j < rows; ++j)
    for (std::uint32_t i = 0; i < columns; ++i) {
      const Vec2 at{-half.x + step * i, -half.y + step * j};
      mesh.vertices.push_back({at.x, at.y, height(at, depth)});
      if (i == 0 || j == 0) continue;
      const std::uint32_t k = j * columns + i, material = mesh.vertices.back().z < 0.5 ? 0 : 1;
      mesh.triangles.push_back({k - columns - 1, k - columns, k});
      mesh.triangles.push_back({k - columns - 1, k, k - 1});
      mesh.materials.insert(mesh.materials.end(), 2, material);
    }
  return mesh;
}

using Scene = pulsecast::Scene<TriangleMesh<>, WaterSurface>;

/// Bed, banks and trees under water with waves. Reflectances at 532 nm.
Scene scene(std::uint64_t seed, double depth, double wind, double wavelength) {
  std::vector<Scene::Part> parts;
  const auto place = [&](auto geometry, const MaterialTable& materials, const Placement& placement = {}) {
    parts.push_back({.geometry = std::move(geometry),
                     .materials = materials,
                     .placement = placement,
                     .object = static_cast<ObjectId>(parts.size())});
  };
  place(std::make_shared<const TriangleMesh<>>(ground(depth)),
        material_table({{.name = "gravel", .reflectance = 0.2, .classification = 40, .ground = true},
                        {.name = "meadow", .reflectance = 0.12, .classification = 2, .ground = true}}));
  const SmoothInterface body = SmoothInterface::water(water(JerlovType::coastal_1, wavelength));
  const WaveField waves(waves_of({.wind_speed = wind, .fetch = 300, .components = 32, .seed = seed}));
  place(std::make_shared<const WaterSurface>(WaterArea{-half, half}, waves),
        material_table({{.name = "river", .reflectance = 0.005, .classification = 9, .smooth = body}}));

  std::vector<Material> of_trees = street::materials();
  of_trees[street::leaf].reflectance = 0.1;
  const MaterialTable wood = material_table(std::move(of_trees));
  const auto tree = std::make_shared<const TriangleMesh<>>(street::tree(street::Dice(seed, 2)));
  street::Dice dice(seed, 3);
  for (int k = 0; k < 60; ++k) {
    const Vec2 at{dice.between(-half.x, half.x), dice.between(-half.y, half.y)};
    const double ground = height(at, depth), size = dice.between(0.8, 1.5), twist = dice.between(0, 6);
    if (ground > 1.5) place(tree, wood, {rotation_about(axis::up, twist), size, {at.x, at.y, ground}});
  }
  return Scene(std::move(parts));
}

void scan(const CommandLine& line, double depth, double wind, double pulse_rate) {
  const Laser laser{.wavelength = 532_nm, .peak_power = 20e3, .pulse_length = 1.5_ns, .divergence = 1_mrad};
  const MulticopterFlight flight =
      plan_multicopter(std::vector<FlightPoint>{{{0, -36, 60}}, {{0, 36, 60}}}, {.speed = 8, .arrival_heading = 0});
  const Scanner scanner{.pulse_rate = pulse_rate,
                        .pulses = static_cast<PulseIndex>(flight.duration().seconds() * pulse_rate),
                        .laser = laser};
  const Platform drone{flight, Mount{.boresight = extrinsic({{axis::right, -90_deg}})},
                       Deflector{PalmerMirror{.rotation_rate = 40, .half_angle = 20_deg}, scanner}};
  const Scene map = scene(line.seed, depth, wind, laser.wavelength);
  const Survey survey{drone, SingleRay{}, map, LightPaths{}, Receiver{}, FullWaveform{{.threshold = 20e-9}}, line.seed};
  ::scan(survey, line, "river",
         {.azimuth = 5_deg,
          .elevation = 7_deg,
          .field_of_view = 25_deg,
          .colour_by = io::ColourBy::kind,
          .point_size = 3});
}

}  // namespace river

int main(int argc, char** argv) {
  CommandLine line("Scans a foggy street with shop windows and mirrors, and a river with its bed.");
  double visibility = 150, step_deg = 0.15, depth = 3, wind = 3, pulse_rate_kHz = 30;
  line.add_number("--visibility", visibility, 20, 1000, "M", "Visibility in the fog of the street");
  line.add_number("--resolution", step_deg, 0.02, 5, "DEG",
                  "Angular step between pulses and between lines, in the street");
  line.add_number("--depth", depth, 0.5, 8, "M", "Depth of the river");
  line.add_number("--wind", wind, 0, 15, "M/S", "Speed of the wind over the river");
  line.add_number("--pulse-rate", pulse_rate_kHz, 1, 500, "kHz", "Pulse rate over the river");
  return line.run(argc, argv, [&] {
    town::scan(line, visibility, radians(step_deg));
    river::scan(line, depth, wind, 1e3 * pulse_rate_kHz);
  });
}
