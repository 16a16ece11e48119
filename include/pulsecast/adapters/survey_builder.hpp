// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <pulsecast/adapters/survey_leg.hpp>
#include <pulsecast/adapters/survey_optics.hpp>
#include <pulsecast/adapters/survey_settings.hpp>
#include <pulsecast/adapters/trajectory_table.hpp>
#include <pulsecast/base/random.hpp>
#include <pulsecast/platform/ground_vehicle.hpp>
#include <pulsecast/platform/legs.hpp>
#include <pulsecast/platform/multicopter.hpp>
#include <pulsecast/platform/platform.hpp>
#include <pulsecast/platform/straight_line.hpp>
#include <pulsecast/platform/tripod.hpp>
#include <pulsecast/platform/waypoints.hpp>

/// From the settings of a survey document to pulses.
namespace pulsecast::adapters {

struct SurveyBuildOptions {
  std::uint64_t seed = 0;      ///< of leg offsets and noise
  bool platform_noise = true;  ///< whether there is any
  bool leg_noise = true;       ///< whether legs begin elsewhere than they should
};

/// A survey that can be run, and what is known of its legs.
struct SurveyPlan {
  struct LegPlan {
    std::size_t number = 0;  ///< in the document, from 0
    bool active = true;
    std::optional<std::string> strip{};
    PulseIndex first = 0, end = 0;  ///< its slots in the survey
    Tick start{}, duration{};
    double trajectory_interval = 0;  ///< [s]; 0: no records
    double pulse_rate = 0;           ///< [Hz]
  };
  Legs<SurveyLeg> source;
  std::vector<LegPlan> legs;
  std::optional<double> clock_start{};  ///< when the survey begins, if a trajectory says so [s]
  std::vector<std::string> warnings{};
};

namespace detail {

[[nodiscard]] inline std::string leg_name(std::size_t k) { return "leg " + std::to_string(k); }

/// Where a leg begins and how it moves; what remains is its duration.
struct LegWay {
  SurveyPath path{};
  double duration = 0;  ///< until it is there [s]
};

/// Turns settings into a plan.
class SurveyPlanner {
 public:
  SurveyPlanner(const SurveySettings& survey, const SurveyBuildOptions& options) : survey_(survey), options_(options) {}

  [[nodiscard]] SurveyPlan plan(const Ground auto& ground) {
    if (survey_.legs.empty()) throw SettingError("legs (number)", 0, "", "at least 1");
    if (survey_.scanner.channels.empty()) throw SettingError("channels (number)", 0, "", "at least 1");
    place(ground);
    ways(ground);
    std::vector<Leg<SurveyLeg>> legs;
    std::vector<SurveyPlan::LegPlan> plans;
    PulseIndex first = 0;
    Tick start{};
    double optic_time = 0;
    for (std::size_t k = 0; k < survey_.legs.size(); ++k) {
      const LegSettings& leg = survey_.legs[k];
      const double rate = rate_of(leg);
      const double duration = duration_of(k, rate);
      const auto slots = static_cast<PulseIndex>(std::max(0.0, std::ceil(duration * rate - 1e-6)));
      if (!leg.scanner.active) optic_time = 0;
      std::vector<SurveyChannel> channels;
      for (const ChannelSettings& channel : survey_.scanner.channels)
        channels.emplace_back(optic(k, channel, rate, optic_time),
                              Scanner{.pulse_rate = rate, .pulses = slots, .laser = survey_laser(channel, leg.scanner)});
      const Tick time = Tick::of(slots, rate);
      if (leg.scanner.active) optic_time += time.seconds();
      SurveyNoise noise{.seed = options_.seed + 0x9e3779b97f4a7c15U * (k + 1)};
      if (options_.platform_noise) noise.position = survey_.platform.position_noise, noise.attitude = survey_.platform.attitude_noise;
      const Mount mount{.lever_arm = survey_.platform.mount.position, .boresight = survey_.platform.mount.rotation.rotation()};
      legs.push_back({SurveyLeg(ways_[k].path, mount, std::move(channels), time, std::move(noise)), leg.scanner.active, strip_of(k)});
      const PulseIndex size = leg.scanner.active ? legs.back().platform.size() : 0;
      plans.push_back({k, leg.scanner.active, leg.strip, first, first + size, start, time, leg.scanner.trajectory_interval, rate});
      first += size, start = start + time;
    }
    return {Legs<SurveyLeg>(std::move(legs)), std::move(plans), clock_start_, std::move(warnings_)};
  }

