// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_BASE_GRAVITY_HPP
#define PULSECAST_BASE_GRAVITY_HPP

#include <pulsecast/base/namespace.hpp>

namespace PULSECAST_NAMESPACE {

/// Standard acceleration of gravity [m/s^2]. Source: 3rd CGPM, 1901.
inline constexpr double standard_gravity = 9.80665;

}  // namespace PULSECAST_NAMESPACE

#endif
