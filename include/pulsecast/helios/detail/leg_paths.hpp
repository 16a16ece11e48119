// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_LEG_PATHS_HPP
#define PULSECAST_HELIOS_DETAIL_LEG_PATHS_HPP

#include <pulsecast/helios/detail/leg.hpp>
#include <pulsecast/helios/detail/passing.hpp>

namespace PULSECAST_NAMESPACE::helios {

/// Format of the trajectory file of a leg.
[[nodiscard]] inline io::TrajectoryFormat trajectory_format(const TrajectorySettings& t, RotationSpec spec) {
  io::TrajectoryFormat format = io::helios_format();
  format.angles = spec == RotationSpec::canonical ? io::helios_canonical : io::helios_arinc_705;
  format.separator = t.separator.value_or(format.separator);
  format.fixed_separator = t.separator.has_value();
  format.angle_unit = t.angles_in_degrees ? io::AngleUnit::degree : io::AngleUnit::radian;
  if (t.position_only) format.columns = {"t", "x", "y", "z"};
  if (!t.columns) return format;
  const TrajectoryIndices& at = *t.columns;
  std::vector<std::pair<int, const char*>> columns{{at.time, "t"}, {at.x, "x"}, {at.y, "y"}, {at.z, "z"}};
  if (!t.position_only) columns.insert(columns.end(), {{at.roll, "roll"}, {at.pitch, "pitch"}, {at.yaw, "yaw"}});
  int most = 0;
  for (const auto& [place, name] : columns) most = std::max(most, place);
  format.names = io::ColumnNames::nowhere;
  format.columns.clear();
  for (int i = 0; i <= most; ++i) format.columns.push_back("column_" + std::to_string(i));
  format.left_out = format.columns;
  for (const auto& [place, name] : columns) format.columns[static_cast<std::size_t>(place)] = name;
  const auto is_taken = [&](const std::string& column) { return std::ranges::count(format.columns, column) == 0; };
  std::erase_if(format.left_out, is_taken);
  return format;
}

/// Poses of a program from one time to another, on a clock that starts there. @throws SettingError
[[nodiscard]] inline io::TrajectoryTable poses_within(std::vector<TimedPose> poses, const TrajectorySettings& window) {
  const Waypoints path(poses);
  const double first = poses.front().time, last = poses.back().time;
  const double from = window.start.value_or(first), to = window.end.value_or(last);
  const double start = std::max(first, from), end = std::min(last, to);
  const auto seconds = [](double time) { return text::to_text(time) + " s"; };
  if (!(start <= end))
    throw SettingError("tStart to tEnd",
                       text::joined({" is from ", seconds(from), " to ", seconds(to),
                                     ", but must be within the poses, from ", seconds(first), " to ", seconds(last)}));
  io::TrajectoryTable table{.start_time = start, .poses = {}, .warnings = {}};
  const std::string name = window.file.string() + ": the window ";
  if (from < first) table.warnings.push_back(name + "begins before the first pose, at " + seconds(first));
  if (to > last) table.warnings.push_back(name + "ends after the last pose, at " + seconds(last));
  const auto at = [&](double time) {
    const Pose<frame::Body, frame::World> pose = path.at(Tick::of_seconds(time));
    return TimedPose{time, pose.position, pose.rotation};
  };
  std::erase_if(poses, [&](const TimedPose& pose) { return pose.time <= start || pose.time >= end; });
  poses.insert(poses.begin(), at(start));
  if (end > start) poses.push_back(at(end));
  for (TimedPose& pose : poses) pose.time -= start;
  table.poses = std::move(poses);
  return table;
}

/// Path and duration of a leg.
struct LegPath {
  SurveyPath path{};
  double duration = 0;            ///< travel time [s]
  double rounding = 0;            ///< maximum error of the duration [s]
  std::optional<double> clock{};  ///< start by the clock of a trajectory, if it counts [s]
};

/// Paths of the legs of a survey, which must outlive them. @throws SettingError with leg and attribute, FileError
class LegPaths {
 public:
  LegPaths(const SurveySettings& survey, const GroundHeight& ground, const SurveyBuildOptions& options)
      : survey_(survey), options_(options) {
    place(ground);
    plan_paths(ground);
  }

  [[nodiscard]] const LegPath& operator[](std::size_t k) const noexcept { return paths_[k]; }
  /// Start time of the survey, if a trajectory gives it [s]
  [[nodiscard]] std::optional<double> clock_start() const noexcept { return clock_start_; }
  [[nodiscard]] const std::vector<std::string>& warnings() const noexcept { return warnings_; }

