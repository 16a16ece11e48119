// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/scanner/channels.hpp>

#include <cmath>
#include <optional>
#include <vector>

#include <pulsecast/base/units.hpp>
#include <pulsecast/deflector/deflector.hpp>
#include <pulsecast/deflector/fixed_beam.hpp>
#include <pulsecast/deflector/polygon_mirror.hpp>
#include <pulsecast/deflector/risley_prisms.hpp>
#include <pulsecast/deflector/rotating_head.hpp>
#include <pulsecast/platform/platform.hpp>
#include <pulsecast/platform/straight_line.hpp>
#include <pulsecast/platform/tripod.hpp>
#include <pulsecast/scanner/scanner.hpp>

#include <doctest/doctest.h>

#include "support/archetypes.hpp"
#include "support/laws.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

static_assert(BeamSource<Channels<Scanner>>);
static_assert(InstrumentSource<Channels<Deflector<FixedBeam, Scanner>>>);
static_assert(WorldSource<Channels<support::LeastSource<frame::World>>>);

namespace {

using Beam = Deflector<FixedBeam, Scanner>;

/// Beams from -15 to 15 degrees, fired in turn with a pause at the end of each round.
std::vector<Beam> fan(std::size_t n, PulseIndex pulses = 1000) {
  std::vector<Beam> beams;
  for (std::size_t k = 0; k < n; ++k) {
    const double place = static_cast<double>(k);
    beams.emplace_back(
        FixedBeam{aimed_at(0, radians(-15 + 30 * place / static_cast<double>(n - 1)), {0, 0, 0.001 * place})},
        Scanner{.pulse_rate = 20_kHz, .pulses = pulses, .delay = place * 1_us});
  }
  return beams;
}

}  // namespace

TEST_CASE("channels take turns, and each is what it is alone but for its number") {
  const std::vector<Beam> beams = fan(16);
  const Channels device{beams};
  const std::vector<Emitter> emitters = device.emitters();
  CHECK(device.size() == 16000);
  CHECK(emitters.size() == 16);
  CHECK(device.duration() == beams[0].duration());
  for (PulseIndex i = 0; i < device.size(); ++i) {
    const auto p = device.pulse(i), alone = beams[i % 16].pulse(i / 16);
    REQUIRE(p);
    REQUIRE(emitters[p->emitter].channel == i % 16);
    REQUIRE(p->tick == alone->tick);
    REQUIRE(p->direction() == alone->direction());
    REQUIRE(p->origin() == Vec3{0, 0, 0.001 * static_cast<double>(i % 16)});
  }
  CHECK(support::source_laws(device) == "");
}

TEST_CASE("pulses of one channel share a register, through heads and platforms, also of channels of several emitters") {
  const Deflector sensor{RotatingHead{.angular_rate = 100}, Channels{fan(16)}};
  const Platform car{StraightLine{.speed = 10}, Mount{.lever_arm = {0, 0, 2}}, sensor};
  static_assert(pulsecast::detail::MakesStridedLanes<decltype(car)>);
  CHECK(car.pulse_lanes(5, simd::lane_count, 16).size == simd::lane_count);
  CHECK(support::source_laws(sensor) == "");
  CHECK(support::source_laws(car) == "");
  CHECK(support::source_laws(Channels{std::vector{Channels{fan(3)}, Channels{fan(3)}}}) == "");
}

TEST_CASE("channels keep the laws of a source, of any number and size") {
  for (const std::size_t n : {1U, 2U, 31U, 256U, 3000U})
    for (const PulseIndex pulses : {PulseIndex{0}, PulseIndex{1}, PulseIndex{100}, PulseIndex{1000000000000}}) {
      CAPTURE(n);
      CAPTURE(pulses);
      const Channels device{std::vector<Scanner>(n, Scanner{.pulses = pulses})};  // all together
      CHECK(device.size() == n * pulses);
      CHECK(support::source_laws(device) == "");
    }
}

TEST_CASE("a spinning sensor of many beams draws one cone per beam, each beam turned on by its own delay") {
  const double rate = 10 * 360_deg;
  const Deflector sensor{RotatingHead{.angular_rate = -rate},
                         Channels{fan(32, 2000)}};  // ten turns a second to the right
  const Platform robot{Tripod{}, Mount{.lever_arm = {0, 0, 1.5}}, sensor};
  CHECK(support::source_laws(robot) == "");
  CHECK(support::wrapped_source_laws(robot, sensor) == "");
  const std::vector<Emitter> emitters = robot.emitters();
  for (PulseIndex i = 0; i < robot.size(); i += 101) {
    const auto p = robot.pulse(i);
    const double elevation = radians(-15 + 30 * static_cast<double>(emitters[p->emitter].channel) / 31),
                 azimuth = rate * p->tick.seconds();
    const double level = std::cos(elevation);
    CAPTURE(i);
    CHECK(length(p->direction() - Vec3{level * std::sin(azimuth), level * std::cos(azimuth), std::sin(elevation)}) <
          1e-12);
  }
}

