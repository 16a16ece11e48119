// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/platform/legs.hpp>

#include <concepts>
#include <cstdint>
#include <utility>
#include <vector>

#include <pulsecast/deflector/deflector.hpp>
#include <pulsecast/deflector/fixed_beam.hpp>
#include <pulsecast/deflector/polygon_mirror.hpp>
#include <pulsecast/platform/platform.hpp>
#include <pulsecast/platform/tripod.hpp>
#include <pulsecast/scanner/channels.hpp>
#include <pulsecast/scanner/scanner.hpp>

#include <doctest/doctest.h>

#include "support/archetypes.hpp"
#include "support/generators.hpp"
#include "support/laws.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

namespace {

using Pass = Platform<Tripod, Deflector<PolygonMirror, Scanner>>;
static_assert(WorldSource<Legs<Pass>>);
static_assert(WorldSource<Legs<support::LeastSource<frame::World>>>);

Pass set_up(double x, double rate, PulseIndex pulses, const PolygonMirror& mirror = {}) {
  return {Tripod{.position = {x, 0, 0}}, Mount{}, Deflector{mirror, Scanner{.pulse_rate = rate, .pulses = pulses}}};
}

}  // namespace

TEST_CASE("legs stand end to end: their slots are numbered through, and time runs on") {
  const Legs legs(std::vector{set_up(1, 4, 6), set_up(2, 1, 2), set_up(3, 2, 3)});
  CHECK(legs.size() == 11);
  CHECK(legs.duration() == Tick{5, 0});
  CHECK(legs.start(0) == Tick{0, 0});
  CHECK(legs.start(1) == Tick{1, 0.5});
  CHECK(legs.start(2) == Tick{3, 0.5});
  const std::pair<double, std::uint16_t> expected[] = {{0, 0},   {0.25, 0}, {0.5, 0}, {0.75, 0}, {1, 0},  {1.25, 0},
                                                       {1.5, 1}, {2.5, 1},  {3.5, 2}, {4, 2},    {4.5, 2}};
  for (PulseIndex i = 0; i < 11; ++i) {
    CAPTURE(i);
    const auto p = legs.pulse(i);
    REQUIRE(p);
    CHECK(p->tick.seconds() == expected[i].first);
    CHECK(p->leg == expected[i].second);
    CHECK(legs.leg_of(i) == expected[i].second);
    CHECK(p->origin().x == expected[i].second + 1);
  }
}

TEST_CASE("each leg begins with its own clock at zero") {
  // a line of the mirror lasts 2 s, and the first leg ends in the middle of one
  const Legs legs(std::vector{set_up(0, 1, 3, {.line_rate = 0.5}), set_up(0, 1, 3, {.line_rate = 0.5})});
  for (PulseIndex i = 0; i < 3; ++i) CHECK(legs.pulse(i + 3)->direction() == legs.pulse(i)->direction());
}

TEST_CASE("a leg without pulses takes a number and nothing else") {
  const Legs legs(std::vector{set_up(1, 1, 2), set_up(2, 1, 0), set_up(3, 1, 2)});
  CHECK(legs.size() == 4);
  CHECK(legs.pulse(1)->leg == 0);
  CHECK(legs.pulse(2)->leg == 2);
  CHECK(legs.pulse(2)->tick == Tick{2, 0});
}

TEST_CASE("a blocked slot stays blocked in its leg") {
  const Legs legs(std::vector{set_up(1, 4, 4), set_up(2, 4, 4, {.line_rate = 1, .angle_min = 0})});
  CHECK(legs.pulse(3));
  CHECK_FALSE(legs.pulse(4));
  CHECK_FALSE(legs.pulse(5));
  CHECK(legs.pulse(6));
}

TEST_CASE("a single leg is what it holds") {
  const Pass pass = set_up(1, 99999.5, 100000007);
  const Legs legs(std::vector{pass});
  CHECK(support::source_laws(legs) == "");
  CHECK(support::wrapped_source_laws(legs, pass) == "");
}

TEST_CASE("many legs keep the laws of a source") {
  std::vector<Pass> passes;
  for (int k = 0; k < 300; ++k) passes.push_back(set_up(k, 1e6 / (k + 7), static_cast<PulseIndex>(1000 + 37 * k)));
  const Legs legs(passes);
  CHECK(support::source_laws(legs, 5000) == "");
  PulseIndex first = 0;
  for (std::size_t k = 0; k < passes.size(); ++k) {
    CAPTURE(k);
    CHECK(legs.pulse(first)->leg == k);
    CHECK(legs.pulse(first)->tick == legs.start(k));
    first += passes[k].size();
    CHECK(legs.pulse(first - 1)->leg == k);
  }
  CHECK(first == legs.size());
}

