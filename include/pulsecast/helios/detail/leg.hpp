// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_LEG_HPP
#define PULSECAST_HELIOS_DETAIL_LEG_HPP

#include <map>

#include <pulsecast/helios/instrument.hpp>
#include <pulsecast/io/trajectory.hpp>
#include <pulsecast/platform/ground_vehicle.hpp>
#include <pulsecast/platform/multicopter.hpp>
#include <pulsecast/platform/pose_errors.hpp>
#include <pulsecast/platform/straight_line.hpp>
#include <pulsecast/platform/tripod.hpp>

namespace PULSECAST_NAMESPACE::helios {

/// Options for compiling a survey to pulses.
struct SurveyBuildOptions {
  std::uint64_t seed = 0;      ///< seed of leg offsets and noise
  bool platform_noise = true;  ///< true: platform noise as in the survey; false: none
  bool leg_noise = true;       ///< true: random leg offsets as in the survey; false: none
  /// Place of each leg in its document, as in `survey.xml:12:5`. If empty, as for settings of a
  /// program, the notes of `read_survey` are given with the others.
  std::vector<std::string> leg_places{};
  io::MapProjector projector{};                                  ///< of trajectories by longitude and latitude
  std::map<std::string, std::vector<TimedPose>> trajectories{};  ///< as `Simulation::Settings::trajectories`

  /// Name of a leg for messages.
  [[nodiscard]] std::string leg_name(std::size_t k) const {
    return (k < leg_places.size() ? leg_places[k] + ": leg " : "leg ") + std::to_string(k);
  }
};

/// Height of any `Ground` [m]; of a `LevelledGround`, the level nearest to a height.
class GroundHeight {
 public:
  template <Ground G>
  requires(!std::same_as<G, GroundHeight>) GroundHeight(G ground)
      : height_([ground = std::move(ground)](const Vec2& at, [[maybe_unused]] double near) -> std::optional<double> {
          if constexpr (LevelledGround<G>)
            return ground(at, near);
          else
            return ground(at);
        }) {}

  [[nodiscard]] std::optional<double> operator()(const Vec2& at,
                                                 double near = std::numeric_limits<double>::infinity()) const {
    return height_(at, near);
  }

 private:
  std::function<std::optional<double>(const Vec2&, double)> height_;
};

static_assert(LevelledGround<GroundHeight>);

/// Path, own or shared.
template <class Path>
[[nodiscard]] const Path& path_of(const Path& path) noexcept {
  return path;
}
template <class Path>
[[nodiscard]] const Path& path_of(const std::shared_ptr<const Path>& path) noexcept {
  return *path;
}
/// Path of any platform from a start time on. Legs of one plan share it.
struct SurveyPath {
  using AnyPath = std::variant<Tripod, StraightLine, std::shared_ptr<const Waypoints>,
                               std::shared_ptr<const MulticopterFlight>, std::shared_ptr<const GroundVehicleDrive>>;
  AnyPath path{};
  Tick start{};  ///< start time on the clock of the plan

  [[nodiscard]] Pose<frame::Body, frame::World> at(Tick t) const noexcept {
    return std::visit([&](const auto& p) noexcept { return path_of(p).at(start + t); }, path);
  }

  simd::Mask poses(const TickLanes& t, PoseLanes<frame::Body, frame::World>& poses) const noexcept {
    const auto find = [&](const auto& p) noexcept { return find_poses(path_of(p), t + start, all_lanes(), poses); };
    return std::visit(find, path);
  }
};

static_assert(Trajectory<SurveyPath>);

/// Errors of a platform's pose: reported pose minus true pose.
struct SurveyNoise {
  using AxisNoise = std::array<std::optional<NoiseSettings>, 3>;
  AxisNoise position{};  ///< along x, y and z of the world [m]
  AxisNoise attitude{};  ///< about right, forward and up of the beam [rad]
  MountErrorSettings mount{};
  std::uint64_t seed = 0;
  PoseErrorSettings errors{};
  std::uint64_t survey_seed = 0;  ///< of the errors; those of calibration are the same in all legs
  std::uint32_t leg = 0;          ///< number of the leg

