// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <pulsecast/base/expect.hpp>
#include <pulsecast/concepts.hpp>

namespace pulsecast {

/// A head that turns a whole instrument at a constant rate.
struct RotatingHead {
  double rate = 2 * pi;  ///< positive turns left about an axis that points up [rad/s]
  double start = 0;      ///< angle at the survey's start [rad]
  Vec3 axis = up;        ///< of any length but zero

  void validate() const {
    expect_finite("RotatingHead::rate", rate, "rad/s");
    expect_finite("RotatingHead::start", start, "rad");
    expect_positive("RotatingHead::axis (length)", length(axis), "");
  }

  [[nodiscard]] Pose<frame::Instrument, frame::Instrument> at(Tick t) const noexcept {
    return {rotation_about(axis, start + 2 * pi * t.phase(rate / (2 * pi))), {}};
  }
};

static_assert(Head<RotatingHead>);

}  // namespace pulsecast
