// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/helios/document.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <doctest/doctest.h>

#include "helios/damage_surveys.hpp"
#include "helios/survey_texts.hpp"
#include "support/file_errors.hpp"
#include "support/relative.hpp"
#include "support/temporary_folder.hpp"

using namespace pulsecast;
using namespace pulsecast::helios;
using support::contains;
using support::faults_of;
using support::leg;
using support::read_text;
using support::survey_text;

namespace {

const support::TemporaryFolder folder;
const std::filesystem::path& data = support::data_folder;
const XmlOptions options{.assets = {data}};
constexpr const char* surveys[] = {"tripod", "airplane", "drone", "trajectory", "spinning"};

std::filesystem::path sample(const std::string& name) { return data / "surveys" / (name + ".xml"); }

std::filesystem::path written(const std::string& name, const std::string& text) {
  std::ofstream(folder / name, std::ios::binary) << text;
  return folder / name;
}

bool any_contains(const std::vector<std::string>& texts, const std::string& part) {
  return std::any_of(texts.begin(), texts.end(), [&](const std::string& text) { return contains(text, part); });
}

}  // namespace

TEST_CASE("a survey is read with its templates, its scanner, its platform and its scene") {
  const SurveyDocument document = read_survey(sample("airplane"), options);
  CHECK(document.warnings.empty());
  const SurveySettings& survey = document.survey;
  CHECK(survey.name == "airplane");
  CHECK_FALSE(survey.seed);
  REQUIRE(survey.leg_offset);
  CHECK(survey.leg_offset->mean == 0);
  CHECK(survey.leg_offset->deviation == 0.2);
  REQUIRE(survey.legs.size() == 4);
  CHECK(survey.legs[0].strip == "a");
  CHECK(survey.legs[2].strip == "b");
  CHECK(survey.legs[1].platform.position == Vec3(476700, 5474300, 600));
  CHECK(survey.legs[1].platform.speed == 120);
  CHECK(survey.legs[0].scanner.active);
  CHECK_FALSE(survey.legs[1].scanner.active);
  CHECK(survey.legs[1].scanner.scan_angle == radians(20));
  CHECK(survey.legs[2].scanner.scan_angle == radians(15));
  CHECK(survey.legs[3].scanner.pulse_rate == 20000);
  CHECK(survey.legs[0].scanner.trajectory_interval == 0.05);

  CHECK(survey.platform.kind == PlatformKind::linear_path);
  CHECK(survey.platform.mount.position == Vec3(0, 0, 0.7));
  const Vec3 beam = survey.platform.mount.rotation.rotation() *
                    axis::forward;  // down by the first turn, which the second does not change
  CHECK(length(beam - Vec3(0, 0, -1)) < 1e-12);
  CHECK(survey.platform.position_noise[0]->deviation == 0.02);
  CHECK(survey.platform.position_noise[1]->deviation == 0.03);
  CHECK(survey.platform.position_noise[1]->clip_low == -0.1);
  CHECK(survey.platform.attitude_noise[2]->distribution == NoiseDistribution::uniform);
  CHECK(survey.platform.attitude_noise[2]->lifespan == 10);

  CHECK(survey.scanner.pulse_rates == std::vector<double>{2000, 20000});
  REQUIRE(survey.scanner.channels.size() == 1);
  const ChannelSettings& device = survey.scanner.channels[0];
  REQUIRE(std::holds_alternative<OscillatingOptic>(device.optic));
  CHECK(std::get<OscillatingOptic>(device.optic).scan_product_max == radians(9e5));
  CHECK(device.pulse_length == 10e-9);
  CHECK(device.wavelength == 1064e-9);
  CHECK(device.visibility == 23e3);
  CHECK(device.scan_angle_max == radians(37.5));
  CHECK(device.range_max == std::numeric_limits<double>::infinity());
  CHECK(device.returns_max == 4);
  CHECK(device.received_power_min == support::relative(1e-13, 1e-12));

  REQUIRE(survey.scene.parts.size() == 1);
  CHECK(survey.scene.parts[0].id == "0");
  const auto& raster = std::get<GeoTiffSource>(survey.scene.parts[0].source);
  CHECK(raster.files == std::vector<std::filesystem::path>{data / "terrain.tif"});
  CHECK(raster.material.file == data / "materials.mtl");
  CHECK(raster.material.name == "ground");
}

TEST_CASE("what a survey sets of the scanner holds for every channel, and takes the place of nothing else") {
  const SurveySettings tripod = read_survey(sample("tripod"), options).survey;
  const ChannelSettings& device = tripod.scanner.channels.at(0);
  CHECK(device.waveform == FullWaveformSettings{.bin_size = 0.2e-9, .window = 1e-9, .rings = 5, .duration_max = 60e-9});
  CHECK(device.accuracy == 0.01);
  CHECK(device.range_min == 1);
  CHECK(device.range_max == 250);
  CHECK(device.errors.range == "0.001*sin(THETA)");
  CHECK(tripod.seed == 42);
  CHECK(tripod.legs[1].duration_max == 0.5);
  CHECK(tripod.legs[1].scanner.divergence == 0.001);
  CHECK(tripod.legs[0].scanner.vertical_angle_min == radians(-40));

  const std::string text = survey_text(
      R"(scanner="surveys/assets.xml#puck")",
      R"(<FWFSettings beamSampleQuality="2"/><detectorSettings rangeMin_m="2" distanceMeasurementError="1+t/100"/>
        <leg maxDuration_s="1"><platformSettings/><scannerSettings scanFreq_hz="5"/></leg>)");
  const SurveySettings puck = read_text(text).survey;
  REQUIRE(puck.scanner.channels.size() == 4);
  for (const ChannelSettings& channel : puck.scanner.channels) {
    CHECK(channel.waveform.rings == 2);
    CHECK(channel.waveform.window == 2e-9);  // the scanner's
    CHECK(channel.range_min == 2);
    CHECK(channel.errors.range_noise == "1+t/100");
  }
}

