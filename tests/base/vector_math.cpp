// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/base/vector_math.hpp>

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <doctest/doctest.h>

#include "support/generators.hpp"
#include "support/relative.hpp"

using namespace pulsecast;

#pragma GCC diagnostic ignored "-Wpsabi"  // of vectors wider than a register: all that return some are inlined

namespace {
constexpr double infinity = std::numeric_limits<double>::infinity(),
                 not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double least = std::numeric_limits<double>::denorm_min(), tiny = std::numeric_limits<double>::min();

/// Distance to the expected value in units in the last place of its double.
double ulps(double value, long double expected) {
  const double rounded = static_cast<double>(expected);
  if (std::isnan(rounded) || std::isnan(value)) return std::isnan(rounded) && std::isnan(value) ? 0 : infinity;
  if (value == rounded) return std::signbit(value) == std::signbit(rounded) ? 0 : infinity;
  const double size = std::fabs(rounded), ulp = size < tiny ? least : size - std::nextafter(size, 0.0);
  return static_cast<double>(std::fabs(static_cast<long double>(value) - expected)) / ulp;
}
bool same_bits(double a, double b) {
  return (std::isnan(a) && std::isnan(b)) || std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}
double signed_log_uniform(support::Generator& any, double from, double to) {
  return any.uniform(-1, 1) < 0 ? -any.log_uniform(from, to) : any.log_uniform(from, to);
}

/// True if each lane that f sets from x and y has the bits that f gives of that lane alone.
template <std::size_t N, class F>
bool lanes_agree(const F& f, const double (&x)[8], const double (&y)[8]) {
  bool agree = true;
  for (std::size_t first = 0; first < 8; first += N) {
    using V = simd::Vec<double, N>;
    V all, a, b;
    simd::fill(a, x[first]);
    simd::fill(b, y[first]);
    f(all, a, b);
    for (std::size_t lane = 0; lane < N; ++lane) {
      double one = 0;
      f(one, x[first + lane], y[first + lane]);
      agree &= same_bits(all[lane], one);
    }
  }
  return agree;
}
}  // namespace

TEST_CASE("sines and cosines err by at most 1 ulp") {
  for (std::uint64_t seed = 0; seed < 100000; ++seed) {
    support::Generator any(seed);
    const double multiple = std::floor(any.uniform(-60000, 60000)) * (pi / 2);
    for (const double x :
         {any.uniform(-10, 10), signed_log_uniform(any, 1e-300, 1e5), multiple, std::nextafter(multiple, infinity)}) {
      CAPTURE(seed);
      CAPTURE(x);
      const auto [sine, cosine] = simd::sincos(x);
      REQUIRE(ulps(sine, std::sin(static_cast<long double>(x))) <= 1);
      REQUIRE(ulps(cosine, std::cos(static_cast<long double>(x))) <= 1);
    }
  }
}

TEST_CASE("sines and cosines are exact at zero, and defined everywhere") {
  for (const double x : {0.0, -0.0, least, -least, tiny}) {
    CHECK(same_bits(simd::sin(x), x));
    CHECK(simd::cos(x) == 1);
  }
  for (const double x : {infinity, -infinity, not_a_number}) {
    CHECK(std::isnan(simd::sin(x)));
    CHECK(std::isnan(simd::cos(x)));
  }
  for (const double x : {1e7, -1e9, 1e22, 1e300}) {
    CHECK(simd::sin(x) == std::sin(x));
    CHECK(simd::cos(x) == std::cos(x));
  }
  for (int k = -8; k <= 8; ++k) {
    CHECK(ulps(simd::sin(k * (pi / 2)), std::sin(static_cast<long double>(k * (pi / 2)))) <= 0.51);
    CHECK(ulps(simd::cos(k * (pi / 2)), std::cos(static_cast<long double>(k * (pi / 2)))) <= 0.51);
  }
}

TEST_CASE("arctangents err by at most 2 ulp, in every quadrant") {
  for (std::uint64_t seed = 0; seed < 100000; ++seed) {
    support::Generator any(seed);
    const double x = signed_log_uniform(any, 1e-5, 1e5), wide = signed_log_uniform(any, 1e-308, 1e308);
    for (const double y : {any.uniform(-1e5, 1e5), x * any.uniform(-2, 2), x, std::nextafter(x, 0.0), wide}) {
      CAPTURE(seed);
      CAPTURE(y);
      CAPTURE(x);
      REQUIRE(ulps(simd::atan2(y, x), std::atan2(static_cast<long double>(y), static_cast<long double>(x))) <= 2);
      REQUIRE(ulps(simd::atan2(x, y), std::atan2(static_cast<long double>(x), static_cast<long double>(y))) <= 2);
    }
  }
}

TEST_CASE("arctangents of zeros, infinities, subnormal numbers and NaN are those of the C library") {
  const double all[] = {0.0, -0.0, 1, -1, least, -least, 1e308, -1e308, infinity, -infinity, not_a_number};
  for (const double y : all)
    for (const double x : all) {
      CAPTURE(y);
      CAPTURE(x);
      CHECK(ulps(simd::atan2(y, x), std::atan2(y, x)) <= 1);
    }
}

