// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/helios/detail/xml/leg.hpp>

#include <string>

#include <doctest/doctest.h>

#include "helios/xml_reading.hpp"

using namespace pulsecast;
using namespace pulsecast::helios;
using support::contains;

namespace {

/// What is told of an element.
std::string told(const std::string& text, LegPlatformSettings& settings) {
  return support::xml_told(text, [&](XmlInput& io) { xml::fields(io, settings); });
}
std::string told(const std::string& text) {
  LegPlatformSettings settings;
  return told(text, settings);
}

/// The settings of an element with which nothing is wrong or odd.
LegPlatformSettings from(const std::string& text) {
  LegPlatformSettings settings;
  CHECK(told(text, settings).empty());
  return settings;
}

std::string scanner_told(const std::string& text, LegScannerSettings& settings) {
  return support::xml_told(text, [&](XmlInput& io) { xml::fields(io, settings); });
}

}  // namespace

TEST_CASE("a leg that says nothing has the defaults of the format") {
  CHECK(from("<platformSettings/>") == LegPlatformSettings{});
  LegScannerSettings scanner;
  CHECK(scanner_told("<scannerSettings/>", scanner).empty());
  CHECK(scanner == LegScannerSettings{});
}

TEST_CASE("any index of a column means that all are agreed") {
  const LegPlatformSettings leg = from(R"(<p trajectory="mesh.obj" tIndex="0"/>)");
  CHECK(leg.trajectory->columns == TrajectoryIndices{});
  CHECK_FALSE(from(R"(<p trajectory="mesh.obj"/>)").trajectory->columns);
  CHECK(from(R"(<p trajectory="mesh.obj" zIndex="9"/>)").trajectory->columns->z == 9);
}

TEST_CASE("of a trajectory, what cannot be is told") {
  CHECK(contains(told(R"(<p trajectory="none.trj"/>)"), "does not exist"));
  CHECK(contains(told(R"(<p trajectory="mesh.obj" tStart="2" tEnd="2"/>)"), "tEnd is not after tStart"));
  for (const char* separator : {";;", "|", ""}) {
    LegPlatformSettings settings;
    const std::string odd = told("<p trajectory=\"mesh.obj\" trajectory_separator=\"" + std::string(separator) + "\"/>", settings);
    CHECK(odd.starts_with("\nwarning "));
    CHECK(contains(odd, "has no effect: expected a comma, a semicolon, a tab or a blank; it is detected"));
    CHECK_FALSE(settings.trajectory->separator);
  }
  CHECK(contains(told(R"(<p trajectory="mesh.obj" tIndex="1000"/>)"), "from 0 to 999"));
  CHECK(contains(told(R"(<p trajectory="mesh.obj" interpolationDomain="positions"/>)"), "did you mean 'position'?"));
}

TEST_CASE("a multicopter that does not stop to turn turns smoothly") {
  CHECK_FALSE(from(R"(<p stopAndTurn="true"/>)").smooth_turn);
  CHECK(from(R"(<p stopAndTurn="false"/>)").smooth_turn);
  CHECK(from(R"(<p stopAndTurn="true" smoothTurn="true"/>)").smooth_turn);
  LegPlatformSettings inherited{.smooth_turn = true};
  CHECK(told(R"(<p smoothTurn="false"/>)", inherited).empty());
  CHECK_FALSE(inherited.smooth_turn);
}

TEST_CASE("what of a leg does nothing is told, and what is as it says is not") {
  CHECK(contains(told(R"(<p slowdownEnabled="false"/>)"), "warning"));
  CHECK(told(R"(<p slowdownEnabled="true"/>)").empty());
  CHECK(contains(told(R"(<p slowdownEnabled="no"/>)"), "is taken as false"));
  CHECK(told(R"(<p trajectory="mesh.obj" teleportToStart="true"/>)").empty());
  CHECK(from(R"(<p trajectory="mesh.obj" teleportToStart="true"/>)").trajectory.value().teleports);
  CHECK(contains(told(R"(<p trajectory="mesh.obj" slopeFilterThreshold="0.1"/>)"), "all samples are kept"));
  CHECK(told(R"(<p trajectory="mesh.obj" slopeFilterThreshold="0"/>)").empty());
}

TEST_CASE("figures of a leg that make no sense are told") {
  LegScannerSettings scanner;
  CHECK(contains(scanner_told(R"(<s pulseFreq_hz="-1"/>)", scanner), "from 0 to 100000000 Hz"));
  CHECK(contains(scanner_told(R"(<s scanAngle_deg="1e9"/>)", scanner), "from 0 to 180 deg"));
  CHECK(contains(scanner_told(R"(<s headRotatePerSec_deg="1e7"/>)", scanner), "deg"));
  CHECK(contains(told(R"(<p movePerSec_m="-1"/>)"), "from 0 to 100000 m/s"));
  CHECK(scanner == LegScannerSettings{});
}
