// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include <pulsecast/helios/survey.hpp>
#include <pulsecast/run.hpp>

#include "options.hpp"

/// The page that a run leaves, and the one that shows it while it goes on, as far as they are asked for.
class Pages {
 public:
  Pages(const Options& options, const pulsecast::helios::SurveySettings& survey);
  ~Pages();
  Pages(const Pages&) = delete;
  Pages& operator=(const Pages&) = delete;

  /// Where the run can be watched; empty if it cannot.
  [[nodiscard]] std::string address() const;

  /// A run begins, whose results are left in a folder.
  void begin(const std::filesystem::path& folder, const pulsecast::helios::CompiledSurvey& compiled);
  void operator()(const pulsecast::EchoBatch& batch);
  void tell(const pulsecast::Progress& progress);
  [[nodiscard]] bool stop_requested() const;
  /// The run is over: leaves its page.
  void end();
  /// There are no further runs: whoever watches gets the rest.
  void finish(bool complete);

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;
};
