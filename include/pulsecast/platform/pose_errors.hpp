// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_PLATFORM_POSE_ERRORS_HPP
#define PULSECAST_PLATFORM_POSE_ERRORS_HPP

#include <pulsecast/platform/platform.hpp>

namespace PULSECAST_NAMESPACE {

/// Standard deviations along or about the x, y and z of a frame, or one number for all.
struct AxisDeviations {
  double x;  ///< along or about x [m or rad]
  double y;  ///< along or about y [m or rad]
  double z;  ///< along or about z [m or rad]

  /// The same for all axes.
  constexpr AxisDeviations(double each) noexcept : x(each), y(each), z(each) {}
  /// One for each axis.
  constexpr AxisDeviations(double x_, double y_, double z_) noexcept : x(x_), y(y_), z(z_) {}

  [[nodiscard]] constexpr bool none() const noexcept { return x == 0 && y == 0 && z == 0; }  ///< no error
  [[nodiscard]] constexpr bool alike() const noexcept { return x == y && y == z; }           ///< the same for all axes
  friend bool operator==(const AxisDeviations&, const AxisDeviations&) = default;
};

/// Errors of reported poses, zero by default: standard deviations along or about each axis of the body.
/// `uncertainty_of` a survey states them; a lever arm or boresight error of a given size counts there as one standard
/// deviation.
struct PoseErrors {
  AxisDeviations position_noise = 0;  ///< white noise of the position [m]
  AxisDeviations attitude_noise = 0;  ///< white noise of the attitude [rad]
  AxisDeviations position_drift = 0;  ///< slow drift of the position: a Gauss-Markov process [m]
  AxisDeviations attitude_drift = 0;  ///< slow drift of the attitude, of the same kind [rad]
  double drift_time = 60;             ///< decay of drifts to 1/e; at least 1e-6 of the survey [s]
  AxisDeviations angular_jitter = 0;  ///< unreported turn of each beam about its x and z; y is without effect [rad]
  Vec3 lever_arm_error{};             ///< reported minus true lever arm [m]
  Rotation boresight_error = no_rotation;  ///< from the true instrument to the reported one
  std::uint64_t seed = 0;                  ///< of all draws; each of several `Legs` draws its own
  AxisDeviations position_offset = 0;      ///< of the position, constant over a leg, as of a registration [m]
  AxisDeviations attitude_offset = 0;      ///< of the attitude, constant over a leg [rad]
  AxisDeviations lever_arm_deviation = 0;  ///< of the lever arm, drawn once for all legs [m]
  AxisDeviations boresight_deviation =
      0;                         ///< of the boresight about the instrument's axes, drawn once for all legs [rad]
  double latency_deviation = 0;  ///< of the clock of poses, drawn once for all legs [s]

  void validate() const {
    require("position_noise", position_noise, 1e6, "m");
    require("attitude_noise", attitude_noise, max_angle, "rad");
    require("position_drift", position_drift, 1e6, "m");
    require("attitude_drift", attitude_drift, max_angle, "rad");
    require_positive("PoseErrors::drift_time", drift_time, "s");
    require("angular_jitter", angular_jitter, max_angle, "rad");
    require_finite("PoseErrors::lever_arm_error (length)", length(lever_arm_error), "m");
    require_rotation("PoseErrors::boresight_error", boresight_error);
    require("position_offset", position_offset, 1e6, "m");
    require("attitude_offset", attitude_offset, max_angle, "rad");
    require("lever_arm_deviation", lever_arm_deviation, 1e6, "m");
    require("boresight_deviation", boresight_deviation, max_angle, "rad");
    require_not_negative("PoseErrors::latency_deviation", latency_deviation, "s");
  }
  void normalize() noexcept { boresight_error = unit(boresight_error); }

