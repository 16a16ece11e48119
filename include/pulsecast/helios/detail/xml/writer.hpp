// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_XML_WRITER_HPP
#define PULSECAST_HELIOS_DETAIL_XML_WRITER_HPP

#include <sstream>

#include <pulsecast/helios/detail/xml/leg_checks.hpp>
#include <pulsecast/helios/detail/xml/scanner.hpp>
#include <pulsecast/helios/detail/xml/scene.hpp>
#include <pulsecast/io/output_file.hpp>

namespace PULSECAST_NAMESPACE::helios::detail {

/// Writes a document with one root element, and keeps the notes that reading it would give.
class DocumentWriter {
 public:
  DocumentWriter() {
    pugi::xml_node declaration = document_.append_child(pugi::node_declaration);
    declaration.append_attribute("version").set_value("1.0");
    declaration.append_attribute("encoding").set_value("UTF-8");
    root_ = document_.append_child("document");
  }

  template <class Settings>
  void add(const char* element, Settings settings) {
    write(element, [&](XmlOutput& io) { xml::fields(io, settings); });
  }

  /// Adds an element by `fields(XmlOutput&)`.
  template <class Fields>
  void write(const char* element, const Fields& fields) {
    XmlOutput io(root_.append_child(element));
    fields(io);
    notes_.insert(notes_.end(), io.notes().begin(), io.notes().end());
  }

  [[nodiscard]] const std::vector<std::string>& notes() const noexcept { return notes_; }

  [[nodiscard]] std::string text() const {
    std::ostringstream all;
    document_.save(all, "  ", pugi::format_indent, pugi::encoding_utf8);
    return all.str();
  }

 private:
  pugi::xml_document document_;
  pugi::xml_node root_;
  std::vector<std::string> notes_;
};

inline void write_text(const std::filesystem::path& path, const std::string& text) {
  io::OutputFile file(path);
  file.write(text);
  file.commit();
}

inline void write_leg(XmlOutput& io, const SurveySettings& survey, std::size_t i) {
  LegSettings leg = survey.legs[i];
  const LegChecks checks(survey);
  leg.fields(io);
  io.child("platformSettings", "", [&](XmlOutput& inner) {
    leg.platform.fields(inner);
    checks.check_platform(inner, i);
  });
  io.child("scannerSettings", "", [&](XmlOutput& inner) {
    leg.scanner.fields(inner);
    checks.check_scanner(inner, i);
  });
}

/// Gives settings without an id one for references.
template <class Settings>
Settings with_id(Settings settings, const char* id) {
  if (settings.id.empty()) settings.id = id;
  return settings;
}

/// Document of a survey; `leg_name(i)` begins the messages about a leg. @throws SettingError for
/// what `read_survey` would refuse, except files and ground
inline DocumentWriter document_of(const SurveySettings& survey, const auto& leg_name) {
  DocumentWriter document;
  if (survey.scanner.channels.empty()) throw SettingError("scanner: channels (number)", 0, "", "at least 1");
  if (survey.legs.empty()) throw SettingError("legs (number)", 0, "", "at least 1");
  ScannerSettings scanner = with_id(survey.scanner, "scanner");
  if (scanner.pulse_rates.empty()) scanner.pulse_rates = {first_pulse_rate(survey)};
  const PlatformSettings platform = with_id(survey.platform, "platform");
  const SceneSettings scene = with_id(survey.scene, "scene");
  document.add("scanner", scanner);
  document.add("platform", platform);
  document.add("scene", scene);
  document.write("survey", [&](XmlOutput& io) {
    io.put("name", survey.name);
    io.put("scene", "#" + scene.id);
    io.put("scanner", "#" + scanner.id);
    const bool interpolated = platform.kind == PlatformKind::interpolated;
    if (interpolated) io.put("platform", "interpolated");
    io.put(interpolated ? "basePlatform" : "platform", "#" + platform.id);
    if (RotationSpec spec = platform.rotation_spec; interpolated) xml::rotation_spec(io, spec);
    if (survey.seed) io.put("seed", std::to_string(*survey.seed));
    if (std::optional<LegOffsetSettings> offset = survey.leg_offset) {
      io.put("legRandomOffset", "true");
      offset->fields(io);
    }
    for (const ChannelSettings& channel : scanner.channels)
      if (const std::string note = xml::bin_note(channel); !note.empty()) io.warn("binSize_ns", note);
    for (std::size_t i = 0; i < survey.legs.size(); ++i)
      io.child("leg", leg_name(i), [&](XmlOutput& inner) { write_leg(inner, survey, i); });
  });
  return document;
}

/// As above, to be read again.
inline DocumentWriter document_of(const SurveySettings& survey) {
  if (survey.scene.parts.empty()) throw SettingError("scene: parts (number)", 0, "", "at least 1");
  for (const PartSettings& part : survey.scene.parts)
    if (std::visit([](const auto& source) { return source.files.empty(); }, part.source))
      throw SettingError("part '" + part.id + "': files (number)", 0, "", "at least 1");
  return document_of(survey, [](std::size_t i) { return "leg " + std::to_string(i); });
}

}  // namespace PULSECAST_NAMESPACE::helios::detail

#endif
