// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <pybind11/pybind11.h>

#include <pulsecast/helios/simulation.hpp>

// Files of a run, by the functions and options of the survey program.

/// Gives each text as a UserWarning of Python. Requires the GIL.
void warn(const std::vector<std::string>& texts);

/// Adds the method `run`, to arrays, files, or both.
void bind_run_to_files(pybind11::class_<pulsecast::helios::Simulation>& simulation);

/// Adds the method `write` to `Batch`.
void bind_write(pybind11::module_& m);