 private:
  [[nodiscard]] double rate_of(const LegSettings& leg) const {
    double rate = leg.scanner.pulse_rate;
    if (!(rate > 0) && !survey_.scanner.pulse_rates.empty()) rate = survey_.scanner.pulse_rates.front();
    expect_positive("pulseFreq_hz", rate, "Hz");
    return rate;
  }

  /// The number that the leg's pulses carry: legs of one strip have that of its first.
  [[nodiscard]] std::uint16_t strip_of(std::size_t k) const {
    std::size_t first = k;
    if (survey_.legs[k].strip)
      for (std::size_t i = k; i-- > 0;)
        if (survey_.legs[i].strip == survey_.legs[k].strip) first = i;
    return static_cast<std::uint16_t>(first);
  }

  SurveyOptic optic(std::size_t k, const ChannelSettings& channel, double rate, double active) const {
    const LegScannerSettings& leg = survey_.legs[k].scanner;
    try {
      if (leg.active) return survey_optic(channel, leg, rate, survey_.platform.mount.rotation.rotation(), {active});
      return {};  // nobody asks it
    } catch (const SettingError& error) {
      throw SettingError(leg_name(k) + ": " + error.field(), error.value(), error.unit(), error.allowed());
    }
  }

  void place(const Ground auto& ground) {
    for (std::size_t k = 0; k < survey_.legs.size(); ++k) {
      const LegPlatformSettings& p = survey_.legs[k].platform;
      Vec3 at = p.position;
      if (p.on_ground && survey_.platform.kind != PlatformKind::interpolated) {
        const std::optional<double> height = ground(Vec2{at.x, at.y});
        if (!height)
          throw SettingError(leg_name(k) + ": onGround at x = " + pulsecast::detail::written(at.x) + ", y", at.y, "m",
                             "where the scene has ground: a material with helios_isGround");
        at.z = *height;
      }
      if (survey_.leg_offset && options_.leg_noise)
        for (int axis = 0; axis < 3; ++axis)
          at[axis] += survey_.leg_offset->mean + survey_.leg_offset->deviation * normal({.seed = options_.seed + 1,
                                                                                         .pulse = k,
                                                                                         .subray = static_cast<std::uint32_t>(axis),
                                                                                         .purpose = Purpose::position_noise});
      places_.push_back(at);
    }
  }

  void ways(const Ground auto& ground) {
    const std::size_t n = survey_.legs.size();
    ways_.resize(n);
    const PlatformKind kind = survey_.platform.kind;
    if (kind != PlatformKind::stationary && kind != PlatformKind::interpolated && n < 2)
      throw SettingError("legs (number)", 1, "", "at least 2 for a platform that moves: each leg goes to where the next one begins");
    switch (kind) {
      case PlatformKind::stationary:
        for (std::size_t k = 0; k < n; ++k) ways_[k].path.path = Tripod{places_[k]};
        break;
      case PlatformKind::linear_path:
        fly_straight();
        break;
      case PlatformKind::multicopter:
        fly();
        break;
      case PlatformKind::ground_vehicle:
        drive(ground);
        break;
      case PlatformKind::interpolated:
        follow();
        break;
    }
  }

  [[nodiscard]] double speed_of(std::size_t k) const {
    const double speed = survey_.legs[k].platform.speed;
    if (!(speed > 0)) throw SettingError(leg_name(k) + ": movePerSec_m", speed, "m/s", "greater than 0, or the leg would never end");
    return speed;
  }

