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

/// What a run must know to be gone on with, in a file beside its results until it is complete.
struct RunLog {
  static constexpr const char* name = "unfinished.txt";
  std::uint64_t seed = 0;
  double start_time = 0;                          ///< of the first repetition [s]
  int run = 0;                                    ///< which repetition this is
  std::string how{};                              ///< what else decides about the results
  std::map<std::string, std::string> inputs{};    ///< files that do, and the fingerprint of each
  std::string before{};                           ///< folder of the repetition before, whose log may not be gone yet
  std::map<std::string, std::uintmax_t> files{};  ///< results that are whole, and their sizes [byte]

  /// Reads what `text()` says, and what `add_files()` has added since; of this, a last line without its end does not count. Throws a
  /// `FileError` that names `path` and the line if it is not as a run leaves it.
  static RunLog parse(std::string_view text, const std::string& path);
  [[nodiscard]] std::string text() const;

  void write(const std::filesystem::path& folder) const;
  /// The text of a log. Throws a `FileError` if it cannot be read.
  static std::string text_in(const std::filesystem::path& folder);
  /// Notes that results are whole, in the file of the log, too.
  void add_files(const std::filesystem::path& folder, const std::vector<std::filesystem::path>& whole);
  /// Those of the results that are not there, or not as long as when they were noted as whole.
  [[nodiscard]] std::vector<std::filesystem::path> damaged(const std::vector<std::filesystem::path>& results) const;
  /// Whether all these results were noted as whole.
  [[nodiscard]] bool names(const std::vector<std::filesystem::path>& results) const;
  /// What is complete needs none any more. Its results are on the disk then, names and all.
  static void remove(const std::filesystem::path& folder);
};

/// A name as it stands in a log: without control characters, each of which becomes `\x` and two digits.
[[nodiscard]] std::string written_name(const std::string& name);

/// The right to write to the folder of a run. It is a lock of the system on a file in the folder, which ends with the process, however
/// that ends; where the file system has no locks, there is none. The file is removed with the lock.
class RunLock {
 public:
  static constexpr const char* name = ".lock";

  /// Throws a `FileError` that names the folder and the process that writes to it, if one does.
  explicit RunLock(const std::filesystem::path& folder);
  RunLock(RunLock&& other) noexcept : path_(std::move(other.path_)), file_(std::exchange(other.file_, -1)) {}
  RunLock& operator=(RunLock&& other) noexcept {
    std::swap(path_, other.path_), std::swap(file_, other.file_);
    return *this;
  }
  ~RunLock();

  /// The folder has another name now.
  void renamed(const std::filesystem::path& folder) { path_ = folder / name; }

 private:
  std::filesystem::path path_;
  int file_ = -1;
};

/// The newest runs of a survey.
struct RunFolders {
  std::optional<std::filesystem::path> unfinished{}, newest{};
};
RunFolders runs_in(const std::filesystem::path& parent);

/// The same; the one that is unfinished is locked by `lock`, and still unfinished then. Throws if it is being written.
RunFolders lock_unfinished(const std::filesystem::path& parent, std::optional<RunLock>& lock);

/// A folder of its own for each run, by the time of its start; it has its log and its lock from the beginning.
std::pair<std::filesystem::path, RunLock> new_run_folder(const std::filesystem::path& parent, const RunLog& log);
