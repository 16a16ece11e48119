// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_TRANSPORT_ECHO_SIMULATOR_HPP
#define PULSECAST_TRANSPORT_ECHO_SIMULATOR_HPP

#include <pulsecast/scanner/footprint.hpp>
#include <pulsecast/transport/detail/block_pulse.hpp>
#include <pulsecast/transport/detail/judged_surface.hpp>
#include <pulsecast/transport/direct_light.hpp>

namespace PULSECAST_NAMESPACE {

/// Receiving half of a device, for the emitters with its index as their `Emitter::receiver`.
template <Footprint Footprint, Detector Detector>
struct ReceiverUnit {
  Footprint footprint;  ///< sampling of the beams
  Receiver receiver;    ///< aperture, range gate and range errors
  Detector detector;    ///< detector
};

/// Echoes of pulses as a pure function: what light, receivers and detectors make of each. A
/// `Survey` is this after a source of pulses. Immutable. Refers to the map, which must outlive it.
template <Footprint Footprint, Target Target, Detector Detector, Transport<Target> Transport = DirectLight>
class EchoSimulator {
  static_assert(detail::members_checked<Footprint, tag::RecordsSubrays, tag::RotatesPerPulse, tag::JudgesSurfaces> &&
                detail::detector_checked<Detector>);
  static_assert(!ReadsVelocity<Detector> || TracesVelocity<Transport, Target>,
                "Survey: the detector reads velocities, which this transport does not set; give it trace<true>, as "
                "DirectLight has");

 public:
  /// For pulses of `emitters`, by number, with receivers. @throws SettingError for settings out of
  /// range, an emitter without a receiver, or a refused laser
  EchoSimulator(std::vector<ReceiverUnit<Footprint, Detector>> receivers, const Target& target, Transport transport,
                const std::vector<Emitter>& emitters, std::uint64_t seed = 0);
  // a temporary map would dangle
  EchoSimulator(std::vector<ReceiverUnit<Footprint, Detector>>, const Target&&, Transport, const std::vector<Emitter>&,
                std::uint64_t = 0) = delete;

  struct Workspace {
    decltype(std::declval<const Transport&>().workspace(0)) transport;              ///< of the transport
    SharedBuffer<Reflection> reflections;                                           ///< of a pulse
    std::vector<SubrayRecord> subrays;                                              ///< of a pulse, if recorded
    std::vector<decltype(std::declval<const Detector&>().workspace(0))> detectors;  ///< by receiver
    std::uint16_t emitter = 0;                                                      ///< of the last pulse
    WhiteTarget white_target{};                                                     ///< of that emitter
    std::vector<detail::BlockPulse> block{};                                        ///< pulses of a block of slots
    detail::RaySheaf rays{};                                                        ///< rays of some of them
  };

  [[nodiscard]] Workspace workspace() const;

  /// Subrays of a pulse: the mean over the emitters, if their receivers differ.
  [[nodiscard]] std::size_t subrays() const noexcept {
    if (receivers_.size() == 1 || emitters_.empty()) return receivers_.front().footprint.size();
    std::size_t sum = 0;
    for (const EmitterConstants& e : emitters_) sum += receivers_[e.emitter.receiver].footprint.size();
    return sum / emitters_.size();
  }
  /// Subrays passed to the sinks with each pulse.
  [[nodiscard]] std::size_t recorded_subrays() const noexcept { return recorded ? subrays() : 0; }
  /// Receivers, by number.
  [[nodiscard]] std::span<const ReceiverUnit<Footprint, Detector>> receivers() const noexcept { return receivers_; }
  /// Sample spacing of a waveform; 0 if the detectors have none [s].
  [[nodiscard]] double sample_interval() const noexcept { return interval_of(receivers_.front()); }
  /// Token of this survey and its copies, which may use each other's workspaces.
  [[nodiscard]] const std::shared_ptr<const void>& identity() const noexcept { return identity_; }

  /// Result of slot i, whose pulse is empty if it is blocked.
  [[nodiscard]] Outcome operator()(PulseIndex i, const std::optional<Pulse<frame::World>>& pulse,
                                   Workspace& w) const noexcept;

 protected:
  /// True if pulses of one emitter are traced together, several in a block of slots.
  static constexpr bool in_blocks = std::same_as<Footprint, SingleRay> && std::same_as<Transport, DirectLight> &&
                                    detail::TracesSheaves<Target> && !ReadsVelocity<Detector>;

