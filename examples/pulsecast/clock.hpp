// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

#include <pulsecast/helios/simulation.hpp>

#include "notes.hpp"
#include "options.hpp"

/// Second of the GPS week for a time in UTC, in seconds since 1970.
double gps_week_seconds(std::int64_t unix_time);

/// Time given by a user as --gpsStartTime, in seconds since 1970; now if the text is empty. Throws
/// std::invalid_argument.
std::int64_t unix_time_of(const std::string& text);

/// Chooses the clock of LAS files for times of a run [s]: that of a GPS week, unless a trajectory begins beyond one.
/// Throws std::invalid_argument for times that the format does not have. Source: LAS 1.4 R15, Global Encoding, GPS Time
/// Type.
void settle_clock(Options& options, const pulsecast::helios::Simulation& simulation, double begin, double end,
                  Notes& notes);
