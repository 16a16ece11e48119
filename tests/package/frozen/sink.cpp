// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// User-defined sinks, beside one of the library: heights by column of a grid, and a lambda.
#include <algorithm>
#include <array>
#include <fstream>
#include <iostream>
#include <iterator>
#include <memory>
#include <string>

#include <pulsecast/io/las.hpp>
#include <pulsecast/pulsecast.hpp>

using namespace pulsecast;
using namespace pulsecast::literals;

struct HighestByColumn {
  std::array<double, 8> z{};  // [m], by easting
  void operator()(const EchoBatch& batch) {
    for (const Shot& shot : batch.shots)
      for (const Echo& echo : batch.echoes_of(shot)) {
        const Vec3 point = point_of(shot, echo);
        double& highest = z[static_cast<std::size_t>(std::clamp(point.x + 4, 0.0, 7.0))];
        highest = std::max(highest, point.z);
      }
  }
};
static_assert(EchoSink<HighestByColumn>);

int main() {
  const MeshData gable{.vertices = {{-4, 8, 0}, {4, 8, 0}, {4, 8, 3}, {0, 8, 6}, {-4, 8, 3}},
                       .triangles = {{0, 1, 2}, {0, 2, 4}, {4, 2, 3}}};
  const Scene<TriangleMesh<>> scene({{.geometry = std::make_shared<const TriangleMesh<>>(gable), .object = 5}});
  const Deflector turning{
      RotatingHead{.angular_rate = 36_deg},
      Deflector{PolygonMirror{.line_rate = 50_Hz}, Scanner{.pulse_rate = 10_kHz, .pulses = 100'000}}};
  const Platform platform{Tripod{}, Mount{.lever_arm = {0, 0, 1.7}}, turning};
  const Survey survey{platform, RingFootprint{2}, scene, Receiver{}, FullWaveform{}};

  HighestByColumn highest;
  std::array<std::uint64_t, 2> pulses{};
  const auto count = [&](const EchoBatch& batch) {
    for (const Shot& shot : batch.shots) ++pulses[batch.echoes_of(shot).empty() ? 0 : 1];
  };
  io::LasWriter las("gable.las");
  const RunSummary summary = run(survey, {}, highest, count, las);
  las.close();
  std::cout << summary.echoes << " echoes of " << pulses[1] << " pulses\n";
  for (const double z : highest.z) std::cout << std::hexfloat << z << '\n';

  // FNV-1a of the records, which follow a header that states the day
  std::ifstream file("gable.las", std::ios::binary);
  const std::string bytes(std::istreambuf_iterator<char>(file), {});
  const auto offset = static_cast<std::size_t>(static_cast<unsigned char>(bytes[96])) +
                      256 * static_cast<std::size_t>(static_cast<unsigned char>(bytes[97]));
  std::uint64_t digest = 14695981039346656037u;
  for (std::size_t i = offset; i < bytes.size(); ++i)
    digest = (digest ^ static_cast<unsigned char>(bytes[i])) * 1099511628211u;
  std::cout << bytes.size() << ' ' << digest << '\n';
}
