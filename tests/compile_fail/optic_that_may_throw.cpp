// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
// error: static.assert.*(Motion|Optic)
#include <pulsecast/concepts.hpp>

using namespace pulsecast;

struct Mirror {
#ifdef SHOULD_NOT_COMPILE
  Pose<frame::Beam, frame::Instrument> at(Tick) const { return {}; }
#else
  Pose<frame::Beam, frame::Instrument> at(Tick) const noexcept { return {}; }
#endif
};
static_assert(Optic<Mirror>);

int main() {}
