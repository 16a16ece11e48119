// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/base/tick.hpp>

#include <cmath>
#include <initializer_list>

#include <doctest/doctest.h>

#include "support/generators.hpp"
#include "support/relative.hpp"

using namespace pulsecast;

namespace {

__extension__ typedef unsigned __int128 Wide;

/// i * frequency / rate in whole numbers: the turns of a clockwork of a whole frequency [Hz] when slot i of a source
/// begins.
struct Exact {
  Wide quotient;
  long double rest;  ///< in [0, 1)

  /// A rate is a whole number of 2^-bits, as every double is.
  Exact(PulseIndex i, double rate, unsigned frequency = 1) {
    int bits = 0;
    while (rate != std::floor(rate)) {
      rate *= 2;
      ++bits;
    }
    const Wide numerator = (static_cast<Wide>(i) * frequency) << bits, denominator = static_cast<std::uint64_t>(rate);
    quotient = numerator / denominator;
    rest = static_cast<long double>(static_cast<std::uint64_t>(numerator % denominator)) /
           static_cast<long double>(static_cast<std::uint64_t>(denominator));
  }
};

/// On the circle of circumference 1.
double distance_of_phases(double a, long double b) {
  const double d = std::fabs(static_cast<double>(static_cast<long double>(a) - b));
  return std::fmin(d, 1 - d);
}

double worst_phase_error(PulseIndex first, double rate, unsigned frequency) {
  double worst = 0;
  for (PulseIndex i = first; i < first + 20000; ++i)
    worst = std::fmax(worst, distance_of_phases(Tick::of(i, rate).phase(frequency), Exact(i, rate, frequency).rest));
  return worst;
}

}  // namespace

TEST_CASE("a tick of a pulse is its number over the rate, rounded once, for years") {
  for (const double rate : {1.0, 3.0, 1e5, 99999.5, 1e6 / 7, 1.0 / 3, 2.5e6}) {
    for (const PulseIndex from : {0ULL, 99990ULL, 1000000000ULL, 1000000000000ULL, 1234567890123456ULL}) {
      for (PulseIndex i = from; i < from + 20; ++i) {
        CAPTURE(rate);
        CAPTURE(i);
        const Exact exact(i, rate);
        const Tick tick = Tick::of(i, rate);
        const auto whole = static_cast<std::int64_t>(exact.quotient);
        const double fraction = static_cast<double>(exact.rest);
        if (fraction < 1) {
          CHECK(tick.second == whole);
          CHECK(tick.fraction == fraction);
        } else {
          CHECK(tick == Tick{whole + 1, 0});
        }
      }
    }
  }
}

TEST_CASE("a tick of random pulses and rates keeps its fraction in [0, 1) and its moment exact") {
  for (std::uint64_t seed = 0; seed < 5000; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    const double rate = std::round(any.log_uniform(1, 1e7) * 1024) / 1024;
    const auto i = static_cast<PulseIndex>(any.log_uniform(1, 1e15));
    const Tick tick = Tick::of(i, rate);
    const Exact exact(i, rate);
    CHECK(tick.fraction >= 0);
    CHECK(tick.fraction < 1);
    const long double error = static_cast<long double>(tick.second - static_cast<std::int64_t>(exact.quotient)) +
                              (static_cast<long double>(tick.fraction) - exact.rest);
    CHECK(std::fabs(static_cast<double>(error)) <= 0x1p-53);
  }
}

TEST_CASE("a mirror's phase is as exact at pulse 10^12 as at the first pulse") {
  // The fraction of a second is rounded to 2^-54 and so is the phase, times the frequency; the product and the sums
  // round as well.
  const double bound = 200 * 0x1p-52;
  for (const double rate : {1e5, 99999.5, 1e6 / 7}) {
    CAPTURE(rate);
    CHECK(worst_phase_error(0, rate, 200) <= bound);
    CHECK(worst_phase_error(1000000000000, rate, 200) <= bound);
    CHECK(worst_phase_error(1000000000000000, rate, 200) <= bound);
  }
}