  void fly_straight() {
    double heading = 0;
    for (std::size_t k = 0; k + 1 < places_.size(); ++k) {
      const Vec3 way = places_[k + 1] - places_[k];
      if (length(way) == 0) {
        ways_[k].path.path = Tripod{places_[k], heading};
        continue;
      }
      const StraightLine line{places_[k], places_[k + 1], speed_of(k)};
      heading = heading_of(way, heading);
      ways_[k] = {{line, {}}, line.duration().seconds()};
    }
    ways_.back().path.path = Tripod{places_.back(), heading};
  }

  [[nodiscard]] bool stops_after(std::size_t k) const {
    const LegPlatformSettings &now = survey_.legs[k].platform, &next = survey_.legs[k + 1].platform;
    return !now.smooth_turn || now.speed != next.speed;
  }

  [[nodiscard]] double heading_between(std::size_t k, double otherwise) const {
    return k + 1 < places_.size() ? heading_of(places_[k + 1] - places_[k], otherwise) : otherwise;
  }

  /// Legs that the multicopter flies without a stop are one flight.
  void fly() {
    const std::size_t last = places_.size() - 1;
    double heading = 0;
    for (std::size_t k = 0; k < last;) {
      std::size_t end = k + 1;
      while (end < last && !stops_after(end - 1)) ++end;
      std::vector<FlightPoint> points;
      for (std::size_t i = k; i <= end; ++i) points.push_back({places_[i], 0});
      const LegPlatformSettings& p = survey_.legs[k].platform;
      const MulticopterDynamics& d = survey_.platform.multicopter;
      MulticopterSettings s{.speed = speed_of(k)};
      s.turn = p.smooth_turn ? MulticopterTurn::smooth : MulticopterTurn::stop_and_turn;
      s.yaw_rate = std::clamp(d.yaw_speed, 1e-3, 1e3);
      s.bank_max = std::clamp(d.pitch_offset, 1e-3, 1.5);
      s.departure_heading = p.yaw_at_departure ? -*p.yaw_at_departure : heading_between(k, heading);
      heading = heading_between(end - 1, *s.departure_heading);
      s.arrival_heading = heading_between(end, heading);
      if (end < last && survey_.legs[end].platform.yaw_at_departure) s.arrival_heading = -*survey_.legs[end].platform.yaw_at_departure;
      const auto flight = std::make_shared<const MulticopterFlight>(over(points, s));
      split(k, end, flight, flight->duration().seconds());
      heading = *s.arrival_heading;
      k = end;
    }
    ways_.back().path.path = Tripod{places_.back(), heading};
  }

  /// A flight over its waypoints: as smooth turns cut corners, these are moved outwards until the way passes where it should.
  [[nodiscard]] static MulticopterFlight over(std::vector<FlightPoint> points, const MulticopterSettings& s) {
    const std::vector<FlightPoint> wanted = points;
    MulticopterFlight flight = plan_multicopter(points, s);
    if (s.turn != MulticopterTurn::smooth) return flight;
    for (int round = 0; round < 8; ++round) {
      double from = 0, most = 0;
      const double whole = flight.duration().seconds();
      for (std::size_t i = 1; i + 1 < points.size(); ++i) {
        from = nearest_moment(flight, wanted[i].position, from, whole);
        const Vec3 miss = wanted[i].position - flight.at(Tick::of_seconds(from)).position;
        points[i].position += miss, most = std::max(most, length(miss));
      }
      if (most < 0.01) break;
      flight = plan_multicopter(points, s);
    }
    return flight;
  }

  void drive(const Ground auto& ground) {
    const std::size_t last = places_.size() - 1;
    for (std::size_t k = 0; k < last;) {
      std::size_t end = k + 1;
      while (end < last && survey_.legs[end - 1].platform.speed == survey_.legs[end].platform.speed) ++end;
      if (end == last - 1) end = last;  // the last leg only says where the way ends
      std::vector<Vec2> points;
      for (std::size_t i = k; i <= end; ++i) points.push_back({places_[i].x, places_[i].y});
      const auto solid = [&](const Vec2& at) -> std::optional<double> {
        if (const std::optional<double> height = ground(at)) return height;
        return places_[k].z;
      };
      const auto way = std::make_shared<const GroundVehicleDrive>(plan_ground_vehicle(points, solid, {.speed = speed_of(k)}));
      split(k, end, way, way->duration().seconds());
      k = end;
    }
    const auto& before = ways_[last - 1];
    ways_.back().path = {before.path.path, before.path.start + Tick::of_seconds(before.duration)};
  }

