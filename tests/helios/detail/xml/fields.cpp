// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/helios/detail/xml/fields.hpp>

#include <cmath>
#include <functional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/helios/detail/xml/scanner.hpp>
#include <pulsecast/helios/detail/xml/scene.hpp>

#include "helios/xml_reading.hpp"

using namespace pulsecast;
using namespace pulsecast::helios;
using support::contains;

namespace {

/// What is told of an element.
template <class Settings>
std::string told(const std::string& text, Settings& settings) {
  return support::xml_told(text, [&](XmlInput& io) { xml::fields(io, settings); });
}
template <class Settings>
std::string told(const std::string& text) {
  Settings settings;
  return told(text, settings);
}

/// The settings of an element with which nothing is wrong or odd.
template <class Settings>
Settings from(const std::string& text) {
  Settings settings;
  CHECK(told(text, settings).empty());
  return settings;
}

std::string scanner(const std::string& attributes, const std::string& inside = "") {
  return "<scanner id=\"s\" pulseFreqs_Hz=\"1000\" " + attributes + ">" + inside + "</scanner>";
}

constexpr const char* mesh =
    R"(<filter type="objloader"><param type="string" key="filepath" value="mesh.obj"/></filter>)";

/// What is told of a filter.
template <class Source>
std::string filter_told(const std::string& params, Source& source) {
  return support::xml_told("<f><filter type=\"x\">" + params + "</filter></f>", [&](XmlInput& outer) {
    outer.know({}, {"filter"});
    XmlInput io(outer.document(), outer.node().child("filter"), outer.report(), outer.search(), true);
    PartSource read = source;
    xml::fields(io, read);
    source = std::get<Source>(read);
    io.finish();
  });
}

/// Sets the numbers of settings one after the other beyond their maximum, in the unit of documents.
class Beyond final : public FieldCheck {
 public:
  explicit Beyond(int row) : row_(row) {}
  [[nodiscard]] bool reads() const noexcept override { return true; }
  [[nodiscard]] bool has(const char*) const override { return true; }
  using FieldCheck::number, FieldCheck::vector;
  void vector(const char*, Vec3&, double) override {}
  void number(const char* row, double& value, const XmlUnit& unit, double, double high) override {
    const bool is_member = std::string_view(row) != "slopeFilterThreshold";
    if (is_member && high < 1e300 && row_-- == 0) value = unit.si(tell(row, 1.5 * std::abs(high) + 1));
  }
  void whole(const char* row, int& value, int, int high) override {
    if (row_-- == 0) value = static_cast<int>(tell(row, high + 1.0));
  }
  bool element(const char*, const std::function<void(FieldIo&)>&) override { return false; }
  void each(const char*, std::size_t, const std::function<void(FieldIo&, std::size_t)>&) override {}
  void fault(std::string_view, std::string) const override {}

  std::string name, text;  ///< of the number that was set

 private:
  double tell(const char* row, double number) {
    name = row;
    text = xml_number(number);
    return number;
  }
  int row_;
};

/// Checks that each number of settings is refused beyond its maximum, as a member and as an attribute; counts them.
template <class Settings>
int refused_beyond_limits(const Settings& defaults = {}) {
  for (int row = 0;; ++row) {
    Settings settings = defaults;
    Beyond beyond(row);
    settings.fields(beyond);
    if (beyond.name.empty()) return row;
    CAPTURE(beyond.name);
    CHECK_NOTHROW(check_fields(defaults));
    CHECK_THROWS_WITH_AS(check_fields(settings), doctest::Contains(beyond.name.c_str()), SettingError);
    settings = defaults;
    const std::string attribute = beyond.name + "=\"" + beyond.text + "\"";
    CHECK(contains(support::xml_told("<a " + attribute + "/>", [&](XmlInput& io) { settings.fields(io); }),
                   attribute + ": expected"));
  }
}

template <class... Settings>
int all_refused_beyond_limits(const Settings&... defaults) {
  return (refused_beyond_limits(defaults) + ...);
}

}  // namespace

// ----------------------------------------------------------------------------------------- limits

TEST_CASE("each number of all settings has its limits in programs and in documents") {
  CHECK(all_refused_beyond_limits(AxisTurn{}, MountSettings{}, ChannelSettings{.optic = OscillatingOptic{}},
                                  RotatingOptic{}, LineOptic{}, RisleyOptic{}, FullWaveformSettings{}, NoiseSettings{},
                                  MountErrorSettings{}, PoseErrorSettings{}, MulticopterDynamics{}, LegOffsetSettings{},
                                  LegPlatformSettings{}, LegScannerSettings{}, TrajectorySettings{},
                                  TrajectoryIndices{}, SceneSettings{}, PartSettings{}, LightSettings{},
                                  MediumSettings{}, MotionSequenceSettings{}, SwapSettings{}, MaterialSource{},
                                  GeoTiffSource{}, XyzSource{}, VoxelSource{}, MeshSource{}) > 90);
}

// ------------------------------------------------------------------------------ mounts, directions

TEST_CASE("a mount has a position and turns in their order") {
  const MountSettings mount = from<MountSettings>(
      R"(<m x="1" y="-2" z="3e2" rotations="local"><rot axis="Z" angle_deg="90"/><rot axis="x" angle_deg="0"/></m>)");
  CHECK(mount.position == Vec3(1, -2, 300));
  CHECK(mount.rotation.local);
  CHECK(mount.rotation.turns == std::vector<AxisTurn>{{Axis::z, radians(90)}, {Axis::x, 0}});
  CHECK(from<MountSettings>("<m/>") == MountSettings{});
}