  [[nodiscard]] bool none() const {
    return position == AxisNoise{} && attitude == AxisNoise{} && mount == MountErrorSettings{};
  }

  [[nodiscard]] PoseErrors pose_errors() const {
    const auto axes = [](const Vec3& v) { return AxisDeviations(v.x, v.y, v.z); };
    return {.position_drift = axes(errors.position_drift),
            .attitude_drift = axes(errors.attitude_drift),
            .drift_time = errors.drift_time,
            .angular_jitter = errors.angular_jitter,
            .seed = survey_seed,
            .lever_arm_deviation = axes(errors.lever_arm_deviation),
            .boresight_deviation = axes(errors.boresight_deviation),
            .latency_deviation = errors.latency_deviation};
  }

  [[nodiscard]] Vec3 draw(const AxisNoise& noise, PulseIndex slot, Purpose purpose) const noexcept {
    Vec3 out{};
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::optional<NoiseSettings>& n = noise[k];
      if (!n) continue;
      const PulseIndex moment = n->lifespan > 0 ? slot / static_cast<PulseIndex>(n->lifespan) : 0;
      const RandomKey key{.seed = seed, .pulse = moment, .subray = k, .purpose = purpose};
      out[static_cast<int>(k)] = value(*n, uniform(key));
    }
    return out;
  }

  /// Value of a noise for a uniform draw.
  [[nodiscard]] static double value(const NoiseSettings& n, double draw) noexcept {
    const bool is_normal = n.distribution == NoiseDistribution::normal;
    const double value = is_normal ? n.mean + n.deviation * normal_quantile(draw) : n.low + (n.high - n.low) * draw;
    return n.clipped ? std::clamp(value, n.clip_low, std::max(n.clip_low, n.clip_high)) : value;
  }

  /// Error of one axis, as it is stated.
  struct Stated {
    Vec3 error;  ///< standard deviation along the axis [m or rad]
    ErrorScope scope;
  };
  /// Errors of a noise: its standard deviation and its mean, from 1,000 quantiles.
  [[nodiscard]] static std::vector<Stated> stated(const AxisNoise& noise) {
    constexpr int count = 1000;
    std::vector<Stated> all;
    for (int axis = 0; axis < 3; ++axis) {
      const std::optional<NoiseSettings>& n = noise[static_cast<std::size_t>(axis)];
      double mean = 0, squares = 0;
      for (int k = 0; n && k < count; ++k) {
        const double draw = value(*n, (k + 0.5) / count);
        mean += draw / count;
        squares += draw * draw / count;
      }
      const auto add = [&](double size, ErrorScope scope) {
        if (size == 0) return;
        all.push_back({Vec3{}, scope});
        all.back().error[axis] = size;
      };
      if (!n) continue;
      add(mean, ErrorScope::survey);
      add(std::sqrt(std::max(0.0, squares - mean * mean)), n->lifespan == 1  ? ErrorScope::pulse
                                                           : n->lifespan > 1 ? ErrorScope::correlated
                                                                             : ErrorScope::leg);
    }
    return all;
  }
};

/// One leg of a survey: an instrument on a platform, whose reported poses may have noise.
class SurveyLeg {
 public:
  /// `known` is the end of the known path, if that is within the last slot.
  SurveyLeg(SurveyPath path, const Mount& mount, Instrument instrument, SurveyNoise noise,
            std::optional<Tick> known = {})
      : truth_(std::move(path), mount, std::move(instrument)),
        noise_(std::move(noise)),
        mount_error_(error_of(noise_.mount, mount)),
        positions_(SurveyNoise::stated(noise_.position)),
        attitudes_(SurveyNoise::stated(noise_.attitude)),
        noisy_(!noise_.none()),
        known_(std::min(known.value_or(truth_.duration()), truth_.duration())) {
    if (noise_.errors == PoseErrorSettings{}) return;
    erring_.emplace(truth_, noise_.pose_errors());
    erring_->draw_for_leg(noise_.leg);
  }

