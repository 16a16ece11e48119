// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/detector/detail/single_peak_group.hpp>

#include <cmath>
#include <limits>
#include <vector>

#include <doctest/doctest.h>

#include "support/generators.hpp"
#include "support/relative.hpp"

using namespace pulsecast;

namespace {

const PulseShape shape(4e-9);
const double metres_per_tau = 0.5 * speed_of_light * shape.tau;
constexpr double interval = 0.25e-9;

/// The sum of all pulses at a two-way travel time, by its definition.
double received(const std::vector<Reflection>& reflections, double time) {
  double sum = 0;
  for (const Reflection& r : reflections) sum += r.power * shape(time - arrival(r));
  return sum;
}

double at(const SinglePeakGroup& group, double x) { return group.power(simd::Doubles{} + x)[0]; }

std::vector<Reflection> close_together(support::Generator& any) {
  std::vector<Reflection> reflections(1 + any.whole(40));
  const double start = any.log_uniform(1, 3000), spread = any.log_uniform(1e-6, 1.99) * metres_per_tau;
  for (Reflection& r : reflections) r = {start + any.uniform(0, spread), any.log_uniform(1e-9, 1e-7)};
  for (std::size_t k = 0; k < reflections.size(); ++k) reflections[k].object = static_cast<ObjectId>(k);
  return reflections;
}

bool one(const std::vector<Reflection>& reflections, std::size_t room = 10) {
  SinglePeakGroup::Workspace w(room);
  return SinglePeakGroup(reflections, shape, interval, w).one();
}

}  // namespace

TEST_CASE("the sum of a group is that of its pulses from the last edge on, and highest at its peak") {
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    const auto reflections = close_together(any);
    SinglePeakGroup::Workspace w(reflections.size());
    const SinglePeakGroup group(reflections, shape, interval, w);
    REQUIRE(group.one());
    double farthest = 0;
    for (const Reflection& r : reflections) farthest = std::fmax(farthest, r.range);
    CHECK(group.last_edge() == support::relative(2 * farthest / speed_of_light - 2 * shape.tau, 1e-14));
    const double peak = group.peak(), top = at(group, peak);
    CHECK(peak > 0);
    CHECK(peak <= 2 + 1e-9);
    for (double x = 0; x < 10; x += 0.01) {
      REQUIRE(at(group, x) <= top * (1 + 1e-14));
      REQUIRE(std::fabs(at(group, x) - received(reflections, group.last_edge() + x * shape.tau)) < 1e-9 * top);
    }
  }
}

TEST_CASE(
    "the range of a group is the mean by power, and its strongest reflection is that whose pulse is highest at the "
    "time") {
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    const auto reflections = close_together(any);
    SinglePeakGroup::Workspace w(reflections.size());
    const SinglePeakGroup group(reflections, shape, interval, w);
    double power = 0, weighted = 0;
    for (const Reflection& r : reflections) {
      power += r.power;
      weighted += r.power * (r.range - reflections[0].range);
    }
    CHECK(std::fabs(group.mean_range() - (reflections[0].range + weighted / power)) < 1e-12 * group.mean_range());
    const double x = any.uniform(0, 4), time = group.last_edge() + x * shape.tau;
    const auto share = [&](const Reflection& r) { return r.power * shape(time - arrival(r)); };
    const double strongest = share(group.strongest(x));
    for (const Reflection& r : reflections) REQUIRE(share(r) <= strongest * (1 + 1e-9));
  }
  // of equal ones, the first
  const std::vector<Reflection> equal{{10, 1, 5}, {10, 2, 6}, {10, 2, 7}, {10, 1, 8}, {10, 2, 9}, {10, 2, 10}};
  SinglePeakGroup::Workspace w(equal.size());
  CHECK(SinglePeakGroup(equal, shape, interval, w).strongest(2).object == 6);
}

TEST_CASE("what is no group is told from one") {
  CHECK(one({{50, 1}}));
  CHECK(one({{50, 1}, {50 + 1.999 * metres_per_tau, 1}}));
  CHECK_FALSE(one({{50, 1}, {50 + 2.001 * metres_per_tau, 1}}));
  CHECK_FALSE(one({}));
  CHECK_FALSE(one(std::vector<Reflection>(11, {50, 1})));
  CHECK(one(std::vector<Reflection>(11, {50, 1}), 11));
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  for (const double power : {0.0, -1.0, nan}) CHECK_FALSE(one({{50, 1}, {50, power}}));
  for (const double range : {nan, infinity, 1e18}) CHECK_FALSE(one({{50, 1}, {range, 1}}));
  CHECK_FALSE(one({{1e18, 1}}));
}
