// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_PLATFORM_MULTICOPTER_HPP
#define PULSECAST_PLATFORM_MULTICOPTER_HPP

#include <pulsecast/concepts.hpp>
#include <pulsecast/platform/detail/speed_profile.hpp>

namespace PULSECAST_NAMESPACE {

/// Waypoint of a multicopter.
struct FlightPoint {
  Vec3 position{};   ///< position in the world [m]
  double hover = 0;  ///< minimum duration of the stay; 0 to pass, with smooth turns [s]
};

/// Flight at the waypoints between the first and the last.
enum class MulticopterTurn {
  stop_and_turn,  ///< hovers at each waypoint until it faces the next leg
  smooth,         ///< cuts the corner; stops to hover, or to turn by more than 150 degrees
};

/// Limits and style of a multicopter's flight.
struct MulticopterSettings {
  double speed = 8;                                ///< maximum [m/s]
  double acceleration = 3;                         ///< maximum in any direction [m/s^2]
  double jerk = 6;                                 ///< maximum in any direction [m/s^3]
  double bank_max = pi / 6;                        ///< maximum angle from upright [rad]
  double yaw_rate = pi / 2;                        ///< maximum [rad/s]
  MulticopterTurn turn = MulticopterTurn::smooth;  ///< at waypoints between the ends
  double turn_distance = 10;                       ///< maximum from its begin to its waypoint [m]
  std::optional<double> departure_heading{};       ///< from north; along the first leg if empty [rad]
  std::optional<double> arrival_heading{};         ///< from north; along the last leg if empty [rad]

  void validate() const {
    require_within("MulticopterSettings::speed", speed, 1e-3, 1e3, "m/s");
    require_within("MulticopterSettings::acceleration", acceleration, 1e-3, 1e3, "m/s^2");
    require_within("MulticopterSettings::jerk", jerk, 1e-3, 1e3, "m/s^3");
    require_within("MulticopterSettings::bank_max", bank_max, 1e-3, 1.5, "rad");
    require_within("MulticopterSettings::yaw_rate", yaw_rate, 1e-3, 1e3, "rad/s");
    require_within("MulticopterSettings::turn_distance", turn_distance, 1e-3, 1e9, "m");
    if (departure_heading) require_angle("MulticopterSettings::departure_heading", *departure_heading);
    if (arrival_heading) require_angle("MulticopterSettings::arrival_heading", *arrival_heading);
  }
};

/// Flight in pieces of constant jerk. Thrust alone moves it: its up axis follows acceleration and
/// lift, tan(bank) = v^2 / (g r) in a level turn. Position, velocity and attitude are continuous.
class MulticopterFlight {
 public:
  using refinements = refines<tag::Differentiable>;
  /// `motion` [m]; `heading` clockwise from north [rad]; `passes` by waypoint: `plan_multicopter`.
  MulticopterFlight(PiecewiseCubic<Vec3> motion, PiecewiseCubic<double> heading, Tick duration,
                    std::vector<Tick> passes = {})
      : motion_(std::move(motion)), heading_(std::move(heading)), duration_(duration), passes_(std::move(passes)) {}

  [[nodiscard]] Pose<frame::Body, frame::World> at(Tick t) const noexcept {
    const CubicPiece<Vec3> state = motion_.at(t);
    const Vec3 thrust = normalize(state.acceleration + standard_gravity * axis::up);
    const Rotation lean = normalize(detail::rotation_wxyz(1 + thrust.z, -thrust.y, thrust.x, 0));
    return {lean * level(heading_.at(t).position), state.position};
  }

  /// Source: rate of a unit quaternion, twice the vector of q^-1 q', here of q / |q|. Attitude depends on acceleration,
  /// so its rate jumps with the jerk.
  [[nodiscard]] Derivatives derivatives(Tick t) const noexcept {
    const CubicPiece<Vec3> state = motion_.moving_at(t);
    const CubicPiece<double> heading = heading_.moving_at(t);
    const Vec3 thrust = state.acceleration + standard_gravity * axis::up, jerk = state.jerk;
    const Vec3 axis{-thrust.y, thrust.x, 0}, axis_rate{-jerk.y, jerk.x, 0};
    const double whole = length(thrust), gain = dot(thrust, jerk) / whole,
                 bend = (dot(jerk, jerk) - gain * gain) / whole;
    const double w = whole + thrust.z, w_rate = gain + jerk.z, square = w * w + dot(axis, axis);
    Derivatives d{.velocity = state.velocity, .acceleration = state.acceleration};
    d.angular_rate = (2 / square) * (w * axis_rate - w_rate * axis - cross(axis, axis_rate));
    d.angular_acceleration = (-2 / square) * (bend * axis + (w * w_rate + dot(axis, axis_rate)) * d.angular_rate);
    d.turn_by(level(heading.position), -heading.velocity * axis::up, -heading.acceleration * axis::up);
    return d;
  }

  [[nodiscard]] Tick duration() const noexcept { return duration_; }

  /// Passing time of each waypoint of the plan: the middle of its turn, or the begin of its hover.
  [[nodiscard]] const std::vector<Tick>& passes() const noexcept { return passes_; }

