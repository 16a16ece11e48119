// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/detector/analytic_waveform.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/detector/full_waveform.hpp>
#include <pulsecast/detector/gaussian_fit.hpp>

#include "support/detect.hpp"
#include "support/generators.hpp"
#include "support/laws.hpp"
#include "support/relative.hpp"

using namespace pulsecast;

static_assert(Detector<AnalyticWaveform<>> && Detector<AnalyticWaveform<MomentWidth>>);

namespace {

const Laser laser{.pulse_length = 4e-9};
const PulseShape shape(laser.pulse_length);
const double metres_per_tau = 0.5 * speed_of_light * shape.tau;

template <class D>
std::vector<Echo> echoes_of(const D& detector, std::vector<Reflection> reflections) {
  auto workspace = detector.workspace(reflections.size());
  const Detection d = support::detect(detector, laser, reflections, workspace);
  return {d.echoes.begin(), d.echoes.end()};
}

/// The sum of all pulses at a two-way travel time, by its definition, with its slope by tau.
struct Received {
  double power = 0, slope = 0;
};
Received received(const std::vector<Reflection>& reflections, double time) {
  Received sum;
  for (const Reflection& r : reflections) {
    const double u = (time - arrival(r)) / shape.tau + PulseShape::peak;
    if (u < 0) continue;
    const double p = r.power * std::exp(-u) * PulseShape::to_unit_peak;
    sum.power += p * u * u;
    sum.slope += p * (2 * u - u * u);
  }
  return sum;
}

std::vector<Reflection> some(support::Generator& any, std::size_t most) {
  std::vector<Reflection> reflections(1 + any.whole(most));
  const double start = any.log_uniform(1, 3000), spread = any.log_uniform(0.01, 20);
  for (Reflection& r : reflections)
    r = {start + any.uniform(0, spread), any.log_uniform(1e-9, 1e-7), static_cast<ObjectId>(any.whole(9))};
  return reflections;
}

constexpr double infinity = std::numeric_limits<double>::infinity();
const WaveformSettings all_peaks{.threshold = 0, .window = 0, .returns_max = 255, .timing = EchoTiming::peak};

}  // namespace

TEST_CASE("one hit gives one echo, exact to rounding, wherever it is") {
  for (const EchoTiming timing : {EchoTiming::true_range, EchoTiming::peak}) {
    const AnalyticWaveform<MomentWidth> detector(WaveformSettings{.threshold = 1e-12, .timing = timing});
    for (std::uint64_t seed = 0; seed < 500; ++seed) {
      CAPTURE(seed);
      support::Generator any(seed);
      const double range = any.log_uniform(0.5, 1e5), power = any.log_uniform(1e-11, 1e-3);
      const auto echoes = echoes_of(detector, {{range, power, 42, 6, {}, 0.5}});
      REQUIRE(echoes.size() == 1);
      CHECK(std::fabs(echoes[0].range - range) < 1e-10);
      CHECK(echoes[0].amplitude == support::relative(power, 1e-12));
      CHECK(echoes[0].width == support::relative(shape.deviation(), 1e-9));
      CHECK(echoes[0].object == 42);
      CHECK(echoes[0].classification == 6);
      CHECK(echoes[0].cos_incidence == 0.5);
      CHECK(echoes[0].number == 1);
    }
  }
}

TEST_CASE("between two edges, ages give the sum of pulses, where it turns, and its integrals") {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    EdgeAgeMoments ages;
    std::vector<Reflection> reflections;
    double now = 0;
    for (std::size_t k = any.whole(9) + 1; k-- > 0;) {
      const double step = any.uniform(0, 2), power = any.log_uniform(0.1, 10);
      ages.advance(step);
      now += step;
      ages.add(power);
      reflections.push_back({(now + PulseShape::peak) * metres_per_tau, power});
    }
    const auto at = [&](double x) { return received(reflections, (now + x) * shape.tau); };
    CHECK(ages.power() == doctest::Approx(at(0).power).epsilon(1e-10));
    if (ages.can_turn()) {
      for (const double x : {ages.until_valley(), ages.until_peak()})
        if (x > 0) CHECK(std::fabs(at(x).slope) < 1e-10 * at(x).power + 1e-12);
      CHECK(ages.until_valley() < ages.until_peak());
    } else {
      for (double x = 0; x < 5; x += 0.25) CHECK(at(x).slope < 0);
    }
    for (const double end : {0.01, 1.0, 10.0, infinity}) {
      CAPTURE(end);
      const WaveformMoments found = ages.until(end);
      WaveformMoments sum;
      const double step = std::fmin(end, 60) / 4000;
      for (double x = 0.5 * step; x < std::fmin(end, 60); x += step) {
        const double p = at(x).power * step;
        sum.energy += p;
        sum.first += p * x;
        sum.second += p * x * x;
      }
      CHECK(found.energy == support::relative(sum.energy, 1e-4));
      CHECK(found.first == support::relative(sum.first, 1e-4));
      CHECK(found.second == support::relative(sum.second, 1e-4));
    }
  }
}

