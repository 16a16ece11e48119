// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/transport/plane_spread.hpp>

#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <pulsecast/pulsecast.hpp>

#include <doctest/doctest.h>

#include "support/generators.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

namespace {

/// Plane that is met at a range on the axis, tilted about an axis across the beam [rad]; behind a step, `deeper` [m].
struct Slope {
  double range, tilt, about = 0, deeper = 0;
  std::optional<Hit> closest_hit(const Ray& ray) const noexcept {
    const Vec3 across{std::cos(about), 0, std::sin(about)}, normal = std::cos(tilt) * axis::forward + std::sin(tilt) * across;
    const double along = dot(normal, ray.direction);
    if (!(along > 0)) return {};
    const double behind = dot(ray.direction, across) > 0 ? deeper : 0;
    return Hit{.range = std::cos(tilt) * range / along + behind, .cos_incidence = along, .backscatter = along};
  }
};

const Receiver vacuum{.visibility = std::numeric_limits<double>::infinity()};

template <Footprint Pattern>
Outcome pulse_on(const Slope& slope, const Laser& laser, const Pattern& footprint, bool spread, std::vector<Echo>& echoes) {
  const Platform source{Tripod{}, Mount{}, Deflector{FixedBeam{}, Scanner{.pulses = 1, .laser = laser}}};
  const FullWaveform<MomentWidth> detector{WaveformSettings{.threshold = 1e-30, .window = 0, .returns_max = 255, .timing = EchoTiming::true_range}};
  const Survey survey{source, footprint, slope, DirectLight{.spread_planes = spread}, vacuum, detector};
  auto w = survey.workspace();
  Outcome o = survey(0, w);
  echoes.assign(o.echoes.begin(), o.echoes.end());
  return o;
}

struct Case {
  double range, divergence, pulse, tilt;
};
const std::vector<Case> cases{{400e3, 25.0 / 400e3, 15.6e-9, 20_deg}, {400e3, 25.0 / 400e3, 15.6e-9, 30_deg},
                              {400e3, 25.0 / 400e3, 15.6e-9, 45_deg}, {3000, 0.5e-3, 4e-9, 60_deg},
                              {3000, 0.5e-3, 4e-9, 70_deg},           {1000, 0.5e-3, 0.5e-9, 45_deg},
                              {1000, 0.5e-3, 0.5e-9, 60_deg}};

}  // namespace

TEST_CASE("a smooth plane gives one echo, of the place and width that a Gaussian beam's has") {
  std::size_t false_echoes = 0;
  for (const Case& c : cases)
    for (const double about : {0.0, 0.7, 2.1}) {
      const Laser laser{.pulse_length = c.pulse, .divergence = c.divergence};
      const Slope slope{c.range, c.tilt, about};
      std::vector<Echo> echoes;
      const auto check = [&](const auto& footprint) {
        false_echoes += pulse_on(slope, laser, footprint, false, echoes).echoes.size() - 1;
        const Outcome o = pulse_on(slope, laser, footprint, true, echoes);
        CAPTURE(c.range);
        CAPTURE(c.tilt);
        CAPTURE(about);
        REQUIRE(echoes.size() == 1);
        CHECK(o.energy.received == doctest::Approx(pulse_on(slope, laser, footprint, false, echoes).energy.received));
      };
      check(LatticeFootprint(19));
      check(RingFootprint(3));
      check(SunflowerFootprint(19));
      const Outcome o = pulse_on(slope, laser, LatticeFootprint(19), true, echoes);
      // Source: variance of the echo, that of the pulse, 3 tau^2, and that of a Gaussian beam over a plane, (w/2 tan(tilt) 2/c)^2
      const double tau = c.pulse / 3.5, across = 0.25 * c.divergence * c.range * std::tan(c.tilt) * 2 / speed_of_light;
      if (o.spread) CHECK(echoes[0].width == doctest::Approx(std::sqrt(3 * tau * tau + across * across)).epsilon(0.02));
      CHECK(std::fabs(echoes[0].range - c.range) < 0.02 * across * speed_of_light / 2 + 1e-6 * c.range);
    }
  CHECK(false_echoes > 50);
}

TEST_CASE("steps, rough surfaces and steep pulses are left alone") {
  const Laser laser{.pulse_length = 4e-9, .divergence = 0.5e-3};
  std::vector<Echo> echoes;
  CHECK(!pulse_on({.range = 100, .tilt = 10_deg}, laser, LatticeFootprint(19), true, echoes).spread);
  CHECK(!pulse_on({.range = 100, .tilt = 0, .deeper = 3}, laser, LatticeFootprint(19), true, echoes).spread);
  CHECK(echoes.size() == 2);
  CHECK(!pulse_on({.range = 3000, .tilt = 70_deg, .deeper = 10}, laser, LatticeFootprint(19), true, echoes).spread);
  CHECK(!pulse_on({.range = 3000, .tilt = 70_deg}, laser, SingleRay{}, true, echoes).spread);
  CHECK(pulse_on({.range = 3000, .tilt = 60_deg}, laser, LatticeFootprint(100), true, echoes).spread);
  CHECK(!pulse_on({.range = 3000, .tilt = 60_deg}, laser, LatticeFootprint(5000), true, echoes).spread);  // dense enough
}

TEST_CASE("runs count the pulses that were spread") {
  const Slope slope{3000, 70_deg};
  const Platform source{Tripod{}, Mount{}, Deflector{FixedBeam{}, Scanner{.pulses = 100, .laser = {.divergence = 0.5e-3}}}};
  CHECK(run(Survey{source, LatticeFootprint(19), slope, vacuum, FullWaveform{}}, {}).spread == 100);
  CHECK(run(Survey{source, LatticeFootprint(19), slope, DirectLight{.spread_planes = false}, vacuum, FullWaveform{}}, {}).spread == 0);
}

TEST_CASE("a plane is found from the inverse ranges of its subrays, wherever it is") {
  support::Generator any(4);
  const Emitter emitter{.laser = {.divergence = 0.02}};
  const LatticeFootprint footprint(19);
  const SubrayDirections beam(footprint, emitter);
  for (int k = 0; k < 200; ++k) {
    const Slope slope{any.log_uniform(1, 1e5), any.uniform(0, 1.4), any.uniform(0, 6)};
    std::vector<Reflection> met;
    for (std::size_t j = 0; j < footprint.size(); ++j)
      met.push_back({.range = slope.closest_hit({.direction = {beam.x[j], beam.y[j], beam.z[j]}})->range, .power = 1});
    const MetPlane plane(beam, met);
    CAPTURE(k);
    CHECK(plane.range_at(0, emitter) == doctest::Approx(slope.range).epsilon(1e-9));
    CHECK(plane.farthest_from(beam, met) < 1e-8 * slope.range);
    met[7].range *= 1.01;
    CHECK(MetPlane(beam, met).farthest_from(beam, met) > 1e-3 * slope.range);
  }
}