TEST_CASE("a turn by a part of pi in degrees gets a note") {
  for (const char* angle : {"1.5708", "-1.57", "3.14159", "0.785398"})
    CHECK(contains(told<MountSettings>(R"(<m><rot axis="x" angle_deg=")" + std::string(angle) + "\"/></m>"),
                   "angle_deg is " + std::string(angle) + ": given in radians, not degrees?"));
  for (const char* angle : {"90", "1.5", "3", "-2.5", "0", "6", "22.5", "2.356", "-6.28"})
    CHECK(told<MountSettings>(R"(<m><rot axis="x" angle_deg=")" + std::string(angle) + "\"/></m>").empty());
}

TEST_CASE("a mount takes the place of the one before, as a whole") {
  MountSettings mount{.position = {1, 2, 3}, .rotation = {.turns = {{Axis::x, 1}}, .local = true}};
  CHECK(told(R"(<m z="5"/>)", mount).empty());
  CHECK(mount == MountSettings{.position = {0, 0, 5}});
}

TEST_CASE("of a turn, what cannot be is told") {
  CHECK(contains(told<MountSettings>(R"(<m><rot axis="w" angle_deg="9"/></m>)"), "axis=\"w\" is not known"));
  CHECK(contains(told<MountSettings>(R"(<m><rot axis="x"/></m>)"), "has no attribute 'angle_deg'"));
  CHECK(contains(told<MountSettings>(R"(<m><rot axis="x" angle_deg="1e9"/></m>)"), "from -36000 to 36000 deg"));
  CHECK(contains(told<MountSettings>(R"(<m rotations="lokal"/>)"), "did you mean 'local'?"));
  CHECK(contains(told<MountSettings>(R"(<m x="1e10"/>)"), "expected a number from"));
}

TEST_CASE("a direction needs a length") {
  Vec3 v = axis::up;
  const auto read = [&](const char* text) {
    return support::xml_told(text, [&](XmlInput& io) { io.direction("d", v); });
  };
  CHECK(read(R"(<a><d x="1"/></a>)").empty());
  CHECK(v == axis::right);
  CHECK(contains(read(R"(<a><d x="0" y="0.1"/></a>)"), "shorter than 0.1 and has no effect"));
  CHECK(v == axis::right);
}

// ---------------------------------------------------------------------------------------- scanners

TEST_CASE("a scanner that says nothing has the defaults of the format") {
  const ScannerSettings settings = from<ScannerSettings>(scanner("optics=\"oscillating\""));
  REQUIRE(settings.channels.size() == 1);
  CHECK(settings.channels[0] == ChannelSettings{});
  CHECK(settings.pulse_rates == std::vector<double>{1000});
}

TEST_CASE("of a scanner, what cannot be is told") {
  const auto fault = [](const std::string& attributes, const std::string& inside = "") {
    return told<ScannerSettings>(scanner(attributes, inside));
  };
  CHECK(contains(fault("optics=\"rotatin\""), "did you mean 'rotating'?"));
  CHECK(contains(fault(""), "has no attribute 'optics'"));
  CHECK(contains(fault("optics=\"line\" rangeMin_m=\"5\" rangeMax_m=\"5\""), "rangeMax_m is not beyond rangeMin_m"));
  CHECK(contains(fault("optics=\"line\" scanFreqMin_Hz=\"5\" scanFreqMax_Hz=\"4\""), "scanFreqMax_Hz is below"));
  CHECK(contains(fault("optics=\"line\"", "<headError expr=\"0\"/>"), "warning"));
  CHECK(from<ScannerSettings>(scanner("optics=\"rotating\"", "<headError expr=\"1\"/>")).channels.at(0).errors.head ==
        "1");
  CHECK(contains(fault("optics=\"line\"", "<rangeError expr=\"\"/>"), "warning"));
  for (const char* never : {"1/0", "0/0", "ln(-1)", "sqrt(-1-THETA^2)", "1/(THETA-THETA)"}) {
    const std::string told = fault("optics=\"line\"", "\n<rangeError expr=\"" + std::string(never) + "\"/>");
    CHECK(contains(told,
                   "a.xml:2:13: expr=\"" + std::string(never) + "\" is not finite for any THETA: expected a formula"));
  }
  CHECK(fault("optics=\"line\"", "<rangeError expr=\"1/THETA+ln(THETA)\"/>").empty());  // of some angles
  CHECK(contains(fault("optics=\"line\" distanceMeasurementError=\"1/0\""), "for any t: expected a formula"));
  CHECK(contains(fault("optics=\"line\" distanceMeasurementError=\"1/0\""), "a.xml:1:"));
  const std::string part =
      fault("optics=\"line\" accuracy_m=\"1\" rangeMax_m=\"100\" distanceMeasurementError=\"sqrt(50-t)\"");
  CHECK(contains(part, "a.xml:1:"));
  CHECK(contains(part, "a formula with a finite value from rangeMin_m to rangeMax_m"));
  CHECK(contains(fault("optics=\"line\"", "<rangeError/>"), "has no attribute 'expr'"));
  CHECK(contains(fault("optics=\"line\"", "<rangeError expr=\"2*(THETA\"/>"), "a.xml:1:"));
  CHECK(fault("optics=\"line\"", "<rangeError expr=\"2*(THETA)\"/>").empty());
  CHECK(contains(fault("optics=\"line\" distanceMeasurementError=\"2*THETA\""), "a.xml:1:"));
  CHECK(fault("optics=\"line\" distanceMeasurementError=\"2*t^2\"").empty());
  CHECK(contains(fault("optics=\"rotating\" scanAngleEffectiveMax_deg=\"0\""), "no pulse is emitted"));
  CHECK(contains(fault("optics=\"line\"", "<channels/>"), "warning"));
  CHECK(contains(fault("optics=\"line\" scanProduct=\"5\""), "warning "));
  const auto rates = [](const char* text) {
    return "<scanner id=\"s\" optics=\"line\" pulseFreqs_Hz=\"" + std::string(text) + "\"/>";
  };
  ScannerSettings read;
  CHECK(contains(told<ScannerSettings>(rates("1,,2, "), read), "warning"));
  CHECK(read.pulse_rates == std::vector<double>{1, 2});
  CHECK(contains(told<ScannerSettings>(rates("1,x")), "pulseFreqs_Hz=\"1,x\": expected numbers"));
  CHECK(contains(told<ScannerSettings>(rates(",")), "expected numbers"));
  CHECK(contains(told<ScannerSettings>(rates("")), "is empty: expected a value"));
}

