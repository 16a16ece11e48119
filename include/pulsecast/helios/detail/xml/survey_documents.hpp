// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_XML_SURVEY_DOCUMENTS_HPP
#define PULSECAST_HELIOS_DETAIL_XML_SURVEY_DOCUMENTS_HPP

#include <filesystem>
#include <string>

#include <pulsecast/helios/detail/xml/survey.hpp>
#include <pulsecast/helios/detail/xml/writer.hpp>
#include <pulsecast/helios/document.hpp>
#include <pulsecast/helios/settings.hpp>

/// Reading and writing of survey documents.
namespace PULSECAST_NAMESPACE::helios {

namespace detail {

inline DocumentWriter document_of(const AssetDocument& assets) {
  DocumentWriter document;
  for (const ScannerSettings& scanner : assets.scanners) document.add("scanner", scanner);
  for (const PlatformSettings& platform : assets.platforms) document.add("platform", platform);
  for (const SceneSettings& scene : assets.scenes) document.add("scene", scene);
  return document;
}

}  // namespace detail

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
  detail::document_of(survey).write(path);
}

PULSECAST_INLINE std::string xml_text(const SurveySettings& survey) { return detail::document_of(survey).text(); }

PULSECAST_INLINE void write_assets(const std::filesystem::path& path, const AssetDocument& assets) {
  detail::document_of(assets).write(path);
}

PULSECAST_INLINE std::string xml_text(const AssetDocument& assets) { return detail::document_of(assets).text(); }

}  // namespace PULSECAST_NAMESPACE::helios

#endif
