// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/detector/analytic_waveform.hpp>
#include <pulsecast/detector/band_limited_receiver.hpp>
#include <pulsecast/detector/first_hit.hpp>
#include <pulsecast/detector/fmcw.hpp>
#include <pulsecast/detector/full_waveform.hpp>
#include <pulsecast/detector/gaussian_decomposition.hpp>
#include <pulsecast/detector/phase_shift.hpp>
#include <pulsecast/detector/photon_counting.hpp>
#include <pulsecast/detector/returns.hpp>
#include <pulsecast/detector/shape_deviation.hpp>
#include <pulsecast/material/weather.hpp>
#include <pulsecast/transport/light_paths.hpp>

#include "support/detect.hpp"
#include "support/light.hpp"

/// Detectors that hear haze and the ground, against integrals of the lidar equation.
using namespace pulsecast;
using support::from_to;
using support::LightScene;

namespace {

constexpr double wavelength = 1064e-9;

/// Laser and receiver without aerosols of its own.
support::Lamp airborne() {
  support::Lamp lamp;
  lamp.laser = {.wavelength = wavelength, .peak_power = 5000, .pulse_length = 4e-9, .divergence = 5e-4};
  lamp.receiver.visibility = std::numeric_limits<double>::infinity();
  return lamp;
}

/// A pulse straight down through haze, and what should return.
struct Flight {
  double height, visibility;
  support::Lamp lamp = airborne();
  Medium medium = haze(visibility, wavelength);
  std::size_t cells = 8192;

  [[nodiscard]] support::Traced pulse() const {
    const LightScene ground(
        {support::rectangle({}, 999.0 * axis::right, 999.0 * axis::forward, Material{.reflectance = 0.3}, 7)});
    return traced(LightPaths{.air = Media({{.medium = medium}}), .volume_cells = cells}, ground,
                  from_to({0, 0, height}, {}), LatticeFootprint(19), lamp);
  }
  /// Power that returns from a range [W/m].
  [[nodiscard]] double density(double range) const {
    const LinkBudget budget(lamp.receiver, lamp.laser);
    return range > lamp.receiver.range_min && range < height
               ? budget.power(1, pi * medium.backscatter, range) * left(range)
               : 0;
  }
  [[nodiscard]] double left(double range) const { return std::exp(-2 * medium.extinction() * range); }
  /// Power of the ground's reflections [W].
  [[nodiscard]] double ground() const {
    return LinkBudget(lamp.receiver, lamp.laser).power(1, 0.3, height) * left(height);
  }
  /// Waveform of haze at a time, for a pulse in time since its arrival, by the midpoint rule [W].
  template <class Shape>
  [[nodiscard]] double of_haze(double time, const Shape& shape, int steps = 4000) const {
    const double far = 0.5 * speed_of_light * (time - shape.begin());
    const double near =
        std::max(0.0, 0.5 * speed_of_light * (time - std::min(shape.end(), 10 * lamp.laser.pulse_length)));
    double sum = 0;
    for (int k = 0; k < steps; ++k) {
      const double range = near + (k + 0.5) / steps * (far - near);
      sum += density(range) * shape(time - 2 * range / speed_of_light) * (far - near) / steps;
    }
    return sum;
  }
};

/// Echoes of a detector, from a workspace of its own.
template <class D>
std::vector<Echo> echoes_of(D detector, const Flight& flight, const support::Traced& pulse, std::uint64_t number = 0) {
  if constexpr (PreparesForLasers<D>) detector.prepare(flight.lamp.laser);
  auto w = detector.workspace(pulse.reflections.size());
  std::vector<Reflection> reflections = pulse.reflections;
  const Emitter emitter{.laser = flight.lamp.laser};
  const DetectorInput input{
      emitter, flight.lamp.receiver.gate(), reflections, {.seed = 3, .pulse = number}, pulse.continuous};
  const Detection d = detector.detect(input, w);
  return {d.echoes.begin(), d.echoes.end()};
}

template <class D>
void check_ground(const char* name, const D& detector, const Flight& flight, double threshold) {
  CAPTURE(name);
  CAPTURE(flight.height);
  CAPTURE(flight.visibility);
  const auto pulse = flight.pulse();
  CHECK(std::fabs(pulse.imbalance()) < 1e-14);
  std::size_t air = 0, ground = 0;
  for (const Echo& echo : echoes_of(detector, flight, pulse)) {
    if (echo.kind == ReflectionKind::air) {
      ++air;
      CHECK(echo.range < 1);
    } else {
      ++ground;
      CHECK(echo.object == 7);
      CHECK(std::fabs(echo.range - flight.height) < 0.01);
      CHECK(echo.amplitude == doctest::Approx(flight.ground()).epsilon(0.08));
    }
  }
  CHECK(air <= 1);
  // the ground's pulse is a maximum of the waveform where it rises faster than the haze before it falls; here, by far
  CHECK(ground == (flight.ground() > threshold ? 1 : 0));
}

/// Maxima a second of noise of a deviation of 1 and an autocorrelation exp(-(t / 2 s)^2) that exceed a level. Source:
/// Rice 1945, sec. 3.6.
double maxima_above(double level, double s) {
  const double second = 1 / (2 * s * s), fourth = 3 / (4 * s * s * s * s), regular = second / std::sqrt(fourth);
  const double irregular = std::sqrt(1 - regular * regular);
  const auto above = [](double x) { return 0.5 * std::erfc(x / std::sqrt(2.0)); };
  return (std::sqrt(fourth / second) * above(level / irregular) +
          std::sqrt(second) * std::exp(-0.5 * level * level) * above(-regular * level / irregular)) /
         (2 * pi);
}

}  // namespace