  /// Divides one plan among the legs from `k` to `end`, each until the way is nearest to where the next begins, and a flight has turned
  /// to where it goes from there.
  template <class Plan>
  void split(std::size_t k, std::size_t end, const std::shared_ptr<const Plan>& plan, double whole) {
    double from = 0;
    for (std::size_t i = k; i < end; ++i) {
      double to = i + 1 == end ? whole : nearest_moment(*plan, places_[i + 1], from, whole);
      if constexpr (std::same_as<Plan, MulticopterFlight>)
        if (i + 1 < end) to = end_of_turn(*plan, to, places_[i + 2], whole);
      ways_[i] = {{plan, Tick::of_seconds(from)}, to - from};
      from = to;
    }
  }

  /// When a plan first passes a place, after a time: the first of its nearest approaches that is no farther than any other by more than a
  /// metre.
  template <class Plan>
  [[nodiscard]] static double nearest_moment(const Plan& plan, const Vec3& place, double from, double whole) {
    const auto distance = [&](double t) {
      const Vec3 off = plan.at(Tick::of_seconds(t)).position - place;
      return std::hypot(off.x, off.y);
    };
    constexpr int steps = 20'000;
    const double step = (whole - from) / steps;
    double least = distance(from);
    for (int i = 1; i <= steps; ++i) least = std::min(least, distance(from + i * step));
    double before = distance(from), best = whole;
    for (int i = 1; i <= steps; ++i) {
      const double now = distance(from + i * step);
      if (now > before && before <= least + 1) {
        best = from + (i - 1) * step;
        break;
      }
      before = now;
    }
    double low = std::max(from, best - step), high = std::min(whole, best + step);  // golden-section search would do no better
    for (int i = 0; i < 60; ++i) {
      const double a = low + (high - low) / 3, b = high - (high - low) / 3;
      (distance(a) < distance(b) ? high : low) = distance(a) < distance(b) ? b : a;
    }
    return 0.5 * (low + high);
  }

  /// When a flight, from a time on, first goes straight at a place, within a degree.
  [[nodiscard]] static double end_of_turn(const MulticopterFlight& flight, double from, const Vec3& place, double whole) {
    for (double t = from; t < whole; t += 0.01) {
      const auto state = flight.motion().at(Tick::of_seconds(t));
      const Vec3 way = place - state.position;
      if (dot(state.velocity, way) >= std::cos(radians(1)) * length(state.velocity) * length(way)) return t;
    }
    return from;
  }

  void follow() {
    struct Key {
      std::string file;
      std::optional<double> start, end;
      auto operator<=>(const Key&) const = default;
    };
    std::map<Key, TrajectoryTable> tables;
    for (std::size_t k = 0; k < survey_.legs.size(); ++k) {
      const std::optional<TrajectorySettings>& t = survey_.legs[k].platform.trajectory;
      if (!t) throw SettingError(leg_name(k) + ": trajectory (number)", 0, "", "1, for an interpolated platform");
      TrajectoryFormat format = helios_format();
      format.angles = survey_.platform.rotation_spec == RotationSpec::canonical ? helios_canonical : helios_arinc_705;
      format.separator = std::string(",;\t ").find(t->separator) != std::string::npos ? t->separator : ',';
      format.angle_unit = t->angles_in_degrees ? AngleUnit::degree : AngleUnit::radian;
      if (t->position_only) format.columns = {"t", "x", "y", "z"};
      if (t->columns) columns_of(*t, format);
      if (t->slope_filter > 0) warn(leg_name(k) + ": slopeFilterThreshold has no effect: all samples are kept");
      const Key key{t->file.string(), t->start, t->end};
      if (!tables.contains(key)) {
        TrajectoryTable table = read_trajectory(t->file, format, {t->start, t->end});
        for (const std::string& warning : table.warnings) warn(warning);
        if (t->position_only) table.poses = with_headings(std::move(table.poses));
        tables.emplace(key, std::move(table));
      }
      const TrajectoryTable& table = tables.at(key);
      if (k == 0 && t->sync_clock) clock_start_ = table.start_time;
      const auto path = std::make_shared<const Waypoints>(table.poses);
      ways_[k] = {{path, {}}, path->duration().seconds()};
    }
  }