 private:
  static void require(const char* member, const AxisDeviations& deviations, double most, const char* unit) {
    for (const double each : {deviations.x, deviations.y, deviations.z})
      require_within(std::string("PoseErrors::") + member, each, 0, most, unit);
  }
};

/// Platform with pose errors: rays start at the true pose, points are of the reported one.
template <Trajectory Path, InstrumentSource Source>
class WithPoseErrors {
 public:
  using refinements = refines<tag::MakesLanes, tag::DrawsByLeg, tag::StatesErrors>;
  /// @throws SettingError for settings out of range
  WithPoseErrors(Platform<Path, Source> truth, PoseErrors errors)
      : truth_(std::move(truth)), errors_(validated(errors)) {
    calibration_ = {errors_.boresight_error * rotation_by(drawn_once(errors_.boresight_deviation, 0)),
                    errors_.lever_arm_error + drawn_once(errors_.lever_arm_deviation, 1)};
    latency_ = drawn_once(errors_.latency_deviation, 2).x;
    draw();
  }

  void draw_for_leg(std::uint32_t leg) {
    if (leg != std::exchange(leg_, leg)) draw();
  }

  [[nodiscard]] PulseIndex size() const noexcept { return truth_.size(); }
  [[nodiscard]] Tick duration() const noexcept { return truth_.duration(); }
  [[nodiscard]] std::vector<Emitter> emitters() const { return truth_.emitters(); }
  [[nodiscard]] const Platform<Path, Source>& truth() const noexcept { return truth_; }  ///< without errors

  [[nodiscard]] PulseIndex slot_from(Tick t) const noexcept requires FindsSlots<Source> { return truth_.slot_from(t); }
  [[nodiscard]] PulseIndex next_pulse(PulseIndex i) const noexcept requires SkipsBlocked<Source> {
    return truth_.next_pulse(i);
  }

  /// Reported pose of the body.
  [[nodiscard]] Pose<frame::Body, frame::World> reported(Tick t) const noexcept {
    const Pose<frame::Body, frame::World> world_from_body = truth_.trajectory().at(later(t, latency_));
    const Drift drift = drift_at(t);
    const Vec3 moved = white_noise(t, Purpose::position_noise, errors_.position_noise) + drift.position;
    const Vec3 turned = white_noise(t, Purpose::attitude_noise, errors_.attitude_noise) + drift.attitude;
    return world_from_body * Pose<frame::Body, frame::Body>{rotation_by(turned), moved};
  }

  [[nodiscard]] std::optional<Pulse<frame::World>> pulse(PulseIndex i) const noexcept { return pulse_lanes(i, 1)[0]; }

  [[nodiscard]] PulseLanes<frame::World> pulse_lanes(PulseIndex i, std::size_t count) const noexcept {
    const auto inner = find_pulses(truth_.source(), i, count);
    auto out = truth_.placed(jittered(inner, i));
    const Pose<frame::Instrument, frame::Body> calibrated{truth_.mount().boresight * calibration_.rotation,
                                                          truth_.mount().lever_arm + calibration_.position};
    for (std::size_t lane = 0; lane < inner.size; ++lane) {
      if (inner.sent[lane] == 0) continue;
      const Tick t = inner.tick[lane];
      auto beam = inner.pose[lane];
      if constexpr (MeasuresBeam<Source>) beam = truth_.source().measured(i + lane, t).value_or(beam);
      out.report(lane, reported(t) * calibrated * beam);
    }
    return out;
  }

  template <class Visit>
  [[gnu::always_inline]] void visit_errors(PulseIndex i, Tick t, const Visit& visit) const noexcept {
    if constexpr (StatesErrors<Source>) truth_.visit_errors(i, t, visit);
    const Pose<frame::Body, frame::World> body = truth_.trajectory().at(t);
    for (const PoseError<frame::Body>& of : stated_)
      if (of.turned_any_way > 0 || of.moved_any_way > 0)
        visit(Error{.about = *of.about == Vec3{} ? body.position : body.point(*of.about),
                    .scope = of.scope,
                    .moved_any_way = of.moved_any_way,
                    .turned_any_way = of.turned_any_way});
      else
        visit(body * of);
    if (errors_.latency_deviation > 0)
      visit(error_between(body, truth_.trajectory().at(later(t, errors_.latency_deviation))));
    if (!errors_.angular_jitter.none()) visit_jitter(i, visit);
  }

