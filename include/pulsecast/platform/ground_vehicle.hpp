// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_PLATFORM_GROUND_VEHICLE_HPP
#define PULSECAST_PLATFORM_GROUND_VEHICLE_HPP

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <pulsecast/base/require.hpp>
#include <pulsecast/base/search.hpp>
#include <pulsecast/concepts.hpp>
#include <pulsecast/platform/curved_path.hpp>
#include <pulsecast/platform/heading.hpp>
#include <pulsecast/platform/piecewise_cubic.hpp>
#include <pulsecast/platform/speed_profile.hpp>

namespace PULSECAST_NAMESPACE {

/// Limits and dimensions of a ground vehicle.
struct GroundVehicleSettings {
  double speed = 10;         ///< maximum [m/s]
  double acceleration = 2;   ///< maximum of the acceleration along and across the path combined, as on level ground [m/s^2]
  double jerk = 2;           ///< maximum change of acceleration along the path [m/s^3]
  double turn_radius = 5.5;  ///< radius of every curve, at the middle of the rear axle: the vehicle's minimum [m]
  double wheelbase = 2.7;    ///< distance from the rear to the front axle [m]
  double track = 1.6;        ///< distance from the left to the right wheels [m]
  double ground_step = 0.1;  ///< maximum distance between ground queries along the path [m]

  void validate() const {
    require_within("GroundVehicleSettings::speed", speed, 1e-3, 1e3, "m/s");
    require_within("GroundVehicleSettings::acceleration", acceleration, 1e-3, 1e3, "m/s^2");
    require_within("GroundVehicleSettings::jerk", jerk, 1e-3, 1e3, "m/s^3");
    require_within("GroundVehicleSettings::turn_radius", turn_radius, 1e-2, 1e6, "m");
    require_within("GroundVehicleSettings::wheelbase", wheelbase, 1e-2, 1e2, "m");
    require_within("GroundVehicleSettings::track", track, 1e-2, 1e2, "m");
    require_within("GroundVehicleSettings::ground_step", ground_step, 1e-3, 1e2, "m");
  }
};

/// Pose of a vehicle relative to the map: the plane through its four wheels.
struct Footing {
  double height = 0;  ///< height of the middle of the rear axle, at the foot of the wheels [m]
  double ahead = 0;   ///< slope forwards, positive upwards [m/m]
  double aside = 0;   ///< slope to the right, positive upwards [m/m]

  /// Attitude by heading, then pitch, then roll, so that up is normal to the plane.
  /// Source: the up of Rx(pitch) Ry(roll) is (sin r, -sin p cos r, cos p cos r), and the normal is (-aside, -ahead, 1).
  [[nodiscard]] Rotation attitude(double heading) const noexcept {
    const double pitch = std::atan(ahead);
    return level(heading) * rotation_about(axis::right, pitch) * rotation_about(axis::forward, -std::atan(aside * std::cos(pitch)));
  }
};

/// Drive over the ground. The body's origin is the middle of the rear axle, at the height of the wheels' contact. Position, speed and
/// attitude are continuous; the vehicle stops where it changes gear.
class GroundVehicleDrive {
 public:
  /// Piece of the path with the footings at equal distances along it, both ends included.
  struct Section {
    PathPiece path{};                 ///< piece of the path, on the map
    double start = 0;                 ///< length driven before [m]
    std::vector<Footing> footings{};  ///< footings from its start to its end
  };

  /// `driven` is the length driven over time [m]: see `plan_ground_vehicle`.
  GroundVehicleDrive(std::vector<Section> sections, PiecewiseCubic<double> driven, Tick duration)
      : sections_(std::move(sections)), driven_(std::move(driven)), duration_(duration) {}

