// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <pulsecast/adapters/survey_settings.hpp>

#include "options.hpp"

/// What reads documents, apart from the rest so that it is compiled once.
struct SurveyFile {
  pulsecast::adapters::SurveySettings survey;
  std::vector<std::string> warnings;
  std::string text{}, scene_text{};  ///< of all settings, and of those of the scene: the same text, the same settings
};
SurveyFile read_survey_file(const Options& options);

/// Scanners and platforms in the assets that the program finds.
void print_catalogue(const Options& options);
