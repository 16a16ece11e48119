// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/helios/instrument.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/cloud.hpp>
#include <pulsecast/deflector/rotating_head.hpp>
#include <pulsecast/detector/gaussian_fit.hpp>
#include <pulsecast/helios/document.hpp>
#include <pulsecast/helios/make_simulation.hpp>
#include <pulsecast/helios/scene.hpp>
#include <pulsecast/platform/platform.hpp>
#include <pulsecast/platform/pose_errors.hpp>
#include <pulsecast/platform/straight_line.hpp>
#include <pulsecast/platform/tripod.hpp>
#include <pulsecast/run.hpp>
#include <pulsecast/scanner/any_source.hpp>
#include <pulsecast/scanner/channels.hpp>

#include "support/data_folder.hpp"
#include "support/temporary_folder.hpp"

namespace pulsecast::helios {
namespace {

/// A beam straight ahead, 1000 times a second.
ScannerSettings ahead(const ErrorFormulas& errors = {}) {
  ScannerSettings scanner{.id = "ahead", .pulse_rates = {1000}};
  scanner.channels = {{.optic = RotatingOptic{}, .head_rate_max = radians(360), .errors = errors}};
  return scanner;
}

/// A flight of 100 m along a line, over the ground: half a second.
SurveySettings flight(const ScannerSettings& scanner, const PlatformSettings& platform) {
  SurveySettings survey{.name = scanner.id, .scanner = scanner, .platform = platform};
  LegSettings leg;
  leg.platform.position = {-50, 10, 60};
  leg.platform.speed = 200;
  leg.scanner.pulse_rate = 2000;
  const double fastest = scanner.channels.front().scan_rate_max;
  leg.scanner.scan_rate = fastest > 0 ? std::min(20.0, fastest) : 20;
  leg.scanner.head_rate = radians(90);
  leg.scanner.warm_up = 0.25;
  survey.legs = {leg, leg};
  survey.legs[1].platform.position.x += 100;
  return survey;
}

/// All that sinks get of a survey.
struct Record {
  Cloud cloud;
  std::vector<Shot> shots;
  std::vector<float> samples;

