// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/detector/full_waveform.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/detector/gaussian_fit.hpp>

#include "support/detect.hpp"
#include "support/generators.hpp"
#include "support/laws.hpp"
#include "support/relative.hpp"

using namespace pulsecast;

static_assert(Detector<FullWaveform<>>);

static_assert(Detector<FullWaveform<MomentWidth>>);

namespace {

const Laser laser{.pulse_length = 4e-9};

template <class Width>
std::vector<Echo> echoes_of(const FullWaveform<Width>& detector, std::vector<Reflection> reflections,
                            const Laser& l = laser) {
  auto workspace = detector.workspace(reflections.size());
  const Detection d = support::detect(detector, l, reflections, workspace);
  return {d.echoes.begin(), d.echoes.end()};
}

/// The sum of all pulses at a two-way travel time, by its definition.
double received(const std::vector<Reflection>& reflections, double time) {
  const PulseShape shape(laser.pulse_length);
  double sum = 0;
  for (const Reflection& r : reflections) sum += r.power * shape(time - 2 * r.range / speed_of_light);
  return sum;
}

struct Peak {
  double range, height;
};

/// The peaks of the sum, found on a grid 50 times finer than the digitiser's; empty if any of them is too flat to be
/// sure of.
std::vector<Peak> distinct_peaks(const std::vector<Reflection>& reflections) {
  const double step = 0.005e-9;
  double first = std::numeric_limits<double>::infinity(), last = 0;
  for (const Reflection& r : reflections) {
    first = std::min(first, r.range);
    last = std::max(last, r.range);
  }
  const double begin = 2 * first / speed_of_light - 3e-9;
  const auto n = static_cast<std::size_t>((2 * last / speed_of_light + 3e-9 - begin) / step);
  std::vector<double> y(n);
  for (std::size_t i = 0; i < n; ++i) y[i] = received(reflections, begin + static_cast<double>(i) * step);
  std::vector<Peak> peaks;
  std::vector<std::size_t> turns;  // peaks and valleys
  double valley = 0;
  for (std::size_t i = 1; i + 1 < n; ++i) {
    if (y[i] < y[i - 1] && y[i] <= y[i + 1]) {
      if (!peaks.empty() && y[i] > 0.98 * peaks.back().height) return {};
      valley = y[i];
      turns.push_back(i);
    }
    if (y[i] > y[i - 1] && y[i] >= y[i + 1]) {
      if (valley > 0.98 * y[i]) return {};
      const double offset = 0.5 * (y[i - 1] - y[i + 1]) / (y[i - 1] - 2 * y[i] + y[i + 1]);
      peaks.push_back({0.5 * speed_of_light * (begin + (static_cast<double>(i) + offset) * step), y[i]});
      turns.push_back(i);
    }
  }
  // a level shoulder is no peak yet, but rounding may make one of it
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const bool level = std::fabs(y[i + 1] - y[i]) < 1e-5 * y[i];
    const auto near = [&](std::size_t turn) { return turn < i + 100 && i < turn + 100; };
    if (level && std::none_of(turns.begin(), turns.end(), near)) return {};
  }
  return peaks;
}

}  // namespace

TEST_CASE("one hit gives one echo, its range exact to 0.1 mm and its amplitude to 1 percent, wherever it is") {
  const FullWaveform detector(WaveformSettings{.threshold = 1e-12});
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    const double range = any.log_uniform(0.5, 1e4), power = any.log_uniform(1e-11, 1e-3);
    const auto echoes = echoes_of(detector, {{range, power, 42, 6}});
    REQUIRE(echoes.size() == 1);
    CHECK(std::fabs(echoes[0].range - range) < 1e-4);
    CHECK(echoes[0].amplitude == support::relative(power, 0.01));
    CHECK(echoes[0].object == 42);
    CHECK(echoes[0].classification == 6);
    CHECK(echoes[0].number == 1);
    CHECK(echoes[0].width == 0);
  }
}

