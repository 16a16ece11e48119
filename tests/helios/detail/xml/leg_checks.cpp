// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/helios/detail/xml/leg_checks.hpp>

#include <string>

#include <doctest/doctest.h>

#include "helios/survey_texts.hpp"

using namespace pulsecast;
using support::faults_of;
using support::leg;
using support::survey_text;

namespace {

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

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
  refuses(
      survey_text(R"(scanner="surveys/assets.xml#puck")", leg("headRotateStop_deg=\"20\" headRotatePerSec_deg=\"5\" scanFreq_hz=\"5\"")),
      "headRotatePerSecMax_deg is 0");
  CHECK(faults_of(survey_text("", leg(R"(scanFreq_hz="20" headRotateStop_deg="20" maxDuration_s="2")"))).empty());
  CHECK(
      faults_of(
          survey_text(
              "", R"(<leg><platformSettings/><scannerSettings scanFreq_hz="20"><maxDuration_s>2</maxDuration_s></scannerSettings></leg>)"))
          .empty());
  refuses(survey_text("", leg(R"(headRotatePerSec_deg="60" headRotateStop_deg="20" scanFreq_hz="201")")), "scanFreqMax_Hz, 200 Hz");
  refuses(survey_text("", leg(R"(headRotatePerSec_deg="60" headRotateStop_deg="20" scanFreq_hz="0.5")")), "scanFreqMin_Hz, 1 Hz");
  refuses(survey_text("", leg(R"(verticalAngleMin_deg="10" verticalAngleMax_deg="10")")), "no pulse is emitted");
  refuses(survey_text("", ""), "holds no <leg>");
  refuses(survey_text("", "<leg><scannerSettings/></leg>"), "holds no <platformSettings>");
  refuses(survey_text(R"(platform="interpolated")", leg("")), "'trajectory'");
  CHECK(faults_of(survey_text("", leg(R"(scanFreq_hz="20" headRotatePerSec_deg="20")"))).empty());  // it ends at once
}

TEST_CASE("vertical angles that are further apart than the scanner's are limited, with a warning") {
  const auto warnings = [](const char* angles) { return support::read_text(survey_text("", leg(angles))).warnings; };
  const std::vector<std::string> wide = warnings(R"(verticalAngleMin_deg="-60" verticalAngleMax_deg="60")");
  REQUIRE(wide.size() == 1);
  CHECK(contains(wide[0], "survey.xml:4:109: verticalAngleMin_deg and verticalAngleMax_deg are further apart than the scanner's 100 deg"));
  CHECK(contains(wide[0], "they are limited to -50 and 50 deg"));
  CHECK(warnings(R"(verticalAngleMin_deg="-40" verticalAngleMax_deg="60")").empty());
}

TEST_CASE("a platform that moves may stay where it is") {
  const auto told = [](const std::string& legs) {
    const std::string text = survey_text(R"(platform="surveys/assets.xml#quadcopter")", legs);
    std::string all = faults_of(text);
    if (all.empty())
      for (const std::string& warning : support::read_text(text).warnings) all += warning + '\n';
    return all;
  };
  const auto at = [](const std::string& place, const std::string& duration = "") {
    return "<leg " + duration + "><platformSettings " + place + R"(/><scannerSettings scanFreq_hz="20" pulseFreq_hz="20000"/></leg>)";
  };
  const std::string last = R"(<leg><platformSettings x="9"/><scannerSettings active="false"/></leg>)", stay = R"(maxDuration_s="2")";
  CHECK_FALSE(contains(told(at("")), "maxDuration_s=\"2\""));
  CHECK(contains(told(at("")), "as its destination, or maxDuration_s"));
  CHECK_FALSE(contains(told(at("", stay)), "leg"));
  CHECK_FALSE(contains(told(at("", stay) + at("") + last), "leg"));
  CHECK_FALSE(contains(told(at(R"(movePerSec_m="0")", stay) + at("") + last), "leg"));
  CHECK(contains(told(at("") + at("") + last), "ends at once: maxDuration_s"));
  CHECK(contains(told(at("") + at(R"(x="9")", stay)), "to stay there for maxDuration_s, expected another <leg> at the same position"));
}

TEST_CASE("a resolution that the scanner is too slow or too fast for is told as such, with one that it can do") {
  const auto at = [](const char* resolution) {
    return faults_of(
        survey_text("", leg("maxDuration_s=\"1\" pulseFreq_hz=\"20000\" verticalResolution_deg=\"" + std::string(resolution) + "\"")));
  };
  CHECK(contains(at("5"), "verticalResolution_deg of 5 takes 416.666667 lines a second at 20000 Hz: expected at most 2.4"));
  CHECK(contains(at("5"), "for the scanner's scanFreqMax_Hz is 200 Hz"));
  CHECK(contains(at("0.001"), "expected at least"));
  CHECK(at("2.4").empty());
}

TEST_CASE("the last leg of a platform that moves scans nothing, and is not held against the scanner") {
  const std::string airplane = R"(platform="surveys/assets.xml#airplane")";
  const std::string flies = R"(<leg><platformSettings x="9"/><scannerSettings scanFreq_hz="20"/></leg>)";
  for (const char* settings : {R"(<scannerSettings scanFreq_hz="0"/>)", R"(<scannerSettings scanFreq_hz="1e5"/>)", ""}) {
    const std::string ends = "<leg><platformSettings/>" + std::string(settings) + "</leg>";
    CHECK(faults_of(survey_text(airplane, flies + ends)).empty());
    CHECK(contains(faults_of(survey_text(airplane, ends + flies)), "scanFreq_hz"));
  }
}

TEST_CASE("what stands on the ground needs some, and what a platform cannot is told") {
  const std::string grounded = R"(<leg maxDuration_s="1"><platformSettings onGround="true"/><scannerSettings scanFreq_hz="20"/></leg>)";
  CHECK(faults_of(survey_text("", grounded)).empty());
  const std::string scene = R"(<scene id="bare"><part><filter type="xyzloader"><param key="filepath" value="surveys/points.xyz"/>
    <param key="separator" value=","/><param key="voxelSize" value="1"/></filter></part></scene>)";
  const std::string bare = survey_text(R"(scene="#bare")", grounded, scene);
  CHECK(contains(faults_of(bare), "survey.xml:5:42: nothing"));
  CHECK(contains(faults_of(bare), "nothing in the scene is ground: expected a material with helios_isGround"));
  const std::string turns =
      R"(<leg maxDuration_s="1"><platformSettings smoothTurn="true" yawAtDeparture_deg="5"/><scannerSettings scanFreq_hz="20"/></leg>)";
  const auto warnings = support::read_text(survey_text("", turns)).warnings;
  REQUIRE(warnings.size() == 2);
  CHECK(contains(warnings[0], "a smooth turn has no effect with this type of platform"));
  CHECK(contains(warnings[1], "yawAtDeparture_deg has no effect with this type of platform"));
}

TEST_CASE("a document says where each leg stands") {
  const auto document = support::read_text(survey_text("", leg("") + "\n  " + leg("")));
  REQUIRE(document.leg_places.size() == 2);
  CHECK(contains(document.leg_places[0], "survey.xml:4:2"));
  CHECK(contains(document.leg_places[1], "survey.xml:5:4"));
}
