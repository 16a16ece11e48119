// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SCANNER_ANY_SOURCE_HPP
#define PULSECAST_SCANNER_ANY_SOURCE_HPP

#include <variant>

#include <pulsecast/pulse_lanes.hpp>

namespace PULSECAST_NAMESPACE {

/// Pulse source of one of several types, for platforms of different kinds, or emitters with
/// different optics: `Channels{std::vector<AnySource<Deflector<PolygonMirror, Scanner>,
/// Deflector<FixedBeam, Scanner>>>{...}}`.
template <class First, class... Others>
class AnySource {
 public:
  using refinements = refines<tag::MakesLanes>;
  static constexpr bool strides_lanes = detail::MakesStridedLanes<First> && (detail::MakesStridedLanes<Others> && ...);
  /// Takes a source of one of the types.
  template <class Source>
  requires std::constructible_from<std::variant<First, Others...>, Source> AnySource(Source source)
      : source_(validated(std::move(source))) {}  // NOLINT(google-explicit-constructor)

  [[nodiscard]] PulseIndex size() const noexcept {
    return std::visit([](const auto& s) noexcept { return s.size(); }, source_);
  }
  [[nodiscard]] Tick duration() const noexcept {
    return std::visit([](const auto& s) noexcept { return s.duration(); }, source_);
  }
  [[nodiscard]] std::vector<Emitter> emitters() const {
    return std::visit([](const auto& s) { return s.emitters(); }, source_);
  }
  [[nodiscard]] auto pulse(PulseIndex i) const noexcept -> decltype(std::declval<const First&>().pulse(i)) {
    return std::visit([i](const auto& s) noexcept { return s.pulse(i); }, source_);
  }
  [[nodiscard]] auto pulse_lanes(PulseIndex i, std::size_t count, PulseIndex step = 1) const noexcept {
    return std::visit([=](const auto& s) noexcept { return find_pulses(s, i, count, step); }, source_);
  }
  [[nodiscard]] PulseIndex slot_from(Tick t) const noexcept requires FindsSlots<First> &&(FindsSlots<Others>&&...) {
    return std::visit([t](const auto& s) noexcept { return s.slot_from(t); }, source_);
  }
  [[nodiscard]] PulseIndex next_pulse(PulseIndex i) const noexcept requires SkipsBlocked<First> ||
      (SkipsBlocked<Others> || ...) {
    const auto skip = [i]<class Source>(const Source& s) noexcept -> PulseIndex {
      if constexpr (SkipsBlocked<Source>) return s.next_pulse(i);
      return i;
    };
    return std::visit(skip, source_);
  }
  [[nodiscard]] std::optional<Pose<frame::Beam, frame::Instrument>> measured(
      PulseIndex i, Tick t) const noexcept requires MeasuresBeam<First> ||(MeasuresBeam<Others> || ...) {
    const auto beam =
        [&]<class Source>(const Source& s) noexcept -> std::optional<Pose<frame::Beam, frame::Instrument>> {
      if constexpr (MeasuresBeam<Source>) return s.measured(i, t);
      return std::nullopt;
    };
    return std::visit(beam, source_);
  }
  template <class Visit>
  void visit_errors(PulseIndex i, Tick t, const Visit& visit) const noexcept requires StatesErrors<First> ||
      (StatesErrors<Others> || ...) {
    const auto state = [&]<class Source>(const Source& s) noexcept {
      if constexpr (StatesErrors<Source>) s.visit_errors(i, t, visit);
    };
    std::visit(state, source_);
  }
  void draw_for_leg(std::uint32_t leg) requires DrawsByLeg<First> ||(DrawsByLeg<Others> || ...) {
    const auto tell = [leg]<class Source>(Source& s) {
      if constexpr (DrawsByLeg<Source>) s.draw_for_leg(leg);
    };
    std::visit(tell, source_);
  }

 private:
  std::variant<First, Others...> source_;
};

}  // namespace PULSECAST_NAMESPACE

#endif
