// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_BASE_ERROR_SOURCE_HPP
#define PULSECAST_BASE_ERROR_SOURCE_HPP

#include <optional>

#include <pulsecast/base/frame.hpp>

/// Errors that a source draws, in the form in which they are stated: one standard deviation of each.
namespace PULSECAST_NAMESPACE {

/// How long a drawn error stays the same.
enum class ErrorScope : std::uint8_t {
  pulse,       ///< drawn anew for each pulse: random
  correlated,  ///< of neighbouring pulses alike, as a drift
  leg,         ///< drawn once for a leg
  survey,      ///< drawn once for a survey; also an error of a known size
};

/// Displacement of reported points by one standard deviation of an error that is independent of others. In a frame:
/// moved, and turned about a point, as a rigid body.
template <class Frame>
struct PoseError {
  Vec3 moved{};                          ///< translation [m]
  Vec3 turned{};                         ///< small rotation: axis times angle [rad]
  std::optional<Vec3> about{};           ///< point that rotations leave in place [m]; empty: the exit of the beam
  ErrorScope scope = ErrorScope::pulse;  ///< how long it stays the same
  double moved_any_way = 0;              ///< independent translations along all axes, of this size; else 0 [m]
  double turned_any_way = 0;             ///< independent rotations about all axes, of this size; else 0 [rad]
};

/// Error in the frame around its own.
template <class Inner, class Outer>
[[nodiscard]] PoseError<Outer> operator*(const Pose<Inner, Outer>& pose, const PoseError<Inner>& error) noexcept {
  PoseError<Outer> out{pose.direction(error.moved)};
  out.turned = pose.direction(error.turned);
  if (error.about) out.about = pose.point(*error.about);
  out.scope = error.scope;
  out.moved_any_way = error.moved_any_way;
  out.turned_any_way = error.turned_any_way;
  return out;
}

namespace detail {
/// Axis times angle of a rotation [rad].
[[nodiscard]] inline Vec3 turn_of(const Rotation& r) noexcept {
  const Vec3 axis{r.x, r.y, r.z};
  const double size = length(axis), turn = r.w < 0 ? -2 : 2;  // a quaternion and its negative are one rotation
  return size > 0 ? turn * std::atan2(size, std::fabs(r.w)) / size * axis : Vec3{};
}
}  // namespace detail

/// Error that displaces a body from one pose to another, as of a known size.
template <class Body, class Frame>
[[nodiscard]] PoseError<Frame> error_between(const Pose<Body, Frame>& from, const Pose<Body, Frame>& to) noexcept {
  return {.moved = to.position - from.position,
          .turned = detail::turn_of(to.rotation * conjugate(from.rotation)),
          .about = from.position,
          .scope = ErrorScope::survey};
}

/// Covariance of a vector: a symmetric matrix [m^2].
struct Covariance {
  double xx = 0, yy = 0, zz = 0;  ///< variances
  double xy = 0, xz = 0, yz = 0;  ///< covariances

  /// Adds that of an error along a vector, whose length is a standard deviation [m], or its multiple.
  [[gnu::always_inline]] void add(const Vec3& v, double factor = 1) noexcept {
    const Vec3 by = factor * v;
    xx += by.x * v.x;
    yy += by.y * v.y;
    zz += by.z * v.z;
    xy += by.x * v.y;
    xz += by.x * v.z;
    yz += by.y * v.z;
  }
  /// Adds the same variance in all directions [m^2].
  void add(double variance) noexcept {
    xx += variance;
    yy += variance;
    zz += variance;
  }
  /// Adds that of independent errors.
  void add(const Covariance& other) noexcept {
    xx += other.xx;
    yy += other.yy;
    zz += other.zz;
    xy += other.xy;
    xz += other.xz;
    yz += other.yz;
  }
  /// Variance along a unit vector [m^2].
  [[nodiscard]] double along(const Vec3& v) const noexcept {
    return v.x * (xx * v.x + 2 * (xy * v.y + xz * v.z)) + v.y * (yy * v.y + 2 * yz * v.z) + v.z * zz * v.z;
  }
  /// The same in axes that `turn(v)` maps a vector to.
  [[nodiscard]] Covariance in_axes(const auto& turn) const noexcept {
    const Vec3 x = turn(Vec3{xx, xy, xz}), y = turn(Vec3{xy, yy, yz}), z = turn(Vec3{xz, yz, zz});  // columns, turned
    const Vec3 a = turn(Vec3{x.x, y.x, z.x}), b = turn(Vec3{x.y, y.y, z.y}), c = turn(Vec3{x.z, y.z, z.z});
    return {a.x, b.y, c.z, a.y, a.z, b.z};
  }
};

/// Stated error of a point: reported place less the centroid of the power that its pulse lit.
struct PointUncertainty {
  /// Reasons why an error may be greater than stated.
  enum Flag : std::uint8_t {
    mixed = 1,     ///< the beam did not lie on one smooth, evenly bright surface, or was not judged
    weak = 2,      ///< so near the noise that an echo may be lost, or its range off
    indirect = 4,  ///< light by way of glass, water, mirrors or haze
    biased = 8,    ///< on a slope, the detector errs by more than a fifth of the stated deviation
    unstated = 16  ///< the instrument measures its beam with errors that it does not state
  };
  Covariance random{};      ///< of errors that are drawn anew for each pulse [m^2]
  Covariance systematic{};  ///< of those that neighbouring points share [m^2]
  std::uint8_t flags = 0;   ///< sum of `Flag`; 0: as stated

  /// Covariance of the whole error [m^2].
  [[nodiscard]] Covariance total() const noexcept {
    Covariance both = random;
    both.add(systematic);
    return both;
  }
};

}  // namespace PULSECAST_NAMESPACE

#endif
