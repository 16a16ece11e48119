// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "options.hpp"

/// Prints what this installation can do, a line for each ability. A line with `missing` names the remedy.
void print_abilities(const Options& options);
