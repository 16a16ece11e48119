// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/detector/receiver_noise.hpp>

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include <doctest/doctest.h>

#include <pulsecast/deflector/deflector.hpp>
#include <pulsecast/deflector/fixed_beam.hpp>
#include <pulsecast/detector/full_waveform.hpp>
#include <pulsecast/platform/platform.hpp>
#include <pulsecast/platform/tripod.hpp>
#include <pulsecast/run.hpp>
#include <pulsecast/scanner/scanner.hpp>

#include "support/laws.hpp"
#include "support/relative.hpp"

using namespace pulsecast;

TEST_CASE("without settings there is no noise") {
  CHECK(ReceiverNoise{}.none());
  CHECK(ReceiverNoise{}.deviation_of_sample(1e-6, 1e-9) == 0);
  CHECK_FALSE(ReceiverNoise{.deviation = 1e-12}.none());
  CHECK_FALSE(ReceiverNoise{.background = 1e-12}.none());
}

TEST_CASE("the shot noise of a background is that of its photons") {
  // by hand: at 1 um a photon has 1.98645e-19 J, so 1 nW brings 5.03412 photons in 1 ns; they vary by their root
  const ReceiverNoise noise{.background = 1e-9};
  CHECK(noise.deviation_of_sample(1e-6, 1e-9) == support::relative(std::sqrt(5.03412) * 1.98645e-19 / 1e-9, 1e-5));
  const ReceiverNoise half{.background = 1e-9, .quantum_efficiency = 0.5};
  CHECK(half.deviation_of_sample(1e-6, 1e-9) ==
        support::relative(std::sqrt(2) * noise.deviation_of_sample(1e-6, 1e-9), 1e-12));
  const ReceiverNoise both{.deviation = 3e-10, .background = 1e-9};
  CHECK(both.deviation_of_sample(1e-6, 1e-9) ==
        support::relative(std::hypot(3e-10, noise.deviation_of_sample(1e-6, 1e-9)), 1e-12));
}

TEST_CASE("noise refuses settings that cannot be") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_NOTHROW(ReceiverNoise{}.validate());
  for (const double bad : {-1.0, nan}) {
    CHECK_THROWS_AS(ReceiverNoise{.deviation = bad}.validate(), SettingError);
    CHECK_THROWS_AS(ReceiverNoise{.background = bad}.validate(), SettingError);
  }
  for (const double bad : {-1.0, 0.0, 1.1, nan})
    CHECK_THROWS_AS(ReceiverNoise{.quantum_efficiency = bad}.validate(), SettingError);
}

TEST_CASE(
    "a survey has the same noise whatever the number of threads, another for another seed, and none unless asked for") {
  struct Wall {
    std::optional<Hit> closest_hit(const Ray& ray) const noexcept { return Hit{100 / ray.direction.y, 1, 1, 0, 0}; }
  };
  const Wall wall;
  const Platform source{Tripod{}, Mount{}, Deflector{FixedBeam{}, Scanner{.pulses = 3000}}};
  const auto sum = [&](unsigned threads, std::uint64_t seed, double deviation) {
    const WaveformSettings settings{.threshold = 0, .returns_max = 255, .record_length = 100e-9};
    const Survey survey{source,
                        RingFootprint(3),
                        wall,
                        Receiver{},
                        FullWaveform(settings, NoWidth{}, ReceiverNoise{.deviation = deviation}),
                        seed};
    support::LawfulSink sink;
    (void)run(survey, {.threads = threads}, sink);
    CHECK(sink.broken() == "");
    return sink.checksum();
  };
  const std::string noisy = sum(1, 1, 1e-8);
  CHECK(sum(4, 1, 1e-8) == noisy);
  CHECK(sum(1, 2, 1e-8) != noisy);
  CHECK(sum(1, 1, 0) != noisy);
  CHECK(sum(1, 1, 0) == sum(3, 2, 0));
}