TEST_CASE("a channel has what it says, and what it does not say from its scanner") {
  const AssetDocument assets = read_assets(sample("assets"));
  REQUIRE(assets.scanners.size() == 6);
  REQUIRE(assets.platforms.size() == 4);
  const std::vector<ChannelSettings>& puck = assets.scanners[5].channels;
  REQUIRE(puck.size() == 4);
  CHECK(puck[0].beam_origin.position.z == 0.02);
  CHECK(puck[0].beam_origin.rotation.turns == std::vector<AxisTurn>{{Axis::y, radians(-95)}});
  CHECK(puck[1].beam_origin.rotation.turns == std::vector<AxisTurn>{{Axis::y, radians(-90)}});
  CHECK(puck[1].divergence == 0.003);
  CHECK(puck[3].divergence == 0.001);
  CHECK(puck[2].wavelength == 1550e-9);
  CHECK(puck[1].wavelength == 903e-9);
  CHECK(puck[2].scan_angle_max == radians(90));
  CHECK(std::get<RotatingOptic>(puck[2].optic).effective_angle_max == radians(80));
  CHECK(std::get<RotatingOptic>(puck[1].optic).effective_angle_max == radians(180));
  CHECK(std::get<LineOptic>(puck[3].optic).fibers == 8);
  CHECK(puck[3].received_power_min == support::relative(1e-12, 1e-12));
  const std::vector<ChannelSettings>& prisms = assets.scanners[4].channels;
  REQUIRE(prisms.size() == 3);
  const auto& risley = std::get<RisleyOptic>(prisms[2].optic);
  CHECK(risley.incident_beam == Vec3(0.0269, 0.99963, 0));
  CHECK(risley.prisms[1] == RisleyPrism{radians(29.6), -51.6, 1.51});
}

TEST_CASE("parts have their filters, motions and swaps") {
  const AssetDocument assets = read_assets(sample("scenes"), options);
  REQUIRE(assets.scenes.size() == 4);
  const PartSettings& turned = assets.scenes[1].parts.at(1);
  CHECK(turned.id == "turned");
  CHECK(std::get<ObjSource>(turned.source).y_up);
  CHECK(turned.transform.scale == 1.5);
  CHECK(turned.transform.translation == Vec3(4, -6, 0.5));
  CHECK(turned.transform.on_ground == 1);
  REQUIRE(turned.transform.rotations.size() == 1);
  CHECK(turned.transform.rotations[0].local);
  CHECK(turned.transform.rotations[0].turns == std::vector<AxisTurn>{{Axis::x, radians(30)}, {Axis::z, radians(45)}});
  const auto& voxels = std::get<VoxelSource>(assets.scenes[2].parts.at(0).source);
  CHECK(voxels.mode == VoxelMode::scaled);
  CHECK(voxels.random_shift);
  const auto& cloud = std::get<XyzSource>(assets.scenes[2].parts.at(2).source);
  CHECK(cloud.separator == ",");
  CHECK(cloud.default_normal == axis::up);
  const SceneSettings& moving = assets.scenes[3];
  CHECK(moving.dynamic_step == 2);
  const PartSettings& spinner = moving.parts.at(1);
  REQUIRE(spinner.motions.size() == 2);
  CHECK(spinner.motions[0].loop == 100);
  CHECK(spinner.motions[0].next == "turn");
  CHECK(spinner.motions[0].motions.at(1).about_itself);
  CHECK(std::get<TranslationMotion>(spinner.motions[0].motions.at(0).kind).by == Vec3(0.002, 0, 0));
  CHECK(std::get<RotationMotion>(spinner.motions[1].motions.at(0).kind) ==
        RotationMotion{axis::up, radians(1), Vec3(1, 2, 3), {}});
  CHECK(spinner.motions[1].motions.at(0).shift_factor == 1);
  CHECK(std::get<RotationMotion>(spinner.motions[1].motions.at(1).kind).glide == 0.01);
  CHECK(std::get<ReflectionMotion>(spinner.motions[1].motions.at(3).kind).shift == Vec3(0, 1, 0));
  const PartSettings& swapped = moving.parts.at(2);
  REQUIRE(swapped.swaps.size() == 3);
  CHECK(swapped.swaps[0].step == 2);
  CHECK(swapped.swaps[0].transform.scale == 2);
  CHECK_FALSE(swapped.swaps[0].source);
  CHECK(swapped.swaps[1].source);
  CHECK(swapped.swaps[2].removes);
}

TEST_CASE("an interpolated platform takes mount and noise from another, and the survey's mount first") {
  const SurveySettings survey = read_survey(sample("trajectory"), options).survey;
  CHECK(survey.platform.kind == PlatformKind::interpolated);
  CHECK(survey.platform.rotation_spec == RotationSpec::canonical);
  CHECK(survey.platform.mount.position == Vec3(0, 0, 0.9));
  CHECK(survey.platform.mount.rotation.local);
  CHECK(survey.platform.position_noise[0]->deviation == 0.02);
  REQUIRE(survey.legs.at(0).platform.trajectory);
  const TrajectorySettings& trajectory = *survey.legs[0].platform.trajectory;
  CHECK(trajectory.file == data / "flight.trj");
  CHECK(trajectory.columns == TrajectoryIndices{});
  CHECK(trajectory.start == 1);
  CHECK(trajectory.end == 2.5);
  for (const char* name : {"trajectory_seperator", "trajectory_separator"}) {
    const std::string text = survey_text(R"(platform="interpolated")",
                                         "<leg><platformSettings trajectory=\"flight.trj\" " + std::string(name) +
                                             "=\";\"/><scannerSettings scanFreq_hz=\"20\"/></leg>");
    const SurveySettings other = read_text(text).survey;
    CHECK(other.legs.at(0).platform.trajectory->separator == ';');
    CHECK_FALSE(other.legs.at(0).platform.trajectory->columns);
  }
}

TEST_CASE("a survey, read, written and read again, gives equal settings") {
  for (const char* name : surveys) {
    CAPTURE(name);
    const SurveyDocument first = read_survey(sample(name), options);
    write_survey(folder / "again.xml", first.survey);
    CHECK(xml_text(first.survey) == support::content(folder / "again.xml"));
    const SurveyDocument second = read_survey(folder / "again.xml");
    CHECK(second.survey == first.survey);
    CHECK(second.warnings.empty());
    SurveySettings other = first.survey;
    other.legs.front().scanner.scan_rate += 1;  // what was compared can differ
    CHECK(other != first.survey);
  }
}

