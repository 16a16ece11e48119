// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
// error: WorldSource|constraints not satisfied for class template .Survey
#include <pulsecast/deflector/deflector.hpp>
#include <pulsecast/deflector/polygon_mirror.hpp>
#include <pulsecast/detector/first_hit.hpp>
#include <pulsecast/platform/platform.hpp>
#include <pulsecast/platform/tripod.hpp>
#include <pulsecast/scanner/scanner.hpp>
#include <pulsecast/survey.hpp>

using namespace pulsecast;

struct Nothing {
  std::optional<Hit> closest_hit(const Ray&) const noexcept { return std::nullopt; }
};

int main() {
  const Deflector device{PolygonMirror{}, Scanner{}};
  const Platform platform{Tripod{}, Mount{}, device};
  const Nothing map;
#ifdef SHOULD_NOT_COMPILE
  const Survey survey{device, SingleRay{}, map, Receiver{}, FirstHit{}};
#else
  const Survey survey{platform, SingleRay{}, map, Receiver{}, FirstHit{}};
#endif
  return survey.size() > 0 ? 0 : 1;
}
