// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/detector/gaussian_fit.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/detector/echo_width.hpp>
#include <pulsecast/detector/full_waveform.hpp>
#include <pulsecast/detector/pulse_shape.hpp>

#include "support/detect.hpp"
#include "support/generators.hpp"
#include "support/relative.hpp"

using namespace pulsecast;

static_assert(EchoWidth<GaussianFit>);

namespace {

std::vector<double> planted(const Gaussian& g, std::size_t n) {
  std::vector<double> y(n);
  for (std::size_t i = 0; i < n; ++i)
    y[i] = g.amplitude * std::exp(-0.5 * std::pow((static_cast<double>(i) - g.position) / g.width, 2));
  return y;
}

}  // namespace

TEST_CASE(
    "a Gaussian without noise is found as it was planted, of any size and width, also where its top is just inside") {
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    const double width = any.log_uniform(0.7, 100);
    const auto n = static_cast<std::size_t>(std::ceil(6 * width)) + 3;
    const double last = static_cast<double>(n - 1);
    const Gaussian g{any.log_uniform(1e-12, 1e6), any.uniform(0.1 * last, 0.9 * last), width};
    const GaussianFit::Result r = GaussianFit{}.fit(planted(g, n));
    REQUIRE(r.converged);
    CHECK(r.iterations <= 15);
    CHECK(r.gaussian.amplitude == support::relative(g.amplitude, 1e-5));
    CHECK(std::fabs(r.gaussian.position - g.position) < 1e-5 * g.width);
    CHECK(r.gaussian.width == support::relative(g.width, 1e-5));
  }
}

TEST_CASE("at a signal-to-noise ratio of 50, planted Gaussians are recovered within 1 percent") {
  double amplitude = 0, position = 0, width = 0, mean_width = 0;
  constexpr int cases = 2000;
  for (std::uint64_t seed = 0; seed < cases; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    const Gaussian g{any.log_uniform(1e-12, 1e-3), 80 + any.uniform(), 16};  // 4 ns, sampled every 0.25 ns
    auto y = planted(g, 160);
    for (double& sample : y) sample += g.amplitude / 50 * any.normal();
    const GaussianFit::Result r = GaussianFit{}.fit(y);
    REQUIRE(r.converged);
    CHECK(r.iterations <= 10);
    amplitude += std::pow(r.gaussian.amplitude / g.amplitude - 1, 2);
    position += std::pow((r.gaussian.position - g.position) / g.width, 2);
    width += std::pow(r.gaussian.width / g.width - 1, 2);
    mean_width += r.gaussian.width / g.width - 1;
  }
  CHECK(std::sqrt(amplitude / cases) < 0.01);
  CHECK(std::sqrt(position / cases) < 0.01);
  CHECK(std::sqrt(width / cases) < 0.01);
  CHECK(std::fabs(mean_width / cases) < 0.003);
}

TEST_CASE("a fit ends within the iterations allowed, and says so if it did not converge") {
  int unconverged = 0;
  for (std::uint64_t seed = 0; seed < 3000; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    std::vector<double> y(any.whole(60));
    const double slope = any.uniform(-2, 2), level = any.uniform(0, 60), noise = any.log_uniform(1e-3, 10);
    for (std::size_t i = 0; i < y.size(); ++i) y[i] = slope * (static_cast<double>(i) - level) + noise * any.normal();
    const GaussianFit::Result r = GaussianFit{}.fit(y);
    CHECK(r.iterations <= 50);
    const double width = GaussianFit{}.width(y, 2);
    CHECK(std::isnan(width) == !r.converged);
    unconverged += !r.converged;
    if (!r.converged) continue;
    CHECK(width == 2 * r.gaussian.width);
    CHECK(std::isfinite(width));
    CHECK(width > 0);
    CHECK(r.gaussian.amplitude > 0);
    CHECK(r.gaussian.width <= static_cast<double>(y.size()));
    CHECK(r.gaussian.position > -r.gaussian.width);
    CHECK(r.gaussian.position < static_cast<double>(y.size()) + r.gaussian.width);
  }
  CHECK(unconverged > 100);
  CHECK_FALSE(GaussianFit{.iterations_max = 1}.fit(planted({1, 30.4, 9}, 61)).converged);
}

TEST_CASE("what has no top has no width") {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  for (const auto& y : {std::vector<double>{},
                        {1},
                        {1, 2},
                        {0, 0, 0, 0},
                        {0, 1, 2, 0},
                        {0, 2, 2, 0},
                        {-1, -2, -1},
                        {nan, nan, nan},
                        {infinity, 1, 2, 1},
                        {5, 5, 5, 5, 5, 5, 5}})
    CHECK(std::isnan(GaussianFit{}.width(y, 1)));
}

TEST_CASE("a pulse has the same fitted width wherever its samples lie") {
  const PulseShape shape(4e-9);
  double least = 1, most = 0;
  for (int k = 0; k < 50; ++k) {
    std::vector<double> y;
    for (double t = -2 * shape.tau - 0.005e-9 * k; t < 20 * shape.tau; t += 0.25e-9) y.push_back(shape(t));
    const double width = GaussianFit{}.width(y, 0.25e-9);
    least = std::fmin(least, width);
    most = std::fmax(most, width);
  }
  CHECK(most < 1.006 * least);
  CHECK(pulse_width(GaussianFit{}, shape, 0.25e-9) == support::relative(least, 0.006));
  CHECK(least > 1.44 * shape.tau);  // its full width at half maximum as that of a Gaussian
  CHECK(least < std::sqrt(3) * shape.tau);
}

TEST_CASE("each echo has a fitted width of its own") {
  const Laser laser{.pulse_length = 4e-9};
  const FullWaveform<GaussianFit> detector;
  auto workspace = detector.workspace(300);
  std::vector<Reflection> reflections{{50, 3e-8}};
  for (int k = 0; k < 200; ++k) reflections.push_back({80 + 0.005 * k, 1e-9});
  const Detection d = support::detect(detector, laser, reflections, workspace);
  REQUIRE(d.echoes.size() == 2);
  CHECK(d.echoes[0].width == support::relative(detector.pulse_width(laser), 0.006));
  // Source: variances of a convolution add up; a box of two-way length T has T^2 / 12
  const double box = 2 / speed_of_light;
  CHECK(d.echoes[1].width ==
        support::relative(std::sqrt(std::pow(detector.pulse_width(laser), 2) + box * box / 12), 0.1));
}

TEST_CASE("a fit refuses settings that cannot be") {
  CHECK_NOTHROW(GaussianFit{}.validate());
  CHECK_THROWS_AS(FullWaveform(WaveformSettings{}, GaussianFit{.iterations_max = 0}), SettingError);
  for (const double bad : {-0.1, 1.0, std::numeric_limits<double>::quiet_NaN()})
    CHECK_THROWS_AS(GaussianFit{.share = bad}.validate(), SettingError);
}
