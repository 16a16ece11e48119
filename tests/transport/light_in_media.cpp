// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/base/units.hpp>
#include <pulsecast/transport/light_paths.hpp>

#include "support/generators.hpp"
#include "support/laws.hpp"
#include "support/light.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;
using support::clean;
using support::from_to;
using support::power_of;
using support::rectangle;
using support::traced;

namespace {

using World = support::LightScene;
const Medium mist{.absorption = 0.01, .scattering = 0.04, .backscatter = 0.002};

/// Power that a medium sends back from between two ranges, by a fine sum [W].
double integral(const support::Lamp& lamp, const Medium& m, double near, double far, double fog_begin) {
  const LinkBudget budget(lamp.receiver, lamp.laser);
  double sum = 0;
  const int steps = 200000;
  for (int k = 0; k < steps; ++k) {
    const double s = near + (k + 0.5) / steps * (far - near);
    sum +=
        budget.power(1, pi * m.backscatter * std::exp(-2 * m.extinction() * (s - fog_begin)), s) * (far - near) / steps;
  }
  return sum;
}

}  // namespace

TEST_CASE("fog dims what is behind it, and sends light back from all along the way") {
  const World scene({rectangle({0, 60, 0}, 50.0 * axis::right, 50.0 * axis::up, Material{.reflectance = 0.5}, 4)});
  const support::Lamp lamp{.laser = {.divergence = 1e-3}};
  for (const double begin : {0.0, 20.0}) {
    const LightPaths light{.spread_planes = false,
                           .air = Media({{.medium = mist, .bounds = {{-9, begin, -9}, {9, 60.5, 9}}}})};
    const auto seen = traced(light, scene, from_to({0, 0, 0}, axis::forward), LatticeFootprint(19), lamp);
    const auto open = traced(LightPaths{.spread_planes = false}, scene, from_to({0, 0, 0}, axis::forward),
                             LatticeFootprint(19), lamp);
    CHECK(std::fabs(seen.imbalance()) < 1e-9);
    const double left = std::exp(-0.05 * (60 - begin));
    CHECK(power_of(seen.of(ReflectionKind::surface)) ==
          doctest::Approx(left * left * power_of(open.reflections)).epsilon(1e-5));
    CHECK(seen.of(ReflectionKind::air).empty());
    CHECK(seen.between(0, 99, ReflectionKind::air).power ==
          doctest::Approx(integral(lamp, mist, begin, 60, begin)).epsilon(1e-3));
    CHECK(seen.continuous.front().begin == doctest::Approx(begin).epsilon(1e-6));
    CHECK(seen.continuous.back().end == doctest::Approx(60).epsilon(1e-6));
    for (double from = begin + 0.01; from < 58; from *= 1.3) {
      CAPTURE(from);
      const double to = std::min(60.0, from + 0.3 + 0.1 * from),
                   part = seen.between(from, to, ReflectionKind::air).power;
      CHECK(part == doctest::Approx(integral(lamp, mist, from, to, begin)).epsilon(from > 0.3 ? 5e-3 : 5e-2));
    }
    CHECK(seen.result.energy.absorbed / seen.result.energy.sent ==
          doctest::Approx(0.2 * (1 - left) + 0.5 * left).epsilon(1e-6));
  }
}

TEST_CASE("fog without an end takes all of the light") {
  const LightPaths light{.air = Media({{.medium = mist}})};
  const auto seen =
      traced(light, World({}), from_to({0, 0, 0}, axis::forward), RingFootprint(3), {.laser = {.divergence = 1e-3}});
  CHECK(std::fabs(seen.imbalance()) < 1e-9);
  CHECK(seen.result.energy.missed < 1e-12 * seen.result.energy.sent);
  CHECK(seen.result.energy.scattered / seen.result.energy.sent == doctest::Approx(0.8));
  CHECK(seen.reflections.empty());
  CHECK(seen.continuous.size() < 400);
}

TEST_CASE("what fog sends back is left out from where the least share of it is left, as that of walls there") {
  for (const double least : {1e-1, 1e-2, 1e-3, 1e-4}) {
    const LightPaths light{.share_min = least, .air = Media({{.medium = mist}})};
    const auto seen =
        traced(light, World({}), from_to({0, 0, 0}, axis::forward), RingFootprint(3), {.laser = {.divergence = 1e-3}});
    CHECK(seen.continuous.back().end == doctest::Approx(-std::log(least) / mist.extinction()).epsilon(1e-9));
    CHECK(std::fabs(seen.imbalance()) < 1e-9);
  }
}

