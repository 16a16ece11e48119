// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/helios/detail/xml/fields.hpp>

#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "helios/xml_reading.hpp"

using namespace pulsecast;
using namespace pulsecast::helios;
using support::contains;

namespace {

/// What is told of an element.
std::string told(const std::string& text, MountSettings& settings) {
  return support::xml_told(text, [&](XmlInput& io) { xml::fields(io, settings); });
}
std::string told(const std::string& text) {
  MountSettings settings;
  return told(text, settings);
}

/// The settings of an element with which nothing is wrong or odd.
MountSettings from(const std::string& text) {
  MountSettings settings;
  CHECK(told(text, settings).empty());
  return settings;
}

}  // namespace

TEST_CASE("a mount has a position and turns in their order") {
  const MountSettings mount =
      from(R"(<m x="1" y="-2" z="3e2" rotations="local"><rot axis="Z" angle_deg="90"/><rot axis="x" angle_deg="0"/></m>)");
  CHECK(mount.position == Vec3(1, -2, 300));
  CHECK(mount.rotation.local);
  CHECK(mount.rotation.turns == std::vector<AxisTurn>{{Axis::z, radians(90)}, {Axis::x, 0}});
  CHECK(from("<m/>") == MountSettings{});
}

TEST_CASE("a mount takes the place of the one before, as a whole") {
  MountSettings mount{.position = {1, 2, 3}, .rotation = {.turns = {{Axis::x, 1}}, .local = true}};
  CHECK(told(R"(<m z="5"/>)", mount).empty());
  CHECK(mount == MountSettings{.position = {0, 0, 5}});
}

TEST_CASE("of a turn, what cannot be is told") {
  CHECK(contains(told(R"(<m><rot axis="w" angle_deg="9"/></m>)"), "axis=\"w\" is not known"));
  CHECK(contains(told(R"(<m><rot axis="x"/></m>)"), "has no attribute 'angle_deg'"));
  CHECK(contains(told(R"(<m><rot axis="x" angle_deg="1e9"/></m>)"), "from -36000 to 36000 deg"));
  CHECK(contains(told(R"(<m rotations="lokal"/>)"), "did you mean 'local'?"));
  CHECK(contains(told(R"(<m x="1e10"/>)"), "expected a number from"));
}

TEST_CASE("a direction needs a length") {
  Vec3 v = axis::up;
  const auto read = [&](const char* text) { return support::xml_told(text, [&](XmlInput& io) { xml::direction(io, "d", v); }); };
  CHECK(read(R"(<a><d x="1"/></a>)").empty());
  CHECK(v == axis::right);
  CHECK(contains(read(R"(<a><d x="0" y="0.1"/></a>)"), "shorter than 0.1 and has no effect"));
  CHECK(v == axis::right);
}
