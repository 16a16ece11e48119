// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/base/random.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <doctest/doctest.h>

#include "support/relative.hpp"

using namespace pulsecast;

namespace {

using Words = std::array<std::uint32_t, 4>;

// Source: Random123 1.14, kat_vectors, philox4x32 10
static_assert(detail::philox({0, 0, 0, 0}, {0, 0}) == Words{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8});
static_assert(detail::philox({0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff}, {0xffffffff, 0xffffffff}) ==
              Words{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd});
static_assert(detail::philox({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}) ==
              Words{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1});

struct Moments {
  double mean = 0, variance = 0, skewness = 0, kurtosis = 0;

  template <class Draw>
  Moments(std::size_t n, Draw draw) {
    std::vector<double> x(n);
    for (std::size_t i = 0; i < n; ++i) mean += x[i] = draw(i);
    mean /= static_cast<double>(n);
    for (const double v : x) {
      const double d = v - mean;
      variance += d * d;
      skewness += d * d * d;
      kurtosis += d * d * d * d;
    }
    variance /= static_cast<double>(n);
    skewness /= static_cast<double>(n) * std::pow(variance, 1.5);
    kurtosis /= static_cast<double>(n) * variance * variance;
  }
};

/// One step of Newton's method in extended precision: the quantile that z should have been.
double refined_quantile(double p, double z) {
  const long double x = z;
  const long double cdf = std::erfc(-x / std::numbers::sqrt2_v<long double>) / 2;
  const long double density =
      std::exp(-x * x / 2) * std::numbers::inv_sqrtpi_v<long double> / std::numbers::sqrt2_v<long double>;
  return static_cast<double>(x - (cdf - static_cast<long double>(p)) / density);
}

}  // namespace

TEST_CASE("the words of a key are Philox's, with pulse, subray and purpose as counter and the seed as key") {
  const RandomKey key{0x299f31d0a4093822, 0x85a308d3243f6a88, 0x13198a2e, static_cast<Purpose>(0x03707344)};
  CHECK(random_words(key) == Words{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1});
}

TEST_CASE("part 0 draws what keys without a part draw, and another part has the upper bits of the purpose's word") {
  CHECK(random_words({1, 2, 3, Purpose::free_path, 0}) == detail::philox({2, 0, 3, 3}, {1, 0}));
  CHECK(random_words({1, 2, 3, Purpose::free_path, 5}) == detail::philox({2, 0, 3, 3 + 5 * 256}, {1, 0}));
}

TEST_CASE("keys that differ in one field give different numbers, and equal keys the same") {
  const RandomKey key{1, 2, 3, Purpose::range_noise};
  CHECK(random_words(key) == random_words(RandomKey{1, 2, 3, Purpose::range_noise}));
  std::vector<Words> all{random_words(key)};
  for (int bit = 0; bit < 64; ++bit) {
    all.push_back(random_words({1 ^ (std::uint64_t{1} << bit), 2, 3, Purpose::range_noise}));
    all.push_back(random_words({1, 2 ^ (std::uint64_t{1} << bit), 3, Purpose::range_noise}));
  }
  for (int bit = 0; bit < 32; ++bit)
    all.push_back(random_words({1, 2, 3 ^ (std::uint32_t{1} << bit), Purpose::range_noise}));
  for (const Purpose other :
       {Purpose::position_noise, Purpose::attitude_noise, Purpose::free_path, Purpose::receiver_noise, Purpose::scene})
    all.push_back(random_words({1, 2, 3, other}));
  for (int bit = 0; bit < 24; ++bit)
    all.push_back(random_words({1, 2, 3, Purpose::range_noise, std::uint32_t{1} << bit}));
  std::sort(all.begin(), all.end());
  CHECK(std::adjacent_find(all.begin(), all.end()) == all.end());
}

