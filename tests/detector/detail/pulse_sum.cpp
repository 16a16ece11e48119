// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/detector/detail/pulse_sum.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <doctest/doctest.h>

#include "support/generators.hpp"

using namespace pulsecast;

namespace {

double received(const std::vector<Reflection>& reflections, const PulseShape& shape, double time) {
  double sum = 0;
  for (const Reflection& r : reflections) sum += r.power * shape(time - arrival(r));
  return sum;
}

}  // namespace

TEST_CASE("reflections are sorted by range, and what cannot be an echo is left out") {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  std::vector<Reflection> all{{30, 1, 3},  {10, 0, 9},   {10, 1, 1},   {infinity, 1, 9}, {20, 1, 2},
                              {nan, 1, 9}, {15, nan, 9}, {1e18, 1, 9}, {15, -1, 9}};
  const auto useful = in_order_of_range(all, 0.25e-9);
  REQUIRE(useful.size() == 3);
  for (std::size_t i = 0; i < 3; ++i) CHECK(useful[i].object == i + 1);
  CHECK(in_order_of_range({}, 1).empty());
}

TEST_CASE("reflections of equal ranges keep their order, up to as many as a bundle has rays") {
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    std::vector<Reflection> all(any.whole(RayBundle::capacity + 1));
    const std::uint64_t ranges = 1 + any.whole(2 * RayBundle::capacity);
    for (std::size_t i = 0; i < all.size(); ++i)
      all[i] = {0.1 + static_cast<double>(any.whole(ranges)), any.uniform(), static_cast<ObjectId>(i)};
    std::vector<Reflection> expected = all;
    const auto nearer = [](const Reflection& a, const Reflection& b) { return a.range < b.range; };
    std::stable_sort(expected.begin(), expected.end(), nearer);
    const auto sorted = in_order_of_range(all, 0.25e-9);
    REQUIRE(sorted.size() == expected.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
      CHECK(sorted[i].range == expected[i].range);
      CHECK(sorted[i].power == expected[i].power);
      CHECK(sorted[i].object == expected[i].object);
    }
  }
}

TEST_CASE("more reflections than a bundle has rays are sorted, too") {
  support::Generator any(1);
  std::vector<Reflection> all(3 * RayBundle::capacity);
  for (Reflection& r : all) r = {any.uniform(1, 2), 1};
  const auto sorted = in_order_of_range(all, 0.25e-9);
  REQUIRE(sorted.size() == all.size());
  for (std::size_t i = 1; i < sorted.size(); ++i) CHECK(sorted[i - 1].range <= sorted[i].range);
}

TEST_CASE("sums of pulses, sample by sample, are those of their definition, wherever the samples begin") {
  const PulseShape shape(4e-9);
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    std::vector<Reflection> reflections(1 + any.whole(20));
    const double start = any.log_uniform(1, 1000), spread = any.log_uniform(0.01, 30),
                 interval = any.log_uniform(0.01e-9, 2e-9);
    for (Reflection& r : reflections) r = {start + any.uniform(0, spread), any.log_uniform(0.1, 10)};
    REQUIRE(in_order_of_range(reflections, interval).size() == reflections.size());
    double first = SampledSum::first_sample(reflections.front(), shape, interval);
    CHECK(first * interval < arrival(reflections.front()) - 2 * shape.tau);
    if (any.coin()) first += static_cast<double>(any.whole(100));
    SampledSum sum(reflections, shape, interval, 0, first);
    for (int n = 0; n < 200; ++n) {
      CHECK(sum.sample() == first + n);
      const double time = sum.time(), power = sum.power();
      CHECK(std::fabs(power - received(reflections, shape, time)) < 1e-9);
      std::size_t in = 0;
      while (in < reflections.size() && arrival(reflections[in]) - 2 * shape.tau <= time) ++in;
      CHECK(sum.next() == in);
      CHECK(sum.all_in() == (in == reflections.size()));
      if (in > 0) CHECK(sum.last_peak() == arrival(reflections[in - 1]));
    }
  }
}
