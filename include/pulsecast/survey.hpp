// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SURVEY_HPP
#define PULSECAST_SURVEY_HPP

#include <pulsecast/pulse_lanes.hpp>
#include <pulsecast/stage_arguments.hpp>
#include <pulsecast/transport/echo_simulator.hpp>

namespace PULSECAST_NAMESPACE {

/// Simulation as a pure function from a pulse index to echoes. Immutable, so that pulses may be requested in any order
/// and from any number of threads. Refers to the map, which must outlive it.
template <WorldSource Source, Footprint Footprint, Target Target, Detector Detector,
          Transport<Target> Transport = DirectLight>
class Survey : public EchoSimulator<Footprint, Target, Detector, Transport> {
  using Echoes = EchoSimulator<Footprint, Target, Detector, Transport>;

 public:
  using typename Echoes::Workspace;

  /// Survey with one receiver for all emitters.
  /// @throws SettingError for settings out of range, footprint shares that do not sum to one, or a laser that the
  /// detector refuses
  Survey(Source source, Footprint footprint, const Target& target, Receiver receiver, Detector detector,
         std::uint64_t seed = 0)
      : Survey(std::move(source), std::move(footprint), target, Transport{}, std::move(receiver), std::move(detector),
               seed) {}
  /// As above, with a transport other than `DirectLight`.
  Survey(Source source, Footprint footprint, const Target& target, Transport transport, Receiver receiver,
         Detector detector, std::uint64_t seed = 0)
      : Survey(std::move(source), {{std::move(footprint), std::move(receiver), std::move(detector)}}, target,
               std::move(transport), seed) {}

  /// Survey with a receiver for each group of emitters. Sample intervals must be equal, and numbers of subrays if they
  /// are recorded.
  /// @throws SettingError as above, or for an emitter without a receiver
  Survey(Source source, std::vector<ReceiverUnit<Footprint, Detector>> receivers, const Target& target,
         std::uint64_t seed = 0)
      : Survey(std::move(source), std::move(receivers), target, Transport{}, seed) {}
  /// As above, with a transport other than `DirectLight`.
  Survey(Source source, std::vector<ReceiverUnit<Footprint, Detector>> receivers, const Target& target,
         Transport transport, std::uint64_t seed = 0);

  // a temporary map would dangle
  Survey(Source, Footprint, const Target&&, Receiver, Detector, std::uint64_t = 0) = delete;
  Survey(Source, Footprint, const Target&&, Transport, Receiver, Detector, std::uint64_t = 0) = delete;
  Survey(Source, std::vector<ReceiverUnit<Footprint, Detector>>, const Target&&, std::uint64_t = 0) = delete;
  Survey(Source, std::vector<ReceiverUnit<Footprint, Detector>>, const Target&&, Transport, std::uint64_t = 0) = delete;

  [[nodiscard]] PulseIndex size() const noexcept { return source_.size(); }
  /// Source of the pulses.
  [[nodiscard]] const Source& source() const noexcept { return source_; }
  /// As the concept FindsSlots requires: a loop simulates the slots from one time up to another.
  [[nodiscard]] PulseIndex slot_from(Tick t) const noexcept requires FindsSlots<Source> { return source_.slot_from(t); }
  /// As the concept SkipsBlocked requires.
  [[nodiscard]] PulseIndex next_pulse(PulseIndex i) const noexcept requires SkipsBlocked<Source> {
    return source_.next_pulse(i);
  }

  /// Simulates pulse i.
  [[nodiscard]] Outcome operator()(PulseIndex i, Workspace& w) const noexcept {
    if constexpr (Echoes::in_blocks) {
      make_block(i, 1, w);
      return Echoes::result_of(0, w);
    } else {
      return Echoes::operator()(i, source_.pulse(i), w);
    }
  }

