// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "loading.hpp"
#include "notes.hpp"
#include "options.hpp"
#include "survey_files.hpp"

/// Command `forecast`: prints the cost of a run and the cheapest settings within the limits. False if there are none.
bool forecast(const Options& options, const SurveyFile& file, const Loading& loading, Notes& notes);