TEST_CASE("every echo is where the sum of pulses has no slope, as high as the sum, and between any two it is lower") {
  const AnalyticWaveform detector(all_peaks);
  std::size_t several = 0;
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    const auto reflections = some(any, 40);
    const auto echoes = echoes_of(detector, reflections);
    REQUIRE(!echoes.empty());
    several += echoes.size() > 1;
    double highest = 0;
    for (std::size_t e = 0; e < echoes.size(); ++e) {
      const double time = 2 * echoes[e].range / speed_of_light;
      const Received there = received(reflections, time);
      CHECK(std::fabs(there.slope) < 1e-8 * there.power);
      CHECK(echoes[e].amplitude == support::relative(there.power, 1e-9));
      highest = std::fmax(highest, there.power);
      if (e == 0) continue;
      double valley = infinity;
      for (double x = 0; x <= 1; x += 1e-3)
        valley = std::fmin(
            valley,
            received(reflections, time - x * 2 * (echoes[e].range - echoes[e - 1].range) / speed_of_light).power);
      CHECK(valley <= std::fmin(echoes[e].amplitude, echoes[e - 1].amplitude) * (1 + 1e-5));
    }
    for (const Reflection& r : reflections)  // nothing was passed over
      for (double x = -2; x < 3; x += 0.1)
        CHECK(received(reflections, arrival(r) + x * shape.tau).power <= highest * (1 + 1e-9));
  }
  CHECK(several > 200);
}

TEST_CASE("the echo of a group, found directly, is what the pass over its edges finds") {
  // A reflection without power makes the group none, and nothing else.
  const auto both = [](const auto& detector, std::vector<Reflection> reflections) {
    const auto directly = echoes_of(detector, reflections);
    reflections.push_back({reflections.front().range, 0, 77, 7});
    return std::pair(directly, echoes_of(detector, reflections));
  };
  for (const EchoTiming timing : {EchoTiming::true_range, EchoTiming::peak}) {
    const AnalyticWaveform<MomentWidth> detector(WaveformSettings{.threshold = 1e-12, .timing = timing});
    for (std::uint64_t seed = 0; seed < 4000; ++seed) {
      CAPTURE(seed);
      support::Generator any(seed);
      std::vector<Reflection> reflections(1 + any.whole(40));
      const double start = any.log_uniform(1e-3, 1e5), spread = any.log_uniform(1e-9, 1.999) * metres_per_tau;
      for (Reflection& r : reflections) r = {start + any.uniform(0, spread), any.log_uniform(1e-11, 1e-7)};
      for (std::size_t k = 0; k < reflections.size(); ++k) reflections[k].object = static_cast<ObjectId>(k);
      if (seed % 2 == 0) {  // as far apart as may be
        reflections.front().range = start;
        reflections.back().range = start + spread;
      }
      const auto [found, expected] = both(detector, reflections);
      REQUIRE(found.size() == 1);
      REQUIRE(expected.size() == 1);
      const Echo &a = found[0], &b = expected[0];
      // Of the last edge, whose two-way time is rounded, comes as much as the time has digits.
      const double rounding = 1e-15 * start, near = 1e-9 + rounding / metres_per_tau;
      REQUIRE(std::fabs(a.range - b.range) <
              (timing == EchoTiming::true_range ? 0 : 1e-7 * metres_per_tau) + 4 * rounding + 1e-14);
      REQUIRE(a.amplitude == support::relative(b.amplitude, near));
      REQUIRE(a.width == support::relative(b.width, near));
      REQUIRE(a.number == 1);
      if (a.object == b.object) continue;  // else both must have as great a share
      const double time = 2 * b.range / speed_of_light;
      const auto share = [&](ObjectId k) { return reflections[k].power * shape(time - arrival(reflections[k])); };
      if (timing == EchoTiming::peak) REQUIRE(share(a.object) == support::relative(share(b.object), 1e-6));
    }
  }
  // at the threshold, and with edges so far apart that the ages' variance is 1 but for rounding
  const double least = echoes_of(AnalyticWaveform(), {{50, 1e-8}, {50.1, 1e-8}})[0].amplitude;
  CHECK(both(AnalyticWaveform(WaveformSettings{.threshold = 0.999 * least}), {{50, 1e-8}, {50.1, 1e-8}}).first.size() ==
        1);
  CHECK(both(AnalyticWaveform(WaveformSettings{.threshold = 1.001 * least}), {{50, 1e-8}, {50.1, 1e-8}}).first.empty());
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    const double range = any.log_uniform(1, 1e4),
                 further = range + 2 * metres_per_tau * (1 - any.log_uniform(1e-15, 1e-9)), power = 1e-8;
    const auto [found, expected] = both(AnalyticWaveform(all_peaks), {{range, power}, {further, power * std::exp(-2)}});
    REQUIRE(found.size() == 1);
    CHECK(found[0].amplitude == support::relative(expected[0].amplitude, 1e-6));
  }
}