TEST_CASE("an airplane in haze keeps its ground, and has one echo of the air") {
  for (const double height : {500.0, 1000.0, 4000.0})
    for (const double visibility : {2e3, 10e3, 23e3, 50e3}) {
      const Flight flight{.height = height, .visibility = visibility};
      for (const double threshold : {1e-12, 1e-10}) {
        const WaveformSettings s{.threshold = threshold};
        check_ground("FullWaveform", FullWaveform(s), flight, threshold);
        check_ground("AnalyticWaveform", AnalyticWaveform(s), flight, threshold);
        check_ground("BandLimitedReceiver", FullWaveform(s, NoWidth{}, BandLimitedReceiver{}), flight, threshold);
        WaveformSettings true_range = s;
        true_range.timing = EchoTiming::true_range;
        check_ground("true range", FullWaveform(true_range), flight, threshold);
      }
      const WaveformSettings recorded{.threshold = 1e-12, .record_length = 3e-5};
      check_ground("GaussianDecomposition", GaussianDecomposition(FullWaveform(recorded)), flight, recorded.threshold);
      const BandLimitedReceiver matched(ReceiverChain{.matched_filter = true});
      check_ground("matched filter", FullWaveform(WaveformSettings{.threshold = 1e-12}, NoWidth{}, matched), flight,
                   1e-12);
    }
}

TEST_CASE("haze has one echo for any number of cells, and any samples") {
  for (const std::size_t cells : {4UL, 50UL, 8192UL})
    for (const double interval : {0.05e-9, 0.4e-9, 1e-9}) {
      Flight flight{.height = 1000, .visibility = 10e3};
      flight.cells = cells;
      check_ground("FullWaveform", FullWaveform(WaveformSettings{.sample_interval = interval, .threshold = 1e-12}),
                   flight, 1e-12);
    }
}

TEST_CASE("the record of a pulse in haze is the integral of the lidar equation, and the ground's pulse") {
  const Flight flight{.height = 1000, .visibility = 10e3};
  const auto pulse = flight.pulse();
  const WaveformSettings s{.threshold = 1e-12, .record_length = 7e-6};
  const auto check = [&](const auto& detector) {
    auto w = detector.workspace(pulse.reflections.size());
    std::vector<Reflection> reflections = pulse.reflections;
    const Emitter emitter{.laser = flight.lamp.laser};
    const Detection d = detector.detect({emitter, {}, reflections, {}, pulse.continuous}, w);
    const PulseShape shape(flight.lamp.laser.pulse_length);
    for (std::size_t k = 1; k < d.waveform.size(); k += k < 100 ? 7 : 97) {
      const double time = d.waveform_start + static_cast<double>(k) * s.sample_interval;
      const double expected =
          flight.of_haze(time, shape) + flight.ground() * shape(time - 2 * flight.height / speed_of_light);
      if (!(expected > 1e-16)) continue;
      CAPTURE(time);
      CHECK(static_cast<double>(d.waveform[k]) == doctest::Approx(expected).epsilon(5e-3));
    }
  };
  check(FullWaveform(s));
  check(AnalyticWaveform(s));
}