TEST_CASE("a phase of a frequency that is not whole loses its turns exactly") {
  // 0.1 Hz is no double: the clockwork goes at what is nearest, 0.1000000000000000055511151231257827 Hz, and after 10^9
  // s is that far ahead
  CHECK(Tick{1000000000, 0}.phase(0.1) == support::relative(5.5511151231257827e-9, 1e-15));
}

TEST_CASE("a phase is in [0, 1), and zero when a turn is complete") {
  CHECK(Tick{}.phase(40) == 0);
  CHECK(Tick{7, 0}.phase(40) == 0);
  CHECK(Tick{0, 0.5}.phase(3) == 0.5);
  CHECK(Tick{0, 0.25}.phase(-1) == 0.75);
  CHECK(Tick{0, 1e-20}.phase(-1) == 0);
  for (std::uint64_t seed = 0; seed < 5000; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    const Tick tick{static_cast<std::int64_t>(any.whole(1000000000)), any.uniform()};
    const double phase = tick.phase(any.log_uniform(1e-6, 1e6) * (any.coin() ? 1 : -1));
    CHECK(phase >= 0);
    CHECK(phase < 1);
  }
}

TEST_CASE("a moment in seconds splits into whole and rest, before the start too") {
  CHECK(Tick::of_seconds(2.75) == Tick{2, 0.75});
  CHECK(Tick::of_seconds(-0.25) == Tick{-1, 0.75});
  CHECK(Tick::of_seconds(-3) == Tick{-3, 0});
  CHECK(Tick::of_seconds(-1e-20) == Tick{});
  CHECK(Tick{2, 0.75}.seconds() == 2.75);
  CHECK(Tick{-1, 0.75}.seconds() == -0.25);
}

TEST_CASE("addition carries full seconds over") {
  CHECK(Tick{1, 0.75} + Tick{2, 0.5} == Tick{4, 0.25});
  CHECK(Tick{1, 0.5} + Tick{2, 0.5} == Tick{4, 0});
  CHECK(Tick{1, 0.25} + Tick{2, 0.5} == Tick{3, 0.75});
  CHECK(Tick{1, 0.25} + Tick::of_seconds(-0.5) == Tick{0, 0.75});
}

TEST_CASE("ticks are ordered by time") {
  CHECK(Tick{1, 0.9} < Tick{2, 0.1});
  CHECK(Tick{2, 0.1} < Tick{2, 0.2});
  CHECK(Tick{-1, 0.5} < Tick{0, 0});
  CHECK(Tick{2, 0.1} == Tick{2, 0.1});
  for (const double rate : {3.0, 99999.5, 1e6 / 7})
    for (PulseIndex i = 999999999000; i < 1000000000000; ++i) REQUIRE(Tick::of(i, rate) < Tick::of(i + 1, rate));
}

TEST_CASE("a clockwork at the pulse rate takes one step a pulse, also after a million million pulses") {
  for (const double rate : {1.0, 3.0, 1e5, 300e3, 33333.3, 99999.5, 1e6 / 7}) {
    for (const std::size_t n : {1U, 2U, 3U, 7U, 128U, 2083U, 100000U}) {
      for (const PulseIndex start : {PulseIndex{0}, PulseIndex{123456789}, PulseIndex{1000000000000}}) {
        CAPTURE(rate);
        CAPTURE(n);
        CAPTURE(start);
        for (PulseIndex i = start; i < start + 300; ++i) REQUIRE(step_in_cycle(Tick::of(i, rate), rate, n) == i % n);
      }
    }
  }
}

TEST_CASE("a moment between two steps belongs to the nearer one") {
  CHECK(step_in_cycle({0, 0.1}, 4, 3) == 0);
  CHECK(step_in_cycle({0, 0.13}, 4, 3) == 1);
  CHECK(step_in_cycle({0, 0.62}, 4, 3) == 2);
  CHECK(step_in_cycle({0, 0.63}, 4, 3) == 0);
}
