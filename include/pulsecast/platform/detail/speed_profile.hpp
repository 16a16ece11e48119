// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_PLATFORM_DETAIL_SPEED_PROFILE_HPP
#define PULSECAST_PLATFORM_DETAIL_SPEED_PROFILE_HPP

#include <span>

#include <pulsecast/platform/detail/piecewise_cubic.hpp>

namespace PULSECAST_NAMESPACE {

/// Limits of a motion along a line.
struct SpeedLimits {
  double speed = 1;         ///< maximum [m/s]
  double acceleration = 1;  ///< maximum when speeding up [m/s^2]
  double braking = 1;       ///< maximum deceleration [m/s^2]
  double jerk = 1;          ///< maximum change of acceleration [m/s^3]
};

/// Fastest change of speed between states of zero acceleration, which rises, holds, and falls.
/// Source: Biagiotti & Melchiorri 2008, section 3.4, acceleration phase of the double S profile.
struct SpeedChange {
  double from = 0;          ///< initial speed [m/s]
  double to = 0;            ///< final speed [m/s]
  double acceleration = 1;  ///< maximum magnitude [m/s^2]
  double jerk = 1;          ///< magnitude while the acceleration rises or falls [m/s^3]

  /// Duration of the rise of the acceleration, equal to that of its fall [s].
  [[nodiscard]] double ramp() const noexcept {
    return std::fmin(acceleration / jerk, std::sqrt(std::fabs(to - from) / jerk));
  }

  /// Duration of constant acceleration in between [s].
  [[nodiscard]] double hold() const noexcept {
    return std::fmax(0.0, std::fabs(to - from) / acceleration - acceleration / jerk);
  }

  [[nodiscard]] double duration() const noexcept { return 2 * ramp() + hold(); }  ///< total [s]

  /// Length driven: the speed is symmetric about its mean, so mean times duration [m].
  [[nodiscard]] double distance() const noexcept { return 0.5 * (from + to) * duration(); }

  /// Appends its pieces, which begin at a position [m].
  void add_to(std::vector<CubicPiece<double>>& pieces, double position) const {
    if (from == to) return;
    const double rise = std::copysign(jerk, to - from), t = ramp(), most = rise * t, gain = 0.5 * most * t;
    const CubicPiece<double> first{t, position, from, 0, rise};
    const CubicPiece<double> second{hold(), first.after(t).position, from + gain, most, 0};
    const CubicPiece<double> third{t, second.after(hold()).position, to - gain, most, -rise};
    pieces.insert(pieces.end(), {first, second, third});
  }
};

/// Largest speed from `low` to `high` that fits, by bisection. `low` and all below one must fit.
[[nodiscard]] double max_speed(double low, double high, auto&& fits) {
  if (fits(high)) return high;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (fits(middle) ? low : high) = middle;
  }
  return low;
}

/// Fastest motion over a length [m] between two speeds [m/s] that `reachable_speed` allows, in up
/// to seven pieces. Source: Biagiotti & Melchiorri 2008, section 3.4.
[[nodiscard]] inline std::vector<CubicPiece<double>> speed_profile(double length, double from, double to,
                                                                   const SpeedLimits& limits) {
  const auto rise = [&](double speed) { return SpeedChange{from, speed, limits.acceleration, limits.jerk}; };
  const auto fall = [&](double speed) { return SpeedChange{speed, to, limits.braking, limits.jerk}; };
  const double most = max_speed(std::fmax(from, to), std::fmax(limits.speed, std::fmax(from, to)), [&](double speed) {
    return rise(speed).distance() + fall(speed).distance() <= length;
  });
  const double begin = rise(most).distance(), end = std::fmax(begin, length - fall(most).distance());
  std::vector<CubicPiece<double>> pieces;
  rise(most).add_to(pieces, 0);
  if (end > begin && most > 0) pieces.push_back({(end - begin) / most, begin, most, 0, 0});
  fall(most).add_to(pieces, end);
  return pieces;
}

/// Highest speed after a length [m], from an initial speed [m/s].
[[nodiscard]] inline double reachable_speed(double length, double from, double acceleration,
                                            const SpeedLimits& limits) {
  return max_speed(from, std::fmax(from, limits.speed), [&](double speed) {
    return SpeedChange{from, speed, acceleration, limits.jerk}.distance() <= length;
  });
}

/// Section of a path, driven without a stop in between.
struct PathSection {
  double length = 0;     ///< [m]
  SpeedLimits limits{};  ///< limits all along it
};

/// Lowers the speeds at the joints of sections, until each can be driven within its limits:
/// forwards for speeding up, backwards for braking. Source: look-ahead of machine tools.
inline void settle_speeds(std::span<double> joints, std::span<const PathSection> sections) {
  PULSECAST_ASSERT(joints.size() == sections.size() + 1);
  for (std::size_t k = 0; k < sections.size(); ++k) {
    const PathSection& s = sections[k];
    if (joints[k + 1] > joints[k])
      joints[k + 1] = std::fmin(joints[k + 1], reachable_speed(s.length, joints[k], s.limits.acceleration, s.limits));
  }
  for (std::size_t k = sections.size(); k-- > 0;) {
    const PathSection& s = sections[k];
    if (joints[k] > joints[k + 1])
      joints[k] = std::fmin(joints[k], reachable_speed(s.length, joints[k + 1], s.limits.braking, s.limits));
  }
}

}  // namespace PULSECAST_NAMESPACE

#endif
