// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_XML_LEG_READER_HPP
#define PULSECAST_HELIOS_DETAIL_XML_LEG_READER_HPP

#include <pulsecast/helios/detail/scene_files.hpp>
#include <pulsecast/helios/detail/xml/fields.hpp>
#include <pulsecast/helios/detail/xml/leg_checks.hpp>
#include <pulsecast/helios/detail/xml/library.hpp>

namespace PULSECAST_NAMESPACE::helios::detail {

[[nodiscard]] inline bool fits_no_name(unsigned char c) { return c == '/' || c == '\\' || c < ' ' || c == 0x7f; }

/// Replaces forbidden characters in a part of a file or folder name, with a warning.
inline void fit_for_name(const XmlInput& io, const char* name, std::string& text) {
  if (std::none_of(text.begin(), text.end(), fits_no_name)) return;
  const std::string given = said(name, text);
  std::replace_if(text.begin(), text.end(), fits_no_name, '_');
  io.warn(name, given + " is taken as " + text::quoted(text) +
                    ": expected no slashes and no control characters in a part of a file name");
}

/// Reads the legs of a survey, after its scanner and platform.
class LegReader {
 public:
  LegReader(XmlLibrary& library, const XmlLibraryDocument& document, XmlReport& report, SurveySettings& survey)
      : library_(library), document_(document), report_(report), survey_(survey) {}

  /// Reads and checks all legs. Returns their places.
  std::vector<std::string> read(XmlInput& io) {
    std::vector<double> resolutions;  // per leg, 0 if none [rad]
    std::vector<std::string> places;
    io.each("leg", 0, [&](FieldIo& leg, std::size_t) {
      resolutions.push_back(read_leg(xml::input(leg), survey_.legs.emplace_back()));
      places.push_back(xml::input(leg).place().text());
    });
    if (places.empty()) io.fault("", "<survey> holds no <leg>: nothing would be scanned");
    if (!report_.is_clean()) return places;
    const LegChecks checks(survey_);
    bool is_active = false;
    std::size_t i = 0;
    for (const pugi::xml_node node : io.node().children("leg")) {
      const auto in = [&](const char* element) {
        const pugi::xml_node own = node.child(element);
        return XmlInput(io.document(), own ? own : node, report_, io.search());
      };
      const XmlInput platform = in("platformSettings");
      LegSettings& leg = survey_.legs[i];
      check_ground(platform, leg.platform);
      checks.check_platform(platform, i);
      checks.check_scanner(in("scannerSettings"), i, resolutions[i]);
      if (survey_.platform.kind != PlatformKind::interpolated) leg.platform.trajectory.reset();
      is_active = is_active || leg.scanner.active;
      ++i;
    }
    if (!is_active) io.warn("", "no leg is active: there will be no pulses");
    return places;
  }

  /// Reads the templates of the survey's document, also without a leg; their faults are warnings.
  void read_unused_templates() {
    const auto all = [&](const char* element, const XmlInput::Read& read) {
      for (const pugi::xml_node node : document_.document().root().children(element))
        document_.read(node, report_, [&](XmlInput& io) {
          io.require({"id"});
          io.know({"id", "name"});
          read(io);
        });
    };
    report_.leniently([&] {
      all("platformSettings", [&](XmlInput& io) {
        LegPlatformSettings ignored;
        read_leg_platform(io, ignored);
      });
      all("scannerSettings", [&](XmlInput& io) {
        LegScanner ignored{.settings = {.pulse_rate = 1}};
        read_leg_scanner(io, ignored);
      });
    });
  }

 private:
  /// `<scannerSettings>`, with values that are stored elsewhere later.
  struct LegScanner {
    LegScannerSettings settings{};
    std::optional<double> duration_max{};
    double vertical_resolution = 0, horizontal_resolution = 0;  // [rad]
  };

  /// Reads a leg. Returns its vertical resolution [rad].
  double read_leg(XmlInput& leg, LegSettings& settings) {
    leg.text("stripId", settings.strip);
    if (settings.strip) fit_for_name(leg, "stripId", *settings.strip);
    leg.number("maxDuration_s", settings.duration_max, units::second, -1, 1e9);
    if (!leg.child("platformSettings", [&](XmlInput& inner) { read_leg_platform(inner, settings.platform); }))
      leg.fault("", "<leg> holds no <platformSettings>");
    LegScanner scanner;
    if (!survey_.scanner.pulse_rates.empty()) scanner.settings.pulse_rate = survey_.scanner.pulse_rates.front();
    leg.child("scannerSettings", [&](XmlInput& inner) { read_leg_scanner(inner, scanner); });
    settings.scanner = scanner.settings;
    if (!(settings.duration_max > 0.0)) settings.duration_max = scanner.duration_max;
    if (!(settings.duration_max > 0.0)) settings.duration_max.reset();
    return scanner.vertical_resolution;
  }