TEST_CASE("fog is passed on every stretch of a path, once") {
  // a mirror at 45 degrees, and a wall to the right
  const Vec3 slant = normalize(Vec3{1, 1, 0});
  const World scene({rectangle({0, 20, 0}, 9.0 * slant, 9.0 * axis::up, clean(SmoothInterface::mirror(1))),
                     rectangle({30, 20, 0}, 9.0 * axis::forward, 9.0 * axis::up, Material{.reflectance = 1})});
  const LightPaths light{.air = Media({{.medium = mist}})};
  const auto pose = from_to({0, 0, 0}, axis::forward);
  for (const auto& [glass, way] : {std::pair{false, 50.0}, std::pair{true, 50.0}}) {
    std::vector<World::Part> parts(scene.parts().begin(), scene.parts().end());
    if (glass)
      parts.push_back(rectangle({0, 10, 0}, 1.0 * axis::right, 1.0 * axis::up,
                                clean({.kind = InterfaceKind::dielectric, .inside = {.index = 1}})));
    if (glass) {
      parts.push_back(rectangle({0, 11, 0}, 1.0 * axis::right, 1.0 * axis::up, Material{}));
      parts.back().materials = parts[2].materials;
    }
    const World world(parts);
    const auto seen = traced(light, world, pose, SingleRay{}), open = traced(LightPaths{}, world, pose, SingleRay{});
    const auto ghost = seen.of(ReflectionKind::mirror), clear = open.of(ReflectionKind::mirror);
    REQUIRE(ghost.size() == 1);
    REQUIRE(clear.size() == 1);
    CHECK(ghost[0].power / clear[0].power ==
          doctest::Approx(std::exp(-2 * 0.05 * (way - (glass ? 1 : 0)))).epsilon(1e-9));
    CHECK(std::fabs(seen.imbalance()) < 1e-9);
  }
}

TEST_CASE("the water's column sends light back by its coefficients, between the surface and the bottom") {
  const Medium water{.index = 1.33, .group_index = 1.36, .absorption = 0.08, .scattering = 0.07, .backscatter = 0.003};
  const World scene(
      {rectangle({0, 0, 0}, 500.0 * axis::right, 500.0 * axis::forward,
                 clean({.kind = InterfaceKind::water, .inside = water}), 9),
       rectangle({0, 0, -8}, 500.0 * axis::right, 500.0 * axis::forward, Material{.reflectance = 0.2}, 2)});
  for (const double degrees : {0.0, 20.0, 40.0}) {
    const double a = degrees * 1_deg, b = std::asin(std::sin(a) / 1.33), above = 200 / std::cos(a),
                 below = 8 / std::cos(b);
    const support::Lamp lamp;
    const auto seen = traced(LightPaths{}, scene, from_to({0, 0, 200}, {200 * std::tan(a), 0, 0}), SingleRay{}, lamp);
    CHECK(std::fabs(seen.imbalance()) < 1e-9);
    const auto column = seen.between(0, 999, ReflectionKind::water);
    for (const ContinuousReturn& r : seen.continuous) CHECK(r.object == 9);
    const LinkBudget budget(lamp.receiver, lamp.laser);
    const double pass = std::pow(fresnel_split(std::cos(a), 1.33).refracted(), 2);
    double sum = 0, moment = 0;
    const int steps = 20000;
    for (int k = 0; k < steps; ++k) {
      const double s = (k + 0.5) / steps * below;
      const double across = 1.33 * above + s, along = 1.33 * above + s * std::pow(std::cos(a) / std::cos(b), 2);
      const double spread = std::sqrt(across * along) * std::cos(b) / std::cos(a);
      const double power =
          budget.power_through(pass, pi * 0.003 * std::exp(-2 * 0.15 * s), spread, above) * below / steps;
      sum += power;
      moment += power * (above + 1.36 * s);
    }
    CHECK(column.power == doctest::Approx(sum).epsilon(1e-3));
    CHECK(column.mean == doctest::Approx(moment / sum).epsilon(1e-5));
  }
}

TEST_CASE("stretches for which there is no room go into cells, which keep their power and the gate") {
  support::Generator any(5);
  for (const std::size_t capacity : {4UL, 64UL, 1000UL}) {
    detail::VolumeProfile profile(capacity);
    const RangeGate gate{3, 40};
    profile.begin(0.05, 0.6, gate);
    std::vector<ContinuousReturn> returns;
    double sum = 0;
    for (int k = 0; k < 3000; ++k) {
      const double begin = any.uniform(3, 39.9), density = any.uniform(0, 2);
      sum += profile.add(begin, begin + any.uniform(0.01, 0.1), density, any.uniform(0, density));
    }
    returns.resize(profile.write_to(returns, 0, ReflectionKind::air));
    CHECK(returns.size() <= profile.size_max());
    double seen = 0;
    CHECK(support::detail::continuous_laws(returns, gate, seen) == "");
    CHECK(seen == doctest::Approx(sum).epsilon(1e-12));
  }
}