TEST_CASE("a beam quality of 1 says nothing, and another one holds for all channels that say none") {
  CHECK_FALSE(from<ScannerSettings>(scanner("optics=\"line\" beamQualityFactor=\"1\"")).channels.at(0).beam_quality);
  const ScannerSettings settings =
      from<ScannerSettings>(scanner("optics=\"line\" beamQualityFactor=\"2.5\"",
                                    "<channels><channel/><channel beamQualityFactor=\"1.0\"/></channels>"));
  CHECK(settings.channels.at(0).beam_quality == 2.5);
  CHECK_FALSE(settings.channels.at(1).beam_quality);
}

TEST_CASE("which returns are kept is a word of the scanner, or of a channel") {
  const ScannerSettings settings = from<ScannerSettings>(scanner(
      "optics=\"line\" keptReturns=\"Strongest\"", "<channels><channel/><channel keptReturns=\"first\"/></channels>"));
  CHECK(settings.channels.at(0).returns_kept == KeptReturns::strongest);
  CHECK(settings.channels.at(1).returns_kept == KeptReturns::first);
  CHECK(
      contains(told<ScannerSettings>(scanner("optics=\"line\" keptReturns=\"strong\"")), "did you mean 'strongest'?"));
}

TEST_CASE("a channel with other optics than its scanner begins anew") {
  const ScannerSettings settings = from<ScannerSettings>(
      scanner("optics=\"risley\" angle1_deg=\"5\"", "<channels><channel optics=\"line\"/><channel/></channels>"));
  CHECK(settings.channels.at(0).optic == OpticSettings(LineOptic{}));
  CHECK(std::get<RisleyOptic>(settings.channels.at(1).optic).prisms[0].angle == radians(5));
  CHECK(settings.channels[0].id == "0");
  CHECK(settings.channels[1].id == "1");
}

// --------------------------------------------------------------------------------------- platforms

TEST_CASE("a platform that says nothing has the defaults of the format") {
  CHECK(from<PlatformSettings>("<platform id=\"p\" type=\"MultiCopter\"/>") ==
        PlatformSettings{.id = "p", .kind = PlatformKind::multicopter});
  const PlatformSettings noisy =
      from<PlatformSettings>("<platform id=\"p\" type=\"static\"><attitudeYNoise stdev=\"0.1\"/></platform>");
  CHECK(noisy.attitude_noise[1] == NoiseSettings{.deviation = 0.1});
  CHECK_FALSE(noisy.attitude_noise[0]);
  const PlatformSettings wrong = from<PlatformSettings>(
      R"(<platform id="p" type="static"><mountError y="0.5" roll_deg="1" pitch_deg="-2" heading_deg="3"/></platform>)");
  CHECK(wrong.mount_error == MountErrorSettings{{0, 0.5, 0}, radians(1), radians(-2), radians(3)});
  const PlatformSettings drawn = from<PlatformSettings>(
      R"(<platform id="p" type="static"><poseErrors attitudeDriftZ_deg="1" leverArmX_m="2" latency_s="3"/></platform>)");
  CHECK(drawn.pose_errors == PoseErrorSettings{.attitude_drift = {0, 0, radians(1)},
                                               .lever_arm_deviation = {2, 0, 0},
                                               .latency_deviation = 3});
  CHECK(contains(told<PlatformSettings>(R"(<platform id="p" type="static"><mountError yaw_deg="1"/></platform>)"),
                 "attribute 'yaw_deg' of <mountError> is not known"));
}

