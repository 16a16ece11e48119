// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include <doctest/doctest.h>

#include <pulsecast/pulsecast.hpp>
#include <pulsecast/sensor/velodyne.hpp>

#include "support/checksum.hpp"
#include "support/relative.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

namespace {

/// Ground of 100 by 100 cells, with heights by integers alone.
MeshData rough_ground() {
  constexpr std::uint32_t cells = 100;
  MeshData mesh;
  std::uint64_t state = 1;
  for (std::uint32_t y = 0; y <= cells; ++y)
    for (std::uint32_t x = 0; x <= cells; ++x) {
      state = state * 6364136223846793005 + 1442695040888963407;  // Knuth's MMIX
      mesh.vertices.push_back({x - 50.0, y - 50.0, static_cast<double>(state >> 32) * 0x1p-31});
    }
  for (std::uint32_t y = 0; y < cells; ++y)
    for (std::uint32_t x = 0; x < cells; ++x) {
      const std::uint32_t a = y * (cells + 1) + x, b = a + 1, c = a + cells + 1, d = c + 1;
      mesh.triangles.push_back({a, b, d});
      mesh.triangles.push_back({a, d, c});
    }
  return mesh;
}

/// Checksum of all numbers of shots and echoes.
std::string checksum(const auto& survey) {
  support::Checksum sum;
  run(survey, {}, [&](const EchoBatch& batch) { sum.add(batch); });
  return sum.hex();
}

}  // namespace

TEST_CASE("a survey has the same bytes on every processor, unless products and sums are contracted") {
  if (support::contracted()) return;  // then the last bits are the compiler's choice
  const Scene<TriangleMesh<>> scene({{.geometry = std::make_shared<const TriangleMesh<>>(rough_ground())}});
  const Tripod tripod{.position = {0, 0, 3}};
  const Mount mount{.lever_arm = {0, 0, 1.7}};
  const Deflector sweeping{PolygonMirror{.line_rate = 100_Hz}, Scanner{.pulse_rate = 100_kHz, .pulses = 4000}};
  const Platform scanner{tripod, mount, Deflector{RotatingHead{.angular_rate = 36_deg}, sweeping}};
  CHECK(checksum(Survey{scanner, SingleRay{}, scene, Receiver{}, FirstHit{}}) ==
        "1aa09a55c5979be7f3a24186dd3ba45d246baa7c38da1c194d9485f57bcf1dc0");
  CHECK(checksum(Survey{scanner, LatticeFootprint{19}, scene, Receiver{}, FullWaveform{}}) ==
        "a0631f1103bd65930518c3f96088f5e195117414d67cd546801ae6753c005c54");
  const SpinningSensor sensor = velodyne_vlp_16();
  const Platform robot{tripod, mount, sensor.source(0.02)};
  CHECK(checksum(Survey{robot, SingleRay{}, scene, sensor.receiver(), FirstHit{}}) ==
        "28e0e6c33df35dfeacac8045cc001ef1fad6d28b8c2bf4258d9d80ce797ffdd0");
}