TEST_CASE("a kept workspace returns what a fresh one does, of air and of water") {
  const Medium inside{.index = 1.33, .absorption = 0.1, .scattering = 0.1, .backscatter = 0.01};
  const World lake({rectangle({}, 500.0 * axis::right, 500.0 * axis::forward,
                              Material{.reflectance = 0, .smooth = {.kind = InterfaceKind::water, .inside = inside}}),
                    rectangle({0, 0, -4}, 500.0 * axis::right, 500.0 * axis::forward, Material{.reflectance = 0.1}),
                    rectangle({40, 0, 30}, 20.0 * axis::right, 20.0 * axis::forward, Material{.reflectance = 0.1})});
  const LightPaths light{.share_min = 0.05, .air = Media({{.medium = {.scattering = 1e-3, .backscatter = 1e-4}}})};
  support::Lamp lamp;
  lamp.laser.divergence = 1e-3;
  lamp.receiver.range_min = 20.5;  // the air up to there is not heard
  const LatticeFootprint pattern(19);
  auto kept = light.workspace(pattern.size());
  support::Generator any(11);
  std::size_t only_water = 0;
  for (int k = 0; k < 100; ++k) {
    CAPTURE(k);
    // to the board, into the water, to the board, and anywhere
    const Vec3 from =
        k % 4 == 1 ? Vec3{0, 0, 20} : Vec3{k % 4 == 3 ? any.uniform(0, 60) : 40.0, 0, any.uniform(55, 100)};
    const auto pose = from_to(from, {from.x + any.uniform(-3, 3), 0, 0});
    const auto seen = traced(light, lake, pose, pattern, lamp, kept),
               expected = traced(light, lake, pose, pattern, lamp);
    only_water += !seen.continuous.empty() && seen.continuous[0].kind == ReflectionKind::water ? 1 : 0;
    REQUIRE(seen.continuous.size() == expected.continuous.size());
    for (std::size_t i = 0; i < seen.continuous.size(); ++i) {
      const ContinuousReturn &a = seen.continuous[i], &b = expected.continuous[i];
      REQUIRE(a.begin == b.begin);
      REQUIRE(a.end == b.end);
      REQUIRE(a.at_begin == b.at_begin);
      REQUIRE(a.at_end == b.at_end);
      REQUIRE(a.kind == b.kind);
    }
  }
  CHECK(only_water > 20);
}

TEST_CASE("drops in the beam are Poisson in number, and give back the mean of their medium") {
  // a pulse from 5 to 25 m through rain, in a box without a wall
  const double wavelength = 905e-9;
  const Precipitation drops = rain(5, wavelength);
  const support::Lamp base{.laser = {.wavelength = wavelength, .divergence = 5e-3}};
  const MediumRegion region = MediumRegion::of(drops, {{-9, 5, -9}, {9, 25, 9}});
  // volume of a cone up to two radii: pi theta^2 (b^3 - a^3) / 3
  const double expected = drops.number() * pi * 25e-6 * (std::pow(25.0, 3) - std::pow(5.0, 3)) / 3;
  REQUIRE(expected < detail::BeamParticles::most);
  const LightPaths light{.air = Media({region}), .volume_cells = 4096};
  MediumRegion mean = region;
  mean.particles = {};
  const auto even = traced(LightPaths{.air = Media({mean})}, World({}), from_to({}, axis::forward), SingleRay{}, base);
  const double continuous = even.between(0, 99, ReflectionKind::air).power;
  double count = 0, squares = 0, power = 0, power2 = 0;
  const int pulses = 2000;
  for (int k = 0; k < pulses; ++k) {
    support::Lamp lamp = base;
    lamp.index = static_cast<PulseIndex>(k);
    const auto seen = traced(light, World({}), from_to({}, axis::forward), LatticeFootprint(19), lamp);
    CHECK(std::fabs(seen.imbalance()) < 1e-9);
    const auto n = static_cast<double>(seen.reflections.size());
    count += n / pulses;
    squares += n * n / pulses;
    const double p = power_of(seen.reflections);
    power += p / pulses;
    power2 += p * p / pulses;
    for (const Reflection& r : seen.reflections) {
      CHECK(r.kind == ReflectionKind::air);
      CHECK(r.range > 5 - 1e-9);
      CHECK(r.range < 25.1);
    }
  }
  CHECK(std::fabs(count - expected) < 3 * std::sqrt(expected / pulses));
  CHECK(std::fabs((squares - count * count) / expected - 1) < 3 * std::sqrt(2.0 / pulses));
  CHECK(std::fabs(power - continuous) < 3 * std::sqrt((power2 - power * power) / pulses) + 0.01 * continuous);
}

