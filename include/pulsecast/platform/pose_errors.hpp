// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_PLATFORM_POSE_ERRORS_HPP
#define PULSECAST_PLATFORM_POSE_ERRORS_HPP

#include <pulsecast/platform/platform.hpp>

namespace PULSECAST_NAMESPACE {

/// Errors of reported poses, zero by default: deviations along or about each axis of the body.
struct PoseErrors {
  double position_noise = 0;               ///< white noise of the position [m]
  double attitude_noise = 0;               ///< white noise of the attitude [rad]
  double position_drift = 0;               ///< slow drift of the position: a Gauss-Markov process [m]
  double attitude_drift = 0;               ///< slow drift of the attitude, of the same kind [rad]
  double drift_time = 60;                  ///< decay of drifts to 1/e; at least 1e-6 of the survey [s]
  double angular_jitter = 0;               ///< unreported deviation of each beam, right and up [rad]
  Vec3 lever_arm_error{};                  ///< reported minus true lever arm [m]
  Rotation boresight_error = no_rotation;  ///< from the true instrument to the reported one
  std::uint64_t seed = 0;                  ///< of all draws; each of several `Legs` draws its own

  void validate() const {
    require_not_negative("PoseErrors::position_noise", position_noise, "m");
    require_within("PoseErrors::attitude_noise", attitude_noise, 0, max_angle, "rad");
    require_not_negative("PoseErrors::position_drift", position_drift, "m");
    require_within("PoseErrors::attitude_drift", attitude_drift, 0, max_angle, "rad");
    require_positive("PoseErrors::drift_time", drift_time, "s");
    require_within("PoseErrors::angular_jitter", angular_jitter, 0, max_angle, "rad");
    require_finite("PoseErrors::lever_arm_error (length)", length(lever_arm_error), "m");
    require_rotation("PoseErrors::boresight_error", boresight_error);
  }
  void normalize() noexcept { boresight_error = unit(boresight_error); }
};

/// Platform with pose errors: rays start at the true pose, points are of the reported one.
template <Trajectory Path, InstrumentSource Source>
class WithPoseErrors {
 public:
  using refinements = refines<tag::MakesLanes, tag::DrawsByLeg>;
  /// @throws SettingError for settings out of range
  WithPoseErrors(Platform<Path, Source> truth, PoseErrors errors)
      : truth_(std::move(truth)), errors_(validated(errors)) {
    plan_drift();
  }

  void draw_for_leg(std::uint32_t leg) {
    if (leg == std::exchange(leg_, leg)) return;
    plan_drift();
  }

  [[nodiscard]] PulseIndex size() const noexcept { return truth_.size(); }
  [[nodiscard]] Tick duration() const noexcept { return truth_.duration(); }
  [[nodiscard]] std::vector<Emitter> emitters() const { return truth_.emitters(); }
  [[nodiscard]] const Platform<Path, Source>& truth() const noexcept { return truth_; }  ///< without errors

  [[nodiscard]] PulseIndex next_pulse(PulseIndex i) const noexcept requires SkipsBlocked<Source> {
    return truth_.next_pulse(i);
  }

  /// Reported pose of the body.
  [[nodiscard]] Pose<frame::Body, frame::World> reported(Tick t) const noexcept {
    const Pose<frame::Body, frame::World> world_from_body = truth_.trajectory().at(t);
    const Drift drift = drift_at(t);
    const Vec3 moved = white_noise(t, Purpose::position_noise, errors_.position_noise) + drift.position;
    const Vec3 turned = white_noise(t, Purpose::attitude_noise, errors_.attitude_noise) + drift.attitude;
    return world_from_body * Pose<frame::Body, frame::Body>{turned_by(turned), moved};
  }

  [[nodiscard]] std::optional<Pulse<frame::World>> pulse(PulseIndex i) const noexcept { return pulse_lanes(i, 1)[0]; }

