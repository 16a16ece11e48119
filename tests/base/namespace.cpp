// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/base/namespace.hpp>

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>

#include <doctest/doctest.h>

#include "support/mixed_instructions.hpp"

using namespace pulsecast;

namespace {

/// Two files of a program share no function of the library and no name of a type, and give the same bits.
void check_apart(const support::AnswerOfFile& own, const support::AnswerOfFile& other) {
  CHECK(own.function != other.function);
  CHECK(std::string(own.pose) != other.pose);
  REQUIRE(own.count > 1000);
  REQUIRE(own.count == other.count);
  for (std::size_t i = 0; i < own.count; ++i) {
    CAPTURE(i);
    REQUIRE(std::bit_cast<std::uint64_t>(own.numbers[i]) == std::bit_cast<std::uint64_t>(other.numbers[i]));
  }
}

}  // namespace

TEST_CASE(
    "files compiled with other settings of GLM and of the standard library have functions and types of their own, and "
    "the same bits") {
  check_apart(support::answer_of_this_file(), support::answer_of_other_settings());
}

#if defined(PULSECAST_MIXED_INSTRUCTIONS) && !defined(__FMA__)  // there is a file for AVX2, and others contract nothing
TEST_CASE(
    "files compiled for different instruction sets have functions and types of their own, and give the same bits") {
  if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma")) return;
  check_apart(support::answer_of_this_file(), support::answer_of_avx2());
}
#endif

// What compilers are told by options is in tests/compile_fail/fast_math.cpp.
TEST_CASE("arithmetic has infinities, rays of NaN, an order, and numbers below the least normal one") {
  volatile double zero = 0, large = 1e16, least = std::numeric_limits<double>::min();
  const double infinity = 1 / zero, nothing = infinity - infinity;
  CHECK(infinity > std::numeric_limits<double>::max());
  CHECK(std::isnan(nothing));
  CHECK_FALSE(nothing == nothing);
  CHECK(1 / -zero < 0);
  CHECK((large + 1) - large == 0);
  CHECK(least / 2 > 0);
}
