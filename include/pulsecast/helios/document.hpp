// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <variant>
#include <vector>

#include <pugixml.hpp>

#include <pulsecast/detector/waveform_settings.hpp>
#include <pulsecast/helios/detail/xml/document.hpp>
#include <pulsecast/helios/detail/xml/element.hpp>
#include <pulsecast/helios/detail/xml/fields.hpp>
#include <pulsecast/helios/detail/xml/leg.hpp>
#include <pulsecast/helios/detail/xml/leg_checks.hpp>
#include <pulsecast/helios/detail/xml/library.hpp>
#include <pulsecast/helios/detail/xml/platform.hpp>
#include <pulsecast/helios/detail/xml/scanner.hpp>
#include <pulsecast/helios/detail/xml/scene.hpp>
#include <pulsecast/helios/settings.hpp>
#include <pulsecast/io/output_file.hpp>

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

/// Reads one survey.
class SurveyReader {
 public:
  SurveyReader(const std::filesystem::path& path, const XmlOptions& options)
      : library_(folders(path, options), report_), document_(library_.read(path)), channel_files_(options.channel_files) {}

  [[nodiscard]] SurveyDocument read() {
    const XmlDocument& document = document_.document();
    const pugi::xml_node node = document.root().child("survey");
    if (!node) report_.fault(document.place(document.root()), "there is no <survey> in this document");
    if (const pugi::xml_node second = node.next_sibling("survey"))
      report_.warn(document.place(second), "a second <survey>: the first one counts");
    if (node) {
      XmlInput io(document, node, report_, document_.search());
      read_survey(io, std::filesystem::path(document.path()).stem().string());
      io.finish();
      read_unused_templates();
    }
    report_.require_clean();
    return {std::move(survey_), report_.warnings(), std::move(leg_places_), document.place(node).text()};
  }

  [[nodiscard]] AssetDocument read_assets() {
    AssetDocument assets;
    const auto all = [&](const char* element, auto& values) {
      for (pugi::xml_node node = document_.document().root().child(element); node; node = node.next_sibling(element))
        asset({&document_, node}, values.emplace_back());
    };
    all("scanner", assets.scanners);
    all("platform", assets.platforms);
    all("scene", assets.scenes);
    report_.require_clean();
    assets.warnings = report_.warnings();
    return assets;
  }

 private:
  /// `<scannerSettings>`, with what goes elsewhere in the end.
  struct LegScanner {
    LegScannerSettings settings{};
    std::optional<double> duration_max{};
    double vertical_resolution = 0, horizontal_resolution = 0;  // [rad]
  };

  static std::vector<std::filesystem::path> folders(const std::filesystem::path& path, const XmlOptions& options) {
    std::vector<std::filesystem::path> all = options.assets;
    all.push_back(std::filesystem::absolute(path).parent_path());
    return all;
  }

  template <class Settings>
  void asset(const XmlReference& found, Settings& settings) {
    XmlInput io(found.document->document(), found.node, report_, found.document->search());
    xml::fields(io, settings);
    io.finish();
  }

  void read_survey(XmlInput& io, std::string name) {
    io.text("name", survey_.name);
    fit_for_name(io, "name", survey_.name);
    if (survey_.name == ".." || survey_.name == ".") {
      io.warn("name", XmlInput::said("name", survey_.name) + " is no name of a folder for results: that of the file is taken");
      survey_.name.clear();
    }
    if (survey_.name.empty()) survey_.name = std::move(name);
    seed(io);
    io.without_effect({"numRuns", "simSpeed"});
    bool is_offset = false;
    LegOffsetSettings offset;
    io.flag("legRandomOffset", is_offset);
    io.number("legRandomOffsetMean", offset.mean, units::metre, -1e6, 1e6);
    io.number("legRandomOffsetStdev", offset.deviation, units::metre, 0, 1e6);
    if (is_offset) survey_.leg_offset = offset;
    io.require({"scanner", "platform", "scene"});
    read_platform(io);
    const XmlReference scanner = read_reference(io, "scanner", survey_.scanner);
    if (survey_.scanner.channels.size() > 1) check_channel_ids(scanner);
    read_reference(io, "scene", survey_.scene);
    xml::noise_fields(io, survey_.platform);
    read_overrides(io);
    read_legs(io);
  }