  /// True if a leg continues the flight or drive of the leg before.
  [[nodiscard]] bool continues(std::size_t k) const {
    const auto shared = [&]<class Plan>(const std::shared_ptr<const Plan>* plan) {
      const auto* const before = std::get_if<std::shared_ptr<const Plan>>(&paths_[k - 1].path.path);
      return plan && before && *before == *plan;
    };
    return k > 0 && (shared(std::get_if<std::shared_ptr<const MulticopterFlight>>(&paths_[k].path.path)) ||
                     shared(std::get_if<std::shared_ptr<const GroundVehicleDrive>>(&paths_[k].path.path)));
  }

  [[nodiscard]] std::string leg_name(std::size_t k) const { return options_.leg_name(k); }

  [[nodiscard]] bool is_stationary(std::size_t k) const { return helios::is_stationary(survey_, k); }

 private:
  void place(const GroundHeight& ground) {
    for (std::size_t k = 0; k < survey_.legs.size(); ++k) {
      const LegPlatformSettings& p = survey_.legs[k].platform;
      Vec3 at = p.position;
      if (p.on_ground && survey_.platform.kind != PlatformKind::interpolated) {
        const std::optional<double> height = ground(Vec2{at.x, at.y});
        if (!height)
          throw SettingError(text::joined({leg_name(k), ": onGround at x = ", text::to_text(at.x), ", y"}), at.y, "m",
                             "over ground of the scene: a material with helios_isGround");
        at.z = *height;
      }
      require_finite(leg_name(k) + ": position (length)", length(at), "m");
      const std::optional<LegOffsetSettings>& offset = survey_.leg_offset;
      RandomKey key{.seed = options_.seed + 1, .pulse = k, .purpose = Purpose::position_noise};
      for (; offset && options_.leg_noise && key.subray < 3; ++key.subray)
        at[static_cast<int>(key.subray)] += offset->mean + offset->deviation * normal(key);
      places_.push_back(k > 0 && is_stationary(k - 1) ? places_.back() : at);
    }
  }

  void plan_paths(const GroundHeight& ground) {
    paths_.resize(places_.size());
    switch (survey_.platform.kind) {
      case PlatformKind::stationary:
        for (std::size_t k = 0; k < places_.size(); ++k) paths_[k].path.path = Tripod{places_[k]};
        return;
      case PlatformKind::linear_path:
        return fly_straight();
      case PlatformKind::multicopter:
        return fly();
      case PlatformKind::ground_vehicle:
        return drive(ground);
      case PlatformKind::interpolated:
        return follow();
    }
  }

  [[nodiscard]] double speed_of(std::size_t k) const {
    const double speed = survey_.legs[k].platform.speed;
    const std::string name = leg_name(k) + ": movePerSec_m";
    if (!(speed > 0)) throw SettingError(name, speed, "m/s", "greater than 0, as the leg would never end otherwise");
    if (survey_.platform.kind != PlatformKind::linear_path) require_within(name, speed, 1e-3, 1e3, "m/s");
    return speed;
  }

  static constexpr double max_duration = 1e15;  ///< range of a Tick [s]

  void fly_straight() {
    double heading = heading_from(0, 0);
    for (std::size_t k = 0; k + 1 < places_.size(); ++k) {
      const Vec3 way = places_[k + 1] - places_[k];
      if (length(way) == 0) {
        paths_[k].path.path = Tripod{places_[k], heading};
        continue;
      }
      const StraightLine line{places_[k], places_[k + 1], speed_of(k)};
      const double least = length(way) / max_duration;
      if (line.speed < least)
        throw SettingError(leg_name(k) + ": movePerSec_m", line.speed, "m/s",
                           "at least " + text::to_text(least) + ", for an end within 1e15 s");
      heading = heading_of(way, heading);
      paths_[k] = {{line, {}}, line.duration().seconds()};
    }
    paths_.back().path.path = Tripod{places_.back(), heading};
  }

  [[nodiscard]] bool stops_after(std::size_t k) const {
    const LegPlatformSettings &now = survey_.legs[k].platform, &next = survey_.legs[k + 1].platform;
    return !now.smooth_turn || now.speed != next.speed;
  }

  /// Heading of the first displacement from leg `k` on; `otherwise` if there is none [rad].
  [[nodiscard]] double heading_from(std::size_t k, double otherwise) const {
    while (k + 1 < places_.size() && places_[k + 1] == places_[k]) ++k;
    return k + 1 < places_.size() ? heading_of(places_[k + 1] - places_[k], otherwise) : otherwise;
  }