TEST_CASE("channels may differ in laser and in optic, and one may be blocked while another is open") {
  std::vector<Deflector<PolygonMirror, Scanner>> two;
  two.emplace_back(PolygonMirror{.line_rate = 50, .angle_min = 0},
                   Scanner{.pulses = 5000, .laser = {.wavelength = 1064_nm}});
  two.emplace_back(PolygonMirror{.line_rate = 50, .angle_max = 0},
                   Scanner{.pulses = 5000, .laser = {.wavelength = 532_nm}});
  const Channels device{two};
  CHECK(support::source_laws(device) == "");
  const std::vector<Emitter> emitters = device.emitters();
  for (PulseIndex i = 0; i < device.size(); ++i) {
    const auto p = device.pulse(i);
    REQUIRE(p.has_value() == two[i % 2].pulse(i / 2).has_value());
    if (p) REQUIRE(emitters[p->emitter].laser.wavelength == (i % 2 == 0 ? 1064_nm : 532_nm));
  }

  std::vector<Deflector<RisleyPrisms, Scanner>> three;
  for (const double aside : {-0.1, 0.0, 0.1})
    three.emplace_back(
        RisleyPrisms{.prisms = {{.rotation_rate = 77}, {.rotation_rate = -33}}, .incident = {aside, 1, 0}}, Scanner{});
  const Channels rosettes{three};
  CHECK(support::source_laws(rosettes) == "");
  CHECK(rosettes.pulse(0)->direction().x < rosettes.pulse(1)->direction().x);
  CHECK(rosettes.pulse(1)->direction().x < rosettes.pulse(2)->direction().x);
}

TEST_CASE("several lasers may share one mirror") {
  const std::vector<Scanner> lasers{{.pulses = 100, .laser = {.wavelength = 905_nm}}, {.pulses = 100, .delay = 2_us}};
  const Deflector device{PolygonMirror{}, Channels{lasers}};
  CHECK(support::source_laws(device) == "");
  CHECK(device.pulse(2)->emitter == 0);
  CHECK(device.pulse(3)->emitter == 1);
  CHECK(device.emitters() == std::vector<Emitter>{{.laser = {.wavelength = 905_nm}}, {.channel = 1}});
}

TEST_CASE("channels of several emitters each list all of them, under the number of their channel") {
  const auto pair = [](double first, double second) {
    return Channels{
        std::vector<Scanner>{{.laser = {.wavelength = first}, .receiver = 1}, {.laser = {.wavelength = second}}}};
  };
  const Channels device{std::vector{pair(905_nm, 1064_nm), pair(1310_nm, 1550_nm)}};
  CHECK(support::source_laws(device) == "");
  CHECK(device.emitters() == std::vector<Emitter>{{.laser = {.wavelength = 905_nm}, .receiver = 1, .channel = 0},
                                                  {.laser = {.wavelength = 1064_nm}, .channel = 0},
                                                  {.laser = {.wavelength = 1310_nm}, .receiver = 1, .channel = 1},
                                                  {.laser = {.wavelength = 1550_nm}, .channel = 1}});
  for (PulseIndex i = 0; i < 8; ++i) CHECK(device.pulse(i)->emitter == i % 2 * 2 + i / 2 % 2);
}

TEST_CASE("a device has at least one channel and at most 65535, all of one length") {
  CHECK_THROWS_AS(Channels{std::vector<Scanner>{}}, SettingError);
  const Channels most{std::vector<Scanner>(65535)};
  CHECK(most.pulse(65534)->emitter == 65534);
  CHECK(most.emitters().back().channel == 65534);
  CHECK_THROWS_AS(Channels{std::vector<Scanner>(65536)}, SettingError);
  CHECK_THROWS_WITH_AS((Channels{std::vector<Channels<Scanner>>(256, Channels{std::vector<Scanner>(256)})}),
                       doctest::Contains("Channels::channels (emitters) is 65536"), SettingError);
  CHECK_THROWS_AS((Channels{std::vector<Scanner>{{.pulses = 10}, {.pulses = 11}}}), SettingError);
  CHECK_THROWS_AS((Channels{std::vector<Scanner>{{.pulse_rate = 10}, {.pulse_rate = 11}}}), SettingError);
  CHECK_THROWS_AS((Channels{std::vector<Scanner>{{}, {.pulse_rate = -1}}}), SettingError);
}

TEST_CASE("channels whose time would go backwards are refused") {
  const auto device = [](std::vector<double> delays) {
    std::vector<Scanner> lasers;
    for (const double delay : delays) lasers.push_back({.delay = delay});
    return Channels{lasers};
  };
  CHECK_NOTHROW(device({0, 0, 1_us, 9_us}));
  CHECK_NOTHROW(device({3_us, 3_us}));
  CHECK_THROWS_AS(device({1_us, 0}), SettingError);
  CHECK_THROWS_AS(device({0, 2_us, 1_us, 3_us}), SettingError);
  CHECK_THROWS_AS(device({0, 2_us, 2_us, 2_us, 1_us}), SettingError);
}

TEST_CASE(
    "channels out of order are found wherever their optics open, and wherever a source of one's own goes astray") {
  // a mirror that is closed in the first 19 ms of a line, and at the end, too
  const auto pair = [](double first, double second) {
    const PolygonMirror late{.line_rate = 33, .angle_min = 30_deg};
    std::vector<Deflector<PolygonMirror, Scanner>> two;
    two.emplace_back(late, Scanner{.pulses = 3200, .delay = first});
    two.emplace_back(late, Scanner{.pulses = 3200, .delay = second});
    return Channels{two};
  };
  CHECK_FALSE(pair(0, 1_us).pulse(3000));
  CHECK_FALSE(pair(0, 1_us).pulse(6399));
  CHECK_THROWS_AS(pair(1_us, 0), SettingError);

  struct Astray : Scanner {
    std::optional<Pulse<frame::Beam>> pulse(PulseIndex i) const noexcept {
      auto p = Scanner::pulse(i);
      if (receiver == 1 && i + 1 == pulses) p->tick = p->tick + Tick{-1, 0};
      return p;
    }
  };
  CHECK_NOTHROW((Channels{std::vector<Astray>{{{.pulses = 9000}}, {{.pulses = 9000}}}}));
  CHECK_THROWS_AS((Channels{std::vector<Astray>{{{.pulses = 9000}}, {{.pulses = 9000, .receiver = 1}}}}), SettingError);
}
