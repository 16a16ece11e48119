// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// How receivers range, detect and err: beside the Cramer-Rao bound, Rice's formula, and the statistics of photons.

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/detector/band_limited_receiver.hpp>
#include <pulsecast/detector/full_waveform.hpp>
#include <pulsecast/detector/gaussian_decomposition.hpp>
#include <pulsecast/detector/phase_shift.hpp>
#include <pulsecast/detector/photon_counting.hpp>
#include <pulsecast/scanner/footprint.hpp>
#include <pulsecast/shape/leaf_angles.hpp>

#include "validation/table.hpp"

using namespace pulsecast;
using namespace pulsecast::validation;

namespace {

constexpr double power = 1e-6;         // of an echo [W]
constexpr double light = 299'792'458;  // [m/s]
const Laser laser{.pulse_length = 4e-9};
const Emitter emitter{.laser = laser};

template <class D, class Workspace>
std::vector<Echo> echoes(const D& d, Workspace& w, std::vector<Reflection> reflections, std::uint64_t pulse,
                         RangeGate gate) {
  const Detection found = d.detect({emitter, gate, reflections, {.seed = 20, .pulse = pulse}}, w);
  return {found.echoes.begin(), found.echoes.end()};
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", value);
  return text;
}

/// Noise-equivalent power [W/sqrt(Hz)] for a peak of so many deviations of the noise in 2 GHz.
double noise_power(double snr) { return power / snr / std::sqrt(2e9); }

/// Least deviation of an unbiased range [m]. Source: Cramer-Rao bound in white noise of one-sided density N: N/2 by the
/// integral of the squared slope; of (t/tau)^2 exp(-t/tau) e^2/4, with a full width at half maximum of 3.3946807 tau,
/// it is e^4/(64 tau).
double bound(double snr) {
  const double tau = 4e-9 / 3.3946806708, slope = std::exp(4.0) / (64 * tau);
  return 0.5 * light * std::sqrt(0.5 / (snr * snr * 2e9) / slope);
}

}  // namespace

TEST_CASE("ranging in noise") {
  for (const bool matched : {false, true})
    for (const double snr : {30.0, 100.0, 300.0})
      for (const double bin : {1e-9, 0.25e-9, 0.05e-9}) {
        FullWaveform d{
            WaveformSettings{.sample_interval = bin,
                             .threshold = 0.4 * power,
                             .prominence = 0.2 * power,
                             .timing = EchoTiming::peak},
            NoWidth{},
            BandLimitedReceiver{ReceiverChain{
                .bandwidth = matched ? 350e6 : 0, .noise_power = noise_power(snr), .matched_filter = matched}}};
        d.prepare(laser);
        auto w = d.workspace(1);
        double squares = 0;
        constexpr int pulses = 400;
        for (int k = 0; k < pulses; ++k) {
          const double range = 100 + (k + 0.5) / pulses * bin * light / 2;
          for (const Echo& echo :
               echoes(d, w, {{.range = range, .power = power}}, static_cast<std::uint64_t>(k), {95, 105}))
            squares += std::pow(echo.range - range, 2) / pulses;
        }
        row(std::string(matched ? "matched filter" : "default low-pass") + ", peak over noise in 2 GHz " + number(snr) +
                ", bins of " + number(1e9 * bin) + " ns: range error by Cramer-Rao bound",
            1, std::sqrt(squares) / bound(snr), matched ? 0.3 : 1);
      }
}

TEST_CASE("false alarms") {
  // Source: Rice 1945: crossings a second of u deviations, behind a Gaussian low-pass of deviation s
  const double u = 3, s = 4e-9 / std::sqrt(8 * std::numbers::ln2), gate = 10e-6;
  const double rate = std::exp(-0.5 * u * u) / (2 * std::numbers::pi * std::numbers::sqrt2 * s);
  constexpr int pulses = 100;
  for (const double bin : {1e-9, 0.25e-9, 0.1e-9}) {
    const ReceiverChain chain{.noise_power = noise_power(30)};
    const double gain = ReceivedPulse(GammaPulse{}, 4e-9, chain.filter(4e-9), bin).gain();
    const double deviation = noise_power(30) * std::sqrt(1 / (4 * std::sqrt(std::numbers::pi) * s)) / gain;
    FullWaveform d{WaveformSettings{.sample_interval = bin,
                                    .threshold = u * deviation,
                                    .prominence = deviation,
                                    .window = 0,
                                    .returns_max = 255,
                                    .timing = EchoTiming::peak},
                   NoWidth{}, BandLimitedReceiver{chain}};
    d.prepare(laser);
    auto w = d.workspace(1);
    std::size_t found = 0;
    for (std::uint64_t k = 0; k < pulses; ++k) found += echoes(d, w, {}, k, {0, 0.5 * light * gate}).size();
    const double expected = 1e-3 * rate, spread = 3 * std::sqrt(pulses * gate * rate) / (pulses * gate) * 1e-3;
    row("threshold of 3 deviations, bins of " + number(1e9 * bin) + " ns: false alarms [1/ms]", expected,
        static_cast<double>(found) / (pulses * gate) * 1e-3, spread);
  }
}

