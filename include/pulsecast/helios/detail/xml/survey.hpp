// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_XML_SURVEY_HPP
#define PULSECAST_HELIOS_DETAIL_XML_SURVEY_HPP

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <pugixml.hpp>

#include <pulsecast/helios/detail/xml/document.hpp>
#include <pulsecast/helios/detail/xml/element.hpp>
#include <pulsecast/helios/detail/xml/fields.hpp>
#include <pulsecast/helios/detail/xml/leg_reader.hpp>
#include <pulsecast/helios/detail/xml/library.hpp>
#include <pulsecast/helios/detail/xml/platform.hpp>
#include <pulsecast/helios/detail/xml/scanner.hpp>
#include <pulsecast/helios/detail/xml/scene.hpp>
#include <pulsecast/helios/settings.hpp>

namespace PULSECAST_NAMESPACE::helios::detail {

/// Reads one survey.
class SurveyReader {
 public:
  /// `assets` and `channel_files` as in `XmlOptions`.
  SurveyReader(const std::filesystem::path& path, const std::vector<std::filesystem::path>& assets, bool channel_files)
      : library_(folders(path, assets), report_), document_(library_.read(path)), channel_files_(channel_files) {}

  /// Reads the survey of the document. Throws `XmlFaults`.
  [[nodiscard]] SurveySettings read() {
    const XmlDocument& document = document_.document();
    const pugi::xml_node node = document.root().child("survey");
    if (!node) report_.fault(document.place(document.root()), "there is no <survey> in this document");
    if (const pugi::xml_node second = node.next_sibling("survey"))
      report_.warn(document.place(second), "a second <survey>: the first one is used");
    if (node) {
      XmlInput io(document, node, report_, document_.search());
      read_survey(io, std::filesystem::path(document.path()).stem().string());
      io.finish();
      legs_.read_unused_templates();
    }
    report_.require_clean();
    place_ = document.place(node).text();
    return survey_;
  }

  /// Reads all elements of a name in the document.
  template <class Settings>
  void read_all(const char* element, std::vector<Settings>& values) {
    for (pugi::xml_node node = document_.document().root().child(element); node; node = node.next_sibling(element))
      asset({&document_, node}, values.emplace_back());
  }

  /// Per leg, of the survey.
  [[nodiscard]] const std::vector<std::string>& leg_places() const noexcept { return leg_places_; }
  [[nodiscard]] const std::string& place() const noexcept { return place_; }  ///< position of the survey
  [[nodiscard]] const XmlReport& report() const noexcept { return report_; }

 private:
  static std::vector<std::filesystem::path> folders(const std::filesystem::path& path,
                                                    std::vector<std::filesystem::path> all) {
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
      io.warn("name",
              XmlInput::said("name", survey_.name) + " cannot name a folder for results: the name of the file is used");
      survey_.name.clear();
    }
    if (survey_.name.empty()) survey_.name = std::move(name);
    seed(io);
    io.without_effect({"numRuns", "simSpeed"});
    bool is_offset = false;
    LegOffsetSettings offset;
    io.flag("legRandomOffset", is_offset);
    offset.fields(io);
    if (is_offset) survey_.leg_offset = offset;
    io.require({"scanner", "platform", "scene"});
    read_platform(io);
    const XmlReference scanner = read_reference(io, "scanner", survey_.scanner);
    if (survey_.scanner.channels.size() > 1) check_channel_ids(scanner);
    read_reference(io, "scene", survey_.scene);
    xml::noise_fields(io, survey_.platform);
    read_overrides(io);
    leg_places_ = legs_.read(io);
  }

