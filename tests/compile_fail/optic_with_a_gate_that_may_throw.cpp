// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
// error: open.Tick. must be const and noexcept
#include <pulsecast/deflector/deflector.hpp>
#include <pulsecast/scanner/scanner.hpp>

using namespace pulsecast;

struct Shutter {
  Pose<frame::Beam, frame::Instrument> at(Tick) const noexcept { return {}; }
#ifdef SHOULD_NOT_COMPILE
  bool open(Tick) const { return true; }
#else
  bool open(Tick) const noexcept { return true; }
#endif
};

int main() {
  const Deflector deflector{Shutter{}, Scanner{}};
  return deflector.pulse(0) ? 0 : 1;
}
