// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Two plates, one behind the other, that each meet half of a beam.

#include <cmath>
#include <cstdio>
#include <optional>
#include <string>

#include <doctest/doctest.h>

#include <pulsecast/base/units.hpp>
#include <pulsecast/detector/analytic_waveform.hpp>
#include <pulsecast/detector/full_waveform.hpp>

#include "validation/one_pulse.hpp"
#include "validation/table.hpp"

using namespace pulsecast;
using namespace pulsecast::validation;

namespace {

constexpr Laser laser{.pulse_length = 4e-9, .divergence = 0.3e-3};
constexpr double tau =
    4e-9 /
    3.3946806708;  ///< of a pulse of 4 ns, P(t) = (t/tau)^2 exp(-t/tau). Source: Carlsson et al. 2001, eq. 4.5 [s]

struct Plates {
  double apart;
  std::optional<Hit> closest_hit(const Ray& ray) const noexcept {
    return Hit{(ray.direction.x < 0 ? 100 : 100 + apart) / ray.direction.y, 1,
               ray.direction.x < 0 ? 1.0 : std::pow(1 + apart / 100, 2), 0, 0};
  }
};

/// Two rays of half the energy each.
struct TwoRays {
  std::size_t size() const noexcept { return 2; }
  Vec2 offset(std::size_t j) const noexcept { return {j == 0 ? -0.1 : 0.1, 0}; }
  double share(std::size_t) const noexcept { return 0.5; }
};

template <class D>
std::vector<Echo> echoes(double apart, const D& detector) {
  return one_pulse(Plates{apart}, TwoRays{}, laser, vacuum, detector).echoes;
}

/// The least distance between plates that are two echoes.
template <class D>
double resolved(const D& detector) {
  double one = 0, two = 2;
  while (two - one > 1e-7) {
    const double middle = 0.5 * (one + two);
    (echoes(middle, detector).size() == 1 ? one : two) = middle;
  }
  return two;
}

}  // namespace

TEST_CASE("plates are two echoes from a distance on") {
  // Of two equal pulses, the first has its peak two tau after its leading edge. If the second one's edge comes in
  // before, the sum goes on rising and turns once; if it comes in later, the sum falls and rises again. So two echoes
  // are at least 2 tau apart in time.
  const WaveformSettings settings{.window = 0};
  row("AnalyticWaveform, two equal plates: least distance with two echoes [m]", speed_of_light * tau,
      resolved(AnalyticWaveform(settings)), 1e-5);
  row("FullWaveform, two equal plates: least distance with two echoes [m]", speed_of_light * tau,
      resolved(FullWaveform(settings)), 0.1);
}

TEST_CASE("peaks of two plates") {
  for (const double apart : {1, 2, 5}) {
    const WaveformSettings settings{.timing = EchoTiming::peak};
    char text[80];
    std::snprintf(text, sizeof text, "plates %g m apart: peaks apart [ns]", apart);
    const auto exact = echoes(apart, AnalyticWaveform(settings)), sampled = echoes(apart, FullWaveform(settings));
    REQUIRE(exact.size() == 2);
    REQUIRE(sampled.size() == 2);
    // The second pulse begins d tau after the first, whose peak is at 2 tau, and stands on its tail: x tau after its
    // own leading edge the sum is e^-x ((x + d)^2 q + x^2) with q = e^-d, and its slope is zero where (1 + q) x^2 - 2
    // (1 + q - d q) x - (2 - d) d q = 0.
    const double d = 2 * apart / speed_of_light / tau, q = std::exp(-d), half = 1 + q - d * q;
    const double x = (half + std::sqrt(half * half + (1 + q) * (2 - d) * d * q)) / (1 + q);
    const double closed = (d + x - 2) * tau * 1e9, to_ns = 2e9 / speed_of_light;
    row(std::string("AnalyticWaveform, ") + text, closed, (exact[1].range - exact[0].range) * to_ns, 1e-6);
    row(std::string("FullWaveform, ") + text, closed, (sampled[1].range - sampled[0].range) * to_ns, 1e-3);
  }
}

TEST_CASE("echoes of two plates, timed by their energy") {
  // the mean of the true ranges of an echo's subrays is that of its plate, however the pulses overlap
  for (const double apart : {0.5, 1.0, 2.0}) {
    char text[80];
    std::snprintf(text, sizeof text, "plates %g m apart: echoes apart [m]", apart);
    const WaveformSettings settings{.timing = EchoTiming::true_range};
    const auto exact = echoes(apart, AnalyticWaveform{settings}), sampled = echoes(apart, FullWaveform{settings});
    REQUIRE(exact.size() == 2);
    REQUIRE(sampled.size() == 2);
    row(Kind::consistency, std::string("AnalyticWaveform, ") + text, apart, exact[1].range - exact[0].range, 1e-6);
    row(Kind::consistency, std::string("FullWaveform, ") + text, apart, sampled[1].range - sampled[0].range, 1e-6);
  }
}