TEST_CASE("of a platform, what cannot be is told") {
  CHECK(contains(told<PlatformSettings>("<platform id=\"p\" type=\"statik\"/>"), "did you mean 'static'?"));
  CHECK(contains(told<PlatformSettings>("<platform id=\"p\" type=\"static\" yaw_speed_deg=\"1\"/>"),
                 "has no effect with this type"));
  for (const char* type : {"static", "multicopter", "groundvehicle"})
    for (const char* name : {"drag", "engine_max_force", "speedup_magnitude", "slowdown_magnitude", "slowdown_distance",
                             "base_pitch_deg", "pitch_speed_deg", "roll_speed_deg", "roll_offset_deg"}) {
      const std::string begin = "<platform id=\"p\" type=\"" + std::string(type) + "\" " + name + "=\"";
      CHECK(contains(told<PlatformSettings>(begin + "1\"/>"), "warning"));
      CHECK(contains(told<PlatformSettings>(begin + "1\"/>"),
                     "'" + std::string(name) + "' has no effect: paths are planned"));
      CHECK(told<PlatformSettings>(begin + "much\"/>") == told<PlatformSettings>(begin + "1\"/>"));
    }
  CHECK(contains(
      told<PlatformSettings>(R"(<platform id="p" type="static"><attitudeYNoise type="UNIFORM" min="2"/></platform>)"),
      "max is below min"));
  CHECK(contains(told<PlatformSettings>(
                     R"(<platform id="p" type="static"><attitudeYNoise clipEnabled="1" clipMin="2"/></platform>)"),
                 "clipMax is below"));
  CHECK(contains(told<PlatformSettings>("<platform type=\"static\"/>"), "has no attribute 'id'"));
}

// -------------------------------------------------------------------------------------------- legs

TEST_CASE("a leg that says nothing has the defaults of the format") {
  CHECK(from<LegPlatformSettings>("<platformSettings/>") == LegPlatformSettings{});
  LegScannerSettings scanner;
  CHECK(told("<scannerSettings/>", scanner).empty());
  CHECK(scanner == LegScannerSettings{});
}

TEST_CASE("any index of a column means that all are agreed") {
  const LegPlatformSettings leg = from<LegPlatformSettings>(R"(<p trajectory="mesh.obj" tIndex="0"/>)");
  CHECK(leg.trajectory->columns == TrajectoryIndices{});
  CHECK_FALSE(from<LegPlatformSettings>(R"(<p trajectory="mesh.obj"/>)").trajectory->columns);
  CHECK(from<LegPlatformSettings>(R"(<p trajectory="mesh.obj" zIndex="9"/>)").trajectory->columns->z == 9);
}

TEST_CASE("of a trajectory, what cannot be is told") {
  CHECK(contains(told<LegPlatformSettings>(R"(<p trajectory="none.trj"/>)"), "does not exist"));
  CHECK(contains(told<LegPlatformSettings>(R"(<p trajectory="mesh.obj" tStart="2" tEnd="2"/>)"),
                 "tEnd is not after tStart"));
  for (const char* separator : {";;", "|", ""}) {
    LegPlatformSettings settings;
    const std::string odd = told<LegPlatformSettings>(
        "<p trajectory=\"mesh.obj\" trajectory_separator=\"" + std::string(separator) + "\"/>", settings);
    CHECK(odd.starts_with("\nwarning "));
    CHECK(contains(odd, "has no effect: expected a comma, a semicolon, a tab or a blank; it is detected"));
    CHECK_FALSE(settings.trajectory->separator);
  }
  CHECK(contains(told<LegPlatformSettings>(R"(<p trajectory="mesh.obj" tIndex="1000"/>)"), "from 0 to 999"));
  CHECK(contains(told<LegPlatformSettings>(R"(<p trajectory="mesh.obj" interpolationDomain="positions"/>)"),
                 "did you mean 'position'?"));
}

TEST_CASE("a multicopter that does not stop to turn turns smoothly") {
  CHECK_FALSE(from<LegPlatformSettings>(R"(<p stopAndTurn="true"/>)").smooth_turn);
  CHECK(from<LegPlatformSettings>(R"(<p stopAndTurn="false"/>)").smooth_turn);
  CHECK(from<LegPlatformSettings>(R"(<p stopAndTurn="true" smoothTurn="true"/>)").smooth_turn);
  LegPlatformSettings inherited{.smooth_turn = true};
  CHECK(told(R"(<p smoothTurn="false"/>)", inherited).empty());
  CHECK_FALSE(inherited.smooth_turn);
}

TEST_CASE("what of a leg does nothing is told, and what is as it says is not") {
  CHECK(contains(told<LegPlatformSettings>(R"(<p slowdownEnabled="false"/>)"), "warning"));
  CHECK(told<LegPlatformSettings>(R"(<p slowdownEnabled="true"/>)").empty());
  CHECK(contains(told<LegPlatformSettings>(R"(<p slowdownEnabled="no"/>)"), "is taken as false"));
  CHECK(told<LegPlatformSettings>(R"(<p trajectory="mesh.obj" teleportToStart="true"/>)").empty());
  CHECK(from<LegPlatformSettings>(R"(<p trajectory="mesh.obj" teleportToStart="true"/>)").trajectory.value().teleports);
  CHECK(contains(told<LegPlatformSettings>(R"(<p trajectory="mesh.obj" slopeFilterThreshold="0.1"/>)"),
                 "all samples are kept"));
  CHECK(told<LegPlatformSettings>(R"(<p trajectory="mesh.obj" slopeFilterThreshold="0"/>)").empty());
}

