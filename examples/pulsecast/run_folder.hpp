// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// Data for resuming a run, in a file beside its results until it is complete.
struct RunLog {
  static constexpr const char* name = "unfinished.txt";
  std::uint64_t seed = 0;
  double start_time = 0;                          ///< of the first repetition [s]
  int run = 0;                                    ///< index of this repetition
  std::string how{};                              ///< other inputs of the results, as text
  std::map<std::string, std::string> inputs{};    ///< input files, with their fingerprints
  std::string before{};                           ///< folder of the previous repetition, if its log may still exist
  std::map<std::string, std::uintmax_t> files{};  ///< complete results, with their sizes [byte]

  /// Parses `text()` and the lines of `add_files()` since then; ignores a last line without its end. Throws a
  /// `FileError` with `path` and the line if the text is not that of a run.
  static RunLog parse(std::string_view text, const std::string& path);
  [[nodiscard]] std::string text() const;

  void write(const std::filesystem::path& folder) const;
  /// Text of a log. Throws a `FileError` if it cannot be read.
  static std::string text_in(const std::filesystem::path& folder);
  /// Records complete results, also in the log file.
  void add_files(const std::filesystem::path& folder, const std::vector<std::filesystem::path>& whole);
  /// Results that are missing, or differ in size from their record.
  [[nodiscard]] std::vector<std::filesystem::path> damaged(const std::vector<std::filesystem::path>& results) const;
  /// True if all these results are recorded as complete.
  [[nodiscard]] bool names(const std::vector<std::filesystem::path>& results) const;
  /// Removes the log of a complete run, after syncing the folder to disk.
  static void remove(const std::filesystem::path& folder);
};

/// Exclusive right to write to a run folder: a system lock on a file there. It ends with the process in any case. File
/// systems without locks give no protection. The destructor removes the file.
class RunLock {
 public:
  static constexpr const char* name = ".lock";

  /// Throws a `FileError` with the folder and its writer, if another process writes to it.
  explicit RunLock(const std::filesystem::path& folder);
  RunLock(RunLock&& other) noexcept : path_(std::move(other.path_)), file_(std::exchange(other.file_, -1)) {}
  RunLock& operator=(RunLock&& other) noexcept {
    std::swap(path_, other.path_);
    std::swap(file_, other.file_);
    return *this;
  }
  ~RunLock();

  /// Updates the name of the folder.
  void renamed(const std::filesystem::path& folder) { path_ = folder / name; }

 private:
  std::filesystem::path path_;
  int file_ = -1;
};

/// Newest runs of a survey.
struct RunFolders {
  std::optional<std::filesystem::path> unfinished{}, newest{};
};
RunFolders runs_in(const std::filesystem::path& parent);

/// Newest runs; locks the unfinished one, which is still unfinished then. Throws if it is being written.
RunFolders lock_unfinished(const std::filesystem::path& parent, std::optional<RunLock>& lock);

/// Makes a folder for a run, named by its start time, with log and lock from the beginning.
std::pair<std::filesystem::path, RunLock> new_run_folder(const std::filesystem::path& parent, const RunLog& log);
