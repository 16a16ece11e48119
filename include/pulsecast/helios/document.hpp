// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DOCUMENT_HPP
#define PULSECAST_HELIOS_DOCUMENT_HPP

#include <pulsecast/base/compiled.hpp>
#include <pulsecast/helios/detail/xml/faults.hpp>
#include <pulsecast/helios/settings.hpp>

namespace PULSECAST_NAMESPACE::helios {

/// Search folders and purpose of reading a document.
struct XmlOptions {
  std::vector<std::filesystem::path> assets{};  ///< searched before those of the documents
  bool channel_files = false;                   ///< for files named by channel ids: unique ones
};

/// Content of a survey document.
struct SurveyDocument {
  SurveySettings survey{};                ///< settings of the survey
  std::vector<std::string> warnings{};    ///< as in `survey.xml:3:10: 'numRuns' has no effect`
  std::vector<std::string> leg_places{};  ///< position of each leg, as in `survey.xml:12:5`
  std::string place{};                    ///< position of the survey
};

/// Content of a document of assets, in document order.
struct AssetDocument {
  std::vector<ScannerSettings> scanners{};    ///< `<scanner>` elements
  std::vector<PlatformSettings> platforms{};  ///< `<platform>` elements
  std::vector<SceneSettings> scenes{};        ///< `<scene>` elements
  std::vector<std::string> warnings{};        ///< as in `SurveyDocument`
};

/// Reads a survey and its references, in the format of HELIOS++, and checks all but the scene's
/// files. Scanner and platform have the survey's overrides. @throws XmlFaults (all faults), FileError
[[nodiscard]] SurveyDocument read_survey(const std::filesystem::path& path, const XmlOptions& options = {});

/// Writes a survey with scanner, platform and scene as one document. Reading it gives equal
/// settings, but for the last digit of a program's values where the document's unit is not SI.
void write_survey(const std::filesystem::path& path, const SurveySettings& survey);
[[nodiscard]] std::string xml_text(const SurveySettings& survey);  ///< text of that document

/// Reads the scanners, platforms and scenes of a document. Throws as `read_survey`.
[[nodiscard]] AssetDocument read_assets(const std::filesystem::path& path, const XmlOptions& options = {});

/// Writes scanners, platforms and scenes as one document.
void write_assets(const std::filesystem::path& path, const AssetDocument& assets);
[[nodiscard]] std::string xml_text(const AssetDocument& assets);  ///< text of that document

}  // namespace PULSECAST_NAMESPACE::helios

#if PULSECAST_DEFINES(HELIOS_DOCUMENT)
#include <pulsecast/helios/detail/xml/survey.hpp>
#include <pulsecast/helios/detail/xml/writer.hpp>

namespace PULSECAST_NAMESPACE::helios {

PULSECAST_INLINE SurveyDocument read_survey(const std::filesystem::path& path, const XmlOptions& options) {
  detail::SurveyReader reader(path, options.assets, options.channel_files);
  SurveyDocument document{.survey = reader.read()};
  document.warnings = reader.report().warnings();
  document.leg_places = reader.leg_places();
  document.place = reader.place();
  return document;
}

PULSECAST_INLINE AssetDocument read_assets(const std::filesystem::path& path, const XmlOptions& options) {
  detail::SurveyReader reader(path, options.assets, options.channel_files);
  AssetDocument assets;
  reader.read_all("scanner", assets.scanners);
  reader.read_all("platform", assets.platforms);
  reader.read_all("scene", assets.scenes);
  reader.report().require_clean();
  assets.warnings = reader.report().warnings();
  return assets;
}

PULSECAST_INLINE void write_survey(const std::filesystem::path& path, const SurveySettings& survey) {
  detail::write_text(path, xml_text(survey));
}
PULSECAST_INLINE std::string xml_text(const SurveySettings& survey) { return detail::document_of(survey).text(); }

PULSECAST_INLINE void write_assets(const std::filesystem::path& path, const AssetDocument& assets) {
  detail::write_text(path, xml_text(assets));
}
PULSECAST_INLINE std::string xml_text(const AssetDocument& assets) {
  detail::DocumentWriter document;
  for (const ScannerSettings& scanner : assets.scanners) document.add("scanner", scanner);
  for (const PlatformSettings& platform : assets.platforms) document.add("platform", platform);
  for (const SceneSettings& scene : assets.scenes) document.add("scene", scene);
  return document.text();
}

}  // namespace PULSECAST_NAMESPACE::helios

#endif

#endif