TEST_CASE("in noise, echoes besides those of haze and ground are as many as Rice says") {
  // behind a gate, where haze is a thousandth of the threshold; and nearer, where it is a part of it
  for (const double near : {40.0, 200.0}) {
    CAPTURE(near);
    Flight flight{.height = 600, .visibility = 10e3};
    flight.lamp.receiver.range_min = near;
    flight.lamp.receiver.range_max = 700;
    const ReceiverChain chain{.noise_power = 1e-12};
    const Laser& laser = flight.lamp.laser;
    const LowPass filter = chain.filter(laser.pulse_length);
    const ReceivedPulse received(GammaPulse{}, laser.pulse_length, filter, 0.25e-9);
    const double sigma = std::sqrt(chain.density(0, wavelength) * filter.noise_bandwidth()) / received.gain();
    const double threshold = 3.2 * sigma, begin = 2 * near / speed_of_light, end = 2 * 700 / speed_of_light;
    FullWaveform detector(WaveformSettings{.threshold = threshold, .window = 0, .returns_max = 255}, NoWidth{},
                          BandLimitedReceiver{chain});
    detector.prepare(laser);
    const auto pulse = flight.pulse();
    auto w = detector.workspace(pulse.reflections.size());
    double expected = 0;
    const int steps = 600;
    for (int k = 0; k < steps; ++k) {
      const double t = begin + 10e-9 + (k + 0.5) / steps * (end - begin - 20e-9),
                   level = (threshold - flight.of_haze(t, received, 400)) / sigma;
      if (std::fabs(0.5 * speed_of_light * t - flight.height) < 3) continue;
      expected += maxima_above(level, filter.deviation) * (end - begin - 20e-9) / steps;
    }
    double count = 0, ground = 0;
    const int pulses = 1500;
    for (int k = 0; k < pulses; ++k) {
      std::vector<Reflection> reflections = pulse.reflections;
      const Emitter emitter{.laser = laser};
      const DetectorInput input{emitter,
                                flight.lamp.receiver.gate(),
                                reflections,
                                {.seed = 3, .pulse = static_cast<PulseIndex>(k)},
                                pulse.continuous};
      bool on_ground = false;
      for (const Echo& echo : detector.detect(input, w).echoes) {
        on_ground |= std::fabs(echo.range - flight.height) < 0.5 && echo.object == 7;
        if (std::fabs(echo.range - flight.height) > 3 && echo.range > near + 1.5 && echo.range < 698.5) count += 1;
      }
      ground += on_ground ? 1 : 0;
    }
    CAPTURE(expected);
    CAPTURE(count);
    CHECK(ground == pulses);
    CHECK(std::fabs(count - expected * pulses) < 3 * std::sqrt(expected * pulses));
  }
}