  void seed(XmlInput& io) {
    const auto text = io.value("seed");
    if (!text || *text == "AUTO" || *text == "auto") return;
    if (const auto whole = text::number_in<std::uint64_t>(*text)) return void(survey_.seed = *whole);
    // YYYY-MM-DD hh:mm:ss
    static constexpr std::array<std::uint64_t, 6> seconds{31'104'000, 2'592'000, 86'400, 3600, 60, 1};
    static constexpr std::array<std::uint64_t, 6> first{1970, 0, 0, 0, 0, 0};
    std::string_view rest = *text;
    std::uint64_t time = 0;
    bool is_time = text->size() < 40;
    for (std::size_t i = 0; is_time && i < 6; ++i) {
      const auto value = text::take_number<std::uint64_t>(rest);
      is_time = value && *value >= first[i] && *value < 10000 && rest.empty() == (i == 5);
      time += is_time ? (*value - first[i]) * seconds[i] : 0;
      rest.remove_prefix(rest.empty() ? 0 : 1);
    }
    const auto number = number_of(*text);
    if (is_time) {
      survey_.seed = time;
    } else if (number && std::abs(*number) < 1e18) {
      survey_.seed = static_cast<std::uint64_t>(std::abs(*number));
      if (*number < 0 || *number != std::floor(*number))
        io.warn("seed", XmlInput::said("seed", *text) + " is taken as " + std::to_string(*survey_.seed) +
                            ": expected a whole number from 0");
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

  /// Checks ids of channels; those without one have their number as id.
  void check_channel_ids(const XmlReference& scanner) {
    const XmlDocument& document = scanner.document->document();
    std::map<std::string, std::size_t> numbers;
    pugi::xml_node node = scanner.node.child("channels").child("channel");
    for (std::size_t k = 0; k < survey_.scanner.channels.size() && node; ++k, node = node.next_sibling("channel")) {
      const std::string id =
          survey_.scanner.channels[k].id.empty() ? std::to_string(k) : survey_.scanner.channels[k].id;
      const auto [other, is_new] = numbers.emplace(id, k);
      if (channel_files_ && std::any_of(id.begin(), id.end(), fits_no_name))
        report_.fault(document.place(node, "id"),
                      "the id of a channel is part of file names: expected no slashes and no control characters in it");
      if (is_new) continue;
      const std::string problem = "channel " + std::to_string(k) + " has the id of channel " +
                                  std::to_string(other->second) + ", " + text::quoted(id);
      if (channel_files_)
        report_.fault(document.place(node, "id"),
                      problem + ": expected different ids, as each channel has its own file");
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
            ignored.fields(inner);
          }))
        io.warn("platform", "<scannerMount> of a survey has no effect unless platform=\"interpolated\"");
      return;
    }
    survey_.platform.id = "interpolated";
    if (const auto base = io.given("basePlatform"))
      if (const XmlReference found = library_.find(io, document_, "basePlatform", *base, "platform"))
        asset(found, survey_.platform);
    survey_.platform.multicopter = {};
    survey_.platform.kind = PlatformKind::interpolated;
    xml::rotation_spec(io, survey_.platform.rotation_spec);
    io.child("scannerMount", [&](XmlInput& inner) { survey_.platform.mount.fields(inner); });
  }

  /// Reads the scanner overrides of a survey, for all channels.
  void read_overrides(XmlInput& io) {
    std::vector<ChannelSettings> none(1);
    std::vector<ChannelSettings>& channels = survey_.scanner.channels.empty() ? none : survey_.scanner.channels;
    for (ChannelSettings& channel : channels) {
      io.child("FWFSettings", [&](XmlInput& inner) { channel.waveform.fields(inner); });
      io.child("detectorSettings", [&](XmlInput& inner) {
        channel.detector_fields(inner);
        xml::range_noise(inner, channel);
        channel.check_range(inner);
      });
    }
    limit_bins(io);
  }

  void limit_bins(const XmlInput& io) {
    const pugi::xml_node own = io.node().child("FWFSettings");
    for (ChannelSettings& channel : survey_.scanner.channels) {
      const std::string note = xml::bin_note(channel);
      if (!note.empty()) report_.warn(own ? document_.document().place(own) : io.place("scanner"), note);
      channel.waveform.bin_size = limited_bin(channel);
    }
  }

  XmlReport report_;
  XmlLibrary library_;
  const XmlLibraryDocument& document_;
  bool channel_files_;
  SurveySettings survey_;
  LegReader legs_{library_, document_, report_, survey_};
  std::vector<std::string> leg_places_;
  std::string place_;
};

}  // namespace PULSECAST_NAMESPACE::helios::detail

#endif
