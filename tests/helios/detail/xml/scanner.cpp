// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/helios/detail/xml/scanner.hpp>

#include <string>
#include <variant>
#include <vector>

#include <doctest/doctest.h>

#include "helios/xml_reading.hpp"

using namespace pulsecast;
using namespace pulsecast::helios;
using support::contains;

namespace {

/// What is told of an element.
std::string told(const std::string& text, ScannerSettings& settings) {
  return support::xml_told(text, [&](XmlInput& io) { xml::fields(io, settings); });
}
std::string told(const std::string& text) {
  ScannerSettings settings;
  return told(text, settings);
}

/// The settings of an element with which nothing is wrong or odd.
ScannerSettings from(const std::string& text) {
  ScannerSettings settings;
  CHECK(told(text, settings).empty());
  return settings;
}

std::string scanner(const std::string& attributes, const std::string& inside = "") {
  return "<scanner id=\"s\" pulseFreqs_Hz=\"1000\" " + attributes + ">" + inside + "</scanner>";
}

}  // namespace

TEST_CASE("a scanner that says nothing has the defaults of the format") {
  const ScannerSettings settings = from(scanner("optics=\"oscillating\""));
  REQUIRE(settings.channels.size() == 1);
  CHECK(settings.channels[0] == ChannelSettings{});
  CHECK(settings.pulse_rates == std::vector<double>{1000});
}

TEST_CASE("of a scanner, what cannot be is told") {
  const auto fault = [](const std::string& attributes, const std::string& inside = "") { return told(scanner(attributes, inside)); };
  CHECK(contains(fault("optics=\"rotatin\""), "did you mean 'rotating'?"));
  CHECK(contains(fault(""), "has no attribute 'optics'"));
  CHECK(contains(fault("optics=\"line\" rangeMin_m=\"5\" rangeMax_m=\"5\""), "rangeMax_m is not beyond rangeMin_m"));
  CHECK(contains(fault("optics=\"line\" scanFreqMin_Hz=\"5\" scanFreqMax_Hz=\"4\""), "scanFreqMax_Hz is below"));
  CHECK(contains(fault("optics=\"line\"", "<headError expr=\"0\"/>"), "warning"));
  CHECK(from(scanner("optics=\"rotating\"", "<headError expr=\"1\"/>")).channels.at(0).errors.head == "1");
  CHECK(contains(fault("optics=\"line\"", "<rangeError expr=\"\"/>"), "warning"));
  for (const char* never : {"1/0", "0/0", "ln(-1)", "sqrt(-1-THETA^2)", "1/(THETA-THETA)"}) {
    const std::string told = fault("optics=\"line\"", "\n<rangeError expr=\"" + std::string(never) + "\"/>");
    CHECK(contains(told, "a.xml:2:13: expr=\"" + std::string(never) + "\" is not finite for any THETA: expected a formula"));
  }
  CHECK(fault("optics=\"line\"", "<rangeError expr=\"1/THETA+ln(THETA)\"/>").empty());  // of some angles
  CHECK(contains(fault("optics=\"line\" distanceMeasurementError=\"1/0\""), "for any t: expected a formula"));
  CHECK(contains(fault("optics=\"line\" distanceMeasurementError=\"1/0\""), "a.xml:1:"));
  const std::string part = fault("optics=\"line\" accuracy_m=\"1\" rangeMax_m=\"100\" distanceMeasurementError=\"sqrt(50-t)\"");
  CHECK(contains(part, "a.xml:1:"));
  CHECK(contains(part, "a formula with a finite value from rangeMin_m to rangeMax_m"));
  CHECK(contains(fault("optics=\"line\"", "<rangeError/>"), "has no attribute 'expr'"));
  CHECK(contains(fault("optics=\"line\"", "<rangeError expr=\"2*(THETA\"/>"), "a.xml:1:"));
  CHECK(fault("optics=\"line\"", "<rangeError expr=\"2*(THETA)\"/>").empty());
  CHECK(contains(fault("optics=\"line\" distanceMeasurementError=\"2*THETA\""), "a.xml:1:"));
  CHECK(fault("optics=\"line\" distanceMeasurementError=\"2*t^2\"").empty());
  CHECK(contains(fault("optics=\"rotating\" scanAngleEffectiveMax_deg=\"0\""), "no pulse is emitted"));
  CHECK(contains(fault("optics=\"line\"", "<channels/>"), "warning"));
  CHECK(contains(fault("optics=\"line\" scanProduct=\"5\""), "warning "));
  const auto rates = [](const char* text) { return "<scanner id=\"s\" optics=\"line\" pulseFreqs_Hz=\"" + std::string(text) + "\"/>"; };
  ScannerSettings read;
  CHECK(contains(told(rates("1,,2, "), read), "warning"));
  CHECK(read.pulse_rates == std::vector<double>{1, 2});
  CHECK(contains(told(rates("1,x")), "pulseFreqs_Hz=\"1,x\": expected numbers"));
  CHECK(contains(told(rates(",")), "expected numbers"));
  CHECK(contains(told(rates("")), "is empty: expected a value"));
}

TEST_CASE("a beam quality of 1 says nothing, and another one holds for all channels that say none") {
  CHECK_FALSE(from(scanner("optics=\"line\" beamQualityFactor=\"1\"")).channels.at(0).beam_quality);
  const ScannerSettings settings =
      from(scanner("optics=\"line\" beamQualityFactor=\"2.5\"", "<channels><channel/><channel beamQualityFactor=\"1.0\"/></channels>"));
  CHECK(settings.channels.at(0).beam_quality == 2.5);
  CHECK_FALSE(settings.channels.at(1).beam_quality);
}

TEST_CASE("a channel with other optics than its scanner begins anew") {
  const ScannerSettings settings =
      from(scanner("optics=\"risley\" angle1_deg=\"5\"", "<channels><channel optics=\"line\"/><channel/></channels>"));
  CHECK(settings.channels.at(0).optic == OpticSettings(LineOptic{}));
  CHECK(std::get<RisleyOptic>(settings.channels.at(1).optic).prisms[0].angle == radians(5));
  CHECK(settings.channels[0].id == "0");
  CHECK(settings.channels[1].id == "1");
}