TEST_CASE("assets, read, written and read again, give equal settings") {
  for (const char* name : {"assets", "scenes"}) {
    CAPTURE(name);
    const AssetDocument first = read_assets(sample(name), options);
    write_assets(folder / "again.xml", first);
    CHECK(xml_text(first) == support::content(folder / "again.xml"));
    const AssetDocument second = read_assets(folder / "again.xml");
    CHECK(second.scanners == first.scanners);
    CHECK(second.platforms == first.platforms);
    CHECK(second.scenes == first.scenes);
    CHECK(first.scanners.size() + first.scenes.size() >= 4);
  }
}

TEST_CASE("settings that a program makes are written and read") {
  SurveySettings survey;
  survey.name = "study <&> \"1\"";
  survey.seed = std::numeric_limits<std::uint64_t>::max();
  survey.scanner = {
      .id = "s",
      .name = "of our own",
      .pulse_rates = {1000},
      .channels = {{.optic = RotatingOptic{}, .scan_angle_max = 1, .returns_kept = KeptReturns::strongest}}};
  survey.platform.id = "p";
  survey.scene.id = "c";
  survey.scene.parts = {
      {.id = "a b", .source = ObjSource{.files = {data / "materials.obj", data / "surveys" / "points.xyz"}}}};
  survey.scene.parts[0].swaps = {
      {.source = VoxelSource{.files = {data / "crown.vox"}, .leaf_angles = data / "spherical.txt"}},
      {.source = MeshSource{
           .files = {data / "materials.obj"}, .up = MeshUp::y, .unit = 0.01, .materials = data / "materials.mtl"}}};
  survey.scene.parts[0].attributes = {{"age", 80}, {"leaf or wood", 0.1}};
  survey.scene.light = {{.passages = 3, .share_min = 0.01, .orders = 2, .paths = 20, .field_of_view = radians(20)}};
  survey.scene.media = {
      {.absorption = 0.5},
      {.absorption = 0.1, .scattering = 0.2, .backscatter = 0.01, .min = Vec3{0, 1, 2}, .max = Vec3{3, 4, 5}}};
  survey.legs = {{.duration_max = 0.1, .scanner = {.pulse_rate = 1000, .scan_rate = 10, .scan_angle = 0.3}}};
  write_survey(folder / "own.xml", survey);
  const SurveySettings again = read_survey(folder / "own.xml").survey;
  CHECK(again.scene == survey.scene);
  CHECK(again.platform == survey.platform);
  CHECK(again.name == survey.name);
  CHECK(again.seed == survey.seed);
  CHECK(again.legs[0].scanner.scan_angle.value() == support::relative(0.3, 1e-15));
  CHECK(again.scanner.channels[0].optic == survey.scanner.channels[0].optic);
  CHECK(again.scanner.channels[0].returns_kept == KeptReturns::strongest);
}

TEST_CASE("a survey is never written that would not be read") {
  SurveySettings survey;
  survey.scanner.channels = {{.optic = RotatingOptic{}, .scan_angle_max = 1}};
  survey.scene.parts = {{.source = ObjSource{.files = {data / "materials.obj"}}}};
  survey.legs = {{.duration_max = 0.1, .scanner = {.pulse_rate = 5000, .scan_rate = 10}}};
  write_survey(folder / "own.xml", survey);
  CHECK(read_survey(folder / "own.xml").survey.scanner.pulse_rates == std::vector<double>{5000});
  CHECK(read_survey(folder / "own.xml").warnings.empty());
  const auto refused = [&](const auto& change, const char* says) {
    SurveySettings other = survey;
    change(other);
    CHECK_THROWS_WITH_AS(write_survey(folder / "no.xml", other), doctest::Contains(says), SettingError);
    CHECK_FALSE(std::filesystem::exists(folder / "no.xml"));
  };
  survey.legs[0].scanner.vertical_angle_max = std::nextafter(2 * pi, 7);  // 360 degrees but for rounding
  CHECK_NOTHROW(write_survey(folder / "own.xml", survey));
  CHECK_NOTHROW((void)read_survey(folder / "own.xml"));
  refused([](SurveySettings& s) { s.legs[0].scanner.vertical_angle_min = -40; }, "leg 0: verticalAngleMin_deg");
  refused([](SurveySettings& s) { s.legs[0].duration_max.reset(); }, "leg 0: maxDuration_s");
  refused([](SurveySettings& s) { s.legs.clear(); }, "legs (number)");
  refused([](SurveySettings& s) { s.scene.parts.clear(); }, "scene: parts (number)");
  refused([](SurveySettings& s) { s.scene.parts[0].source = XyzSource{}; }, "part '': files (number)");
  refused([](SurveySettings& s) { s.scene.parts[0].transform.scale = 1e-31; }, "part '': scale is 1e-31");
  refused([](SurveySettings& s) { s.scene.parts[0].transform.translation.x = 2e9; }, "part '': offset is 2e+09");
  refused([](SurveySettings& s) { s.scene.dynamic_interval = 1e7; }, "dynTimeStep is 1e+07 s");
  refused([](SurveySettings& s) { s.scene.parts[0].motions = {{.id = "a", .next = "b"}}; },
          "part '': next=\"b\": there is no such");
  refused(
      [](SurveySettings& s) {
        s.scene.parts[0].motions = {{.id = "a", .motions = {{.kind = ReflectionMotion{.normal = {}}}}}};
      },
      "ortho is too short");
  refused([](SurveySettings& s) { s.scanner.pulse_rates = {1e-9}; }, "pulseFreqs_Hz is 1e-09 Hz");
  refused([](SurveySettings& s) { s.scanner.channels[0].head_axis = {}; }, "headRotateAxis has no direction");
}

TEST_CASE("a survey without a name has that of its file") {
  CHECK(read_text(survey_text("", leg(""))).survey.name == "survey");
  CHECK(read_text(survey_text(R"(name="")", leg(""))).survey.name == "survey");
  CHECK(read_text(survey_text(R"(name="one")", leg(""))).survey.name == "one");
}