TEST_CASE("photons of haze and ground are Poisson processes with the rate of the waveform") {
  Flight flight{.height = 300, .visibility = 2e3};
  flight.lamp.receiver.range_min = 5;
  flight.lamp.laser.peak_power = 2;
  PhotonCounting<> detector(
      PhotonCountingSettings{.efficiency = 0.2, .dead_time = 0, .threshold = 1, .returns_max = 255});
  const Laser& laser = flight.lamp.laser;
  detector.prepare(laser);
  const auto pulse = flight.pulse();
  auto w = detector.workspace(pulse.reflections.size());
  // bins of 2 m, wider with range
  std::vector<double> edges;
  for (double range = 5.5; range < 306; range = range < 294 ? range * 1.15 : range + 1)
    edges.push_back(std::min(range, 306.0));
  std::vector<double> counts(edges.size() - 1), expected(edges.size() - 1);
  const int pulses = 400;
  for (int k = 0; k < pulses; ++k) {
    std::vector<Reflection> reflections = pulse.reflections;
    const Emitter emitter{.laser = laser};
    (void)detector.detect({emitter,
                           flight.lamp.receiver.gate(),
                           reflections,
                           {.seed = 3, .pulse = static_cast<PulseIndex>(k)},
                           pulse.continuous},
                          w);
    for (const auto& count : w.counts) {
      const double range = 0.5 * speed_of_light * count.time;
      for (std::size_t b = 0; b + 1 < edges.size(); ++b) counts[b] += range >= edges[b] && range < edges[b + 1] ? 1 : 0;
    }
  }
  // photons by time, about the mean of the pulse: gamma distribution of order 3, whose mean is tau after its peak
  const PulseShape shape(laser.pulse_length);
  const double per_watt = 0.2 * laser.pulse_length * wavelength / (planck_constant * speed_of_light);
  const auto before = [&](double t) {  // share of photons before a time since their mean
    const double u = t / shape.tau + 3;
    return u > 0 ? 1 - std::exp(-u) * (1 + u + 0.5 * u * u) : 0;
  };
  const auto photons = [&](double near, double far, double from, double power) {
    return power * per_watt * (before(2 * (far - from) / speed_of_light) - before(2 * (near - from) / speed_of_light));
  };
  double chi2 = 0, bins = 0;
  for (std::size_t b = 0; b + 1 < edges.size(); ++b) {
    const double low = std::max(5.0, edges[b] - 12), step = (std::min(300.0, edges[b + 1] + 2) - low) / 4000;
    for (int k = 0; k < 4000; ++k)
      expected[b] +=
          photons(edges[b], edges[b + 1], low + (k + 0.5) * step, flight.density(low + (k + 0.5) * step) * step);
    expected[b] = pulses * (expected[b] + photons(edges[b], edges[b + 1], 300, flight.ground()));
    if (expected[b] < 10) continue;
    chi2 += std::pow(counts[b] - expected[b], 2) / expected[b];
    ++bins;
  }
  REQUIRE(bins > 15);
  CHECK(std::fabs(chi2 - bins) < 4 * std::sqrt(2 * bins));
}

TEST_CASE("a phase-shift scanner measures the phasor of haze and wall") {
  const Flight flight{.height = 40, .visibility = 2e3};
  const auto pulse = flight.pulse();
  const auto echoes = echoes_of(PhaseShift(PhaseShiftSettings{.frequencies = {1e6}}), flight, pulse);
  REQUIRE(echoes.size() == 1);
  const double period = 0.5 * speed_of_light / 1e6;
  double in_phase = flight.ground() * std::cos(2 * pi * 40 / period),
         quadrature = flight.ground() * std::sin(2 * pi * 40 / period);
  const int steps = 400'000;
  for (int k = 0; k < steps; ++k) {
    const double range = (k + 0.5) / steps * 40, power = flight.density(range) * 40 / steps;
    in_phase += power * std::cos(2 * pi * range / period);
    quadrature += power * std::sin(2 * pi * range / period);
  }
  CHECK(echoes[0].range == doctest::Approx(std::atan2(quadrature, in_phase) / (2 * pi) * period).epsilon(1e-4));
  CHECK(echoes[0].amplitude == doctest::Approx(std::hypot(in_phase, quadrature)).epsilon(1e-4));
}

TEST_CASE("a coherent scanner finds the wall in haze, with the power of both") {
  const Flight flight{.height = 100, .visibility = 2e3};
  const auto pulse = flight.pulse();
  const Fmcw detector(FmcwSettings{.threshold = 1e-12});
  const auto echoes = echoes_of(detector, flight, pulse);
  REQUIRE(echoes.size() == 1);
  CHECK(echoes[0].range == doctest::Approx(100).epsilon(1e-5));
  // the window of Hann, squared, has the integral 1.5; half of it is before the wall
  const double expected = flight.ground() + 0.75 * detector.settings().resolution() * flight.density(99.99);
  CHECK(echoes[0].amplitude == doctest::Approx(expected).epsilon(2e-3));
}

