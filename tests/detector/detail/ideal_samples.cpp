// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/detector/detail/ideal_samples.hpp>

#include <cmath>
#include <vector>

#include <doctest/doctest.h>

#include "support/generators.hpp"

using namespace pulsecast;

namespace {
const Emitter emitter{.laser = {.pulse_length = 4e-9}};

struct Sections {
  int count = 0;
  std::vector<double> numbers, powers;
};
/// All samples; of a window of some capacity, as many at once as there are.
Sections all(IdealSamples samples, std::size_t capacity = 0) {
  Sections s;
  while (samples.begin_section()) {
    ++s.count;
    for (bool more = true; more;) {
      if (capacity > 0) {
        const double first = samples.number();
        std::vector<double> window;
        window.reserve(capacity);
        samples.append(window);
        REQUIRE(window.size() < window.capacity());
        for (const double& power : window) {
          s.numbers.push_back(first + static_cast<double>(&power - window.data()));
          s.powers.push_back(power);
        }
        if (!window.empty()) REQUIRE(samples.number() == s.numbers.back() + 1);
      }
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

TEST_CASE("samples that are appended at once are those one by one, to the last bit, in the same sections") {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    const WaveformSettings settings{.sample_interval = any.log_uniform(0.01e-9, 4e-9)};
    std::vector<Reflection> reflections(1 + any.whole(40));
    const double start = any.log_uniform(0.1, 1000), spread = any.log_uniform(0.01, 100);
    for (Reflection& r : reflections) r = {start + any.uniform(0, spread), any.log_uniform(0.1, 10)};
    for (std::size_t i = 1; i < reflections.size(); ++i)
      if (any.whole(4) == 0) reflections[i].range = reflections[i - 1].range;
    REQUIRE(in_order_of_range(reflections, settings.sample_interval).size() == reflections.size());
    const DetectorInput input{emitter, {}, reflections};
    const IdealSamples samples(0, 0, settings, input, reflections, any.coin() ? 0 : 20);
    const Sections one_by_one = all(samples), at_once = all(samples, 2 + any.whole(300));
    CHECK(at_once.count == one_by_one.count);
    CHECK(at_once.numbers == one_by_one.numbers);
    CHECK(at_once.powers == one_by_one.powers);
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
