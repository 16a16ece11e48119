// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/detector/timing_errors.hpp>

#include <cmath>

#include <pulsecast/base/units.hpp>
#include <pulsecast/detector/analytic_waveform.hpp>
#include <pulsecast/detector/band_limited_receiver.hpp>
#include <pulsecast/detector/first_hit.hpp>
#include <pulsecast/detector/full_waveform.hpp>
#include <pulsecast/detector/phase_shift.hpp>

#include <doctest/doctest.h>

#include "support/relative.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

namespace {
const Emitter emitter{.laser = {.peak_power = 1e3, .pulse_length = 4e-9}};
}

TEST_CASE("a detector without noise and samples does not err on a plane, by any amplitude") {
  const TimingErrors first(FirstHit{}, emitter), analytic(AnalyticWaveform<>{}, emitter);
  for (const double power : {1e-15, 1e-6, 1.0}) {
    CHECK(first.of(power, 0).deviation < 1e-12);
    CHECK(std::fabs(first.of(power, 0).bias) < 1e-12);
    CHECK(analytic.of(power, 0).deviation < 1e-9);
    CHECK(std::fabs(analytic.of(power, 0).bias) < 1e-9);
    CHECK(!analytic.of(power, 0).weak);
  }
}

TEST_CASE("a peak does not lie at the mean of a slope, a true range does") {
  const TimingErrors peak(AnalyticWaveform<>{}, emitter),
      mean(AnalyticWaveform<>{{.timing = EchoTiming::true_range}}, emitter);
  CHECK(std::fabs(peak.of(1e-6, 0.3).bias) > 0.02);
  CHECK(std::fabs(mean.of(1e-6, 0.3).bias) < 1e-9);
  CHECK(!peak.of(1e-6, 0.3).beyond);
  CHECK(peak.of(1e-6, 3).beyond);
}

TEST_CASE("the phase of a sine in white noise has the deviation of theory") {
  // Source: each component of a phasor of amplitude a errs by s, so the phase by s / a
  const PhaseShiftSettings settings{.frequencies = {10e6}, .threshold = 1e-7, .deviation = 1e-7};
  const TimingErrors errors(PhaseShift{settings}, emitter);
  for (const double power : {3e-6, 3e-5, 1e-3})
    CHECK(errors.of(power, 0).deviation == support::relative(1e-7 / power * settings.ambiguity() / (2 * pi), 0.06));
}

TEST_CASE("a receiver's noise falls with the amplitude, and what is near the noise is weak") {
  FullWaveform<NoWidth, BandLimitedReceiver<>> detector{
      {.threshold = 1e-7}, {}, BandLimitedReceiver<>{{.noise_power = 1e-12}}};
  detector.prepare(emitter.laser);
  const TimingErrors errors(detector, emitter);
  CHECK(errors.of(1e-8, 0).weak);
  CHECK(!errors.of(1e-5, 0).weak);
  const double near = errors.of(1e-5, 0).deviation, far = errors.of(1e-4, 0).deviation;
  CHECK(near > 1e-5);
  CHECK(near / far == support::relative(10, 0.1));
  CHECK(errors.of(1e-5, 0.2).deviation > near);
}
