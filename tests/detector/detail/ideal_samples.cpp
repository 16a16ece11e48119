// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/detector/detail/ideal_samples.hpp>

#include <cmath>
#include <vector>

#include <doctest/doctest.h>

using namespace pulsecast;

namespace {
const Emitter emitter{.laser = {.pulse_length = 4e-9}};

struct Sections {
  int count = 0;
  std::vector<double> numbers, powers;
};
Sections all(IdealSamples samples) {
  Sections s;
  while (samples.begin_section()) {
    ++s.count;
    for (bool more = true; more;) {
      s.numbers.push_back(samples.number());
      s.powers.push_back(samples.power(more));
    }
  }
  return s;
}
}  // namespace

TEST_CASE("samples are the sum of the pulse shapes, in sections about the echoes") {
  const WaveformSettings settings;
  std::vector<Reflection> reflections{
      {.range = 100, .power = 3}, {.range = 100.4, .power = 2}, {.range = 300, .power = 1}};
  const DetectorInput input{emitter, {}, reflections};
  const IdealSamples samples(0, 0, settings, input, reflections, 20);
  CHECK(!samples.independent_noise());
  CHECK(samples.delay() == 0);
  const Sections s = all(samples);
  CHECK(s.count == 2);
  CHECK(s.numbers.front() == samples.start());
  const PulseShape shape(4e-9, settings.shape_divisor);
  for (std::size_t i = 0; i < s.numbers.size(); ++i) {
    double sum = 0;
    for (const Reflection& r : reflections)
      sum += r.power * shape(s.numbers[i] * settings.sample_interval - arrival(r));
    REQUIRE(std::fabs(s.powers[i] - sum) < 1e-6);
  }
}

TEST_CASE("noise has the deviation asked for, and goes on for the length of the record") {
  const WaveformSettings settings{.record_length = 1e-6};
  std::vector<Reflection> reflections{{.range = 100, .power = 1e-30}};
  const DetectorInput input{emitter, {}, reflections, {.seed = 3}};
  const IdealSamples samples(0.5, 0.25, settings, input, reflections, 0);
  CHECK(samples.independent_noise());
  CHECK(samples.background() == 0.25);
  const Sections s = all(samples);
  CHECK(s.count == 1);
  REQUIRE(s.powers.size() >= 4000);
  double squares = 0;
  for (const double p : s.powers) squares += p * p;
  CHECK(std::sqrt(squares / static_cast<double>(s.powers.size())) == doctest::Approx(0.5).epsilon(0.04));
}

TEST_CASE("nothing heard gives no section") {
  const WaveformSettings settings;
  const DetectorInput input{emitter};
  CHECK(all(IdealSamples(0, 0, settings, input, {}, 0)).count == 0);
  CHECK(all(IdealSamples(1, 0, settings, input, {}, 0)).count == 0);
}
