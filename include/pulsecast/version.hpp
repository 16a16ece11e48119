// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

/// The version of the library; CMake reads it here.
#define PULSECAST_VERSION "0.1.1"