TEST_CASE("hits on the same spot are one, thousands of them too, and add up") {
  const AnalyticWaveform<MomentWidth> detector;
  for (const std::size_t n : {2U, 19U, 10000U}) {
    const auto echoes = echoes_of(detector, std::vector<Reflection>(n, {123.456, 1e-8}));
    REQUIRE(echoes.size() == 1);
    CHECK(std::fabs(echoes[0].range - 123.456) < 1e-9);
    CHECK(echoes[0].amplitude == support::relative(1e-8 * static_cast<double>(n), 1e-9));
    CHECK(echoes[0].width == support::relative(shape.deviation(), 1e-9));
  }
}

TEST_CASE("a slope of thousands of hits is one echo at its middle, as wide as variances add up to") {
  std::vector<Reflection> slope;
  for (int k = 0; k <= 5000; ++k) slope.push_back({1000 + 0.0002 * k, 1e-10});
  const auto echoes = echoes_of(AnalyticWaveform<MomentWidth>{{.timing = EchoTiming::true_range}}, slope);
  REQUIRE(echoes.size() == 1);
  CHECK(echoes[0].range == support::relative(1000.5, 1e-9));
  const double box = 2 * 1.0002 / speed_of_light;
  CHECK(echoes[0].width == support::relative(std::sqrt(3 * shape.tau * shape.tau + box * box / 12), 1e-6));
}

TEST_CASE("an echo's moments are those of the sum between its valleys") {
  const AnalyticWaveform<MomentWidth> detector(all_peaks);
  const WaveformSettings fine{
      .sample_interval = 0.02e-9, .threshold = 0, .window = 0, .returns_max = 255, .timing = EchoTiming::peak};
  const FullWaveform<MomentWidth> sampled(fine);
  std::size_t compared = 0;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    auto reflections = some(any, 10);
    for (Reflection& r : reflections) r.range = 100 + std::fmod(r.range, 5);  // so that all fits into one stretch
    const auto a = echoes_of(detector, reflections), b = echoes_of(sampled, reflections);
    if (a.size() != b.size()) continue;
    for (std::size_t e = 0; e + 1 < a.size(); ++e) {
      CHECK(std::fabs(a[e].width - b[e].width) < 0.02e-9);  // a sample
      ++compared;
    }
  }
  CHECK(compared > 30);
}

