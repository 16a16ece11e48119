// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <pulsecast/echo.hpp>
#include <pulsecast/helios/survey.hpp>
#include <pulsecast/io/las_settings.hpp>

#include "options.hpp"

/// Names of the files of points of a prefix: one, or one for each channel.
std::vector<std::filesystem::path> point_files(const std::filesystem::path& folder, const std::string& prefix, const Options& options,
                                               const std::vector<std::string>& channels);

/// Names of all files of a prefix.
std::vector<std::filesystem::path> leg_files(const std::filesystem::path& folder, const std::string& prefix, const Options& options,
                                             const std::vector<std::string>& channels);

/// How they are written as LAS or LAZ.
pulsecast::io::LasSettings las_settings(const Options& options, double start_time);

/// The files of one leg, or of all legs of a strip. Each is there when it is whole, and not before.
class LegFiles {
 public:
  /// `prefix` as in `leg000`; `channels` are their ids if each is to have a file of its own.
  LegFiles(const std::filesystem::path& folder, const std::string& prefix, const Options& options, double start_time,
           const std::vector<std::string>& channels);
  ~LegFiles();
  LegFiles(const LegFiles&) = delete;
  LegFiles& operator=(const LegFiles&) = delete;

  void operator()(const pulsecast::EchoBatch& batch);
  void add_trajectory(const pulsecast::helios::SurveyLeg& leg, pulsecast::Tick start, double interval);
  void close();

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;
};

/// A sink for a picture.
class Picture {
 public:
  explicit Picture(const std::filesystem::path& path);
  ~Picture();
  Picture(const Picture&) = delete;
  Picture& operator=(const Picture&) = delete;
  void operator()(const pulsecast::EchoBatch& batch);
  void close();

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;
};