  [[nodiscard]] std::size_t emitter_count() const noexcept { return emitters_.size(); }
  /// Slots of a block: so many of each emitter if they fire in turn.
  [[nodiscard]] std::size_t block_size() const noexcept {
    return std::clamp<std::size_t>(emitters_.size() * detail::RaySheaf::capacity, 1, 512);  // 200 kB
  }
  /// Enters the pulses of slots `first + at`, `first + at + step` and so on into the block from slot `first` on.
  void enter(const PulseLanes<frame::World>& pulses, PulseIndex first, std::size_t at, std::size_t step,
             Workspace& w) const noexcept {
    const detail::ReportedLanes reported(pulses);
    for (std::size_t lane = 0; lane < pulses.size; ++lane, at += step) {
      detail::BlockPulse& p = w.block[at];
      reported.get(lane, first + at, p);
      if (p.blocked()) continue;
      PULSECAST_ASSERT(p.emitter < emitters_.size());
      const EmitterConstants& constants = emitters_[p.emitter];
      p.outcome.shot.channel = constants.emitter.channel;
      if (!constants.beam.from_a_point()) p.exit += matrix_of(pulses.pose.rotation[lane]) * constants.beam.exits[0];
    }
  }
  /// Traces the pulses of a block of so many slots, those of one emitter together where it pays.
  void trace_block(std::size_t slots, Workspace& w) const noexcept {
    const std::size_t emitters = emitters_.size();
    for (std::size_t start = 0; start < std::min(slots, emitters); ++start)
      for (std::size_t slot = start; slot < slots;) {
        std::array<detail::BlockPulse*, detail::RaySheaf::capacity> pulses;
        w.rays.size = 0;
        for (; slot < slots && w.rays.size < w.rays.capacity; slot += emitters) {
          detail::BlockPulse& p = w.block[slot];
          if (p.blocked()) continue;
          if (w.rays.size > 0 && p.emitter != pulses[0]->emitter) break;
          pulses[w.rays.size] = &p;
          w.rays.push_back(p.ray(seed_), detail::infinity);
        }
        if (w.rays.size > 0) trace_together(emitters_[pulses[0]->emitter], {pulses.data(), w.rays.size}, w);
      }
  }
  /// Result of a slot of a traced block.
  [[nodiscard]] const Outcome& result_of(std::size_t slot, Workspace& w) const noexcept {
    detail::BlockPulse& p = w.block[slot];
    if (p.reflects || (RunsWithoutReflections<Detector> && !p.blocked()))
      detect(p.outcome.shot.index, emitters_[p.emitter], {&p.reflection, p.reflects ? 1U : 0U}, {}, p.white, w,
             p.outcome);
    return p.outcome;
  }

 private:
  using Unit = ReceiverUnit<Footprint, Detector>;

  /// Constants of an emitter, computed once for all pulses.
  struct EmitterConstants {
    Emitter emitter;
    LinkBudget budget;      // link budget of its laser and receiver
    SubrayDirections beam;  // subrays, shared with emitters of equal beams
    bool errs = false;      // true if its receiver has range errors
    RangeErrors errors{};   // drawn for this survey
  };

  /// Refuses a footprint whose shares do not sum to the whole beam.
  static void require_whole_beam(const Footprint& footprint) {
    double sum = 0;
    for (std::size_t j = 0; j < footprint.size(); ++j) {
      const double share = footprint.share(j);
      require_not_negative("Footprint::share", share, "");
      require_finite("Footprint::offset (length)", length(footprint.offset(j)), "");
      sum += share;
    }
    require_within("Footprint::share (sum)", sum, 1 - 1e-6, 1 + 1e-6, "");
  }

  /// Refuses receivers whose results do not fit in one batch.
  void require_alike() const {
    const double interval = sample_interval(), subrays = static_cast<double>(receivers_.front().footprint.size());
    for (const Unit& unit : receivers_) {
      if (interval_of(unit) != interval)
        throw SettingError("Survey::receivers (sample interval)", interval_of(unit), "s", "equal for all");
      if (recorded) require_within("Survey::receivers (subrays)", unit.footprint.size(), subrays, subrays, "");
    }
  }

  static double interval_of(const Unit& unit) noexcept {
    if constexpr (SamplesWaveforms<Detector>) return unit.detector.sample_interval();
    return 0;
  }

  /// Computes the constants of a valid emitter; those from `first` on are known. @throws
  /// SettingError if it has no receiver, or the detector refuses its laser
  void set(EmitterConstants* constants, const Emitter& emitter, const EmitterConstants* first) {
    require_within("Emitter::receiver", emitter.receiver, 0, static_cast<double>(receivers_.size()) - 1, "");
    Unit& unit = receivers_[emitter.receiver];
    if constexpr (RotatesPerPulse<Footprint>)
      require_within("Laser::divergence (up by across)", emitter.laser.divergence.aspect(), 1, 1, "");
    if constexpr (ValidatesLaser<Detector>) unit.detector.validate(emitter.laser);
    if constexpr (PreparesForLasers<Detector>) unit.detector.prepare(emitter.laser);
    const EmitterConstants* alike = first;
    while (alike != constants &&
           !(alike->emitter.receiver == emitter.receiver && SubrayDirections::equal(alike->emitter, emitter)))
      ++alike;
    *constants = {emitter, LinkBudget(unit.receiver, emitter.laser),
                  alike == constants ? SubrayDirections(unit.footprint, emitter) : alike->beam,
                  !unit.receiver.range_errors.none(), unit.receiver.range_errors.drawn(seed_, emitter.receiver)};
  }