TEST_CASE("logarithms err by at most 1 ulp") {
  for (std::uint64_t seed = 0; seed < 100000; ++seed) {
    support::Generator any(seed);
    for (const double x : {any.log_uniform(1e-320, 1e308), any.uniform(0, 2), 1 + any.uniform(-1e-3, 1e-3)}) {
      CAPTURE(seed);
      CAPTURE(x);
      REQUIRE(ulps(simd::log(x), std::log(static_cast<long double>(x))) <= 1);
    }
  }
  CHECK(same_bits(simd::log(1.0), 0.0));
  CHECK(simd::log(0.0) == -infinity);
  CHECK(simd::log(-0.0) == -infinity);
  CHECK(simd::log(infinity) == infinity);
  CHECK(ulps(simd::log(least), std::log(static_cast<long double>(least))) <= 1);
  for (const double x : {-1.0, -least, -infinity, not_a_number}) CHECK(std::isnan(simd::log(x)));
}

TEST_CASE("powers err by at most 4 + 2 |ln(result)| ulp") {
  for (std::uint64_t seed = 0; seed < 100000; ++seed) {
    support::Generator any(seed);
    const double base = any.uniform(0, 1), exponent = any.log_uniform(1e-3, 1e3);
    CAPTURE(seed);
    CAPTURE(base);
    CAPTURE(exponent);
    const long double expected = std::pow(static_cast<long double>(base), static_cast<long double>(exponent));
    const double size = std::fabs(exponent * std::log(base));
    if (size < 708) REQUIRE(ulps(simd::pow(base, exponent), expected) <= 4 + 2 * size);
    if (size < 708) REQUIRE(ulps(simd::pow(base, -exponent), 1 / expected) <= 4 + 2 * size);
  }
}

TEST_CASE("whole powers err by at most as many ulp as their exponent, and are those of each lane") {
  for (std::uint64_t seed = 0; seed < 10000; ++seed) {
    support::Generator any(seed);
    const double base = any.uniform(0, 1.2), other = any.uniform(0, 1.2);
    for (unsigned exponent = 0; exponent <= 64; ++exponent) {
      CAPTURE(seed);
      CAPTURE(exponent);
      const double power = simd::whole_power(base, exponent);
      const long double expected = std::pow(static_cast<long double>(base), static_cast<long double>(exponent));
      if (expected > 1e-300L) REQUIRE(ulps(power, expected) <= exponent);
      const simd::Vec<double, 2> both = simd::whole_power(simd::Vec<double, 2>{other, base}, exponent);
      REQUIRE(same_bits(both[1], power));
    }
  }
}

TEST_CASE("powers of zero and infinity, and to zero and infinity, are those of the C library") {
  const double bases[] = {0.0, 0.5, 1, 2, infinity, not_a_number},
               exponents[] = {0.0, -0.0, 1, -1, 2000, -2000, infinity, -infinity, not_a_number};
  for (const double base : bases)
    for (const double exponent : exponents) {
      CAPTURE(base);
      CAPTURE(exponent);
      CHECK(ulps(simd::pow(base, exponent), std::pow(base, exponent)) <= 4);
    }
  CHECK(std::isnan(simd::pow(-1.0, 2.0)));
}

TEST_CASE("whole numbers and square roots are those of the C library") {
  for (std::uint64_t seed = 0; seed < 20000; ++seed) {
    support::Generator any(seed);
    const double near = std::floor(any.uniform(-1e6, 1e6)) + 0.5;
    for (const double x : {any.uniform(-3, 3), near, signed_log_uniform(any, 1e-300, 1e300), 0.0, -0.0, infinity,
                           -infinity, not_a_number}) {
      CAPTURE(seed);
      CAPTURE(x);
      REQUIRE(same_bits(simd::round(x), std::nearbyint(x)));
      REQUIRE(same_bits(simd::floor(x), std::floor(x)));
      const double all[8] = {x, x, x, x, x, x, x, x};
      simd::Vec<double, 8> roots;
      simd::fill(roots, all[0]);
      roots = simd::sqrt(roots);
      for (std::size_t lane = 0; lane < 8; ++lane) REQUIRE(same_bits(roots[lane], std::sqrt(x)));
    }
  }
}

TEST_CASE("a lane has the bits of the plain number, however many lanes there are") {
  if (support::contracted()) return;  // then the last bits are the compiler's choice
  const auto agree = [](const auto& f, const double(&x)[8], const double(&y)[8]) {
    return lanes_agree<2>(f, x, y) && lanes_agree<4>(f, x, y) && lanes_agree<8>(f, x, y);
  };
  const double edges[] = {0.0, -0.0, infinity, -infinity, not_a_number, 1, least, 1e7};
  for (std::uint64_t seed = 0; seed < 20000; ++seed) {
    support::Generator any(seed);
    double x[8], y[8];
    for (std::size_t k = 0; k < 8; ++k) {
      x[k] = any.uniform(0, 1) < 0.1 ? edges[k] : signed_log_uniform(any, 1e-6, 1e6);
      y[k] = any.uniform(0, 1) < 0.1 ? edges[k] : signed_log_uniform(any, 1e-6, 1e6);
    }
    CAPTURE(seed);
    REQUIRE(agree([](auto& out, const auto& a, const auto&) { out = simd::sin(a); }, x, y));
    REQUIRE(agree([](auto& out, const auto& a, const auto&) { out = simd::cos(a); }, x, y));
    REQUIRE(agree([](auto& out, const auto& a, const auto& b) { out = simd::atan2(a, b); }, x, y));
    REQUIRE(agree([](auto& out, const auto& a, const auto&) { out = simd::log(a); }, x, y));
    REQUIRE(agree([](auto& out, const auto& a, const auto& b) { out = simd::pow(a, b); }, x, y));
    REQUIRE(agree([](auto& out, const auto& a, const auto&) { out = simd::floor(a); }, x, y));
    REQUIRE(agree([](auto& out, const auto& a, const auto&) { out = simd::sqrt(a); }, x, y));
  }
}
