// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/deflector/risley_prisms.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include <pulsecast/base/units.hpp>

#include <doctest/doctest.h>

#include "support/generators.hpp"
#include "support/laws.hpp"
#include "support/relative.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

static_assert(Optic<RisleyPrisms> && Gated<RisleyPrisms> && MovesInLanes<RisleyPrisms>);

namespace {

/// Two wedges, as of a small mapping sensor.
RisleyPrisms two_wedges(double first, double second) {
  return {.prisms = {{.wedge = 18.7481_deg, .rotation_rate = first},
                     {.wedge = 17.9634_deg, .rotation_rate = second, .inclined_exit = true}}};
}

/// Snell's law in a plane: light at an angle below forward meets a face whose normal, along the light, is at an angle
/// below forward.
double behind_face(double light, double normal, double ratio) {
  return normal + std::asin(ratio * std::sin(light - normal));
}

/// Light at an angle below forward, behind a prism that is not turned, or turned half round if its wedge is negative.
double behind_prism(double light, double wedge, bool inclined_exit, double index) {
  const double inside = behind_face(light, inclined_exit ? 0 : wedge, 1 / index);
  return behind_face(inside, inclined_exit ? -wedge : 0, index);
}

double off_forward(const Vec3& d) { return std::atan2(std::hypot(d.x, d.z), d.y); }

/// Unit direction of one refracted ray; empty where `refract` does not return its lane.
std::optional<Vec3> refracted(const Vec3& direction, const Vec3& normal, double ratio) {
  Vec3Lanes light(direction);
  if (detail::refract(light, Vec3Lanes(normal), ratio)[0] == 0) return std::nullopt;
  return light[0];
}

}  // namespace

TEST_CASE("light is refracted by Snell's law, in the plane of light and normal") {
  support::Generator any(1);
  int reflected = 0;
  for (int k = 0; k < 2000; ++k) {
    const Vec3 normal = any.unit();
    Vec3 light = any.unit();
    if (dot(light, normal) > 0) light = -light;
    const double ratio = any.uniform(0.5, 2);
    CAPTURE(k);
    const auto on = refracted(light, normal, ratio);
    const double sine = length(cross(light, normal));
    REQUIRE(on.has_value() == (ratio * sine <= 1));
    if (!on) {
      ++reflected;
      continue;
    }
    CHECK(std::fabs(length(*on) - 1) < 1e-15);
    CHECK(length(cross(*on, normal) - ratio * cross(light, normal)) < 1e-14);
    CHECK(dot(*on, normal) <= 0);
    if (dot(*on, normal) < -0.01)
      CHECK(length(-*refracted(-*on, -normal, 1 / ratio) - light) < 1e-12);  // the way back is the same
  }
  CHECK(reflected > 100);
  CHECK(!refracted(axis::forward, axis::forward, 1));  // from behind the face
}

TEST_CASE("one prism draws a cone whose angle follows from Snell's law in a plane") {
  for (const bool inclined_exit : {false, true}) {
    const RisleyPrisms optic{.prisms = {{.wedge = 18_deg, .rotation_rate = 10, .inclined_exit = inclined_exit}}};
    const double angle = behind_prism(0, 18_deg, inclined_exit, 1.51);
    CHECK(angle > 9_deg);  // about (index - 1) times the wedge
    for (int k = 0; k < 100; ++k) {
      const double turn = 2 * pi * k / 100;  // the beam goes to the thick end: down, then left
      const Vec3 expected{-std::sin(angle) * std::sin(turn), std::cos(angle), -std::sin(angle) * std::cos(turn)};
      CHECK(length(*optic.direction({5, k / 1000.0}) - expected) < 1e-13);
    }
  }
}

TEST_CASE("a prism without a wedge, or of the index around it, changes nothing") {
  const Vec3 light = normalize(Vec3{0.1, 1, -0.2});
  const RisleyPrisms plate{.prisms = {{.wedge = 0}}, .incident = 7.0 * light};
  CHECK(length(*plate.direction({0, 0.3}) - light) < 1e-15);
  const RisleyPrisms in_oil{.prisms = {{.refractive_index = 1.51}}, .surrounding_index = 1.51, .incident = light};
  CHECK(length(*in_oil.direction({0, 0.3}) - light) < 1e-15);
}

TEST_CASE("a rosette closes after the common period of its prisms, and not before") {
  const RisleyPrisms optic = two_wedges(60, -40);  // 20 Hz in common
  double moved = 0;
  for (int k = 0; k < 500; ++k) {
    const Vec3 d = *optic.direction({3, k * 1e-4});
    CHECK(length(*optic.direction(Tick::of_seconds(3.05 + k * 1e-4)) - d) < 1e-11);
    moved = std::max(moved, length(*optic.direction(Tick::of_seconds(3.025 + k * 1e-4)) - d));
  }
  CHECK(moved > 0.1);
}

