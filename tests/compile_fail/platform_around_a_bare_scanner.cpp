// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
// error: InstrumentSource|constraints not satisfied for class template .Platform
#include <pulsecast/deflector/deflector.hpp>
#include <pulsecast/deflector/polygon_mirror.hpp>
#include <pulsecast/platform/platform.hpp>
#include <pulsecast/platform/tripod.hpp>
#include <pulsecast/scanner/scanner.hpp>

using namespace pulsecast;

int main() {
#ifdef SHOULD_NOT_COMPILE
  const Platform platform{Tripod{}, Mount{}, Scanner{}};
#else
  const Platform platform{Tripod{}, Mount{}, Deflector{PolygonMirror{}, Scanner{}}};
#endif
  return platform.size() > 0 ? 0 : 1;
}
