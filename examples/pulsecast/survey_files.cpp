// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

#include "survey_files.hpp"

#include <algorithm>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <set>
#include <system_error>

#include <pulsecast/adapters/xml.hpp>

namespace fs = std::filesystem;
using namespace pulsecast;

SurveyFile read_survey_file(const Options& options) {
  adapters::SurveyDocument document = adapters::read_survey(options.survey, {.assets = options.assets});
  std::string text = adapters::xml_text(document.survey),
              scene_text = adapters::xml_text(adapters::AssetDocument{.scenes = {document.survey.scene}});
  return {std::move(document.survey), std::move(document.warnings), std::move(text), std::move(scene_text)};
}

namespace {

const char* optic_name(const adapters::OpticSettings& optic) {
  static constexpr const char* names[] = {"oscillating", "rotating", "conic", "line", "risley"};
  return names[optic.index()];
}

const char* kind_name(adapters::PlatformKind kind) {
  static constexpr const char* names[] = {"static", "linearpath", "multicopter", "groundvehicle", "interpolated"};
  return names[static_cast<std::size_t>(kind)];
}

std::vector<fs::path> documents_of(const Options& options) {
  std::vector<fs::path> files;
  std::set<std::string> seen;
  std::error_code ignored;
  const fs::path here_now = fs::current_path(ignored);  // its documents are surveys
  for (const fs::path& folder : options.assets)
    for (const fs::path& inside : {folder, folder / "data"}) {
      if (inside == here_now) continue;
      std::error_code error;
      std::vector<fs::path> here;
      for (fs::directory_iterator i(inside, error), end; !error && i != end; i.increment(error))
        if (i->path().extension() == ".xml" && i->is_regular_file(error)) here.push_back(i->path());
      std::sort(here.begin(), here.end());
      for (fs::path& file : here)
        if (seen.insert(file.lexically_normal().string()).second) files.push_back(std::move(file));
    }
  return files;
}

}  // namespace

void print_catalogue(const Options& options) {
  for (const fs::path& file : documents_of(options)) {
    adapters::AssetDocument assets;
    try {
      assets = adapters::read_assets(file, {.assets = options.assets});
    } catch (const FileError& error) {
      if (options.verbose) std::cerr << "note: " << error.what() << '\n';
      continue;
    }
    if (assets.scanners.empty() && assets.platforms.empty()) continue;
    std::cout << file.string() << '\n';
    for (const auto& s : assets.scanners) {
      std::cout << "  " << std::left << std::setw(36) << s.id << std::setw(13) << optic_name(s.channels.front().optic) << std::right
                << std::setw(4) << s.channels.size() << (s.channels.size() == 1 ? " channel   " : " channels  ") << s.name << '\n';
    }
    for (const auto& p : assets.platforms)
      std::cout << "  " << std::left << std::setw(36) << p.id << std::setw(29) << kind_name(p.kind) << std::right << p.name << '\n';
  }
}