  static constexpr bool recorded = RecordsSubrays<Footprint>;

  /// Pulse i with its beam turned about its axis.
  [[nodiscard]] Pulse<frame::World> turned(Pulse<frame::World> pulse, PulseIndex i) const noexcept {
    const Rotation turn = rotation_about(axis::forward, 2 * pi * uniform({seed_, i, 0, Purpose::beam_turn}));
    pulse.pose.rotation = pulse.pose.rotation * turn;
    if (pulse.reported) pulse.reported->rotation = pulse.reported->rotation * turn;
    return pulse;
  }

  [[nodiscard]] TransportResult trace(const Pulse<frame::World>& pulse, PulseIndex i, const EmitterConstants& constants,
                                      Workspace& w) const noexcept {
    const auto& [emitter, budget, beam, errs, errors] = constants;
    const Unit& unit = receivers_[emitter.receiver];
    TransportInput light{pulse, i, seed_, emitter, beam, unit.footprint.size(), budget, w.white_target};
    light.gate = unit.receiver.gate();
    if constexpr (recorded) light.record = w.subrays;
    if constexpr (ReadsVelocity<Detector>)
      return transport_.template trace<true>(*target_, light, w.transport, w.reflections);
    else
      return transport_.trace(*target_, light, w.transport, w.reflections);
  }

  /// Error of a pulse without light, of a map that answered with NaN, or with a reported pose.
  static PulseError error_of(const Pulse<frame::World>& pulse, bool nan_of_map) noexcept {
    if (!pulse.pose.finite() || (pulse.reported && !pulse.reported->finite())) return PulseError::pose;
    return nan_of_map ? PulseError::map : PulseError::none;
  }

  /// Traces the rays of a sheaf, of pulses of one emitter.
  void trace_together(const EmitterConstants& constants, std::span<detail::BlockPulse*> pulses,
                      Workspace& w) const noexcept {
    const auto& [emitter, budget, beam, errs, errors] = constants;
    const RangeGate gate = receivers_[emitter.receiver].receiver.gate();
    const std::span<Hit> hits = w.transport.hits;
    w.rays.enclose();
    target_->closest(w.rays, emitter.laser.wavelength, hits);
    for (std::size_t j = 0; j < pulses.size(); j += simd::lane_count) {
      const simd::Doubles range = simd::generate([&](std::size_t lane) { return hits[j + lane].range; });
      const simd::Doubles ones = simd::Doubles{} + 1.0, white = budget.power_in_view(ones, ones, range);
      for (std::size_t lane = 0; lane < std::min(simd::lane_count, pulses.size() - j); ++lane) {
        detail::BlockPulse& p = *pulses[j + lane];
        const Hit& hit = hits[j + lane];
        const double seen = budget.sees_all() || !hit.met() ? white[lane] : white[lane] * budget.overlap_at(hit.range);
        const TransportResult result = DirectLight::of_hit(hit, seen, gate, emitter.laser, p.reflection);
        p.white = WhiteTarget(hit.range, seen);
        p.reflects = result.reflections > 0;
        p.outcome.energy = result.energy;
        p.outcome.shot.fate = p.reflects ? Fate::below_threshold : result.fate;
        if (result.nan && p.outcome.error == PulseError::none) p.outcome.error = PulseError::map;
      }
    }
  }

  /// Turns the light that returned of a pulse into echoes. Always inlined: a call costs 0.2 % of a pulse.
  [[gnu::always_inline]] void detect(PulseIndex i, const EmitterConstants& constants, std::span<Reflection> reflections,
                                     std::span<const ContinuousReturn> continuous, WhiteTarget& white, Workspace& w,
                                     Outcome& out) const noexcept {
    const Emitter& emitter = constants.emitter;
    const Unit& unit = receivers_[emitter.receiver];
    const DetectorInput input{emitter, unit.receiver.gate(), reflections, {.seed = seed_, .pulse = i}, continuous};
    const Detection detection = unit.detector.detect(input, w.detectors[emitter.receiver]);
    bool all_inside = true;
    for (Echo& echo : detection.echoes) {
      echo.reflectance = echo.amplitude / white.power(constants.budget, echo.range);
      if (constants.errs) [[unlikely]]
        echo.range += constants.errors.at(echo, normal({seed_, i, echo.number, Purpose::range_noise}), emitter.channel);
      all_inside &= input.gate.contains(echo.range);
    }
    const std::span<Echo> echoes = all_inside ? detection.echoes : detail::inside(input.gate, detection.echoes);
    if (constants.errs) detail::sort_by_range(echoes);
    out.echoes = echoes;
    out.waveform = detection.waveform;
    out.shot.waveform_start = detection.waveform_start;
    if (!echoes.empty()) out.shot.fate = Fate::returned;
  }

