// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <pulsecast/helios/detail/xml/survey.hpp>
#include <pulsecast/helios/detail/xml/writer.hpp>
#include <pulsecast/helios/settings.hpp>

namespace pulsecast::helios {

/// Where the files are that documents name, and what they are read for.
struct XmlOptions {
  std::vector<std::filesystem::path> assets{};  ///< folders; the first that has a file wins. Then come those of survey and document
  bool channel_files = false;  ///< whether each channel is to have a file by its id: ids that cannot tell files apart are refused
};

/// What a document of a survey says.
struct SurveyDocument {
  SurveySettings survey{};
  std::vector<std::string> warnings{};    ///< what is odd, but could be read, as in `survey.xml:3:10: attribute 'numRuns' has no effect`
  std::vector<std::string> leg_places{};  ///< where each leg stands, as in `survey.xml:12:5`, for `SurveyBuildOptions`
  std::string place{};                    ///< where the survey stands
};

/// What a document of assets holds, each in its order.
struct AssetDocument {
  std::vector<ScannerSettings> scanners{};
  std::vector<PlatformSettings> platforms{};
  std::vector<SceneSettings> scenes{};
  std::vector<std::string> warnings{};
};

/// Reads a survey and all that it refers to, in the format of HELIOS++, and checks all that can be checked without loading the scene. The
/// settings are resolved: what the survey sets of scanner and platform stands there, for every channel. Throws `XmlFaults`, with all that
/// is wrong, if anything is; any other `FileError` if the file cannot be read.
[[nodiscard]] SurveyDocument read_survey(const std::filesystem::path& path, const XmlOptions& options = {});

/// Writes a survey with its scanner, platform and scene as one document. Read again, it gives equal settings; where these were made by a
/// program, a number that is not in SI in a document may differ in its last digit.
void write_survey(const std::filesystem::path& path, const SurveySettings& survey);
[[nodiscard]] std::string xml_text(const SurveySettings& survey);  ///< what would be written

/// Reads the scanners, platforms and scenes of a document. Throws as `read_survey`.
[[nodiscard]] AssetDocument read_assets(const std::filesystem::path& path, const XmlOptions& options = {});

/// Writes scanners, platforms and scenes as one document.
void write_assets(const std::filesystem::path& path, const AssetDocument& assets);
[[nodiscard]] std::string xml_text(const AssetDocument& assets);  ///< what would be written

namespace detail {

inline DocumentWriter document_of(const AssetDocument& assets) {
  DocumentWriter document;
  for (const ScannerSettings& scanner : assets.scanners) document.add("scanner", scanner);
  for (const PlatformSettings& platform : assets.platforms) document.add("platform", platform);
  for (const SceneSettings& scene : assets.scenes) document.add("scene", scene);
  return document;
}

}  // namespace detail

inline SurveyDocument read_survey(const std::filesystem::path& path, const XmlOptions& options) {
  detail::SurveyReader reader(path, options.assets, options.channel_files);
  SurveyDocument document{.survey = reader.read()};
  document.warnings = reader.report().warnings();
  document.leg_places = reader.leg_places();
  document.place = reader.place();
  return document;
}

inline AssetDocument read_assets(const std::filesystem::path& path, const XmlOptions& options) {
  detail::SurveyReader reader(path, options.assets, options.channel_files);
  AssetDocument assets;
  reader.read_all("scanner", assets.scanners);
  reader.read_all("platform", assets.platforms);
  reader.read_all("scene", assets.scenes);
  reader.report().require_clean();
  assets.warnings = reader.report().warnings();
  return assets;
}

inline void write_survey(const std::filesystem::path& path, const SurveySettings& survey) { detail::document_of(survey).write(path); }

inline std::string xml_text(const SurveySettings& survey) { return detail::document_of(survey).text(); }

inline void write_assets(const std::filesystem::path& path, const AssetDocument& assets) { detail::document_of(assets).write(path); }

inline std::string xml_text(const AssetDocument& assets) { return detail::document_of(assets).text(); }

}  // namespace pulsecast::helios
