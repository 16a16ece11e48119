// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_PLATFORM_WAYPOINTS_HPP
#define PULSECAST_PLATFORM_WAYPOINTS_HPP

#include <pulsecast/base/search.hpp>
#include <pulsecast/base/unit_rotation.hpp>
#include <pulsecast/pulse_lanes.hpp>

namespace PULSECAST_NAMESPACE {

/// Interpolation of positions between two waypoints.
enum class Interpolation : std::uint8_t {
  linear,  ///< piecewise linear, at constant velocity
  cubic,   ///< cubic polynomials through the waypoints, with continuous velocity
};

/// Motion through timed poses. Attitudes turn at a constant rate about one axis, by the smaller
/// angle. Before the first waypoint and after the last one the body rests.
///
/// A time that occurs more than once is a jump: up to it the first of these waypoints counts, from
/// it on the last. Cubic positions are interpolated on either side alone.
class Waypoints {
 public:
  using refinements = refines<tag::MovesInLanes, tag::Differentiable>;
  /// From 1 to 1e9 waypoints, times not decreasing. Throws a `SettingError`.
  explicit Waypoints(std::vector<TimedPose> points, Interpolation positions = Interpolation::linear)
      : points_(std::move(points)) {
    require_within("Waypoints::points (number)", points_.size(), 1, 1e9, "");
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const std::string field = "Waypoints::points[" + std::to_string(i) + "]";
      TimedPose& p = points_[i];
      require_within(field + ".time", p.time, -1e15, 1e15, "s");  // limit of a `Tick`
      if (i > 0 && p.time < points_[i - 1].time)
        throw SettingError(field + ".time", p.time, "s",
                           "at least that of the previous waypoint, " + text::to_text(points_[i - 1].time));
      require_finite(field + ".position (length)", length(p.position), "m");
      require_rotation(field + ".rotation", p.rotation);
      p.rotation = normalize(p.rotation);
    }
    if (positions == Interpolation::cubic && points_.size() > 1) find_velocities();
  }

  /// Time from the start of the leg to the last waypoint.
  [[nodiscard]] Tick duration() const noexcept { return Tick::of_seconds(std::max(0.0, points_.back().time)); }

  /// Waypoints, as given, with unit rotations.
  [[nodiscard]] const std::vector<TimedPose>& points() const noexcept { return points_; }

  [[nodiscard]] auto at(Tick t) const noexcept { return pose_in_lanes(*this, t); }

  [[nodiscard]] Derivatives derivatives(Tick t) const noexcept {
    const auto about = neighbours_of(t.seconds());
    if (about.before == about.behind) return {};
    const TimedPose &a = points_[about.before], &b = points_[about.behind];
    const double interval = b.time - a.time, s = ((static_cast<double>(t.second) - a.time) + t.fraction) / interval;
    const Vec3 path = b.position - a.position;
    Derivatives d{.velocity = path / interval,
                  .angular_rate = rotation_vector(conjugate(a.rotation) * b.rotation) / interval};
    if (velocities_.empty()) return d;
    const Vec3 leaving = interval * velocities_[about.before], arriving = interval * velocities_[about.behind];
    const Vec3 square = 3.0 * path - 2.0 * leaving - arriving, cube = leaving + arriving - 2.0 * path;  // as below
    d.velocity = (leaving + s * (2.0 * square + 3.0 * s * cube)) / interval;
    d.acceleration = (2.0 * square + 6.0 * s * cube) / (interval * interval);
    return d;
  }

  simd::Mask poses(const TickLanes& ticks, PoseLanes<frame::Body, frame::World>& poses) const noexcept {
    const simd::Doubles t = ticks.seconds();
    const auto about = neighbours_of(t[0]);
    bool together = true;  // between the same waypoints
    for (std::size_t lane = 1; lane < simd::lane_count && together; ++lane)
      together = t[lane] == t[0] || neighbours_of(t[lane]) == about;
    if (together)
      find_poses(about, ticks, poses);
    else
      for (std::size_t lane = 0; lane < simd::lane_count; ++lane) poses.set(lane, at(ticks[lane]));
    return all_lanes();
  }

 private:
  [[nodiscard]] detail::Neighbours neighbours_of(double t) const noexcept {
    return detail::neighbours(points_.size(), [&](std::size_t n) noexcept { return !(t < points_[n].time); });
  }

  /// Poses at times between two waypoints.
  void find_poses(const detail::Neighbours& about, const TickLanes& ticks,
                  PoseLanes<frame::Body, frame::World>& poses) const noexcept {
    const TimedPose &a = points_[about.before], &b = points_[about.behind];
    poses = PoseLanes(Pose<frame::Body, frame::World>{a.rotation, a.position});
    if (about.before == about.behind) return;
    // relative to the waypoint the time keeps the exactness of its fraction of a second
    const simd::Doubles since = (ticks.second - a.time) + ticks.fraction;
    const double interval = b.time - a.time;
    const simd::Doubles s = since / interval;
    poses.rotation = interpolated(a.rotation, b.rotation, s);
    const Vec3 path = b.position - a.position;
    if (velocities_.empty()) {
      poses.position = poses.position + s * Vec3Lanes(path);
      return;
    }
    // source: cubic Hermite polynomial in powers of s
    const Vec3 leaving = interval * velocities_[about.before], arriving = interval * velocities_[about.behind];
    const Vec3Lanes square(3.0 * path - 2.0 * leaving - arriving), cube(leaving + arriving - 2.0 * path);
    poses.position = poses.position + s * (Vec3Lanes(leaving) + s * (square + s * cube));
  }