  const Target* target_;
  Transport transport_;
  std::vector<Unit> receivers_;
  std::uint64_t seed_;
  std::span<const EmitterConstants> emitters_{};  // by number
  std::shared_ptr<const void> identity_{};        // owner of the constants, shared with copies
};

template <Footprint Footprint, Target Target, Detector Detector, Transport<Target> Transport>
EchoSimulator<Footprint, Target, Detector, Transport>::EchoSimulator(
    std::vector<ReceiverUnit<Footprint, Detector>> receivers, const Target& target, Transport transport,
    const std::vector<Emitter>& emitters, std::uint64_t seed)
    : target_(&target), transport_(validated(std::move(transport))), receivers_(std::move(receivers)), seed_(seed) {
  require_within("Survey::receivers (number)", receivers_.size(), 1, max_emitters, "");
  for (Unit& unit : receivers_) {
    detail::validate_in_place(unit.footprint);
    detail::validate_in_place(unit.receiver);
    detail::validate_in_place(unit.detector);
    require_whole_beam(unit.footprint);
  }
  require_alike();
  if constexpr (ValidatesTarget<Transport, Target>) transport_.validate(*target_);
  const std::shared_ptr<EmitterConstants[]> constants = std::make_unique<EmitterConstants[]>(emitters.size());
  EmitterConstants* next = constants.get();
  for (const Emitter& emitter : emitters) set(next++, validated(emitter), constants.get());
  emitters_ = {constants.get(), emitters.size()};
  identity_ = constants;
}

template <Footprint Footprint, Target Target, Detector Detector, Transport<Target> Transport>
auto EchoSimulator<Footprint, Target, Detector, Transport>::workspace() const -> Workspace {
  std::size_t most = 0;
  for (const Unit& unit : receivers_) most = std::max(most, unit.footprint.size());
  Workspace w{transport_.workspace(most),
              detail::room_for(transport_.reflections(most), most),
              std::vector<SubrayRecord>(recorded_subrays()),
              {}};
  for (const Unit& unit : receivers_)
    w.detectors.push_back(unit.detector.workspace(transport_.reflections(unit.footprint.size())));
  if constexpr (in_blocks) w.block.resize(block_size());
  return w;
}

template <Footprint Footprint, Target Target, Detector Detector, Transport<Target> Transport>
Outcome EchoSimulator<Footprint, Target, Detector, Transport>::operator()(
    PulseIndex i, const std::optional<Pulse<frame::World>>& pulse, Workspace& w) const noexcept {
  Outcome out;
  out.shot.index = i;
  if (!pulse) {
    out.shot.fate = Fate::blocked;
    return out;
  }
  const Pose<frame::Beam, frame::World>& reported = pulse->reported ? *pulse->reported : pulse->pose;
  out.shot.tick = pulse->tick;
  out.shot.origin = reported.position;
  out.shot.direction = reported.direction(axis::forward);
  out.shot.scan_angle = pulse->scan_angle;
  out.shot.leg = pulse->leg;
  PULSECAST_ASSERT(pulse->emitter < emitters_.size());
  const EmitterConstants& constants = emitters_[pulse->emitter];
  const Emitter& emitter = constants.emitter;
  out.shot.channel = emitter.channel;

  if (pulse->emitter != w.emitter) {
    w.emitter = pulse->emitter;
    w.white_target = {};
  }
  const TransportResult result = [&] {
    if constexpr (RotatesPerPulse<Footprint>)
      return trace(turned(*pulse, i), i, constants, w);
    else
      return trace(*pulse, i, constants, w);
  }();
  out.energy = result.energy;
  out.spread = result.spread;
  out.unresolved = result.unresolved;
  out.subrays = w.subrays;
  if (result.reflections == 0 || result.nan || pulse->reported) out.error = error_of(*pulse, result.nan);
  out.shot.fate = result.dark() ? result.fate : Fate::below_threshold;
  if constexpr (!RunsWithoutReflections<Detector>)
    if (result.dark()) return out;

  const std::span<Reflection> reflections{w.reflections.data(), result.reflections};
  if constexpr (JudgesSurfaces<Footprint>)
    out.shot.surface = detail::judged_surface(constants.beam, receivers_[emitter.receiver].footprint, reflections);
  detect(i, constants, reflections, result.continuous, w.white_target, w, out);
  return out;
}

}  // namespace PULSECAST_NAMESPACE

#endif
