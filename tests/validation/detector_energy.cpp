// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// What a waveform holds of a pulse's energy, and that it does not depend on how the subrays lie.

#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/detector/analytic_waveform.hpp>
#include <pulsecast/detector/full_waveform.hpp>

#include "support/detect.hpp"
#include "support/generators.hpp"
#include "validation/one_pulse.hpp"
#include "validation/table.hpp"

using namespace pulsecast;
using namespace pulsecast::validation;

namespace {

const Laser laser{.pulse_length = 4e-9, .divergence = 0.3e-3};

/// All of a flat ground below: subrays of a ring meet it at the very same range.
struct Nadir {
  std::optional<Hit> closest_hit(const Ray& ray) const noexcept { return Hit{100 / ray.direction.y, 1, 0.5, 0, 0}; }
};

struct RandomFootprint {
  std::vector<Vec2> offsets;

  RandomFootprint() {
    support::Generator any(1);
    for (int k = 0; k < 200; ++k) offsets.push_back({0.5 * any.normal(), 0.5 * any.normal()});
  }
  std::size_t size() const noexcept { return offsets.size(); }
  Vec2 offset(std::size_t j) const noexcept { return offsets[j]; }
  double share(std::size_t) const noexcept { return 1 / static_cast<double>(offsets.size()); }
};

template <class Pattern>
void amplitude(const char* name, const Pattern& footprint) {
  // Source: laser radar equation for an extended target, Jelalian 1992; near by, the solid angle of a disc on the axis
  const double closed = laser.peak_power * vacuum.diameter * vacuum.diameter /
                        (4 * 100 * 100 + vacuum.diameter * vacuum.diameter) * 0.5 * vacuum.efficiency;
  const auto exact = one_pulse(Nadir{}, footprint, laser, vacuum, AnalyticWaveform{}).echoes;
  const auto sampled = one_pulse(Nadir{}, footprint, laser, vacuum, FullWaveform{}).echoes;
  REQUIRE(exact.size() == 1);
  REQUIRE(sampled.size() == 1);
  row(std::string("AnalyticWaveform, nadir plane, ") + name + ": amplitude by the radar equation", 1,
      exact[0].amplitude / closed, 1e-6);
  row(std::string("FullWaveform, nadir plane, ") + name + ": amplitude by the radar equation", 1,
      sampled[0].amplitude / closed, 1e-4);
}

/// The integral of a record by all the power that came in [s].
template <template <class...> class D>
double recorded() {
  const D<NoWidth> detector(WaveformSettings{.record_length = 1000e-9});
  std::vector<Reflection> reflections;
  support::Generator any(7);
  double power = 0;
  for (int k = 0; k < 100; ++k) {
    reflections.push_back({any.uniform(50, 120), any.log_uniform(1e-10, 1e-8)});
    power += reflections.back().power;
  }
  auto workspace = detector.workspace(100);
  double sum = 0;
  for (const float sample : support::detect(detector, laser, reflections, workspace).waveform)
    sum += static_cast<double>(sample);
  return sum * detector.sample_interval() / power;
}

}  // namespace

TEST_CASE("ties do not lose energy") {
  amplitude("one subray", SingleRay{});
  amplitude("19 subrays in rings", RingFootprint(3));
  amplitude("279 subrays in rings", RingFootprint(10));
  amplitude("19 subrays of a sunflower", SunflowerFootprint(19));
  amplitude("200 subrays anywhere", RandomFootprint{});
}

TEST_CASE("a waveform holds all the energy that came in") {
  // Source: the integral of (t/tau)^2 exp(-t/tau) is 2 tau; its peak is 4/e^2; tau is the pulse's length by 3.3947,
  // Carlsson et al. 2001
  const double closed = 4e-9 / 3.3946806708 * std::numbers::e * std::numbers::e / 2;
  row("AnalyticWaveform, 100 reflections: integral of the waveform by the received power [ns]", closed * 1e9,
      recorded<AnalyticWaveform>() * 1e9, 1e-3);
  row("FullWaveform, 100 reflections: integral of the waveform by the received power [ns]", closed * 1e9,
      recorded<FullWaveform>() * 1e9, 1e-3);
}