  void check_ground(const XmlInput& io, const LegPlatformSettings& platform) {
    if (!platform.on_ground || survey_.platform.kind == PlatformKind::interpolated) return;
    if (!has_ground_) has_ground_ = has_ground(survey_.scene);
    if (!*has_ground_)
      io.fault("onGround",
               "nothing in the scene is ground: expected a material with helios_isGround in an MTL file "
               "of it");
  }

  /// Reads the template of an element, if it has one, and then the element: `read(io, is_leg)`.
  void with_template(XmlInput& io, const XmlLibraryDocument& from, std::vector<pugi::xml_node> before,
                     const std::function<void(XmlInput&, bool)>& read) {
    const bool is_leg = before.empty();
    if (const auto text = io.given("template")) {
      const XmlReference found = library_.find(io, from, "template", *text, io.node().name());
      before.push_back(io.node());
      if (found && std::ranges::find(before, found.node) != before.end())
        io.fault("template", said("template", *text) + " is a template of itself");
      else if (found && before.size() > 16)
        io.fault("template", said("template", *text) + " exceeds the maximum depth of templates");
      else if (found)
        found.document->read(found.node, report_, [&](XmlInput& inner) {
          inner.know({"id", "name"});
          with_template(inner, *found.document, before, read);
        });
    }
    read(io, is_leg);
  }

  void read_leg_platform(XmlInput& io, LegPlatformSettings& settings) {
    with_template(io, document_, {}, [&](XmlInput& inner, bool is_leg) {
      if (is_leg) settings.yaw_at_departure.reset();  // is not inherited
      settings.fields(inner);
    });
  }

  void read_leg_scanner(XmlInput& io, LegScanner& scanner) {
    const double usual_rate = scanner.settings.pulse_rate;
    with_template(io, document_, {}, [&](XmlInput& inner, bool) {
      scanner.settings.fields(inner);
      inner.number("maxDuration_s", scanner.duration_max, units::second, -1, 1e9);
      inner.child("maxDuration_s", [&](XmlInput& text) {
        const std::string content = text.content();
        if (content.find_first_not_of(" \t\r\n") == content.npos)
          return text.warn("", "<maxDuration_s> is empty: it is ignored");
        scanner.duration_max = number_of(content);
        if (!(scanner.duration_max >= -1.0 && scanner.duration_max <= 1e9))
          text.fault("", "<maxDuration_s> holds " + text::quoted(content) + ": expected a number of seconds");
      });
      inner.number("verticalResolution_deg", scanner.vertical_resolution, units::degree, 0, 180);
      inner.number("horizontalResolution_deg", scanner.horizontal_resolution, units::degree, 0, 360);
    });
    LegScannerSettings& s = scanner.settings;
    if (s.pulse_rate == 0 && usual_rate > 0) {
      s.pulse_rate = usual_rate;
      io.warn("pulseFreq_hz", "pulseFreq_hz of 0 means the scanner's default, " + xml_number(usual_rate) + " Hz");
    }
    const auto& channels = survey_.scanner.channels;
    const ChannelSettings* const device = channels.empty() ? nullptr : &channels.front();
    if (s.scan_angle == 0.0 && device && device->scan_angle_max > 0) {
      s.scan_angle.reset();
      io.warn("scanAngle_deg", "scanAngle_deg of 0 means the scanner's maximum, " +
                                   xml_number(units::degree.number(device->scan_angle_max)) + " deg");
    }
    if (scanner.vertical_resolution == 0 && scanner.horizontal_resolution == 0) return;
    if (!device || !std::holds_alternative<RotatingOptic>(device->optic))
      return io.warn("verticalResolution_deg", "resolutions have no effect with these optics");
    if (!(device->scan_angle_max > 0)) return;
    const auto rounded = [](double value, double limit) {
      return std::fabs(value - limit) < 1e-12 * limit ? limit : value;
    };
    const double rate = s.pulse_rate * scanner.vertical_resolution / (2 * device->scan_angle_max);
    s.scan_rate = rounded(rounded(rate, device->scan_rate_max), device->scan_rate_min);
    s.head_rate = rounded(scanner.horizontal_resolution * s.scan_rate, device->head_rate_max);
    if (!(s.scan_rate <= 1e6 && s.head_rate <= radians(1e6)))
      io.fault("verticalResolution_deg",
               "these resolutions need a scan frequency or head speed out of range: expected finer ones");
  }

  XmlLibrary& library_;
  const XmlLibraryDocument& document_;
  XmlReport& report_;
  SurveySettings& survey_;
  std::optional<bool> has_ground_{};
};

}  // namespace PULSECAST_NAMESPACE::helios::detail

#endif
