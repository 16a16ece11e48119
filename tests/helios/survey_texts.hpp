// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <utility>

#include <pulsecast/helios/document.hpp>

#include "support/data_folder.hpp"
#include "support/temporary_folder.hpp"

/// Surveys of a few words, on the sample assets.
namespace pulsecast::support {

/// A survey with these attributes of the survey and this inside, on the sample assets.
inline std::string survey_text(const std::string& attributes, const std::string& inside,
                               const std::string& before = "") {
  std::string all = attributes;
  const std::pair<const char*, const char*> usual[] = {{"scene=", R"( scene="surveys/scenes.xml#yard")"},
                                                       {"platform=", R"( platform="surveys/assets.xml#tripod")"},
                                                       {"scanner=", R"( scanner="surveys/assets.xml#rotating")"}};
  for (const auto& [name, reference] : usual)
    if (all.find(name) == std::string::npos) all += reference;
  return "<?xml version=\"1.0\"?>\n<document>\n" + before + "<survey " + all + ">\n" + inside +
         "\n</survey>\n</document>\n";
}

/// Reads a text as a survey.
inline helios::SurveyDocument read_text(const std::string& text) {
  static const TemporaryFolder folder;
  std::ofstream(folder / "survey.xml", std::ios::binary) << text;
  return helios::read_survey(folder / "survey.xml", {.assets = {data_folder}});
}

inline constexpr const char* head_turns = R"(headRotatePerSec_deg="60" headRotateStop_deg="20" scanFreq_hz="20" )";

/// A leg of the tripod with these scanner settings beside those that it needs.
inline std::string leg(const std::string& scanner) {
  std::string all = scanner;
  if (all.find("scanFreq_hz") == std::string::npos) all = head_turns + all;
  return "<leg><platformSettings/><scannerSettings " + all + "/></leg>";
}

/// All that is wrong with a text; empty if nothing is.
inline std::string faults_of(const std::string& text) {
  try {
    (void)read_text(text);
  } catch (const helios::XmlFaults& faults) {
    return faults.what();
  }
  return "";
}

}  // namespace pulsecast::support