  /// Heading of a multicopter at the start of a leg, within a turn [rad].
  [[nodiscard]] double departure_of(std::size_t k, double otherwise) const {
    const std::optional<double>& yaw = survey_.legs[k].platform.yaw_at_departure;
    return !yaw ? otherwise : std::fabs(*yaw) > max_angle ? std::remainder(-*yaw, 2 * pi) : -*yaw;
  }

  /// Plans one flight for each run of legs without a stop.
  void fly() {
    const std::size_t last = places_.size() - 1;
    double heading = departure_of(0, heading_from(0, 0));
    for (std::size_t k = 0, end = 0; k < last; k = end) {
      end = k + 1;
      heading = departure_of(k, heading);
      if (is_stationary(k)) {
        paths_[k].path.path = Tripod{places_[k], heading};
        continue;
      }
      while (end < last && !stops_after(end - 1) && !is_stationary(end)) ++end;
      std::vector<FlightPoint> points;
      for (std::size_t i = k; i <= end; ++i) points.push_back({places_[i], 0});
      const LegPlatformSettings& p = survey_.legs[k].platform;
      const MulticopterDynamics& d = survey_.platform.multicopter;
      MulticopterSettings s{.speed = speed_of(k)};
      s.turn = p.smooth_turn ? MulticopterTurn::smooth : MulticopterTurn::stop_and_turn;
      s.yaw_rate = std::clamp(d.yaw_speed, 1e-3, 1e3);
      s.bank_max = std::clamp(d.pitch_offset, 1e-3, 1.5);
      if (s.yaw_rate != d.yaw_speed) warn("yaw_speed_deg is taken as " + brief(degrees(s.yaw_rate)));
      if (s.bank_max != d.pitch_offset) warn("pitch_offset_deg is taken as " + brief(degrees(s.bank_max)));
      s.departure_heading = heading;
      heading = heading_from(end - 1, heading);
      s.arrival_heading = heading_from(end, heading);
      if (end < last) s.arrival_heading = departure_of(end, *s.arrival_heading);
      const auto flight = std::make_shared<const MulticopterFlight>(detail::flight_over(points, s));
      split(k, end, flight, flight->duration().seconds());
      heading = *s.arrival_heading;
    }
    paths_.back().path.path = Tripod{places_.back(), heading};
  }

  void drive(const GroundHeight& ground) {
    const std::size_t last = places_.size() - 1;
    double height = std::numeric_limits<double>::infinity();  // that of the last drive's end
    for (std::size_t k = 0, end = 0; k < last; k = end) {
      end = k + 1;
      if (is_stationary(k)) continue;
      const auto speed = [&](std::size_t i) { return survey_.legs[i].platform.speed; };
      while (end < last && !is_stationary(end) && speed(end - 1) == speed(end)) ++end;
      if (end == last - 1 && !is_stationary(end)) end = last;  // the last leg only ends the path
      std::vector<Vec2> points;
      for (std::size_t i = k; i <= end; ++i) points.push_back({places_[i].x, places_[i].y});
      const GroundVehicleSettings settings{
          .speed = speed_of(k), .start_height = height, .height_without_ground = places_[k].z};
      auto plan = plan_ground_vehicle(points, ground, settings);
      const auto way = std::make_shared<const GroundVehicleDrive>(std::move(plan));
      for (const std::string& warning : way->warnings()) warn(leg_name(k) + ": " + warning);
      height = way->at(way->duration()).position.z;
      split(k, end, way, way->duration().seconds());
      for (std::size_t i = k; i < end; ++i) note_slowness(i, settings);
    }
    park(ground);
    if (last == 0) return;
    const auto& before = paths_[last - 1];
    paths_.back().path = {before.path.path, before.path.start + Tick::of_seconds(before.duration)};
  }

  /// Notes a leg that takes twice as long as its way at its speed, with speeding up and braking.
  void note_slowness(std::size_t k, const GroundVehicleSettings& s) {
    const double way = std::hypot(places_[k + 1].x - places_[k].x, places_[k + 1].y - places_[k].y);
    const double expected = way / s.speed + s.speed / s.acceleration + s.acceleration / s.jerk;
    if (paths_[k].duration > 2 * expected)
      warn(text::joined({leg_name(k), ": the vehicle takes ", brief(paths_[k].duration), " s for ", brief(way),
                         " m at up to ", brief(s.speed), " m/s; turns and steep ground take time"}));
  }

