// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/scanner/footprint.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <doctest/doctest.h>

#include "support/laws.hpp"
#include "support/relative.hpp"

using namespace pulsecast;

static_assert(Footprint<SingleRay> && Footprint<RingFootprint> && Footprint<SunflowerFootprint> &&
              Footprint<LatticeFootprint> && Footprint<WithSubrayRecord<RingFootprint>> &&
              Footprint<TurnedFootprint<LatticeFootprint>>);

namespace {

double radius(const Vec2& offset) { return std::hypot(offset.x, offset.y); }

}  // namespace

TEST_CASE("all footprints keep the law, of any size") {
  CHECK(support::footprint_laws(SingleRay{}) == "");
  for (const std::size_t n : {1U, 2U, 3U, 4U, 7U, 20U, 50U}) {
    CAPTURE(n);
    CHECK(support::footprint_laws(RingFootprint(n)) == "");
    CHECK(support::footprint_laws(SunflowerFootprint(n)) == "");
    CHECK(support::footprint_laws(LatticeFootprint(n)) == "");
  }
  CHECK(support::footprint_laws(SunflowerFootprint(100000)) == "");
  CHECK(support::footprint_laws(LatticeFootprint(100000)) == "");
}

TEST_CASE("a single ray is on the axis") {
  CHECK(SingleRay{}.size() == 1);
  CHECK(SingleRay{}.offset(0) == Vec2{0, 0});
  CHECK(RingFootprint(1).offset(0) == Vec2{0, 0});
  CHECK(SunflowerFootprint(1).offset(0) == Vec2{0, 0});
  CHECK(LatticeFootprint(1).offset(0) == Vec2{0, 0});
}

TEST_CASE("ring i of a footprint holds floor(2 pi i) subrays about the central one") {
  CHECK(RingFootprint(1).size() == 1);
  CHECK(RingFootprint(2).size() == 1 + 6);
  CHECK(RingFootprint(3).size() == 1 + 6 + 12);
  CHECK(RingFootprint(4).size() == 1 + 6 + 12 + 18);
  CHECK(RingFootprint(5).size() == 1 + 6 + 12 + 18 + 25);
  CHECK(RingFootprint().size() == 19);
}

TEST_CASE("rings are a ring's width apart, the first subray of each stands up, and the energy is centred") {
  const RingFootprint f(4);
  CHECK(f.offset(0) == Vec2{0, 0});
  std::size_t j = 1;
  for (const std::size_t ring : {1U, 2U, 3U}) {
    const auto count = static_cast<std::size_t>(std::floor(2 * pi * static_cast<double>(ring)));
    CHECK(std::fabs(f.offset(j).x) < 1e-15);
    CHECK(f.offset(j).y > 0);
    for (std::size_t k = 0; k < count; ++k, ++j) {
      CHECK(radius(f.offset(j)) == support::relative(static_cast<double>(ring) / 3.5, 1e-14));
      CHECK(f.share(j) == f.share(j - k));
    }
  }
  CHECK(j == f.size());
}

TEST_CASE("the energy inside of a ring is that of a Gaussian beam") {
  const RingFootprint f(6);
  double inside = 0;
  std::size_t j = 0;
  for (int ring = 0; ring < 6; ++ring) {
    const auto count = ring == 0 ? std::size_t{1} : static_cast<std::size_t>(std::floor(2 * pi * ring));
    for (std::size_t k = 0; k < count; ++k) inside += f.share(j++);
    const double outer = (ring + 0.5) / 5.5;
    // Source: the integral of exp(-2 r^2) r dr, as a share of that to r = 1
    CHECK(inside == support::relative(std::expm1(-2 * outer * outer) / std::expm1(-2.0), 1e-13));
  }
}

TEST_CASE("the middle of every footprint's energy is on the axis") {
  const auto middle = [](const auto& f) {
    Vec2 sum{};
    for (std::size_t j = 0; j < f.size(); ++j) sum += f.share(j) * f.offset(j);
    return std::hypot(sum.x, sum.y);
  };
  for (const std::size_t n : {1U, 2U, 7U, 19U, 62U, 1000U}) CHECK(middle(SunflowerFootprint(n)) < 1e-15);
  for (const std::size_t n : {1U, 2U, 7U, 19U, 62U, 1000U}) CHECK(middle(LatticeFootprint(n)) < 1e-15);
  for (const std::size_t n : {1U, 2U, 3U, 5U, 10U}) CHECK(middle(RingFootprint(n)) < 1e-15);
}

TEST_CASE("a sunflower's subrays carry equal energy and spread as a Gaussian beam does") {
  const std::size_t n = 20000;
  const SunflowerFootprint f(n);
  REQUIRE(f.size() == n);
  double second_moment = 0;
  std::size_t inside = 0;
  for (std::size_t j = 0; j < n; ++j) {
    REQUIRE(f.share(j) == f.share(0));
    if (j > 0)
      REQUIRE(radius(f.offset(j)) > radius(f.offset(j - 1)) - 5e-4);  // but for the map of the whole to the moments
    second_moment += f.share(j) * std::pow(radius(f.offset(j)), 2);
    inside += radius(f.offset(j)) < 1;
  }
  // Source: the mean of r^2 over exp(-2 r^2) r dr is 1/2, and 1 - exp(-2) of it is inside of r = 1
  CHECK(second_moment == support::relative(0.5, 1e-3));
  CHECK(static_cast<double>(inside) / n == support::relative(1 - std::exp(-2), 1e-4));
}

