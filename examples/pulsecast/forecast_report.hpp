// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "options.hpp"
#include "simulation.hpp"
#include "survey_files.hpp"

/// The command `forecast`: says what a run would come to, and the cheapest settings that meet what is asked. False if none does.
bool forecast(const Options& options, const SurveyFile& file, const Simulation::Settings& settings, Notes& notes);