TEST_CASE("figures of a leg that make no sense are told") {
  LegScannerSettings scanner;
  CHECK(contains(told(R"(<s pulseFreq_hz="-1"/>)", scanner), "from 0 to 100000000 Hz"));
  CHECK(contains(told(R"(<s scanAngle_deg="1e9"/>)", scanner), "from 0 to 180 deg"));
  CHECK(contains(told(R"(<s headRotatePerSec_deg="1e7"/>)", scanner), "deg"));
  CHECK(contains(told<LegPlatformSettings>(R"(<p movePerSec_m="-1"/>)"), "from 0 to 100000 m/s"));
  CHECK(scanner == LegScannerSettings{});
}

// ------------------------------------------------------------------------------------------ scenes

TEST_CASE("a scene and a part that say little have the defaults of the format") {
  const SceneSettings scene = from<SceneSettings>("<scene id=\"s\"><part>" + std::string(mesh) + "</part></scene>");
  CHECK(scene == SceneSettings{.id = "s", .parts = {{.id = "0", .source = scene.parts.at(0).source}}});
  const SceneSettings timed = from<SceneSettings>("<scene id=\"s\" dynTimeStep=\"0.5\"><part dynTimeStep=\"1\">" +
                                                  std::string(mesh) + "</part></scene>");
  CHECK(timed.dynamic_interval == 0.5);
  CHECK(timed.parts.at(0).dynamic_interval == 1);
}

TEST_CASE("light and media of a scene are read, and what they cannot be is told") {
  const std::string part = "<part>" + std::string(mesh) + "</part></scene>";
  const SceneSettings scene = from<SceneSettings>(R"(<scene id="s"><light passages="3" orders="2" fieldOfView_deg="90"/>
    <medium scattering_perM="0.1" backscatter_perMSr="0.01" min="0;1;2" max="3;4;5"/><medium absorption_perM="2"/>)" +
                                                  part);
  REQUIRE(scene.light.size() == 1);
  CHECK(scene.light[0] == LightSettings{.passages = 3, .orders = 2, .field_of_view = pi / 2});
  REQUIRE(scene.media.size() == 2);
  CHECK(scene.media[0].region(0).bounds == Box{{0, 1, 2}, {3, 4, 5}});
  CHECK(scene.media[0].backscatter == 0.01);
  CHECK(scene.media[1].region(0).bounds == everywhere());
  const auto fault = [&](const std::string& inside) { return told<SceneSettings>("<scene id=\"s\">" + inside + part); };
  CHECK(contains(fault(R"(<light passages="33"/>)"), "from 0 to 32"));
  CHECK(contains(fault(R"(<light orders="0"/>)"), "from 1 to 64"));
  CHECK(contains(fault(R"(<light/><light/>)"), "a second <light>"));
  CHECK(contains(fault(R"(<medium absorption_perM="-1"/>)"), "from 0"));
  CHECK(contains(fault(R"(<medium scattering_perM="0.1" backscatter_perMSr="0.2"/>)"), "Medium::backscatter"));
  CHECK(contains(fault(R"(<medium min="1;1;1" max="0;0;0"/>)"), "MediumRegion::bounds"));
  CHECK(contains(fault(R"(<medium min="0;0;0" max="2;2;2"/><medium min="1;1;1" max="3;3;3"/>)"), "Media (region)"));
  CHECK(contains(fault(R"(<medium min="0;0;0" max="2;2;2"/><medium min="1;1;1" max="3;3;3"/>)"), "apart from it"));
}

TEST_CASE("media are read by presets, too, and what does not go together is told") {
  const std::string part = "<part>" + std::string(mesh) + "</part></scene>";
  const SceneSettings scene = from<SceneSettings>(R"(<scene id="s"><medium preset="fog" visibility_m="200"/>
    <medium preset="rain" rate_mmPerH="5" min="0;0;0" max="1;1;1"/>)" +
                                                  part);
  REQUIRE(scene.media.size() == 2);
  const Medium thick = fog(200, 1550e-9);
  CHECK(scene.media[0].region(1550e-9).medium.scattering == thick.scattering);
  CHECK(scene.media[0].region(1550e-9).medium.backscatter == thick.backscatter);
  CHECK(scene.media[1].region(905e-9).particles.lidar_ratio == rain(5, 905e-9).lidar_ratio);
  CHECK(scene.media[1].region(905e-9).bounds == Box{{0, 0, 0}, {1, 1, 1}});
  const auto fault = [&](const std::string& inside) { return told<SceneSettings>("<scene id=\"s\">" + inside + part); };
  CHECK(contains(fault(R"(<medium preset="fogg" visibility_m="200"/>)"), "fog"));
  CHECK(contains(fault(R"(<medium preset="fog"/>)"), "fog (visibility)"));
  CHECK(contains(fault(R"(<medium preset="fog" visibility_m="2000"/>)"), "from 1 to 1000"));
  CHECK(contains(fault(R"(<medium preset="fog" visibility_m="0"/>)"), "visibility_m"));
  CHECK(contains(fault(R"(<medium preset="snow" rate_mmPerH="20"/>)"), "from 0.1 to 10"));
  CHECK(contains(fault(R"(<medium preset="rain" visibility_m="200"/>)"), "visibility_m"));
  CHECK(contains(fault(R"(<medium preset="haze" visibility_m="2000" rate_mmPerH="2"/>)"), "rate_mmPerH"));
  CHECK(contains(fault(R"(<medium visibility_m="200"/>)"), "but for fog"));
  CHECK(contains(fault(R"(<medium preset="fog" visibility_m="200" scattering_perM="0.1"/>)"), "with a preset"));
}

