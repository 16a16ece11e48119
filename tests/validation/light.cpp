// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Light that goes on: mirrors, glass, water, fog, and light that surfaces scatter to and fro.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/base/units.hpp>
#include <pulsecast/detector/full_waveform.hpp>
#include <pulsecast/shape/transmissive_voxels.hpp>
#include <pulsecast/shape/voxel_grid.hpp>
#include <pulsecast/shape/water_surface.hpp>
#include <pulsecast/shape/wind_waves.hpp>
#include <pulsecast/transport/light_paths.hpp>

#include "support/generators.hpp"
#include "support/light.hpp"
#include "support/scenes.hpp"
#include "validation/integral.hpp"
#include "validation/one_pulse.hpp"
#include "validation/table.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;
using namespace pulsecast::validation;
using support::clean;
using support::from_to;
using support::power_of;
using support::rectangle;
using support::traced;

namespace {

using World = support::LightScene;
constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace

TEST_CASE("mirrors") {
  double worst = 0, balance = 0;
  for (std::uint64_t seed = 1; seed <= 500; ++seed) {
    support::Generator any(seed);
    // a mirror some 60 m away, turned at random, and a plane in its view at 100 m in all
    const double to_mirror = any.uniform(20, 80), angle = any.uniform(0.1, 0.7), turn = any.uniform(0, 2 * pi);
    const Vec3 normal{std::sin(angle) * std::cos(turn), -std::cos(angle), std::sin(angle) * std::sin(turn)},
        at{0, to_mirror, 0};
    const Vec3 side = normalize(cross(normal, any.unit())), there = mirrored(axis::forward, normal);
    const Vec3 wall_normal = normalize(0.3 * any.unit() - there), wall_side = normalize(cross(wall_normal, any.unit()));
    const Vec3 centre = at + (100 - to_mirror) * there;
    const World scene(
        {rectangle(at, 5.0 * side, 5.0 * cross(normal, side), clean(SmoothInterface::mirror(0.9))),
         rectangle(centre, 0.3 * wall_side, 0.3 * cross(wall_normal, wall_side), Material{.reflectance = 0.6})});
    const auto pulse =
        traced(LightPaths{}, scene, from_to({}, axis::forward), RingFootprint(3), {.laser = {.divergence = 1e-3}});
    balance = std::max(balance, std::fabs(pulse.imbalance()));
    // the mirrored place of the wall, met by the straight rays of the beam
    const SubrayDirections beam(RingFootprint(3), Emitter{.laser = {.divergence = 1e-3}});
    const Vec3 image{0, 100, 0}, image_normal = mirrored(wall_normal, normal);
    for (std::size_t j = 0; j < pulse.reflections.size(); ++j) {
      const Vec3 direction{beam.x[j], beam.y[j], beam.z[j]};
      worst = std::max(worst,
                       std::fabs(pulse.reflections[j].range - dot(image, image_normal) / dot(direction, image_normal)));
    }
    if (pulse.reflections.size() != RingFootprint(3).size()) worst = 1;
  }
  row("ghost in a mirror, 500 mirrors and walls at 100 m: largest distance from the mirrored place [m]", 0, worst,
      1e-9);
  row(Kind::consistency, "the same: energy sent, less all terms of the ledger, by it", 0, balance, 1e-9);
}

TEST_CASE("glass") {
  const SmoothInterface glass = SmoothInterface::glass();
  double worst = 0, shift = 0;
  for (int degrees = 0; degrees < 90; ++degrees) {
    const double a = degrees * 1_deg, n = glass.inside.index, b = std::asin(std::sin(a) / n);
    const double s = a > 0 ? std::sin(a - b) / std::sin(a + b) : (1 - n) / (1 + n),
                 p = a > 0 ? std::tan(a - b) / std::tan(a + b) : s;
    // the face in the xz plane; what it refracts is absorbed by a black wall, what it reflects misses
    const World scene({rectangle({0, 0, 0}, 900.0 * axis::right, 9.0 * axis::up, clean(glass)),
                       rectangle({0, 5, 0}, 900.0 * axis::right, 9.0 * axis::up, Material{.reflectance = 0})});
    const auto pulse = traced(LightPaths{}, scene, from_to({-std::tan(a), -1, 0.1}, {0, 0, 0.1}), SingleRay{},
                              {.receiver = {.diameter = 1e-4}});
    const double reflected = (pulse.result.energy.missed + pulse.result.energy.received) / pulse.result.energy.sent;
    if (degrees > 0) worst = std::max(worst, std::fabs(reflected - (s * s + p * p) / 2));

    // a pane of 10 mm, and behind it a wall that slants by 45 degrees, on which a shift to the side is one of range
    const SmoothInterface pane = SmoothInterface::pane(0.01);
    const Vec3 slant = normalize(Vec3{1, -1, 0}), turned{std::sin(a), -std::cos(a), 0};
    const World window({rectangle({0, 10, 0}, 90.0 * cross(turned, axis::up), 9.0 * axis::up, clean(pane)),
                        rectangle({0, 90, 0}, 50.0 * cross(slant, axis::up), 9.0 * axis::up, Material{})});
    const auto seen = traced(LightPaths{}, window, from_to({}, axis::forward), SingleRay{}).of(ReflectionKind::glass);
    const double lateral = 0.01 * std::sin(a - b) / std::cos(b), inside = 0.01 / std::cos(b);
    // straight on, the wall is 90 m away; aside by x it is at 90 - x or so, and the way inside counts by the group
    // index
    const double along = inside * std::cos(a - b),
                 expected = 10 + glass.inside.group_index * inside + (90 - 10 - along - lateral);
    if (seen.size() == 1 && degrees < 85) shift = std::max(shift, std::fabs(seen[0].range - expected));
  }
  row("Fresnel's split of light at glass, 1 to 89 degrees: largest error of the share reflected", 0, worst, 1e-6);
  row("lateral shift by a pane of 10 mm, 0 to 84 degrees, as range on a slanted wall: largest error [m]", 0, shift,
      1e-9);
}

TEST_CASE("water") {
  const Medium water{.index = 1.34, .group_index = 1.37, .absorption = 0.05, .scattering = 0.07, .backscatter = 0.004};
  double worst = 0, dimmed = 0, volume = 0, balance = 0;
  for (const double depth : {5.0, 12.0})
    for (int degrees = 0; degrees <= 40; degrees += 5) {
      const double a = degrees * 1_deg, b = std::asin(std::sin(a) / 1.34), height = 300;
      const auto lake = [&](const Medium& inside) {
        return World(
            {rectangle({}, 900.0 * axis::right, 900.0 * axis::forward,
                       clean({.kind = InterfaceKind::water, .inside = inside}), 1),
             rectangle({0, 0, -depth}, 900.0 * axis::right, 900.0 * axis::forward, Material{.reflectance = 0.2}, 2)});
      };
      const auto pose = from_to({0, 0, height}, {height * std::tan(a), 0, 0});
      const auto pulse = traced(LightPaths{}, lake(water), pose, SingleRay{}),
                 clear = traced(LightPaths{}, lake({1.34, 1.37}), pose, SingleRay{});
      balance = std::max(balance, std::fabs(pulse.imbalance()));
      const double above = height / std::cos(a), below = depth / std::cos(b),
                   clear_power = power_of(clear.of(ReflectionKind::water));
      const double column = pulse.between(0, 999, ReflectionKind::water).power;
      for (const Reflection& r : pulse.of(ReflectionKind::water)) {
        worst = std::max(worst, std::fabs(r.range / (above + 1.37 * below) - 1));
        dimmed = std::max(dimmed, std::fabs(r.power / clear_power / std::exp(-2 * 0.12 * below) - 1));
      }
      // against the bottom's echo, which is that of a surface of reflectance 0.2 at the end
      const auto spread2 = [&](double s) {
        return (1.34 * above + s) * (1.34 * above + s * std::pow(std::cos(a) / std::cos(b), 2));
      };
      const double sum =
          integral([&](double s) { return pi * 0.004 * std::exp(-2 * 0.12 * s) / spread2(s); }, 0, below, 4000) *
          spread2(below);
      volume = std::max(volume, std::fabs(column / (clear_power * sum / (0.2 * std::cos(b))) - 1));
    }
  row("bottom at 5 and 12 m, 0 to 40 degrees: largest error of the range, by it", 0, worst, 1e-9);
  row("the same: bottom's echo against exp(-2 Kd s), largest error, by it", 0, dimmed, 1e-9);
  row("the same: the column's echoes against their integral, largest error, by it", 0, volume, 1e-3);
  row(Kind::consistency, "the same: energy sent, less all terms of the ledger, by it", 0, balance, 1e-9);
}

TEST_CASE("refraction by waves") {
  // of thin beams from above: the angle between the refracted ray and the vertical, along one axis, at two standard
  // deviations. Source of the slopes: Cox & Munk 1954; of the angles: the tilt's share 1 - 1/n for small ones, here
  // exactly
  for (const double wind : {5.0, 10.0}) {
    const WaterSurface sea({{-500, -500}, {500, 500}}, WaveField(waves_of({.wind_speed = wind, .seed = 11})));
    double squares = 0, expected = 0;
    const int beams = 20'000;
    support::Generator any(3);
    for (int k = 0; k < beams; ++k) {
      const Ray down{.origin = {any.uniform(-400, 400), any.uniform(-400, 400), 50},
                     .direction = -axis::up,
                     .tick = Tick::of_seconds(any.uniform(0, 60))};
      ClosestHit hit(infinity);
      const SingleRayPacket ray(down);
      sea.closest(ray, hit);
      const Vec3 normal = sea.surface(hit.primitive_of(0), ray, 0).normal;
      const Vec3 below = refracted(down.direction, normal, 1.34, fresnel_split(normal.z, 1.34));
      squares += (std::pow(std::atan2(below.x, -below.z), 2) + std::pow(std::atan2(below.y, -below.z), 2)) / 2 / beams;
      const double tilt = std::atan(std::sqrt((0.003 + 0.00508 * wind) / 2) * any.normal());
      expected += std::pow(tilt - std::asin(std::sin(tilt) / 1.34), 2) / beams;
    }
    const std::string title = "refraction by waves at " + std::to_string(static_cast<int>(wind)) +
                              " m/s of wind, one axis, 2 sigma [degrees]";
    row(title, degrees(2 * std::sqrt(expected)), degrees(2 * std::sqrt(squares)),
        0.05 * degrees(2 * std::sqrt(expected)));
    row(Kind::published, title + ": Eren et al. 2018", wind == 5 ? 3.5 : 4.8, degrees(2 * std::sqrt(squares)),
        0.05 * (wind == 5 ? 3.5 : 4.8));
  }
}

TEST_CASE("fog") {
  const Medium fog{.absorption = 0.002, .scattering = 0.02, .backscatter = 0.001};
  const Laser laser{.divergence = 1e-3};
  // the waveform of fog from 20 m on, between 25 and 80 m, against the convolution of its profile with the pulse
  {
    const World nothing(std::vector<World::Part>{});
    const LightPaths light{.air = Media({{.medium = fog, .bounds = {{-99, 20, -99}, {99, 999, 99}}}})};
    const Platform source{Tripod{}, Mount{}, Deflector{FixedBeam{}, Scanner{.pulses = 1, .laser = laser}}};
    const WaveformSettings settings{.threshold = 1e-12, .record_length = 600e-9};
    const Survey survey{source, LatticeFootprint(19), nothing, light, vacuum, FullWaveform{settings}};
    auto w = survey.workspace();
    const Outcome o = survey(0, w);
    const LinkBudget budget(vacuum, laser);
    const PulseShape shape(laser.pulse_length);
    double worst = 0;
    for (std::size_t k = 0; k < o.waveform.size(); ++k) {
      const double time = o.shot.waveform_start + static_cast<double>(k) * settings.sample_interval,
                   range = time * speed_of_light / 2;
      if (range < 25 || range > 80) continue;
      const auto part = [&](double s) {
        return budget.power(1, pi * fog.backscatter * std::exp(-2 * fog.extinction() * (s - 20)), s) *
               shape(time - 2 * s / speed_of_light);
      };
      const double expected = integral(part, range - 4, range + 1.5, 3000);
      worst = std::max(worst, std::fabs(static_cast<double>(o.waveform[k]) / expected - 1));
    }
    row("waveform of fog from 25 to 80 m against its integral, largest error, by it", 0, o.waveform.empty() ? 1 : worst,
        0.01);
    row("echoes of homogeneous fog, besides that of its edge", 0, static_cast<double>(o.echoes.size()) - 1, 0);
  }
  // range at which half of the pulses still find a wall, in noise of 2 % of the threshold
  {
    const double threshold = LinkBudget(vacuum, laser).power(1, 0.5 * std::exp(-2 * fog.extinction() * 100), 100);
    const auto found = [&](double range) {
      const World wall({rectangle({0, range, 0}, 9.0 * axis::right, 9.0 * axis::up, Material{.reflectance = 0.5}, 7)});
      const LightPaths light{.air = Media({{.medium = fog}})};
      const Platform source{Tripod{}, Mount{}, Deflector{FixedBeam{}, Scanner{.pulses = 400, .laser = laser}}};
      const FullWaveform detector{WaveformSettings{.threshold = threshold, .window = 0}, NoWidth{},
                                  ReceiverNoise{.deviation = 0.02 * threshold}};
      const Receiver gated{.visibility = vacuum.visibility,
                           .range_min = 60};  // else the noise on the fog's own light is echoes
      const Survey survey{source, SingleRay{}, wall, light, gated, detector};
      auto w = survey.workspace();
      double pulses = 0;
      for (PulseIndex i = 0; i < survey.size(); ++i) {
        const Outcome o = survey(i, w);
        pulses += std::any_of(o.echoes.begin(), o.echoes.end(), [](const Echo& e) { return e.object == 7; }) ? 1 : 0;
      }
      return pulses / 400;
    };
    double near = 90, far = 110;
    for (int k = 0; k < 12; ++k) {
      const double middle = (near + far) / 2;
      (found(middle) > 0.5 ? near : far) = middle;
    }
    row("range at which half of the pulses find a wall in fog, threshold where P exp(-2 s R) / R^2 is [m]", 100, near,
        1);
  }
}

TEST_CASE("rain") {
  const Precipitation drops = rain(10, 905e-9);
  const Box box{{-9, 5, -9}, {9, 30, 9}};
  const support::Lamp base{.laser = {.wavelength = 905e-9, .divergence = 3e-3}};
  const double expected = drops.number() * pi * 9e-6 * (27'000 - 125) / 3;  // in a cone of two radii
  const World nothing(std::vector<World::Part>{});
  double count = 0, squares = 0;
  const int pulses = 4000;
  for (int k = 0; k < pulses; ++k) {
    support::Lamp lamp = base;
    lamp.index = static_cast<PulseIndex>(k);
    const auto n = static_cast<double>(traced(LightPaths{.air = Media({MediumRegion::of(drops, box)})}, nothing,
                                              from_to({}, axis::forward), SingleRay{}, lamp)
                                           .reflections.size());
    count += n / pulses;
    squares += n * n / pulses;
  }
  row("rain of 10 mm/h, 5 to 30 m before a beam of 3 mrad: mean number of drops", expected, count,
      3 * std::sqrt(expected / pulses));
  row("the same: variance of the number, by its mean", 1, (squares - count * count) / expected,
      3 * std::sqrt(2.0 / pulses));
}

TEST_CASE("light to and fro") {
  const auto to_and_fro = [](std::size_t orders, std::size_t paths) {
    return LightPaths{.spread_planes = false, .scattering = {.orders = orders, .paths = paths, .field_of_view = pi}};
  };
  // a plate 10 m before the scanner, and a ceiling 5 m above it
  {
    const World plates({rectangle({0, 10, 0}, 1e4 * axis::right, 1e4 * axis::up, Material{.reflectance = 0.6}),
                        rectangle({0, 0, 5}, 1e4 * axis::right, 1e4 * axis::forward, Material{.reflectance = 0.3})});
    double second = 0, first = 0;
    for (PulseIndex pulse = 0; pulse < 8; ++pulse) {
      support::Lamp lamp;
      lamp.index = pulse;
      const auto seen = traced(to_and_fro(2, 50'000), plates, from_to({}, axis::forward), SingleRay{}, lamp);
      second += power_of(seen.of(ReflectionKind::multiple));
      first += power_of(seen.of(ReflectionKind::surface));
    }
    const double near = std::pow(support::Lamp{}.receiver.diameter / 2, 2);
    const auto row_of_ceiling = [&](double y) {
      const auto at = [&](double u) {  // of the ceiling, at x = 5 tan(u)
        const double x = 5 * std::tan(u), d2 = x * x + (10 - y) * (10 - y) + 25, back2 = x * x + y * y + 25;
        return (10 - y) * 5 / (pi * d2 * d2) * 0.3 * 5 * y / back2 / (back2 + near) * 5 / std::pow(std::cos(u), 2);
      };
      return integral(at, -pi / 2, pi / 2, 400);
    };
    row("second order of a wall and a ceiling, by the first", integral(row_of_ceiling, 0, 10, 400) * (100 + near),
        second / first, 5e-4);
  }
  // a sphere, seen from its middle by a flat aperture: each order lights the wall evenly, and the mean of the cosine is
  // 1/4
  {
    const Scene<support::UnitBall> sphere({{.geometry = std::make_shared<const support::UnitBall>(),
                                            .materials = material_table({{.reflectance = 0.8}}),
                                            .placement = {.scale = 3}}});
    double before = 0, first = 0;
    for (std::size_t orders = 1; orders <= 6; ++orders) {
      const auto seen = traced(to_and_fro(orders, 100'000), sphere, from_to({}, axis::forward), SingleRay{});
      first = power_of(seen.of(ReflectionKind::surface));
      const double all = first + power_of(seen.of(ReflectionKind::multiple));
      if (orders > 1)
        row("integrating sphere of reflectance 0.8: order " + std::to_string(orders) + " by the first",
            0.25 * std::pow(0.8, static_cast<double>(orders) - 1), (all - before) / first, 4e-3);
      before = all;
    }
  }
  // a slab of leaves, 3 m thick, from 30 m above: leaves that send back evenly, and leaves of all directions
  for (const bool tilted : {false, true}) {
    constexpr double thickness = 3, height = 30, reflectance = 0.5, area = 0.8, k = 0.5 * area;
    VoxelData leaves{.corner = {-75, -75, -thickness}, .edge = thickness};
    for (std::uint32_t x = 0; x < 50; ++x)
      for (std::uint32_t y = 0; y < 50; ++y) leaves.cells.push_back({x, y, 0});
    leaves.densities.assign(leaves.cells.size(), static_cast<float>(area));
    const Scene<VoxelGrid<TransmissiveVoxels>> slab({{.geometry = std::make_shared<const VoxelGrid<TransmissiveVoxels>>(
                                                          leaves, TransmissiveVoxels{.tilted_leaves = tilted}),
                                                      .materials = material_table({{.reflectance = reflectance}})}});
    double second = 0, first = 0;
    for (PulseIndex pulse = 0; pulse < 40'000; ++pulse) {
      support::Lamp lamp;
      lamp.index = pulse;
      const auto seen = traced(
          LightPaths{
              .spread_planes = false, .scattering = {.orders = 2, .paths = 8, .field_of_view = pi}, .volume_cells = 4},
          slab, from_to({0.5, 0.5, height}, {0.5, 0.5, 0}), SingleRay{}, lamp);
      second += power_of(seen.of(ReflectionKind::multiple));
      first += power_of(seen.of(ReflectionKind::surface));
    }
    const double near = std::pow(support::Lamp{}.receiver.diameter / 2, 2);
    // scattered by a leaf at an angle to its way, by that of a white surface across it: Ross 1981
    const auto scattered = [&](double cosine) {
      const double angle = std::acos(std::clamp(cosine, -1.0, 1.0));
      return tilted ? reflectance * 2 / (3 * pi) * (std::sin(angle) - angle * cosine) : reflectance / 4;
    };
    const double back = tilted ? scattered(-1) : reflectance;
    const double met = integral(
        [&](double z) { return k * std::exp(-k * z) * back / (std::pow(height + z, 2) + near); }, 0, thickness, 1000);
    const auto from_depth = [&](double z1) {     // light scattered at a depth, and again on its way
      const auto towards = [&](double cosine) {  // downwards positive
        const double most = cosine > 0 ? (thickness - z1) / cosine : cosine < 0 ? -z1 / cosine : 1e3;
        return integral(
            [&](double s) {
              const double z = z1 + s * cosine, r2 = s * s * (1 - cosine * cosine), d2 = std::pow(height + z, 2) + r2;
              const double turn =
                  -(s * (1 - cosine * cosine) + cosine * (height + z)) / std::sqrt(d2);  // its cosine, to the receiver
              return k * std::exp(-k * s) * scattered(turn) / (d2 + near) *
                     std::exp(-k * z * std::sqrt(d2) / (height + z)) * (height + z) /
                     std::sqrt(d2);  // of a flat aperture
            },
            0, std::min(most, 60.0), 300);
      };
      const auto scattered_towards = [&](double cosine) { return 2 * scattered(cosine) * towards(cosine); };
      return k * std::exp(-k * z1) * integral(scattered_towards, -1, 1, 200);
    };
    const double both = integral(from_depth, 0, thickness, 60);
    row(tilted ? "second order in a slab of spherical leaves, by the first"
               : "second order in a slab of leaves, by the first",
        both / met, second / first, 0.01 * both / met);
  }
}
