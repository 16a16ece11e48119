// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/detector/band_limited_receiver.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include <pulsecast/detector/full_waveform.hpp>
#include <pulsecast/pulsecast.hpp>

#include <doctest/doctest.h>

#include "support/generators.hpp"
#include "support/laws.hpp"

using namespace pulsecast;

namespace {

constexpr double power = 1e-6;  // of the echo [W]
const Laser laser{.pulse_length = 4e-9};
const Emitter emitter{.laser = laser};

/// One-sided density for a peak of so many deviations of the noise in 2 GHz, as noise-equivalent power [W/sqrt(Hz)].
double noise_power(double snr) { return power / snr / std::sqrt(2e9); }

template <PulseForm Form>
auto detector(const ReceiverChain& chain, const WaveformSettings& settings, const Form& form) {
  FullWaveform made{settings, NoWidth{}, BandLimitedReceiver<Form>{chain, form}};
  made.prepare(laser);
  return made;
}

/// Echoes of flat targets of one power at these ranges, in one pulse.
template <class D, class Workspace>
std::vector<Echo> echoes(const D& d, Workspace& w, std::vector<Reflection> reflections, std::uint64_t pulse = 0,
                         RangeGate gate = {80, 120}) {
  const Detection found =
      d.detect({.emitter = emitter, .gate = gate, .reflections = reflections, .key = {.seed = 11, .pulse = pulse}}, w);
  return {found.echoes.begin(), found.echoes.end()};
}

/// Standard deviation of the range of a gamma pulse that no unbiased estimator beats [m]. Source: Cramer-Rao bound in
/// white noise of two-sided density N/2: N/2 by the integral of the squared slope, which for (t/tau)^2 exp(-t/tau)
/// e^2/4 is e^4/(64 tau).
double bound(double snr) {
  const double tau = laser.pulse_length / 3.394680670846503, slope = std::exp(4.0) / (64 * tau);
  return 0.5 * speed_of_light * std::sqrt(0.5 / (snr * snr * 2e9) / slope);
}

struct Ranging {
  double error = 0;  // root mean square [m]
  int other = 0;     // pulses without exactly one echo
};

/// Walls drawn evenly over one bin's range about 100 m.
Ranging range_walls(const ReceiverChain& chain, WaveformSettings settings, int pulses) {
  const auto d = detector(chain, settings, GammaPulse{});
  auto w = d.workspace(1);
  Ranging result;
  double squares = 0;
  for (int k = 0; k < pulses; ++k) {
    const double range = 100 + (k + 0.5) / pulses * settings.sample_interval * speed_of_light / 2;
    const auto found = echoes(d, w, {{.range = range, .power = power}}, static_cast<std::uint64_t>(k));
    if (found.size() != 1) ++result.other;
    if (found.size() == 1) squares += (found[0].range - range) * (found[0].range - range);
  }
  result.error = std::sqrt(squares / (pulses - result.other));
  return result;
}

}  // namespace

TEST_CASE("ranges err little more than the Cramer-Rao bound, whatever the bin") {
  CHECK(1e3 * bound(30) == doctest::Approx(2.94).epsilon(0.01));
  for (const double bin : {1e-9, 0.25e-9, 0.05e-9})
    for (const double snr : {30.0, 300.0})
      for (const bool matched : {false, true}) {
        CAPTURE(bin);
        CAPTURE(snr);
        CAPTURE(matched);
        const ReceiverChain chain{
            .bandwidth = matched ? 350e6 : 0, .noise_power = noise_power(snr), .matched_filter = matched};
        const Ranging r = range_walls(
            chain,
            {.sample_interval = bin, .threshold = 0.4 * power, .prominence = 0.2 * power, .timing = EchoTiming::peak},
            300);
        CHECK(r.other == 0);
        CHECK(r.error < (matched ? 1.2 : 1.35) * bound(snr));
        CHECK(r.error > 0.9 * bound(snr));
      }
}

