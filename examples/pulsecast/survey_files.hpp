// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <pulsecast/helios/settings.hpp>

#include "notes.hpp"
#include "options.hpp"

/// What reads documents, apart from the rest so that it is compiled once.
struct SurveyFile {
  pulsecast::helios::SurveySettings survey;
  std::string text{}, scene_text{};       ///< of all settings, and of those of the scene: the same text, the same settings
  std::vector<std::string> leg_places{};  ///< where each leg stands in it, for messages
  std::string place{};                    ///< where the survey itself does
};
/// Reads the survey of the command line, and tells what is odd about it, also if something is wrong.
SurveyFile read_survey_file(const Options& options, Notes& notes);

/// The code of the reference system that all rasters of the scene have; 0 if there is none, or another one. Rasters that a part moves do
/// not count.
std::uint16_t reference_system_of(const pulsecast::helios::SceneSettings& scene);

/// What `write_survey_file` changes, of all channels.
struct WaveformChange {
  int rings = 0;        ///< `beamSampleQuality`
  double bin_size = 0;  ///< `binSize_ns` [s]
};

/// Writes the document of a survey with other settings, and all else as it stands there, comments too: through
/// symbolic links, with the mode that the file had. Throws a `FileError` and leaves what was there if what is written would not say the
/// same.
void write_survey_file(const Options& options, const SurveyFile& file, const WaveformChange& change, const std::filesystem::path& path);

/// Scanners and platforms in the assets that the program finds.
void print_catalogue(const Options& options);
