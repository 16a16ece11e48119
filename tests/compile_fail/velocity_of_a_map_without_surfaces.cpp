// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
// error: error: .*the detector reads velocities, which this map does not give
// option: -Wfatal-errors
#include <array>

#include <pulsecast/deflector/deflector.hpp>
#include <pulsecast/deflector/polygon_mirror.hpp>
#include <pulsecast/platform/platform.hpp>
#include <pulsecast/platform/tripod.hpp>
#include <pulsecast/run.hpp>
#include <pulsecast/scanner/scanner.hpp>

using namespace pulsecast;

struct Nothing {
  std::optional<Hit> closest_hit(const Ray&) const noexcept { return std::nullopt; }
};

struct Doppler {
#ifdef SHOULD_NOT_COMPILE
  static constexpr bool reads_velocity = true;
#endif
  using Workspace = std::array<Echo, 1>;
  Workspace workspace(std::size_t) const { return {}; }
  Detection detect(const DetectorInput&, Workspace&) const noexcept { return {}; }
};

int main() {
  const Platform platform{Tripod{}, Mount{}, Deflector{PolygonMirror{}, Scanner{}}};
  const Nothing map;
  run(Survey{platform, SingleRay{}, map, Receiver{}, Doppler{}}, {});
}