TEST_CASE("scale and translate replace, with a warning; rotations add up") {
  const std::string twice =
      std::string(mesh) + R"(<filter type="scale"><param type="double" key="scale" value="2"/></filter>
    <filter type="rotate"><param type="rotation" key="rotation"><rot axis="z" angle_deg="90"/></param></filter>
    <filter type="scale"><param type="double" key="scale" value="3"/></filter>
    <filter type="rotate"><param type="rotation" key="rotation"><rot axis="x" angle_deg="90"/></param></filter>)";
  SceneSettings scene;
  CHECK(contains(told("<scene id=\"s\"><part>" + twice + "</part></scene>", scene), "a second filter 'scale'"));
  REQUIRE(scene.parts.size() == 1);
  CHECK(scene.parts[0].transform.scale == 3);
  CHECK(scene.parts[0].transform.rotations.size() == 2);
  const std::string by_value =
      R"(<filter type="rotate"><param type="rotation" key="rotation" value="0;0;45"/></filter>)";
  CHECK(contains(told("<scene id=\"s\"><part>" + (mesh + by_value) + "</part></scene>", scene),
                 "attribute 'value' has no effect"));
}

TEST_CASE("of a scene, what cannot be is told") {
  const auto fault = [](const std::string& inside) {
    return told<SceneSettings>("<scene id=\"s\"><part>" + inside + "</part></scene>");
  };
  const std::string loads = mesh;
  CHECK(fault(loads).empty());
  CHECK(contains(fault(loads + loads), "a second loading filter"));
  CHECK(contains(fault("<filter type=\"objlaoder\"/>"), "did you mean 'objloader'?"));
  CHECK(contains(fault("<filter type=\"objloader\"/>"), "has no param 'filepath'"));
  CHECK(contains(fault(""), "holds no <part> with a loading filter"));
  CHECK(contains(fault(loads + "<filter type=\"scale\"/>"), "has no param 'scale'"));
  CHECK(contains(fault(loads + R"(<filter type="scale"><param key="scale" value="-2"/></filter>)"), "scale=\"-2\""));
  CHECK(contains(fault(loads + R"(<filter type="scale"><param key="scale" value="1e-31"/></filter>)"),
                 "the scale is less than 1e-30"));
  CHECK(contains(fault(loads + R"(<dmotion id="a" loop="1" next="b"/>)"), "next=\"b\": there is no such <dmotion>"));
  CHECK(contains(fault(loads + R"(<swap swapStep="0"/>)"), "swapStep=\"0\": expected a whole number"));
  CHECK(contains(fault(loads + R"(<swap keepCRS="false"/>)"), "keepCRS of false has no effect"));
  CHECK(fault(loads + R"(<swap keepCRS="true"/>)").empty());
}

TEST_CASE("a part has named numbers, each with a name and a value, and each name once") {
  const auto scene = [](const std::string& inside) {
    return "<scene id=\"s\"><part>" + (mesh + inside) + "</part></scene>";
  };
  const auto made =
      from<SceneSettings>(scene(R"(<attribute name="age" value="80"/><attribute name="dbh" value="-2e3"/>)"));
  CHECK(made.parts.at(0).attributes == std::vector<AttributeSettings>{{"age", 80}, {"dbh", -2000}});
  CHECK(contains(told<SceneSettings>(scene(R"(<attribute name="age"/>)")), "has no attribute 'value'"));
  CHECK(contains(told<SceneSettings>(scene(R"(<attribute value="1"/>)")), "has no attribute 'name'"));
  CHECK(contains(told<SceneSettings>(scene(R"(<attribute name="a" value="1"/><attribute name="a" value="2"/>)")),
                 "each name once"));
}

TEST_CASE("a part's number counts parts without geometry") {
  SceneSettings scene;
  CHECK(contains(told<SceneSettings>("<scene id=\"s\"><part/><part>" + std::string(mesh) + "</part></scene>", scene),
                 "it is left out"));
  REQUIRE(scene.parts.size() == 1);
  CHECK(scene.parts[0].id == "1");
}

// -------------------------------------------------------------------------------- sources of parts