TEST_CASE(
    "a finer digitiser ranges no worse by the default timing, after a receiver of a bandwidth, and with ten bits") {
  constexpr double none = 0;
  for (const double snr : {none, 30.0, 300.0}) {
    ReceiverChain chain{.bandwidth = 2e9};
    if (snr > none) chain.noise_power = noise_power(snr);
    if (snr == none) chain.full_scale = 10 * power;
    double coarser = std::numeric_limits<double>::infinity();
    for (const double bin : {0.5e-9, 0.25e-9, 0.1e-9, 0.05e-9}) {
      CAPTURE(snr);
      CAPTURE(bin);
      const Ranging r =
          range_walls(chain, {.sample_interval = bin, .threshold = 0.4 * power, .prominence = 0.2 * power}, 300);
      CHECK(r.other == 0);
      CHECK(r.error < 1.1 * coarser);
      if (snr > none) CHECK(r.error < 2 * bound(snr));
      if (snr == none) CHECK(r.error < 1e-3);
      coarser = r.error;
    }
  }
}

TEST_CASE("false alarms are as many as Rice's formula gives, whatever the bin") {
  // Source: Rice 1945, Bell System Technical Journal 24: upward crossings of u deviations, a second: sqrt(-R''(0)) / (2
  // pi) exp(-u^2/2) with R = exp(-(t / 2 s)^2) of a low-pass of deviation s
  const double u = 3, gate = 10e-6, s = laser.pulse_length / std::sqrt(8 * std::numbers::ln2);
  const double rate = 1 / (std::numbers::sqrt2 * s * 2 * std::numbers::pi) * std::exp(-0.5 * u * u);
  constexpr int pulses = 100;
  const double expected = pulses * gate * rate;
  for (const double bin : {1e-9, 0.25e-9, 0.1e-9}) {
    const ReceiverChain chain{.noise_power = noise_power(30)};
    const LowPass filter = chain.filter(laser.pulse_length);
    const double deviation = std::sqrt(chain.density(0, laser.wavelength) * filter.noise_bandwidth()) /
                             ReceivedPulse(GammaPulse{}, 4e-9, filter, bin).gain();
    const auto d = detector(chain,
                            {.sample_interval = bin,
                             .threshold = u * deviation,
                             .prominence = deviation,
                             .window = 0,
                             .returns_max = 255,
                             .timing = EchoTiming::peak},
                            GammaPulse{});
    auto w = d.workspace(1);
    std::size_t found = 0;
    for (std::uint64_t k = 0; k < pulses; ++k) found += echoes(d, w, {}, k, {0, 0.5 * speed_of_light * gate}).size();
    CAPTURE(bin);
    CAPTURE(expected);
    CHECK(std::fabs(static_cast<double>(found) - expected) < 3 * std::sqrt(expected));
  }
}

TEST_CASE("false alarms are inside the gate") {
  const RangeGate metre{100, 101};
  const auto d = detector(ReceiverChain{.noise_power = noise_power(1)}, {.threshold = 0.1 * power}, GammaPulse{});
  auto w = d.workspace(1);
  std::size_t found = 0;
  for (std::uint64_t k = 0; k < 1000; ++k)
    for (const Echo& echo : echoes(d, w, {}, k, metre)) {
      CHECK(metre.contains(echo.range));
      ++found;
    }
  CHECK(found > 100);
}

TEST_CASE("a threshold for few false alarms gives no second echo") {
  // of 1e-4 in a gate of 40 m: 267 ns at the rate of Rice's formula
  const double s = laser.pulse_length / std::sqrt(8 * std::numbers::ln2),
               crossings = 267e-9 / (std::numbers::sqrt2 * s * 2 * std::numbers::pi);
  const double u = std::sqrt(2 * std::log(crossings / 1e-4));
  const ReceiverChain chain{.noise_power = noise_power(30)};
  const LowPass filter = chain.filter(laser.pulse_length);
  const double deviation = std::sqrt(chain.density(0, laser.wavelength) * filter.noise_bandwidth()) /
                           ReceivedPulse(GammaPulse{}, 4e-9, filter, 0.25e-9).gain();
  const WaveformSettings settings{.threshold = u * deviation, .prominence = u * deviation, .timing = EchoTiming::peak};
  CHECK(range_walls(chain, settings, 3000).other <= 3);
}