TEST_CASE("a leg that is not active takes its time and its number, but holds no slots") {
  const Legs legs(
      std::vector<Leg<Pass>>{{set_up(1, 4, 6)}, {set_up(2, 1, 5), false}, {set_up(3, 2, 3)}, {set_up(4, 1, 7), false}});
  static_assert(std::same_as<decltype(legs), const Legs<Pass>>);
  CHECK(legs.size() == 9);
  CHECK(legs.duration() == Tick{15, 0});
  CHECK(legs.legs().size() == 4);
  CHECK(legs.start(2) == Tick{6, 0.5});
  CHECK(legs.pulse(5)->leg == 0);
  CHECK(legs.pulse(6)->leg == 2);
  CHECK(legs.pulse(6)->tick == Tick{6, 0.5});
  CHECK(legs.pulse(6)->origin().x == 3);
  CHECK(legs.pulse(8)->leg == 2);
  CHECK(support::source_laws(legs) == "");
  CHECK(Legs(std::vector<Leg<Pass>>{{set_up(1, 4, 6), false}}).size() == 0);
}

TEST_CASE("a leg may say when it starts: with a gap, or before the leg listed before it") {
  std::vector<Leg<Pass>> list;
  for (const Tick start : {Tick{7, 0.25}, Tick{100, 0}, Tick{0, 0.5}})
    list.push_back({.platform = set_up(1, 100, 10), .start = start});
  list.push_back({.platform = set_up(1, 100, 10)});
  const Legs legs(list);
  CHECK(legs.pulse(0)->tick == Tick{7, 0.25});
  CHECK(legs.pulse(10)->tick == Tick{100, 0});
  CHECK(legs.pulse(20)->tick == Tick{0, 0.5});
  CHECK(legs.pulse(30)->tick == Tick{0, 0.5} + legs.legs()[2].duration());
  CHECK(legs.duration() == Tick{100, 0} + legs.legs()[1].duration());
  list[0].start = Tick{-1, 0};
  CHECK_THROWS_AS(Legs{list}, SettingError);
}

TEST_CASE("legs share equal tables of emitters, and the pulses of each keep their own") {
  const auto pass = [](std::vector<double> wavelengths, PulseIndex pulses = 4) {
    std::vector<Deflector<FixedBeam, Scanner>> channels;
    for (const double wavelength : wavelengths)
      channels.emplace_back(FixedBeam{}, Scanner{.pulses = pulses, .laser = {.wavelength = wavelength}});
    return Platform{Tripod{}, Mount{}, Channels{channels}};
  };
  const std::vector green_and_red{532_nm, 905_nm}, red_and_green{905_nm, 532_nm};
  const std::vector passes{pass(green_and_red), pass(red_and_green), pass(green_and_red),
                           pass({1_um}, 0),     pass(red_and_green), pass({532_nm})};
  const Legs legs(passes);
  CHECK(support::source_laws(legs) == "");
  const std::vector<Emitter> emitters = legs.emitters();
  CHECK(emitters.size() == 4);  // the last leg's table is the begin of the first one's
  PulseIndex i = 0;
  for (const auto& platform : passes)
    for (PulseIndex k = 0; k < platform.size(); ++k, ++i) {
      CAPTURE(i);
      CHECK(emitters[legs.pulse(i)->emitter] == platform.emitters()[platform.pulse(k)->emitter]);
    }
  CHECK(i == legs.size());
}

TEST_CASE("each leg finds its emitters among those of all, whatever they are") {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    std::vector<Platform<Tripod, Deflector<FixedBeam, Channels<Scanner>>>> passes;
    for (std::size_t k = 0; k < 30; ++k) {
      std::vector<Scanner> channels(1 + any.whole(5), Scanner{.pulses = any.whole(4)});
      for (Scanner& channel : channels) {
        channel.footprint_scale = static_cast<double>(1 + any.whole(2));
        channel.receiver = static_cast<std::uint16_t>(any.whole(2));
      }
      passes.push_back({Tripod{}, Mount{}, Deflector{FixedBeam{}, Channels{channels}}});
    }
    const Legs legs(passes);
    REQUIRE(support::source_laws(legs) == "");
    const std::vector<Emitter> emitters = legs.emitters();
    PulseIndex i = 0;
    for (const auto& platform : passes)
      for (PulseIndex k = 0; k < platform.size(); ++k, ++i)
        REQUIRE(emitters[legs.pulse(i)->emitter] == platform.emitters()[platform.pulse(k)->emitter]);
  }
}

TEST_CASE("more emitters than a pulse can number are refused") {
  const auto pass = [](double wavelength) {
    return Platform{Tripod{}, Mount{},
                    Deflector{FixedBeam{}, Channels{std::vector<Scanner>(
                                               40'000, Scanner{.pulses = 1, .laser = {.wavelength = wavelength}})}}};
  };
  CHECK(Legs(std::vector{pass(532_nm), pass(532_nm)}).emitters().size() == 40'000);
  CHECK_THROWS_WITH_AS((Legs(std::vector{pass(532_nm), pass(905_nm)})),
                       doctest::Contains("Legs::legs (emitters) is 80000"), SettingError);
}

TEST_CASE("no legs are refused") { CHECK_THROWS_AS(Legs(std::vector<Pass>{}), SettingError); }