  void operator()(const EchoBatch& batch) {
    cloud(batch);
    shots.insert(shots.end(), batch.shots.begin(), batch.shots.end());
    samples.insert(samples.end(), batch.samples.begin(), batch.samples.end());
  }
};

void require_equal(const Record& a, const Record& b) {
  REQUIRE(a.shots.size() == b.shots.size());
  for (std::size_t i = 0; i < a.shots.size(); ++i) {
    const Shot &x = a.shots[i], &y = b.shots[i];
    REQUIRE(std::pair(x.index, x.tick) == std::pair(y.index, y.tick));
    REQUIRE(std::pair(x.origin, x.direction) == std::pair(y.origin, y.direction));
    REQUIRE(std::pair(x.scan_angle, x.waveform_start) == std::pair(y.scan_angle, y.waveform_start));
    REQUIRE(std::pair(x.leg, x.channel) == std::pair(y.leg, y.channel));
    REQUIRE(x.fate == y.fate);
  }
  REQUIRE(a.cloud.points == b.cloud.points);
  for (std::size_t i = 0; i < a.cloud.size(); ++i) {
    const Echo &x = a.cloud.echoes[i], &y = b.cloud.echoes[i];
    REQUIRE(std::pair(x.range, x.amplitude) == std::pair(y.range, y.amplitude));
    REQUIRE(std::pair(x.reflectance, x.cos_incidence) == std::pair(y.reflectance, y.cos_incidence));
    REQUIRE(std::pair(x.object, x.number) == std::pair(y.object, y.number));
    REQUIRE((x.width == y.width || (std::isnan(x.width) && std::isnan(y.width))));
  }
  REQUIRE(a.samples == b.samples);
}

}  // namespace

TEST_CASE(
    "an instrument on one's own trajectory gives the bytes of an XML survey on an equal one, whatever the scanner") {
  const AssetDocument assets =
      read_assets(support::data_folder / "surveys/assets.xml", {.assets = {support::data_folder}});
  REQUIRE(assets.scanners.size() >= 6);
  const support::TemporaryFolder folder;
  std::ofstream(folder / "ground.obj") << "v -400 -400 0\nv 400 -400 0\nv 400 400 0\nv -400 400 0\nf 1 2 3\nf 1 3 4\n";
  for (const ScannerSettings& scanner : assets.scanners) {
    CAPTURE(scanner.id);
    SurveySettings settings = flight(scanner, assets.platforms.at(1));
    settings.scene.parts.push_back({.id = "3", .source = ObjSource{.files = {folder / "ground.obj"}}});
    write_survey(folder / "survey.xml", settings);
    const SurveySettings survey = read_survey(folder / "survey.xml").survey;
    Record by_xml;
    const auto simulation =
        make_simulation(survey, {.seed = 5, .echo_width = true, .waveform_noise = true, .platform_noise = false});
    run(simulation->survey(), {}, [&](const EchoBatch& batch) { by_xml(batch); });
    CHECK(by_xml.cloud.size() > 100);

    const LegPlatformSettings &from = survey.legs[0].platform, &to = survey.legs[1].platform;
    const StraightLine line{from.position, to.position, from.speed};
    const Mount mount{.lever_arm = survey.platform.mount.position,
                      .boresight = survey.platform.mount.rotation.rotation()};
    const Instrument instrument(survey.scanner, survey.legs[0].scanner, line.duration().seconds(),
                                {.boresight = mount.boresight});
    const SurveyScene scene(SceneBuilder(survey.scene, {}).parts(), {.to = 1});
    Record by_hand;
    run(Survey{Platform{line, mount, instrument}, receivers_of<GaussianFit>(survey.scanner, {.noise = true}), scene, 5},
        {}, [&](const EchoBatch& batch) { by_hand(batch); });
    require_equal(by_xml, by_hand);
  }
}

TEST_CASE("beams leave from where the trajectory and the beam origin are, and the head turns them") {
  ScannerSettings scanner = ahead();
  scanner.channels[0].beam_origin.position = {0, 0, 0.5};
  const Platform still{Tripod{.position = {1, 2, 3}}, Mount{.lever_arm = {0, 0, 1}},
                       Instrument(scanner, {.head_rate = radians(90)}, 2)};
  CHECK(still.size() == 2000);
  CHECK(still.duration().seconds() == 2);
  CHECK(length(still.pulse(0)->origin() - Vec3{1, 2, 4.5}) < 1e-12);
  CHECK(length(still.pulse(0)->direction() - axis::forward) < 1e-12);
  CHECK(length(still.pulse(1000)->direction() + axis::right) < 1e-9);
  CHECK_FALSE(still.pulse(0)->reported.has_value());

  SUBCASE("the origin is along the axes of the body, if the boresight is told") {
    const Rotation down = rotation_about(axis::right, -pi / 2);
    const Platform looks_down{Tripod{}, Mount{.boresight = down}, Instrument(scanner, {}, 1, {.boresight = down})};
    CHECK(length(looks_down.pulse(0)->origin() - Vec3{0, 0, 0.5}) < 1e-12);
    CHECK(length(looks_down.pulse(0)->direction() + axis::up) < 1e-12);
  }
}

TEST_CASE("a scan continues that of an earlier instrument, if its running time is told") {
  ScannerSettings scanner = ahead();
  scanner.channels[0].optic = OscillatingOptic{};
  scanner.channels[0].scan_angle_max = radians(20);
  const LegScannerSettings settings{.scan_rate = 4};
  const Instrument whole(scanner, settings, 1), later(scanner, settings, 0.4, {.optic_time = 0.6});
  for (const PulseIndex i : {PulseIndex{0}, PulseIndex{177}, PulseIndex{399}})
    CHECK(length(later.pulse(i)->direction() - whole.pulse(600 + i)->direction()) < 1e-9);
}

TEST_CASE("errors by formulas are reported by platforms, whatever wraps the instrument") {
  const Instrument exact(ahead(), {}, 1), errs(ahead({.range = "0.5"}), {}, 1);
  const Mount mount{.lever_arm = {0, 0, 1}};
  const Vec3 moved{0, 0.5, 1};
  const auto reported = [&](const auto& source, PulseIndex i) {
    return Platform{Tripod{}, mount, source}.pulse(i)->reported;
  };
  CHECK_FALSE(reported(exact, 3).has_value());
  CHECK(length(reported(errs, 3)->position - moved) < 1e-12);
  CHECK(length(Platform{Tripod{}, mount, errs}.pulse(3)->origin() - Vec3{0, 0, 1}) < 1e-12);

  using Any = AnySource<Instrument, Deflector<FixedBeam, Scanner>>;
  static_assert(MeasuresBeam<Any> && MeasuresBeam<Channels<Any>> && !MeasuresBeam<Deflector<FixedBeam, Scanner>>);
  const auto any = std::make_unique<const Any>(errs),
             other = std::make_unique<const Any>(Deflector{FixedBeam{}, Scanner{}});
  CHECK(length(any->measured(3, {})->position - Vec3{0, 0.5, 0}) < 1e-12);
  CHECK_FALSE(other->measured(3, {}).has_value());
  const Channels both{std::vector{exact, errs}};
  CHECK_FALSE(reported(both, 6).has_value());
  CHECK(length(reported(both, 7)->position - moved) < 1e-12);
  const Deflector turned{RotatingHead{.angular_rate = 0, .start = pi / 2}, errs};
  CHECK(length(reported(turned, 3)->position - Vec3{-0.5, 0, 1}) < 1e-12);
  CHECK_FALSE(reported(Deflector{RotatingHead{}, exact}, 3).has_value());
  const WithPoseErrors with_lever{Platform{Tripod{}, mount, errs}, {.lever_arm_error = {1, 0, 0}}};
  CHECK(length(with_lever.pulse(3)->reported->position - (moved + Vec3{1, 0, 0})) < 1e-12);
}

TEST_CASE("receivers are those of the channels, each once, with the smallest bins of all") {
  ScannerSettings scanner = ahead();
  scanner.channels.resize(4, scanner.channels[0]);
  scanner.channels[2].receiver_diameter = 0.3;
  scanner.channels[3].waveform.bin_size = 0.125e-9;
  const auto receivers = receivers_of(scanner);
  REQUIRE(receivers.size() == 3);
  CHECK(receivers[1].receiver.diameter == 0.3);
  CHECK(receivers[0].footprint.size() == RingFootprint(3).size());
  for (const auto& unit : receivers) CHECK(unit.detector.sample_interval() == 0.125e-9);
  std::vector<std::uint16_t> of_channel;
  for (const Emitter& emitter : Instrument(scanner, {}, 1).emitters()) of_channel.push_back(emitter.receiver);
  CHECK(of_channel == std::vector<std::uint16_t>{0, 0, 1, 2});
}

TEST_CASE("instruments that cannot be are refused with the attribute") {
  CHECK_THROWS_WITH_AS(Instrument({}, {}, 1), doctest::Contains("channels (number)"), SettingError);
  ScannerSettings scanner = ahead();
  CHECK_THROWS_WITH_AS(Instrument(scanner, {}, -1), doctest::Contains("duration"), SettingError);
  CHECK_THROWS_WITH_AS(Instrument(scanner, {}, std::nan("")), doctest::Contains("duration"), SettingError);
  CHECK_THROWS_WITH_AS(Instrument(scanner, {.warm_up = -1}, 1), doctest::Contains("opticsWarmupPhase_s"), SettingError);
  scanner.pulse_rates.clear();
  CHECK_THROWS_WITH_AS(Instrument(scanner, {}, 1), doctest::Contains("pulseFreq_hz"), SettingError);
  CHECK_NOTHROW(Instrument(scanner, {.pulse_rate = 10}, 1));
  scanner.channels[0].scan_rate_max = 50;
  CHECK_THROWS_WITH_AS(Instrument(scanner, {.pulse_rate = 10, .scan_rate = 60}, 1), doctest::Contains("scanFreq_hz"),
                       SettingError);
  CHECK_NOTHROW(Instrument(scanner, {.active = false, .pulse_rate = 10, .scan_rate = 60}, 1));
}

}  // namespace pulsecast::helios