TEST_CASE("noise of a part in 1e10 does not move a slope") {
  std::vector<Reflection> slope;
  for (int k = 0; k < 200; ++k) slope.push_back({.range = 100 + 0.02 * k, .power = power / 200});
  for (const double bandwidth : {0.0, 350e6})
    for (const EchoTiming timing : {EchoTiming::true_range, EchoTiming::peak, EchoTiming::leading_edge,
                                    EchoTiming::constant_fraction, EchoTiming::centroid}) {
      const WaveformSettings settings{.threshold = 0.02 * power, .prominence = 0.01 * power, .timing = timing};
      const auto quiet = detector(ReceiverChain{.bandwidth = bandwidth}, settings, GammaPulse{});
      const auto noisy = detector(ReceiverChain{.bandwidth = bandwidth, .noise_power = 1e-10 * noise_power(1)},
                                  settings, GammaPulse{});
      auto w = quiet.workspace(200);
      auto v = noisy.workspace(200);
      const auto without = echoes(quiet, w, slope), with = echoes(noisy, v, slope);
      REQUIRE(without.size() == 1);
      REQUIRE(with.size() == 1);
      CAPTURE(bandwidth);
      CAPTURE(static_cast<int>(timing));
      CHECK(std::fabs(with[0].range - without[0].range) <
            (bandwidth > 0 ? 1e-4 : 1e-6));  // the plateau is flatter after a filter
    }
}

TEST_CASE("flat targets are in their place by every timing, one after the other, of any form and bin") {
  const auto check = [](const auto& form, double bin, bool matched) {
    for (const EchoTiming timing : {EchoTiming::true_range, EchoTiming::peak, EchoTiming::leading_edge,
                                    EchoTiming::constant_fraction, EchoTiming::centroid}) {
      const auto d = detector(ReceiverChain{.bandwidth = matched ? 300e6 : 0, .matched_filter = matched},
                              {.sample_interval = bin, .threshold = 0.1 * power, .timing = timing}, form);
      auto w = d.workspace(3);
      const auto found = echoes(
          d, w,
          {{.range = 0.4, .power = power}, {.range = 100.123, .power = power}, {.range = 150.321, .power = power}}, 0,
          {0, 200});
      CAPTURE(static_cast<int>(timing));
      CAPTURE(bin);
      CAPTURE(matched);
      REQUIRE(found.size() == 3);
      CHECK(std::fabs(found[0].range - 0.4) < 5e-4);
      CHECK(std::fabs(found[1].range - 100.123) < 5e-4);
      CHECK(std::fabs(found[2].range - 150.321) < 5e-4);
      for (const Echo& echo : found) CHECK(echo.amplitude == doctest::Approx(power).epsilon(0.02));
    }
  };
  for (const double bin : {1e-9, 0.25e-9})
    for (const bool matched : {false, true}) {
      check(GammaPulse{}, bin, matched);
      check(GaussianPulse{}, bin, matched);
      check(RectangularPulse{}, bin, matched);
    }
}

TEST_CASE("a saturated echo walks as the clipped pulse does") {
  const double s =
      laser.pulse_length / std::sqrt(8 * std::numbers::ln2) * std::numbers::sqrt2;  // of pulse and low-pass
  const double limit = power / 20;
  const auto rise = [&](double by_level) {
    return -s * std::sqrt(2 * std::log(by_level));
  };  // of a Gaussian, to a level below its peak
  const auto range_of = [&](EchoTiming timing, double saturation) {
    const auto d = detector(ReceiverChain{.saturation = saturation}, {.threshold = 0.01 * power, .timing = timing},
                            GaussianPulse{});
    auto w = d.workspace(1);
    const auto found = echoes(d, w, {{.range = 100, .power = power}});
    REQUIRE(found.size() == 1);
    return found[0].range;
  };
  const double half = 0.5 * speed_of_light;
  CHECK(std::fabs(range_of(EchoTiming::constant_fraction, limit) - (100 + half * (rise(40) - rise(2)))) < 1e-3);
  CHECK(std::fabs(range_of(EchoTiming::leading_edge, limit) - (100 + half * (rise(100) - rise(10)))) < 1e-3);
  CHECK(std::fabs(range_of(EchoTiming::leading_edge, 0) - range_of(EchoTiming::leading_edge, limit)) < 1e-9);
  CHECK(std::fabs(range_of(EchoTiming::peak, limit) - 100) < 0.5 * half * 0.25e-9 + 1e-3);  // the middle of the plateau
}

