// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/detector/receiver_chain.hpp>

#include <cmath>
#include <limits>

#include <doctest/doctest.h>

#include "support/relative.hpp"

using namespace pulsecast;
using support::relative;

TEST_CASE(
    "the density of the noise is that of the amplifier and of the shot noise of signal, background and dark current") {
  const ReceiverChain thermal{.noise_power = 1e-12};
  CHECK(thermal.density(0, 1.064e-6) == relative(1e-24, 1e-15));
  CHECK(thermal.density(1e-3, 1.064e-6) == relative(1e-24, 1e-15));
  // a photon of 1064 nm has 1.8669905e-19 J; of a current of 1 nA, q / (eta h nu) W are behind each ampere
  const double photon = 6.62607015e-34 * 299792458 / 1.064e-6;
  const ReceiverChain shot{
      .background = 2e-9, .quantum_efficiency = 0.5, .shot_noise = true, .excess_noise = 3, .dark_current = 1e-9};
  const double dark = 1e-9 * photon / (0.5 * 1.602176634e-19);
  CHECK(shot.density(5e-9, 1.064e-6) == relative(2 * 3 * photon / 0.5 * (7e-9 + dark), 1e-12));
  CHECK(shot.density(-1, 1.064e-6) == relative(2 * 3 * photon / 0.5 * (2e-9 + dark), 1e-12));
}

TEST_CASE("shot noise of a band is Poisson's: the variance of the photoelectrons in a time is their number") {
  // white noise in a mean over a time T has the bandwidth 1 / (2 T)
  const ReceiverChain chain{.quantum_efficiency = 1, .shot_noise = true};
  const double photon = 6.62607015e-34 * 299792458 / 1.55e-6, time = 1e-6, power = 1e-9;
  const double variance = chain.density(power, 1.55e-6) / (2 * time);
  CHECK(std::pow(power / photon * time, 1) == relative(variance * std::pow(time / photon, 2), 1e-12));
}

TEST_CASE("without a bandwidth the low-pass is as wide as the pulse") {
  CHECK(ReceiverChain{}.filter(4e-9).deviation == relative(4e-9 / 2.3548200450309493, 1e-12));
  CHECK(ReceiverChain{.bandwidth = 1e9}.filter(4e-9).deviation == LowPass::of_bandwidth(1e9).deviation);
}

TEST_CASE("a digitiser rounds to its codes, and has an end at both sides") {
  const ReceiverChain chain{.full_scale = 7e-9, .baseline = 1e-9, .bits = 3};  // eight codes from -1 to 7 nW
  const double step = 8e-9 / 7;
  for (int code = 0; code < 8; ++code)
    for (const double beside : {-0.49, 0.0, 0.49})
      CHECK(chain.quantized(-1e-9 + (code + beside) * step) == doctest::Approx(-1e-9 + code * step).epsilon(1e-12));
  CHECK(chain.quantized(1) == doctest::Approx(7e-9).epsilon(1e-12));
  CHECK(chain.quantized(-1) == doctest::Approx(-1e-9).epsilon(1e-12));
  CHECK(ReceiverChain{}.quantized(1.25e-9) == 1.25e-9);
}

TEST_CASE("the error of a digitiser has a variance of a twelfth of its squared step") {
  const ReceiverChain chain{.full_scale = 255, .bits = 8};
  double squares = 0;
  constexpr int count = 100'000;
  for (int i = 0; i < count; ++i) {
    const double power = std::fmod(0.6180339887498949 * i, 1.0) * 200 + 10;  // evenly spread
    squares += std::pow(chain.quantized(power) - power, 2);
  }
  CHECK(squares / count == relative(1.0 / 12, 0.01));
}

TEST_CASE("a receiver refuses values out of range") {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_NOTHROW(ReceiverChain{}.validate());
  for (const double bad : {-1.0, nan}) {
    CHECK_THROWS_AS(ReceiverChain{.bandwidth = bad}.validate(), SettingError);
    CHECK_THROWS_AS(ReceiverChain{.noise_power = bad}.validate(), SettingError);
    CHECK_THROWS_AS(ReceiverChain{.background = bad}.validate(), SettingError);
    CHECK_THROWS_AS(ReceiverChain{.quantum_efficiency = bad}.validate(), SettingError);
    CHECK_THROWS_AS(ReceiverChain{.excess_noise = bad}.validate(), SettingError);
    CHECK_THROWS_AS(ReceiverChain{.dark_current = bad}.validate(), SettingError);
    CHECK_THROWS_AS(ReceiverChain{.saturation = bad}.validate(), SettingError);
    CHECK_THROWS_AS(ReceiverChain{.recovery = bad}.validate(), SettingError);
    CHECK_THROWS_AS(ReceiverChain{.full_scale = bad}.validate(), SettingError);
    CHECK_THROWS_AS(ReceiverChain{.baseline = bad}.validate(), SettingError);
  }
  CHECK_THROWS_AS(ReceiverChain{.quantum_efficiency = 0}.validate(), SettingError);
  CHECK_THROWS_AS(ReceiverChain{.quantum_efficiency = 1.1}.validate(), SettingError);
  CHECK_THROWS_AS(ReceiverChain{.bits = 0}.validate(), SettingError);
  CHECK_THROWS_AS(ReceiverChain{.bits = 25}.validate(), SettingError);
}
