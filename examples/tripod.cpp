// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Scanner on a tripod: scans the mesh files of the command line (OBJ, PLY, glTF, GLB, STL, DAE or FBX), by default a
// wood, from several set-ups. Writes cloud.las, cloud.png, trajectory.txt, and cloud.xyz on request.

#include <cmath>
#include <cstddef>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <pulsecast/io/las.hpp>
#include <pulsecast/io/mesh_file.hpp>
#include <pulsecast/io/png.hpp>
#include <pulsecast/io/text_files.hpp>
#include <pulsecast/io/trajectory.hpp>
#include <pulsecast/pulsecast.hpp>

#include "command_line.hpp"
#include "summary.hpp"
#include "wood.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

/// Scanner: a polygon mirror of four facets sweeps the beam upwards, while the head turns once around. `step` is the
/// angle between pulses and between lines [rad].
auto set_up(const Vec3& foot, double step) {
  const Laser laser{.wavelength = 1550_nm, .peak_power = 10_W, .pulse_length = 4_ns, .divergence = 0.35_mrad};
  const Scanner scanner{
      .pulse_rate = 100_kHz, .pulses = static_cast<PulseIndex>(180_deg / step * 360_deg / step), .laser = laser};
  const PolygonMirror mirror{.line_rate = scanner.pulse_rate * step / 180_deg, .sweep = 90_deg, .angle_min = -70_deg};
  const RotatingHead head{.angular_rate = 360_deg / scanner.duration().seconds()};
  return Platform{Tripod{.position = foot}, Mount{.lever_arm = {0, 0, 1.7}},
                  Deflector{head, Deflector{mirror, scanner}}};
}

/// Scene of mesh files, a part for each node. Formats other than OBJ are read by a child process, as they may come from
/// anywhere.
Scene<MaskedMesh<>> read_scene(const std::vector<std::string>& files, bool y_up) {
  io::MeshFileSettings settings{.isolated = true};
  if (y_up) settings.up = io::UpAxis::y;
  std::vector<Part<MaskedMesh<>>> parts;
  for (const std::string& file : files) {
    io::MeshFile model = io::read_mesh_file(file, settings);
    for (const std::string& warning : model.warnings) std::cerr << "warning: " << warning << '\n';
    for (Part<MaskedMesh<>>& part : io::parts_of(std::move(model), static_cast<ObjectId>(parts.size())))
      parts.push_back(std::move(part));
  }
  return Scene<MaskedMesh<>>(std::move(parts));
}

/// Three places around a box, at the height of its floor.
std::vector<Vec3> places_around(const Box& box) {
  std::vector<Vec3> places;
  for (const double angle : {45_deg, 165_deg, 285_deg}) {
    const Vec3 aside = (0.5 * box.size() + Vec3(3)) * Vec3(std::sin(angle), std::cos(angle), 0);
    places.push_back(Vec3(box.centre().x, box.centre().y, box.min.z) + aside);
  }
  return places;
}

/// View along the path to the hut in the wood.
io::ImageSettings view_of_hut(std::uint64_t seed) {
  const Vec3 eye = wood::Terrain(seed).on({-12.6, -13.2}) + 3.2 * axis::up,
             sight = wood::Terrain(seed).on(wood::hut_place) + 2.5 * axis::up - eye;
  return {.azimuth = std::atan2(sight.x - 1, sight.y),
          .elevation = 5_deg,
          .field_of_view = 75_deg,
          .eye = eye,
          .colour_by = io::ColourBy::classification,
          .point_size = 3};
}

int main(int argc, char** argv) {
  CommandLine line("Scans the given mesh files, or a generated wood, with a scanner on a tripod.");
  std::vector<std::string> files;
  std::vector<Vec3> positions;
  double step_deg = 0.25;
  bool xyz = false, y_up = false;
  line.add_files("scene", files, "FILE",
                 "OBJ, PLY, glTF, GLB, STL, DAE or FBX files of the scene; without any, a generated wood");
  line.add_positions("-p,--position", positions, "Position of the tripod [m]; repeatable for further set-ups");
  line.add_number("-r,--resolution", step_deg, 0.005, 10, "DEG", "Angular step between pulses and between lines");
  line.add_flag("--y-up", y_up, "Vertical axis of the files is y; by default z, or as the file says");
  line.add_flag("--xyz", xyz, "Write the points as text, too");

  const auto scan = [&](const auto& scene) {
    if (positions.empty()) positions = files.empty() ? wood::glades(line.seed) : places_around(scene.bounds());
    std::vector<decltype(set_up({}, 1))> set_ups;
    for (const Vec3& place : positions) set_ups.push_back(set_up(place, radians(step_deg)));

    const Survey survey{Legs{set_ups}, LatticeFootprint{19}, scene, Receiver{}, FullWaveform{}, line.seed};
    io::LasWriter las(line.output / "cloud.las");
    io::ImageWriter image(line.output / "cloud.png", files.empty() ? view_of_hut(line.seed) : io::ImageSettings{});
    std::optional<io::XyzWriter> text;
    if (xyz) text.emplace(line.output / "cloud.xyz");
    const auto write_text = [&](const EchoBatch& batch) {
      if (text) (*text)(batch);
    };
    const RunSummary summary =
        run(survey, {.threads = line.threads, .progress = ProgressLine{}}, las, image, write_text);

    las.close();
    image.close();
    if (text) text->close();
    io::TrajectoryWriter trajectory(line.output / "trajectory.txt");
    const auto& legs = survey.source();
    for (std::size_t k = 0; k < set_ups.size(); ++k)
      trajectory.add(set_ups[k].trajectory(), legs.start(k), set_ups[k].duration(), 1);
    trajectory.close();

    std::cout << "Scanned from " << positions.size() << " set-ups; the results are in " << line.output.string()
              << ".\n";
    print(summary);
  };
  return line.run(argc, argv, [&] { files.empty() ? scan(wood::scene(line.seed)) : scan(read_scene(files, y_up)); });
}
