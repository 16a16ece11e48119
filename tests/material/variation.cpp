// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/material/phong.hpp>
#include <pulsecast/material/variation.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include <doctest/doctest.h>

#include "support/relative.hpp"

using namespace pulsecast;
using namespace pulsecast::support;

TEST_CASE("variants fill the range evenly, keep the rest of the material, and can be made again") {
  const Material leaf{.name = "leaf", .reflectance = 0.5, .law = Phong{0.2}, .classification = 5};
  const std::vector<Material> variants = vary_reflectance(leaf, 10'000, 0.2, 7);
  REQUIRE(variants.size() == 10'000);
  CHECK(variants[0].name == "leaf 1");
  CHECK(variants[9'999].name == "leaf 10000");
  double sum = 0, squares = 0;
  for (const Material& m : variants) {
    REQUIRE(std::fabs(m.reflectance - 0.5) <= 0.2);
    sum += m.reflectance;
    squares += (m.reflectance - 0.5) * (m.reflectance - 0.5);
    REQUIRE(m.law.get<Phong>());
    REQUIRE(m.law.get<Phong>()->share == 0.2);
    REQUIRE(m.classification == 5);
  }
  const double deviation =
      0.2 / std::sqrt(3.0);  // of a uniform distribution, as is 0.2^2 sqrt(4 / 45) that of its square
  CHECK(std::fabs(sum / 1e4 - 0.5) < 4 * deviation / 100);
  CHECK(std::fabs(squares / 1e4 - deviation * deviation) < 4 * 0.04 * std::sqrt(4.0 / 45) / 100);

  const std::vector<Material> again = vary_reflectance(leaf, 5, 0.2, 7), others = vary_reflectance(leaf, 5, 0.2, 8);
  for (std::size_t i = 0; i < 5; ++i) {
    CHECK(again[i].reflectance == variants[i].reflectance);
    CHECK(others[i].reflectance != variants[i].reflectance);
  }
}

TEST_CASE("variants are clipped to fractions, and none is wanted without a range") {
  bool at_0 = false, at_1 = false;
  for (const Material& m : vary_reflectance({.reflectance = 0.5}, 200, 1, 1)) {
    CHECK_NOTHROW(m.validate());
    at_0 |= m.reflectance == 0;
    at_1 |= m.reflectance == 1;
  }
  CHECK(at_0);
  CHECK(at_1);
  for (const Material& m : vary_reflectance({.reflectance = 0.3}, 10, 0, 1)) CHECK(m.reflectance == 0.3);
  CHECK(vary_reflectance({}, 0, 0.1, 1).empty());
  CHECK_THROWS_AS((void)vary_reflectance({}, 3, 1.1, 1), SettingError);
  CHECK_THROWS_AS((void)vary_reflectance({}, 3, -0.1, 1), SettingError);
  CHECK_THROWS_AS((void)vary_reflectance({.reflectance = 2}, 3, 0.1, 1), SettingError);
}

TEST_CASE("a spectrum is shifted as a whole, and that of the original stays") {
  const auto spectrum =
      std::make_shared<const Spectrum>(std::vector<SpectralSample>{{0.5e-6, 0.4}, {1e-6, 0.6}, {1.5e-6, 0.95}});
  const Material original{.reflectance = 0.5, .spectrum = spectrum};
  for (const Material& m : vary_reflectance(original, 50, 0.2, 3)) {
    REQUIRE(m.spectrum);
    const double shift = m.reflectance - 0.5;
    CHECK(m.reflectance_at(0.5e-6) == relative(0.4 + shift, 1e-12));
    CHECK(m.reflectance_at(1e-6) == relative(0.6 + shift, 1e-12));
    CHECK(m.reflectance_at(1.5e-6) == relative(std::min(0.95 + shift, 1.0), 1e-12));
  }
  CHECK(spectrum->reflectance(0.5e-6) == 0.4);
}

TEST_CASE("primitives take their turns, or draw their materials evenly and reproducibly") {
  CHECK(assign_round_robin(7, 3) == std::vector<std::uint32_t>{0, 1, 2, 0, 1, 2, 0});
  CHECK(assign_round_robin(0, 3).empty());
  const std::vector<std::uint32_t> drawn = assign_randomly(30'000, 3, 11);
  CHECK(drawn == assign_randomly(30'000, 3, 11));
  CHECK(drawn != assign_randomly(30'000, 3, 12));
  for (const std::uint32_t m : {0U, 1U, 2U}) {
    const auto count = static_cast<double>(std::count(drawn.begin(), drawn.end(), m));
    CHECK(std::fabs(count - 10'000) < 4 * std::sqrt(30'000 * 2.0 / 9));  // of the binomial distribution
  }
  CHECK_THROWS_AS((void)assign_round_robin(3, 0), SettingError);
  CHECK_THROWS_AS((void)assign_randomly(3, 0, 1), SettingError);
}