  [[nodiscard]] PulseIndex size() const noexcept { return truth_.size(); }
  [[nodiscard]] Tick duration() const noexcept { return truth_.duration(); }
  [[nodiscard]] std::vector<Emitter> emitters() const { return truth_.emitters(); }

  [[nodiscard]] std::optional<Pulse<frame::World>> pulse(PulseIndex i) const noexcept { return pulse_lanes(i, 1)[0]; }

  [[nodiscard]] PulseLanes<frame::World> pulse_lanes(PulseIndex i, std::size_t count) const noexcept {
    auto out = erring_ ? erring_->pulse_lanes(i, count) : truth_.pulse_lanes(i, count);
    for (std::size_t lane = 0; noisy_ && lane < out.size; ++lane) {
      if (out.sent[lane] == 0) continue;
      const PulseIndex slot = (i + lane) / truth_.source().channels();
      const Vec3 turn = noise_.draw(noise_.attitude, slot, Purpose::attitude_noise);
      auto reported = out.reports[lane] != 0 ? out.reported[lane] : out.pose[lane];
      if (mount_error_) {
        const auto body = path().at(out.tick[lane]);
        reported = body * *mount_error_ * body.inverse() * reported;
      }
      reported.position += noise_.draw(noise_.position, slot, Purpose::position_noise);
      reported.rotation = reported.rotation * rotation_about(axis::right, turn.x) *
                          rotation_about(axis::forward, turn.y) * rotation_about(axis::up, turn.z);
      out.report(lane, reported);
    }
    return out;
  }

  [[nodiscard]] PulseIndex slot_from(Tick t) const noexcept { return truth_.slot_from(t); }
  [[nodiscard]] PulseIndex next_pulse(PulseIndex i) const noexcept { return truth_.next_pulse(i); }

  template <class Visit>
  void visit_errors(PulseIndex i, Tick t, const Visit& visit) const noexcept {
    erring_ ? erring_->visit_errors(i, t, visit) : truth_.visit_errors(i, t, visit);
    for (const auto& [error, scope] : positions_) visit(PoseError<frame::World>{.moved = error, .scope = scope});
    if (mount_error_) {
      const auto body = path().at(t);
      visit(error_between(body, body * *mount_error_));
    }
    if (attitudes_.empty()) return;
    if (const auto p = truth_.pulse(i))
      for (const auto& [error, scope] : attitudes_)
        visit(PoseError<frame::World>{.turned = p->pose.direction(error), .scope = scope});
  }

  [[nodiscard]] const SurveyPath& path() const noexcept { return truth_.trajectory(); }
  /// Pose of the scanner, without its head and the noise.
  [[nodiscard]] Pose<frame::Instrument, frame::World> instrument_at(Tick t) const noexcept {
    return truth_.instrument_at(t);
  }
  [[nodiscard]] Tick recorded() const noexcept { return known_; }  ///< duration of the known path

 private:
  using InBody = Pose<frame::Body, frame::Body>;

  /// Pose that turns the true mount to the reported one; none without an error.
  [[nodiscard]] static std::optional<InBody> error_of(const MountErrorSettings& error, const Mount& mount) {
    if (error == MountErrorSettings{}) return std::nullopt;
    const Rotation turn =
        io::rotation_of({.roll = error.roll, .pitch = error.pitch, .yaw = error.heading}, io::heading_pitch_roll);
    return InBody{turn, mount.lever_arm + error.position - turn * mount.lever_arm};
  }

  Platform<SurveyPath, Instrument> truth_;
  std::optional<WithPoseErrors<SurveyPath, Instrument>> erring_{};  // if there are such errors
  SurveyNoise noise_;
  std::optional<InBody> mount_error_;
  std::vector<SurveyNoise::Stated> positions_, attitudes_;
  bool noisy_;
  Tick known_;
};

static_assert(WorldSource<SurveyLeg> && SkipsBlocked<SurveyLeg>);

}  // namespace PULSECAST_NAMESPACE::helios

#endif
