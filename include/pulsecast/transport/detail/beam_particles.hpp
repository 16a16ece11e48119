// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_TRANSPORT_DETAIL_BEAM_PARTICLES_HPP
#define PULSECAST_TRANSPORT_DETAIL_BEAM_PARTICLES_HPP

#include <pulsecast/material/media.hpp>
#include <pulsecast/scanner/beam.hpp>
#include <pulsecast/transport/detail/light_ledger.hpp>

namespace PULSECAST_NAMESPACE::detail {

/// Rain and snow that a beam meets drop by drop: a Poisson process in its volume to two of its
/// radii, where 99.97 % of its light is. Pure in the pulse.
class BeamParticles {
 public:
  static constexpr double most = 1000;  ///< expected number of particles that are met one by one

  BeamParticles(const TransportInput& light, LightLedger& ledger) noexcept : light_(light), ledger_(ledger) {}

  /// Range up to which the particles of a stretch are met one by one [m]: `from` if none are.
  [[nodiscard]] double end(double from, double to, const MediumRegion& region, double density) const noexcept {
    const double per_volume = density * region.particles.number();
    if (!(per_volume > 0) || !(volume(0, 1) > 0)) return from;
    return std::clamp(range_of(0, most / per_volume), from, to);
  }

  /// Adds the echoes of the particles between two ranges [m], from a share of the light on both
  /// ways. `occluded(ray, range)` tells if a ray meets a surface.
  void meet(double from, double to, const MediumRegion& region, double density, double two_way_share,
            const auto& occluded) noexcept {
    const double all = volume(from, to), per_volume = density * region.particles.number();
    const Vec3 origin = light_.pulse.origin();
    const Rotation& turn = light_.pulse.pose.rotation;
    const Vec3 right = turn * axis::right, ahead = turn * axis::forward, up = turn * axis::up;
    for (double at = 0;; ++next_) {
      const auto [gap, place] = draw(0);
      at -= std::log(gap) / per_volume;
      if (!(at < all)) return;
      const auto [size, around] = draw(1);
      const double range = range_of(from, at), radius = 2 * std::sqrt(place);
      const Vec2 w = radii(range),
                 aside{radius * std::cos(2 * pi * around) * w.x, radius * std::sin(2 * pi * around) * w.y};
      const Vec3 to_it = range * ahead + aside.x * right + aside.y * up;
      const double distance = length(to_it);
      if (occluded(Ray{.origin = origin, .direction = to_it / distance, .tick = light_.pulse.tick}, distance)) continue;
      const double irradiance = 2 / (pi * w.x * w.y) * std::exp(-2 * radius * radius);  // [1/m^2]
      const double section = region.particles.backscatter_cross_section(region.particles.diameter(size));
      const double left = two_way_share * std::exp(-2 * density * region.medium.extinction() * (range - from));
      const double power = light_.budget.power(left, pi * section * irradiance, distance);
      if (power > 0 && light_.gate.contains(distance))
        ledger_.reflect({.range = distance}, power, {ReflectionKind::air});
    }
  }

 private:
  std::array<double, 2> draw(std::uint32_t part) const noexcept {
    const auto words = random_words({light_.seed, light_.index, next_, Purpose::drops, part});
    return {(words[0] + 0.5) * 0x1p-32, (words[1] + 0.5) * 0x1p-32};
  }

  /// Semi-axes of the beam at a range, at 1/e^2 [m].
  Vec2 radii(double range) const noexcept {
    return light_.emitter.footprint_scale * beam_radius(light_.emitter.laser, range);
  }

  /// Volume of the beam up to two of its radii, between two ranges [m^3].
  double volume(double from, double to) const noexcept {
    const Laser& laser = light_.emitter.laser;
    const double a = from - laser.waist_range, b = to - laser.waist_range, scale = light_.emitter.footprint_scale;
    return pi * laser.divergence.aspect() * scale * scale *
           (laser.waist_diameter * laser.waist_diameter * (b - a) +
            laser.divergence.across * laser.divergence.across * (b * b * b - a * a * a) / 3);
  }
  /// Range at which the beam has a volume from another range on [m]: bisection, as it may narrow.
  double range_of(double from, double wanted) const noexcept {
    double low = from, high = from + 1;
    while (volume(from, high) < wanted && high < 1e9) high = from + 2 * (high - from);
    for (int k = 0; k < 60 && high - low > 1e-12 * high; ++k) {
      const double middle = (low + high) / 2;
      (volume(from, middle) < wanted ? low : high) = middle;
    }
    return (low + high) / 2;
  }

  const TransportInput& light_;
  LightLedger& ledger_;
  std::uint32_t next_ = 0;  ///< number of the next particle of the pulse
};

}  // namespace PULSECAST_NAMESPACE::detail

#endif
