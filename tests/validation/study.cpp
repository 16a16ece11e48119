// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// The truth of the trade-off study, bench/study/truth.hpp, against closed forms, and the score of its echoes.

#include <cmath>
#include <vector>

#include <doctest/doctest.h>

#include "../../bench/study/score.hpp"

using namespace pulsecast;
using namespace tradeoff;

namespace {

const Instrument instrument{.laser = {.pulse_length = 4e-9, .divergence = 0.5e-3}};
constexpr double range = 1000, radius = 0.25;  // of the beam there [m]

Plane facing(double at, double reflectance = 0.5) { return {{0, at, 0}, {0, -1, 0}, reflectance}; }

Lit light(const std::vector<Surface>& surfaces, const Instrument& by = instrument, std::size_t points = 40'000) {
  return light_of(surfaces, {}, by, {}, quadrature(points, true));
}
double total(const Lit& lit) {
  double sum = 0;
  for (const auto& part : lit.parts) sum += part.second;
  return sum;
}

}  // namespace

TEST_CASE("both quadratures of the study have the energy and the second moments of a Gaussian beam") {
  for (const bool edges : {false, true}) {
    double energy = 0;
    Vec2 squares{};
    double mixed = 0;
    for (const Place& place : quadrature(40'000, edges)) {
      energy += place.share;
      squares += place.share * place.at * place.at;
      mixed += place.share * place.at.x * place.at.y;
    }
    CHECK(energy == doctest::Approx(1).epsilon(1e-6));
    CHECK(squares.x == doctest::Approx(0.25).epsilon(1e-5));
    CHECK(squares.y == doctest::Approx(0.25).epsilon(1e-5));
    CHECK(std::fabs(mixed) < 1e-5);
  }
}

TEST_CASE("the energy past an edge is the error function's, also of a beam with a waist") {
  Instrument waist = instrument;
  waist.laser.waist_diameter = 0.4;
  for (const Instrument& by : {instrument, waist}) {
    const double wide = std::hypot(by.laser.waist_diameter / 2, radius);
    for (const double off : {-1.0, -0.3, 0.0, 0.7}) {
      Plane half = facing(range);
      half.point.x = off * wide;
      half.inwards = {1, 0, 0};
      const double share = 0.5 * std::erfc(std::sqrt(2.0) * off);
      CHECK(total(light({half}, by)) / total(light({facing(range)}, by)) == doctest::Approx(share).epsilon(2e-3));
    }
  }
}

TEST_CASE("a wall is one echo at its range and with its reflectance, by either definition") {
  for (const EchoRule& rule : {EchoRule{}, EchoRule{.divisor = 3.5, .window = 0.5, .by_mean = true}}) {
    const Points echoes = echoes_of(light({facing(50, 0.3)}), instrument, rule);
    REQUIRE(echoes.size() == 1);
    CHECK(echoes[0].range == doctest::Approx(50).epsilon(2e-7));  // but for the rays aslant
    CHECK(echoes[0].intensity == doctest::Approx(0.3).epsilon(1e-4));
  }
}

TEST_CASE("two surfaces far apart are two echoes, each of its share of the beam; close ones are one") {
  Plane half = facing(range);
  half.inwards = {0, 0, 1};
  const Points apart = echoes_of(light({half, facing(range + 5)}), instrument, {});
  REQUIRE(apart.size() == 2);
  CHECK(apart[0].range == doctest::Approx(range).epsilon(1e-7));
  CHECK(apart[1].range == doctest::Approx(range + 5).epsilon(1e-7));
  CHECK(apart[0].intensity == doctest::Approx(0.25).epsilon(2e-3));
  CHECK(apart[1].intensity == doctest::Approx(0.25).epsilon(2e-3));
  CHECK(echoes_of(light({half, facing(range + 0.2)}), instrument, {}).size() == 1);
}

TEST_CASE("light from a slope has the spread of the beam on it, and no other one") {
  const double incidence = 60 * pi / 180;
  const Plane slope{{0, range, 0}, {std::sin(incidence), -std::cos(incidence), 0}, 0.5};
  const Lit lit = light({slope});
  double mean = 0, square = 0;
  for (const auto& [at, power] : lit.parts) mean += at * power / total(lit);
  for (const auto& [at, power] : lit.parts) square += (at - mean) * (at - mean) * power / total(lit);
  CHECK(mean == doctest::Approx(range).epsilon(1e-6));
  CHECK(std::sqrt(square) == doctest::Approx(0.5 * radius * std::tan(incidence)).epsilon(1e-3));
}

TEST_CASE("rays meet balls and wires where circles say") {
  const Vec3 ray{0, 1, 0};
  const Answer ball = answer(Sphere{{0.3, 10, 0.4}, 1, 0.6}, {}, ray);
  CHECK(ball.range == doctest::Approx(10 - std::sqrt(0.75)));
  CHECK(ball.backscatter == doctest::Approx(0.6 * std::sqrt(0.75)));
  const Answer wire = answer(Cylinder{{0.6, 10, 7}, {0, 0, 1}, 1, 0.5}, {}, ray);
  CHECK(wire.range == doctest::Approx(9.2));
  CHECK(wire.backscatter == doctest::Approx(0.4));
  const double c = std::cos(0.5), s = std::sin(0.5);  // aslant along the ray: the circle becomes an ellipse
  const Answer aslant = answer(Cylinder{{0.6, 10, 0}, {0, s, c}, 1, 0.5}, {}, ray);
  CHECK(aslant.range == doctest::Approx(10 - 0.8 / c));
  CHECK(aslant.backscatter == doctest::Approx(0.5 * 0.8 * c));
  CHECK_FALSE(std::isfinite(answer(Sphere{{2, 10, 0}, 1}, {}, ray).range));
  CHECK_FALSE(std::isfinite(answer(Cylinder{{2, 10, 0}, {0, 0, 1}, 1}, {}, ray).range));
}

TEST_CASE("a lost or an invented echo costs half the resolution, and a pair at most both") {
  const auto cost = [](const Points& truth, const Points& found) {
    Sums sums;
    std::vector<double> sizes;
    sums.add(truth, found, 0.6, sizes);
    return sums;
  };
  CHECK(cost({{10, 1}, {12, 1}}, {{10, 1}, {12, 1}}).cost == 0);
  CHECK(cost({{10, 1}, {12, 1}}, {{12.1, 1}}).cost == doctest::Approx(0.3 + 0.1));
  CHECK(cost({{10, 1}, {12, 1}}, {{12.1, 1}}).lost == 1);
  CHECK(cost({{10, 1}}, {{10.5, 1}}).cost == doctest::Approx(0.5));
  CHECK(cost({{10, 1}}, {{10.7, 1}}).cost == doctest::Approx(0.6));
  CHECK(cost({{10, 1}}, {{10.7, 1}}).pairs == 0);
  const Sums crowd = cost({{10, 1}, {10.4, 1}}, {{10.35, 0.5}, {10.45, 1}, {20, 1}});
  CHECK(crowd.cost == doctest::Approx(0.35 + 0.05 + 0.3));  // in order, not the nearest first
  CHECK(crowd.invented == 1);
  CHECK(crowd.brighter == doctest::Approx(0.5));
}

TEST_CASE("the bootstrap finds the spread of a mean of clusters") {
  Clusters clusters;
  for (int k = 0; k < 100; ++k) {
    clusters.emplace_back();
    clusters.back().cost = k % 2 == 0 ? 0 : 2;
    clusters.back().echoes = 1;
  }
  const Interval score = interval_of(Bootstrap(100, 0)(clusters, [](const Sums& s) { return s.score(); }));
  CHECK(score.middle == doctest::Approx(1));
  CHECK(score.low == doctest::Approx(1 - 0.196).epsilon(0.05));
  CHECK(score.high == doctest::Approx(1 + 0.196).epsilon(0.05));
  CHECK_FALSE(score.less());
}
