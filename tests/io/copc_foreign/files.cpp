// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Writes the same points as LAS and as COPC, in pairs of files, for other programs to read and compare. Usage: files
// FOLDER.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include <pulsecast/io/copc.hpp>
#include <pulsecast/io/las.hpp>
#include <pulsecast/pulsecast.hpp>

#include "support/generators.hpp"
#include "support/scenes.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;
using namespace pulsecast::io;
namespace fs = std::filesystem;

namespace {

/// Sizes at which a survey of some ten thousand points takes many runs, blocks and pages.
constexpr io::detail::CopcSizes small{
    .leaf_points = 50, .block_points = 2000, .run_bytes = 200'000, .most_cells = 1000, .page_nodes = 1};

/// Hills with leaves above, from an airplane.
void write_survey(const fs::path& folder, const std::string& name, PulseIndex pulses,
                  const io::detail::CopcSizes& sizes = {}, const LasSettings& settings = {}) {
  support::Generator random(1);
  MeshData mesh = support::net(100, [](double x, double y) { return 8 * std::sin(x / 9) * std::cos(y / 7); });
  for (std::size_t i = 0; i < 30'000; ++i) {
    const Vec3 at{random.uniform(0, 100), random.uniform(0, 100), random.uniform(5, 25)};
    support::add_triangle(mesh, {at, at + random.point(0.5), at + random.point(0.5)});
  }
  Part<TriangleMesh<>> part;
  part.geometry = std::make_shared<const TriangleMesh<>>(std::move(mesh));
  part.placement.translation = {4e5, 5.6e6, 200};
  const Scene<TriangleMesh<>> scene({part});
  const Laser laser{.wavelength = 1550_nm, .peak_power = 5000_W, .pulse_length = 3_ns, .divergence = 1_mrad};
  const Scanner scanner{.pulse_rate = 100_kHz, .pulses = pulses, .laser = laser};
  const StraightLine line{.from = Vec3(4e5, 5.6e6, 200) + Vec3(50, 10, 300),
                          .to = Vec3(4e5, 5.6e6, 200) + Vec3(50, 90, 300),
                          .speed = 80 / std::max(scanner.duration().seconds(), 1e-3)};
  const Platform airplane{line, Mount{.boresight = extrinsic({{axis::right, -90_deg}, {axis::up, -90_deg}})},
                          Deflector{OscillatingMirror{.cycle_rate = 50_Hz, .half_angle = 9_deg}, scanner}};
  LasWriter las(folder / (name + ".las"), settings);
  io::detail::LasFileWriter<io::detail::CopcRecords> copc(folder / (name + ".copc.laz"), settings,
                                                          io::detail::CopcRecords(2, sizes));
  run(Survey{airplane, SunflowerFootprint{7}, scene, Receiver{}, FullWaveform{{.record_length = 20_ns}}}, {}, las,
      copc);
  las.close();
  copc.close();
}

/// Colours by height, none of every third pulse, and an attribute of the one object.
LasSettings of_heights(bool near_infrared) {
  Part<TriangleMesh<>> part;
  part.attributes = attributes({{"age", 80}});
  return {.colours = [](const EchoBatch&, const Shot& shot, const Echo& echo) -> std::optional<PointColour> {
            if (shot.index % 3 == 0) return std::nullopt;
            const auto high = static_cast<std::uint16_t>(200 * point_of(shot, echo).z);
            return PointColour{high, static_cast<std::uint16_t>(2 * high), 300, static_cast<std::uint16_t>(shot.index)};
          },
          .near_infrared = near_infrared,
          .attributes = std::make_shared<const ObjectAttributes>(std::span<const Part<TriangleMesh<>>>(&part, 1))};
}

}  // namespace

int main(int count, char** words) {
  if (count != 2) return 2;
  const fs::path folder = words[1];
  fs::create_directories(folder);
  write_survey(folder, "none", 0);
  write_survey(folder, "one", 1);
  write_survey(folder, "usual", 150'000, {}, {.epsg = 25832, .start_time = 3e8});
  write_survey(folder, "pages", 20'000, small);
  write_survey(folder, "amplitude", 20'000, small, {.intensity = LasIntensity::amplitude});
  write_survey(folder, "colours", 20'000, small, of_heights(false));
  write_survey(folder, "near_infrared", 20'000, small, of_heights(true));
}
