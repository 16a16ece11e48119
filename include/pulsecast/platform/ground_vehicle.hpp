// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_PLATFORM_GROUND_VEHICLE_HPP
#define PULSECAST_PLATFORM_GROUND_VEHICLE_HPP

#include <pulsecast/platform/detail/ground_vehicle_drive.hpp>

namespace PULSECAST_NAMESPACE {

/// Limits and dimensions of a ground vehicle.
struct GroundVehicleSettings {
  double speed = 10;            ///< maximum [m/s]
  double acceleration = 2;      ///< maximum along and across combined, as on level ground [m/s^2]
  double jerk = 2;              ///< maximum change of acceleration along the path [m/s^3]
  double turn_radius = 5.5;     ///< of every curve, at the middle of the rear axle: the minimum [m]
  double wheelbase = 2.7;       ///< distance from the rear to the front axle [m]
  double track = 1.6;           ///< distance from the left to the right wheels [m]
  double wheel_radius = 0.316;  ///< [m]; source: ISO 4000-1, 205/55 R16: 8 inches + 55 % of 205 mm
  double ground_step = 0.1;     ///< maximum distance between footings along the path [m]
  double start_height = std::numeric_limits<double>::infinity();  ///< of the first ground [m]
  std::optional<double> height_without_ground{};                  ///< an error if empty [m]

  void validate() const {
    require_within("GroundVehicleSettings::speed", speed, 1e-3, 1e3, "m/s");
    require_within("GroundVehicleSettings::acceleration", acceleration, 1e-3, 1e3, "m/s^2");
    require_within("GroundVehicleSettings::jerk", jerk, 1e-3, 1e3, "m/s^3");
    require_within("GroundVehicleSettings::turn_radius", turn_radius, 1e-2, 1e6, "m");
    require_within("GroundVehicleSettings::wheelbase", wheelbase, 1e-2, 1e2, "m");
    require_within("GroundVehicleSettings::track", track, 1e-2, 1e2, "m");
    require_within("GroundVehicleSettings::wheel_radius", wheel_radius, 1e-3, 1e2, "m");
    require_within("GroundVehicleSettings::ground_step", ground_step, 1e-3, 1e2, "m");
    const double height = height_without_ground.value_or(0);
    require_within("GroundVehicleSettings::height_without_ground", height, -1e9, 1e9, "m");
  }
};

namespace detail {

/// Lowest point [m] that a wheel of a radius `r` [m] reaches as it rolls along a profile: the
/// closing of the profile with the wheel's disc, which is the ground itself wherever that bends
/// less than the wheel. `at(way)` is the height a way ahead [m], minus infinity without ground;
/// `below` is that at the wheel. Source: ISO 16610-41:2015, closing with a disk.
[[nodiscard]] std::optional<double> lowest_of_wheel(double r, const auto& at, const std::optional<double>& below) {
  constexpr double nothing = -std::numeric_limits<double>::infinity();
  if (below) {
    const std::array<double, 4> places{-0.9 * r, -0.5 * r, 0.5 * r, 0.9 * r},
        heights{at(places[0]), at(places[1]), at(places[2]), at(places[3])};
    const double slope = heights[1] > nothing && heights[2] > nothing ? (heights[2] - heights[1]) / r : 0;
    bool touched = true;  // the ground stays below a parabola of half the wheel's curvature
    for (std::size_t k = 0; k < 4; ++k)
      touched = touched && heights[k] <= *below + slope * places[k] + places[k] * places[k] / (4 * r);
    if (touched) return below;
  }
  constexpr int n = 12;  // samples of a radius
  std::array<double, 4 * n + 1> profile{};
  for (int k = -2 * n; k <= 2 * n; ++k)
    profile[static_cast<std::size_t>(k + 2 * n)] = k == 0 ? below.value_or(nothing) : at(k * r / n);
  const auto disc = [&](int k) { return r * std::sqrt(1 - static_cast<double>(k * k) / (n * n)); };
  double lowest = std::numeric_limits<double>::infinity();
  for (int axle = -n; axle <= n; ++axle) {
    double centre = nothing;
    for (int k = -n; k <= n; ++k)
      centre = std::fmax(centre, profile[static_cast<std::size_t>(axle + k + 2 * n)] + disc(k));
    lowest = std::fmin(lowest, centre - disc(axle));
  }
  return lowest > nothing ? std::optional(lowest) : below;
}

/// Checked waypoints without those less than a centimetre from the one before; both ends stay.
/// `numbers` receives their indices in the list. Throws a `SettingError`.
[[nodiscard]] inline std::vector<Vec2> checked(std::span<const Vec2> waypoints, std::vector<std::size_t>& numbers) {
  require_within("plan_ground_vehicle: waypoints (number)", waypoints.size(), 1, 1e7, "");
  std::vector<Vec2> points;
  for (std::size_t k = 0; k < waypoints.size(); ++k) {
    const std::string name = "plan_ground_vehicle: waypoints[" + std::to_string(k) + "].";
    require_within(name + "x", waypoints[k].x, -1e9, 1e9, "m");
    require_within(name + "y", waypoints[k].y, -1e9, 1e9, "m");
    const auto near = [&](const Vec2& p) { return length(waypoints[k] - p) < 0.01; };
    if (k + 1 == waypoints.size())
      while (points.size() > 1 && near(points.back())) {
        points.pop_back();
        numbers.pop_back();
      }
    if (points.empty() || !near(points.back())) {
      points.push_back(waypoints[k]);
      numbers.push_back(k);
    }
  }
  return points;
}

/// Footings of a vehicle along its path, each from the one before.
template <Ground G>
class FootingFinder {
 public:
  FootingFinder(const G& ground, const GroundVehicleSettings& settings)
      : ground_(ground), s_(settings), before_{s_.start_height, 0, 0} {}