  /// Whether a character may not stand in the name of a file.
  [[nodiscard]] static bool fits_no_name(unsigned char c) { return c == '/' || c == '\\' || c < ' ' || c == 0x7f; }

  /// A text that becomes part of the name of a file or folder.
  static void fit_for_name(const XmlInput& io, const char* name, std::string& text) {
    if (std::none_of(text.begin(), text.end(), fits_no_name)) return;
    const std::string given = XmlInput::said(name, text);
    std::replace_if(text.begin(), text.end(), fits_no_name, '_');
    io.warn(name, given + " is taken as " + xml_quoted(text) + ": expected no slashes and no control characters in a part of a file name");
  }

  void seed(XmlInput& io) {
    const auto text = io.value("seed");
    if (!text || *text == "AUTO" || *text == "auto") return;
    const char* const end = text->data() + text->size();
    std::uint64_t value = 0;
    if (const auto [rest, error] = std::from_chars(text->data(), end, value); error == std::errc{} && rest == end) {
      survey_.seed = value;
      return;
    }
    // YYYY-MM-DD hh:mm:ss
    static constexpr std::array<std::uint64_t, 6> seconds{31'104'000, 2'592'000, 86'400, 3600, 60, 1};
    static constexpr std::array<std::uint64_t, 6> first{1970, 0, 0, 0, 0, 0};
    const char* at = text->data();
    std::uint64_t time = 0;
    bool is_time = text->size() < 40;
    for (std::size_t i = 0; is_time && i < 6; ++i) {
      const auto [rest, error] = std::from_chars(at, end, value);
      is_time = error == std::errc{} && value >= first[i] && value < 10000 && (rest == end) == (i == 5);
      time += is_time ? (value - first[i]) * seconds[i] : 0;
      at = rest == end ? end : rest + 1;
    }
    const auto number = number_of(*text);
    if (is_time) {
      survey_.seed = time;
    } else if (number && std::abs(*number) < 1e18) {
      survey_.seed = static_cast<std::uint64_t>(std::abs(*number));
      if (*number < 0 || *number != std::floor(*number))
        io.warn("seed",
                XmlInput::said("seed", *text) + " is taken as " + std::to_string(*survey_.seed) + ": expected a whole number from 0");
    } else {
      io.fault("seed", XmlInput::said("seed", *text) + ": expected a whole number, 'YYYY-MM-DD hh:mm:ss' or AUTO");
    }
  }

  template <class Settings>
  XmlReference read_reference(XmlInput& io, const char* name, Settings& settings) {
    const auto text = io.given(name);
    const XmlReference found = text ? library_.find(io, document_, name, *text, name) : XmlReference{};
    if (found) asset(found, settings);
    return found;
  }

  /// Channels without an id have their number as such.
  void check_channel_ids(const XmlReference& scanner) {
    const XmlDocument& document = scanner.document->document();
    std::map<std::string, std::size_t> numbers;
    pugi::xml_node node = scanner.node.child("channels").child("channel");
    for (std::size_t k = 0; k < survey_.scanner.channels.size() && node; ++k, node = node.next_sibling("channel")) {
      const std::string id = survey_.scanner.channels[k].id.empty() ? std::to_string(k) : survey_.scanner.channels[k].id;
      const auto [other, is_new] = numbers.emplace(id, k);
      if (channel_files_ && std::any_of(id.begin(), id.end(), fits_no_name))
        report_.fault(document.place(node, "id"),
                      "the id of a channel becomes part of the names of files: expected no slashes and no control characters in it");
      if (is_new) continue;
      const std::string problem =
          "channel " + std::to_string(k) + " has the id of channel " + std::to_string(other->second) + ", " + xml_quoted(id);
      if (channel_files_)
        report_.fault(document.place(node, "id"), problem + ": expected another one, as each is to have a file of its own");
      else
        report_.warn(document.place(node, "id"), problem);
    }
  }

  void read_platform(XmlInput& io) {
    const auto text = io.given("platform");
    if (text != "interpolated") {
      io.without_effect({"basePlatform", "rotationSpec"}, "has no effect unless platform=\"interpolated\"");
      read_reference(io, "platform", survey_.platform);
      if (io.child("scannerMount", [&](XmlInput& inner) {
            MountSettings ignored;
            xml::fields(inner, ignored);
          }))
        io.warn("platform", "<scannerMount> of a survey has no effect unless platform=\"interpolated\"");
      return;
    }
    survey_.platform.id = "interpolated";
    if (const auto base = io.given("basePlatform"))
      if (const XmlReference found = library_.find(io, document_, "basePlatform", *base, "platform")) asset(found, survey_.platform);
    survey_.platform.multicopter = {};
    survey_.platform.kind = PlatformKind::interpolated;
    io.choice("rotationSpec", survey_.platform.rotation_spec,
              {{"ARINC 705", RotationSpec::arinc_705}, {"CANONICAL", RotationSpec::canonical}});
    io.child("scannerMount", [&](XmlInput& inner) { xml::fields(inner, survey_.platform.mount); });
  }

  /// What a survey sets of the scanner, of all channels.
  void read_overrides(XmlInput& io) {
    std::vector<ChannelSettings> none(1);
    std::vector<ChannelSettings>& channels = survey_.scanner.channels.empty() ? none : survey_.scanner.channels;
    for (ChannelSettings& channel : channels) {
      io.child("FWFSettings", [&](XmlInput& inner) { xml::fields(inner, channel.waveform); });
      io.child("detectorSettings", [&](XmlInput& inner) {
        xml::detector_fields(inner, channel);
        xml::range_noise(inner, channel);
        if (!(channel.range_min < channel.range_max))
          inner.fault("rangeMax_m", "rangeMax_m is not beyond rangeMin_m: nothing could be measured");
      });
    }
    limit_bins(io);
  }

  /// A pulse would fall between bins that are longer, and `FullWaveform` takes no more than so many in one.
  void limit_bins(const XmlInput& io) {
    constexpr double most = WaveformSettings::max_samples;
    const pugi::xml_node own = io.node().child("FWFSettings");
    for (ChannelSettings& channel : survey_.scanner.channels) {
      const double bin = channel.waveform.bin_size, length = channel.pulse_length;
      if (bin <= length && length <= most * bin) continue;
      const auto ns = [](double seconds) { return xml_number(units::nanosecond.number(seconds)) + " ns"; };
      channel.waveform.bin_size = bin > length ? length : std::nextafter(length / most, length);
      report_.warn(own ? document_.document().place(own) : io.place("scanner"),
                   "binSize_ns is " + ns(bin) + ", and pulses are " + ns(length) + " long: it is limited to " +
                       ns(channel.waveform.bin_size) + "; expected bins from " + ns(length / most) + " to " + ns(length));
    }
  }

  void read_legs(XmlInput& io) {
    const XmlDocument& document = document_.document();
    io.know({}, {"leg"});
    std::vector<pugi::xml_node> nodes;
    std::vector<double> resolutions;  // of each leg, or 0
    for (pugi::xml_node node = io.node().child("leg"); node; node = node.next_sibling("leg")) {
      XmlInput leg(document, node, report_, document_.search());
      resolutions.push_back(read_leg(leg, survey_.legs.emplace_back()));
      leg.finish();
      nodes.push_back(node);
      leg_places_.push_back(leg.place().text());
    }
    if (nodes.empty()) report_.fault(io.place(), "<survey> holds no <leg>: nothing would be scanned");
    if (!report_.is_clean()) return;
    const LegChecks checks(document_, survey_, report_);
    bool is_active = false;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      checks.check(nodes[i], i, resolutions[i]);
      if (survey_.platform.kind != PlatformKind::interpolated) survey_.legs[i].platform.trajectory.reset();
      is_active = is_active || survey_.legs[i].scanner.active;
    }
    if (!is_active) report_.warn(io.place(), "no leg is active: there will be no pulses");
  }