 private:
  using Error = PoseError<frame::World>;
  struct Drift {
    Vec3 position{}, attitude{};
  };

  static Tick later(Tick t, double seconds) noexcept { return seconds == 0 ? t : t + Tick::of_seconds(seconds); }

  /// Errors in the frame of the body, but for those of latency and jitter.
  [[nodiscard]] std::vector<PoseError<frame::Body>> in_body() const {
    std::vector<PoseError<frame::Body>> all;
    const auto along = [&]<class Frame>(const Pose<Frame, frame::Body>& of, const AxisDeviations& moved,
                                        const AxisDeviations& turned, ErrorScope scope) {
      const auto add = [&](PoseError<Frame> error) {
        error.about = Vec3{};
        error.scope = scope;
        all.push_back(of * error);
      };
      if (moved.alike() && turned.alike()) {
        if (moved.x > 0 || turned.x > 0) add({.moved_any_way = moved.x, .turned_any_way = turned.x});
        return;
      }
      for (const auto& [move, turn, axis] : {std::tuple(moved.x, turned.x, axis::right),
                                             {moved.y, turned.y, axis::forward},
                                             {moved.z, turned.z, axis::up}}) {
        if (move > 0) add({.moved = move * axis});
        if (turn > 0) add({.turned = turn * axis});
      }
    };
    const Pose<frame::Body, frame::Body> body{};
    const Pose<frame::Instrument, frame::Body> mount = truth_.mount().pose();
    along(body, errors_.position_noise, errors_.attitude_noise, ErrorScope::pulse);
    along(body, errors_.position_drift, errors_.attitude_drift, ErrorScope::correlated);
    along(body, errors_.position_offset, errors_.attitude_offset, ErrorScope::leg);
    along(body, errors_.lever_arm_deviation, 0, ErrorScope::survey);
    along(mount, 0, errors_.boresight_deviation, ErrorScope::survey);
    if (errors_.lever_arm_error != Vec3{})
      all.push_back(error_between(mount, {mount.rotation, mount.position + errors_.lever_arm_error}));
    if (errors_.boresight_error != no_rotation)
      all.push_back(error_between(mount, {mount.rotation * errors_.boresight_error, mount.position}));
    return all;
  }

  void visit_jitter(PulseIndex i, const auto& visit) const noexcept {
    const auto [about_x, unused, about_z] = errors_.angular_jitter;
    if (about_x == about_z) {  // that about the axis of the beam is without effect
      if (about_x > 0) visit(Error{.turned_any_way = about_x});
    } else if (const auto p = truth_.pulse(i)) {
      visit(Error{.turned = p->pose.direction({about_x, 0, 0})});
      visit(Error{.turned = p->pose.direction({0, 0, about_z})});
    }
  }

  double drawn(std::uint64_t moment, std::uint32_t number, Purpose purpose) const noexcept {
    return normal({errors_.seed, moment, number, purpose, leg_});
  }

  Vec3 normals(std::uint64_t moment, Purpose purpose, std::uint32_t second = 0) const noexcept {
    const std::uint32_t first = 3 * second;
    return {drawn(moment, first, purpose), drawn(moment, first + 1, purpose), drawn(moment, first + 2, purpose)};
  }

  /// White noise, common to emitters that fire together. No two ticks within 45 years share it.
  Vec3 white_noise(Tick t, Purpose purpose, const AxisDeviations& deviations) const noexcept {
    if (deviations.none()) return {};
    const auto part = std::bit_cast<std::uint64_t>(t.fraction);
    return by_axis(deviations, normals(part, purpose, static_cast<std::uint32_t>(t.second)));
  }

