// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_SURVEY_OPTIC_HPP
#define PULSECAST_HELIOS_DETAIL_SURVEY_OPTIC_HPP

#include <variant>

#include <pulsecast/deflector/deflector.hpp>
#include <pulsecast/deflector/fiber_array.hpp>
#include <pulsecast/deflector/fixed_beam.hpp>
#include <pulsecast/deflector/oscillating_mirror.hpp>
#include <pulsecast/deflector/palmer_mirror.hpp>
#include <pulsecast/deflector/polygon_mirror.hpp>
#include <pulsecast/deflector/risley_prisms.hpp>
#include <pulsecast/deflector/rotating_head.hpp>
#include <pulsecast/helios/detail/formula.hpp>
#include <pulsecast/scanner/scanner.hpp>

/// Optics of survey documents, as one type.
namespace PULSECAST_NAMESPACE::helios {

/// Optic with a deflection angle, upward [rad].
template <class O>
concept TellsAngle = requires(const O optic, Tick t) {
  static_cast<double>(optic.angle(t));
};

/// Beam path of one channel: an optic of any kind, mounted in an instrument that a head turns. One
/// type, so that a program with scanners from files compiles one pipeline.
struct SurveyOptic {
  using AnyOptic = std::variant<FixedBeam, OscillatingMirror, PolygonMirror, PalmerMirror, FiberArray, RisleyPrisms>;

  AnyOptic optic{};
  Tick ahead{};                                          ///< lead of the optic's clock
  Pose<frame::Instrument, frame::Instrument> emitter{};  ///< channel, before the head turns it
  RotatingHead head{.angular_rate = 0};
  std::shared_ptr<const Formula> deflection_error{};  ///< of the deflection, by it [rad]
  std::shared_ptr<const Formula> head_error{};        ///< of the head, by the deflection [rad]
  std::shared_ptr<const Formula> range_error{};       ///< of the range, by the deflection [m]
  double head_zero_threshold = 0;                     ///< minimum distance of its argument from k pi [rad]

  void validate() const {
    std::visit([](const auto& o) { o.validate(); }, optic);
    RotatingHead{.angular_rate = head.angular_rate, .axis = head.axis}.validate();
    require_within("RotatingHead::start", head.start, -1e6, 1e6, "rad");  // some have many turns
  }

  [[nodiscard]] bool open(Tick t) const noexcept {
    PoseLanes<frame::Beam, frame::Instrument> beam;
    return exact(TickLanes(t), beam)[0] != 0;
  }

  [[nodiscard]] Tick next_open(Tick t) const noexcept {
    const Tick now = t + ahead;
    const Tick opens = std::visit(
        [&](const auto& o) noexcept {
          if constexpr (ForeseesOpening<decltype(o)>)
            return o.next_open(now);
          else
            return now;
        },
        optic);
    return t + Tick::of_seconds(static_cast<double>(opens.second - now.second) + (opens.fraction - now.fraction));
  }

  /// True pose of the beam, with the errors of deflection and head.
  [[nodiscard]] Pose<frame::Beam, frame::Instrument> at(Tick t) const noexcept { return pose_in_lanes(*this, t); }

  simd::Mask poses(const TickLanes& t, PoseLanes<frame::Beam, frame::Instrument>& poses) const noexcept {
    const simd::Mask open = exact(t, poses);
    if (deflection_error || head_error)
      for (std::size_t lane = 0; lane < simd::lane_count; ++lane)
        poses.set(lane, with_errors(poses[lane], deflection(t[lane])));
    return open;
  }

  /// Poses of the beam as the instrument measures them; returns the lanes where the optic is open.
  simd::Mask exact(const TickLanes& t, PoseLanes<frame::Beam, frame::Instrument>& poses) const noexcept {
    const auto find = [&](const auto& o) noexcept { return find_poses(o, t + ahead, all_lanes(), poses); };
    const simd::Mask open = std::visit(find, optic);
    poses = PoseLanes(emitter) * poses;
    if (head.angular_rate == 0 && head.start == 0) return open;
    PoseLanes<frame::Instrument, frame::Instrument> turned;
    head.poses(t, turned);
    poses = turned * poses;
    return open;
  }

  /// True pose of a beam of an upward deflection [rad].
  [[nodiscard]] Pose<frame::Beam, frame::Instrument> with_errors(Pose<frame::Beam, frame::Instrument> pose,
                                                                 double angle) const noexcept {
    if (deflection_error) pose.rotation = pose.rotation * aimed_above((*deflection_error)(angle)).rotation;
    if (!head_error) return pose;
    const double half_turns = std::round(angle / pi), off = angle - half_turns * pi;
    const double kept_off = half_turns * pi + std::copysign(std::max(std::fabs(off), head_zero_threshold), off);
    return Pose<frame::Instrument, frame::Instrument>{rotation_about(head.axis, (*head_error)(kept_off)), {}} * pose;
  }

  /// Upward deflection of the beam; 0 for optics without a deflection angle [rad].
  [[nodiscard]] double deflection(Tick t) const noexcept {
    return std::visit(
        [&](const auto& o) noexcept -> double {
          if constexpr (TellsAngle<decltype(o)>)
            return o.angle(t + ahead);
          else
            return 0;
        },
        optic);
  }

  [[nodiscard]] bool errs() const noexcept { return deflection_error || head_error || range_error; }

  /// Measured pose, shifted along the beam by the range error.
  [[nodiscard]] Pose<frame::Beam, frame::Instrument> reported(Tick t) const noexcept {
    PoseLanes<frame::Beam, frame::Instrument> poses;
    exact(TickLanes(t), poses);
    auto pose = poses[0];
    if (range_error) pose.position += (*range_error)(deflection(t)) * pose.direction(axis::forward);
    return pose;
  }
};

static_assert(Optic<SurveyOptic> && Gated<SurveyOptic> && ForeseesOpening<SurveyOptic>);

/// One channel in one leg.
using SurveyChannel = Deflector<SurveyOptic, Scanner>;

}  // namespace PULSECAST_NAMESPACE::helios

#endif
