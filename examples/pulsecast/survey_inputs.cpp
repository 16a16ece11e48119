// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

#include "survey_inputs.hpp"

#include <sys/stat.h>

#include <array>
#include <charconv>
#include <cstdint>
#include <system_error>

#include <pulsecast/base/error.hpp>
#include <pulsecast/helios/detail/scene_files.hpp>

namespace fs = std::filesystem;
using namespace pulsecast;
using io::Fingerprint;

SurveyInputs::SurveyInputs(const helios::SurveySettings& survey, const std::vector<fs::path>& assets)
    : scene_(helios::scene_files(survey.scene)), spectra_(helios::spectra_folders(assets)) {
  for (const helios::LegSettings& leg : survey.legs)
    if (leg.platform.trajectory) trajectories_.push_back(leg.platform.trajectory->file);
}

Fingerprint SurveyInputs::fingerprint(const fs::path& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return io::content_fingerprint(path);
  Mark mark;
  for (const auto number :
       {static_cast<std::intmax_t>(status.st_dev), static_cast<std::intmax_t>(status.st_ino), static_cast<std::intmax_t>(status.st_size),
        static_cast<std::intmax_t>(status.st_mtim.tv_sec), static_cast<std::intmax_t>(status.st_mtim.tv_nsec),
        static_cast<std::intmax_t>(status.st_ctim.tv_sec), static_cast<std::intmax_t>(status.st_ctim.tv_nsec)})
    mark.push_back(static_cast<std::uint64_t>(number));
  auto& [known_mark, known] = known_[path];
  if (known_mark != mark) {
    known = io::content_fingerprint(path);
    known_mark = std::move(mark);
  }
  return known;
}

std::map<std::string, std::string> SurveyInputs::fingerprints() {
  std::map<std::string, std::string> all;
  const auto add = [&](const fs::path& path) {
    try {
      all.emplace(path.string(), hex(fingerprint(path)));
    } catch (const FileError&) {  // missing or unreadable
    }
  };
  for (const fs::path& path : scene_) add(path);
  for (const fs::path& path : trajectories_) add(path);
  for (const fs::path& folder : spectra_) {
    std::error_code error;
    for (fs::directory_iterator i(folder, error), end; !error && i != end; i.increment(error))
      if (std::error_code ignored; i->is_regular_file(ignored)) add(i->path());
  }
  return all;
}

std::string hex(std::uint64_t number) {
  std::array<char, 16> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), number, 16).ptr;
  const std::string text(digits.data(), end);
  return std::string(16 - text.size(), '0') + text;
}

std::string hex(const Fingerprint& fingerprint) { return hex(fingerprint.high) + hex(fingerprint.low); }