  /// Returns its vertical resolution [rad].
  double read_leg(XmlInput& leg, LegSettings& settings) {
    std::optional<double> duration_max;
    leg.text("stripId", settings.strip);
    if (settings.strip) fit_for_name(leg, "stripId", *settings.strip);
    leg.number("maxDuration_s", duration_max, units::second, -1, 1e9);
    const bool has_platform = leg.child("platformSettings", [&](XmlInput& inner) { read_leg_platform(inner, settings.platform); });
    if (!has_platform) report_.fault(leg.place(), "<leg> holds no <platformSettings>");
    LegScanner scanner;
    if (!survey_.scanner.pulse_rates.empty()) scanner.settings.pulse_rate = survey_.scanner.pulse_rates.front();
    leg.child("scannerSettings", [&](XmlInput& inner) { read_leg_scanner(inner, scanner); });
    if (duration_max && *duration_max <= 0) duration_max.reset();
    if (!duration_max && scanner.duration_max && *scanner.duration_max > 0) duration_max = scanner.duration_max;
    settings.scanner = scanner.settings;
    settings.duration_max = duration_max;
    return scanner.vertical_resolution;
  }

  /// Reads the template of an element, if it has one, and then the element: `read(XmlInput&)`.
  template <class Read>
  void with_template(XmlInput& io, const XmlLibraryDocument& from, std::vector<pugi::xml_node> before, const Read& read) {
    const bool is_leg = before.empty();
    if (const auto text = io.given("template")) {
      const std::string element = io.node().name();
      const XmlReference found = library_.find(io, from, "template", *text, element.c_str());
      before.push_back(io.node());
      if (found && std::find(before.begin(), before.end(), found.node) != before.end()) {
        io.fault("template", XmlInput::said("template", *text) + " is a template of itself");
      } else if (found && before.size() > 16) {
        io.fault("template", XmlInput::said("template", *text) + " is the last of too many templates");
      } else if (found) {
        XmlInput inner(found.document->document(), found.node, report_, found.document->search());
        inner.know({"id", "name"});
        with_template(inner, *found.document, before, read);
        inner.finish();
      }
    }
    read(io, is_leg);
  }

