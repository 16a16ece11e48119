// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include <pulsecast/helios/survey.hpp>
#include <pulsecast/run.hpp>

#include "options.hpp"
#include "point_files.hpp"

/// Page of the points of a run.
std::unique_ptr<PointFile> page_file(const std::filesystem::path& path, const pulsecast::helios::SurveySettings& survey,
                                     const pulsecast::helios::CompiledSurvey& compiled, const Options& options);

/// Page file and live page of a run, if requested.
class Pages {
 public:
  Pages(const Options& options, const pulsecast::helios::SurveySettings& survey);
  ~Pages();
  Pages(const Pages&) = delete;
  Pages& operator=(const Pages&) = delete;

  /// URL of the live page; empty if there is none.
  [[nodiscard]] std::string address() const;

  /// Starts a run with results in a folder.
  void begin(const std::filesystem::path& folder, const pulsecast::helios::CompiledSurvey& compiled,
             const Options& options);
  void operator()(const pulsecast::EchoBatch& batch);
  void show(const pulsecast::Progress& progress);
  [[nodiscard]] bool stop_requested() const;
  /// Ends the run and writes its page.
  void end();
  /// Ends the last run: live viewers get the remaining points.
  void finish(bool complete);

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;
};
