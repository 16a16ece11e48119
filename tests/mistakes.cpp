// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
//
// Mistakes of unit, which a compiler cannot see: the first message says what to do. tests/compile_fail/mistakes.cpp has
// those that it sees.
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <pulsecast/base/rotation_list.hpp>
#include <pulsecast/deflector/deflector.hpp>
#include <pulsecast/deflector/fiber_array.hpp>
#include <pulsecast/deflector/oscillating_mirror.hpp>
#include <pulsecast/deflector/palmer_mirror.hpp>
#include <pulsecast/deflector/pattern_table.hpp>
#include <pulsecast/deflector/polygon_mirror.hpp>
#include <pulsecast/deflector/risley_prisms.hpp>
#include <pulsecast/deflector/rotating_head.hpp>
#include <pulsecast/platform/block_flight.hpp>
#include <pulsecast/platform/multicopter.hpp>
#include <pulsecast/platform/platform.hpp>
#include <pulsecast/platform/pose_errors.hpp>
#include <pulsecast/platform/tripod.hpp>
#include <pulsecast/scanner/scanner.hpp>

#include <doctest/doctest.h>

using namespace pulsecast;
using namespace pulsecast::literals;

namespace {

/// Message of a `SettingError`; empty if there is none.
std::string refusal(const std::function<void()>& make) {
  try {
    make();
  } catch (const SettingError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("a period in place of a pulse rate is refused when a stage is made") {
  CHECK(refusal([] {
          Deflector{PolygonMirror{}, Scanner{.pulse_rate = 10_us}};
        }) == "Scanner::pulse_rate is 1e-05 Hz, but must be from 0.001 to 1e+12: a period?");
  CHECK(refusal([] { Deflector{PolygonMirror{}, Scanner{.pulse_rate = 1_Hz}}; }) == "");
  CHECK(refusal([] {
          Deflector{PolygonMirror{}, Scanner{.pulse_rate = 0}};
        }) == "Scanner::pulse_rate is 0 Hz, but must be from 0.001 to 1e+12");
  CHECK(refusal([] { Deflector{PolygonMirror{.line_rate = 1 / 60.0}, Scanner{}}; }) == "");
}

TEST_CASE("degrees in place of radians are refused when a stage is made") {
  const Deflector device{PolygonMirror{}, Scanner{}};
  CHECK(refusal([&] {
          Platform{Tripod{.heading = 90}, Mount{}, device};
        }) == "Tripod::heading is 90 rad, but must be from -2 pi to 2 pi: given in degrees?");
  CHECK(refusal([&] {
          Platform{Tripod{.heading = std::numeric_limits<double>::infinity()}, Mount{}, device};
        }) == "Tripod::heading is inf rad, but must be from -2 pi to 2 pi");
  CHECK(refusal([] {
          Deflector{OscillatingMirror{.half_angle = 20}, Scanner{}};
        }) == "OscillatingMirror::half_angle is 20 rad, but must be from 0 to 3.141592653589793: given in degrees?");
}

TEST_CASE("all angles of the core are asked for degrees beyond a turn") {
  const double turn = 360_deg;
  struct Case {
    const char* name;
    std::function<void(double)> make;
    double most;  // of the angles that are allowed [rad]
  };
  const std::vector<Case> cases{
      {"Tripod::heading", [](double a) { Tripod{.heading = a}.validate(); }, turn},
      {"RotatingHead::start", [](double a) { RotatingHead{.start = a}.validate(); }, turn},
      {"AxisAngle::angle",
       [](double a) {
         (void)extrinsic({{axis::up, a}});
       },
       turn},
      {"AxisAngle::angle",
       [](double a) {
         (void)intrinsic({{axis::up, a}});
       },
       turn},
      {"BlockFlight::heading",
       [](double a) {
         BlockFlight{.area = {{0, 0, 0}, {1, 1, 1}}, .heading = a}.validate();
       },
       turn},
      {"MulticopterSettings::departure_heading",
       [](double a) { MulticopterSettings{.departure_heading = a}.validate(); }, turn},
      {"MulticopterSettings::arrival_heading", [](double a) { MulticopterSettings{.arrival_heading = a}.validate(); },
       turn},
      {"MulticopterSettings::bank_max", [](double a) { MulticopterSettings{.bank_max = a}.validate(); }, 1.5},
      {"PoseErrors::attitude_noise", [](double a) { PoseErrors{.attitude_noise = a}.validate(); }, turn},
      {"PoseErrors::attitude_drift", [](double a) { PoseErrors{.attitude_drift = a}.validate(); }, turn},
      {"PoseErrors::angular_jitter", [](double a) { PoseErrors{.angular_jitter = a}.validate(); }, turn},
      {"BeamAngles::azimuth", [](double a) { PatternTable{.entries = {{.azimuth = a}}}.validate(); }, turn},
      {"BeamAngles::elevation", [](double a) { PatternTable{.entries = {{.elevation = a}}}.validate(); }, 90_deg},
      {"Prism::start", [](double a) { RisleyPrisms{.prisms = {{.start = a}}}.validate(); }, turn},
      {"Prism::wedge", [](double a) { RisleyPrisms{.prisms = {{.wedge = a}}}.validate(); }, 1.5},
      {"OscillatingMirror::half_angle", [](double a) { OscillatingMirror{.half_angle = a}.validate(); }, 180_deg},
      {"PalmerMirror::half_angle", [](double a) { PalmerMirror{.half_angle = a}.validate(); }, 90_deg},
      {"FiberArray::half_angle", [](double a) { FiberArray{.half_angle = a}.validate(); }, 180_deg},
      {"PolygonMirror::sweep", [](double a) { PolygonMirror{.sweep = a}.validate(); }, 180_deg},
      {"Laser::divergence", [](double a) { Laser{.divergence = a}.validate(); }, 30_deg},
  };
  for (const Case& of : cases) {
    CAPTURE(of.name);
    const std::string in_degrees = refusal([&] { of.make(20); });
    CHECK(in_degrees.starts_with(std::string(of.name) + " is 20 rad, but must be from "));
    CHECK(in_degrees.ends_with(": given in degrees?"));
    CHECK(refusal([&] { of.make(of.most); }) == "");
    const std::string beyond = refusal([&] { of.make(of.most + 1e-3); });
    CHECK(beyond != "");
    CHECK(beyond.ends_with("given in degrees?") == (of.most == turn));
  }
}
