// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/detector/detail/received_pulse.hpp>

#include <cmath>
#include <cstddef>
#include <numbers>

#include <doctest/doctest.h>

using namespace pulsecast;

namespace {
/// Largest difference of the samples of a pulse from a function of time.
template <class Expected>
double greatest_error(const ReceivedPulse& pulse, double interval, double arrival, const Expected& expected) {
  const double first = pulse.first_sample(arrival);
  const ReceivedPulse::Phase phase = pulse.phase(arrival);
  CHECK(phase.first + 4 <= pulse.rows());
  CHECK(pulse.stride() >= pulse.count());
  double worst = 0;
  for (std::size_t k = 0; k < pulse.stride(); ++k) {
    double value = 0;
    for (std::size_t j = 0; j < 4; ++j) value += phase.weights[j] * pulse.row(phase.first + j)[k];
    worst = std::fmax(worst, std::fabs(value - expected((first + static_cast<double>(k)) * interval - arrival)));
  }
  return worst;
}
}  // namespace

TEST_CASE("a Gaussian pulse behind a Gaussian low-pass is a Gaussian of both variances") {
  const double length = 4e-9, deviation = length / std::sqrt(8 * std::numbers::ln2);
  for (const double interval : {1e-9, 0.25e-9, 0.05e-9})
    for (const double narrower : {0.05, 0.3, 1.0}) {
      CAPTURE(interval);
      CAPTURE(narrower);
      const LowPass filter{narrower * deviation};
      const ReceivedPulse pulse(GaussianPulse{}, length, filter, interval);
      const double both = std::hypot(deviation, filter.deviation);
      CHECK(pulse.gain() == doctest::Approx(deviation / both).epsilon(1e-6));
      for (const double arrival : {0.0, 0.1e-9, 0.77e-9, 123.456e-9, 6.67e-6})
        CHECK(greatest_error(pulse, interval, arrival,
                             [&](double t) { return std::exp(-0.5 * t * t / (both * both)); }) < 1e-6);
    }
}

TEST_CASE("a rectangular pulse behind a low-pass has the edges of the error function") {
  const double length = 4e-9, s = 0.3e-9 * std::numbers::sqrt2;
  const ReceivedPulse pulse(RectangularPulse{}, length, LowPass{0.3e-9}, 0.25e-9);
  const auto expected = [&](double t) {
    return 0.5 * (std::erf((t + 0.5 * length) / s) - std::erf((t - 0.5 * length) / s));
  };
  CHECK(pulse.gain() == doctest::Approx(1).epsilon(1e-9));
  CHECK(greatest_error(pulse, 0.25e-9, 0.1e-9, expected) < 1e-6);
}

TEST_CASE("a gamma pulse behind a low-pass far above its own bandwidth is the pulse itself") {
  const GammaPulse form;
  const double length = 4e-9;
  const ReceivedPulse pulse(form, length, LowPass{1e-3 * length}, 0.25e-9);
  CHECK(greatest_error(pulse, 0.25e-9, 3.3e-9, [&](double t) { return form.power(t, length); }) <
        3e-5);  // half of variance times curvature
}
