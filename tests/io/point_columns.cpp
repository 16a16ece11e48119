// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/point_columns.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <string_view>

#include <doctest/doctest.h>

#include <pulsecast/base/error.hpp>

namespace pulsecast::io {
namespace {

/// Point of an echo at 10 m of a pulse to the east.
struct OnePoint {
  Shot shot{.index = (std::uint64_t{1} << 60) + 1,
            .tick = {3, 0.25},
            .origin = {1, 2, 3},
            .direction = axis::right,
            .scan_angle = 0.125,
            .leg = 2,
            .channel = 1,
            .echoes = 300};
  Echo echo{.range = 10,
            .amplitude = 2e-9,
            .reflectance = 0.5,
            .width = 1e-9,
            .cos_incidence = 0.75,
            .object = 9,
            .classification = 6,
            .number = 4,
            .kind = ReflectionKind::glass,
            .velocity = -3};
  PointSettings settings{.rings = {5, 11},
                         .start_time = 1000,
                         .lasers = {{}, {.wavelength = 1e-6, .pulse_length = 5e-9}},
                         .power_reference = 2e-8};
  PointSurface surface{
      .interaction = {.material_index = 3, .part = 7}, .normal = {0.25, 0.5, 1}, .velocity = {4, 5, 6}};
  PointColour colour{65535, 257 * 128, 899, 13107};
  Tick scan_start{1, 0.5};

  [[nodiscard]] double at(std::string_view name) const {
    const PointView view{shot, echo, settings, scan_start, {3, -4, 12}, &surface, &colour};
    return find_column(name).get(view);
  }
  [[nodiscard]] double without(std::string_view name) const {
    return find_column(name).get({shot, echo, settings, scan_start});
  }
};

TEST_CASE("each column has its value in its unit") {
  const OnePoint p;
  CHECK((p.at("x") == 3 && p.at("y") == -4 && p.at("z") == 12));
  CHECK((p.at("time") == 1.75 && p.at("clock") == 1003.25));
  CHECK((p.at("range") == 10 && p.at("intensity") == 2e-9 && p.at("reflectance") == 0.5));
  CHECK((p.at("echo_width") == 1e-9 && p.at("cos_incidence") == 0.75 && p.at("radial_velocity") == -3));
  CHECK((p.at("object") == 9 && p.at("classification") == 6 && p.at("leg") == 2 && p.at("kind") == 1));
  CHECK((p.at("return_number") == 4 && p.at("number_of_returns") == 300));
  CHECK((p.at("channel") == 1 && p.at("ring") == 11 && p.at("scan_angle") == 0.125));
  CHECK((p.at("red") == 65535 && p.at("green") == 257 * 128 && p.at("blue") == 899 && p.at("near_infrared") == 13107));
  CHECK(p.at("rgb") == 0xFF8003);  // 899 / 257 is 3.498
  CHECK(std::bit_cast<std::uint32_t>(static_cast<float>(p.at("rgb_bits"))) == 0xFF8003);
  CHECK(p.at("azimuth") == std::atan2(-4, 3));
  CHECK(p.at("elevation") == std::atan2(12, 5));
  CHECK(p.at("reflectivity") == 50);
  CHECK(p.at("photons") == doctest::Approx(2e-9 * 5e-9 * 1e-6 / (6.62607015e-34 * 299792458)));
  CHECK(p.at("intensity_level") == doctest::Approx(-10));
  CHECK(p.at("reflectance_level") == doctest::Approx(-3.0103));
  CHECK((p.at("normal_x") == 0.25 && p.at("normal_y") == 0.5 && p.at("normal_z") == 1));
  CHECK((p.at("velocity_x") == 4 && p.at("velocity_y") == 5 && p.at("velocity_z") == 6));
  CHECK((p.at("part") == 7 && p.at("material") == 3));
}

TEST_CASE("numbers of pulses are whole beyond what a double holds") {
  const OnePoint p;
  REQUIRE((column("pulse")->whole != nullptr));
  CHECK(column("pulse")->whole({p.shot, p.echo, p.settings, p.scan_start}) == (std::uint64_t{1} << 60) + 1);
  CHECK(p.at("pulse") == 0x1p60);
}

TEST_CASE("values that are unknown are NaN, 0 for normals and velocities, and infinite for indices") {
  OnePoint p;
  for (const char* name : {"red", "green", "blue", "near_infrared", "rgb"}) CHECK(std::isnan(p.without(name)));
  CHECK((p.without("rgb_bits") == 0 && p.without("normal_x") == 0 && p.without("velocity_z") == 0));
  CHECK((std::isinf(p.without("part")) && std::isinf(p.without("material"))));
  p.echo.velocity = std::numeric_limits<double>::quiet_NaN();
  p.echo.amplitude = p.echo.reflectance = 0;
  CHECK(std::isnan(p.without("radial_velocity")));
  CHECK((p.without("intensity_level") == -200 && p.without("reflectance_level") == -200));
}

TEST_CASE("names of columns are words of their own, and what a column needs is stated") {
  std::set<std::string_view> names;
  for (const PointColumn& each : point_columns) {
    CAPTURE(each.name);
    CHECK(names.insert(each.name).second);
    CHECK(std::ranges::all_of(each.name, [](char c) { return (c >= 'a' && c <= 'z') || c == '_'; }));
    CHECK_FALSE(each.description.empty());
    CHECK(each.description.size() + each.unit.size() <= 29);  // with blank and brackets, the 32 bytes of LAS
    CHECK(&find_column(each.name) == &each);
    const OnePoint p;  // a column that states no need has its value without
    if (each.needs == PointNeed::nothing) CHECK(p.at(each.name) == p.without(each.name));
  }
  CHECK_THROWS_WITH_AS(static_cast<void>(find_column("rnage")), "column 'rnage' is not known; did you mean 'range'?",
                       SettingError);
}

TEST_CASE("reflectivity is in percent up to white, and grows by 10 a doubling up to its limit") {
  CHECK(reflectivity_byte(-1) == 0);
  CHECK(reflectivity_byte(0.25) == 25);
  CHECK(reflectivity_byte(1) == 100);
  CHECK(reflectivity_byte(4) == 120);
  CHECK(reflectivity_byte(1e30) == 255);
  CHECK(reflectivity_byte(std::numeric_limits<double>::quiet_NaN()) == 0);
}

}  // namespace
}  // namespace pulsecast::io