TEST_CASE("after saturation the amplifier recovers by its time constant") {
  const double recovery = 20e-9, limit = power / 10;
  const auto d = detector(ReceiverChain{.saturation = limit, .recovery = recovery},
                          {.threshold = 0.01 * power, .record_length = 200e-9}, GaussianPulse{});
  auto w = d.workspace(1);
  std::vector<Reflection> one{{.range = 100, .power = power}, {.range = 130, .power = 1e-3 * power}};
  const Detection found = d.detect({.emitter = emitter, .gate = {0, 200}, .reflections = one}, w);
  const auto last = std::find(found.waveform.rbegin(), found.waveform.rend(), static_cast<float>(limit));
  REQUIRE(last != found.waveform.rend());
  const auto after = static_cast<std::size_t>(found.waveform.rend() - last);
  REQUIRE(found.waveform.size() > after + 20);
  for (std::size_t k = 0; k < 20; ++k) {
    const double expected = limit * std::exp(-static_cast<double>(k + 1) * 0.25e-9 / recovery);
    CHECK(found.waveform[after + k] == doctest::Approx(expected).epsilon(1e-5));
  }
}

TEST_CASE("the steps of a digitiser add a twelfth of their square to the variance") {
  const ReceiverChain chain{.noise_power = noise_power(10)};
  ReceiverChain coarse = chain;
  coarse.full_scale = 2 * power;
  coarse.baseline = power;
  coarse.bits = 8;
  const double step = 3 * power / 255;
  const WaveformSettings settings{.threshold = power, .record_length = 5e-6};
  const auto fine = detector(chain, settings, GammaPulse{}), stepped = detector(coarse, settings, GammaPulse{});
  auto w = fine.workspace(1), v = stepped.workspace(1);
  double squares = 0, product = 0, variance = 0;
  std::size_t samples = 0;
  for (std::uint64_t k = 0; k < 20; ++k) {
    const DetectorInput input{emitter, {0, 700}, {}, {.seed = 5, .pulse = k}};
    const Detection a = fine.detect(input, w), b = stepped.detect(input, v);
    REQUIRE(a.waveform.size() == b.waveform.size());
    for (std::size_t i = 0; i < a.waveform.size(); ++i) {
      const double error = static_cast<double>(b.waveform[i]) - static_cast<double>(a.waveform[i]);
      squares += error * error;
      product += error * static_cast<double>(a.waveform[i]);
      variance += static_cast<double>(a.waveform[i]) * static_cast<double>(a.waveform[i]);
      ++samples;
    }
  }
  REQUIRE(samples > 300'000);
  REQUIRE(std::sqrt(variance / static_cast<double>(samples)) > 2 * step);
  CHECK(squares / static_cast<double>(samples) == doctest::Approx(step * step / 12).epsilon(0.02));
  CHECK(std::fabs(product) < 0.02 * std::sqrt(squares * variance));  // so that the variances add up
}

TEST_CASE("the signal has shot noise of its own") {
  const ReceiverChain chain{.shot_noise = true, .excess_noise = 3};
  const auto d = detector(chain, {.threshold = 0.3 * power, .record_length = 100e-9}, GaussianPulse{});
  auto w = d.workspace(1);
  const double photon = 6.62607015e-34 * speed_of_light / laser.wavelength, sqrt_2 = std::numbers::sqrt2;
  const double s = laser.pulse_length / std::sqrt(8 * std::numbers::ln2),
               noise_bandwidth = 1 / (4 * std::sqrt(std::numbers::pi) * s);
  const double expected =
      std::sqrt(2 * 3 * photon / 0.8 * power * noise_bandwidth) * sqrt_2;  // the low-pass lowers the peak by sqrt 2
  double sum = 0, squares = 0;
  constexpr int pulses = 4000;
  for (std::uint64_t k = 0; k < pulses; ++k) {
    std::vector<Reflection> one{{.range = 100, .power = power}};
    const Detection found = d.detect({.emitter = emitter, .reflections = one, .key = {.seed = 2, .pulse = k}}, w);
    const auto peak = static_cast<std::size_t>(std::lround((200 / speed_of_light - found.waveform_start) / 0.25e-9));
    REQUIRE(peak < found.waveform.size());
    sum += found.waveform[peak];
    squares += static_cast<double>(found.waveform[peak]) * found.waveform[peak];
  }
  const double mean = sum / pulses, deviation = std::sqrt(squares / pulses - mean * mean);
  CHECK(mean == doctest::Approx(power).epsilon(0.01));
  CHECK(deviation == doctest::Approx(expected).epsilon(3 / std::sqrt(2.0 * pulses)));
}

TEST_CASE("noise is heard in the sky") {
  struct Sky {
    std::optional<Hit> closest_hit(const Ray&) const noexcept { return {}; }
  };
  const Sky sky;
  const ReceiverChain chain{.noise_power = 1e-12};
  const LowPass filter = chain.filter(laser.pulse_length);
  const double deviation = std::sqrt(chain.density(0, laser.wavelength) * filter.noise_bandwidth());
  const Platform up{Tripod{}, Mount{}, Deflector{FixedBeam{}, Scanner{.pulses = 500, .laser = laser}}};
  const Survey survey{up, SingleRay{}, sky, Receiver{.range_max = 300},
                      FullWaveform{WaveformSettings{.threshold = 4 * deviation, .timing = EchoTiming::peak}, NoWidth{},
                                   BandLimitedReceiver{chain}}};
  std::size_t found = 0;
  run(survey, {.threads = 1}, [&](const EchoBatch& batch) {
    found += batch.echoes.size();
    for (const Echo& echo : batch.echoes) CHECK((echo.range >= 0 && echo.range <= 300));
  });
  CHECK(found > 5);
}

TEST_CASE("the laws of detectors, and settings that are refused") {
  const std::vector<std::vector<Reflection>> cases{{{.range = 100, .power = power}},
                                                   {},
                                                   {{.range = 10, .power = power}, {.range = 500, .power = 3 * power}},
                                                   {{.range = 3, .power = power}}};
  CHECK(support::detector_laws(detector(ReceiverChain{}, {.threshold = 0.1 * power}, GammaPulse{}), laser, cases) ==
        "");
  CHECK_THROWS_AS(BandLimitedReceiver{ReceiverChain{.quantum_efficiency = 0}}, SettingError);
  BandLimitedReceiver<> receiver(ReceiverChain{.noise_power = 1e-9, .shot_noise = true});
  CHECK(receiver.settings().noisy());
  receiver.silence();
  CHECK(!receiver.settings().noisy());
}

TEST_CASE("a single maximum is found from the samples near it, as from all samples") {
  support::Generator any(8);
  for (int k = 0; k < 300; ++k) {
    const double bin = any.log_uniform(0.05e-9, 1e-9);
    const ReceiverChain chain{.bandwidth = k % 2 == 0 ? 0 : any.log_uniform(100e6, 1e9)};
    WaveformSettings settings{.sample_interval = bin, .threshold = 1e-3 * power, .timing = EchoTiming::peak};
    const auto d = detector(chain, settings, GammaPulse{});
    settings.record_length = bin;  // asks for all samples
    const auto full = detector(chain, settings, GammaPulse{});
    std::vector<Reflection> reflections;
    const double range = any.uniform(1, 1000), spread = any.log_uniform(1e-4, 0.5);
    for (int j = 0; j < 7; ++j)
      reflections.push_back({.range = range + any.uniform(0, spread),
                             .power = any.log_uniform(0.1, 1) * power,
                             .object = static_cast<ObjectId>(j)});
    auto w = d.workspace(7), v = full.workspace(7);
    const auto a = echoes(d, w, reflections, 0, {}), b = echoes(full, v, reflections, 0, {});
    CAPTURE(k);
    REQUIRE(a.size() == b.size());
    for (std::size_t e = 0; e < a.size(); ++e) {
      REQUIRE(std::fabs(a[e].range - b[e].range) < 1e-9);
      REQUIRE(a[e].amplitude == doctest::Approx(b[e].amplitude).epsilon(1e-9));
      REQUIRE(a[e].object == b[e].object);
    }
  }
}