TEST_CASE("a coarser digitiser errs more, by what a quartic through five of its samples misses") {
  struct Limits {
    double interval, range, amplitude;
  };
  for (const Limits& limit :
       {Limits{0.25e-9, 0.05e-3, 1e-5}, Limits{0.5e-9, 0.5e-3, 5e-4}, Limits{1e-9, 10e-3, 0.02}}) {
    CAPTURE(limit.interval);
    const FullWaveform detector(WaveformSettings{.sample_interval = limit.interval, .timing = EchoTiming::peak});
    double range_error = 0, amplitude_error = 0;
    for (int k = 0; k < 1000; ++k) {
      const double range = 100 + 0.000777 * k;
      const auto echoes = echoes_of(detector, {{range, 1e-8}});
      REQUIRE(echoes.size() == 1);
      range_error = std::fmax(range_error, std::fabs(echoes[0].range - range));
      amplitude_error = std::fmax(amplitude_error, std::fabs(echoes[0].amplitude / 1e-8 - 1));
    }
    CHECK(range_error < limit.range);
    CHECK(amplitude_error < limit.amplitude);
  }
}

TEST_CASE("two equal hits far apart are two echoes of full strength, and two close together are one between them") {
  const FullWaveform detector;
  for (const double apart : {2.0, 5.0, 20.0, 100.0, 1000.0, 100000.0}) {
    CAPTURE(apart);
    const auto echoes = echoes_of(detector, {{50 + apart, 1e-8, 2}, {50, 1e-8, 1}});
    REQUIRE(echoes.size() == 2);
    CHECK(std::fabs(echoes[0].range - 50) < 1e-4);
    CHECK(echoes[0].object == 1);
    CHECK(echoes[0].number == 1);
    CHECK(std::fabs(echoes[1].range - (50 + apart)) <
          (apart < 5 ? 2e-3 : 1e-4));  // the first one's tail still reaches there
    CHECK(echoes[1].object == 2);
    CHECK(echoes[1].number == 2);
  }
  for (const double apart : {0.01, 0.1, 0.3}) {
    CAPTURE(apart);
    const auto echoes = echoes_of(detector, {{50, 1e-8, 1}, {50 + apart, 1e-8, 2}});
    REQUIRE(echoes.size() == 1);
    CHECK(echoes[0].range > 50);
    CHECK(echoes[0].range < 50 + apart);
    CHECK(echoes[0].amplitude < 2e-8);
  }
}

TEST_CASE("echoes are the peaks of the sum of all pulses, as found on a finer grid") {
  const FullWaveform detector(
      WaveformSettings{.threshold = 0, .window = 0, .returns_max = 255, .timing = EchoTiming::peak});
  int compared = 0, several = 0, peaks_compared = 0, off_by_a_millimetre = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    std::vector<Reflection> reflections(1 + any.whole(12));
    const double start = any.log_uniform(1, 3000), spread = any.log_uniform(0.1, 20);
    for (Reflection& r : reflections) r = {start + any.uniform(0, spread), any.log_uniform(1e-9, 1e-7)};
    const auto peaks = distinct_peaks(reflections);
    if (peaks.empty()) continue;
    ++compared;
    several += peaks.size() > 1;
    const auto echoes = echoes_of(detector, reflections);
    REQUIRE(echoes.size() == peaks.size());
    for (std::size_t k = 0; k < peaks.size(); ++k) {
      const double off = std::fabs(echoes[k].range - peaks[k].range);
      CHECK(off < 0.019);  // half a sample: where another pulse's leading edge bends the top, nothing finer can be told
      ++peaks_compared;
      off_by_a_millimetre += off > 1e-3;
      CHECK(echoes[k].amplitude == support::relative(peaks[k].height, 0.005));
    }
  }
  CHECK(compared > 150);
  CHECK(several > 50);
  CHECK(off_by_a_millimetre * 20 < peaks_compared);
}

