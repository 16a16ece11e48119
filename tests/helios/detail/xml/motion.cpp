// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/helios/detail/xml/motion.hpp>

#include <string>
#include <variant>

#include <doctest/doctest.h>

#include "helios/xml_reading.hpp"

using namespace pulsecast;
using namespace pulsecast::helios;
using support::contains;

namespace {

/// What is told of an element.
std::string told(const std::string& text, MotionSettings& settings) {
  return support::xml_told(text, [&](XmlInput& io) { xml::fields(io, settings); });
}
std::string told(const std::string& text) {
  MotionSettings settings;
  return told(text, settings);
}

/// The settings of an element with which nothing is wrong or odd.
MotionSettings from(const std::string& text) {
  MotionSettings settings;
  CHECK(told(text, settings).empty());
  return settings;
}

}  // namespace

TEST_CASE("every type of motion is read") {
  CHECK(from(R"(<motion type="identity"/>)") == MotionSettings{});
  CHECK(std::get<TranslationMotion>(from(R"(<motion type="translation" vec="1;2;3"/>)").kind).by == Vec3(1, 2, 3));
  const MotionSettings turn = from(R"(<motion type="rotation" axis="0;0;2" angle="90" center="1;1;1" selfMode="true" autoCRS="1"/>)");
  CHECK(turn == MotionSettings{RotationMotion{Vec3(0, 0, 2), radians(90), Vec3(1), {}}, true, 1});
  CHECK(std::get<RotationMotion>(from(R"(<motion type="helical" axis="0;0;1" angle="9" glide="0.5"/>)").kind).glide == 0.5);
  CHECK(std::get<ReflectionMotion>(from(R"(<motion type="reflection" ortho="0;1;0"/>)").kind) == ReflectionMotion{axis::forward, {}});
  CHECK(std::get<ReflectionMotion>(from(R"(<motion type="glideplane" ortho="0;1;0" shift="3;0;0"/>)").kind).shift == Vec3(3, 0, 0));
  CHECK(std::get<RotoreflectionMotion>(from(R"(<motion type="rotsym" axis="0;1;0" angle="180"/>)").kind).angle == radians(180));
}

TEST_CASE("of a motion, what cannot be is told") {
  CHECK(contains(told(R"(<motion type="translation"/>)"), "has no attribute 'vec'"));
  CHECK(contains(told(R"(<motion type="rotation" axis="0;0;0" angle="1"/>)"), "too short for a direction"));
  for (const char* turn :
       {R"(<motion type="rotation" axis="0;0;0" angle="0"/>)", R"(<motion type="helical" axis="0;0;0" angle="0" glide="3"/>)"}) {
    MotionSettings still;
    CHECK(contains(told(turn, still), "warning"));
    CHECK(contains(told(turn, still), "a.xml:1:25: axis is too short for a direction, and angle is 0: the motion does nothing") ==
          contains(turn, "rotation"));
    CHECK(still == MotionSettings{});
  }
  CHECK_FALSE(contains(told(R"(<motion type="rotsym" axis="0;0;0" angle="0"/>)"), "warning"));  // mirrored at no plane
  CHECK(contains(told(R"(<motion type="glideplane" ortho="1;0;0" shift="1;1;0"/>)"), "at right angles"));
  CHECK(contains(told(R"(<motion type="rotation" axis="0;0;1" angle="1" glide="1"/>)"), "'glide' of <motion> is not known"));
  CHECK(contains(told(R"(<motion type="rotasion" axis="0;0;1"/>)"), "did you mean 'rotation'?"));
  CHECK(contains(told(R"(<motion/>)"), "has no attribute 'type'"));
}

TEST_CASE("a sequence that nothing can do is told, with its place") {
  const auto sequence = [](const std::string& motions) {
    MotionSequenceSettings settings;
    return support::xml_told("<dmotion id=\"m\" loop=\"0\">" + motions + "</dmotion>", [&](XmlInput& io) { xml::fields(io, settings); });
  };
  const std::string mirror = R"(<motion type="reflection" ortho="1;0;0"/>)",
                    own = R"(<motion type="rotsym" axis="0;0;1" angle="9" selfMode="1"/>)";
  const std::string turn = R"(<motion type="rotation" axis="0;0;1" angle="9"/>)",
                    own_turn = R"(<motion type="rotation" axis="0;0;1" angle="9" selfMode="1"/>)";
  CHECK(contains(sequence(mirror), "a.xml:1:2: <dmotion id='m'> is not supported: expected an even number of reflections"));
  CHECK(contains(sequence(mirror + own), "an even number"));
  CHECK(sequence(mirror + mirror).empty());
  CHECK(sequence(own + own).empty());
  CHECK(contains(sequence(turn + own_turn), "not both in one sequence"));
  CHECK(sequence(mirror + mirror + own_turn).empty());
  CHECK_FALSE(contains(sequence(R"(<motion type="rotation" axis="0;0;0" angle="1"/>)" + own_turn), "not both"));
}