  [[nodiscard]] PulseLanes<frame::World> pulse_lanes(PulseIndex i, std::size_t count) const noexcept {
    const auto inner = find_pulses(truth_.source(), i, count);
    auto out = truth_.placed(jittered(inner, i));
    const Pose<frame::Instrument, frame::Body> calibrated{truth_.mount().boresight * errors_.boresight_error,
                                                          truth_.mount().lever_arm + errors_.lever_arm_error};
    for (std::size_t lane = 0; lane < inner.size; ++lane) {
      if (inner.sent[lane] == 0) continue;
      const Tick t = inner.tick[lane];
      auto beam = inner.pose[lane];
      if constexpr (MeasuresBeam<Source>) beam = truth_.source().measured(i + lane, t).value_or(beam);
      out.report(lane, reported(t) * calibrated * beam);
    }
    return out;
  }

 private:
  struct Drift {
    Vec3 position{}, attitude{};
  };

  static Rotation turned_by(const Vec3& angles) noexcept {
    const double angle = length(angles);
    return angle > 0 ? rotation_about(angles, angle) : no_rotation;
  }

  double drawn(std::uint64_t moment, std::uint32_t number, Purpose purpose) const noexcept {
    return normal({errors_.seed, moment, number, purpose, leg_});
  }

  Vec3 normals(std::uint64_t moment, Purpose purpose, std::uint32_t second = 0) const noexcept {
    const std::uint32_t first = 3 * second;
    return {drawn(moment, first, purpose), drawn(moment, first + 1, purpose), drawn(moment, first + 2, purpose)};
  }

  /// White noise, common to emitters that fire together. No two ticks within 45 years share it.
  Vec3 white_noise(Tick t, Purpose purpose, double deviation) const noexcept {
    if (deviation == 0) return {};
    const auto part = std::bit_cast<std::uint64_t>(t.fraction);
    return deviation * normals(part, purpose, static_cast<std::uint32_t>(t.second));
  }

  PulseLanes<frame::Instrument> jittered(PulseLanes<frame::Instrument> p, PulseIndex i) const noexcept {
    if (errors_.angular_jitter == 0) return p;
    for (std::size_t lane = 0; lane < p.size; ++lane) {
      const double aside = errors_.angular_jitter * drawn(i + lane, 0, Purpose::angular_jitter);
      const double upwards = errors_.angular_jitter * drawn(i + lane, 1, Purpose::angular_jitter);
      const Rotation turned = p.pose.rotation[lane] * rotation_about(axis::up, -aside);
      p.pose.rotation.set(lane, turned * rotation_about(axis::right, upwards));
    }
    return p;
  }

  /// Drift at nodes: the last, decayed, plus a random part. Source: Gelb 1974, sec. 3.8.
  void plan_drift() {
    if (errors_.position_drift == 0 && errors_.attitude_drift == 0) return;
    const double kept = std::exp(-1.0 / nodes_per_drift_time), added = std::sqrt(1 - kept * kept);
    const double nodes = std::ceil(truth_.duration().seconds() / errors_.drift_time * nodes_per_drift_time) + 2;
    const double times = nodes / nodes_per_drift_time;
    require_within("PoseErrors::drift_time (survey duration divided by it)", times, 0, 1e6, "");
    drift_.clear();
    for (std::uint64_t n = 0; n < static_cast<std::uint64_t>(nodes); ++n) {
      const Vec3 position = errors_.position_drift * normals(n, Purpose::position_drift);
      const Vec3 attitude = errors_.attitude_drift * normals(n, Purpose::attitude_drift);
      const Drift before = n == 0 ? Drift{position, attitude} : drift_.back();
      const double fresh = n == 0 ? 0 : added, old = n == 0 ? 1 : kept;
      drift_.push_back({old * before.position + fresh * position, old * before.attitude + fresh * attitude});
    }
  }

  Drift drift_at(Tick t) const noexcept {
    if (drift_.empty()) return {};
    const double at = t.seconds() / errors_.drift_time * nodes_per_drift_time;
    const std::size_t n = at > 0 ? std::min(static_cast<std::size_t>(at), drift_.size() - 2) : 0;
    const double share = at - static_cast<double>(n);
    const Drift &a = drift_[n], &b = drift_[n + 1];
    return {a.position + share * (b.position - a.position), a.attitude + share * (b.attitude - a.attitude)};
  }

  static constexpr double nodes_per_drift_time = 50;  ///< between nodes, 1 % is off the variance

  Platform<Path, Source> truth_;
  PoseErrors errors_;
  std::uint32_t leg_ = 0;
  std::vector<Drift> drift_;
};

}  // namespace PULSECAST_NAMESPACE

#endif
