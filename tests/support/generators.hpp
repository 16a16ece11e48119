// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <pulsecast/base/frame.hpp>
#include <pulsecast/base/random.hpp>
#include <pulsecast/base/tick.hpp>
#include <pulsecast/geometry/box.hpp>
#include <pulsecast/geometry/bundle.hpp>

/// What tests are made with: random cases, laws, archetypes, checksums.
namespace pulsecast::support {

/// Random test cases, the same on every machine for the same seed. Put the seed into the failure message.
class Generator {
 public:
  explicit Generator(std::uint64_t seed) noexcept : seed_(seed) {}

  /// In (0, 1).
  [[nodiscard]] double uniform() noexcept { return pulsecast::uniform(next()); }
  [[nodiscard]] double uniform(double low, double high) noexcept { return low + (high - low) * uniform(); }

  /// Every decade between two positive numbers is as likely as every other.
  [[nodiscard]] double log_uniform(double low, double high) noexcept {
    return std::clamp(std::exp(uniform(std::log(low), std::log(high))), low, high);
  }

  /// A whole number in [0, n), for n up to 2^52.
  [[nodiscard]] std::uint64_t whole(std::uint64_t n) noexcept {
    return std::min(static_cast<std::uint64_t>(uniform() * static_cast<double>(n)), n - 1);
  }

  [[nodiscard]] double normal() noexcept { return pulsecast::normal(next()); }
  [[nodiscard]] bool coin() noexcept { return uniform() < 0.5; }

  /// Each coordinate in (-reach, reach).
  [[nodiscard]] Vec3 point(double reach) noexcept {
    const double x = uniform(-reach, reach), y = uniform(-reach, reach), z = uniform(-reach, reach);
    return {x, y, z};
  }

  /// A direction, every one as likely as every other.
  [[nodiscard]] Vec3 unit() noexcept {
    const double z = uniform(-1, 1), turn = uniform(0, 2 * pi), r = std::sqrt(1 - z * z);
    return normalize(Vec3{r * std::cos(turn), r * std::sin(turn), z});
  }

  /// Every rotation as likely as every other. Source: four normal numbers, normalised, are uniform on the sphere
  /// (Muller 1959).
  [[nodiscard]] Rotation rotation() noexcept {
    const double w = normal(), x = normal(), y = normal(), z = normal();
    return normalize(Rotation{w, x, y, z});
  }

  template <class From, class To>
  [[nodiscard]] Pose<From, To> pose(double reach) noexcept {
    const Rotation turn = rotation();
    return {turn, point(reach)};
  }

  /// Its centre is within reach, and each of its sides is log-uniform between two lengths.
  [[nodiscard]] Box box(double reach, double smallest, double largest) noexcept {
    const Vec3 centre = point(reach);
    const double x = log_uniform(smallest, largest), y = log_uniform(smallest, largest),
                 z = log_uniform(smallest, largest);
    const Vec3 half{x / 2, y / 2, z / 2};
    return {centre - half, centre + half};
  }

  /// Unit rays from one point that stay within an angle of an axis; the first ray is the axis itself.
  [[nodiscard]] RayBundle cone(const Vec3& origin, const Vec3& axis, double half_angle, std::size_t size) noexcept {
    RayBundle rays;
    rays.origin = origin;
    rays.size = size;
    rays.set_direction(0, axis);
    for (std::size_t j = 1; j < size; ++j) {
      const Vec3 across = cross(axis, unit());
      rays.set_direction(j, normalize(rotation_about(across, uniform(0, half_angle)) * axis));
    }
    rays.pad();
    return rays;
  }

 private:
  [[nodiscard]] RandomKey next() noexcept { return {seed_, drawn_++, 0, Purpose::scene}; }

  std::uint64_t seed_;
  PulseIndex drawn_ = 0;
};

/// The start, and 200 moments from a nanosecond to three years after it.
[[nodiscard]] inline std::vector<Tick> some_ticks(std::uint64_t seed) {
  Generator any(seed);
  std::vector<Tick> ticks{{0, 0}};
  for (int k = 0; k < 200; ++k) ticks.push_back(Tick::of_seconds(any.log_uniform(1e-9, 1e8)));
  return ticks;
}

}  // namespace pulsecast::support
