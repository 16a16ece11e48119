// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
// error: error: .*run: a sink must be callable with one batch
// option: -Wfatal-errors
#include <pulsecast/deflector/deflector.hpp>
#include <pulsecast/deflector/polygon_mirror.hpp>
#include <pulsecast/detector/first_hit.hpp>
#include <pulsecast/platform/platform.hpp>
#include <pulsecast/platform/tripod.hpp>
#include <pulsecast/run.hpp>
#include <pulsecast/scanner/scanner.hpp>

using namespace pulsecast;

struct Nothing {
  std::optional<Hit> closest_hit(const Ray&) const noexcept { return std::nullopt; }
};

int main() {
  const Deflector device{PolygonMirror{}, Scanner{}};
  const Platform platform{Tripod{}, Mount{}, device};
  const Nothing map;
  const Survey survey{platform, SingleRay{}, map, Receiver{}, FirstHit{}};
#ifdef SHOULD_NOT_COMPILE
  run(survey, {}, [](const Echo&) {});
#else
  run(survey, {}, [](const EchoBatch&) {});
#endif
}
