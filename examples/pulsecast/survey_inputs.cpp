// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

#include "survey_inputs.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <utility>

#include <pulsecast/base/error.hpp>
#include <pulsecast/helios/detail/scene_files.hpp>

namespace fs = std::filesystem;
using namespace pulsecast;
using io::Fingerprint;

SurveyInputs::SurveyInputs(const helios::SurveySettings& survey, const std::vector<fs::path>& assets)
    : scene_(helios::scene_files(survey.scene)), spectra_(helios::spectra_folders(assets)) {
  for (const helios::LegSettings& leg : survey.legs)
    if (leg.platform.trajectory) others_.insert(leg.platform.trajectory->file);
}

Fingerprint SurveyInputs::fingerprint(const fs::path& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) status = {};
  Mark mark;
  for (const auto number :
       {static_cast<std::intmax_t>(status.st_dev), static_cast<std::intmax_t>(status.st_ino),
        static_cast<std::intmax_t>(status.st_size), static_cast<std::intmax_t>(status.st_mtim.tv_sec),
        static_cast<std::intmax_t>(status.st_mtim.tv_nsec), static_cast<std::intmax_t>(status.st_ctim.tv_sec),
        static_cast<std::intmax_t>(status.st_ctim.tv_nsec)})
    mark.push_back(static_cast<std::uint64_t>(number));
  const bool is_folder = S_ISDIR(status.st_mode) && std::find(spectra_.begin(), spectra_.end(), path) != spectra_.end();
  const auto [known, is_new] = known_.try_emplace(path);
  if (!is_new && !is_folder && known->second.first == mark) return known->second.second;
  Fingerprint now{};
  if (is_folder || S_ISREG(status.st_mode)) try {
      now = io::content_fingerprint(path);
    } catch (const FileError&) {  // unreadable: as if it were missing
    }
  if (!is_new && now != known->second.second)
    throw FileError(path.string(), "", "has changed since this program looked at it first");
  known->second = {std::move(mark), now};
  return now;
}

std::map<std::string, std::string> SurveyInputs::fingerprints() {
  std::map<std::string, std::string> all;
  const auto add_all = [&](const auto& paths) {
    for (const fs::path& path : paths) all.emplace(path.string(), hex(fingerprint(path)));
  };
  add_all(scene_);
  add_all(others_);
  add_all(spectra_);
  return all;
}

std::string hex(std::uint64_t number) {
  std::array<char, 16> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), number, 16).ptr;
  const std::string text(digits.data(), end);
  return std::string(16 - text.size(), '0') + text;
}

std::string hex(const Fingerprint& fingerprint) { return hex(fingerprint.high) + hex(fingerprint.low); }