TEST_CASE("drops are the same for the same pulse, others for another, and none are behind a wall") {
  const support::Lamp lamp{.laser = {.wavelength = 905e-9, .divergence = 3e-3}};
  const LightPaths light{.spread_planes = false, .air = Media({MediumRegion::of(rain(20, 905e-9))})};
  const World wall({rectangle({0, 12, 0}, 9.0 * axis::right, 9.0 * axis::up, Material{}, 3)});
  const auto a = traced(light, wall, from_to({}, axis::forward), LatticeFootprint(19), lamp),
             b = traced(light, wall, from_to({}, axis::forward), LatticeFootprint(19), lamp);
  support::Lamp next = lamp;
  next.index = 1;
  const auto c = traced(light, wall, from_to({}, axis::forward), LatticeFootprint(19), next);
  REQUIRE(a.reflections.size() == b.reflections.size());
  CHECK(a.of(ReflectionKind::surface).size() == 19);
  CHECK(a.of(ReflectionKind::air).size() > 5);
  CHECK(a.reflections.front().range == b.reflections.front().range);
  CHECK(a.reflections.front().range != c.reflections.front().range);
  for (const Reflection& r : a.of(ReflectionKind::air)) CHECK(r.range < 12.01);
}

TEST_CASE("where drops are too many to be met one by one, their mean takes over without a gap") {
  const double wavelength = 905e-9;
  const MediumRegion region = MediumRegion::of(rain(20, wavelength), {{-99, 2, -99}, {99, 120, 99}});
  MediumRegion mean = region;
  mean.particles = {};
  const support::Lamp lamp{.laser = {.wavelength = wavelength, .divergence = 5e-3}};
  const auto profile = [&](const MediumRegion& of, PulseIndex pulses) {
    std::vector<double> bins(12);
    for (PulseIndex k = 0; k < pulses; ++k) {
      support::Lamp one = lamp;
      one.index = k;
      const auto seen = traced(LightPaths{.air = Media({of})}, World({}), from_to({}, axis::forward), SingleRay{}, one);
      for (const Reflection& r : seen.reflections)
        bins[std::min<std::size_t>(11, static_cast<std::size_t>(r.range / 10))] +=
            r.power / static_cast<double>(pulses);
      for (std::size_t b = 0; b < bins.size(); ++b) {
        const double from = 10 * static_cast<double>(b);
        const double part = seen.between(from, from + 10, ReflectionKind::air).power;
        if (part > 0) bins[b] += part / static_cast<double>(pulses);
      }
    }
    return bins;
  };
  const auto grains = profile(region, 400), smooth = profile(mean, 1);
  for (std::size_t k = 1; k < 12; ++k) {
    CAPTURE(k);
    CHECK(grains[k] == doctest::Approx(smooth[k]).epsilon(k < 4 ? 0.1 : 4e-3));
  }
}

TEST_CASE("light paths through media keep the laws of transports") {
  support::Generator any(3);
  const Media air(
      {{.medium = mist},
       {.medium = {.absorption = 1, .scattering = 2, .backscatter = 0.1}, .bounds = {{-5, -5, -5}, {5, 5, 5}}}});
  const SmoothInterface water{.kind = InterfaceKind::water,
                              .inside = {.index = 1.33, .absorption = 0.1, .scattering = 0.1, .backscatter = 0.01}};
  std::vector<World::Part> parts;
  for (int k = 0; k < 12; ++k)
    parts.push_back(rectangle(
        any.point(20), any.uniform(2, 12) * any.unit(), 8.0 * any.unit(),
        Material{.reflectance = any.uniform(0, 0.5), .smooth = k % 2 == 0 ? water : SmoothInterface::pane()}));
  std::vector<Pose<frame::Beam, frame::World>> poses;
  for (int k = 0; k < 60; ++k) poses.push_back({any.rotation(), any.point(20)});
  const World scene(std::move(parts));
  CHECK(support::transport_laws(LightPaths{.air = air}, scene, poses) == "");
  CHECK(support::transport_laws(LightPaths{.air = air, .volume_cells = 50}, scene, poses,
                                {.range_min = 5, .range_max = 40}) == "");
}