  /// Footing at a stance, `step` metres on the map after the one before, by least squares of the four wheels. As their
  /// contact depends on the attitude, the plane is iterated from the footing before; each round leaves about the square
  /// of the slope of the error. Wheels keep to the level that this footing leads to. Throws a `SettingError` where
  /// there is no ground. Source: slopes of a plane through a rectangle are differences of the means of opposite sides.
  [[nodiscard]] Footing next(const Stance& stance, double step, std::size_t waypoint) {
    Footing expected = before_;
    expected.height += step * expected.ahead;
    if (std::exchange(is_first_, false))
      expected.height = height(stance.position, s_.start_height).value_or(s_.start_height);
    bool gap = false;
    const auto error = [&](const Footing& footing, double x, double y) {  // of a wheel
      const Vec3 wheel = footing.attitude(stance.heading) * Vec3{x, y, 0};
      const Vec2 place = stance.position + Vec2{wheel.x, wheel.y};
      const double near = expected.height + (expected.attitude(stance.heading) * Vec3{x, y, 0}).z;
      return standing(place, stance.heading, near, waypoint, gap) - footing.height - wheel.z;
    };
    Footing footing = expected;
    if (!std::isfinite(footing.height)) footing.height = 0;
    for (int round = 0; round < 6; ++round) {
      const double rear_left = error(footing, -s_.track / 2, 0), rear_right = error(footing, s_.track / 2, 0);
      const double front_left = error(footing, -s_.track / 2, s_.wheelbase);
      const double front_right = error(footing, s_.track / 2, s_.wheelbase);
      const double rear = 0.5 * (rear_left + rear_right), pitch = 0.5 * (front_left + front_right) - rear;
      const double roll = 0.5 * (rear_right - rear_left + front_right - front_left);
      footing.height += rear;
      footing.ahead = std::clamp(footing.ahead + pitch / s_.wheelbase, -tilt_max, tilt_max);
      footing.aside = std::clamp(footing.aside + roll / s_.track, -tilt_max, tilt_max);
      if (std::fabs(rear) + std::fabs(pitch) + std::fabs(roll) <= 1e-14 * (1 + std::fabs(footing.height))) break;
    }
    gaps_ += gap ? 1 : 0;
    return before_ = footing;
  }