TEST_CASE("noise that is next to none") {
  std::vector<Reflection> slope;
  for (int k = 0; k < 200; ++k) slope.push_back({.range = 100 + 0.02 * k, .power = power / 200});
  const auto range = [&](double noise, EchoTiming timing) {
    FullWaveform d{WaveformSettings{.threshold = 0.02 * power, .prominence = 0.01 * power, .timing = timing}, NoWidth{},
                   BandLimitedReceiver{ReceiverChain{.noise_power = noise}}};
    d.prepare(laser);
    auto w = d.workspace(200);
    return echoes(d, w, slope, 0, {80, 130}).at(0).range;
  };
  row(Kind::bound, "slope of 4 m, noise of 1e-10 of the peak: shift of its peak [m]", 0,
      range(noise_power(1e10), EchoTiming::peak) - range(0, EchoTiming::peak), 1e-6);
  row(Kind::bound, "slope of 4 m, noise of 1e-10 of the peak: shift of its centroid [m]", 0,
      range(noise_power(1e10), EchoTiming::centroid) - range(0, EchoTiming::centroid), 1e-6);
}

TEST_CASE("saturation and overlapping echoes") {
  const double s =
      4e-9 / std::sqrt(8 * std::numbers::ln2) * std::numbers::sqrt2;  // of a Gaussian pulse and its low-pass
  const auto rise = [&](double by_level) { return -s * std::sqrt(2 * std::log(by_level)); };
  FullWaveform clipped{WaveformSettings{.threshold = 0.01 * power, .timing = EchoTiming::constant_fraction}, NoWidth{},
                       BandLimitedReceiver{ReceiverChain{.saturation = power / 20}, GaussianPulse{}}};
  clipped.prepare(laser);
  auto w = clipped.workspace(1);
  row("Gaussian pulse clipped at 1/20: walk of half its height [m]", 0.5 * light * (rise(40) - rise(2)),
      echoes(clipped, w, {{.range = 100, .power = power}}, 0, {80, 120}).at(0).range - 100, 1e-3);
  GaussianDecomposition parts{FullWaveform{
      WaveformSettings{.threshold = 0.05 * power, .window = 0, .timing = EchoTiming::peak, .record_length = 100e-9},
      NoWidth{}, BandLimitedReceiver{ReceiverChain{}, GaussianPulse{}}}};
  parts.prepare(laser);
  auto v = parts.workspace(2);
  const auto two =
      echoes(parts, v, {{.range = 100, .power = power}, {.range = 101, .power = 0.6 * power}}, 0, {80, 120});
  row("Gaussian echoes 1 m apart, decomposed: second range [m]", 101, two.at(1).range, 1e-4);
  row("Gaussian echoes 1 m apart, decomposed: second amplitude by the first", 0.6,
      two.at(1).amplitude / two.at(0).amplitude, 1e-3);
}