TEST_CASE("a value that equals the default can be set against a template") {
  const std::string templates =
      R"(<scannerSettings id="t" active="false" beamDivergence_rad="0.001" headRotateStart_deg="5"/>)";
  const SurveySettings survey =
      read_text(survey_text("", leg(R"(template="t" active="true" beamDivergence_rad="0.003" headRotateStart_deg="0")"),
                            templates))
          .survey;
  CHECK(survey.legs[0].scanner.active);
  CHECK(survey.legs[0].scanner.divergence == 0.003);
  CHECK(survey.legs[0].scanner.head_start == 0);
}

TEST_CASE("the seed may be a number or a time") {
  const auto seed = [](const char* text) {
    return read_text(survey_text("seed=\"" + std::string(text) + "\"", leg(""))).survey.seed;
  };
  CHECK_FALSE(seed("AUTO"));
  CHECK(seed("7") == 7);
  CHECK(seed("7.9") == 7);
  CHECK(seed("1971-01-01 00:00:02") == 31104000 + 2592000 + 86400 + 2);
  CHECK(seed("-3") == 3);
  for (const char* odd : {"7.9", "-3"}) {
    const std::vector<std::string> warnings =
        read_text(survey_text("seed=\"" + std::string(odd) + "\"", leg(""))).warnings;
    CHECK(any_contains(warnings,
                       "survey.xml:3:9: seed=\"" + std::string(odd) + "\" is taken as " + (odd[0] == '7' ? "7" : "3")));
  }
  CHECK(read_text(survey_text(R"(seed="7.0")", leg(""))).warnings.empty());
  CHECK(contains(faults_of(survey_text(R"(seed="often")", leg(""))), "seed=\"often\""));
}

TEST_CASE("a leg has the scanner's first rate, and resolutions give rates") {
  SurveySettings survey = read_text(survey_text("", leg(""))).survey;
  CHECK(survey.legs[0].scanner.pulse_rate == 2000);
  CHECK_FALSE(survey.legs[0].scanner.scan_angle);
  survey =
      read_text(
          survey_text("", R"(<leg><platformSettings/><scannerSettings pulseFreq_hz="20000" verticalResolution_deg="0.24"
      horizontalResolution_deg="0.5" headRotateStop_deg="90"/></leg>)"))
          .survey;
  CHECK(survey.legs[0].scanner.scan_rate == support::relative(20000 * 0.24 / 240, 1e-12));
  CHECK(survey.legs[0].scanner.head_rate == support::relative(radians(10), 1e-12));
  CHECK(contains(faults_of(survey_text(
                     "", leg(R"(pulseFreq_hz="1e8" verticalResolution_deg="180" horizontalResolution_deg="1")"))),
                 "these resolutions need a scan frequency"));
}

TEST_CASE("bins that pulses fall between, or that are too many, are limited") {
  const auto read = [](const char* bin, double taken) {
    const SurveyDocument document =
        read_text(survey_text("", R"(<FWFSettings binSize_ns=")" + std::string(bin) + "\"/>" + leg("")));
    CHECK(document.survey.scanner.channels.at(0).waveform.bin_size == support::relative(taken, 1e-12));
    return document.warnings;
  };
  CHECK(
      any_contains(read("9", 5e-9),
                   "survey.xml:4:2: binSize_ns is 9 ns, and pulses are 5 ns long: it is limited to 5 ns; expected bins "
                   "from 0.0005 ns to 5 ns"));
  CHECK(any_contains(read("0.0003", 0.0005e-9), "binSize_ns is 0.0003 ns"));
  CHECK(read("5", 5e-9).empty());
  CHECK(read("0.0005", 0.0005e-9).empty());
}