TEST_CASE("reflections close to one another, of which the echo is found directly, give what all samples give") {
  int compared = 0;
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    std::vector<Reflection> reflections(1 + any.whole(30));
    const double start = any.log_uniform(1, 3000),
                 spread = any.log_uniform(1e-6, 3) * 0.5 * speed_of_light * laser.pulse_length / 3.5;
    for (Reflection& r : reflections) r = {start + any.uniform(0, spread), any.log_uniform(1e-9, 1e-8)};
    for (std::size_t k = 0; k < reflections.size(); ++k) {
      reflections[k].object = static_cast<ObjectId>(k);
      reflections[k].cos_incidence = any.uniform();
    }
    WaveformSettings settings{.sample_interval = any.log_uniform(0.05e-9, 2e-9),
                              .threshold = any.log_uniform(1e-9, 1e-6),
                              .timing = any.coin() ? EchoTiming::true_range : EchoTiming::peak};
    const auto directly = echoes_of(FullWaveform(settings), reflections);
    settings.record_length = 100e-9;  // what is kept has to be sampled
    const auto by_samples = echoes_of(FullWaveform(settings), reflections);
    REQUIRE(directly.size() == by_samples.size());
    for (std::size_t k = 0; k < directly.size(); ++k) {
      ++compared;
      CHECK(std::fabs(directly[k].range - by_samples[k].range) < 1e-8);
      CHECK(directly[k].amplitude == support::relative(by_samples[k].amplitude, 1e-9));
      CHECK(directly[k].object == by_samples[k].object);
      CHECK(directly[k].cos_incidence == by_samples[k].cos_incidence);
      CHECK(directly[k].number == by_samples[k].number);
    }
  }
  CHECK(compared > 1000);
}

TEST_CASE("a long row of hits gives an echo each, all of the same strength and width") {
  const FullWaveform<MomentWidth> detector(WaveformSettings{.returns_max = 255});
  const double deviation = PulseShape(laser.pulse_length).deviation();
  for (const double spacing : {5.55, 7.77}) {  // the waveform dies away between the latter, but not between the former
    CAPTURE(spacing);
    std::vector<Reflection> row;
    for (int k = 0; k < 250; ++k) row.push_back({100 + spacing * k, 1e-8, static_cast<ObjectId>(k)});
    const auto echoes = echoes_of(detector, row);
    REQUIRE(echoes.size() == row.size());
    for (std::size_t k = 0; k < row.size(); ++k) {
      CAPTURE(k);
      CHECK(std::fabs(echoes[k].range - row[k].range) < 1e-4);
      CHECK(echoes[k].amplitude == support::relative(1e-8, 0.01));
      CHECK(echoes[k].object == row[k].object);
      CHECK(echoes[k].width == support::relative(deviation, 0.02));
    }
  }
}

TEST_CASE("the width of a hit is that of the pulse, and a slope widens it") {
  const FullWaveform<MomentWidth> detector;
  const double deviation = PulseShape(laser.pulse_length).deviation();
  const auto flat = echoes_of(detector, {{100, 1e-8}});
  REQUIRE(flat.size() == 1);
  CHECK(flat[0].width == support::relative(deviation, 0.01));
  std::vector<Reflection> slope;
  for (int k = 0; k <= 100; ++k) slope.push_back({100 + 0.005 * k, 1e-10});
  const auto tilted = echoes_of(detector, slope);
  REQUIRE(tilted.size() == 1);
  // Source: variances of a convolution add up; a box of two-way length T has T^2 / 12
  const double box = 2 * 0.505 / speed_of_light;
  CHECK(tilted[0].width == support::relative(std::sqrt(deviation * deviation + box * box / 12), 0.01));
}

TEST_CASE("echoes weaker than the threshold are not reported") {
  const std::vector<Reflection> reflections{{50, 1e-8}, {80, 3e-8}, {110, 0.9e-8}};
  const auto echoes = echoes_of(FullWaveform(WaveformSettings{.threshold = 0.95e-8}), reflections);
  REQUIRE(echoes.size() == 2);
  CHECK(echoes[0].range == support::relative(50, 1e-5));
  CHECK(echoes[1].range == support::relative(80, 1e-5));
  CHECK(echoes[1].number == 2);
  CHECK(echoes_of(FullWaveform(WaveformSettings{.threshold = 1e-7}), reflections).empty());
}

TEST_CASE("within the window before and after it, only the highest is an echo") {
  const std::vector<Reflection> reflections{{50, 1e-8}, {53, 2e-8}, {56, 1.5e-8}, {100, 5e-9}};
  CHECK(echoes_of(FullWaveform(WaveformSettings{.window = 1e-9}), reflections).size() == 4);
  // 3 m are 20 ns
  const auto echoes = echoes_of(FullWaveform(WaveformSettings{.window = 25e-9}), reflections);
  REQUIRE(echoes.size() == 2);
  CHECK(echoes[0].range == support::relative(53, 1e-5));
  CHECK(echoes[1].range == support::relative(100, 1e-5));
  CHECK(echoes[0].number == 1);
  CHECK(echoes[1].number == 2);
}