  [[nodiscard]] Pose<frame::Body, frame::World> at(Tick t) const noexcept {
    const double driven = driven_.at(t).position;
    const auto starts_before = [&](std::size_t i) noexcept { return !(driven < sections_[i].start); };
    const Section& section = sections_[detail::neighbours(sections_.size(), starts_before).before];
    const double along = std::clamp(driven - section.start, 0.0, section.path.length);
    const Stance stance = section.path.after(along);
    const std::size_t steps = section.footings.size() - 1;
    const double step = section.path.length > 0 ? along / section.path.length * static_cast<double>(steps) : 0;
    const std::size_t k = std::min(static_cast<std::size_t>(step), steps - 1);
    const Footing &a = section.footings[k], &b = section.footings[k + 1];
    const double part = step - static_cast<double>(k);
    const Footing footing{std::lerp(a.height, b.height, part), std::lerp(a.ahead, b.ahead, part), std::lerp(a.aside, b.aside, part)};
    return {footing.attitude(stance.heading), {stance.position.x, stance.position.y, footing.height}};
  }

  [[nodiscard]] Tick duration() const noexcept { return duration_; }
  /// Sections in order of time.
  [[nodiscard]] const std::vector<Section>& sections() const noexcept { return sections_; }
  [[nodiscard]] const PiecewiseCubic<double>& driven() const noexcept { return driven_; }  ///< length driven, forwards plus backwards [m]

