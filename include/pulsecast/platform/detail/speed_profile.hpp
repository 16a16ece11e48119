// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_PLATFORM_DETAIL_SPEED_PROFILE_HPP
#define PULSECAST_PLATFORM_DETAIL_SPEED_PROFILE_HPP

#include <algorithm>
#include <span>
#include <vector>

#include <pulsecast/base/require.hpp>
#include <pulsecast/base/search.hpp>
#include <pulsecast/base/tick.hpp>

namespace PULSECAST_NAMESPACE {

/// Time interval of constant jerk. `V` is a number or a vector, here in metres.
template <class V>
struct CubicPiece {
  double duration = 0;  ///< length of the interval [s]
  V position{};         ///< position at the start of the interval [m]
  V velocity{};         ///< velocity at the start [m/s]
  V acceleration{};     ///< acceleration at the start [m/s^2]
  V jerk{};             ///< constant jerk [m/s^3]

  /// State after a time [s]; `duration` is the rest.
  [[nodiscard]] CubicPiece after(double t) const noexcept {
    return {duration - t, position + t * (velocity + t / 2 * (acceleration + t / 3 * jerk)),
            velocity + t * (acceleration + t / 2 * jerk), acceleration + t * jerk, jerk};
  }
};

/// Motion in closed form: pieces in order of time, each valid until the next begins. The last state
/// of a shorter or the last piece holds on, and the start state of the first one holds before it.
template <class V>
class PiecewiseCubic {
 public:
  /// Rests at a position [m].
  explicit PiecewiseCubic(const V& position) { add({}, {.position = position}); }

  /// Appends a piece that replaces the motion from `start` on. Starts must not decrease.
  void add(Tick start, const CubicPiece<V>& piece) {
    PULSECAST_ASSERT(pieces_.empty() || !(start < pieces_.back().start));
    pieces_.push_back({start, piece});
  }

  /// State at a time; its duration is the rest of the piece.
  [[nodiscard]] CubicPiece<V> at(Tick t) const noexcept {
    const Timed& now = pieces_[detail::neighbours(pieces_.size(), [&](std::size_t i) noexcept {
                                 return !(t < pieces_[i].start);
                               }).before];
    const double elapsed = static_cast<double>(t.second - now.start.second) + (t.fraction - now.start.fraction);
    return now.piece.after(std::clamp(elapsed, 0.0, now.piece.duration));
  }

  /// As `at`, but at rest while a state holds on. Ticks are rounded: in the last picosecond of a piece, as in the next.
  [[nodiscard]] CubicPiece<V> moving_at(Tick t) const noexcept {
    constexpr double rounding = 1e-12;
    const CubicPiece<V> state = at(t);
    if (state.duration > rounding) return state;
    CubicPiece<V> next = at(t + Tick{0, rounding});
    next.position = state.position;
    return next.duration > 0 ? next : CubicPiece<V>{.position = state.position};
  }

  struct Timed {
    Tick start;           ///< start of the piece
    CubicPiece<V> piece;  ///< motion from its start on
  };
  [[nodiscard]] const std::vector<Timed>& pieces() const noexcept { return pieces_; }

 private:
  std::vector<Timed> pieces_;
};

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