TEST_CASE("a cloud that says little has the defaults of the format") {
  XyzSource cloud;
  CHECK(
      filter_told(
          R"(<param key="filepath" value="mesh.obj"/><param key="separator" value=""/><param key="voxelSize" value="1"/>)",
          cloud)
          .empty());
  CHECK(cloud.files.at(0).filename() == "mesh.obj");
  CHECK(cloud.voxel_size == 1);
  CHECK(cloud.separator.empty());
  CHECK(cloud.normal_columns[2] == 5);
  XyzSource other;
  CHECK(contains(filter_told(R"(<param key="filepath" value="mesh.obj"/>)", other), "has no param 'voxelSize'"));
  const std::string odd =
      R"(<param key="filepath" value="mesh.obj"/><param key="voxelSize" value="0"/><param key="defaultNormal" value="0;0;0"/>)";
  CHECK(filter_told(odd, other).starts_with("\nwarning "));
  CHECK(contains(filter_told(odd, other), "a.xml:1:84: voxelSize of 0 means 1 m"));
  CHECK(contains(filter_told(odd, other), "defaultNormal is zero: it has no direction, and no effect"));
  CHECK(other.voxel_size == 1);
  CHECK_FALSE(other.default_normal);
  CHECK(contains(filter_told(R"(<param key="normalXIndex" value="1000"/>)", other), "from 0 to 999"));
  CHECK(contains(filter_told(R"(<param key="colour" value="1"/>)", other), "rgbRIndex, rgbGIndex"));  // each once
  for (const char* name : {"rgbRIndex", "rgbGIndex", "rgbBIndex", "maxColorValue", "sparse"}) {
    const std::string told =
        filter_told("<param key=\"filepath\" value=\"mesh.obj\"/><param key=\"voxelSize\" value=\"1\"/><param key=\"" +
                        std::string(name) + "\" value=\"1\"/>",
                    other);
    CHECK(contains(told, "warning"));
    CHECK(contains(told, "param '" + std::string(name) + "' has no effect"));
  }
}

TEST_CASE("files may be one, those of a pattern, or a list") {
  ObjSource one, pattern, list, none;
  CHECK(filter_told(R"(<param key="filepath" value="mesh.obj"/>)", one).empty());
  CHECK(filter_told(R"(<param key="filepath" value="nothing"/><param key="efilepath" value="m.*"/>)", pattern).empty());
  CHECK(filter_told(R"(<param key="filepaths" value="mesh.obj|a.xml"/>)", list).empty());
  CHECK(one == pattern);
  CHECK(list.files.size() == 2);
  CHECK(contains(filter_told(R"(<param key="filepaths" value="mesh.obj|b.xml"/>)", none),
                 "filepaths=\"b.xml\" does not exist"));
  CHECK(contains(filter_told("", none), "has no param 'filepath'"));
  CHECK(contains(filter_told(R"(<param key="filepath" value="mesh.obj"/><param key="up" value="x"/>)", none),
                 "up=\"x\" is not known"));
}

TEST_CASE("a raster of heights may be of tiles, and have one of classes") {
  GeoTiffSource raster;
  CHECK(filter_told(R"(<param key="filepath" value="mesh.obj"/><param key="classfile" value="mesh.obj"/>)", raster)
            .empty());
  CHECK(raster.classes.filename() == "mesh.obj");
  CHECK_FALSE(raster.mosaic);
  CHECK(filter_told(R"(<param key="filepath" value="mesh.obj"/><param key="mosaic" value="true"/>)", raster).empty());
  CHECK(raster.mosaic);
  CHECK_FALSE(raster.height_scale);
  CHECK(filter_told(R"(<param key="filepath" value="mesh.obj"/><param key="classcolours" value="true"/>
      <param key="heightScale" value="0.01"/><param key="heightOffset" value="-50"/><param key="noDataValue" value="-9999"/>
      <param key="pixelSize" value="2"/>)",
                    raster)
            .empty());
  CHECK(raster.class_colours);
  CHECK(raster.height_scale == 0.01);
  CHECK(raster.height_offset == -50);
  CHECK(raster.missing == -9999);
  CHECK(raster.pixel_size == 2);
  CHECK(contains(filter_told(R"(<param key="filepath" value="mesh.obj"/><param key="heightScale" value="0"/>)", raster),
                 "from "));
  CHECK(contains(
      filter_told(R"(<param key="filepath" value="mesh.obj"/><param key="classfile" value="no.tif"/>)", raster),
      "does not exist"));
}

TEST_CASE("a mesh file has axes, a unit and a table of materials, of its own unless they are told") {
  MeshSource model;
  CHECK(filter_told(R"(<param key="filepath" value="mesh.obj"/>)", model).empty());
  CHECK(model == MeshSource{.files = model.files});
  CHECK(
      filter_told(R"(<param key="filepath" value="mesh.obj"/><param key="up" value="y"/><param key="unit" value="0.01"/>
      <param key="materials" value="a.xml"/>)",
                  model)
          .empty());
  CHECK(model.up == MeshUp::y);
  CHECK(model.unit == 0.01);
  CHECK(model.materials.filename() == "a.xml");
  CHECK(contains(filter_told(R"(<param key="filepath" value="mesh.obj"/><param key="unit" value="0"/>)", model),
                 "from "));
  CHECK(contains(filter_told(R"(<param key="filepath" value="mesh.obj"/><param key="up" value="x"/>)", model),
                 "up=\"x\" is not known"));
}

TEST_CASE("voxels have a mode, a table and a material") {
  VoxelSource voxels;
  CHECK(
      filter_told(
          R"(<param key="filepath" value="mesh.obj"/><param key="intersectionMode" value="Fixed"/><param key="ladlut" value="mesh.obj"/>
      <param key="matfile" value="mesh.obj"/><param key="matname" value="leaf"/><param key="randomMaterials" value="3"/>)",
          voxels)
          .empty());
  CHECK(voxels.mode == VoxelMode::fixed);
  CHECK(voxels.leaf_angles.filename() == "mesh.obj");
  CHECK(voxels.material.name == "leaf");
  CHECK(voxels.material.random == 3);
  CHECK(voxels.leaf_area == 0);
  CHECK(
      filter_told(
          R"(<param key="filepath" value="mesh.obj"/><param key="leafArea_m2" value="0.004"/><param key="clumping" value="0.7"/>)",
          voxels)
          .empty());
  CHECK(voxels.leaf_area == 0.004);
  CHECK(voxels.clumping == 0.7);
  CHECK(contains(filter_told(R"(<param key="filepath" value="mesh.obj"/><param key="clumping" value="0"/>)", voxels),
                 "from 0.01 to 10"));
  CHECK(contains(filter_told(R"(<param key="filepath" value="mesh.obj"/><param key="ladlut" value="no.txt"/>)", voxels),
                 "does not exist"));
  CHECK(contains(
      filter_told(R"(<param key="filepath" value="mesh.obj"/><param key="intersectionArgument" value="-1"/>)", voxels),
      "from 0 to 100"));
}