TEST_CASE("photons") {
  const double efficiency = 0.3, photon = 6.62607015e-34 * light / laser.wavelength;
  const auto power_for = [&](double mean) { return mean * photon / efficiency / laser.pulse_length; };
  constexpr int pulses = 10'000;
  const double infinite = std::numeric_limits<double>::infinity();
  for (const double mean : {0.1, 1.0}) {
    PhotonCounting<> d{{.efficiency = efficiency, .dead_time = infinite}};
    d.prepare(laser);
    auto w = d.workspace(1);
    int found = 0;
    for (std::uint64_t k = 0; k < pulses; ++k)
      found += echoes(d, w, {{.range = 100, .power = power_for(mean)}}, k, {}).empty() ? 0 : 1;
    const double p = 1 - std::exp(-mean);
    row(number(mean) + " photoelectrons: probability of detection", p, static_cast<double>(found) / pulses,
        3 * std::sqrt(p * (1 - p) / pulses));
  }
  {
    // Source: first of a Poisson process of N photoelectrons over a Gaussian: density N f exp(-N F), integrated
    const double mean = 10, s = 4e-9 / std::sqrt(8 * std::numbers::ln2);
    double sum = 0, first = 0, second = 0;
    for (int i = -6000; i <= 6000; ++i) {
      const double x = 1e-3 * i, density = std::exp(-0.5 * x * x - mean * 0.5 * std::erfc(-x / std::numbers::sqrt2));
      sum += density;
      first += density * x;
      second += density * x * x;
    }
    const double expected = first / sum, deviation = std::sqrt(second / sum - expected * expected);
    PhotonCounting<GaussianPulse> d{{.efficiency = efficiency, .dead_time = infinite}};
    d.prepare(laser);
    auto w = d.workspace(1);
    double times = 0;
    int found = 0;
    for (std::uint64_t k = 0; k < pulses; ++k)
      for (const Echo& echo : echoes(d, w, {{.range = 100, .power = power_for(mean)}}, k, {})) {
        times += 2 * (echo.range - 100) / light / s;
        ++found;
      }
    row("10 photoelectrons of a Gaussian pulse: first one, in deviations of the pulse", expected, times / found,
        3 * deviation / std::sqrt(1.0 * found));
  }
  {
    const double rate = 1e7, dead = 50e-9, gate = 10e-6, slower = 1 + rate * dead;
    PhotonCounting<> d{{.dark_rate = rate, .dead_time = dead, .bin = 1e-11, .returns_max = 255}};
    d.prepare(laser);
    auto w = d.workspace(1);
    constexpr int shots = 400;
    double after = 0;  // the first microsecond, so that dead times are in balance
    for (std::uint64_t k = 0; k < shots; ++k)
      for (const Echo& echo : echoes(d, w, {}, k, {0, 0.5 * light * gate})) after += 2 * echo.range / light > 1e-6;
    const double counted = shots * (gate - 1e-6);
    row("10 MHz of dark counts, 50 ns of dead time: rate of counts [MHz]", 1e-6 * rate / slower, 1e-6 * after / counted,
        3e-6 * std::sqrt(rate / std::pow(slower, 3) / counted));
  }
}

TEST_CASE("phases") {
  const PhaseShift d;
  auto w = d.workspace(2);
  const double finest = 120e6, period = 0.5 * light / finest;
  const std::complex<double> sum = 0.3 * std::polar(1.0, 4 * std::numbers::pi * finest * 20.0 / light) +
                                   0.7 * std::polar(1.0, 4 * std::numbers::pi * finest * 20.2 / light);
  const double fine = std::arg(sum) / (2 * std::numbers::pi) * period;
  row("phase shift at an edge 0.2 m deep: range [m]", fine + std::round((20.1 - fine) / period) * period,
      echoes(d, w, {{.range = 20, .power = 0.3}, {.range = 20.2, .power = 0.7}}, 0, {}).at(0).range, 1e-6);
  row("phase shift, a wall at 170 m, ambiguous behind 1 MHz: range [m]", 170 - 0.5 * light / 1e6,
      echoes(d, w, {{.range = 170, .power = 1}}, 0, {}).at(0).range, 1e-6);
}

TEST_CASE("moments of footprints, and leaves against the light") {
  const auto variance = [](const auto& footprint) {
    double sum = 0;
    for (std::size_t j = 0; j < footprint.size(); ++j)
      sum += footprint.share(j) * dot(footprint.offset(j), footprint.offset(j));
    return sum;
  };
  row("lattice of 7: squared distance from the axis, in squared radii", 0.5, variance(LatticeFootprint(7)), 1e-6);
  row("lattice of 19: squared distance from the axis, in squared radii", 0.5, variance(LatticeFootprint(19)), 1e-6);
  row("sunflower of 37: squared distance from the axis, in squared radii", 0.5, variance(SunflowerFootprint(37)), 1e-6);
  // Source: mean squared cosine by mean cosine; of spherical leaves 1/3 by 1/2; of density (2/pi)(1 +- cos 2t) from
  // above 3/4 by 8/(3 pi), and 1/4 by 4/(3 pi)
  row("spherical leaves from above: backscatter by reflectance", 2.0 / 3,
      LeafAngles::spherical().incidence_cosine(axis::up), 1e-6);
  row("planophile leaves from above: backscatter by reflectance", 0.75 / (8 / (3 * std::numbers::pi)),
      LeafAngles::planophile().incidence_cosine(axis::up), 1e-5);
  row("erectophile leaves from above: backscatter by reflectance", 0.25 / (4 / (3 * std::numbers::pi)),
      LeafAngles::erectophile().incidence_cosine(axis::up), 1e-5);
}
