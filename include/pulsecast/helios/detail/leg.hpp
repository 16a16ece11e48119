// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_LEG_HPP
#define PULSECAST_HELIOS_DETAIL_LEG_HPP

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include <pulsecast/base/random.hpp>
#include <pulsecast/concepts.hpp>
#include <pulsecast/helios/detail/optics.hpp>
#include <pulsecast/helios/settings.hpp>
#include <pulsecast/platform/ground_vehicle.hpp>
#include <pulsecast/platform/multicopter.hpp>
#include <pulsecast/platform/platform.hpp>
#include <pulsecast/platform/straight_line.hpp>
#include <pulsecast/platform/tripod.hpp>
#include <pulsecast/platform/waypoints.hpp>

/// Pulses of one leg of a survey, for any platform and scanner.
namespace pulsecast::helios {

/// Path of any platform from a start time on. Legs of one plan share it.
struct SurveyPath {
  using AnyPath = std::variant<Tripod, StraightLine, std::shared_ptr<const Waypoints>, std::shared_ptr<const MulticopterFlight>,
                               std::shared_ptr<const GroundVehicleDrive>>;
  AnyPath path{};
  Tick start{};  ///< start time on the clock of the plan

  [[nodiscard]] Pose<frame::Body, frame::World> at(Tick t) const noexcept {
    return std::visit(
        [&](const auto& p) noexcept {
          if constexpr (requires { p->at(t); })
            return p->at(start + t);
          else
            return p.at(start + t);
        },
        path);
  }
};

static_assert(Trajectory<SurveyPath>);

/// Noise of a platform's pose: reported pose minus true pose.
struct SurveyNoise {
  std::array<std::optional<NoiseSettings>, 3> position{};  ///< along x, y and z of the world [m]
  std::array<std::optional<NoiseSettings>, 3> attitude{};  ///< about right, forward and up of the beam [rad]
  std::uint64_t seed = 0;

  [[nodiscard]] bool none() const noexcept {
    return std::none_of(position.begin(), position.end(), [](const auto& n) { return n.has_value(); }) &&
           std::none_of(attitude.begin(), attitude.end(), [](const auto& n) { return n.has_value(); });
  }

  [[nodiscard]] Vec3 draw(const std::array<std::optional<NoiseSettings>, 3>& noise, PulseIndex slot, Purpose purpose) const noexcept {
    Vec3 out{};
    for (int k = 0; k < 3; ++k) {
      const std::optional<NoiseSettings>& n = noise[static_cast<std::size_t>(k)];
      if (!n) continue;
      const PulseIndex moment = n->lifespan > 0 ? slot / static_cast<PulseIndex>(n->lifespan) : 0;
      const RandomKey key{.seed = seed, .pulse = moment, .subray = static_cast<std::uint32_t>(k), .purpose = purpose};
      double value =
          n->distribution == NoiseDistribution::normal ? n->mean + n->deviation * normal(key) : n->low + (n->high - n->low) * uniform(key);
      if (n->clipped) value = std::clamp(value, n->clip_low, std::max(n->clip_low, n->clip_high));
      out[k] = value;
    }
    return out;
  }
};

/// One leg of a survey: channels that fire together, on one platform.
class SurveyLeg {
 public:
  SurveyLeg(SurveyPath path, Mount mount, std::vector<SurveyChannel> channels, Tick duration, SurveyNoise noise)
      : path_(std::move(path)), mount_(validated(mount)), channels_(std::move(channels)), duration_(duration), noise_(std::move(noise)) {
    require_within("SurveyLeg::channels (number)", static_cast<double>(channels_.size()), 1, 256, "");
    noisy_ = !noise_.none();
  }

  [[nodiscard]] PulseIndex size() const noexcept { return channels_.size() * channels_.front().size(); }
  [[nodiscard]] Tick duration() const noexcept { return duration_; }

  [[nodiscard]] std::optional<Pulse<frame::World>> pulse(PulseIndex i) const noexcept {
    const std::size_t k = i % channels_.size();
    const auto inner = channels_[k].pulse(i / channels_.size());
    if (!inner) return std::nullopt;
    const Pose<frame::Instrument, frame::World> instrument = path_.at(inner->tick) * mount_.pose();
    std::optional<Pulse<frame::World>> out(std::in_place, instrument, *inner);
    out->index = i;
    out->channel = static_cast<std::uint8_t>(k);
    const Vec3 on_body = mount_.boresight * inner->direction();
    out->scan_angle = std::atan2(on_body.x, -on_body.z);
    const SurveyOptic& optic = channels_[k].moving();
    if (optic.errs()) out->reported = instrument * optic.reported(inner->tick);
    if (noisy_) {
      const PulseIndex slot = i / channels_.size();
      const Vec3 turn = noise_.draw(noise_.attitude, slot, Purpose::attitude_noise);
      if (!out->reported) out->reported = out->pose;
      out->reported->position += noise_.draw(noise_.position, slot, Purpose::position_noise);
      out->reported->rotation = out->reported->rotation * rotation_about(axis::right, turn.x) * rotation_about(axis::forward, turn.y) *
                                rotation_about(axis::up, turn.z);
    }
    return out;
  }

  [[nodiscard]] const SurveyPath& path() const noexcept { return path_; }
  [[nodiscard]] const std::vector<SurveyChannel>& channels() const noexcept { return channels_; }

 private:
  SurveyPath path_;
  Mount mount_;
  std::vector<SurveyChannel> channels_;
  Tick duration_;
  SurveyNoise noise_;
  bool noisy_ = false;
};

static_assert(WorldSource<SurveyLeg>);

}  // namespace pulsecast::helios

#endif