 private:
  std::vector<Section> sections_;
  PiecewiseCubic<double> driven_;
  Tick duration_;
};

static_assert(Trajectory<GroundVehicleDrive>);

namespace detail {

/// Checked waypoints without those less than a centimetre from the one before; the first and the last stay. `numbers` receives their
/// indices in the list. Throws a `SettingError`.
[[nodiscard]] inline std::vector<Vec2> checked(std::span<const Vec2> waypoints, std::vector<std::size_t>& numbers) {
  require_within("plan_ground_vehicle: waypoints (number)", static_cast<double>(waypoints.size()), 1, 1e7, "");
  std::vector<Vec2> points;
  for (std::size_t k = 0; k < waypoints.size(); ++k) {
    const std::string name = "plan_ground_vehicle: waypoints[" + std::to_string(k) + "].";
    require_within(name + "x", waypoints[k].x, -1e9, 1e9, "m");
    require_within(name + "y", waypoints[k].y, -1e9, 1e9, "m");
    const auto near = [&](const Vec2& p) { return length(waypoints[k] - p) < 0.01; };
    if (k + 1 == waypoints.size()) {
      while (points.size() > 1 && near(points.back())) {
        points.pop_back();
        numbers.pop_back();
      }
    }
    if (points.empty() || !near(points.back())) {
      points.push_back(waypoints[k]);
      numbers.push_back(k);
    }
  }
  return points;
}

/// Footing at a stance, by least squares of the four wheels. The wheels' contact depends on the attitude, so the plane is iterated; each
/// round leaves about the square of the slope of the error before. Throws a `SettingError` where there is no ground.
/// Source: the slopes of a plane through a rectangle's corners are the differences of the means of opposite sides.
[[nodiscard]] inline Footing footing_at(const Stance& stance, std::size_t waypoint, const GroundVehicleSettings& s,
                                        const Ground auto& ground) {
  const auto height = [&](const Vec2& place) {
    const std::optional<double> h = ground(place);
    const std::string name = "plan_ground_vehicle: path to waypoints[" + std::to_string(waypoint) + "], ";
    if (!h) throw SettingError(name + "x", place.x, "m", "over ground; there is none at y = " + to_text(place.y) + " m");
    require_within(name + "height", *h, -1e9, 1e9, "m");
    return *h;
  };
  Footing footing{height(stance.position), 0, 0};
  for (int round = 0; round < 6; ++round) {
    const Rotation attitude = footing.attitude(stance.heading);
    const auto error = [&](double x, double y) {  // height error of a wheel against the ground
      const Vec3 wheel = attitude * Vec3{x, y, 0};
      return height(stance.position + Vec2{wheel.x, wheel.y}) - footing.height - wheel.z;
    };
    const double rear_left = error(-s.track / 2, 0), rear_right = error(s.track / 2, 0);
    const double front_left = error(-s.track / 2, s.wheelbase), front_right = error(s.track / 2, s.wheelbase);
    const double rear = 0.5 * (rear_left + rear_right), front = 0.5 * (front_left + front_right);
    footing.height += rear;
    footing.ahead += (front - rear) / s.wheelbase;
    footing.aside += 0.5 * (rear_right - rear_left + front_right - front_left) / s.track;
  }
  return footing;
}

/// Speed limits on a piece of the path, on the map. In a curve, acceleration along and across have equal shares of the maximum. On a slope
/// the path is longer than on the map.
[[nodiscard]] inline SpeedLimits limits_on(const GroundVehicleDrive::Section& section, const GroundVehicleSettings& s) noexcept {
  double steepest = 0;
  const auto& footings = section.footings;
  for (std::size_t k = 0; k + 1 < footings.size() && section.path.length > 0; ++k) {
    const double step = section.path.length / static_cast<double>(footings.size() - 1);
    steepest = std::fmax(steepest, std::fabs(footings[k + 1].height - footings[k].height) / step);
  }
  const double map = 1 / std::hypot(1, steepest), bend = std::fabs(section.path.curvature);
  const double share = bend > 0 ? s.acceleration * std::sqrt(0.5) : s.acceleration;
  const double speed = bend > 0 ? std::fmin(s.speed, std::sqrt(share / bend)) : s.speed;  // centripetal acceleration v^2 / r
  return {map * speed, map * share, map * share, map * s.jerk};
}

}  // namespace detail

/// Plans a drive from the first waypoint to the last along `path_through`, at rest at both ends and at changes of gear. All four wheels
/// follow the ground as far as a rigid body can. A single waypoint looks north. Waypoints less than a centimetre apart are one. The ground
/// is queried only during planning. Throws a `SettingError` for invalid settings or waypoints, a path that is too long, or missing ground.
[[nodiscard]] inline GroundVehicleDrive plan_ground_vehicle(std::span<const Vec2> waypoints, const Ground auto& ground,
                                                            const GroundVehicleSettings& settings = {}) {
  settings.validate();
  std::vector<std::size_t> numbers;
  const std::vector<Vec2> points = detail::checked(waypoints, numbers);
  std::vector<PathPiece> path = path_through(points, settings.turn_radius);
  if (path.empty()) path.push_back({.start = {points[0], 0}});

  double whole = 0;
  for (const PathPiece& piece : path) whole += piece.length;
  require_within("plan_ground_vehicle: path (length)", whole, 0, 1e7 * settings.ground_step, "m");  // footings take some 240 MB

  std::vector<GroundVehicleDrive::Section> sections;
  std::vector<PathSection> path_sections;
  std::vector<double> joints(path.size() + 1, 0.0);
  double start = 0;
  for (std::size_t k = 0; k < path.size(); ++k) {
    const std::size_t steps = std::max<std::size_t>(1, static_cast<std::size_t>(std::ceil(path[k].length / settings.ground_step)));
    GroundVehicleDrive::Section section{path[k], start, {}};
    for (std::size_t i = 0; i <= steps; ++i) {
      const double along = path[k].length * static_cast<double>(i) / static_cast<double>(steps);
      section.footings.push_back(detail::footing_at(path[k].after(along), numbers[path[k].waypoint], settings, ground));
    }
    path_sections.push_back({path[k].length, detail::limits_on(section, settings)});
    if (k > 0 && path[k].gear == path[k - 1].gear) joints[k] = std::fmin(path_sections[k - 1].limits.speed, path_sections[k].limits.speed);
    sections.push_back(std::move(section));
    start += path[k].length;
  }
  settle_speeds(joints, path_sections);

  PiecewiseCubic<double> driven(0);
  Tick now{};
  for (std::size_t k = 0; k < sections.size(); ++k) {
    for (CubicPiece<double> piece : speed_profile(path_sections[k].length, joints[k], joints[k + 1], path_sections[k].limits)) {
      piece.position += sections[k].start;
      if (piece.duration > 0) driven.add(now, piece);
      now = now + Tick::of_seconds(piece.duration);
    }
  }
  driven.add(now, {.position = start});
  return {std::move(sections), std::move(driven), now};
}

}  // namespace PULSECAST_NAMESPACE

#endif
