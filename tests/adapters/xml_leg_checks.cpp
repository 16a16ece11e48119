// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/adapters/xml_leg_checks.hpp>

#include <string>

#include <doctest/doctest.h>

#include "adapters/survey_texts.hpp"

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
  refuses(survey_text(airplane, flies), "a single leg");
  CHECK(faults_of(survey_text(airplane, flies + flies)).empty());
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
  refuses(survey_text("", leg(R"(verticalAngleMin_deg="-60" verticalAngleMax_deg="60")")), "further apart than the scanner's 100 deg");
  refuses(survey_text("", leg(R"(verticalAngleMin_deg="10" verticalAngleMax_deg="10")")), "no pulse could leave");
  refuses(survey_text("", ""), "holds no <leg>");
  refuses(survey_text("", "<leg><scannerSettings/></leg>"), "holds no <platformSettings>");
  refuses(survey_text(R"(platform="interpolated")", leg("")), "'trajectory'");
  CHECK(faults_of(survey_text("", leg(R"(scanFreq_hz="20" headRotatePerSec_deg="20")"))).empty());  // it ends at once
}