// ----------------------------------------------------------------------------------------- motions

TEST_CASE("every type of motion is read") {
  CHECK(from<MotionSettings>(R"(<motion type="identity"/>)") == MotionSettings{});
  CHECK(std::get<TranslationMotion>(from<MotionSettings>(R"(<motion type="translation" vec="1;2;3"/>)").kind).by ==
        Vec3(1, 2, 3));
  const MotionSettings turn = from<MotionSettings>(
      R"(<motion type="rotation" axis="0;0;2" angle="90" center="1;1;1" selfMode="true" autoCRS="1"/>)");
  CHECK(turn == MotionSettings{RotationMotion{Vec3(0, 0, 2), radians(90), Vec3(1), {}}, true, 1});
  CHECK(std::get<RotationMotion>(
            from<MotionSettings>(R"(<motion type="helical" axis="0;0;1" angle="9" glide="0.5"/>)").kind)
            .glide == 0.5);
  CHECK(std::get<ReflectionMotion>(from<MotionSettings>(R"(<motion type="reflection" ortho="0;1;0"/>)").kind) ==
        ReflectionMotion{axis::forward, {}});
  CHECK(std::get<ReflectionMotion>(
            from<MotionSettings>(R"(<motion type="glideplane" ortho="0;1;0" shift="3;0;0"/>)").kind)
            .shift == Vec3(3, 0, 0));
  CHECK(std::get<RotoreflectionMotion>(from<MotionSettings>(R"(<motion type="rotsym" axis="0;1;0" angle="180"/>)").kind)
            .angle == radians(180));
}

TEST_CASE("of a motion, what cannot be is told") {
  CHECK(contains(told<MotionSettings>(R"(<motion type="translation"/>)"), "has no attribute 'vec'"));
  CHECK(contains(told<MotionSettings>(R"(<motion type="rotation" axis="0;0;0" angle="1"/>)"),
                 "too short for a direction"));
  for (const char* turn : {R"(<motion type="rotation" axis="0;0;0" angle="0"/>)",
                           R"(<motion type="helical" axis="0;0;0" angle="0" glide="3"/>)"}) {
    MotionSettings still;
    CHECK(contains(told(turn, still), "warning"));
    CHECK(contains(told(turn, still),
                   "a.xml:1:25: axis is too short for a direction, and angle is 0: the motion does nothing") ==
          contains(turn, "rotation"));
    CHECK(still == MotionSettings{});
  }
  CHECK_FALSE(contains(told<MotionSettings>(R"(<motion type="rotsym" axis="0;0;0" angle="0"/>)"),
                       "warning"));  // mirrored at no plane
  CHECK(
      contains(told<MotionSettings>(R"(<motion type="glideplane" ortho="1;0;0" shift="1;1;0"/>)"), "at right angles"));
  CHECK(contains(told<MotionSettings>(R"(<motion type="rotation" axis="0;0;1" angle="1" glide="1"/>)"),
                 "'glide' of <motion> is not known"));
  CHECK(contains(told<MotionSettings>(R"(<motion type="rotasion" axis="0;0;1"/>)"), "did you mean 'rotation'?"));
  CHECK(contains(told<MotionSettings>(R"(<motion/>)"), "has no attribute 'type'"));
}

TEST_CASE("a sequence that nothing can do is told, with its place") {
  const auto sequence = [](const std::string& motions) {
    MotionSequenceSettings settings;
    return support::xml_told("<dmotion id=\"m\" loop=\"0\">" + motions + "</dmotion>",
                             [&](XmlInput& io) { xml::fields(io, settings); });
  };
  const std::string mirror = R"(<motion type="reflection" ortho="1;0;0"/>)",
                    own = R"(<motion type="rotsym" axis="0;0;1" angle="9" selfMode="1"/>)";
  const std::string turn = R"(<motion type="rotation" axis="0;0;1" angle="9"/>)",
                    own_turn = R"(<motion type="rotation" axis="0;0;1" angle="9" selfMode="1"/>)";
  CHECK(contains(sequence(mirror),
                 "a.xml:1:2: <dmotion id='m'> is not supported: expected an even number of reflections"));
  CHECK(contains(sequence(mirror + own), "an even number"));
  CHECK(sequence(mirror + mirror).empty());
  CHECK(sequence(own + own).empty());
  CHECK(contains(sequence(turn + own_turn), "not both in one sequence"));
  CHECK(sequence(mirror + mirror + own_turn).empty());
  CHECK_FALSE(contains(sequence(R"(<motion type="rotation" axis="0;0;0" angle="1"/>)" + own_turn), "not both"));
}
