// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/helios/detail/xml/scene.hpp>

#include <string>

#include <doctest/doctest.h>

#include "helios/xml_reading.hpp"

using namespace pulsecast;
using namespace pulsecast::helios;
using support::contains;

namespace {

/// What is told of an element.
std::string told(const std::string& text, SceneSettings& settings) {
  return support::xml_told(text, [&](XmlInput& io) { xml::fields(io, settings); });
}
std::string told(const std::string& text) {
  SceneSettings settings;
  return told(text, settings);
}

/// The settings of an element with which nothing is wrong or odd.
SceneSettings from(const std::string& text) {
  SceneSettings settings;
  CHECK(told(text, settings).empty());
  return settings;
}

constexpr const char* mesh = R"(<filter type="objloader"><param type="string" key="filepath" value="mesh.obj"/></filter>)";

}  // namespace

TEST_CASE("a scene and a part that say little have the defaults of the format") {
  const SceneSettings scene = from("<scene id=\"s\"><part>" + std::string(mesh) + "</part></scene>");
  CHECK(scene == SceneSettings{.id = "s", .parts = {{.id = "0", .source = scene.parts.at(0).source}}});
  const SceneSettings timed = from("<scene id=\"s\" dynTimeStep=\"0.5\"><part dynTimeStep=\"1\">" + std::string(mesh) + "</part></scene>");
  CHECK(timed.dynamic_interval == 0.5);
  CHECK(timed.parts.at(0).dynamic_interval == 1);
}

TEST_CASE("scale and translate replace, with a warning; rotations add up") {
  const std::string twice = std::string(mesh) + R"(<filter type="scale"><param type="double" key="scale" value="2"/></filter>
    <filter type="rotate"><param type="rotation" key="rotation"><rot axis="z" angle_deg="90"/></param></filter>
    <filter type="scale"><param type="double" key="scale" value="3"/></filter>
    <filter type="rotate"><param type="rotation" key="rotation"><rot axis="x" angle_deg="90"/></param></filter>)";
  SceneSettings scene;
  CHECK(contains(told("<scene id=\"s\"><part>" + twice + "</part></scene>", scene), "a second filter 'scale'"));
  REQUIRE(scene.parts.size() == 1);
  CHECK(scene.parts[0].transform.scale == 3);
  CHECK(scene.parts[0].transform.rotations.size() == 2);
}

TEST_CASE("of a scene, what cannot be is told") {
  const auto fault = [](const std::string& inside) { return told("<scene id=\"s\"><part>" + inside + "</part></scene>"); };
  const std::string loads = mesh;
  CHECK(fault(loads).empty());
  CHECK(contains(fault(loads + loads), "a second loading filter"));
  CHECK(contains(fault("<filter type=\"objlaoder\"/>"), "did you mean 'objloader'?"));
  CHECK(contains(fault("<filter type=\"objloader\"/>"), "has no param 'filepath'"));
  CHECK(contains(fault(""), "holds no <part> with a loading filter"));
  CHECK(contains(fault(loads + "<filter type=\"scale\"/>"), "has no param 'scale'"));
  CHECK(contains(fault(loads + R"(<filter type="scale"><param key="scale" value="-2"/></filter>)"), "scale=\"-2\""));
  CHECK(contains(fault(loads + R"(<filter type="scale"><param key="scale" value="1e-31"/></filter>)"), "the scale is less than 1e-30"));
  CHECK(contains(fault(loads + R"(<dmotion id="a" loop="1" next="b"/>)"), "next=\"b\": there is no such <dmotion>"));
  CHECK(contains(fault(loads + R"(<swap swapStep="0"/>)"), "swapStep=\"0\": expected a whole number"));
  CHECK(contains(fault(loads + R"(<swap keepCRS="false"/>)"), "keepCRS of false has no effect"));
  CHECK(fault(loads + R"(<swap keepCRS="true"/>)").empty());
}

TEST_CASE("a part's number counts parts without geometry") {
  SceneSettings scene;
  CHECK(contains(told("<scene id=\"s\"><part/><part>" + std::string(mesh) + "</part></scene>", scene), "it is left out"));
  REQUIRE(scene.parts.size() == 1);
  CHECK(scene.parts[0].id == "1");
}
