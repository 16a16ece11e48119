// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/detector/phase_shift.hpp>

#include <cmath>
#include <complex>
#include <cstdint>
#include <numbers>
#include <optional>
#include <vector>

#include <doctest/doctest.h>

#include "support/detect.hpp"
#include "support/generators.hpp"
#include "support/laws.hpp"

using namespace pulsecast;

static_assert(Detector<PhaseShift>);

namespace {

std::optional<Echo> echo(const PhaseShift& detector, std::vector<Reflection> reflections, std::uint64_t pulse = 0) {
  auto w = detector.workspace(reflections.size());
  const Detection d = support::detect(detector, Laser{}, reflections, w, {.seed = 4, .pulse = pulse});
  if (d.echoes.empty()) return {};
  return d.echoes[0];
}

/// Range by the argument of the power-weighted sum of phasors, nearest to a range [m].
double by_phasors(const std::vector<Reflection>& reflections, double frequency, double near) {
  using Complex = std::complex<long double>;
  const long double wave = 2 * std::numbers::pi_v<long double> * static_cast<long double>(frequency) * 2 /
                           static_cast<long double>(speed_of_light);
  Complex sum = 0;
  for (const Reflection& r : reflections)
    sum += static_cast<long double>(r.power) * std::polar(1.0L, wave * static_cast<long double>(r.range));
  const long double period = static_cast<long double>(speed_of_light) / 2 / static_cast<long double>(frequency),
                    range = std::arg(sum) / wave;
  return static_cast<double>(range + std::round((static_cast<long double>(near) - range) / period) * period);
}

}  // namespace

TEST_CASE("a wall is in its place, up to the ambiguity, and folded beyond") {
  const PhaseShift detector;
  const double ambiguity = detector.settings().ambiguity();
  CHECK(ambiguity == doctest::Approx(149.896).epsilon(1e-5));
  for (const double range : {0.001, 0.6, 1.2491, 37.123, 100.0, 149.8}) {
    CHECK(std::fabs(echo(detector, {{.range = range, .power = 1e-6}})->range - range) < 1e-6);
    CHECK(std::fabs(echo(detector, {{.range = range + ambiguity, .power = 1e-6}})->range - range) < 1e-6);
  }
  CHECK(echo(detector, {{.range = 20, .power = 3e-6}})->amplitude == doctest::Approx(3e-6).epsilon(1e-12));
  CHECK(echo(PhaseShift{{.contrast = 0.5}}, {{.range = 20, .power = 3e-6}})->amplitude ==
        doctest::Approx(1.5e-6).epsilon(1e-12));
}

TEST_CASE("at an edge, the range is the argument of the sum of phasors") {
  const PhaseShift detector;
  support::Generator any(3);
  for (int k = 0; k < 500; ++k) {
    const double near = any.uniform(5, 50), apart = any.uniform(0, 0.3), share = any.uniform(0.05, 0.95);
    const std::vector<Reflection> edge{{.range = near, .power = share * 1e-6},
                                       {.range = near + apart, .power = (1 - share) * 1e-6}};
    const auto found = echo(detector, edge);
    REQUIRE(found);
    CAPTURE(k);
    CHECK(std::fabs(found->range - by_phasors(edge, 120e6, near)) < 1e-6);
    CHECK(found->range > near - 1e-9);
    CHECK(found->range < near + apart + 1e-9);
  }
  // surfaces half a period apart cancel
  const double half = 0.25 * speed_of_light / 120e6;
  CHECK(!echo(detector, {{.range = 10, .power = 1e-6}, {.range = 10 + half, .power = 1e-6}}));
}

TEST_CASE("noise moves the phase by its deviation over the amplitude") {
  const double power = 1e-6, deviation = 2e-9;
  const PhaseShift detector{{.deviation = deviation}};
  double squares = 0;
  constexpr int pulses = 4000;
  for (std::uint64_t k = 0; k < pulses; ++k)
    squares += std::pow(echo(detector, {{.range = 42, .power = power}}, k)->range - 42, 2);
  const double expected = 0.5 * speed_of_light / 120e6 / (2 * std::numbers::pi) * deviation / power;
  CHECK(std::sqrt(squares / pulses) == doctest::Approx(expected).epsilon(3 / std::sqrt(2.0 * pulses)));
}

TEST_CASE("an echo has the labels of the strongest, and nothing heard gives none") {
  const PhaseShift detector;
  const auto found = echo(detector, {{10, 1e-6, 1, 2, {}, 0.5}, {10.1, 2e-6, 3, 4, {}, 0.7}});
  REQUIRE(found);
  CHECK(found->object == 3);
  CHECK(found->classification == 4);
  CHECK(found->cos_incidence == 0.7);
  CHECK(!echo(detector, {}));
  CHECK(!echo(PhaseShift{{.threshold = 1e-3}}, {{.range = 10, .power = 1e-6}}));
  const std::vector<std::vector<Reflection>> cases{
      {{.range = 100, .power = 1}}, {}, {{.range = 3, .power = 1}, {.range = 5, .power = 2}}};
  CHECK(support::detector_laws(detector, Laser{}, cases) == "");
}

TEST_CASE("settings out of range are refused") {
  CHECK_THROWS_AS(PhaseShift{{.frequencies = {}}}, SettingError);
  CHECK_THROWS_AS((PhaseShift{{.frequencies = {2e6, 1e6}}}), SettingError);
  CHECK_THROWS_AS(PhaseShift{{.contrast = 0}}, SettingError);
  CHECK_THROWS_AS(PhaseShift{{.deviation = -1}}, SettingError);
}
