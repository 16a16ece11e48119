// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_XML_WRITER_HPP
#define PULSECAST_HELIOS_DETAIL_XML_WRITER_HPP

#include <cstddef>
#include <filesystem>
#include <string>
#include <utility>

#include <pugixml.hpp>

#include <pulsecast/helios/detail/xml/leg.hpp>
#include <pulsecast/helios/detail/xml/output.hpp>
#include <pulsecast/helios/detail/xml/platform.hpp>
#include <pulsecast/helios/detail/xml/scanner.hpp>
#include <pulsecast/helios/detail/xml/scene.hpp>
#include <pulsecast/helios/settings.hpp>
#include <pulsecast/io/output_file.hpp>

namespace PULSECAST_NAMESPACE::helios::detail {

/// Writes a document with one root element.
class DocumentWriter {
 public:
  DocumentWriter() {
    pugi::xml_node declaration = document_.append_child(pugi::node_declaration);
    declaration.append_attribute("version").set_value("1.0");
    declaration.append_attribute("encoding").set_value("UTF-8");
    root_ = document_.append_child("document");
  }

  [[nodiscard]] pugi::xml_node root() const noexcept { return root_; }

  template <class Settings>
  void add(const char* element, const Settings& settings) {
    XmlOutput io(root_.append_child(element));
    xml::fields(io, settings);
  }

  [[nodiscard]] std::string text() const {
    struct Writer : pugi::xml_writer {
      void write(const void* data, std::size_t size) override { all.append(static_cast<const char*>(data), size); }
      std::string all;
    } writer;
    document_.save(writer, "  ", pugi::format_indent, pugi::encoding_utf8);
    return std::move(writer.all);
  }

  void write(const std::filesystem::path& path) const {
    io::OutputFile file(path);
    file.write(text());
    file.commit();
  }

 private:
  pugi::xml_document document_;
  pugi::xml_node root_;
};

inline void write_leg(XmlOutput& io, const LegSettings& leg) {
  io.text("stripId", leg.strip);
  io.number("maxDuration_s", leg.duration_max, units::second, 0, 1e9);
  io.child("platformSettings", [&](XmlOutput& inner) { xml::fields(inner, leg.platform); });
  io.child("scannerSettings", [&](XmlOutput& inner) { xml::fields(inner, leg.scanner); });
}

/// Gives settings without an id one for references.
template <class Settings>
Settings with_id(Settings settings, const char* id) {
  if (settings.id.empty()) settings.id = id;
  return settings;
}

inline DocumentWriter document_of(const SurveySettings& survey) {
  DocumentWriter document;
  const ScannerSettings scanner = with_id(survey.scanner, "scanner");
  const PlatformSettings platform = with_id(survey.platform, "platform");
  const SceneSettings scene = with_id(survey.scene, "scene");
  document.add("scanner", scanner);
  document.add("platform", platform);
  document.add("scene", scene);
  XmlOutput io(document.root().append_child("survey"));
  io.text("name", survey.name);
  io.text("scene", "#" + scene.id);
  io.text("scanner", "#" + scanner.id);
  if (platform.kind == PlatformKind::interpolated) {
    io.text("platform", std::string("interpolated"));
    io.text("basePlatform", "#" + platform.id);
    io.choice("rotationSpec", platform.rotation_spec, {{"ARINC 705", RotationSpec::arinc_705}, {"CANONICAL", RotationSpec::canonical}});
  } else {
    io.text("platform", "#" + platform.id);
  }
  if (survey.seed) io.text("seed", std::to_string(*survey.seed));
  if (survey.leg_offset) {
    io.flag("legRandomOffset", true);
    io.number("legRandomOffsetMean", survey.leg_offset->mean, units::metre, 0, 0);
    io.number("legRandomOffsetStdev", survey.leg_offset->deviation, units::metre, 0, 0);
  }
  io.children("leg", survey.legs, [](XmlOutput& inner, const LegSettings& leg) { write_leg(inner, leg); });
  return document;
}

}  // namespace PULSECAST_NAMESPACE::helios::detail

#endif