  static void columns_of(const TrajectorySettings& t, TrajectoryFormat& format) {
    std::vector<std::pair<int, const char*>> columns{{t.columns->time, "t"}, {t.columns->x, "x"}, {t.columns->y, "y"}, {t.columns->z, "z"}};
    if (!t.position_only) columns.insert(columns.end(), {{t.columns->roll, "roll"}, {t.columns->pitch, "pitch"}, {t.columns->yaw, "yaw"}});
    int most = 0;
    for (const auto& [place, name] : columns) most = std::max(most, place);
    format.names = ColumnNames::nowhere;
    format.columns.clear();
    for (int i = 0; i <= most; ++i) format.columns.push_back("column " + std::to_string(i));
    for (std::string& c : format.columns) std::replace(c.begin(), c.end(), ' ', '_');
    format.left_out = format.columns;
    for (const auto& [place, name] : columns) format.columns[static_cast<std::size_t>(place)] = name;
    std::erase_if(format.left_out,
                  [&](const std::string& c) { return std::find(format.columns.begin(), format.columns.end(), c) == format.columns.end(); });
  }

  /// How long a leg lasts: until the platform is there and the head has turned, but not longer than it may.
  [[nodiscard]] double duration_of(std::size_t k, double rate) const {
    const LegSettings& leg = survey_.legs[k];
    const LegScannerSettings& s = leg.scanner;
    const double turn = s.head_stop - s.head_start, speed = head_rate(survey_.scanner.channels.front(), s);
    const bool stands = ways_[k].duration == 0;
    double duration = ways_[k].duration;
    const bool last_of_moving = stands && k + 1 == survey_.legs.size() && survey_.platform.kind != PlatformKind::stationary;
    if (last_of_moving) return 0;
    if (speed != 0 && turn / speed > 0)
      duration = std::max(duration, turn / speed - s.warm_up);
    else if (turn * s.head_speed < 0)
      throw SettingError(leg_name(k) + ": headRotateStop_deg", degrees(s.head_stop), "deg",
                         "on the side of headRotateStart_deg to which the head turns");
    else if (turn != 0 && !leg.duration_max && s.active)
      throw SettingError(leg_name(k) + ": headRotatePerSec_deg", degrees(s.head_speed), "deg/s",
                         "other than 0, for a scanner whose headRotatePerSecMax_deg is, or the leg would never end");
    if (leg.duration_max) {
      const double most = *leg.duration_max;
      return stands && duration == 0 ? most : std::min(duration, most);
    }
    if (stands && duration == 0 && s.active)
      throw SettingError(leg_name(k) + ": maxDuration_s", 0, "s",
                         "given where neither platform nor head moves, or the leg would never end");
    expect_within(leg_name(k) + " (pulses)", duration * rate, 0, 1e15, "");
    return std::max(0.0, duration);
  }

  void warn(std::string text) {
    if (std::find(warnings_.begin(), warnings_.end(), text) == warnings_.end()) warnings_.push_back(std::move(text));
  }

  const SurveySettings& survey_;
  const SurveyBuildOptions& options_;
  std::vector<Vec3> places_;  // where legs begin
  std::vector<LegWay> ways_;
  std::optional<double> clock_start_;
  std::vector<std::string> warnings_;
};

}  // namespace detail

/// The pulses of a survey. `ground` gives the height of the scene's ground. Throws a `SettingError` that names leg and attribute, or a
/// `FileError` of a trajectory.
[[nodiscard]] SurveyPlan plan_survey(const SurveySettings& survey, const Ground auto& ground, const SurveyBuildOptions& options = {}) {
  return detail::SurveyPlanner(survey, options).plan(ground);
}

}  // namespace pulsecast::adapters
