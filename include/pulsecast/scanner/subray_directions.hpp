// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SCANNER_SUBRAY_DIRECTIONS_HPP
#define PULSECAST_SCANNER_SUBRAY_DIRECTIONS_HPP

#include <pulsecast/base/shared_array.hpp>
#include <pulsecast/concepts.hpp>

namespace PULSECAST_NAMESPACE {

/// Unit direction of a subray in the frame of its beam; +y for zero offset.
/// `offset` is in units of the beam's 1/e^2 radius, which is half the divergence in the far field.
[[nodiscard]] inline Vec3 subray_direction(const Vec2& offset, const Divergence& divergence) noexcept {
  const Vec2 scaled{offset.x, offset.y * divergence.aspect()};
  const double radius = std::hypot(scaled.x, scaled.y);
  if (radius == 0) return axis::forward;
  const double angle = radius * divergence.across / 2;
  const double aside = std::sin(angle) / radius;
  return {aside * scaled.x, std::cos(angle), aside * scaled.y};
}

/// Origin of a subray in the frame of its beam, at the exit [m]; zero for a beam from a point.
/// Otherwise subrays pass the waist a quarter turn ahead of their azimuth, rulings of a
/// hyperboloid: at all ranges, their distances from the axis are those of the footprint times
/// `beam_radius`.
[[nodiscard]] inline Vec3 subray_exit(const Vec2& offset, const Laser& laser) noexcept {
  const Vec3 direction = subray_direction(offset, laser.divergence);
  const Vec3 at_waist = 0.5 * laser.waist_diameter * Vec3{-offset.y, 0, offset.x * laser.divergence.aspect()};
  return at_waist - direction * (laser.waist_range / direction.y) + Vec3{0, laser.waist_range, 0};
}

/// Subrays of an emitter's beam, in its frame, padded to whole SIMD vectors. Copies share memory.
class SubrayDirections {
 public:
  const double* x = nullptr;       ///< components of the unit directions to the right
  const double* y = nullptr;       ///< components forward
  const double* z = nullptr;       ///< components up
  const double* shares = nullptr;  ///< shares of the energy
  const Vec3* exits = nullptr;     ///< exit points; null for a beam from a point [m]
  double spread = 0;               ///< greatest distance of a unit direction from the beam's axis
  double share_sum = 0;            ///< sum of the shares, in order

  /// Beam without subrays.
  SubrayDirections() = default;
  /// Takes a valid footprint and emitter.
  SubrayDirections(const Footprint auto& footprint, const Emitter& emitter)
      : SubrayDirections(footprint.size(), emitter.laser) {
    assign(footprint.size(), emitter, [&](std::size_t j) noexcept {
      return Subray{footprint.offset(j), footprint.share(j)};
    });
  }
  /// Room for up to `size` subrays of any laser, which `assign` sets.
  [[nodiscard]] static SubrayDirections room(std::size_t size) { return {size, Laser{.waist_diameter = 1}}; }

  /// Subray, as of a `Footprint`.
  struct Subray {
    Vec2 offset;   ///< in units of the 1/e^2 radius
    double share;  ///< of the pulse's energy, without unit
  };
  /// Replaces the subrays by `subray(j)`; there must be room for `size`. Changes all copies.
  void assign(std::size_t size, const Emitter& emitter, const auto& subray) noexcept {
    PULSECAST_ASSERT(size + RayBundle::lanes <= padded_);
    exits = emitter.laser.from_a_point() ? nullptr : exits_.data();
    spread = share_sum = 0;
    for (std::size_t j = 0; j < size; ++j) {
      const Subray s = subray(j);
      set(j, emitter.footprint_scale * s.offset, s.share, emitter.laser);
    }
    for (std::size_t column = 0; column < 4; ++column)
      std::fill_n(columns_.data() + column * padded_ + size, RayBundle::lanes, 0.0);
  }

  [[nodiscard]] bool from_a_point() const noexcept { return !exits; }  ///< true for a single exit

  /// True if two emitters with the same footprint have equal subrays.
  [[nodiscard]] static bool equal(const Emitter& a, const Emitter& b) noexcept {
    return a.footprint_scale == b.footprint_scale && a.laser.divergence == b.laser.divergence &&
           a.laser.waist_diameter == b.laser.waist_diameter && a.laser.waist_range == b.laser.waist_range;
  }

  /// Sets the directions of a bundle, whose size is set, from those of subrays `first` on.
  void to_world(const Matrix3& world_from_beam, std::size_t first, RayBundle& rays) const noexcept {
    const Vec3 across = world_from_beam[0], ahead = world_from_beam[1], above = world_from_beam[2];
    rays.set_directions([&](std::size_t j) noexcept -> RayBundle::Directions {
      const simd::Doubles right = simd::load<simd::Doubles>(x[first + j]),
                          forward = simd::load<simd::Doubles>(y[first + j]),
                          up = simd::load<simd::Doubles>(z[first + j]);
      return {right * across.x + forward * ahead.x + up * above.x, right * across.y + forward * ahead.y + up * above.y,
              right * across.z + forward * ahead.z + up * above.z};
    });
  }

 private:
  SubrayDirections(std::size_t size, const Laser& laser)
      : padded_(size + RayBundle::lanes), columns_(4 * padded_), exits_(laser.from_a_point() ? 0 : size) {
    x = columns_.data();
    y = x + padded_;
    z = y + padded_;
    shares = z + padded_;
  }

  void set(std::size_t j, const Vec2& offset, double share, const Laser& laser) noexcept {
    const Vec3 direction = subray_direction(offset, laser.divergence);
    columns_[j] = direction.x;
    columns_[padded_ + j] = direction.y;
    columns_[2 * padded_ + j] = direction.z;
    columns_[3 * padded_ + j] = share;
    spread = std::max(spread, length(direction - axis::forward));
    share_sum += share;
    if (exits) exits_[j] = subray_exit(offset, laser);
  }

  std::size_t padded_ = 0;
  SharedBuffer<double> columns_;
  SharedBuffer<Vec3> exits_;
};

}  // namespace PULSECAST_NAMESPACE

#endif