TEST_CASE("no more returns than allowed are reported, the nearest ones") {
  std::vector<Reflection> reflections;
  for (int k = 0; k < 20; ++k) reflections.push_back({200.0 - 5 * k, 1e-8 * (20 - k)});
  for (const std::size_t most : {1U, 3U, 19U, 20U, 21U}) {
    CAPTURE(most);
    const auto echoes = echoes_of(FullWaveform(WaveformSettings{.returns_max = most}), reflections);
    REQUIRE(echoes.size() == std::min<std::size_t>(most, 20));
    for (std::size_t k = 0; k < echoes.size(); ++k)
      CHECK(echoes[k].range == support::relative(105 + 5 * static_cast<double>(k), 1e-5));
  }
}

TEST_CASE("a kept waveform is the sum of the pulses, sample by sample, as long as asked for") {
  const FullWaveform detector(WaveformSettings{.sample_interval = 0.5e-9, .record_length = 300e-9});
  CHECK(detector.sample_interval() == 0.5e-9);
  const std::vector<Reflection> reflections{{60, 2e-8}, {61, 1e-8}, {70, 5e-9}, {95, 3e-8}};
  auto workspace = detector.workspace(4);
  auto input = reflections;
  const Detection d = support::detect(detector, laser, input, workspace);
  REQUIRE(d.waveform.size() > 400);
  REQUIRE(d.waveform.size() <= 600);
  const double leading_edge = 2 * 60 / speed_of_light - 2 * PulseShape(laser.pulse_length).tau;
  CHECK(d.waveform_start < leading_edge);
  CHECK(d.waveform_start > leading_edge - 2e-9);
  for (std::size_t i = 0; i < d.waveform.size(); ++i) {
    CAPTURE(i);
    const double expected = received(reflections, d.waveform_start + static_cast<double>(i) * 0.5e-9);
    REQUIRE(std::fabs(static_cast<double>(d.waveform[i]) - expected) < 1e-6 * 3e-8);
  }
}

TEST_CASE("a kept waveform leaves out nothing between hits that are far apart") {
  const FullWaveform detector(WaveformSettings{.record_length = 2000e-9});
  const std::vector<Reflection> reflections{{60, 2e-8}, {300, 1e-8}, {1000, 1e-8}};
  auto workspace = detector.workspace(3);
  auto input = reflections;
  const Detection d = support::detect(detector, laser, input, workspace);
  REQUIRE(d.waveform.size() <= 8000);
  bool second_hit = false;
  for (std::size_t i = 0; i < d.waveform.size(); ++i) {
    CAPTURE(i);
    const double expected = received(reflections, d.waveform_start + static_cast<double>(i) * 0.25e-9);
    REQUIRE(std::fabs(static_cast<double>(d.waveform[i]) - expected) < 1e-5 * 2e-8);
    second_hit |= expected > 0.99e-8 && i > 5000;
  }
  CHECK(second_hit);
  CHECK(d.echoes.size() == 3);  // beyond the record, echoes are found as well
}

TEST_CASE(
    "a hit so far away that samples could not be counted is no echo, and does not keep the others from being found") {
  for (const double far_away : {1e15, 1e18, 1e300}) {
    CAPTURE(far_away);
    CHECK(echoes_of(FullWaveform{}, {{far_away, 1e-8}}).empty());
    const auto echoes = echoes_of(FullWaveform{}, {{far_away, 1e-8}, {100, 1e-8}});
    REQUIRE(echoes.size() == 1);
    CHECK(std::fabs(echoes[0].range - 100) < 1e-4);
  }
}

TEST_CASE("a waveform that is not asked for is not kept, and nothing comes of nothing") {
  const FullWaveform detector;
  auto workspace = detector.workspace(4);
  std::vector<Reflection> one{{60, 2e-8}}, none;
  CHECK(support::detect(detector, laser, one, workspace).waveform.empty());
  CHECK(support::detect(detector, laser, none, workspace).echoes.empty());
  const FullWaveform keeps(WaveformSettings{.record_length = 1e-7});
  auto other = keeps.workspace(4);
  CHECK_FALSE(support::detect(keeps, laser, one, other).waveform.empty());
  CHECK(support::detect(keeps, laser, none, other).waveform.empty());
}

