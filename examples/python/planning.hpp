// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <pybind11/pybind11.h>

/// Planners of flights.

/// Makes the functions.
void bind_planning(pybind11::module_& m);
