// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/helios/simulation.hpp>

#include <string>
#include <type_traits>
#include <vector>

#include <doctest/doctest.h>

namespace pulsecast::helios {
namespace {

static_assert(std::is_abstract_v<Simulation> && std::has_virtual_destructor_v<Simulation>);
static_assert(!std::is_copy_constructible_v<Simulation> && !std::is_copy_assignable_v<Simulation>);

/// A survey of one leg, on a tripod.
SurveySettings survey() {
  SurveySettings s;
  s.scanner.pulse_rates = {1000};
  s.scanner.channels = {{.optic = RotatingOptic{}, .scan_angle_max = radians(60), .head_rate_max = radians(360)}};
  LegSettings leg;
  leg.scanner.scan_rate = 10;
  leg.scanner.head_rate = leg.scanner.head_stop = radians(90);
  s.legs = {leg};
  return s;
}

TEST_CASE("what can be checked without a scene is") {
  SurveySettings s = survey();
  CHECK(check_without_scene(s).empty());
  SUBCASE("a leg that scans faster than the device can") {
    s.scanner.channels[0].scan_rate_max = 5;
    CHECK_THROWS_WITH_AS((void)check_without_scene(s), doctest::Contains("leg 0: scanFreq_hz"), SettingError);
    CHECK_THROWS_WITH_AS((void)check_without_scene(s, {"a.xml:3:5"}),
                         doctest::Contains("a.xml:3:5: leg 0: scanFreq_hz"), SettingError);
  }
  SUBCASE("a receiver that cannot be") {
    s.scanner.channels[0].receiver_diameter = -1;
    CHECK_THROWS_AS((void)check_without_scene(s), SettingError);
  }
  SUBCASE("bins that cannot be") {
    s.scanner.channels[0].waveform.bin_size = 0;
    CHECK_THROWS_AS((void)check_without_scene(s), SettingError);
  }
  SUBCASE("a leg on the ground, as there may be some") {
    s.legs[0].platform.on_ground = true;
    CHECK(check_without_scene(s).empty());
  }
  SUBCASE("a platform that arrives long before the head has turned") {
    s.platform.kind = PlatformKind::linear_path;
    s.legs.push_back(s.legs[0]);
    s.legs[1].platform.position = {7, 0, 0};
    REQUIRE(check_without_scene(s).size() == 1);
    CHECK(check_without_scene(s)[0].starts_with("leg 0: the platform arrives after 0.1 s"));
  }
}

}  // namespace
}  // namespace pulsecast::helios