TEST_CASE("full waveforms keep the laws of a detector") {
  std::vector<std::vector<Reflection>> cases{{}};
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    support::Generator any(seed);
    std::vector<Reflection> c(any.whole(60));
    const double start = any.log_uniform(1, 3000), spread = any.log_uniform(0.01, 300);
    for (Reflection& r : c)
      r = {start + any.uniform(0, spread), any.log_uniform(1e-12, 1e-6), static_cast<ObjectId>(any.whole(5)), 0};
    cases.push_back(c);
  }
  CHECK(support::detector_laws(FullWaveform(), laser, cases) == "");
  CHECK(support::detector_laws(FullWaveform<MomentWidth>(WaveformSettings{.record_length = 100e-9}), laser, cases) ==
        "");
  CHECK(support::detector_laws(FullWaveform(WaveformSettings{.threshold = 0, .window = 0, .returns_max = 255}), laser,
                               cases) == "");
}

TEST_CASE("a waveform detector refuses settings that cannot be") {
  CHECK_THROWS_AS(FullWaveform(WaveformSettings{.sample_interval = 0}), SettingError);
  CHECK_THROWS_AS(FullWaveform(WaveformSettings{}, NoWidth{}, ReceiverNoise{.deviation = -1}), SettingError);
}

TEST_CASE("an echo is timed by the energy of its reflections, or by its peak, which is later on a slope") {
  std::vector<Reflection> slope;
  for (int k = 0; k <= 100; ++k) slope.push_back({100 + 0.01 * k, 1e-10});
  const double energy = echoes_of(FullWaveform(WaveformSettings{.timing = EchoTiming::true_range}), slope).at(0).range;
  const double peak = echoes_of(FullWaveform(), slope).at(0).range;
  CHECK(std::fabs(energy - 100.5) < 1e-9);
  CHECK(peak > 100.51);
  CHECK(peak < 100.5 + speed_of_light * PulseShape(laser.pulse_length).tau);
}

TEST_CASE("peaks closer than the separation are one echo, and an echo makes the receiver blind for its dead time") {
  const std::vector<Reflection> reflections{{50, 1e-8}, {51, 3e-8}, {60, 1e-8}};
  const auto two = echoes_of(
      FullWaveform<MomentWidth>(WaveformSettings{.separation = 10e-9, .timing = EchoTiming::true_range}), reflections);
  REQUIRE(two.size() == 2);
  CHECK(two[0].range == support::relative(50.75, 1e-9));
  // Source: variances add up; two spikes of shares p and 1 - p a distance apart have p (1 - p) of its square
  const double apart = 2 / speed_of_light, deviation = PulseShape(laser.pulse_length).deviation();
  CHECK(two[0].width == support::relative(std::sqrt(deviation * deviation + 0.25 * 0.75 * apart * apart), 0.005));
  const auto blind = echoes_of(FullWaveform(WaveformSettings{.dead_time = 66e-9}), reflections);
  REQUIRE(blind.size() == 2);
  CHECK(blind[0].range == doctest::Approx(50));
  CHECK(blind[1].range == doctest::Approx(60));  // 10 m are 66.7 ns
  CHECK(echoes_of(FullWaveform(WaveformSettings{.dead_time = 67e-9}), reflections).size() == 1);
}

TEST_CASE("noise is that of its key: of seed, pulse and sample") {
  const FullWaveform detector(WaveformSettings{.record_length = 1000e-9}, NoWidth{}, ReceiverNoise{.deviation = 1e-9});
  auto workspace = detector.workspace(1);
  const auto record = [&](RandomKey key, double range = 60) {
    std::vector<Reflection> one{{range, 1e-8}};
    const auto w = support::detect(detector, laser, one, workspace, key).waveform;
    return std::vector<float>(w.begin(), w.end());
  };
  CHECK(record({.seed = 1, .pulse = 2}) == record({.seed = 1, .pulse = 2}));
  CHECK(record({.seed = 1, .pulse = 2}) == record({.seed = 1, .pulse = 2, .subray = 7, .purpose = Purpose::scene}));
  CHECK(record({.seed = 1, .pulse = 2}) != record({.seed = 1, .pulse = 3}));
  CHECK(record({.seed = 1, .pulse = 2}) != record({.seed = 2, .pulse = 2}));
}

