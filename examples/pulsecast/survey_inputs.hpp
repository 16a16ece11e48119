// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <pulsecast/helios/settings.hpp>
#include <pulsecast/io/scene_cache.hpp>

/// Input files of a survey besides its documents: scene, spectra and trajectories.
class SurveyInputs {
 public:
  SurveyInputs(const pulsecast::helios::SurveySettings& survey, const std::vector<std::filesystem::path>& assets);

  [[nodiscard]] const std::set<std::filesystem::path>& scene() const noexcept {
    return scene_;
  }  ///< files in its settings
  [[nodiscard]] const std::vector<std::filesystem::path>& spectra() const noexcept { return spectra_; }  ///< folders

  /// Adds the files that a builder of the scene has looked for.
  void add(const std::set<std::filesystem::path>& files) { others_.insert(files.begin(), files.end()); }

  /// Fingerprint of the content of a file, or of a folder of spectra; zero if it cannot be read. Rereads a file only if
  /// its size or times have changed. Throws a `FileError` if it has changed since the first call.
  [[nodiscard]] pulsecast::io::Fingerprint fingerprint(const std::filesystem::path& path);

  /// Fingerprint of each file and folder of spectra, in hexadecimal digits.
  [[nodiscard]] std::map<std::string, std::string> fingerprints();

 private:
  /// Device, inode, size and times of a file: equal marks mean an equal file.
  using Mark = std::vector<std::uint64_t>;

  std::set<std::filesystem::path> scene_, others_;  // `others_`: trajectories, and what the builder has looked for
  std::vector<std::filesystem::path> spectra_;
  std::map<std::filesystem::path, std::pair<Mark, pulsecast::io::Fingerprint>> known_;
};

/// 32 digits.
[[nodiscard]] std::string hex(const pulsecast::io::Fingerprint& fingerprint);
/// 16 digits.
[[nodiscard]] std::string hex(std::uint64_t number);