TEST_CASE("a detector that reads reflections alone hears the ground through haze, and no haze") {
  const Flight flight{.height = 1000, .visibility = 10e3};
  const auto echoes = echoes_of(FirstHit{}, flight, flight.pulse());
  REQUIRE(echoes.size() == 1);
  CHECK(echoes[0].object == 7);
}

TEST_CASE("a cloud beyond a wall's edge is an echo of its own") {
  // an even cloud from 50 to 60 m: one maximum, where its light has come in
  const Emitter emitter;
  std::vector<ContinuousReturn> cloud{{.begin = 50, .end = 60, .at_begin = 1e-9, .at_end = 0.5e-9, .object = 3}};
  std::vector<Reflection> wall{{.range = 40, .power = 1e-8, .object = 4}};
  const auto check = [&](const auto& detector) {
    auto w = detector.workspace(2);
    const Detection d = detector.detect({emitter, {}, wall, {}, cloud}, w);
    REQUIRE(d.echoes.size() == 2);
    CHECK(d.echoes[0].object == 4);
    CHECK(d.echoes[1].object == 3);
    CHECK(d.echoes[1].kind == ReflectionKind::air);
    CHECK(d.echoes[1].range > 50.3);
    CHECK(d.echoes[1].range < 51.5);
  };
  const WaveformSettings s{.threshold = 1e-12};
  check(FullWaveform(s));
  check(AnalyticWaveform(s));
  FullWaveform band(s, NoWidth{}, BandLimitedReceiver{});
  band.prepare(emitter.laser);
  check(band);
}

TEST_CASE("echoes in haze are the same with and without a record") {
  const auto check = [](const char* name, const Flight& flight, const auto& with, const auto& without) {
    CAPTURE(name);
    const auto pulse = flight.pulse();
    const auto expected = echoes_of(with, flight, pulse), seen = echoes_of(without, flight, pulse);
    REQUIRE(seen.size() == expected.size());
    for (std::size_t e = 0; e < seen.size(); ++e) {
      CHECK(seen[e].kind == expected[e].kind);
      CHECK(seen[e].object == expected[e].object);
      CHECK(std::fabs(seen[e].range - expected[e].range) < 1e-6);
      CHECK(std::fabs(seen[e].amplitude - expected[e].amplitude) < 1e-6 * expected[e].amplitude);
    }
  };
  for (const double height : {3.0, 7.123, 30.0, 199.87, 1000.0})
    for (const double visibility : {1e3, 23e3})
      for (const double near : {0.0, 2.5}) {
        CAPTURE(height);
        CAPTURE(visibility);
        CAPTURE(near);
        Flight flight{.height = height, .visibility = visibility};
        flight.lamp.receiver.range_min = near;
        for (const EchoTiming timing : {EchoTiming::peak, EchoTiming::true_range}) {
          const WaveformSettings s{.threshold = 1e-12, .timing = timing};
          WaveformSettings recorded = s;
          recorded.record_length = 7e-6;
          check("ideal", flight, FullWaveform(recorded), FullWaveform(s));
          check("band-limited", flight, FullWaveform(recorded, NoWidth{}, BandLimitedReceiver{}),
                FullWaveform(s, NoWidth{}, BandLimitedReceiver{}));
        }
      }
}

TEST_CASE("after an echo of the air, a wall within the dead time or the window is none") {
  const Flight flight{.height = 30, .visibility = 2e3};
  const auto pulse = flight.pulse();
  const auto check = [&](const WaveformSettings& s, std::size_t expected) {
    for (const auto& echoes : {echoes_of(FullWaveform(s), flight, pulse), echoes_of(AnalyticWaveform(s), flight, pulse),
                               echoes_of(FullWaveform(s, NoWidth{}, BandLimitedReceiver{}), flight, pulse)}) {
      REQUIRE(echoes.size() == expected);
      CHECK(echoes[0].kind == ReflectionKind::air);
    }
  };
  check({.threshold = 1e-12, .dead_time = 100e-9}, 2);
  check({.threshold = 1e-12, .dead_time = 300e-9}, 1);
  check({.threshold = 1e-12, .window = 300e-9}, 1);  // the air is brighter
  check({.threshold = 1e-12, .separation = 300e-9}, 1);
}

