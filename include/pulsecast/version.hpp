// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_VERSION_HPP
#define PULSECAST_VERSION_HPP

/// The version of the library; CMake reads it here.
#define PULSECAST_VERSION "0.3.0"

#endif
