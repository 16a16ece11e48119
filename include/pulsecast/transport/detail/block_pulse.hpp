// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_TRANSPORT_DETAIL_BLOCK_PULSE_HPP
#define PULSECAST_TRANSPORT_DETAIL_BLOCK_PULSE_HPP

#include <pulsecast/detector/radiometry.hpp>
#include <pulsecast/geometry/single_ray.hpp>
#include <pulsecast/reflection.hpp>

namespace PULSECAST_NAMESPACE::detail {

/// Pulse of one ray in a block of slots, and what returned.
struct BlockPulse {
  Outcome outcome{};          ///< without echoes so far
  Vec3 exit{};                ///< origin of the ray [m]
  Vec3 toward{};              ///< direction of the ray
  Reflection reflection{};    ///< light that returned, if any
  WhiteTarget white{};        ///< at its range
  std::uint16_t emitter = 0;  ///< number of its emitter
  bool reflects = false;      ///< true if light returned

  [[nodiscard]] bool blocked() const noexcept { return outcome.shot.fate == Fate::blocked; }
  /// Ray of a survey of this seed.
  [[nodiscard]] SingleRayPacket ray(std::uint64_t seed) const noexcept {
    SingleRayPacket ray;
    ray.origin = exit;
    ray.toward = toward;
    ray.tick = outcome.shot.tick;
    ray.seed = seed;
    ray.pulse = outcome.shot.index;
    return ray;
  }
};

/// Pulses in lanes, as reported and as traced.
class ReportedLanes {
 public:
  explicit ReportedLanes(const PulseLanes<frame::World>& pulses) noexcept : pulses_(pulses) {
    const RotationLanes& r = pulses.pose.rotation;
    const Vec3Lanes& exit = pulses.pose.position;
    direction_ = r * Vec3Lanes(axis::forward);
    // the ray's is that of a bundle, by a column of the matrix
    toward_ = {2.0 * (r.x * r.y - r.w * r.z), 1.0 - 2.0 * (r.x * r.x + r.z * r.z), 2.0 * (r.y * r.z + r.w * r.x)};
    sum_ = exit.x + exit.y + exit.z + r.w + r.x + r.y + r.z;  // keeps NaN and infinity
  }

  /// Sets the pulse of a lane, of slot `index`, without what depends on its emitter.
  [[gnu::always_inline]] void get(std::size_t lane, PulseIndex index, BlockPulse& p) const noexcept {
    Shot& shot = p.outcome.shot;
    p.reflects = false;
    p.outcome.echoes = {};
    p.outcome.waveform = {};
    p.outcome.energy = {};
    p.outcome.error = PulseError::none;
    shot.index = index;
    shot.waveform_start = 0;
    shot.fate = pulses_.sent[lane] == 0 ? Fate::blocked : Fate::missed;
    if (p.blocked()) return;
    p.emitter = pulses_.emitter[lane];
    p.exit = shot.origin = pulses_.pose.position[lane];
    p.toward = toward_[lane];
    shot.tick = pulses_.tick[lane];
    shot.direction = direction_[lane];
    shot.scan_angle = pulses_.scan_angle[lane];
    shot.leg = pulses_.leg[lane];
    bool finite = std::isfinite(sum_[lane]);
    if (pulses_.reports[lane] != 0) {
      const Pose<frame::Beam, frame::World> reported = pulses_.reported[lane];
      shot.origin = reported.position;
      shot.direction = reported.direction(axis::forward);
      finite &= reported.finite();
    }
    if (!finite) p.outcome.error = PulseError::pose;
  }

 private:
  const PulseLanes<frame::World>& pulses_;
  Vec3Lanes direction_, toward_;
  simd::Doubles sum_;
};

}  // namespace PULSECAST_NAMESPACE::detail

#endif
