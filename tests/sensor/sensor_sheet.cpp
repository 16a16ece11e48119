// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/sensor/sensor_sheet.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include "support/laws.hpp"

namespace pulsecast {
namespace {

using namespace literals;

/// Scanner in a plane with a field of view from 100 degrees to the left to 80 degrees to the right.
SensorSheet flat(double rotation_rate) {
  SensorSheet sheet;
  sheet.lasers = {SensorLaser{}};
  sheet.sequence_rate = 7200;
  sheet.rotation_rate = rotation_rate;
  sheet.azimuth_min = -100_deg;
  sheet.azimuth_max = 80_deg;
  return sheet;
}

SensorSheet swept() {
  SensorSheet sheet;
  sheet.lasers = {SensorLaser{}};
  sheet.sequence_rate = 200e3;
  sheet.sweep_rate = 1007;
  sheet.elevation_min = -7_deg;
  sheet.elevation_max = 52_deg;
  return sheet;
}

SensorSheet rosette() {
  SensorSheet sheet;
  sheet.lasers = {SensorLaser{.elevation = -1_deg}, SensorLaser{.elevation = 1_deg, .delay = 1e-6}};
  sheet.sequence_rate = 40e3;
  sheet.prisms = {{.wedge = 18_deg, .rotation_rate = 121.57, .inclined_exit = true},
                  {.wedge = 18_deg, .rotation_rate = -77.73}};
  return sheet;
}

/// Angle from forward to the right [rad].
double azimuth(const Vec3& d) { return std::atan2(d.x, d.y); }

TEST_CASE("a flat scanner turns from behind to the left or right, and is blocked outside of its field") {
  for (const double rate : {20.0, -20.0}) {
    CAPTURE(rate);
    const SensorSource source = flat(rate).source(0.1);  // 360 slots a turn: one a degree
    REQUIRE(source.size() == 720);
    for (PulseIndex i = 0; i < source.size(); ++i) {
      const double right = (static_cast<double>(i % 360) - 180) * (rate > 0 ? 1 : -1);  // [deg]
      const auto pulse = source.pulse(i);
      REQUIRE(pulse.has_value() == (right >= -100 && right <= 80));
      if (!pulse) continue;
      CHECK(std::fabs(azimuth(pulse->direction()) - right * 1_deg) < 1e-12);
      CHECK(std::fabs(pulse->direction().z) < 1e-15);
      CHECK(pulse->tick == Tick::of(i, 7200));
    }
  }
}

TEST_CASE("a mirror on the head sweeps from low to high while the head turns to the right") {
  const SensorSheet sheet = swept();
  const SensorSource source = sheet.source(0.1);
  for (PulseIndex i = 0; i < source.size(); ++i) {
    const auto pulse = source.pulse(i);
    REQUIRE(pulse.has_value());
    const double t = static_cast<double>(i) / 200e3, sweep = t * 1007 - std::floor(t * 1007);
    const double elevation = -7_deg + sweep * 59_deg;
    if (sweep < 1e-9 || sweep > 1 - 1e-9) continue;  // low or high
    const double turn = std::remainder(azimuth(pulse->direction()) - 2 * pi * 10 * t, 2 * pi);
    CHECK(std::fabs(std::asin(pulse->direction().z) - elevation) < 1e-9);
    CHECK(std::fabs(turn) < 1e-9);
  }
}

TEST_CASE("lasers behind prisms are refracted from their own directions, each in its turn") {
  const SensorSheet sheet = rosette();
  const SensorSource source = sheet.source(0.05);
  REQUIRE(source.size() == 4000);
  CHECK(source.emitters()[1].channel == 1);
  for (PulseIndex i = 0; i < source.size(); ++i) {
    const double elevation = i % 2 == 0 ? -1_deg : 1_deg;
    const RisleyPrisms prisms{.prisms = sheet.prisms, .incident = {0, std::cos(elevation), std::sin(elevation)}};
    const auto pulse = source.pulse(i);
    REQUIRE(pulse.has_value());
    CHECK(length(pulse->direction() - *prisms.direction(pulse->tick)) < 1e-12);
  }
}

TEST_CASE("a sheet without prisms, sweeps and limits is a spinning sensor") {
  SensorSheet sheet;
  sheet.lasers = {SensorLaser{.elevation = 3_deg}, SensorLaser{.elevation = -2_deg, .azimuth = 0.1, .height = 0.02}};
  const SensorSource source = sheet.source(0.01);
  const SpinningSource spinning = sheet.SpinningSensor::source(0.01);
  REQUIRE(source.size() == spinning.size());
  for (PulseIndex i = 0; i < source.size(); ++i) {
    CHECK(source.pulse(i)->tick == spinning.pulse(i)->tick);
    CHECK(source.pulse(i)->direction() == spinning.pulse(i)->direction());
    CHECK(source.pulse(i)->origin() == spinning.pulse(i)->origin());
  }
}

TEST_CASE("every kind of sensor keeps the laws of sources, and finds slots by time as its sheet does") {
  for (const SensorSheet& sheet : {flat(10), flat(-25), swept(), rosette()}) {
    const SensorSource source = sheet.source(0.5);
    CHECK(support::source_laws(source) == "");
    for (const double t : {0.0, 0.1, 0.2345, 0.4999})
      CHECK(source.slot_from(Tick::of_seconds(t)) == sheet.slot_from(Tick::of_seconds(t)));
  }
}

TEST_CASE("a member without effect on a kind of sensor is refused by its name") {
  struct Member {
    const char* name;
    void (*set)(SensorSheet&);
    std::string used_by;  // of the kinds below
  };
  const std::vector<Member> members{
      {"SensorSheet::sweep_rate", [](SensorSheet& s) { s.sweep_rate = 5; },
       "view, sweeps, head"},  // makes sweeps of it
      {"SensorSheet::elevation_min", [](SensorSheet& s) { s.elevation_min = -0.1; }, "sweeps"},
      {"SensorSheet::elevation_max", [](SensorSheet& s) { s.elevation_max = 0.9; }, "sweeps"},
      {"SensorSheet::azimuth_min", [](SensorSheet& s) { s.azimuth_min = -0.1; }, "view, head"},  // makes a view of it
      {"SensorSheet::azimuth_max", [](SensorSheet& s) { s.azimuth_max = 0.1; }, "view, head"},
      {"SpinningSensor::start", [](SensorSheet& s) { s.start = 0.1; }, "head"},
      {"SpinningSensor::exit_radius", [](SensorSheet& s) { s.exit_radius = 0.1; }, "head"},
      {"SensorLaser::height", [](SensorSheet& s) { s.lasers.back().height = 0.1; }, "head"},
      {"SensorLaser::elevation", [](SensorSheet& s) { s.lasers.back().elevation = 0.1; }, "head, prisms"},
      {"SensorLaser::azimuth", [](SensorSheet& s) { s.lasers.back().azimuth = 0.1; }, "head, prisms"},
      {"SensorLaser::delay", [](SensorSheet& s) { s.lasers.back().delay = 2e-6; }, "head, prisms"}};
  SensorSheet head;
  head.lasers = {SensorLaser{}};
  const std::vector<std::pair<std::string, SensorSheet>> kinds{
      {"view", flat(10)}, {"sweeps", swept()}, {"prisms", rosette()}, {"head", head}};
  for (const auto& named : kinds)
    for (const Member& member : members) {
      const std::string& kind = named.first;
      CAPTURE(kind);
      CAPTURE(member.name);
      SensorSheet changed = named.second;
      member.set(changed);
      if (kind == "view" && std::string(member.name) == "SensorSheet::sweep_rate") {  // sweeps, with limits of azimuth
        CHECK_THROWS_WITH_AS(changed.validate(), doctest::Contains("SensorSheet::azimuth_min"), SettingError);
      } else if (member.used_by.find(kind) != std::string::npos) {
        CHECK_NOTHROW(changed.validate());
      } else {
        CHECK_THROWS_WITH_AS(changed.validate(),
                             doctest::Contains((std::string(member.name) + " has no effect").c_str()), SettingError);
      }
    }
}

TEST_CASE("sheets without meaning are refused") {
  const auto refused = [](SensorSheet sheet, auto change, const char* part) {
    change(sheet);
    CHECK_THROWS_WITH_AS(static_cast<void>(sheet.source(1)), doctest::Contains(part), SettingError);
  };
  refused(
      flat(10), [](SensorSheet& s) { s.lasers.push_back({}); }, "lasers (number with sweeps");
  refused(
      flat(10), [](SensorSheet& s) { s.azimuth_max = -2; }, "SensorSheet::azimuth_max");
  refused(
      flat(10), [](SensorSheet& s) { s.rotation_rate = 0; }, "line_rate");
  refused(
      swept(), [](SensorSheet& s) { s.elevation_max = -1; }, "PolygonMirror::sweep");
  refused(
      swept(), [](SensorSheet& s) { s.sweep_rate = -1; }, "SensorSheet::sweep_rate");
  refused(
      rosette(), [](SensorSheet& s) { s.prisms[0].wedge = 2; }, "Prism::wedge");
  refused(
      rosette(), [](SensorSheet& s) { s.lasers[0].delay = 1e-5; }, "Channels::channels");
  refused(
      rosette(), [](SensorSheet& s) { s.prisms[0].wedge = s.prisms[1].wedge = 80_deg; },
      "Prism::wedge reflects all beams: expected a smaller one");
  CHECK_THROWS_AS(static_cast<void>(flat(10).source(-1)), SettingError);
}

}  // namespace
}  // namespace pulsecast
