// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
// error: no match for .operator\*.|invalid operands to binary expression
#include <pulsecast/base/frame.hpp>

using namespace pulsecast;

int main() {
  const Pose<frame::Body, frame::World> world_from_body;
  const Pose<frame::Instrument, frame::Body> body_from_instrument;
#ifdef SHOULD_NOT_COMPILE
  const auto pose = body_from_instrument * world_from_body;
#else
  const auto pose = world_from_body * body_from_instrument;
#endif
  return pose.position == Vec3{} ? 0 : 1;
}
