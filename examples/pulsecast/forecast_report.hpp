// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "loading.hpp"
#include "notes.hpp"
#include "options.hpp"
#include "survey_files.hpp"

/// The command `forecast`: says what a run would come to, and the cheapest settings that meet what is asked. False if none does.
bool forecast(const Options& options, const SurveyFile& file, const Loading& loading, Notes& notes);
