// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/transport/echo_simulator.hpp>

#include <optional>
#include <type_traits>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/base/units.hpp>
#include <pulsecast/deflector/deflector.hpp>
#include <pulsecast/deflector/polygon_mirror.hpp>
#include <pulsecast/detector/full_waveform.hpp>
#include <pulsecast/platform/platform.hpp>
#include <pulsecast/platform/tripod.hpp>
#include <pulsecast/scanner/scanner.hpp>
#include <pulsecast/survey.hpp>

#include "support/generators.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

namespace {

/// The ground at z = 0.
struct Floor {
  std::optional<Hit> closest_hit(const Ray& ray) const noexcept {
    const double range = -ray.origin.z / ray.direction.z;
    if (!(range > ray.near && range <= ray.far)) return std::nullopt;
    return Hit{range, -ray.direction.z, -0.5 * ray.direction.z, 9, 2};
  }
};

using Simulator = EchoSimulator<RingFootprint, Floor, FullWaveform<>>;
using Receivers = std::vector<ReceiverUnit<RingFootprint, FullWaveform<>>>;

static_assert(!std::is_constructible_v<Simulator, Receivers, Floor, DirectLight, std::vector<Emitter>>);

}  // namespace

TEST_CASE("pulses of one's own have the echoes that a survey gives them, in any order") {
  const Floor ground;
  const Platform source{
      Tripod{.position = {500000, 5400000, 80}}, Mount{},
      Deflector{PolygonMirror{.line_rate = 50, .sweep = 80_deg}, Scanner{.pulse_rate = 5_kHz, .pulses = 300}}};
  const Receivers receivers{{RingFootprint{2}, Receiver{.range_errors = {.deviation = 0.01}}, FullWaveform{}}};
  const std::uint64_t seed = 7;
  const Survey survey{source, receivers, ground, seed};
  const Simulator echoes(receivers, ground, DirectLight{}, source.emitters(), seed);
  auto of_survey = survey.workspace();
  auto of_pulses = echoes.workspace();
  support::Generator any(11);
  std::size_t returned = 0;
  for (int n = 0; n < 500; ++n) {
    const auto i = static_cast<PulseIndex>(any.uniform(0, 300));
    const Outcome expected = survey(i, of_survey), outcome = echoes(i, source.pulse(i), of_pulses);
    CAPTURE(i);
    REQUIRE(outcome.shot.fate == expected.shot.fate);
    REQUIRE(outcome.echoes.size() == expected.echoes.size());
    for (std::size_t k = 0; k < outcome.echoes.size(); ++k) {
      REQUIRE(outcome.echoes[k].range == expected.echoes[k].range);
      REQUIRE(outcome.echoes[k].amplitude == expected.echoes[k].amplitude);
      ++returned;
    }
  }
  CHECK(returned > 100);
  CHECK(echoes(3, std::nullopt, of_pulses).shot.fate == Fate::blocked);
}

TEST_CASE("an emitter without a receiver is refused") {
  const Floor ground;
  const Receivers receivers{{RingFootprint{2}, Receiver{}, FullWaveform{}}};
  CHECK_THROWS_WITH_AS(Simulator(receivers, ground, DirectLight{}, {Emitter{.receiver = 1}}),
                       "Emitter::receiver is 1, but must be from 0 to 0", SettingError);
}
