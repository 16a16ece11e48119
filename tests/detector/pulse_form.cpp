// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/detector/pulse_form.hpp>

#include <cmath>
#include <limits>
#include <vector>

#include <doctest/doctest.h>

using namespace pulsecast;

static_assert(PulseForm<GammaPulse> && PulseForm<GaussianPulse> && PulseForm<RectangularPulse> &&
              PulseForm<MeasuredPulse>);

namespace {
/// Times at which the power falls to half of the peak on either side, by bisection [s].
template <PulseForm Form>
double width_at_half(const Form& form, double length) {
  const auto half = [&](double out) {
    double in = 0;
    for (int i = 0; i < 100; ++i) {
      const double middle = 0.5 * (in + out);
      (form.power(middle, length) >= 0.5 ? in : out) = middle;
    }
    return in;
  };
  return half(form.end(length)) - half(form.begin(length));
}

template <PulseForm Form>
void check_form(const Form& form, double length, double negligible) {
  CHECK(form.power(0, length) == doctest::Approx(1).epsilon(1e-12));
  CHECK(width_at_half(form, length) == doctest::Approx(length).epsilon(1e-9));
  CHECK(form.begin(length) < 0);
  CHECK(form.end(length) > 0);
  CHECK(form.power(form.begin(length) * (1 + 1e-9), length) <= negligible);
  CHECK(form.power(form.end(length) * (1 + 1e-9), length) <= negligible);
  for (double t = form.begin(length); t < form.end(length); t += 0.01 * length) {
    REQUIRE(form.power(t, length) >= 0);
    REQUIRE(form.power(t, length) <= 1 + 1e-12);
  }
}
}  // namespace

TEST_CASE("pulses have their full width at half maximum, and a peak of 1 at time 0") {
  for (const double length : {0.5e-9, 4e-9, 30e-9}) {
    check_form(GammaPulse{}, length, 1e-9);
    check_form(GaussianPulse{}, length, 1e-10);
    check_form(RectangularPulse{}, length, 0);
  }
}

TEST_CASE("a gamma pulse with the divisor of the literature is shorter than it should be") {
  CHECK(width_at_half(GammaPulse{.divisor = 3.5}, 4e-9) == doctest::Approx(3.8796e-9).epsilon(1e-4));
}

TEST_CASE("a measured pulse is its table, about its peak and relative to it") {
  const MeasuredPulse pulse({{10e-9, 0}, {11e-9, 3}, {12e-9, 6}, {14e-9, 0}});
  for (const double length : {1e-9, 4e-9}) {  // whatever the laser's
    CHECK(pulse.begin(length) == doctest::Approx(-2e-9));
    CHECK(pulse.end(length) == doctest::Approx(2e-9));
    CHECK(pulse.power(-1e-9, length) == doctest::Approx(0.5));
    CHECK(pulse.power(0, length) == 1);
    CHECK(pulse.power(0.5e-9, length) == doctest::Approx(0.75));
    CHECK(pulse.power(-2.1e-9, length) == 0);
    CHECK(pulse.power(2.1e-9, length) == 0);
  }
}

TEST_CASE("a measured pulse refuses a table that is none") {
  constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
  using Table = std::vector<PulseSample>;
  for (const Table& table :
       {Table{}, Table{{0, 1}}, Table{{0, 0}, {1e-9, 0}}, Table{{0, 1}, {0, 2}}, Table{{1e-9, 1}, {0, 1}},
        Table{{0, 1}, {1e-9, -1}}, Table{{0, 1}, {1e-9, not_a_number}}, Table{{0, 1}, {not_a_number, 1}}})
    CHECK_THROWS_AS(MeasuredPulse{table}, SettingError);
}
