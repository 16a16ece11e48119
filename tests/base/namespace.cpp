// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/base/namespace.hpp>

#include <bit>
#include <cstddef>
#include <cstdint>

#include <doctest/doctest.h>

#if defined(PULSECAST_MIXED_INSTRUCTIONS) && !defined(__FMA__)  // there is a file for AVX2, and others contract nothing
#include "support/mixed_instructions.hpp"

using namespace pulsecast;

TEST_CASE("files compiled for different instruction sets have functions of their own, and give the same bits") {
  if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma")) return;
  const support::AnswerOfFile own = support::answer_of_this_file(), avx2 = support::answer_of_avx2();
  CHECK(own.function != avx2.function);
  REQUIRE(own.numbers.size() > 1000);
  REQUIRE(own.numbers.size() == avx2.numbers.size());
  for (std::size_t i = 0; i < own.numbers.size(); ++i) {
    CAPTURE(i);
    REQUIRE(std::bit_cast<std::uint64_t>(own.numbers[i]) == std::bit_cast<std::uint64_t>(avx2.numbers[i]));
  }
}
#else
TEST_CASE("a program for one instruction set has one namespace") {}
#endif