TEST_CASE("names that become those of files have no slashes and no control characters") {
  const auto document =
      read_text(survey_text(R"(name="../../else\where")", R"(<leg stripId="a/b">)" + leg("").substr(5)));
  CHECK(document.survey.name == ".._.._else_where");
  CHECK(document.survey.legs.at(0).strip == "a_b");
  CHECK(any_contains(document.warnings, "survey.xml:3:9: name=\"../../else\\where\" is taken as '.._.._else_where'"));
  CHECK(any_contains(document.warnings, "survey.xml:4:6: stripId=\"a/b\" is taken as 'a_b'"));
  CHECK(read_text(survey_text(R"(name="..")", leg(""))).survey.name == "survey");
  CHECK(read_text(survey_text(R"(name="a&#27;[2Jb")", leg(""))).survey.name == "a_[2Jb");
  for (const char* strip : {"a&#10;b", "a&#127;b", "a\\b"})
    CHECK(read_text(survey_text("", "<leg stripId=\"" + std::string(strip) + "\">" + leg("").substr(5)))
              .survey.legs.at(0)
              .strip == "a_b");
}

TEST_CASE("what is wrong with a template that no leg names is odd only") {
  const std::string templates = "<scannerSettings id=\"t\" scanFreq_hz=\"much\"/>\n<platformSettings x=\"1\"/>\n";
  const auto document = read_text(survey_text("", leg(""), templates));
  CHECK(any_contains(document.warnings, "survey.xml:3:25: scanFreq_hz=\"much\": expected a number"));
  CHECK(any_contains(document.warnings, "survey.xml:4:2: <platformSettings> has no attribute 'id'"));
  CHECK(
      contains(faults_of(survey_text("", leg(R"(template="t")"), templates)), "survey.xml:3:25: scanFreq_hz=\"much\""));
}

TEST_CASE("a leg that could never end, and rates beyond the device, are refused") {
  const auto refuses = [](const std::string& text, const std::string& part) {
    CAPTURE(text);
    const std::string faults = faults_of(text);
    INFO(faults);
    CHECK(contains(faults, part));
  };
  const std::string airplane = R"(platform="surveys/assets.xml#airplane")";
  const std::string stands = R"(<leg><platformSettings movePerSec_m="0"/><scannerSettings scanFreq_hz="20"/></leg>)";
  const std::string flies = R"(<leg><platformSettings x="9"/><scannerSettings scanFreq_hz="20"/></leg>)";
  refuses(survey_text(airplane, stands + flies), "movePerSec_m is 0");
  refuses(survey_text(airplane, flies), "the only leg");
  CHECK(faults_of(survey_text(airplane, flies + stands)).empty());
  refuses(survey_text("", leg(R"(scanFreq_hz="20")")), "neither platform nor head moves");
  refuses(survey_text("", leg(R"(scanFreq_hz="20" headRotateStop_deg="20")")), "the head does not turn");
  refuses(survey_text("", leg(R"(scanFreq_hz="20" headRotateStop_deg="20" headRotatePerSec_deg="-5")")), "turns away");
  refuses(survey_text(R"(scanner="surveys/assets.xml#puck")",
                      leg("headRotateStop_deg=\"20\" headRotatePerSec_deg=\"5\" scanFreq_hz=\"5\"")),
          "headRotatePerSecMax_deg is 0");
  CHECK(faults_of(survey_text("", leg(R"(scanFreq_hz="20" headRotateStop_deg="20" maxDuration_s="2")"))).empty());
  CHECK(
      faults_of(
          survey_text(
              "",
              R"(<leg><platformSettings/><scannerSettings scanFreq_hz="20"><maxDuration_s>2</maxDuration_s></scannerSettings></leg>)"))
          .empty());
  refuses(survey_text("", leg(R"(headRotatePerSec_deg="60" headRotateStop_deg="20" scanFreq_hz="201")")),
          "scanFreqMax_Hz, 200 Hz");
  refuses(survey_text("", leg(R"(headRotatePerSec_deg="60" headRotateStop_deg="20" scanFreq_hz="0.5")")),
          "scanFreqMin_Hz, 1 Hz");
  refuses(survey_text("", leg(R"(verticalAngleMin_deg="10" verticalAngleMax_deg="10")")), "no pulse is emitted");
  refuses(survey_text("", ""), "holds no <leg>");
  refuses(survey_text("", "<leg><scannerSettings/></leg>"), "holds no <platformSettings>");
  refuses(survey_text(R"(platform="interpolated")", leg("")), "'trajectory'");
  CHECK(faults_of(survey_text("", leg(R"(scanFreq_hz="20" headRotatePerSec_deg="20")"))).empty());  // it ends at once
}

TEST_CASE("vertical angles that are further apart than the scanner's are limited, with a warning") {
  const auto warnings = [](const char* angles) { return read_text(survey_text("", leg(angles))).warnings; };
  const std::vector<std::string> wide = warnings(R"(verticalAngleMin_deg="-60" verticalAngleMax_deg="60")");
  REQUIRE(wide.size() == 1);
  CHECK(contains(
      wide[0],
      "survey.xml:4:109: verticalAngleMin_deg and verticalAngleMax_deg are further apart than the scanner's 100 deg"));
  CHECK(contains(wide[0], "they are limited to -50 and 50 deg"));
  CHECK(warnings(R"(verticalAngleMin_deg="-40" verticalAngleMax_deg="60")").empty());
}

TEST_CASE("angles that can hardly be degrees get a note") {
  const auto notes = [](const char* angles) { return read_text(survey_text("", leg(angles))).warnings; };
  for (const char* angles :
       {R"(verticalAngleMin_deg="-0.7" verticalAngleMax_deg="1.05")", R"(scanAngle_deg="0.35")",
        R"(scanAngle_deg="1.5708")", R"(headRotateStart_deg="-1.5708")", R"(headRotateStart_deg="3.14")"}) {
    CAPTURE(angles);
    const std::vector<std::string> found = notes(angles);
    REQUIRE(found.size() == 1);
    CHECK(contains(found[0], "given in radians, not degrees?"));
  }
  for (const char* angles :
       {R"(verticalAngleMin_deg="-40" verticalAngleMax_deg="60")",
        R"(verticalAngleMin_deg="-4.5" verticalAngleMax_deg="2")", R"(scanAngle_deg="3.5")",
        R"(headRotateStart_deg="-3")", R"(headRotateStart_deg="-90")", R"(headRotateStart_deg="-5.5")"}) {
    CAPTURE(angles);
    CHECK(notes(angles).empty());
  }
}

TEST_CASE("a platform that moves may stay where it is") {
  const auto told = [](const std::string& legs) {
    const std::string text = survey_text(R"(platform="surveys/assets.xml#quadcopter")", legs);
    std::string all = faults_of(text);
    if (all.empty())
      for (const std::string& warning : read_text(text).warnings) all += warning + '\n';
    return all;
  };
  const auto at = [](const std::string& place, const std::string& duration = "") {
    return "<leg " + duration + "><platformSettings " + place +
           R"(/><scannerSettings scanFreq_hz="20" pulseFreq_hz="20000"/></leg>)";
  };
  const std::string last = R"(<leg><platformSettings x="9"/><scannerSettings active="false"/></leg>)",
                    stay = R"(maxDuration_s="2")";
  CHECK_FALSE(contains(told(at("")), "maxDuration_s=\"2\""));
  CHECK(contains(told(at("")), "as its destination, or maxDuration_s"));
  CHECK_FALSE(contains(told(at("", stay)), "leg"));
  CHECK_FALSE(contains(told(at("", stay) + at("") + last), "leg"));
  CHECK_FALSE(contains(told(at(R"(movePerSec_m="0")", stay) + at("") + last), "leg"));
  CHECK(contains(told(at("") + at("") + last), "ends at once: maxDuration_s"));
  CHECK(contains(told(at("") + at(R"(x="9")", stay)),
                 "to stay there for maxDuration_s, expected another <leg> at the same position"));
}

TEST_CASE("a resolution that the scanner is too slow or too fast for is told as such, with one that it can do") {
  const auto at = [](const char* resolution) {
    return faults_of(survey_text("", leg("maxDuration_s=\"1\" pulseFreq_hz=\"20000\" verticalResolution_deg=\"" +
                                         std::string(resolution) + "\"")));
  };
  CHECK(contains(at("5"),
                 "verticalResolution_deg of 5 takes 416.666667 lines a second at 20000 Hz: expected at most 2.4"));
  CHECK(contains(at("5"), "for the scanner's scanFreqMax_Hz is 200 Hz"));
  CHECK(contains(at("0.001"), "expected at least"));
  CHECK(at("2.4").empty());
}

TEST_CASE("the last leg of a platform that moves scans nothing, and is not held against the scanner") {
  const std::string airplane = R"(platform="surveys/assets.xml#airplane")";
  const std::string flies = R"(<leg><platformSettings x="9"/><scannerSettings scanFreq_hz="20"/></leg>)";
  for (const char* settings :
       {R"(<scannerSettings scanFreq_hz="0"/>)", R"(<scannerSettings scanFreq_hz="1e5"/>)", ""}) {
    const std::string ends = "<leg><platformSettings/>" + std::string(settings) + "</leg>";
    CHECK(faults_of(survey_text(airplane, flies + ends)).empty());
    CHECK(contains(faults_of(survey_text(airplane, ends + flies)), "scanFreq_hz"));
  }
}

TEST_CASE("what stands on the ground needs some, and what a platform cannot is told") {
  const std::string grounded =
      R"(<leg maxDuration_s="1"><platformSettings onGround="true"/><scannerSettings scanFreq_hz="20"/></leg>)";
  CHECK(faults_of(survey_text("", grounded)).empty());
  const std::string scene =
      R"(<scene id="bare"><part><filter type="xyzloader"><param key="filepath" value="surveys/points.xyz"/>
    <param key="separator" value=","/><param key="voxelSize" value="1"/></filter></part></scene>)";
  const std::string bare = survey_text(R"(scene="#bare")", grounded, scene);
  CHECK(contains(faults_of(bare), "survey.xml:5:42: nothing"));
  CHECK(contains(faults_of(bare), "nothing in the scene is ground: expected a material with helios_isGround"));
  const std::string turns =
      R"(<leg maxDuration_s="1"><platformSettings smoothTurn="true" yawAtDeparture_deg="5"/><scannerSettings scanFreq_hz="20"/></leg>)";
  const auto warnings = read_text(survey_text("", turns)).warnings;
  REQUIRE(warnings.size() == 2);
  CHECK(contains(warnings[0], "a smooth turn has no effect with this type of platform"));
  CHECK(contains(warnings[1], "yawAtDeparture_deg has no effect with this type of platform"));
}

TEST_CASE("a document says where each leg stands") {
  const auto document = read_text(survey_text("", leg("") + "\n  " + leg("")));
  REQUIRE(document.leg_places.size() == 2);
  CHECK(contains(document.leg_places[0], "survey.xml:4:2"));
  CHECK(contains(document.leg_places[1], "survey.xml:5:4"));
}

TEST_CASE("what is odd is told beside what is wrong") {
  try {
    (void)read_text(survey_text(R"(numRuns="2" seed="often" colour="red")", leg("")));
    FAIL("was read");
  } catch (const XmlFaults& faults) {
    CHECK(faults.faults().size() == 1);
    CHECK(faults.warnings().size() == 2);
    CHECK(any_contains(faults.warnings(), "survey.xml:3:34: attribute 'colour' of <survey> is not known"));
  }
}

TEST_CASE("what has no effect, or is unlike what it seems, is told and does not hinder") {
  const auto warns = [](const std::string& text, const std::string& part) {
    const std::vector<std::string> warnings = read_text(text).warnings;
    CAPTURE(part);
    CHECK(any_contains(warnings, part));
    CHECK(any_contains(warnings, "survey.xml:"));
  };
  warns(survey_text(R"(numRuns="1")", leg("")), "'numRuns' has no effect");
  warns(survey_text(R"(simSpeed="1")", leg("")), "'simSpeed' has no effect");
  warns(survey_text("", R"(<FWFSettings apertureDiameter_m="0.1"/>)" + leg("")), "'apertureDiameter_m' has no effect");
  warns(survey_text("", leg(R"(pulseFreq_hz="0")")), "means the scanner's default");
  warns(survey_text("", leg(R"(pulseFreq_hz="3000")")), "not one of the scanner's pulse rates");
  warns(survey_text("", leg(R"(scanAngle_deg="0")")), "means the scanner's maximum");
  warns(survey_text("", leg(R"(scanAngle_deg="130")")), "limited to 120");
  warns(
      survey_text(
          "",
          R"(<leg><platformSettings/><scannerSettings scanFreq_hz="20" headRotatePerSec_deg="720" headRotateStop_deg="9"/></leg>)"),
      "limited to 360");
  warns(survey_text("", leg(R"(active="false")")), "no leg is active");
}

TEST_CASE("several faults are reported together, each with its place and what to mend") {
  const std::string text =
      "<?xml version=\"1.0\"?>\n"
      "<document>\n"
      "  <survey name=\"x\" scene=\"surveys/scenes.xml#yart\" platform=\"surveys/assets.xml#tripod\"\n"
      "          scanner=\"surveys/nothing.xml#rotating\">\n"
      "    <leg>\n"
      "      <platformSettings z=\"1O\"/>\n"
      "      <scannerSettings pulseFreq_Hz=\"1\" scanFreq_hz=\"1,5\"/>\n"
      "      <scanerSettings/>\n"
      "    </leg>\n"
      "  </survey>\n"
      "</document>\n";
  const std::string path = written("survey.xml", text).string();
  try {
    (void)read_survey(path, options);
    FAIL("was read");
  } catch (const XmlFaults& faults) {
    const std::string all = faults.what();
    INFO(all);
    CHECK(faults.faults().size() == 4);
    CHECK(faults.warnings().size() == 2);
    CHECK(faults.path() == path);
    CHECK(contains(all, path + ":3:20: scene=\"surveys/scenes.xml#yart\": there is no <scene> with the id 'yart'"));
    CHECK(contains(all, "did you mean 'yard'?"));
    CHECK(contains(all, path + ":4:11: scanner=\"surveys/nothing.xml#rotating\" does not exist"));
    CHECK(contains(all, path + ":6:25: z=\"1O\": expected a number from -1000000000 to 1000000000 m"));
    CHECK(faults.warnings()[0] ==
          path + ":7:24: attribute 'pulseFreq_Hz' of <scannerSettings> is not known; did you mean 'pulseFreq_hz'?");
    CHECK(contains(all, path + ":7:41: scanFreq_hz=\"1,5\": expected a number"));
    CHECK(faults.warnings()[1] ==
          path + ":8:8: element <scanerSettings> in <leg> is not known; did you mean 'scannerSettings'?");
  }
}

TEST_CASE("channels of one id are told with their place, and refused where each is to have a file of its own") {
  const auto document = [](const std::string& first, const std::string& second) {
    return written(
        "channels.xml",
        "<document>\n  <scanner id=\"s\" optics=\"rotating\" pulseFreqs_Hz=\"3000\" scanAngleMax_deg=\"60\">\n    "
        "<channels>\n"
        "      <channel" +
            first + "/>\n      <channel" + second +
            "/>\n    </channels>\n  </scanner>\n"
            "  <survey scanner=\"#s\" platform=\"surveys/assets.xml#tripod\" scene=\"surveys/scenes.xml#yard\">\n"
            "    <leg maxDuration_s=\"1\"><platformSettings/><scannerSettings scanFreq_hz=\"10\"/></leg>\n  "
            "</survey>\n</document>\n");
  };
  const XmlOptions with_files{.assets = {data}, .channel_files = true};
  const auto faults = [&](const std::filesystem::path& path) -> std::string {
    try {
      (void)read_survey(path, with_files);
      return {};
    } catch (const XmlFaults& found) {
      return found.what();
    }
  };
  CHECK(faults(document(R"( id="a")", R"( id="b")")).empty());
  CHECK(faults(document("", "")).empty());
  CHECK(contains(faults(document(R"( id="a")", R"( id="a")")),
                 "channels.xml:5:16: channel 1 has the id of channel 0, 'a'"));
  CHECK(contains(faults(document(R"( id="1")", "")), "channels.xml:5:8: channel 1 has the id of channel 0, '1'"));
  CHECK(contains(faults(document(R"( id="1")", R"( id="")")),
                 "channels.xml:5:16: channel 1 has the id of channel 0, '1'"));
  CHECK(contains(faults(document(R"( id="a")", R"( id="../b")")),
                 "channels.xml:5:16: the id of a channel is part of file names"));
  CHECK(contains(faults(document(R"( id="a&#10;")", "")),
                 "channels.xml:4:16: the id of a channel is part of file names"));

  CHECK(read_survey(document(R"( id="a")", R"( id="../b")"), options).warnings.empty());
  const SurveyDocument read = read_survey(document(R"( id="1")", ""), options);
  CHECK(read.survey.scanner.channels.size() == 2);
  CHECK(any_contains(read.warnings, "channels.xml:5:8: channel 1 has the id of channel 0, '1'"));
}

TEST_CASE("templates may have templates, but none that is its own") {
  const std::string two =
      R"(<scannerSettings id="a" scanFreq_hz="30"/><scannerSettings id="b" template="a" scanAngle_deg="9"/>)";
  const SurveySettings survey =
      read_text(
          survey_text("", R"(<leg maxDuration_s="1"><platformSettings/><scannerSettings template="b"/></leg>)", two))
          .survey;
  CHECK(survey.legs[0].scanner.scan_rate == 30);
  CHECK(survey.legs[0].scanner.scan_angle == radians(9));
  const std::string cycle = R"(<scannerSettings id="a" template="b"/><scannerSettings id="b" template="a"/>)";
  CHECK(contains(faults_of(survey_text("", leg(R"(template="a")"), cycle)), "is a template of itself"));
}

TEST_CASE("the departure's yaw is not inherited, and a smooth turn is no stop") {
  const SurveySettings survey =
      read_text(
          survey_text(
              "", R"(<leg maxDuration_s="1"><platformSettings template="t"/><scannerSettings scanFreq_hz="20"/></leg>)",
              R"(<platformSettings id="t" yawAtDeparture_deg="5" smoothTurn="true"/>)"))
          .survey;
  CHECK_FALSE(survey.legs[0].platform.yaw_at_departure);
  CHECK(survey.legs[0].platform.smooth_turn);
}

TEST_CASE("files that match a pattern become parts of their own, if the part has no name") {
  for (const char* name : {"a1.xyz", "a2.xyz", "b.txt"}) (void)written(name, "0,0,0\n");
  const std::string filter = R"(<filter type="xyzloader"><param type="string" key="efilepath" value="a[0-9]\.xyz"/>
      <param type="string" key="separator" value=","/><param type="double" key="voxelSize" value="1"/></filter>)";
  const std::string scene = "<document><scene id=\"s\"><part>" + filter + "</part><part id=\"named\">" + filter +
                            "</part><part>" + filter + "</part></scene></document>";
  const AssetDocument assets = read_assets(written("scene.xml", scene));
  REQUIRE(assets.scenes.at(0).parts.size() == 5);
  const std::vector<PartSettings>& parts = assets.scenes[0].parts;
  const std::initializer_list<const char*> ids{"0", "1", "named", "3", "4"};
  CHECK(std::equal(parts.begin(), parts.end(), ids.begin(),
                   [](const PartSettings& part, const char* id) { return part.id == id; }));
  CHECK(std::get<XyzSource>(parts[1].source).files == std::vector<std::filesystem::path>{folder / "a2.xyz"});
  CHECK(std::get<XyzSource>(parts[2].source).files.size() == 2);
  write_assets(folder / "again.xml", assets);
  CHECK(read_assets(folder / "again.xml").scenes == assets.scenes);
}

TEST_CASE("a survey may have ten thousand legs") {
  std::string legs;
  for (int i = 0; i < 10'000; ++i)
    legs += "<leg stripId=\"s" + std::to_string(i) + "\"><platformSettings template=\"p\" x=\"" + std::to_string(i) +
            "\"/>" + "<scannerSettings template=\"t\" scanAngle_deg=\"" + std::to_string(1 + i % 30) + "\"/></leg>\n";
  const std::string templates = R"(<platformSettings id="p" y="5"/><scannerSettings id="t" scanFreq_hz="20"/>)";
  const SurveyDocument document = read_text(survey_text(R"(platform="surveys/assets.xml#airplane")", legs, templates));
  REQUIRE(document.survey.legs.size() == 10'000);
  CHECK(document.survey.legs[9'999].platform.position == Vec3(9'999, 5, 0));
  CHECK(document.survey.legs[9'999].scanner.scan_angle == radians(1 + 9'999 % 30));
}

TEST_CASE("documents in windows-1252 and ISO-8859-1 become UTF-8, those of other encodings are refused") {
  const auto read = [](const std::string& encoding, const std::string& name) {
    std::string text = survey_text("name=\"" + name + "\"", leg(""));
    text.erase(0, text.find("?>") + 2);
    return read_text((encoding.empty() ? "" : "<?xml version='1.0' encoding='" + encoding + "'?>") + text);
  };
  const std::size_t usual = read("UTF-8", "munich").warnings.size();
  const auto is = [&](const std::string& encoding, const std::string& name, const std::string& expected,
                      const std::string& note = "") {
    CAPTURE(encoding);
    const SurveyDocument document = read(encoding, name);
    CHECK(document.survey.name == expected);
    CHECK(document.warnings.size() == usual + (note.empty() ? 0 : 1));
    if (!note.empty()) CHECK(contains(document.warnings.front(), note));
  };
  for (const char* encoding : {"ISO-8859-1", "iso-8859-1", "windows-1252", "Windows-1252"}) {
    is(encoding, "m\xFCnchen", "m\xC3\xBCnchen");
    is(encoding, "\x80 5", "\xE2\x82\xAC 5");  // euro
    is(encoding, "m\xC3\xBCnchen", "m\xC3\xBCnchen", "and is UTF-8, as which it is taken");
  }
  for (const char* encoding : {"UTF-8", "", "us-ascii"}) {
    is(encoding, "m\xC3\xBCnchen", "m\xC3\xBCnchen");
    is(encoding, "m\xFCnchen", "m\xC3\xBCnchen", "is no UTF-8, and is taken as windows-1252");
    is(encoding, "\xED\xA0\x80", "\xC3\xAD\xC2\xA0\xE2\x82\xAC", "is no UTF-8");  // a surrogate
  }
  is("Shift_JIS", "munich", "munich");  // in ASCII
  CHECK(contains(support::file_error([&] { (void)read("Shift_JIS", "m\xFCnchen"); }).problem(),
                 "has the encoding 'shift_jis': expected"));
}

TEST_CASE("hostile documents are refused at once") {
  const auto refuses = [](const std::string& text, const std::string& part) {
    const std::string faults = faults_of(text);
    INFO(faults);
    CHECK(contains(faults, part));
  };
  std::string bomb = "<?xml version=\"1.0\"?><!DOCTYPE document [<!ENTITY a \"ha\">";
  for (char c = 'b'; c < 'z'; ++c) {
    bomb += "<!ENTITY " + std::string(1, c) + " \"";
    for (int i = 0; i < 10; ++i) bomb += "&" + std::string(1, static_cast<char>(c - 1)) + ";";
    bomb += "\">";
  }
  refuses(bomb + "]><document><survey name=\"&y;\"/></document>", "declares entities");
  refuses(survey_text(R"(scene="../../../../../../etc/scenes.xml#yard")", leg("")), "does not exist");
  std::string deep;
  for (int i = 0; i < 200'000; ++i) deep += "<a>";
  refuses("<document>" + deep, "is not well-formed XML");
  std::string many, params;
  for (int i = 0; i < 100'000; ++i) {
    many += "<unknown_" + std::to_string(i) + "/>";
    params += "<param key=\"a\" value=\"b\"/>";
  }
  try {
    (void)read_text("<document>" + many + "</document>");
    FAIL("was read");
  } catch (const XmlFaults& faults) {
    CHECK(contains(faults.what(), "there is no <survey>"));
    CHECK(faults.warnings().size() == XmlReport::max_listed);
    CHECK(contains(faults.warnings().back(), "; more than 1000 are not listed"));
  }
  refuses("<document><scene id=\"s\"><part><filter type=\"objloader\">" + params + "</filter></part></scene>" +
              "<survey scene=\"s\" scanner=\"s\" platform=\"s\"/></document>",
          "too many <param> in a filter");
  refuses("<documents/>", "expected <document>");
  CHECK_THROWS_AS((void)read_text(""), FileError);
  CHECK_THROWS_AS((void)read_survey(folder / "missing.xml"), FileError);
  CHECK_THROWS_AS((void)read_survey(folder.path()), FileError);
}

TEST_CASE("hundreds of damaged copies are refused or told of, each with file, line and the thing to mend") {
  std::map<support::DamageKind, std::size_t> count;
  const support::TemporaryFolder copies;
  for (const char* name : {"tripod", "airplane", "drone", "trajectory", "spinning", "assets", "scenes"}) {
    for (const char* file : {"assets", "scenes"})
      std::filesystem::copy_file(sample(file), copies / (std::string(file) + ".xml"),
                                 std::filesystem::copy_options::overwrite_existing);
    const std::filesystem::path path = copies / (std::string(name) + ".xml");
    const bool is_survey = std::find(std::begin(surveys), std::end(surveys), std::string(name)) != std::end(surveys);
    for (const support::Damage& damage : support::damages(support::content(sample(name)))) {
      std::filesystem::remove(path);
      std::ofstream(path, std::ios::binary) << damage.text;
      INFO(std::string(name), " line ", damage.line, ": '", damage.wrong, "' for '", damage.mended, "'");
      ++count[damage.kind];
      std::vector<std::string> odd, wrong;
      try {
        odd = is_survey ? read_survey(path, options).warnings : read_assets(path, options).warnings;
      } catch (const XmlFaults& faults) {
        odd = faults.warnings();
        for (const XmlFault& fault : faults.faults()) wrong.push_back(fault.place.text() + ": " + fault.problem);
      }
      const std::string place = path.string() + ":" + std::to_string(damage.line) + ":";
      const auto is_named = [&](const std::string& told) {
        return told.starts_with(place) && contains(told, damage.wrong) &&
               (damage.mended.size() < 3 || contains(told, damage.mended));
      };
      const auto is_idle = [&](const std::string& told) {
        return told.starts_with(place) && contains(told, "has no effect");
      };
      const bool is_odd_only = damage.kind == support::DamageKind::attribute_misspelt || damage.wrong.empty();
      const bool is_told = std::any_of(wrong.begin(), wrong.end(), is_named) ||
                           std::any_of(odd.begin(), odd.end(), is_idle) ||
                           (is_odd_only && std::any_of(odd.begin(), odd.end(), is_named));
      CHECK(is_told);
    }
  }
  std::size_t all = 0;
  for (const auto& [kind, number] : count) all += number;
  CHECK(count.size() == 5);
  CHECK(all >= 500);
}