  /// Sentences about the ground on all sections; none about a drive without any ground.
  [[nodiscard]] std::vector<std::string> warnings(const std::vector<GroundVehicleDrive::Section>& sections) const {
    std::vector<std::string> all;
    if (gaps_ > 0 && any_ground_)
      all.push_back(
          "no ground at x = " + brief(first_gap_.x) + ", y = " + brief(first_gap_.y) +
          " m, under a wheel of the vehicle, nor at " + brief(static_cast<double>(gaps_ - 1)) +
          " places of it more: its wheels roll over gaps narrower than they are" +
          (s_.height_without_ground ? ", and stand at " + brief(*s_.height_without_ground) + " m in others" : ""));
    std::size_t steep = 0;
    double most = 0;
    Vec2 first{};
    for (const auto& [path, start, footings] : sections) {
      const std::size_t steps = footings.size() - 1;
      const double step = path.length / static_cast<double>(steps);
      const double whole = std::fmin(std::ceil(s_.wheel_radius / step), static_cast<double>(steps));  // step may be 0
      const auto wheel = static_cast<std::size_t>(whole);
      for (std::size_t i = 0; i <= steps; ++i) {
        const Footing &at = footings[i], &ahead = footings[std::min(i + wheel, steps)];
        const double rise = i + wheel <= steps ? std::fabs(ahead.height - at.height) : 0;
        const double tilt = std::fmax(std::fabs(at.ahead), std::fabs(at.aside));
        most = std::fmax(most, rise);
        if (std::fmax(rise / std::fmax(s_.wheel_radius, whole * step), tilt) <= 1 + 1e-9) continue;
        if (steep++ == 0) first = path.after(step * static_cast<double>(i)).position;
      }
    }
    if (steep > 0)
      all.push_back("ground steeper than 45 degrees under the vehicle at x = " + brief(first.x) +
                    ", y = " + brief(first.y) + " m, and at " + brief(static_cast<double>(steep - 1)) +
                    " places of it more, with steps of up to " + brief(most) +
                    " m: it drives over them at its speed all the same");
    return all;
  }

 private:
  /// Tangent of the largest tilt. Source: Gillespie 1992, table 9.1: cars tip at 1.1 to 1.7 g.
  static constexpr double tilt_max = 1.7;

  /// Lengths for messages, rounded to the centimetre.
  [[nodiscard]] static std::string brief(double x) { return text::to_text(std::round(x * 100) / 100); }

  [[nodiscard]] std::optional<double> height(const Vec2& place, double near) const {
    std::optional<double> h;
    if constexpr (LevelledGround<G>)
      h = ground_(place, near);
    else
      h = ground_(place);
    if (h) require_within("plan_ground_vehicle: height of the ground", *h, -1e9, 1e9, "m");
    return h;
  }

  /// Height of the foot of a wheel.
  [[nodiscard]] double standing(const Vec2& place, double heading, double near, std::size_t waypoint, bool& gap) {
    const std::optional<double> below = height(place, near);
    any_ground_ = any_ground_ || below;
    if (!below && !std::exchange(gap, true) && gaps_ == 0) first_gap_ = place;
    const Vec2 ahead{std::sin(heading), std::cos(heading)};
    const auto at = [&](double way) { return height(place + way * ahead, near).value_or(-infinity); };
    const std::optional<double> rolled = lowest_of_wheel(s_.wheel_radius, at, below);
    if (!rolled && !s_.height_without_ground)
      throw SettingError("plan_ground_vehicle: path to waypoints[" + std::to_string(waypoint) + "], x", place.x, "m",
                         "over ground; there is none at y = " + text::to_text(place.y) + " m");
    return rolled ? *rolled : *s_.height_without_ground;
  }