  /// Gives a vehicle at rest the pose of its arrival; that of its departure if it never arrived.
  void park(const GroundHeight& ground) {
    for (std::size_t k = 0; k < paths_.size(); ++k) {
      if (!is_stationary(k)) continue;
      std::size_t next = k;
      while (next + 1 < paths_.size() && is_stationary(next)) ++next;
      Vec3 at = places_[k];
      at.z = ground(Vec2{at.x, at.y}).value_or(at.z);
      auto pose = Tripod{at}.at({});
      if (k > 0)
        pose = paths_[k - 1].path.at(Tick::of_seconds(paths_[k - 1].duration));
      else if (next + 1 < paths_.size())
        pose = paths_[next].path.at({});
      const std::vector<TimedPose> poses{{0, pose.position, pose.rotation}};
      paths_[k].path.path = std::make_shared<const Waypoints>(poses);
    }
  }

  /// Divides a plan among the legs from `k` to `end`. A leg lasts until the path is nearest to the
  /// start of the next; a flight also completes its turn towards the waypoint after that.
  template <class Plan>
  void split(std::size_t k, std::size_t end, const std::shared_ptr<const Plan>& plan, double whole) {
    double from = 0;
    for (std::size_t i = k; i < end; ++i) {
      double to = i + 1 == end ? whole : detail::nearest_moment(*plan, i + 1 - k, places_[i + 1], from, whole);
      if constexpr (std::same_as<Plan, MulticopterFlight>)
        if (i + 1 < end) to = detail::end_of_turn(*plan, to, places_[i + 2], plan->passes()[i + 2 - k].seconds());
      paths_[i] = {{plan, Tick::of_seconds(from)}, to - from};
      from = to;
    }
  }

  [[nodiscard]] io::TrajectoryTable table_of(const TrajectorySettings& t) const {
    const auto given = options_.trajectories.find(t.file.string());
    if (given != options_.trajectories.end()) return poses_within(given->second, t);
    io::TrajectoryFormat format = trajectory_format(t, survey_.platform.rotation_spec);
    format.projector = options_.projector;
    return io::read_trajectory(t.file, format, {t.start, t.end});
  }

  void follow() {
    struct Key {
      std::string file;
      std::optional<double> start, end;
      auto operator<=>(const Key&) const = default;
    };
    std::map<Key, io::TrajectoryTable> tables;
    std::map<std::string, TrajectorySettings> formats;  // columns and separator by file
    for (std::size_t k = 0; k < survey_.legs.size(); ++k) {
      std::optional<TrajectorySettings> t = survey_.legs[k].platform.trajectory;
      if (!t) throw SettingError(leg_name(k) + ": trajectory (number)", 0, "", "1, for an interpolated platform");
      TrajectorySettings& of_file = formats[t->file.string()];
      if (!of_file.columns) of_file.columns = t->columns;
      if (!of_file.separator) of_file.separator = t->separator;
      t->columns = of_file.columns;
      t->separator = of_file.separator;
      const Key key{t->file.string(), t->start, t->end};
      if (!tables.contains(key)) {
        auto table = naming(leg_name(k), [&] { return table_of(*t); });
        for (const std::string& warning : table.warnings) warn(warning);
        if (t->position_only) table.poses = with_headings(std::move(table.poses));
        tables.emplace(key, std::move(table));
      }
      const io::TrajectoryTable& table = tables.at(key);
      const auto path = std::make_shared<const Waypoints>(table.poses);
      const double duration = path->duration().seconds(),
                   latest = std::fmax(std::fabs(table.start_time), std::fabs(table.start_time + duration));
      paths_[k] = {{path, {}}, duration, std::nextafter(latest, max_duration) - latest};
      if (!survey_.legs.front().platform.trajectory->sync_clock) continue;
      paths_[k].clock = table.start_time;
      clock_start_ = std::min(clock_start_.value_or(table.start_time), table.start_time);
    }
  }

  void warn(std::string text) {
    if (std::ranges::find(warnings_, text) == warnings_.end()) warnings_.push_back(std::move(text));
  }

  const SurveySettings& survey_;
  const SurveyBuildOptions& options_;
  std::vector<Vec3> places_;  // start positions of the legs [m]
  std::vector<LegPath> paths_;
  std::optional<double> clock_start_;
  std::vector<std::string> warnings_;
};

}  // namespace PULSECAST_NAMESPACE::helios

#endif