  void read_leg_platform(XmlInput& io, LegPlatformSettings& settings) {
    with_template(io, document_, {}, [&](XmlInput& inner, bool is_leg) {
      if (is_leg) settings.yaw_at_departure.reset();  // is not inherited
      xml::fields(inner, settings);
    });
  }

  void read_leg_scanner(XmlInput& io, LegScanner& scanner) {
    const double usual_rate = scanner.settings.pulse_rate;
    with_template(io, document_, {}, [&](XmlInput& inner, bool) {
      xml::fields(inner, scanner.settings);
      inner.number("maxDuration_s", scanner.duration_max, units::second, -1, 1e9);
      inner.child("maxDuration_s", [&](XmlInput& text) {
        const std::string content = text.content();
        if (content.find_first_not_of(" \t\r\n") == std::string::npos) {
          report_.warn(text.place(), "<maxDuration_s> is empty: it counts as not given");
          return;
        }
        const auto seconds = number_of(content);
        if (!seconds || !(*seconds >= -1 && *seconds <= 1e9))
          report_.fault(text.place(), "<maxDuration_s> holds " + xml_quoted(content) + ": expected a number of seconds");
        scanner.duration_max = seconds;
      });
      inner.number("verticalResolution_deg", scanner.vertical_resolution, units::degree, 0, 180);
      inner.number("horizontalResolution_deg", scanner.horizontal_resolution, units::degree, 0, 360);
    });
    LegScannerSettings& s = scanner.settings;
    if (s.pulse_rate == 0 && usual_rate > 0) {
      s.pulse_rate = usual_rate;
      io.warn("pulseFreq_hz", "pulseFreq_hz of 0 stands for the usual one of the scanner, " + xml_number(usual_rate) + " Hz");
    }
    const ChannelSettings* const device = survey_.scanner.channels.empty() ? nullptr : &survey_.scanner.channels.front();
    if (s.scan_angle == 0.0 && device && device->scan_angle_max > 0) {
      s.scan_angle.reset();
      io.warn("scanAngle_deg", "scanAngle_deg of 0 stands for the largest one of the scanner, " +
                                   xml_number(units::degree.number(device->scan_angle_max)) + " deg");
    }
    if (scanner.vertical_resolution == 0 && scanner.horizontal_resolution == 0) return;
    if (!device || !std::holds_alternative<RotatingOptic>(device->optic)) {
      io.warn("verticalResolution_deg", "resolutions have no effect with these optics");
    } else if (device->scan_angle_max > 0) {
      const auto rounded = [](double value, double limit) { return std::fabs(value - limit) < 1e-12 * limit ? limit : value; };
      s.scan_frequency = rounded(s.pulse_rate * scanner.vertical_resolution / (2 * device->scan_angle_max), device->scan_frequency_max);
      s.scan_frequency = rounded(s.scan_frequency, device->scan_frequency_min);
      s.head_speed = rounded(scanner.horizontal_resolution * s.scan_frequency, device->head_speed_max);
      if (!(s.scan_frequency <= 1e6 && s.head_speed <= radians(1e6)))
        io.fault("verticalResolution_deg", "no scanner is as fast as these resolutions need: expected a finer one");
    }
  }