TEST_CASE("the shape of a wall's echo in haze deviates as by quadrature") {
  const Emitter emitter;
  std::vector<ContinuousReturn> even{{.begin = 40, .end = 60, .at_begin = 2e-8, .at_end = 1e-8}};
  std::vector<Reflection> wall{{.range = 60, .power = 1e-7, .object = 4}};
  ShapeDeviation detector(FullWaveform(WaveformSettings{.record_length = 200e-9}));
  detector.prepare(emitter.laser);
  auto w = detector.workspace(1);
  const Detection d = detector.detect({emitter, {}, wall, {}, even}, w);
  REQUIRE(d.echoes.size() == 2);

  const double pulse_length = emitter.laser.pulse_length;
  const PulseShape shape(pulse_length);
  const auto sum = [&](double t) {  // at a time since the wall's maximum
    double all = wall[0].power * shape(t);
    const int steps = 2000;
    for (int k = 0; k < steps; ++k) {
      const double before = 8.0 * (k + 0.5) / steps;  // the wall [m]
      all += (1e-8 + before * 5e-10) * shape(t + 2 * before / speed_of_light) * 8 / steps;
    }
    return all;
  };
  const double mean = support::mean_distance(sum, shape, pulse_length, {.reach = 1e-9, .step = 2e-12, .count = 400});
  CHECK(1000 * mean > 15);
  CHECK(static_cast<double>(d.echoes[1].shape_deviation) == doctest::Approx(1000 * mean).epsilon(0.05));
  CHECK(d.echoes[0].shape_deviation > 100);  // the air begins, but does not end
}

TEST_CASE("the strongest return in haze is that of the greater integral, the last is the ground") {
  for (const double near : {0.0, 200.0}) {
    CAPTURE(near);
    Flight flight{.height = 1000, .visibility = 10e3};
    flight.lamp.receiver.range_min = near;
    const auto pulse = flight.pulse();
    const PulseShape shape(flight.lamp.laser.pulse_length);
    double air = 0;
    for (double range = near; range < near + 3; range += 0.01)
      air = std::max(air, flight.of_haze(2 * range / speed_of_light, shape));
    const auto kinds = [&](ReturnMode mode) {
      std::vector<ReflectionKind> all;
      for (const Echo& e :
           echoes_of(SelectedReturns(mode, FullWaveform(WaveformSettings{.threshold = 1e-12})), flight, pulse))
        all.push_back(e.kind);
      return all;
    };
    using Kinds = std::vector<ReflectionKind>;
    const ReflectionKind stronger = air > flight.ground() ? ReflectionKind::air : ReflectionKind::surface;
    CHECK(stronger == (near > 0 ? ReflectionKind::surface : ReflectionKind::air));
    CHECK(kinds(ReturnMode::strongest) == Kinds{stronger});
    CHECK(kinds(ReturnMode::first) == Kinds{ReflectionKind::air});
    CHECK(kinds(ReturnMode::last) == Kinds{ReflectionKind::surface});
    for (const ReturnMode both : {ReturnMode::first_and_last, ReturnMode::strongest_and_last, ReturnMode::n_strongest})
      CHECK(kinds(both) == Kinds{ReflectionKind::air, ReflectionKind::surface});
  }
}

TEST_CASE("with several pulses in the air, haze is lost where the instrument is blind, and the ground is folded") {
  const Flight flight{.height = 1000, .visibility = 10e3};
  const auto pulse = flight.pulse();
  const FullWaveform inside(WaveformSettings{.threshold = 1e-12});
  const MultiplePulsesInAir folded(400e3, inside);
  const auto both = echoes_of(folded, flight, pulse);
  REQUIRE(both.size() == 2);
  CHECK(both[0].kind == ReflectionKind::air);
  CHECK(both[1].object == 7);
  CHECK(both[1].range == doctest::Approx(std::fmod(1000, folded.ambiguity())).epsilon(1e-5));
  const auto ground = echoes_of(MultiplePulsesInAir(400e3, inside, 5), flight, pulse);
  REQUIRE(ground.size() == 1);
  CHECK(ground[0].number == 1);
  CHECK(ground[0].range == both[1].range);
}
