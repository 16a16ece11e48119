// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/detector/echo_timing.hpp>

#include <cmath>
#include <cstddef>
#include <vector>

#include <doctest/doctest.h>

using namespace pulsecast;

namespace {

/// A Gaussian of height 8 and deviation 5 samples about a place.
std::vector<double> gaussian(double place) {
  std::vector<double> y(60);
  for (std::size_t i = 0; i < y.size(); ++i)
    y[i] = 8 * std::exp(-0.5 * std::pow((static_cast<double>(i) - place) / 5, 2));
  return y;
}

}  // namespace

TEST_CASE("each timing finds its point of a Gaussian, between the samples") {
  for (const double place : {29.6, 29.9, 30.0, 30.3}) {
    const auto y = gaussian(place);
    const detail::Vertex top = detail::vertex(&y[30]);
    CAPTURE(place);
    const auto time = [&](EchoTiming timing) { return detail::echo_time(timing, y, 30, top, 2, 0.5); };
    CHECK(top.height == doctest::Approx(8).epsilon(1e-4));
    CHECK(std::fabs(time(EchoTiming::peak) - place) < 1e-3);
    CHECK(time(EchoTiming::true_range) == time(EchoTiming::peak));
    CHECK(std::fabs(time(EchoTiming::leading_edge) - (place - 5 * std::sqrt(2 * std::log(4.0)))) < 1e-3);
    CHECK(std::fabs(time(EchoTiming::constant_fraction) - (place - 5 * std::sqrt(2 * std::log(2.0)))) < 1e-3);
    CHECK(std::fabs(time(EchoTiming::centroid) - place) < 1e-2);
  }
}

TEST_CASE("a rise is sought no further than the window, or than a higher peak") {
  const std::vector<double> falls{9, 7, 4, 5, 6, 5};
  CHECK(detail::rise_before(falls, 4, 4.5) == doctest::Approx(2.5).epsilon(0.2));
  CHECK(detail::rise_before(falls, 4, 1) == 2);  // the flank of a higher one
  const std::vector<double> rises{3, 4, 5, 4};
  CHECK(detail::rise_before(rises, 2, 1) == 0);
  CHECK(detail::rise_before(rises, 2, 3.5) == doctest::Approx(0.5));
}

TEST_CASE("a centroid is that of what exceeds the level") {
  const std::vector<double> y{0, 1, 4, 5, 3, 1, 0};
  CHECK(detail::centroid_about(y, 3, 1) == doctest::Approx((3 * 2 + 4 * 3 + 2 * 4) / 9.0));
  CHECK(detail::centroid_about(y, 3, 0) == doctest::Approx((1 * 1 + 4 * 2 + 5 * 3 + 3 * 4 + 1 * 5) / 14.0));
}

TEST_CASE("a quartic without a maximum gives the parabola's vertex") {
  const std::vector<double> y{5, 0, 1, 0, 5};
  const detail::Vertex top = detail::vertex(&y[2]);
  CHECK(top.offset == 0);
  CHECK(top.height == 1);
}
