// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

/// What a run must know to be gone on with, in a file beside its results until it is complete.
struct RunLog {
  static constexpr const char* name = "unfinished.txt";
  std::uint64_t seed = 0;
  double start_time = 0;           ///< of the first repetition [s]
  int run = 0;                     ///< which repetition this is
  std::string how{};               ///< what else decides about the results
  std::string before{};            ///< folder of the repetition before, whose log may not be gone yet
  std::vector<std::string> cut{};  ///< prefixes of files that are whole, but end too early

  void write(const std::filesystem::path& folder) const;
  /// Throws a `FileError` if it is not as it was written.
  static RunLog read(const std::filesystem::path& folder);
  /// What is complete needs none any more.
  static void remove(const std::filesystem::path& folder);
};

/// The newest runs of a survey.
struct RunFolders {
  std::optional<std::filesystem::path> unfinished{}, newest{};
};
RunFolders runs_in(const std::filesystem::path& parent);

/// A folder of its own for each run, by the time of its start; it has its log from the beginning.
std::filesystem::path new_run_folder(const std::filesystem::path& parent, const RunLog& log);
