// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
// error: BeamSource|Head|constraints not satisfied for class template .Deflector
#include <pulsecast/deflector/deflector.hpp>
#include <pulsecast/deflector/polygon_mirror.hpp>
#include <pulsecast/deflector/rotating_head.hpp>
#include <pulsecast/scanner/scanner.hpp>

using namespace pulsecast;

int main() {
  const Deflector mirror{PolygonMirror{}, Scanner{}};
#ifdef SHOULD_NOT_COMPILE
  const Deflector deflector{PolygonMirror{}, mirror};
#else
  const Deflector deflector{RotatingHead{}, mirror};
#endif
  return deflector.size() > 0 ? 0 : 1;
}