TEST_CASE("uniform numbers are in the open interval and evenly spread") {
  const std::size_t n = 200000;
  std::array<int, 16> bins{};
  const Moments m(n, [&](std::size_t i) {
    const double u = uniform({11, i, 0, Purpose::scene});
    REQUIRE(u > 0);
    REQUIRE(u < 1);
    ++bins[static_cast<std::size_t>(u * 16)];
    return u;
  });
  const double root = std::sqrt(static_cast<double>(n));
  CHECK(std::fabs(m.mean - 0.5) < 4 * std::sqrt(1.0 / 12) / root);
  CHECK(std::fabs(m.variance - 1.0 / 12) < 4 * std::sqrt(1.0 / 180) / root);
  double chi2 = 0;
  for (const int count : bins) chi2 += std::pow(count - static_cast<double>(n) / 16, 2) / (static_cast<double>(n) / 16);
  CHECK(chi2 < 37.7);  // 15 degrees of freedom, 0.1 %
}

TEST_CASE("uniform numbers of neighbouring pulses, subrays, purposes and parts do not go together") {
  const std::size_t n = 100000;
  double pulses = 0, subrays = 0, purposes = 0, parts = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double u = uniform({5, i, 0, Purpose::range_noise}) - 0.5;
    pulses += u * (uniform({5, i + 1, 0, Purpose::range_noise}) - 0.5);
    subrays += u * (uniform({5, i, 1, Purpose::range_noise}) - 0.5);
    purposes += u * (uniform({5, i, 0, Purpose::free_path}) - 0.5);
    parts += u * (uniform({5, i, 0, Purpose::range_noise, 1}) - 0.5);
  }
  const double four_sigma = 4 * std::sqrt(static_cast<double>(n)) / 12;
  CHECK(std::fabs(pulses) < four_sigma);
  CHECK(std::fabs(subrays) < four_sigma);
  CHECK(std::fabs(purposes) < four_sigma);
  CHECK(std::fabs(parts) < four_sigma);
}

TEST_CASE("normal quantiles have their tabulated values") {
  struct Entry {
    double p, z;
  };
  const Entry table[] = {{0.975, 1.959963984540054},
                         {0.75, 0.6744897501960817},
                         {0.999, 3.090232306167813},
                         {1e-10, -6.361340902404056},
                         {0.5, 0}};
  for (const Entry& entry : table) {
    CAPTURE(entry.p);
    CHECK(std::fabs(normal_quantile(entry.p) - entry.z) <= 1e-15 * std::fabs(entry.z));
  }
}

TEST_CASE("normal quantiles undo the normal distribution to 1e-15 over three hundred decades") {
  double worst = 0;
  for (double exponent = -300; exponent < -0.31; exponent += 0.37) {
    const double p = std::pow(10, exponent), z = normal_quantile(p);
    worst = std::fmax(worst, std::fabs(z - refined_quantile(p, z)) / std::fabs(z));
  }
  for (double p = 0.001; p < 0.9999; p += 0.0013) {
    const double z = normal_quantile(p);
    worst = std::fmax(worst, std::fabs(z - refined_quantile(p, z)) / std::fabs(z));
  }
  CHECK(worst < 1e-15);
}

TEST_CASE("normal quantiles are odd about one half and ascend") {
  for (int i = 1; i < 512; ++i) CHECK(normal_quantile(i / 1024.0) == -normal_quantile(1 - i / 1024.0));
  for (int i = 1; i < 4095; ++i) CHECK(normal_quantile(i / 4096.0) < normal_quantile((i + 1) / 4096.0));
}

TEST_CASE("the extreme uniform numbers have finite logarithms and quantiles") {
  for (const double p : {0x1p-53, 1 - 0x1p-53}) {
    CHECK(std::isfinite(std::log(p)));
    CHECK(std::fabs(normal_quantile(p)) == support::relative(8.2, 0.01));
  }
}

TEST_CASE("normal numbers have the moments of the standard normal distribution") {
  const std::size_t n = 200000;
  const Moments m(n, [](std::size_t i) { return normal({3, i, 0, Purpose::range_noise}); });
  const double root = std::sqrt(static_cast<double>(n));
  CHECK(std::fabs(m.mean) < 4 / root);
  CHECK(std::fabs(m.variance - 1) < 4 * std::sqrt(2.0) / root);
  CHECK(std::fabs(m.skewness) < 4 * std::sqrt(6.0) / root);
  CHECK(std::fabs(m.kurtosis - 3) < 4 * std::sqrt(24.0) / root);
}