TEST_CASE("a rosette's field of view reaches from where the prisms cancel to where they add up") {
  const RisleyPrisms optic = two_wedges(-121.5657, 77.7430);
  const double first = behind_prism(0, 18.7481_deg, false, 1.51);
  const double widest = behind_prism(first, 17.9634_deg, true, 1.51),
               narrowest = std::fabs(behind_prism(first, -17.9634_deg, true, 1.51));
  CHECK(widest > 19_deg);
  CHECK(narrowest < 2_deg);
  double low = pi, high = 0;
  for (PulseIndex i = 0; i < 100000; ++i) {
    const double off = off_forward(*optic.direction(Tick::of(i, 100e3)));
    low = std::min(low, off);
    high = std::max(high, off);
  }
  CHECK(high <= widest + 1e-14);
  CHECK(low >= narrowest - 1e-14);
  CHECK(high == support::relative(widest, 1e-5));
  CHECK(std::fabs(low - narrowest) < 1e-3);
}

TEST_CASE("two prisms send two pulses where a peer does") {
  const RisleyPrisms optic = two_wedges(-121.5657, 77.7430);  // recorded from HELIOS++
  CHECK(length(*optic.direction({0, 0.001}) - Vec3{0.035278657564740, 0.960120821637204, -0.277350724136660}) < 1e-12);
  CHECK(length(*optic.direction({0, 0.002}) - Vec3{0.033750194859553, 0.994504135814852, -0.099108265011086}) < 1e-12);
}

TEST_CASE("the pose is the shortest turn to where the light goes") {
  const RisleyPrisms optic = two_wedges(-121.5657, 77.7430);
  for (PulseIndex i = 0; i < 1000; ++i) {
    const Tick t = Tick::of(i, 1234.5);
    CHECK(length(optic.at(t).direction(axis::forward) - *optic.direction(t)) < 1e-15);
    CHECK(optic.at(t).rotation.y == 0);
  }
}

TEST_CASE("a prism that reflects all light inside lets none out") {
  const RisleyPrisms steep{
      .prisms = {{.wedge = 45_deg, .inclined_exit = true}}};  // the glass reflects from asin(1/1.51), 41.5 degrees
  const RisleyPrisms flat{.prisms = {{.wedge = 41_deg, .inclined_exit = true}}};
  for (PulseIndex i = 0; i < 100; ++i) {
    CHECK(!steep.open(Tick::of(i, 1000)));
    CHECK(flat.open(Tick::of(i, 1000)));
  }
  CHECK(support::motion_laws(steep, std::vector<Tick>{{0, 0}, {0, 0.1}}) == "");
}

TEST_CASE("two steep prisms let light out in a part of their turns only") {
  const RisleyPrisms optic{
      .prisms = {{.wedge = 32_deg, .rotation_rate = 7}, {.wedge = 32_deg, .rotation_rate = -5, .inclined_exit = true}}};
  int open = 0;
  for (PulseIndex i = 0; i < 1000; ++i) open += optic.open(Tick::of(i, 1000));
  CHECK(open > 100);
  CHECK(open < 900);
}

TEST_CASE("light that does not come from the front does not get through") {
  CHECK(!RisleyPrisms{.prisms = {{}}, .incident = -axis::forward}.open({}));
  CHECK(!RisleyPrisms{.prisms = {{}}, .incident = axis::up}.open({0, 0.005}));
}

TEST_CASE("a rosette does not wear out with time") {
  const RisleyPrisms optic = two_wedges(-121, 77);
  for (PulseIndex i = 0; i < 5000; i += 7)  // 10^12 pulses are 10^7 s
    CHECK(length(*optic.direction(Tick::of(1000000000000 + i, 100e3)) - *optic.direction(Tick::of(i, 100e3))) < 1e-13);
}

TEST_CASE("Risley prisms keep the laws of a motion") {
  const auto ticks = support::some_ticks(6);
  CHECK(support::motion_laws(two_wedges(-121.5657, 77.7430), ticks) == "");
  RisleyPrisms three = two_wedges(100, -77);
  three.prisms.push_back({.wedge = 5_deg, .rotation_rate = 3.3, .start = 1});
  CHECK(support::motion_laws(three, ticks) == "");
}

TEST_CASE("Risley prisms refuse what cannot be") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_AS(RisleyPrisms{}.validate(), SettingError);
  CHECK_NOTHROW(RisleyPrisms{.prisms = {{}}}.validate());
  for (const double bad : {-0.1, 1.6, nan})
    CHECK_THROWS_AS((RisleyPrisms{.prisms = {{.wedge = bad}}}.validate()), SettingError);
  CHECK_THROWS_AS((RisleyPrisms{.prisms = {{.rotation_rate = nan}}}.validate()), SettingError);
  for (const double bad : {-1.0, 0.0, nan}) {
    CHECK_THROWS_AS((RisleyPrisms{.prisms = {{.refractive_index = bad}}}.validate()), SettingError);
    CHECK_THROWS_AS((RisleyPrisms{.prisms = {{}}, .surrounding_index = bad}.validate()), SettingError);
  }
  CHECK_THROWS_AS((RisleyPrisms{.prisms = {{.start = nan}}}.validate()), SettingError);
  CHECK_THROWS_AS((RisleyPrisms{.prisms = {{}}, .incident = {0, 0, 0}}.validate()), SettingError);
  CHECK_THROWS_AS((RisleyPrisms{.prisms = {{}}, .incident = {0, nan, 0}}.validate()), SettingError);
}
