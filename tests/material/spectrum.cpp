// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/material/spectrum.hpp>

#include <limits>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "support/generators.hpp"
#include "support/relative.hpp"

using namespace pulsecast;
using namespace pulsecast::support;

static_assert(std::copyable<Spectrum>);
static_assert(noexcept(std::declval<const Spectrum&>().reflectance(1e-6)));

TEST_CASE("a spectrum is met in its samples, linear between them, and constant beyond its ends") {
  const Spectrum spectrum({{0.4e-6, 0.1}, {0.5e-6, 0.3}, {1.5e-6, 0.2}});
  CHECK(spectrum.reflectance(0.4e-6) == 0.1);
  CHECK(spectrum.reflectance(0.5e-6) == 0.3);
  CHECK(spectrum.reflectance(1.5e-6) == 0.2);
  CHECK(spectrum.reflectance(0.45e-6) == relative(0.2, 1e-12));
  CHECK(spectrum.reflectance(0.75e-6) == relative(0.275, 1e-12));
  CHECK(spectrum.reflectance(0.1e-6) == 0.1);
  CHECK(spectrum.reflectance(0) == 0.1);
  CHECK(spectrum.reflectance(15e-6) == 0.2);
  CHECK(spectrum.reflectance(std::numeric_limits<double>::infinity()) == 0.2);
  CHECK(spectrum.shortest() == 0.4e-6);
  CHECK(spectrum.longest() == 1.5e-6);
  CHECK(spectrum.samples().size() == 3);
  CHECK(spectrum.memory() == 3 * sizeof(SpectralSample));
}

TEST_CASE("a spectrum of one sample is the same everywhere") {
  const Spectrum spectrum({{1e-6, 0.25}});
  for (const double wavelength : {1e-7, 1e-6, 1e-5}) CHECK(spectrum.reflectance(wavelength) == 0.25);
}

TEST_CASE("a spectrum of random samples of a straight line is that line") {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    CAPTURE(seed);
    Generator random(seed);
    std::vector<SpectralSample> samples;
    double wavelength = random.log_uniform(1e-7, 1e-6);
    const auto line = [](double w) { return 0.1 + w / 1e-4; };
    for (std::uint64_t n = 1 + random.whole(200); n > 0; --n, wavelength += random.log_uniform(1e-10, 1e-7))
      samples.push_back({wavelength, line(wavelength)});
    const Spectrum spectrum(samples);
    for (int i = 0; i < 100; ++i) {
      const double w = random.uniform(spectrum.shortest(), spectrum.longest());
      REQUIRE(spectrum.reflectance(w) == relative(line(w), 1e-12));
    }
    for (const SpectralSample& sample : samples) REQUIRE(spectrum.reflectance(sample.wavelength) == sample.reflectance);
  }
}

TEST_CASE("a spectrum that cannot be is refused, and the refusal says where") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto refusal = [](std::vector<SpectralSample> samples) -> std::string {
    try {
      const Spectrum spectrum(std::move(samples));
    } catch (const SettingError& error) {
      return error.what();
    }
    return {};
  };
  CHECK(refusal({{1e-6, 0}, {2e-6, 1}}) == "");
  CHECK(refusal({}) == "Spectrum::samples (number) is 0, but must be at least 1");
  CHECK(refusal({{1e-6, 0.1}, {1e-6, 0.2}}) ==
        "Spectrum::samples[1].wavelength is 1e-06 m, but must be greater than that of the previous sample, 1e-06");
  CHECK(refusal({{2e-6, 0.1}, {1e-6, 0.2}}).find("samples[1].wavelength") != std::string::npos);
  CHECK(refusal({{0, 0.1}}).find("samples[0].wavelength") != std::string::npos);
  CHECK(refusal({{nan, 0.1}}).find("samples[0].wavelength") != std::string::npos);
  for (const double bad : {-0.01, 1.01, nan})
    CHECK(refusal({{1e-6, 0.1}, {2e-6, bad}}).find("samples[1].reflectance") != std::string::npos);
}
