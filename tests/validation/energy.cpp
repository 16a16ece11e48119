// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Where the energy goes: every joule that is sent has one fate, and none is made.

#include <cmath>
#include <cstdint>
#include <optional>

#include <doctest/doctest.h>

#include <pulsecast/base/units.hpp>
#include <pulsecast/deflector/polygon_mirror.hpp>
#include <pulsecast/deflector/rotating_head.hpp>
#include <pulsecast/detector/full_waveform.hpp>
#include <pulsecast/run.hpp>

#include "validation/one_pulse.hpp"
#include "validation/table.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;
using namespace pulsecast::validation;

namespace {

/// A ground of chequers, white and black, out to 60 m, under a scanner 2 m above it.
struct Chequers {
  std::optional<Hit> closest_hit(const Ray& ray) const noexcept {
    const double range = -ray.origin.z / ray.direction.z;
    if (!(range > ray.near && range <= ray.far)) return std::nullopt;
    const Vec3 p = ray.origin + range * ray.direction;
    if (std::hypot(p.x, p.y) > 60) return std::nullopt;
    const bool white =
        (static_cast<std::int64_t>(std::floor(p.x)) + static_cast<std::int64_t>(std::floor(p.y))) % 2 == 0;
    const double cosine = std::fabs(ray.direction.z);
    return Hit{range, cosine, white ? cosine : 0, 0, 0};
  }
};

/// A white wall.
struct Wall {
  double at;
  std::optional<Hit> closest_hit(const Ray& ray) const noexcept {
    return Hit{at / ray.direction.y, ray.direction.y, ray.direction.y, 0, 0};
  }
};

/// Quarters of a beam: nothing, a plate before the gate, a black plate, a white one.
struct Quarters {
  std::optional<Hit> closest_hit(const Ray& ray) const noexcept {
    const bool right_half = ray.direction.x > 0, upper_half = ray.direction.z > 0;
    if (right_half && upper_half) return std::nullopt;
    return Hit{right_half ? 1.0 : 10.0, 1, upper_half ? 0.0 : 1.0, 0, 0};
  }
};

}  // namespace

TEST_CASE("energy by its fate, over a survey in which pulses have all of them") {
  const Chequers map;
  const Platform source{
      Tripod{.position = {0, 0, 2}}, Mount{},
      Deflector{RotatingHead{.angular_rate = 36_deg},
                Deflector{PolygonMirror{.line_rate = 20, .sweep = 100_deg, .angle_min = -60_deg, .angle_max = 40_deg},
                          Scanner{.pulse_rate = 5_kHz, .pulses = 50'000, .laser = {.divergence = 5_mrad}}}}};
  const Survey survey{source, RingFootprint{5}, map, Receiver{.range_min = 3, .range_max = 50},
                      FullWaveform{WaveformSettings{.sample_interval = 1_ns, .threshold = 2e-6}}};
  const RunSummary summary = run(survey, {.threads = 2});
  const EnergyLedger& energy = summary.energy;
  const double spent = energy.missed + energy.out_of_range + energy.absorbed + energy.scattered + energy.cut;
  std::uint64_t slots = 0;
  for (std::size_t f = 0; f < fate_count; ++f) {
    CAPTURE(f);
    CHECK(summary.fates[f] > 0);
    slots += summary.fates[f];
  }
  row(Kind::consistency, "50 000 pulses of all fates: sum of the energies of all fates, of what was sent", 1,
      spent / energy.sent, 1e-6);
  const double each = Laser{}.peak_power * Laser{}.pulse_length * static_cast<double>(summary.pulses());
  row(Kind::consistency, "50 000 pulses of all fates: what was sent, of peak power by pulse length by their number", 1,
      energy.sent / each, 1e-6);
  row(Kind::consistency, "50 000 slots: sum over all fates", 50'000, static_cast<double>(slots), 0.1);
}

TEST_CASE("energy by its fate, over a beam in quarters") {
  const Result result = one_pulse(Quarters{}, SunflowerFootprint{2001}, Laser{}, Receiver{.range_min = 2});
  row("beam in quarters: share that missed", 0.25, result.energy.share(&EnergyLedger::missed), 0.01);
  row("beam in quarters: share that met something before the range gate", 0.25,
      result.energy.share(&EnergyLedger::out_of_range), 0.01);
  row("beam in quarters: share that was absorbed", 0.25, result.energy.share(&EnergyLedger::absorbed), 0.01);
  row("beam in quarters: share that returned", 0.25, result.energy.share(&EnergyLedger::scattered), 0.01);
}

TEST_CASE("what is detected is never more than what was sent, and near by all but a little of it") {
  const Receiver large{.diameter = 0.2, .efficiency = 1, .visibility = vacuum.visibility};
  double most = 0;
  for (double range = 1e-3; range < 1e4; range *= 1.3)
    most = std::fmax(
        most, one_pulse(Wall{range}, RingFootprint{4}, Laser{.divergence = 1e-6}, large).power / Laser{}.peak_power);
  // Source: sin^2 of half the angle that the aperture subtends where the wall is nearest, at 1 mm
  row("white wall from 1 mm to 10 km before an aperture of 0.2 m: most that is received, of what was sent",
      std::pow(std::sin(std::atan(0.1 / 1e-3)), 2), most, 1e-6);
}