  /// Rotations between two, at a constant rate by the smaller angle. Source: Shoemake 1985.
  [[nodiscard]] static RotationLanes interpolated(const Rotation& from, const Rotation& to,
                                                  const simd::Doubles& share) noexcept {
    const double cosine = dot(from, to), along = std::fabs(cosine);
    simd::Doubles of_from = 1.0 - share, of_to = share;
    if (along <= 1 - std::numeric_limits<double>::epsilon()) {
      const double angle = std::acos(along), sine = std::sin(angle);
      of_from = simd::sin(simd::Doubles(of_from * angle)) / sine;
      of_to = simd::sin(simd::Doubles(share * angle)) / sine;
    }
    if (cosine < 0) of_to = -of_to;
    return normalize(RotationLanes{of_from * from.w + of_to * to.w, of_from * from.x + of_to * to.x,
                                   of_from * from.y + of_to * to.y, of_from * from.z + of_to * to.z});
  }

  void find_velocities() {
    velocities_.assign(points_.size(), Vec3{});
    for (std::size_t first = 0, last = 0; first < points_.size(); first = ++last) {
      while (last + 1 < points_.size() && points_[last + 1].time > points_[last].time) ++last;
      if (last > first) find_velocities(first, last);
    }
    for (const Vec3& v : velocities_) require_finite("Waypoints::points (velocity between)", length(v), "m/s");
  }

  /// Velocities between two jumps: of the parabola through each waypoint and its neighbours; at ends, the outer three.
  /// Source: de Boor 1978, A Practical Guide to Splines, ch. IV; Catmull & Rom 1974 for even times.
  void find_velocities(std::size_t first, std::size_t last) {
    const auto interval = [&](std::size_t i) { return points_[i + 1].time - points_[i].time; };
    const auto velocity = [&](std::size_t i) { return (points_[i + 1].position - points_[i].position) / interval(i); };
    for (std::size_t i = first; i < last; ++i)
      require_finite("Waypoints::points[" + std::to_string(i + 1) + "] (velocity from the previous one)",
                     length(velocity(i)), "m/s");
    velocities_[first] = velocities_[last] = velocity(first);
    for (std::size_t i = first + 1; i < last; ++i) {
      const double share = interval(i) / (interval(i - 1) + interval(i));
      velocities_[i] = share * velocity(i - 1) + (1 - share) * velocity(i);
    }
    if (last > first + 1) {
      velocities_[first] = 2.0 * velocity(first) - velocities_[first + 1];
      velocities_[last] = 2.0 * velocity(last - 1) - velocities_[last - 1];
    }
  }

  std::vector<TimedPose> points_;
  std::vector<Vec3> velocities_;  ///< at each waypoint [m/s]; empty for linear interpolation
};

/// Copies poses with level attitudes along the path: at a bend halfway between the directions in
/// and out; at a reversal that in. At rest or in vertical motion the last heading is kept, or else
/// the next one taken; without any, north. A repeated time is a jump: neither side looks along it.
[[nodiscard]] inline std::vector<TimedPose> with_headings(std::vector<TimedPose> points) {
  const std::size_t n = points.size();
  std::vector<Vec3> ahead(n, Vec3{});  // next horizontal directions; or zero
  const auto jump_to = [&](std::size_t i) { return points[i].time == points[i - 1].time; };
  const auto way_to = [&](std::size_t i) {
    const Vec3 &from = points[i - 1].position, &to = points[i].position;
    if (to.x == from.x && to.y == from.y) return Vec3{};
    const double heading = heading_of(to - from);
    return Vec3{std::sin(heading), std::cos(heading), 0};
  };
  for (std::size_t i = n; i-- > 1;) {
    if (jump_to(i)) continue;
    const Vec3 way = way_to(i);
    ahead[i - 1] = way == Vec3{} ? ahead[i] : way;
  }
  Vec3 behind{}, came{};  // last horizontal direction, and that since the last jump
  for (std::size_t i = 0; i < n; ++i) {
    if (i > 0 && jump_to(i))
      came = Vec3{};
    else if (i > 0)
      if (const Vec3 way = way_to(i); way != Vec3{}) behind = came = way;
    const Vec3 halfway = came + ahead[i];
    points[i].rotation = level(heading_of(length(halfway) > 1e-9 ? halfway : behind));
  }
  return points;
}

/// Waypoints of a body that follows the path through these positions [m] at a constant speed [m/s],
/// level and looking along it. Repeated positions are left out. Throws a `SettingError`.
[[nodiscard]] inline std::vector<TimedPose> at_constant_speed(const std::vector<Vec3>& positions, double speed) {
  require_positive("at_constant_speed (speed)", speed, "m/s");
  std::vector<TimedPose> points;
  double gone = 0;
  for (const Vec3& p : positions) {
    require_finite("at_constant_speed (position, length)", length(p), "m");
    if (!points.empty()) gone += length(p - points.back().position);
    if (points.empty() || gone / speed > points.back().time) points.push_back({.time = gone / speed, .position = p});
  }
  return with_headings(std::move(points));
}

}  // namespace PULSECAST_NAMESPACE

#endif