  [[nodiscard]] const PiecewiseCubic<Vec3>& motion() const noexcept { return motion_; }  ///< position [m]
  /// Clockwise from north over time [rad].
  [[nodiscard]] const PiecewiseCubic<double>& heading() const noexcept { return heading_; }

 private:
  PiecewiseCubic<Vec3> motion_;
  PiecewiseCubic<double> heading_;
  Tick duration_;
  std::vector<Tick> passes_;
};

namespace detail {

/// Largest acceleration along a unit direction [m/s^2]: within the bank, and with a tenth of the
/// weight as thrust. Source: tan(bank) = horizontal / (g + vertical acceleration).
[[nodiscard]] inline double acceleration_along(const Vec3& direction, const MulticopterSettings& settings) noexcept {
  const double bank = std::tan(settings.bank_max), lean = std::hypot(direction.x, direction.y) - bank * direction.z;
  double most = settings.acceleration;
  if (lean > 0) most = std::fmin(most, bank * standard_gravity / lean);
  if (direction.z < 0) most = std::fmin(most, -0.9 * standard_gravity / direction.z);
  return most;
}

/// Turn between two unit directions at a waypoint: the velocity changes along a line, so the speed
/// never grows. Source: Craig 2005, sec. 7.3, straight lines with blends.
struct SmoothTurn {
  Vec3 before{};        ///< direction in, unit
  Vec3 after{};         ///< direction out, unit
  SpeedChange limit{};  ///< limits of acceleration and jerk

  [[nodiscard]] SpeedChange change(double speed) const noexcept {
    return {0, speed * length(after - before), limit.acceleration, limit.jerk};
  }
  /// Length from the begin of the turn to the waypoint, equal to that from there to its end [m].
  [[nodiscard]] double distance(double speed) const noexcept { return 0.5 * speed * change(speed).duration(); }
};

/// Flight under construction, at its current time and state.
class FlightPlan {
 public:
  FlightPlan(const Vec3& position, double heading, double yaw_rate)
      : motion_(position), heading_(heading), yaw_rate_(yaw_rate) {}

  /// Appends motion along a unit direction from a point, superposed on a constant velocity.
  void fly(const std::vector<CubicPiece<double>>& pieces, const Vec3& from, const Vec3& direction,
           const Vec3& drift = {}) {
    double elapsed = 0;
    for (const auto& p : pieces) {
      const Vec3 start = from + p.position * direction + elapsed * drift, velocity = p.velocity * direction + drift;
      if (p.duration > 0)
        motion_.add(now_, {p.duration, start, velocity, p.acceleration * direction, p.jerk * direction});
      now_ = now_ + Tick::of_seconds(p.duration);
      elapsed += p.duration;
    }
  }

  /// Hovers at a point for a time [s], and until it faces a heading.
  void stand(const Vec3& at, double time, double heading) {
    motion_.add(now_, {.position = at});
    now_ = now_ + Tick::of_seconds(std::fmax(time, turn_to(heading, 0)));
  }

  /// Turns to a heading by the smaller angle, within a time if the yaw rate allows. Returns it [s].
  double turn_to(double heading, double time) {
    const double yaw = heading_.at(now_).position, angle = std::remainder(heading - yaw, 2 * pi);
    const double needed = std::fmax(time, std::fabs(angle) / yaw_rate_);
    heading_.add(now_, {needed, yaw, needed > 0 ? angle / needed : 0, 0, 0});
    return needed;
  }

  /// Passes the next waypoint after a time [s].
  void pass(double after) { passes_.push_back(now_ + Tick::of_seconds(after)); }

  /// Finished flight; `numbers` maps each waypoint to its passing.
  [[nodiscard]] MulticopterFlight flight(const std::vector<std::size_t>& numbers) && {
    std::vector<Tick> passes;
    for (const std::size_t k : numbers) passes.push_back(passes_[k]);
    return {std::move(motion_), std::move(heading_), now_, std::move(passes)};
  }

 private:
  PiecewiseCubic<Vec3> motion_;
  PiecewiseCubic<double> heading_;
  double yaw_rate_;
  Tick now_{};
  std::vector<Tick> passes_;
};

/// Checked waypoints, those less than a nanometre from the one before merged into it with the sum
/// of hover times. `numbers` maps each to its merged waypoint. Throws a `SettingError`.
[[nodiscard]] inline std::vector<FlightPoint> checked(std::span<const FlightPoint> waypoints,
                                                      std::vector<std::size_t>& numbers) {
  require_within("plan_multicopter: waypoints (number)", waypoints.size(), 1, 1e7, "");
  std::vector<FlightPoint> points;
  for (std::size_t k = 0; k < waypoints.size(); ++k) {
    const std::string name = "plan_multicopter: waypoints[" + std::to_string(k) + "].";
    const FlightPoint& point = waypoints[k];
    require_within(name + "position.x", point.position.x, -1e9, 1e9, "m");
    require_within(name + "position.y", point.position.y, -1e9, 1e9, "m");
    require_within(name + "position.z", point.position.z, -1e9, 1e9, "m");
    require_within(name + "hover", point.hover, 0, 1e9, "s");
    const bool again = !points.empty() && length(point.position - points.back().position) < 1e-9;
    if (again) points.back().hover += point.hover;
    if (!again) points.push_back(point);
    numbers.push_back(points.size() - 1);
  }
  return points;
}

/// Legs of a flight: from each waypoint to the next.
struct FlightLegs {
  std::vector<Vec3> directions;       ///< unit
  std::vector<double> headings;       ///< [rad]
  std::vector<PathSection> sections;  ///< lengths, and limits along the leg

