// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/helios/detail/xml/platform.hpp>

#include <string>

#include <doctest/doctest.h>

#include "helios/xml_reading.hpp"

using namespace pulsecast;
using namespace pulsecast::helios;
using support::contains;

namespace {

/// What is told of an element.
std::string told(const std::string& text, PlatformSettings& settings) {
  return support::xml_told(text, [&](XmlInput& io) { xml::fields(io, settings); });
}
std::string told(const std::string& text) {
  PlatformSettings settings;
  return told(text, settings);
}

/// The settings of an element with which nothing is wrong or odd.
PlatformSettings from(const std::string& text) {
  PlatformSettings settings;
  CHECK(told(text, settings).empty());
  return settings;
}

}  // namespace

TEST_CASE("a platform that says nothing has the defaults of the format") {
  CHECK(from("<platform id=\"p\" type=\"MultiCopter\"/>") == PlatformSettings{.id = "p", .kind = PlatformKind::multicopter});
  const PlatformSettings noisy = from("<platform id=\"p\" type=\"static\"><attitudeYNoise stdev=\"0.1\"/></platform>");
  CHECK(noisy.attitude_noise[1] == NoiseSettings{.deviation = 0.1});
  CHECK_FALSE(noisy.attitude_noise[0]);
}

TEST_CASE("of a platform, what cannot be is told") {
  CHECK(contains(told("<platform id=\"p\" type=\"statik\"/>"), "did you mean 'static'?"));
  CHECK(contains(told("<platform id=\"p\" type=\"static\" yaw_speed_deg=\"1\"/>"), "has no effect with this type"));
  for (const char* type : {"static", "multicopter", "groundvehicle"})
    for (const char* name : {"drag", "engine_max_force", "speedup_magnitude", "slowdown_magnitude", "slowdown_distance", "base_pitch_deg",
                             "pitch_speed_deg", "roll_speed_deg", "roll_offset_deg"}) {
      const std::string begin = "<platform id=\"p\" type=\"" + std::string(type) + "\" " + name + "=\"";
      CHECK(contains(told(begin + "1\"/>"), "warning"));
      CHECK(contains(told(begin + "1\"/>"), "'" + std::string(name) + "' has no effect: paths are planned"));
      CHECK(told(begin + "much\"/>") == told(begin + "1\"/>"));
    }
  CHECK(contains(told(R"(<platform id="p" type="static"><attitudeYNoise type="UNIFORM" min="2"/></platform>)"), "max is below min"));
  CHECK(contains(told(R"(<platform id="p" type="static"><attitudeYNoise clipEnabled="1" clipMin="2"/></platform>)"), "clipMax is below"));
  CHECK(contains(told("<platform type=\"static\"/>"), "has no attribute 'id'"));
}
