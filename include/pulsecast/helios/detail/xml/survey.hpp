// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_XML_SURVEY_HPP
#define PULSECAST_HELIOS_DETAIL_XML_SURVEY_HPP

#include <pulsecast/helios/detail/xml/leg_reader.hpp>
#include <pulsecast/helios/detail/xml/scanner.hpp>
#include <pulsecast/helios/detail/xml/scene.hpp>

namespace PULSECAST_NAMESPACE::helios::detail {

/// Reads one survey.
class SurveyReader {
 public:
  /// `assets` and `channel_files` as in `XmlOptions`.
  SurveyReader(const std::filesystem::path& path, const std::vector<std::filesystem::path>& assets, bool channel_files)
      : library_(and_own(assets, path), report_), document_(library_.read(path)), channel_files_(channel_files) {}

  /// Reads the survey of the document. Throws `XmlFaults`.
  [[nodiscard]] SurveySettings read() {
    const XmlDocument& document = document_.document();
    const pugi::xml_node node = document.root().child("survey");
    if (!node) report_.fault(document.place(document.root()), "there is no <survey> in this document");
    if (const pugi::xml_node second = node.next_sibling("survey"))
      report_.warn(document.place(second), "a second <survey>: the first one is used");
    if (node) {
      document_.read(node, report_, [&](XmlInput& io) { read_survey(io); });
      legs_.read_unused_templates();
    }
    report_.require_clean();
    place_ = document.place(node).text();
    return survey_;
  }

  template <class Settings>
  void read_all(const char* element, std::vector<Settings>& values) {
    for (const pugi::xml_node node : document_.document().root().children(element))
      asset({&document_, node}, values.emplace_back());
  }

  [[nodiscard]] const std::vector<std::string>& leg_places() const noexcept { return leg_places_; }
  [[nodiscard]] const std::string& place() const noexcept { return place_; }  ///< of the survey
  [[nodiscard]] const XmlReport& report() const noexcept { return report_; }

 private:
  template <class Settings>
  void asset(const XmlReference& found, Settings& settings) {
    found.document->read(found.node, report_, [&](XmlInput& io) { xml::fields(io, settings); });
  }

  void read_survey(XmlInput& io) {
    io.text("name", survey_.name);
    fit_for_name(io, "name", survey_.name);
    if (survey_.name == ".." || survey_.name == ".") {
      io.warn("name", said("name", survey_.name) + " cannot name a folder for results: the name of the file is used");
      survey_.name.clear();
    }
    if (survey_.name.empty()) survey_.name = std::filesystem::path(io.document().path()).stem().string();
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
        io.warn("seed", said("seed", *text) + " is taken as " + std::to_string(*survey_.seed) +
                            ": expected a whole number from 0");
    } else {
      io.fault("seed", said("seed", *text) + ": expected a whole number, 'YYYY-MM-DD hh:mm:ss' or AUTO");
    }
  }

  template <class Settings>
  XmlReference read_reference(XmlInput& io, const char* name, Settings& settings) {
    const char* const element = std::string_view(name) == "basePlatform" ? "platform" : name;
    const auto text = io.given(name);
    const XmlReference found = text ? library_.find(io, document_, name, *text, element) : XmlReference{};
    if (found) asset(found, settings);
    return found;
  }

  /// Checks ids of channels; those without one have their number as id.
  void check_channel_ids(const XmlReference& scanner) {
    const XmlDocument& document = scanner.document->document();
    std::map<std::string, std::size_t> numbers;
    std::size_t k = 0;
    for (const pugi::xml_node node : scanner.node.child("channels").children("channel")) {
      const XmlPlace place = document.place(node, "id");
      const std::string number = std::to_string(k), given = survey_.scanner.channels[k].id;
      const std::string& id = given.empty() ? number : given;
      const auto [other, is_new] = numbers.emplace(id, k++);
      if (channel_files_ && std::ranges::any_of(id, fits_no_name))
        report_.fault(place,
                      "the id of a channel is part of file names: expected no slashes and no control characters "
                      "in it");
      if (is_new) continue;
      const std::string problem = text::joined(
          {"channel ", number, " has the id of channel ", std::to_string(other->second), ", ", text::quoted(id)});
      if (channel_files_)
        report_.fault(place, problem + ": expected different ids, as each channel has its own file");
      else
        report_.warn(place, problem);
    }
  }

  void read_platform(XmlInput& io) {
    const auto text = io.given("platform");
    if (text != "interpolated") {
      const char* const unless = "has no effect unless platform=\"interpolated\"";
      io.without_effect({"basePlatform", "rotationSpec"}, unless);
      read_reference(io, "platform", survey_.platform);
      const auto ignore = [](XmlInput& inner) { MountSettings{}.fields(inner); };
      if (io.child("scannerMount", ignore)) io.warn("platform", std::string("<scannerMount> of a survey ") + unless);
      return;
    }
    survey_.platform.id = "interpolated";
    read_reference(io, "basePlatform", survey_.platform);
    survey_.platform.multicopter = {};
    survey_.platform.kind = PlatformKind::interpolated;
    xml::rotation_spec(io, survey_.platform.rotation_spec);
    io.child("scannerMount", [&](XmlInput& inner) { survey_.platform.mount.fields(inner); });
  }

  /// Reads the scanner overrides of a survey, for all channels.
  void read_overrides(XmlInput& io) {
    std::vector<ChannelSettings> none(1);
    std::vector<ChannelSettings>& channels = survey_.scanner.channels.empty() ? none : survey_.scanner.channels;
    const pugi::xml_node own = io.node().child("FWFSettings");
    for (ChannelSettings& channel : channels) {
      io.child("FWFSettings", [&](XmlInput& inner) { channel.waveform.fields(inner); });
      io.child("detectorSettings", [&](XmlInput& inner) {
        channel.detector_fields(inner);
        xml::range_noise(inner, channel);
        channel.check_range(inner);
      });
      const std::string note = xml::bin_note(channel);
      if (!note.empty()) report_.warn(own ? io.document().place(own) : io.place("scanner"), note);
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
