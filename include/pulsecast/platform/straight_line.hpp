// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_PLATFORM_STRAIGHT_LINE_HPP
#define PULSECAST_PLATFORM_STRAIGHT_LINE_HPP

#include <pulsecast/concepts.hpp>

namespace PULSECAST_NAMESPACE {

/// Straight motion at constant speed, at rest after its end. The body is level and looks along it, or north.
struct StraightLine {
  using refinements = refines<tag::MovesInLanes, tag::Differentiable, tag::Validated>;
  Vec3 from{};          ///< start, in the world [m]
  Vec3 to{0, 1000, 0};  ///< end, in the world [m]
  double speed = 60;    ///< speed along the path, slopes included [m/s]

  void validate() const {
    require_finite("StraightLine::from (length)", length(from), "m");
    require_finite("StraightLine::to (length)", length(to), "m");
    require_positive("StraightLine::speed", speed, "m/s");
    require_within("StraightLine (duration)", length(to - from) / speed, 0, 1e15, "s");
  }

  /// Arrival time, and so the duration of a scan of the whole line.
  [[nodiscard]] Tick duration() const noexcept { return Tick::of_seconds(length(to - from) / speed); }

  [[nodiscard]] auto at(Tick t) const noexcept { return pose_in_lanes(*this, t); }
  [[nodiscard]] Derivatives derivatives(Tick t) const noexcept {
    const double whole = length(to - from);
    return whole > 0 && speed * t.seconds() < whole ? Derivatives{.velocity = (speed / whole) * (to - from)}
                                                    : Derivatives{};
  }

  /// One copy of the code, as compilers may contract products and sums in different ways.
  [[gnu::noinline]] simd::Mask poses(const TickLanes& t, PoseLanes<frame::Body, frame::World>& poses) const noexcept {
    const Vec3 path = to - from;
    const double whole = length(path);
    const simd::Doubles gone = speed * t.seconds(), share = gone / whole;
    const auto on_the_way = gone < (whole > 0 ? whole : -detail::infinity);
    const auto between = [&](double a, double way, double b) {
      return on_the_way ? a + way * share : simd::Doubles{} + b;
    };
    poses.rotation = RotationLanes(level(heading_of(path)));
    poses.position = {between(from.x, path.x, to.x), between(from.y, path.y, to.y), between(from.z, path.z, to.z)};
    return all_lanes();
  }
};

}  // namespace PULSECAST_NAMESPACE

#endif
