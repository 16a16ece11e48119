// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/helios/detail/formula.hpp>

#include <cmath>
#include <string>

#include <doctest/doctest.h>

namespace pulsecast::helios {
namespace {

double at(const std::string& text, double t) { return Formula(text, "t")(t); }

TEST_CASE("a formula is worked out as on paper") {
  CHECK(at("1 + 2*3", 0) == 7);
  CHECK(at("(1 + 2)*3", 0) == 9);
  CHECK(at("8 - 3 - 2", 0) == 3);
  CHECK(at("16/4/2", 0) == 2);
  CHECK(at("-t^2", 3) == -9);
  CHECK(at("2^3^2", 0) == 64);  // from the left
  CHECK(at("2^-1", 0) == 0.5);
  CHECK(at("t^0", 5) == 1);
  CHECK(at(".5*t", 4) == 2);
  CHECK(at("--t", 3) == 3);
  CHECK(at("atan2(1, 2)", 0) == std::atan2(1.0, 2.0));
  CHECK(at("ln(e) + cos(pi)", 0) == std::log(std::exp(1.0)) - 1);
  CHECK(at("sqrt(abs(-t))", 9) == 3);
  CHECK(Formula("0.01*sin(2*THETA)", "THETA")(0.5) == 0.01 * std::sin(1.0));
}

TEST_CASE("what is no formula is refused with its place") {
  for (const char* text :
       {"", "1 +", "(1", "1)", "sin", "sin 2", "sine(2)", "2 t", "atan2(1)", "t..2", "*t", "1e400x", "THETA"}) {
    CAPTURE(text);
    CHECK_THROWS_AS(Formula(text, "t"), std::invalid_argument);
  }
  CHECK_THROWS_WITH(Formula("1 + foo(t)", "t"), doctest::Contains("unknown word 'foo' at character 5"));
}

TEST_CASE("a formula that is too deep is refused") {
  CHECK_THROWS_AS(Formula(std::string(1000, '(') + "1" + std::string(1000, ')'), "t"), std::invalid_argument);
  const auto nested = [](const std::string& before, std::size_t times, std::string text) {
    for (std::size_t i = 0; i < times; ++i) text = before + "(" + text + ")";
    return text;
  };
  CHECK(at(nested("1+", 100, "1"), 0) == 101);
  CHECK_THROWS_AS(Formula(nested("1+", 101, "1"), "t"), std::invalid_argument);
  CHECK(at(nested("1+1*1^", 85, "1"), 0) == 2);  // 256 numbers at once
  CHECK_THROWS_AS(Formula(nested("1+1*1^", 85, "1+1"), "t"), std::invalid_argument);
  CHECK(at(std::string(9'999, ' ') + "1", 0) == 1);
  CHECK_THROWS_AS(Formula(std::string(10'000, ' ') + "1", "t"), std::invalid_argument);
}

}  // namespace
}  // namespace pulsecast::helios