TEST_CASE("a kept waveform is that of the sampling detector") {
  const WaveformSettings settings{.sample_interval = 0.5e-9, .record_length = 300e-9};
  const AnalyticWaveform exact(settings);
  const FullWaveform sampled(settings);
  CHECK(exact.sample_interval() == 0.5e-9);
  std::vector<Reflection> reflections{{60, 2e-8}, {61, 1e-8}, {70, 5e-9}, {95, 3e-8}};
  auto w = exact.workspace(4);
  auto v = sampled.workspace(4);
  const Detection a = support::detect(exact, laser, reflections, w),
                  b = support::detect(sampled, laser, reflections, v);
  REQUIRE(a.waveform.size() > 400);
  REQUIRE(a.waveform.size() <= b.waveform.size() + 1);
  REQUIRE(b.waveform.size() <= a.waveform.size() + 1);
  CHECK(a.waveform_start == b.waveform_start);
  for (std::size_t i = 0; i < std::min(a.waveform.size(), b.waveform.size()); ++i)
    CHECK(std::fabs(a.waveform[i] - b.waveform[i]) < 1e-14F);
  CHECK(echoes_of(AnalyticWaveform<>{}, reflections).size() == 4);
  std::vector<Reflection> one{{60, 1}};
  auto u = AnalyticWaveform<>{}.workspace(1);
  CHECK(support::detect(AnalyticWaveform<>{}, laser, one, u).waveform.empty());
}

TEST_CASE("a fitted width is that of the sampling detector, to what the place of the samples makes") {
  const AnalyticWaveform<GaussianFit> exact;
  const FullWaveform<GaussianFit> sampled;
  std::vector<Reflection> slope;
  for (int k = 0; k <= 100; ++k) slope.push_back({100 + 0.005 * k, 1e-10});
  for (const auto& reflections :
       {std::vector<Reflection>{{100, 1e-8}}, slope, std::vector<Reflection>{{100, 1e-8}, {103, 2e-8}}}) {
    const auto a = echoes_of(exact, reflections), b = echoes_of(sampled, reflections);
    REQUIRE(a.size() == b.size());
    for (std::size_t e = 0; e < a.size(); ++e) CHECK(a[e].width == support::relative(b[e].width, 0.005));
  }
  CHECK(echoes_of(exact, {{100, 1e-8}})[0].width == support::relative(exact.pulse_width(laser), 0.005));
  CHECK(exact.pulse_width(laser) == sampled.pulse_width(laser));
}

TEST_CASE("hits that are too far to be counted, or that bring nothing, are left out") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Reflection& odd : {Reflection{1e18, 1e-8}, {infinity, 1e-8}, {nan, 1e-8}, {50, 0}, {50, nan}, {50, -1}}) {
    CHECK(echoes_of(AnalyticWaveform{}, {odd}).empty());
    const auto echoes = echoes_of(AnalyticWaveform{}, {odd, {100, 1e-8}});
    REQUIRE(echoes.size() == 1);
    CHECK(echoes[0].range == support::relative(100, 1e-12));
  }
  CHECK(echoes_of(AnalyticWaveform{}, {}).empty());
}

TEST_CASE("hits any distance apart are echoes of their own") {
  for (const double apart : {10.0, 1e3, 1e5, 1e7, 1e9}) {
    CAPTURE(apart);
    const auto echoes =
        echoes_of(AnalyticWaveform<MomentWidth>{}, {{50, 1e-8}, {50 + apart, 2e-8}, {50 + 2 * apart, 1e-8}});
    REQUIRE(echoes.size() == 3);
    CHECK(echoes[1].amplitude == support::relative(2e-8, 1e-5));
    CHECK(echoes[2].width == support::relative(shape.deviation(), 1e-3));
  }
}

TEST_CASE("analytic waveforms keep the laws of a detector") {
  std::vector<std::vector<Reflection>> cases{{}};
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    support::Generator any(seed);
    cases.push_back(some(any, 60));
  }
  CHECK(support::detector_laws(AnalyticWaveform(), laser, cases) == "");
  CHECK(support::detector_laws(AnalyticWaveform<MomentWidth>(WaveformSettings{.record_length = 100e-9}), laser,
                               cases) == "");
  CHECK(support::detector_laws(AnalyticWaveform<GaussianFit>(), laser, cases) == "");
  CHECK(support::detector_laws(AnalyticWaveform(all_peaks), laser, cases) == "");
  CHECK_THROWS_AS(AnalyticWaveform(WaveformSettings{.dead_time = -1}), SettingError);
}
