// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/helios/detail/optics.hpp>

#include <cmath>
#include <variant>

#include <doctest/doctest.h>

#include <pulsecast/scanner/beam.hpp>

#include "support/relative.hpp"

namespace pulsecast::helios {
namespace {

using support::relative;

constexpr double rate = 20e3;

/// Where the beam of a slot goes, as an angle above forward [deg].
double angle_deg(const SurveyOptic& optic, PulseIndex slot) {
  const Vec3 d = optic.at(Tick::of(slot, rate)).direction(axis::forward);
  return degrees(std::atan2(d.z, d.y));
}

ChannelSettings channel(OpticSettings optic, double scan_angle_max_deg) {
  return {.optic = optic, .scan_angle_max = radians(scan_angle_max_deg), .head_rate_max = radians(360)};
}

TEST_CASE("a polygon mirror sweeps all its facet, begins in the middle of it, and measures where it may") {
  const ChannelSettings c = channel(RotatingOptic{.effective_angle_max = radians(50)}, 120);
  const SurveyOptic optic = survey_optic(c, {.scan_rate = 20, .scan_angle = radians(40)}, rate);
  CHECK(std::fabs(angle_deg(optic, 0)) < 1e-9);
  CHECK(angle_deg(optic, 100) == relative(24, 1e-9));
  CHECK(angle_deg(optic, 600) == relative(-96, 1e-9));
  CHECK(optic.open(Tick::of(160, rate)));
  CHECK_FALSE(optic.open(Tick::of(170, rate)));
  CHECK_FALSE(optic.open(Tick::of(600, rate)));

  const SurveyOptic limited =
      survey_optic(c, {.scan_rate = 20, .vertical_angle_min = radians(-10), .vertical_angle_max = radians(50)}, rate);
  CHECK(limited.open(Tick::of(200, rate)));
  CHECK_FALSE(limited.open(Tick::of(950, rate)));
}

TEST_CASE("an optic that stands still leaves the beam where it is: sensors whose head spins") {
  const SurveyOptic optic = survey_optic(channel(RotatingOptic{}, 180), {.scan_rate = 0, .head_rate = 1}, rate);
  CHECK(std::holds_alternative<FixedBeam>(optic.optic));
  const Vec3 later = optic.at(Tick::of_seconds(pi / 2)).direction(axis::forward);
  CHECK(length(later + axis::right) < 1e-12);  // a quarter of a turn to the left
}

TEST_CASE("an oscillating mirror makes cycles of whole pulses, from its lower end") {
  const ChannelSettings c = channel(OscillatingOptic{}, 30);
  const SurveyOptic optic = survey_optic(c, {.scan_rate = 20.3, .scan_angle = radians(20)}, rate);
  const auto& mirror = std::get<OscillatingMirror>(optic.optic);
  CHECK(mirror.cycle_rate == relative(rate / 985, 1e-9));
  const auto made = [&](double product_max_deg, double pulse_rate) {
    const ChannelSettings limited = channel(OscillatingOptic{.scan_product_max = radians(product_max_deg)}, 30);
    return std::get<OscillatingMirror>(
        survey_optic(limited, {.scan_rate = 20, .scan_angle = radians(20)}, pulse_rate).optic);
  };
  CHECK(made(310, 15e3).cycle_rate == relative(15e3 / 967, 1e-9));
  CHECK(made(1000, 15e3).turning_time == relative(100 / 15e3, 1e-9));
  CHECK(made(1000, 100).turning_time == relative(0.5 / 20, 1e-9));
  CHECK(angle_deg(optic, 0) == relative(-20, 1e-9));
  CHECK(angle_deg(optic, 985) == relative(-20, 1e-9));
  SUBCASE("it does not swing farther than it can") {
    const SurveyOptic wide = survey_optic(c, {.scan_rate = 20, .scan_angle = radians(80)}, rate);
    CHECK(std::get<OscillatingMirror>(wide.optic).half_angle == relative(radians(30), 1e-9));
  }
  SUBCASE("it must swing") { CHECK_THROWS_AS((void)survey_optic(c, {.scan_rate = 0}, rate), SettingError); }
}

TEST_CASE("rates and gates that a device rounds or cuts get a note, in any channel") {
  const auto notes = [](const OpticSettings& optic, const LegScannerSettings& leg, double pulse_rate) {
    ScannerSettings scanner;
    scanner.channels = {channel(optic, 50)};
    return detail::limit_notes(scanner, 0, leg, pulse_rate);
  };
  const auto swings = [&](double f, double pulse_rate) {
    return notes(OscillatingOptic{}, {.scan_rate = f}, pulse_rate);
  };
  CHECK(swings(50, 100e3).empty());
  CHECK(swings(100, 33e3).empty());
  REQUIRE(swings(400, 1000).size() == 1);
  CHECK(swings(400, 1000)[0].find(
            "scanFreq_hz of 400 is taken as 500, for a cycle is a whole number of pulses, here 2") !=
        std::string::npos);
  CHECK(swings(70, 33e3)[0].find("is taken as 70.064") != std::string::npos);
  CHECK(swings(3e3, 10e3)[0].find("is taken as 3333.333") != std::string::npos);
  const OscillatingOptic heavy{.scan_product_max = radians(500)};
  CHECK(notes(heavy, {.scan_rate = 20}, 1000)[0].find("is taken as 10, for the scanner's scanProduct") !=
        std::string::npos);

  const auto gate = [&](double low, double high) {
    return notes(RotatingOptic{},
                 {.scan_rate = 10, .vertical_angle_min = radians(low), .vertical_angle_max = radians(high)}, 1000);
  };
  CHECK(gate(-50, 50).empty());
  CHECK(gate(-10, 20).empty());
  REQUIRE(gate(-40, 60).size() == 1);
  CHECK(gate(-40, 60)[0].find("beyond the mirror's sweep, -50 to 50 deg: pulses leave from -40 to 50 deg") !=
        std::string::npos);
  CHECK(gate(-70, 0)[0].find("from -50 to 0 deg") != std::string::npos);
  CHECK(gate(-90, 90).empty());  // the document tells of a gate that is too wide

  ScannerSettings two;
  two.channels = {channel(RotatingOptic{}, 120), channel(RotatingOptic{}, 30)};
  two.channels[1].head_rate_max = radians(10);
  const std::vector<std::string> second = detail::limit_notes(
      two, 1,
      {.scan_rate = 10, .scan_angle = radians(40), .vertical_angle_min = -1, .vertical_angle_max = 1, .head_rate = 1},
      1000);
  REQUIRE(second.size() == 3);
  CHECK(second[0] == "channel 1: verticalAngleMin_deg and verticalAngleMax_deg are limited to -30 to 30 deg");
  CHECK(second[1] == "channel 1: scanAngle_deg is limited to 30");
  CHECK(second[2] == "channel 1: headRotatePerSec_deg is limited to 10, unlike that of the first channel");
}

TEST_CASE("fibres stand at the lower ends of equal shares of the scan angle") {
  const SurveyOptic optic =
      survey_optic(channel(LineOptic{.fibers = 64}, 20), {.scan_rate = 10, .scan_angle = radians(15)}, rate);
  for (const PulseIndex i : {0U, 1U, 31U, 63U, 64U, 1000U})
    CHECK(angle_deg(optic, i) == relative(-15 + 30.0 * static_cast<double>(i % 64) / 64, 1e-9));
  const SurveyOptic one = survey_optic(channel(LineOptic{}, 20), {.scan_rate = 10}, rate);
  CHECK(std::fabs(angle_deg(one, 3)) < 1e-9);
}

TEST_CASE("a Palmer mirror turns as often as the leg asks for, on from where the leg before left it") {
  const SurveyOptic optic =
      survey_optic(channel(ConicOptic{}, 20), {.scan_rate = 10, .scan_angle = radians(15)}, rate, no_rotation, 0.025);
  const Vec3 d = optic.at({}).direction(axis::forward);  // a quarter of a turn on
  CHECK(d.x == relative(std::sin(radians(15)), 1e-9));
  CHECK(std::fabs(d.z) < 1e-9);
}

TEST_CASE("prisms without a wedge are not there, and those with a negative one are inclined where light leaves") {
  RisleyOptic risley;
  risley.prisms[0] = {radians(-18), -121, 1.51};
  risley.prisms[2] = {radians(17), 77, 1.51};
  const SurveyOptic optic = survey_optic(channel(risley, 0), {}, rate);
  const auto& prisms = std::get<RisleyPrisms>(optic.optic).prisms;
  REQUIRE(prisms.size() == 2);
  CHECK(prisms[0].inclined_exit);
  CHECK_FALSE(prisms[1].inclined_exit);
  CHECK(prisms[1].rotation_rate == 77);
}

TEST_CASE("scan frequencies that the device cannot are refused, but for legs that do not scan") {
  ChannelSettings c = channel(RotatingOptic{}, 60);
  c.scan_rate_min = 5;
  c.scan_rate_max = 100;
  CHECK_THROWS_AS((void)survey_optic(c, {.scan_rate = 4}, rate), SettingError);
  CHECK_THROWS_AS((void)survey_optic(c, {.scan_rate = 101}, rate), SettingError);
  CHECK_NOTHROW((void)survey_optic(c, {.active = false, .scan_rate = 0}, rate));
}

TEST_CASE("vertical angles that are wider apart than the device's are limited to as much, about their middle") {
  ChannelSettings c = channel(RotatingOptic{.effective_angle_max = radians(50)}, 60);
  const auto gate = [&](double low, double high) {
    LegScannerSettings leg{.scan_rate = 10, .vertical_angle_min = radians(low)};
    if (high < 1000) leg.vertical_angle_max = radians(high);
    const auto mirror = std::get<PolygonMirror>(survey_optic(c, leg, rate).optic);
    return std::pair(degrees(mirror.angle_min), degrees(mirror.angle_max));
  };
  const auto check = [&](std::pair<double, double> found, double low, double high) {
    CHECK(found.first == relative(low, 1e-9));
    CHECK(found.second == relative(high, 1e-9));
  };
  check(gate(-40, 60), -40, 60);
  check(gate(-100, 100), -50, 50);
  check(gate(-40, 61), -40, 60);  // 61 is beyond what the mirror sweeps
  check(gate(-59, 55), -52, 48);
  check(gate(-360, 1000), -55, 45);  // the upper end is the device's
}

TEST_CASE("formulas of errors that are no number at angles of the leg are refused") {
  ChannelSettings c = channel(RotatingOptic{}, 60);
  const LegScannerSettings all{.scan_rate = 10}, above{.scan_rate = 10, .vertical_angle_min = radians(1)};
  for (std::string* formula : {&c.errors.deflection, &c.errors.head, &c.errors.range}) {
    *formula = "0.001*ln(THETA)";
    CHECK_THROWS_WITH_AS((void)survey_optic(c, all, rate), doctest::Contains("also for a THETA of -1.0"), SettingError);
    CHECK_NOTHROW((void)survey_optic(c, above, rate));
    *formula = "1/THETA";  // but for 0
    CHECK_NOTHROW((void)survey_optic(c, all, rate));
    formula->clear();
  }
  c.errors.range = "1/0";
  CHECK_THROWS_WITH_AS((void)survey_optic(c, all, rate), doctest::Contains("rangeError"), SettingError);
  c.optic = LineOptic{};
  CHECK_THROWS_AS((void)survey_optic(c, all, rate), SettingError);
}

TEST_CASE("the beam's origin keeps to the axes of the platform, and turns with the head") {
  ChannelSettings c = channel(RotatingOptic{}, 60);
  c.beam_origin.position = {1, 0, 0.2};
  const Rotation down = rotation_about(axis::right, -pi / 2);
  const SurveyOptic optic = survey_optic(c, {.scan_rate = 10}, rate, down);
  CHECK(length(down * optic.at({}).position - Vec3{1, 0, 0.2}) < 1e-12);
  const SurveyOptic turned = survey_optic(c, {.scan_rate = 10, .head_start = pi / 2}, rate);
  CHECK(length(turned.at({}).position - Vec3{0, 1, 0.2}) < 1e-12);
}

TEST_CASE("a head that cannot turn does not, and one that is asked for too much does what it can") {
  ChannelSettings c = channel(RotatingOptic{}, 60);
  CHECK(head_rate(c, {.head_rate = radians(-500)}) == relative(radians(-360), 1e-9));
  c.head_rate_max = 0;
  CHECK(head_rate(c, {.head_rate = 1}) == 0);
}

TEST_CASE("what warms up has moved when the first pulse leaves") {
  const ChannelSettings c = channel(RotatingOptic{}, 120);
  const LegScannerSettings leg{.scan_rate = 20, .head_rate = 1, .warm_up = 0.01};
  LegScannerSettings at_once = leg;
  at_once.warm_up = 0;
  const Vec3 a = survey_optic(c, leg, rate).at({}).direction(axis::forward);
  const Vec3 b = survey_optic(c, at_once, rate).at(Tick::of_seconds(0.01)).direction(axis::forward);
  CHECK(length(a - b) < 1e-12);
}

TEST_CASE("mechanical errors move the beam, and not what is reported of it") {
  ChannelSettings c = channel(RotatingOptic{}, 120);
  c.errors.deflection = "0.01 + 0*THETA";
  c.errors.range = "2*THETA";
  const SurveyOptic optic = survey_optic(c, {.scan_rate = 20}, rate);
  CHECK(optic.errs());
  const Tick t = Tick::of(100, rate);
  CHECK(angle_deg(optic, 100) == relative(24 + degrees(0.01), 1e-9));
  CHECK(length(optic.reported(t).direction(axis::forward) - aimed_above(radians(24)).direction(axis::forward)) < 1e-12);
  CHECK(length(optic.reported(t).position) == relative(2 * radians(24), 1e-9));
  c.errors = {};
  c.errors.head = "0.1";
  const SurveyOptic head = survey_optic(c, {.scan_rate = 20}, rate);
  CHECK(length(head.at(t).direction(axis::forward) -
               rotation_about(axis::up, 0.1) * head.reported(t).direction(axis::forward)) < 1e-12);
  c.errors = {.head = "THETA", .head_zero_threshold = 0.2};
  const SurveyOptic kept_off = survey_optic(c, {.scan_rate = 20}, rate);
  for (const PulseIndex slot : {PulseIndex{10}, PulseIndex{100}}) {
    const Vec3 exact = kept_off.reported(Tick::of(slot, rate)).direction(axis::forward);
    const Vec3 turned = rotation_about(axis::up, slot == 10 ? 0.2 : radians(24)) * exact;
    CHECK(length(kept_off.at(Tick::of(slot, rate)).direction(axis::forward) - turned) < 1e-12);
  }
  c.errors = {.deflection = "0.1"};
  c.beam_origin.rotation = {.turns = {{Axis::y, pi / 2}}};  // the mirror lies on its side
  const Vec3 aside = survey_optic(c, {.scan_rate = 20}, rate).at({}).direction(axis::forward);
  CHECK(std::fabs(aside.x) == relative(std::sin(0.1), 1e-9));
  CHECK(std::fabs(aside.z) < 1e-12);
}

TEST_CASE("a beam of known quality has its waist where it leaves; one of unknown quality comes from a point") {
  ChannelSettings c;
  CHECK(survey_laser(c, {}).from_a_point());
  c.beam_quality = 2.5;
  const Laser laser = survey_laser(c, {.divergence = 0.5e-3});
  CHECK(beam_quality(laser) == relative(2.5, 1e-12));
  CHECK(laser.waist_range == 0);
  CHECK(2 * beam_radius(laser, 0).x == relative(4 * 2.5 * 1064e-9 / (pi * 0.5e-3), 1e-12));
}

}  // namespace
}  // namespace pulsecast::helios
