// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <pulsecast/helios/document.hpp>
#include <pulsecast/helios/settings.hpp>

#include "notes.hpp"
#include "options.hpp"

/// Survey document with its texts. Documents are read in one source file, which compiles once.
struct SurveyFile {
  pulsecast::helios::SurveySettings survey;
  std::string text{}, scene_text{};       ///< of all settings, and of the scene's: equal texts mean equal settings
  std::vector<std::string> leg_places{};  ///< position of each leg, for messages
  std::string place{};                    ///< position of the survey
};
/// Reads the survey of the command line. Notes its warnings, also if it throws.
SurveyFile read_survey_file(const Options& options, Notes& notes);

/// Changes by `write_survey_file`, to all channels.
struct WaveformChange {
  int rings = 0;        ///< `beamSampleQuality`
  double bin_size = 0;  ///< `binSize_ns` [s]
};

/// Writes a survey document with other settings and keeps the rest, comments too. Follows symbolic links and keeps the
/// file mode. Throws a `FileError` and keeps the old file if the new text would give another survey.
void write_survey_file(const Options& options, const SurveyFile& file, const WaveformChange& change,
                       const std::filesystem::path& path);

/// Document with scanners or platforms.
struct CatalogueDocument {
  std::filesystem::path path;
  pulsecast::helios::AssetDocument assets;
};
/// Those in folders and their `data/`. Documents with faults are left out; noted if `verbose`.
std::vector<CatalogueDocument> read_catalogue(const Options& options,
                                              const std::vector<std::filesystem::path>& folders);

/// Prints the scanners and platforms in the program's assets.
void print_catalogue(const Options& options);