TEST_CASE("the subrays of a sunflower are at the middles of equal energies, a golden angle apart") {
  const SunflowerFootprint f(2);
  const double first = std::sqrt(-0.5 * std::log(1 - 0.25)), second = std::sqrt(-0.5 * std::log(1 - 0.75));
  const double apart =
      std::sqrt(first * first + second * second - 2 * first * second * std::cos(pi * (3 - std::sqrt(5.0))));
  const Vec2 between = f.offset(1) - f.offset(0);
  CHECK(std::hypot(between.x, between.y) == support::relative(apart, 1e-14));
}

TEST_CASE("a lattice's subrays carry equal energy and spread as a Gaussian beam does, across and up") {
  const std::size_t n = 20000;
  const LatticeFootprint f(n);
  REQUIRE(f.size() == n);
  double xx = 0, yy = 0, xy = 0;
  std::size_t inside = 0;
  for (std::size_t j = 0; j < n; ++j) {
    REQUIRE(f.share(j) == f.share(0));
    if (j > 0)
      REQUIRE(f.offset(j).x >
              f.offset(j - 1).x - 5e-4);  // each has a column of its own, but for the map to the moments
    const Vec2 offset = f.offset(j);
    xx += f.share(j) * offset.x * offset.x;
    yy += f.share(j) * offset.y * offset.y;
    xy += f.share(j) * offset.x * offset.y;
    inside += radius(offset) < 1;
  }
  // Source: the variance across and up of exp(-2 r^2) is 1/4, and 1 - exp(-2) of it is inside of r = 1
  CHECK(xx == support::relative(0.25, 1e-3));
  CHECK(yy == support::relative(0.25, 1e-3));
  CHECK(std::fabs(xy) < 3e-4);
  CHECK(static_cast<double>(inside) / n == support::relative(1 - std::exp(-2), 1e-3));
}

TEST_CASE("a lattice knows edges and wires, upright and level, as well as rings of twice as many subrays") {
  const auto inside = [](double x) { return 0.5 * std::erfc(-std::sqrt(2.0) * x); };
  // root of the mean square error of the energy past edges, or onto wires of a width, that stand all over the beam
  const auto error = [&](const auto& f, double width) {
    constexpr int places = 401;
    double squares = 0;
    for (int k = 0; k < 2 * places; ++k) {
      const double at = -1.0001 + 2.0 * (k / 2) / (places - 1), end = width > 0 ? at + width : 10;
      double found = 0;
      for (std::size_t j = 0; j < f.size(); ++j) {
        const double aside = k % 2 == 0 ? f.offset(j).x : f.offset(j).y;
        if (aside > at && aside < end) found += f.share(j);
      }
      squares += std::pow(found - (inside(end) - inside(at)), 2);
    }
    return std::sqrt(squares / (2 * places));
  };
  for (const double width : {0.0, 0.2, 0.4, 0.6}) {  // 0 for an edge
    CAPTURE(width);
    CHECK(error(LatticeFootprint(9), width) < error(RingFootprint(3), width));    // of 19
    CHECK(error(LatticeFootprint(18), width) < error(RingFootprint(4), width));   // of 37
    CHECK(error(LatticeFootprint(31), width) < error(RingFootprint(5), width));   // of 62
    CHECK(error(LatticeFootprint(46), width) < error(RingFootprint(10), width));  // of 279
  }
}

TEST_CASE("a footprint without subrays is refused") {
  CHECK_THROWS_AS(LatticeFootprint(0), SettingError);
  CHECK_THROWS_AS(LatticeFootprint(100001), SettingError);
  CHECK_THROWS_AS(RingFootprint(0), SettingError);
  CHECK_THROWS_AS(SunflowerFootprint(0), SettingError);
}

TEST_CASE("a footprint that is recorded is the same footprint") {
  const WithSubrayRecord footprint{SunflowerFootprint{30}};
  CHECK(support::footprint_laws(footprint) == "");
  CHECK(footprint.size() == 30);
  CHECK(footprint.offset(7) == SunflowerFootprint{30}.offset(7));
}

TEST_CASE("second moments are those of a Gaussian beam: a quarter of the squared radius") {
  struct Moments {
    double across = 0, up = 0, mixed = 0;
  };
  const auto moments = [](const auto& footprint) {
    Moments m;
    for (std::size_t j = 0; j < footprint.size(); ++j) {
      const Vec2 at = footprint.offset(j);
      m.across += footprint.share(j) * at.x * at.x;
      m.up += footprint.share(j) * at.y * at.y;
      m.mixed += footprint.share(j) * at.x * at.y;
    }
    return m;
  };
  const auto check = [](const Moments& m, std::size_t subrays) {
    CAPTURE(subrays);
    CHECK(std::fabs(4 * m.across - 1) < 1e-12);
    CHECK(std::fabs(4 * m.up - 1) < 1e-12);
    CHECK(std::fabs(4 * m.mixed) < 1e-12);
  };
  for (const std::size_t n : {3UL, 4UL, 5UL, 7UL, 19UL, 37UL, 100UL, 1001UL, 20011UL}) {
    check(moments(LatticeFootprint(n)), n);
    check(moments(SunflowerFootprint(n)), n);
  }
  for (const std::size_t circles : {2UL, 3UL, 5UL, 40UL})
    check(moments(RingFootprint(circles, RingMoments::whole)), circles);
  const Moments within = moments(RingFootprint(3));
  CHECK(4 * within.across == doctest::Approx(0.68).epsilon(0.03));
  CHECK(RingFootprint(1, RingMoments::whole).offset(0) == Vec2{0, 0});
}
