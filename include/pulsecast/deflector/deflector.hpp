// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_DEFLECTOR_DEFLECTOR_HPP
#define PULSECAST_DEFLECTOR_DEFLECTOR_HPP

#include <pulsecast/pulse_lanes.hpp>
#include <pulsecast/stage_arguments.hpp>

namespace PULSECAST_NAMESPACE {

/// Deflects the pulses of a laser by a moving optic, or rotates a whole instrument by a head:
/// `Deflector{RotatingHead{...}, Deflector{PolygonMirror{...}, Scanner{...}}}`.
template <class Moving, class Source>
requires detail::Deflectable<Moving, Source>
class Deflector {
  // clang-format on
  static_assert(Gated<Moving> || !ForeseesOpening<Moving>,
                "Deflector: an optic with next_open(Tick) needs open(Tick), too");
  static constexpr bool foresees = ForeseesOpening<Moving> && FindsSlots<Source>;

 public:
  using refinements = refines<tag::MakesLanes>;
  static constexpr bool strides_lanes = detail::MakesStridedLanes<Source>;
  /// Throws a `SettingError` if the settings of `moving` or `source` are invalid.
  Deflector(Moving moving, Source source)
      : moving_(validated(std::move(moving))), source_(validated(std::move(source))) {}

  [[nodiscard]] PulseIndex size() const noexcept { return source_.size(); }
  [[nodiscard]] Tick duration() const noexcept { return source_.duration(); }
  [[nodiscard]] std::vector<Emitter> emitters() const { return source_.emitters(); }

  [[nodiscard]] std::optional<Pulse<frame::Instrument>> pulse(PulseIndex i) const noexcept {
    return pulse_lanes(i, 1)[0];
  }

  [[nodiscard]] PulseLanes<frame::Instrument> pulse_lanes(PulseIndex i, std::size_t count,
                                                          PulseIndex step = 1) const noexcept {
    const auto inner = find_pulses(source_, i, count, step);
    detail::PosesOf<Moving> poses;
    const simd::Mask open = find_poses(moving_, inner.tick, inner.sent, poses);
    PULSECAST_ASSERT(rigid_lanes(poses, open));
    PulseLanes<frame::Instrument> out(poses, inner);
    out.sent = open;
    return out;
  }

  [[nodiscard]] PulseIndex slot_from(Tick t) const noexcept requires FindsSlots<Source> { return source_.slot_from(t); }

  [[nodiscard]] PulseIndex next_pulse(PulseIndex i) const noexcept requires foresees || SkipsBlocked<Source> {
    if constexpr (SkipsBlocked<Source>) i = source_.next_pulse(i);
    if constexpr (foresees)
      if (const auto inner = i < size() ? source_.pulse(i) : std::nullopt)
        if (const Tick opens = moving_.next_open(inner->tick); opens > inner->tick)
          return std::max(i, source_.slot_from(opens));
    return i;
  }

  /// Measured beam, turned by the head.
  [[nodiscard]] std::optional<Pose<frame::Beam, frame::Instrument>> measured(
      PulseIndex i, Tick t) const noexcept requires MeasuresBeam<Source> {
    const auto inner = source_.measured(i, t);
    if (!inner) return std::nullopt;
    return moving_.at(t) * *inner;
  }

  /// Errors of the source, as the concept StatesErrors requires.
  template <class Visit>
  void visit_errors(PulseIndex i, Tick t, const Visit& visit) const noexcept requires StatesErrors<Source> {
    source_.visit_errors(i, t, [&, moved = moving_.at(t)](const auto& error) noexcept { visit(moved * error); });
  }

  [[nodiscard]] const Moving& moving() const noexcept { return moving_; }  ///< optic or head
  [[nodiscard]] const Source& source() const noexcept { return source_; }  ///< deflected source

 private:
  Moving moving_;
  Source source_;
};

/// Names the mistake in the arguments.
template <class Moving, class Source>
requires(!detail::Deflectable<Moving, Source>) Deflector(Moving, Source)
->Deflector<typename detail::DeflectorArguments<Moving, Source>::First, Source>;

}  // namespace PULSECAST_NAMESPACE

#endif
