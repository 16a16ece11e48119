// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include <pulsecast/concepts.hpp>

namespace pulsecast::support {

/// What a detector makes of reflections of a laser's pulse, without a gate.
template <class D, class Workspace>
[[nodiscard]] Detection detect(const D& detector, const Laser& laser, std::span<Reflection> reflections, Workspace& workspace,
                               const RandomKey& key = {}) {
  const Emitter emitter{.laser = laser};
  return detector.detect(Heard{emitter, {}, reflections, key}, workspace);
}

}  // namespace pulsecast::support