  const G& ground_;
  const GroundVehicleSettings& s_;
  Footing before_;
  bool is_first_ = true, any_ground_ = false;
  std::size_t gaps_ = 0;  // footings with a wheel over no ground
  Vec2 first_gap_{};
};

/// Speed limits on a piece of the path. Acceleration in a curve is shared by along and across.
[[nodiscard]] inline SpeedLimits limits_on(const PathPiece& path, const GroundVehicleSettings& s) noexcept {
  const double bend = std::fabs(path.curvature), share = s.acceleration * std::sqrt(0.5);
  if (bend == 0) return {s.speed, s.acceleration, s.acceleration, s.jerk};
  return {std::fmin(s.speed, std::sqrt(share / bend)), share, share, s.jerk};  // v^2 / r
}

}  // namespace detail

/// Plans a drive along `path_through` the waypoints, at rest at both ends and at changes of gear.
/// All four wheels roll over the ground as far as a rigid body can; speed and acceleration are
/// limited along the way in space. A single waypoint looks north. Waypoints less than a centimetre
/// apart are one. Ground of several levels, as roads and bridges, should model `LevelledGround`.
/// Throws a `SettingError` for invalid settings or waypoints, too long a path, or missing ground.
[[nodiscard]] inline GroundVehicleDrive plan_ground_vehicle(std::span<const Vec2> waypoints, const Ground auto& ground,
                                                            const GroundVehicleSettings& settings = {}) {
  settings.validate();
  std::vector<std::size_t> numbers;
  const std::vector<Vec2> points = detail::checked(waypoints, numbers);
  std::vector<PathPiece> path = path_through(points, settings.turn_radius);
  if (path.empty()) path.push_back({.start = {points[0], 0}});

  double whole = 0;
  for (const PathPiece& piece : path) whole += piece.length;
  const double most = 1e7 * settings.ground_step;  // its footings take some 320 MB
  require_within("plan_ground_vehicle: path (length)", whole, 0, most, "m");

  detail::FootingFinder finder(ground, settings);
  std::vector<GroundVehicleDrive::Section> sections;
  std::vector<PathSection> path_sections;
  std::vector<double> joints(path.size() + 1, 0.0);
  double start = 0;
  for (std::size_t k = 0; k < path.size(); ++k) {
    const PathPiece& piece = path[k];
    const double steps = std::fmax(1.0, std::ceil(piece.length / settings.ground_step));
    const double step = piece.length / steps;
    GroundVehicleDrive::Section section{piece, start, {}};
    double climbs = 0;  // length in space beyond that on the map
    for (double i = 0; i <= steps; ++i) {
      const double along = piece.length * i / steps;
      Footing footing = finder.next(piece.after(along), i > 0 ? piece.gear * step : 0, numbers[piece.waypoint]);
      if (i > 0) climbs += std::hypot(step, footing.height - section.footings.back().height) - step;
      footing.along = along + climbs;
      section.footings.push_back(footing);
    }
    path_sections.push_back({section.footings.back().along, detail::limits_on(piece, settings)});
    if (k > 0 && piece.gear == path[k - 1].gear)
      joints[k] = std::fmin(path_sections[k - 1].limits.speed, path_sections[k].limits.speed);
    sections.push_back(std::move(section));
    start += path_sections.back().length;
  }
  settle_speeds(joints, path_sections);

  PiecewiseCubic<double> driven(0);
  Tick now{};
  for (std::size_t k = 0; k < sections.size(); ++k) {
    const auto& [length, limits] = path_sections[k];
    for (CubicPiece<double> piece : speed_profile(length, joints[k], joints[k + 1], limits)) {
      piece.position += sections[k].start;
      if (piece.duration > 0) driven.add(now, piece);
      now = now + Tick::of_seconds(piece.duration);
    }
  }
  driven.add(now, {.position = start});
  std::vector<std::string> warnings = finder.warnings(sections);
  return {std::move(sections), std::move(driven), now, std::move(warnings)};
}

}  // namespace PULSECAST_NAMESPACE

#endif
