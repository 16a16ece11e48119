// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// False echoes of a noisy receiver, and Gaussians found in noise.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/detector/full_waveform.hpp>
#include <pulsecast/detector/gaussian_fit.hpp>

#include "support/detect.hpp"
#include "support/generators.hpp"
#include "validation/table.hpp"

using namespace pulsecast;
using namespace pulsecast::validation;

TEST_CASE("rate of false echoes") {
  for (const int threshold : {2, 3, 4}) {
    const WaveformSettings settings{
        .threshold = threshold * 1e-9, .window = 0, .returns_max = 255, .record_length = 1000e-9};
    const FullWaveform detector(settings, NoWidth{}, ReceiverNoise{.deviation = 1e-9});
    auto workspace = detector.workspace(1);
    double found = 0, samples = 0;
    for (PulseIndex pulse = 0; pulse < 500; ++pulse) {
      std::vector<Reflection> faint{{100, 1e-30}};
      const Detection d = support::detect(detector, {}, faint, workspace, {.seed = 3, .pulse = pulse});
      found += static_cast<double>(d.echoes.size());
      samples += static_cast<double>(d.waveform.size() - 4);  // the ends have no peaks
    }
    // A false echo is a sample above the threshold T whose neighbours are below it: the integral of f F^2 from T on,
    // with f the density and F the distribution of the normal distribution
    const double below = 0.5 * std::erfc(-threshold / std::sqrt(2.0)), closed = (1 - below * below * below) / 3;
    row("noise, threshold of " + std::to_string(threshold) + " deviations: false echoes per million samples",
        closed * 1e6, found / samples * 1e6, 4 * std::sqrt(closed / samples) * 1e6);
  }
}

TEST_CASE("Gaussians in noise") {
  double amplitude = 0, position = 0, width = 0;
  int iterations = 0;
  constexpr int cases = 2000;
  for (std::uint64_t seed = 0; seed < cases; ++seed) {
    support::Generator any(seed);
    const double top = 80 + any.uniform(), deviation = 16;  // 4 ns, sampled every 0.25 ns
    std::vector<double> y(160);
    for (std::size_t i = 0; i < y.size(); ++i)
      y[i] = std::exp(-0.5 * std::pow((static_cast<double>(i) - top) / deviation, 2)) + any.normal() / 50;
    const GaussianFit::Result r = GaussianFit{}.fit(y);
    REQUIRE(r.converged);
    iterations = std::max(iterations, r.iterations);
    amplitude += std::pow(r.gaussian.amplitude - 1, 2) / cases;
    position += std::pow((r.gaussian.position - top) / deviation, 2) / cases;
    width += std::pow(r.gaussian.width / deviation - 1, 2) / cases;
  }
  row(Kind::bound, "GaussianFit, signal to noise 50: root mean square error of the amplitude [%]", 0,
      100 * std::sqrt(amplitude), 1);
  row(Kind::bound, "GaussianFit, signal to noise 50: root mean square error of the position [% of the width]", 0,
      100 * std::sqrt(position), 1);
  row(Kind::bound, "GaussianFit, signal to noise 50: root mean square error of the width [%]", 0,
      100 * std::sqrt(width), 1);
  row(Kind::bound, "GaussianFit, signal to noise 50: most iterations", 0, iterations, 50);
}
