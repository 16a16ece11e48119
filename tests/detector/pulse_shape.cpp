// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/detector/pulse_shape.hpp>

#include <cmath>

#include <doctest/doctest.h>

#include "support/relative.hpp"

using namespace pulsecast;

namespace {

/// Where a function that falls from `low` on reaches a value.
template <class F>
double falls_to(double value, double low, double high, F f) {
  for (int step = 0; step < 200; ++step) (f(0.5 * (low + high)) > value ? low : high) = 0.5 * (low + high);
  return 0.5 * (low + high);
}

}  // namespace

TEST_CASE("a pulse falls to half its peak after its full width at half maximum, as Newton finds it") {
  const PulseShape shape(4e-9);
  const auto half = [&](double t) {
    for (int step = 0; step < 60; ++step) {
      const double slope = (shape(t + 1e-14) - shape(t - 1e-14)) / 2e-14;
      t -= (shape(t) - 0.5) / slope;
    }
    return t;
  };
  CHECK(half(2e-9) - half(-1.5e-9) == support::relative(4e-9, 1e-9));
}

TEST_CASE("a pulse has its peak of one at time zero, two tau after its leading edge") {
  const PulseShape shape(3.5e-9, 3.5);
  CHECK(shape.tau == support::relative(1e-9, 1e-15));
  CHECK(shape(0) == support::relative(1, 1e-15));
  CHECK(shape(1e-13) < 1);
  CHECK(shape(-1e-13) < 1);
  CHECK(shape(-2e-9) == 0);
  CHECK(shape(-1) == 0);
  CHECK(shape(-1.999e-9) > 0);
  CHECK(shape(2e-9) == support::relative(16 * std::exp(-4) * std::exp(2) / 4, 1e-14));
}

TEST_CASE("a pulse is as wide at half its maximum as its tau says") {
  const PulseShape shape(4e-9);
  const double after = falls_to(0.5, 0, 1e-7, [&](double t) { return shape(t); });
  const double before = falls_to(0.5, 0, 2 * shape.tau, [&](double t) { return shape(-t); });
  // u^2 exp(-u) at half its maximum: the difference of the roots is 3.395 (the literature's 3.5 rounds)
  CHECK((after + before) / shape.tau == support::relative(3.395, 2e-4));
  const PulseShape exact(4e-9, (after + before) / shape.tau);
  CHECK(exact(after * exact.tau / shape.tau) == support::relative(0.5, 1e-12));
}

TEST_CASE("a pulse's deviation is that of its shape") {
  const PulseShape shape(4e-9);
  double sum = 0, first = 0, second = 0;
  const double step = shape.tau / 1000;
  for (double t = -2 * shape.tau; t < 60 * shape.tau; t += step) {
    sum += shape(t);
    first += t * shape(t);
    second += t * t * shape(t);
  }
  const double mean = first / sum;
  CHECK(mean ==
        support::relative(shape.tau, 1e-6));  // the mean of a gamma distribution of order 3 is one tau after its peak
  CHECK(std::sqrt(second / sum - mean * mean) == support::relative(shape.deviation(), 1e-6));
}

TEST_CASE("a pulse has fallen to a share by when it says, and stays below") {
  const PulseShape shape(4e-9);
  for (double share = 1; share > 1e-12; share *= 0.7)
    for (double later = 0; later < 20; later += 0.5)
      CHECK(shape((PulseShape::fallen_to(share) + later) * shape.tau) <= share);
}
