// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <pulsecast/echo.hpp>
#include <pulsecast/helios/simulation.hpp>
#include <pulsecast/helios/survey.hpp>
#include <pulsecast/io/las.hpp>
#include <pulsecast/io/text_files.hpp>

#include "options.hpp"
#include "point_files.hpp"

/// Adds the data of a loaded survey that the writers need. Throws std::invalid_argument for a survey that the format
/// cannot hold.
void take_columns(Options& options, const pulsecast::helios::SurveySettings& survey,
                  const pulsecast::helios::Simulation& simulation);

/// Ids of the channels that have point files of their own; empty for one file.
std::vector<std::string> file_channels(const Options& options, const pulsecast::helios::SurveySettings& survey);

/// Prefix of what is of all legs.
inline const std::string whole_run = "leg";

/// Prefix of the files of a leg, such as `leg000`, or of its strip.
std::string prefix_of(const pulsecast::helios::CompiledSurvey::Leg& leg);

/// Names of the point files of a prefix: one, or one per channel.
std::vector<std::filesystem::path> point_files(const std::filesystem::path& folder, const std::string& prefix,
                                               const Options& options, const std::vector<std::string>& channels);

/// Names of all files of a prefix.
std::vector<std::filesystem::path> leg_files(const std::filesystem::path& folder, const std::string& prefix,
                                             const Options& options, const std::vector<std::string>& channels);

/// Settings for LAS, LAZ and COPC files.
pulsecast::io::LasSettings las_settings(const Options& options, double start_time);

/// Columns of formats of any columns.
pulsecast::io::PointLayout point_layout(const Options& options);

/// Further columns of text files.
pulsecast::io::PointTextColumns text_columns(const Options& options);

/// Files of one leg, or of all legs of a strip. A file appears only when it is complete.
class LegFiles {
 public:
  /// `prefix` is like `leg000`; `channels` are ids for separate files, empty for one file.
  LegFiles(const std::filesystem::path& folder, const std::string& prefix, const Options& options, double start_time,
           const std::vector<std::string>& channels);
  ~LegFiles();
  LegFiles(const LegFiles&) = delete;
  LegFiles& operator=(const LegFiles&) = delete;

  void operator()(const pulsecast::EchoBatch& batch);
  [[nodiscard]] bool reads_empty_shots() const noexcept;  ///< as the concept ChoosesShots describes
  void add_trajectory(const pulsecast::helios::SurveyLeg& leg, pulsecast::Tick start, double interval);
  void close();
  [[nodiscard]] LeftOut left_out() const;

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;
};

/// File of trajectories and footprints.
std::unique_ptr<PointFile> map_file(const std::filesystem::path& path, const Options& options);

/// Picture of the points, in front of the hillshade of the scene's rasters.
std::unique_ptr<PointFile> picture_file(const std::filesystem::path& path,
                                        const pulsecast::helios::SurveySettings& survey);