  /// As the concept SimulatesInOrder requires: pulses are made by the register, which does not outlive the call.
  template <class Next>
  void simulate_in_order(PulseIndex i, PulseIndex end, Workspace& w, const Next& next) const {
    if constexpr (Echoes::in_blocks) {
      std::size_t slots = 0;
      for (PulseIndex first = i; i < end; i = next(Echoes::result_of(i - first, w)))
        if (i - first >= slots) {
          first = i;
          slots = std::min<PulseIndex>(end - i, Echoes::block_size());
          make_block(first, slots, w);
        }
    } else {
      PulseLanes<frame::World> pulses;
      for (PulseIndex first = i; i < end; i = next(Echoes::operator()(i, pulses[i - first], w)))
        if (i - first >= pulses.size) {
          first = i;
          pulses = find_pulses(source_, i, lanes_for(end - i));
        }
    }
  }

 private:
  static std::size_t lanes_for(PulseIndex slots) noexcept { return std::min<PulseIndex>(slots, simd::lane_count); }

  /// Makes and traces the pulses of slots. Those of one emitter share registers, if the source makes them so. One copy
  /// of the code, for single calls and runs, as compilers may contract products and sums in different ways.
  [[gnu::noinline]] void make_block(PulseIndex first, std::size_t slots, Workspace& w) const noexcept {
    const std::size_t step = detail::MakesStridedLanes<Source> ? Echoes::emitter_count() : 1;
    for (std::size_t start = 0; start < std::min(step, slots); ++start)
      for (std::size_t slot = start; slot < slots;) {
        const auto pulses = find_pulses(source_, first + slot, lanes_for((slots - slot + step - 1) / step), step);
        Echoes::enter(pulses, first, slot, step, w);
        slot += pulses.size * step;
      }
    Echoes::trace_block(slots, w);
  }

  static std::vector<Emitter> emitters_of(Source& source) {
    detail::validate_in_place(source);
    std::vector<Emitter> emitters = source.emitters();
    require_within("PulseSource::emitters (number)", static_cast<double>(emitters.size()), source.size() > 0 ? 1 : 0,
                   max_emitters, "");
    return emitters;
  }

  Source source_;
};

template <WorldSource Source, Footprint Footprint, Target Target, Detector Detector, Transport<Target> Transport>
Survey<Source, Footprint, Target, Detector, Transport>::Survey(Source source,
                                                               std::vector<ReceiverUnit<Footprint, Detector>> receivers,
                                                               const Target& target, Transport transport,
                                                               std::uint64_t seed)
    : Echoes(std::move(receivers), target, std::move(transport), emitters_of(source), seed),
      source_(std::move(source)) {}

/// Names the mistake in the arguments.
template <class Source, class AnyFootprint, class AnyTarget, class AnyDetector>
requires(!detail::Surveyable<Source, AnyFootprint, AnyTarget, AnyDetector>)
    Survey(Source, AnyFootprint, AnyTarget&&, Receiver, AnyDetector, std::uint64_t = 0)
->Survey<typename detail::SurveyArguments<Source, AnyFootprint, AnyTarget, AnyDetector>::First, AnyFootprint, AnyTarget,
         AnyDetector>;
/// As above.
template <class Source, class AnyFootprint, class AnyTarget, class AnyTransport, class AnyDetector>
requires(!detail::Surveyable<Source, AnyFootprint, AnyTarget, AnyDetector> ||
         !Transport<AnyTransport, std::remove_cvref_t<AnyTarget>>)
    Survey(Source, AnyFootprint, AnyTarget&&, AnyTransport, Receiver, AnyDetector, std::uint64_t = 0)
->Survey<typename detail::TransportArguments<Source, AnyFootprint, AnyTarget, AnyTransport, AnyDetector>::First,
         AnyFootprint, std::remove_cvref_t<AnyTarget>, AnyDetector, AnyTransport>;
/// As above.
template <class Source, class AnyFootprint, class AnyTarget, class AnyDetector>
requires(detail::Temporary<AnyTarget>)
    Survey(Source, std::vector<ReceiverUnit<AnyFootprint, AnyDetector>>, AnyTarget&&, std::uint64_t = 0)
->Survey<typename detail::SurveyArguments<Source, AnyFootprint, AnyTarget, AnyDetector>::First, AnyFootprint, AnyTarget,
         AnyDetector>;

}  // namespace PULSECAST_NAMESPACE

#endif
