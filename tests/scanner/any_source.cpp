// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/scanner/any_source.hpp>

#include <type_traits>
#include <vector>

#include <pulsecast/deflector/deflector.hpp>
#include <pulsecast/deflector/fixed_beam.hpp>
#include <pulsecast/deflector/oscillating_mirror.hpp>
#include <pulsecast/platform/legs.hpp>
#include <pulsecast/platform/platform.hpp>
#include <pulsecast/platform/straight_line.hpp>
#include <pulsecast/platform/tripod.hpp>
#include <pulsecast/scanner/channels.hpp>
#include <pulsecast/scanner/scanner.hpp>

#include <doctest/doctest.h>

using namespace pulsecast;

namespace {
using Fixed = Deflector<FixedBeam, Scanner>;
using Swinging = Deflector<OscillatingMirror, Scanner>;
using Channel = AnySource<Fixed, Swinging>;
static_assert(InstrumentSource<Channel> && !WorldSource<Channel>);

const Scanner scanner{.pulse_rate = 1000, .pulses = 50};
}  // namespace

TEST_CASE("emitters behind different optics make one device, and each is what it is alone") {
  const Fixed fixed{FixedBeam{aimed_at(0.1, 0.2)}, scanner};
  const Swinging swinging{OscillatingMirror{}, scanner};
  const Channels device{std::vector<Channel>{fixed, swinging}};
  REQUIRE(device.size() == 100);
  const std::vector<Emitter> emitters = device.emitters();
  REQUIRE(emitters.size() == 2);
  CHECK(device.duration() == scanner.duration());
  for (PulseIndex i = 0; i < device.size(); ++i) {
    const auto pulse = device.pulse(i), alone = i % 2 == 0 ? fixed.pulse(i / 2) : swinging.pulse(i / 2);
    REQUIRE(pulse.has_value());
    CHECK(pulse->direction() == alone->direction());
    CHECK(pulse->tick == alone->tick);
    CHECK(emitters[pulse->emitter].channel == i % 2);
  }
}

TEST_CASE("legs of different platforms follow each other") {
  const Fixed device{FixedBeam{}, scanner};
  const Platform standing{Tripod{.position = {1, 2, 3}}, Mount{}, device};
  const Platform flying{StraightLine{.from = {0, 0, 100}, .to = {100, 0, 100}, .speed = 50}, Mount{}, device};
  const Legs legs{
      std::vector<AnySource<std::decay_t<decltype(standing)>, std::decay_t<decltype(flying)>>>{standing, flying}};
  CHECK(legs.pulse(3)->origin() == standing.pulse(3)->origin());
  CHECK(legs.pulse(53)->origin() == flying.pulse(3)->origin());
}

TEST_CASE("one of several refuses what it refuses alone") {
  CHECK_THROWS_AS((AnySource<Scanner, Fixed>(Scanner{.pulse_rate = -1})), SettingError);
}