  /// Templates of the survey's own document that no leg names: what is wrong there is odd, as it changes nothing.
  void read_unused_templates() {
    const auto all = [&](const char* element, const auto& read) {
      for (pugi::xml_node node = document_.document().root().child(element); node; node = node.next_sibling(element)) {
        XmlInput io(document_.document(), node, report_, document_.search());
        io.require({"id"});
        io.know({"id", "name"});
        read(io);
        io.finish();
      }
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

  XmlReport report_;
  XmlLibrary library_;
  const XmlLibraryDocument& document_;
  bool channel_files_;
  SurveySettings survey_;
  std::vector<std::string> leg_places_;
};

/// Writes a document with a root.
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

/// Gives what has no id one, so that it can be referred to.
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

inline DocumentWriter document_of(const AssetDocument& assets) {
  DocumentWriter document;
  for (const ScannerSettings& scanner : assets.scanners) document.add("scanner", scanner);
  for (const PlatformSettings& platform : assets.platforms) document.add("platform", platform);
  for (const SceneSettings& scene : assets.scenes) document.add("scene", scene);
  return document;
}

}  // namespace detail

inline SurveyDocument read_survey(const std::filesystem::path& path, const XmlOptions& options) {
  return detail::SurveyReader(path, options).read();
}

inline AssetDocument read_assets(const std::filesystem::path& path, const XmlOptions& options) {
  return detail::SurveyReader(path, options).read_assets();
}

inline void write_survey(const std::filesystem::path& path, const SurveySettings& survey) { detail::document_of(survey).write(path); }

inline std::string xml_text(const SurveySettings& survey) { return detail::document_of(survey).text(); }

inline void write_assets(const std::filesystem::path& path, const AssetDocument& assets) { detail::document_of(assets).write(path); }

inline std::string xml_text(const AssetDocument& assets) { return detail::document_of(assets).text(); }

}  // namespace pulsecast::helios
