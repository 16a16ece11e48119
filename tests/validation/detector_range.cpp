// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// A wall at coordinates as large as UTM has them, scanned from near and far: the range of every return.

#include <cmath>
#include <cstddef>
#include <memory>
#include <string>
#include <utility>

#include <doctest/doctest.h>

#include <pulsecast/base/units.hpp>
#include <pulsecast/deflector/deflector.hpp>
#include <pulsecast/deflector/oscillating_mirror.hpp>
#include <pulsecast/detector/analytic_waveform.hpp>
#include <pulsecast/detector/first_hit.hpp>
#include <pulsecast/detector/full_waveform.hpp>
#include <pulsecast/platform/platform.hpp>
#include <pulsecast/platform/tripod.hpp>
#include <pulsecast/scanner/footprint.hpp>
#include <pulsecast/scanner/scanner.hpp>
#include <pulsecast/scene/scene.hpp>
#include <pulsecast/shape/triangle_mesh.hpp>
#include <pulsecast/survey.hpp>

#include "validation/table.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;
using namespace pulsecast::validation;

namespace {

const Vec3 station{476200.123, 5474300.456, 312.789};

/// A wall to the north of the station, a thousand cells of different sizes.
Scene<TriangleMesh<>> wall(double distance) {
  MeshData mesh;
  const std::uint32_t cells = 20;
  for (std::uint32_t j = 0; j <= cells; ++j)
    for (std::uint32_t i = 0; i <= cells; ++i)
      mesh.vertices.push_back(
          station + distance * Vec3{0.1 * i - 1 + 0.013 * std::sin(7 * i), 1, 0.1 * j - 1 + 0.017 * std::sin(5 * j)});
  for (std::uint32_t j = 0; j < cells; ++j)
    for (std::uint32_t i = 0; i < cells; ++i) {
      const std::uint32_t a = j * (cells + 1) + i, c = a + cells + 1;
      mesh.triangles.push_back({a, a + 1, c + 1});
      mesh.triangles.push_back({a, c + 1, c});
    }
  Scene<TriangleMesh<>>::Part part;
  part.geometry = std::make_shared<const TriangleMesh<>>(std::move(mesh));
  return Scene<TriangleMesh<>>({part});
}

/// The largest error of the range [mm] in a scan by 20 degrees to either side.
template <class Pattern, class D>
double worst(double distance, const Pattern& footprint, const D& detector) {
  const Laser laser{.pulse_length = 4e-9, .divergence = 0.3e-3};
  const Platform source{Tripod{.position = station}, Mount{},
                        Deflector{OscillatingMirror{.cycle_rate = 37, .half_angle = radians(20)},
                                  Scanner{.pulse_rate = 10e3, .pulses = 2000, .laser = laser}}};
  const auto map = wall(distance);
  const Survey survey{source, footprint, map, Receiver{}, detector};
  auto workspace = survey.workspace();
  double error = 0;
  for (PulseIndex i = 0; i < survey.size(); ++i) {
    const Outcome o = survey(i, workspace);
    REQUIRE(o.echoes.size() == 1);
    error = std::fmax(error, std::fabs(o.echoes[0].range - distance / o.shot.direction.y));
  }
  return error * 1e3;
}

}  // namespace

TEST_CASE("range of a wall at UTM coordinates") {
  const WaveformSettings settings{.threshold = 0, .timing = EchoTiming::true_range};
  for (const double distance : {1.0, 100.0, 10000.0}) {
    const std::string text =
        "wall at " + std::to_string(static_cast<int>(distance)) + " m: largest error of 2000 ranges [mm]";
    row("FirstHit, " + text, 0, worst(distance, SingleRay{}, FirstHit{}), 0.1);
    row(Kind::consistency, "AnalyticWaveform, 19 subrays, " + text, 0,
        worst(distance, RingFootprint(3), AnalyticWaveform(settings)), 0.1);
    row(Kind::consistency, "FullWaveform, 19 subrays, " + text, 0,
        worst(distance, RingFootprint(3), FullWaveform(settings)), 0.1);
  }
}