  FlightLegs(const std::vector<FlightPoint>& points, const MulticopterSettings& settings)
      : directions(points.size() - 1), headings(directions.size()), sections(directions.size()) {
    double heading = settings.departure_heading.value_or(0);
    bool level_leg = settings.departure_heading.has_value();  // true once a heading is known
    for (std::size_t k = 0; k < directions.size(); ++k) {
      const Vec3 way = points[k + 1].position - points[k].position;
      directions[k] = normalize(way);
      const double ahead = acceleration_along(directions[k], settings),
                   back = acceleration_along(-directions[k], settings);
      sections[k] = {length(way), {settings.speed, ahead, back, settings.jerk}};
      if (std::hypot(directions[k].x, directions[k].y) > 1e-6) {
        heading = heading_of(directions[k]);
        if (!level_leg) std::fill_n(headings.begin(), k, heading);  // of a vertical start
        level_leg = true;
      }
      headings[k] = heading;
    }
  }
};

}  // namespace detail

/// Plans a flight through the waypoints, at rest at both ends. The vehicle faces its leg, keeps its
/// heading on a vertical one, and turns in place at both ends. Legs take the least time that speed,
/// acceleration, jerk and bank allow. A smooth turn takes at most a third of either leg, so close
/// waypoints are slow; those less than a nanometre apart are one. Throws a `SettingError`.
[[nodiscard]] inline MulticopterFlight plan_multicopter(std::span<const FlightPoint> waypoints,
                                                        const MulticopterSettings& settings = {}) {
  settings.validate();
  std::vector<std::size_t> numbers;
  const std::vector<FlightPoint> points = detail::checked(waypoints, numbers);
  const std::size_t legs = points.size() - 1;
  const auto [directions, headings, sections] = detail::FlightLegs(points, settings);

  std::vector<double> speeds(points.size(), 0.0);  // at the waypoints
  std::vector<detail::SmoothTurn> turns(points.size());
  const double sharpest = -0.5 * std::sqrt(3.0);  // cos(150 deg)
  for (std::size_t k = 1; k < legs; ++k) {
    const Vec3 before = directions[k - 1], after = directions[k];
    if (settings.turn == MulticopterTurn::stop_and_turn || points[k].hover > 0 || dot(before, after) < sharpest)
      continue;
    const Vec3 change = after - before;
    const bool turned = length(change) > 0;
    const double most = turned ? detail::acceleration_along(normalize(change), settings) : settings.acceleration;
    turns[k] = {before, after, {0, 0, most, settings.jerk}};
    const double shorter = std::fmin(sections[k - 1].length, sections[k].length);
    const double room = std::fmin(settings.turn_distance, shorter / 3);
    speeds[k] = max_speed(0, settings.speed, [&](double speed) { return turns[k].distance(speed) <= room; });
  }
  std::vector<PathSection> straights = sections;
  for (std::size_t k = 0; k < legs; ++k)
    straights[k].length -= turns[k].distance(speeds[k]) + turns[k + 1].distance(speeds[k + 1]);
  settle_speeds(speeds, straights);

  detail::FlightPlan plan(points[0].position, settings.departure_heading.value_or(legs > 0 ? headings[0] : 0),
                          settings.yaw_rate);
  for (std::size_t k = 0; k < legs; ++k) {
    const Vec3 at = points[k].position;
    const double begin = turns[k].distance(speeds[k]);
    const double end = sections[k].length - turns[k + 1].distance(speeds[k + 1]);
    const SpeedChange change = turns[k].change(speeds[k]);
    plan.pass(0.5 * change.duration());
    if (speeds[k] == 0) {
      plan.stand(at, points[k].hover, headings[k]);
    } else if (change.to > 0) {
      std::vector<CubicPiece<double>> blend;
      change.add_to(blend, 0);
      plan.turn_to(headings[k], change.duration());
      plan.fly(blend, at - begin * turns[k].before, normalize(turns[k].after - turns[k].before),
               speeds[k] * turns[k].before);
    }
    plan.fly(speed_profile(end - begin, speeds[k], speeds[k + 1], sections[k].limits), at + begin * directions[k],
             directions[k]);
  }
  plan.pass(0);
  const double last_heading = legs > 0 ? headings.back() : settings.departure_heading.value_or(0);
  plan.stand(points.back().position, points.back().hover, settings.arrival_heading.value_or(last_heading));
  return std::move(plan).flight(numbers);
}

}  // namespace PULSECAST_NAMESPACE

#endif
