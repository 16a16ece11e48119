// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_PLATFORM_DETAIL_GROUND_VEHICLE_DRIVE_HPP
#define PULSECAST_PLATFORM_DETAIL_GROUND_VEHICLE_DRIVE_HPP

#include <pulsecast/concepts.hpp>
#include <pulsecast/platform/detail/curved_path.hpp>
#include <pulsecast/platform/detail/speed_profile.hpp>

namespace PULSECAST_NAMESPACE {

/// Pose of a vehicle relative to the map: the plane through its four wheels.
struct Footing {
  double height = 0;  ///< height of the middle of the rear axle, at the foot of the wheels [m]
  double ahead = 0;   ///< slope forwards, positive upwards [m/m]
  double aside = 0;   ///< slope to the right, positive upwards [m/m]
  double along = 0;   ///< length driven in space since the start of its section [m]

  /// Attitude by heading, then pitch, then roll, so that up is normal to the plane.
  /// Source: Rx(p) Ry(r) up = (sin r, -sin p cos r, cos p cos r), along (-aside, -ahead, 1).
  [[nodiscard]] Rotation attitude(double heading) const noexcept {
    const double pitch = std::atan(ahead);
    return level(heading) * rotation_about(axis::right, pitch) *
           rotation_about(axis::forward, -std::atan(aside * std::cos(pitch)));
  }
};

/// Drive over the ground. The body's origin is the middle of the rear axle, at the height of the
/// wheels' contact. Position, speed in space and attitude are continuous; it stops to change gear.
class GroundVehicleDrive {
 public:
  using refinements = refines<tag::Differentiable>;
  /// Piece of the path, with footings at equal distances along it on the map, both ends included.
  struct Section {
    PathPiece path{};                 ///< piece of the path, on the map
    double start = 0;                 ///< length driven before, in space [m]
    std::vector<Footing> footings{};  ///< footings from its start to its end
  };

  /// `driven` is the length driven in space over time [m]: see `plan_ground_vehicle`.
  GroundVehicleDrive(std::vector<Section> sections, PiecewiseCubic<double> driven, Tick duration,
                     std::vector<std::string> warnings = {})
      : sections_(std::move(sections)),
        driven_(std::move(driven)),
        duration_(duration),
        warnings_(std::move(warnings)) {}

  [[nodiscard]] Pose<frame::Body, frame::World> at(Tick t) const noexcept {
    const double driven = driven_.at(t).position;
    const Section& section = section_at(driven);
    const double along = driven - section.start, steps = static_cast<double>(section.footings.size() - 1);
    const auto passed = [&](std::size_t i) noexcept { return !(along < section.footings[i].along); };
    const auto [k, next] = detail::neighbours(section.footings.size(), passed);
    const Footing &a = section.footings[k], &b = section.footings[next];
    const double part = k < next ? (along - a.along) / (b.along - a.along) : 0;
    const Stance stance = section.path.after(section.path.length * ((static_cast<double>(k) + part) / steps));
    const Footing footing{std::lerp(a.height, b.height, part), std::lerp(a.ahead, b.ahead, part),
                          std::lerp(a.aside, b.aside, part)};
    return {footing.attitude(stance.heading), {stance.position.x, stance.position.y, footing.height}};
  }

  /// Velocity and angular rate jump at footings, between which height and slopes are linear.
  [[nodiscard]] Derivatives derivatives(Tick t) const noexcept {
    const CubicPiece<double> driven = driven_.moving_at(t);
    const Section& section = section_at(driven.position);
    const PathPiece& path = section.path;
    const std::vector<Footing>& footings = section.footings;
    const double along = driven.position - section.start;
    const auto passed = [&](std::size_t i) noexcept { return !(along < footings[i].along); };
    const std::size_t k = std::min(detail::neighbours(footings.size(), passed).before, footings.size() - 2);
    const Footing &a = footings[k], &b = footings[k + 1];
    const double whole = b.along - a.along, step = path.length / static_cast<double>(footings.size() - 1);
    if (!(whole > 0)) return {};
    const double part = (along - a.along) / whole, rate = driven.velocity / whole, change = driven.acceleration / whole;
    const double heading = path.after(step * (static_cast<double>(k) + part)).heading;
    const Vec3 ahead{std::sin(heading), std::cos(heading), 0}, right{ahead.y, -ahead.x, 0};
    const double speed = path.gear * step * rate, gain = path.gear * step * change, turn = path.curvature * speed;
    const Vec3 rise = (b.height - a.height) * axis::up;
    Derivatives d{speed * ahead + rate * rise, gain * ahead + speed * turn * right + change * rise, -turn * axis::up,
                  -path.curvature * gain * axis::up};
    // first and second derivative of an angle by those of its tangent
    const auto angular = [](double tangent, double first, double second) noexcept {
      const double square = 1 + tangent * tangent, turned = first / square;
      return Vec2{turned, (second - 2 * tangent * first * turned) / square};
    };
    const double slope = std::lerp(a.ahead, b.ahead, part), steepens = b.ahead - a.ahead, pitch = std::atan(slope);
    const Vec2 pitching = angular(slope, steepens * rate, steepens * change);
    d.turn_by(rotation_about(axis::right, pitch), pitching.x * axis::right, pitching.y * axis::right);
    // tangent of the roll: slope aside times the cosine of the pitch
    const double aside = std::lerp(a.aside, b.aside, part), tilts = b.aside - a.aside, cosine = std::cos(pitch);
    const double less = -std::sin(pitch) * pitching.x,
                 bend = -cosine * pitching.x * pitching.x - std::sin(pitch) * pitching.y;
    const Vec2 rolling = angular(aside * cosine, tilts * rate * cosine + aside * less,
                                 tilts * change * cosine + 2 * tilts * rate * less + aside * bend);
    d.turn_by(rotation_about(axis::forward, -std::atan(aside * cosine)), -rolling.x * axis::forward,
              -rolling.y * axis::forward);
    return d;
  }

  [[nodiscard]] Tick duration() const noexcept { return duration_; }
  [[nodiscard]] const std::vector<Section>& sections() const noexcept { return sections_; }  ///< by time
  /// Length driven in space, forwards plus backwards [m].
  [[nodiscard]] const PiecewiseCubic<double>& driven() const noexcept { return driven_; }
  /// Sentences about ground that no vehicle drives over: too steep, or with gaps.
  [[nodiscard]] const std::vector<std::string>& warnings() const noexcept { return warnings_; }

 private:
  [[nodiscard]] const Section& section_at(double driven) const noexcept {
    const auto starts_before = [&](std::size_t i) noexcept { return !(driven < sections_[i].start); };
    return sections_[detail::neighbours(sections_.size(), starts_before).before];
  }

  std::vector<Section> sections_;
  PiecewiseCubic<double> driven_;
  Tick duration_;
  std::vector<std::string> warnings_;
};

}  // namespace PULSECAST_NAMESPACE

#endif