  static Vec3 by_axis(const AxisDeviations& of, const Vec3& draws) noexcept {
    return {of.x * draws.x, of.y * draws.y, of.z * draws.z};
  }

  /// Error that all legs share.
  Vec3 drawn_once(const AxisDeviations& of, std::uint32_t number) const noexcept {
    const auto draw = [&](std::uint32_t k) { return normal({errors_.seed, 2 + k, number, Purpose::calibration}); };
    return by_axis(of, {draw(0), draw(1), draw(2)});
  }

  PulseLanes<frame::Instrument> jittered(PulseLanes<frame::Instrument> p, PulseIndex i) const noexcept {
    if (errors_.angular_jitter.none()) return p;
    for (std::size_t lane = 0; lane < p.size; ++lane) {
      const double aside = errors_.angular_jitter.z * drawn(i + lane, 0, Purpose::angular_jitter);
      const double upwards = errors_.angular_jitter.x * drawn(i + lane, 1, Purpose::angular_jitter);
      const Rotation turned = p.pose.rotation[lane] * rotation_about(axis::up, -aside);
      p.pose.rotation.set(lane, turned * rotation_about(axis::right, upwards));
    }
    return p;
  }

  /// Draws what is constant over a leg, and the drift at nodes: the last, decayed, plus a random part.
  /// Source: Gelb 1974, sec. 3.8.
  void draw() {
    offset_ = {by_axis(errors_.position_offset, normals(0, Purpose::calibration)),
               by_axis(errors_.attitude_offset, normals(1, Purpose::calibration))};
    if (errors_.position_drift.none() && errors_.attitude_drift.none()) return;
    const double kept = std::exp(-1.0 / nodes_per_drift_time), added = std::sqrt(1 - kept * kept);
    const double nodes = std::ceil(truth_.duration().seconds() / errors_.drift_time * nodes_per_drift_time) + 2;
    const double times = nodes / nodes_per_drift_time;
    require_within("PoseErrors::drift_time (survey duration divided by it)", times, 0, 1e6, "");
    drift_.clear();
    for (std::uint64_t n = 0; n < static_cast<std::uint64_t>(nodes); ++n) {
      const Vec3 position = by_axis(errors_.position_drift, normals(n, Purpose::position_drift));
      const Vec3 attitude = by_axis(errors_.attitude_drift, normals(n, Purpose::attitude_drift));
      const Drift before = n == 0 ? Drift{position, attitude} : drift_.back();
      const double fresh = n == 0 ? 0 : added, old = n == 0 ? 1 : kept;
      drift_.push_back({old * before.position + fresh * position, old * before.attitude + fresh * attitude});
    }
  }

  /// Drift, and what is constant over the leg.
  Drift drift_at(Tick t) const noexcept {
    if (drift_.empty()) return offset_;
    const double at = t.seconds() / errors_.drift_time * nodes_per_drift_time;
    const std::size_t n = at > 0 ? std::min(static_cast<std::size_t>(at), drift_.size() - 2) : 0;
    const double share = at - static_cast<double>(n);
    const Drift &a = drift_[n], &b = drift_[n + 1];
    return {a.position + share * (b.position - a.position) + offset_.position,
            a.attitude + share * (b.attitude - a.attitude) + offset_.attitude};
  }

  static constexpr double nodes_per_drift_time = 50;  ///< between nodes, 1 % is off the variance

  Platform<Path, Source> truth_;
  PoseErrors errors_;
  std::vector<PoseError<frame::Body>> stated_ = in_body();
  std::uint32_t leg_ = 0;
  Pose<frame::Instrument, frame::Instrument> calibration_{};  // reported from true mount
  double latency_ = 0;                                        // of the clock of poses [s]
  Drift offset_{};                                            // constant over the leg
  std::vector<Drift> drift_;
};

}  // namespace PULSECAST_NAMESPACE

#endif
