// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/detail/laz/time.hpp>

#include <bit>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include "support/generators.hpp"
#include "support/laz_reader.hpp"

namespace pulsecast::io::detail {
namespace {

using support::Generator;
using support::LazClock;
using support::LazDecoder;

std::string coded(const std::vector<std::int64_t>& times) {
  LazEncoder encoder;
  LazTimes coder(times.at(0));
  for (std::size_t i = 1; i < times.size(); ++i) coder.encode(encoder, times[i]);
  const std::vector<std::byte> bytes = std::move(encoder).finish();
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// How many of them come back as others.
std::size_t wrong(const std::vector<std::int64_t>& times) {
  LazDecoder decoder(coded(times));
  LazClock clock(static_cast<std::uint64_t>(times.at(0)));
  std::size_t count = 0;
  for (std::size_t i = 1; i < times.size(); ++i) count += clock.decode(decoder) != static_cast<std::uint64_t>(times[i]) ? 1U : 0U;
  return count + (decoder.at_end() ? 0 : 1);
}

TEST_CASE("even steps cost less than a sixth of a bit") {
  std::vector<std::int64_t> times;
  for (std::int64_t i = 0; i < 50'000; ++i) times.push_back(1'000'000'000'000 + 4711 * i);
  CHECK(wrong(times) == 0);
  CHECK(coded(times).size() * 8 * 6 < times.size());
}

TEST_CASE("two even series that take turns cost less than four bits a turn") {
  std::vector<std::int64_t> times;
  for (std::int64_t i = 0; i < 10'000; ++i) times.push_back((i % 2 == 0 ? 0 : std::int64_t{1} << 50) + 100 * i);
  CHECK(wrong(times) == 0);
  CHECK(coded(times).size() * 2 < times.size());
}

TEST_CASE("every multiple of the usual step, and what is next to it, comes back") {
  for (const std::int64_t usual : {1, -1, 7, -1000, 3'000'000}) {
    CAPTURE(usual);
    std::vector<std::int64_t> times{12345, 12345 + usual};
    for (std::int64_t multiple = -15; multiple <= 510; ++multiple)
      for (std::int64_t off = -1; off <= 1; ++off) {
        times.push_back(times.back() + multiple * usual + off);
        times.push_back(times.back() + usual);
      }
    CHECK(wrong(times) == 0);
  }
}

TEST_CASE("times of all kinds come back, real ones and any bits") {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    CAPTURE(seed);
    Generator random(seed);
    const double jump = random.log_uniform(1e-4, 1), reach = random.log_uniform(1, 9e18);
    std::vector<std::int64_t> series(1 + random.whole(7)), times;
    for (int i = 0; i < 5'000; ++i) {
      std::int64_t& time = series[random.whole(series.size())];
      if (random.uniform() < jump)
        time = static_cast<std::int64_t>(static_cast<std::uint64_t>(time) +
                                         static_cast<std::uint64_t>(static_cast<std::int64_t>(random.uniform(-reach, reach))));
      else
        time = static_cast<std::int64_t>(static_cast<std::uint64_t>(time) + 1000 * random.whole(30));
      times.push_back(time);
    }
    CHECK(wrong(times) == 0);
    double now = random.uniform(0, 1e9);
    for (std::int64_t& time : times) time = std::bit_cast<std::int64_t>(now += random.log_uniform(1e-7, 1e-3));
    CHECK(wrong(times) == 0);
  }
}

TEST_CASE("the ends of the range come back, and what wraps around") {
  constexpr std::int64_t low = std::numeric_limits<std::int64_t>::min(), high = std::numeric_limits<std::int64_t>::max();
  CHECK(wrong({0, low, high, 0, high, low, -1, 1, low + 1, high - 1, low, high}) == 0);
  constexpr std::int64_t step = std::numeric_limits<std::int32_t>::min();
  CHECK(wrong({0, step, 2 * step, 0, -step, 0, step, step - 1, 0, -1, step, 0}) == 0);
}

}  // namespace
}  // namespace pulsecast::io::detail