TEST_CASE("samples of noise have the deviation and the mean asked for, as long as the record is, on top of the pulse") {
  const ReceiverNoise noise{.deviation = 1e-9, .background = 5e-9};
  const WaveformSettings settings{.record_length = 10000e-9};
  const FullWaveform noisy(settings, NoWidth{}, noise), still(settings);
  auto workspace = noisy.workspace(2), other = still.workspace(2);
  std::vector<Reflection> reflections{{60, 1e-7}, {1000, 1e-7}};
  const auto a = support::detect(noisy, laser, reflections, workspace, {.seed = 5});
  const auto b = support::detect(still, laser, reflections, other);
  REQUIRE(a.waveform.size() == 40000);
  CHECK(a.waveform_start == b.waveform_start);
  double sum = 0, square = 0;
  for (std::size_t i = 0; i < a.waveform.size(); ++i) {
    const double error =
        static_cast<double>(a.waveform[i]) - (i < b.waveform.size() ? static_cast<double>(b.waveform[i]) : 0);
    sum += error;
    square += error * error;
  }
  const double mean = sum / 40000, deviation = noise.deviation_of_sample(laser.wavelength, settings.sample_interval);
  CHECK(std::fabs(mean - 5e-9) < 5 * deviation / 200);
  CHECK(std::sqrt(square / 40000 - mean * mean) == support::relative(deviation, 5 / std::sqrt(2 * 40000.0)));
}

TEST_CASE("false echoes come at the rate that the normal distribution predicts") {
  // A sample is a peak of the noise above T if it is above T and its two neighbours are below it. For independent
  // samples that is the integral of f F^2 from T on, with f the density and F the distribution: (1 - F(T)^3) / 3.
  constexpr std::size_t samples = 100'000;
  for (const double threshold : {0.0, 1.0, 2.0, 3.0}) {
    CAPTURE(threshold);
    const WaveformSettings settings{
        .threshold = threshold * 1e-9, .window = 0, .returns_max = 255, .record_length = 1000 * 0.25e-9};
    const FullWaveform detector(settings, NoWidth{}, ReceiverNoise{.deviation = 1e-9});
    auto workspace = detector.workspace(1);
    std::size_t found = 0, looked_at = 0;
    for (PulseIndex pulse = 0; looked_at < samples; ++pulse) {
      std::vector<Reflection> faint{{100, 1e-30}};
      const Detection d = support::detect(detector, laser, faint, workspace, {.seed = 11, .pulse = pulse});
      REQUIRE(d.waveform.size() >= 1000);
      // where the number of returns ends the search, it was over there
      const double end = d.echoes.size() < 255
                             ? static_cast<double>(d.waveform.size())
                             : std::round((2 * d.echoes[254].range / speed_of_light - d.waveform_start) / 0.25e-9);
      found += d.echoes.size();
      looked_at += static_cast<std::size_t>(end);
      for (const Echo& e : d.echoes) CHECK(e.amplitude >= threshold * 1e-9);
    }
    const double below = 0.5 * std::erfc(-threshold / std::sqrt(2.0));
    const double expected = (1 - below * below * below) / 3 * static_cast<double>(looked_at);
    CHECK(std::fabs(static_cast<double>(found) - expected) <
          5 * std::sqrt(expected) + 0.005 * expected);  // the ends of a record have no peaks
  }
}

TEST_CASE("noise does not break the laws of a detector, nor grow beyond the workspace") {
  std::vector<std::vector<Reflection>> cases{{}};
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    support::Generator any(seed);
    std::vector<Reflection> c(1 + any.whole(20));
    const double start = any.log_uniform(1, 3000), spread = any.log_uniform(0.01, 300);
    for (Reflection& r : c) r = {start + any.uniform(0, spread), any.log_uniform(1e-6, 1e-5)};
    cases.push_back(c);
  }
  const WaveformSettings settings{.threshold = 0, .window = 0, .returns_max = 255, .record_length = 10000e-9};
  CHECK(support::detector_laws(FullWaveform(settings, MomentWidth{}, ReceiverNoise{.deviation = 1e-11}), laser,
                               cases) == "");
  CHECK(support::detector_laws(FullWaveform(settings, GaussianFit{}, ReceiverNoise{.deviation = 1e-11}), laser,
                               cases) == "");
}
