// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SURVEY_HPP
#define PULSECAST_SURVEY_HPP

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include <pulsecast/base/random.hpp>
#include <pulsecast/base/require.hpp>
#include <pulsecast/concepts.hpp>
#include <pulsecast/scanner/footprint.hpp>
#include <pulsecast/stage_arguments.hpp>
#include <pulsecast/transport/direct_light.hpp>
#include <pulsecast/transport/transport_input.hpp>

namespace PULSECAST_NAMESPACE {

/// Error of a pulse that makes its results worthless: NaN from a user's own type. `run` throws it.
enum class PulseError : std::uint8_t {
  none,
  pose,  ///< a pose is not finite: an error of the trajectory, optic or pose errors
  map,   ///< the map answered with a range or backscatter of NaN
};

/// Result of one pulse slot. The spans stay valid until the workspace is used again; the shot's indices into a batch
/// are not set.
struct Outcome {
  Shot shot;                                ///< pulse as reported
  std::span<const Echo> echoes;             ///< echoes, sorted by reported range
  std::span<const float> waveform;          ///< received power [W]; empty if not kept
  EnergyLedger energy{};                    ///< energy by the end of its paths; zero if nothing was sent [J]
  bool spread = false;                      ///< as in `TransportResult`
  bool unresolved = false;                  ///< as in `TransportResult`
  std::span<const SubrayRecord> subrays{};  ///< all subrays, if the footprint is `WithSubrayRecord`
  PulseError error = PulseError::none;      ///< makes the other members worthless, unless `none`
};

/// ReceiverOverrides half of a device, for the emitters with its index as their `Emitter::receiver`.
template <Footprint Pattern, Detector Instrument>
struct ReceiverUnit {
  Pattern footprint;    ///< sampling of the beams
  Receiver receiver;    ///< aperture, range gate and range errors
  Instrument detector;  ///< detector
};

/// Simulation as a pure function from a pulse index to echoes. Immutable, so that pulses may be requested in any order
/// and from any number of threads. Refers to the map, which must outlive it.
template <WorldSource Source, Footprint Pattern, Target Map, Detector Instrument, Transport<Map> Light = DirectLight>
class Survey {
  static_assert(detail::members_checked<Pattern, tag::RecordsSubrays, tag::RotatesPerPulse> &&
                detail::detector_checked<Instrument>);
  static_assert(!ReadsVelocity<Instrument> || TracesVelocity<Light, Map>,
                "Survey: the detector reads velocities, which this transport does not set; give it trace<true>, as "
                "DirectLight has");

 public:
  /// Survey with one receiver for all emitters.
  /// @throws SettingError for settings out of range, footprint shares that do not sum to one, or a laser that the
  /// detector refuses
  Survey(Source source, Pattern footprint, const Map& map, Receiver receiver, Instrument detector,
         std::uint64_t seed = 0)
      : Survey(std::move(source), std::move(footprint), map, Light{}, std::move(receiver), std::move(detector), seed) {}
  /// As above, with a transport other than `DirectLight`.
  Survey(Source source, Pattern footprint, const Map& map, Light transport, Receiver receiver, Instrument detector,
         std::uint64_t seed = 0)
      : source_(validated(std::move(source))),
        map_(&map),
        transport_(validated(std::move(transport))),
        receivers_(1, {std::move(footprint), std::move(receiver), std::move(detector)}),
        seed_(seed) {
    prepare();
  }

  /// Survey with a receiver for each group of emitters. Sample intervals must be equal, and numbers of subrays if they
  /// are recorded.
  /// @throws SettingError as above, or for an emitter without a receiver
  Survey(Source source, std::vector<ReceiverUnit<Pattern, Instrument>> receivers, const Map& map,
         std::uint64_t seed = 0)
      : Survey(std::move(source), std::move(receivers), map, Light{}, seed) {}
  /// As above, with a transport other than `DirectLight`.
  Survey(Source source, std::vector<ReceiverUnit<Pattern, Instrument>> receivers, const Map& map, Light transport,
         std::uint64_t seed = 0)
      : source_(validated(std::move(source))),
        map_(&map),
        transport_(validated(std::move(transport))),
        receivers_(std::move(receivers)),
        seed_(seed) {
    prepare();
  }

  Survey(Source, Pattern, const Map&&, Receiver, Instrument,
         std::uint64_t = 0) = delete;  // a temporary map would dangle
  Survey(Source, Pattern, const Map&&, Light, Receiver, Instrument, std::uint64_t = 0) = delete;
  Survey(Source, std::vector<ReceiverUnit<Pattern, Instrument>>, const Map&&, std::uint64_t = 0) = delete;
  Survey(Source, std::vector<ReceiverUnit<Pattern, Instrument>>, const Map&&, Light, std::uint64_t = 0) = delete;

  /// Scratch memory of one worker.
  struct Workspace {
    /// Workspace of a detector.
    using OfDetector = decltype(std::declval<const Instrument&>().workspace(0));
    /// Workspace of the transport.
    using OfTransport = decltype(std::declval<const Light&>().workspace(0));

    OfTransport transport;                 ///< workspace of the transport
    SharedBuffer<Reflection> reflections;  ///< reflections of a pulse, with room for all
    std::vector<SubrayRecord> subrays;     ///< all of a pulse, if recorded
    std::vector<OfDetector> detectors;     ///< workspace of each receiver's detector
    std::uint16_t emitter = 0;             ///< emitter of the last pulse
    WhiteTarget white_target{};            ///< white target of that emitter
  };

  /// Scratch memory for one worker.
  [[nodiscard]] Workspace workspace() const {
    std::size_t most = 0;
    for (const Unit& unit : receivers_) most = std::max(most, unit.footprint.size());
    Workspace w{transport_.workspace(most),
                room_for(transport_.reflections(most), most),
                std::vector<SubrayRecord>(recorded_subrays()),
                {}};
    for (const Unit& unit : receivers_)
      w.detectors.push_back(unit.detector.workspace(transport_.reflections(unit.footprint.size())));
    return w;
  }

  [[nodiscard]] PulseIndex size() const noexcept { return source_.size(); }
  /// Subrays of a pulse: the mean over the emitters, if their receivers differ.
  [[nodiscard]] std::size_t subrays() const noexcept {
    if (receivers_.size() == 1 || emitters_.empty()) return receivers_.front().footprint.size();
    std::size_t sum = 0;
    for (const EmitterConstants& e : emitters_) sum += receivers_[e.emitter.receiver].footprint.size();
    return sum / emitters_.size();
  }
  [[nodiscard]] std::size_t recorded_subrays() const noexcept {
    return recorded ? subrays() : 0;
  }  ///< subrays passed on with each pulse
  /// Source of the pulses.
  [[nodiscard]] const Source& source() const noexcept { return source_; }
  /// Receivers.
  [[nodiscard]] std::span<const ReceiverUnit<Pattern, Instrument>> receivers() const noexcept { return receivers_; }
  /// Sample spacing of a waveform; 0 if the detectors have none [s].
  [[nodiscard]] double sample_interval() const noexcept { return interval_of(receivers_.front()); }
  /// Token that this survey shares with its copies alone: they may use each other's workspaces.
  [[nodiscard]] const std::shared_ptr<const void>& identity() const noexcept { return identity_; }

  /// As the concept SkipsBlocked requires.
  [[nodiscard]] PulseIndex next_pulse(PulseIndex i) const noexcept requires SkipsBlocked<Source> {
    return source_.next_pulse(i);
  }

  /// Simulates pulse i.
  [[nodiscard]] Outcome operator()(PulseIndex i, Workspace& w) const noexcept {
    return outcome(i, source_.pulse(i), w);
  }

  /// As the concept SimulatesInOrder requires: pulses are made by the register, which does not outlive the call.
  template <class Next>
  void simulate_in_order(PulseIndex i, PulseIndex end, Workspace& w, const Next& next) const {
    PulseLanes<frame::World> pulses;
    for (PulseIndex first = i; i < end; i = next(outcome(i, pulses[i - first], w)))
      if (i - first >= pulses.size) {
        first = i;
        pulses = find_pulses(source_, i, end - i < simd::lane_count ? end - i : simd::lane_count);
      }
  }

 private:
  using Unit = ReceiverUnit<Pattern, Instrument>;

  /// Result of slot i, whose pulse is empty if it is blocked.
  [[nodiscard]] Outcome outcome(PulseIndex i, const std::optional<Pulse<frame::World>>& pulse,
                                Workspace& w) const noexcept {
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
    const Unit& unit = receivers_[emitter.receiver];
    out.shot.channel = emitter.channel;

    if (pulse->emitter != w.emitter) {
      w.emitter = pulse->emitter;
      w.white_target = {};
    }
    const TransportResult result = [&] {
      if constexpr (RotatesPerPulse<Pattern>)
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
    if constexpr (!RunsWithoutReflections<Instrument>)
      if (result.dark()) return out;

    const std::span<Reflection> reflections(w.reflections.data(), result.reflections);
    const DetectorInput input{
        emitter, unit.receiver.gate(), reflections, {.seed = seed_, .pulse = i}, result.continuous};
    const Detection detection = unit.detector.detect(input, w.detectors[emitter.receiver]);
    const RangeErrors& errors = unit.receiver.range_errors;
    bool all_inside = true;
    for (Echo& echo : detection.echoes) {
      echo.reflectance = echo.amplitude / w.white_target.power(constants.budget, echo.range);
      if (constants.errs)
        echo.range += errors.at(echo, normal({seed_, i, echo.number, Purpose::range_noise}), emitter.channel);
      all_inside &= input.gate.contains(echo.range);
    }
    const std::span<Echo> echoes = all_inside ? detection.echoes : detail::inside(input.gate, detection.echoes);
    if (constants.errs) detail::sort_by_range(echoes);
    out.echoes = echoes;
    out.waveform = detection.waveform;
    out.shot.waveform_start = detection.waveform_start;
    if (!echoes.empty()) out.shot.fate = Fate::returned;
    return out;
  }

  /// Constants of an emitter, computed once for all pulses.
  struct EmitterConstants {
    Emitter emitter;
    LinkBudget budget;      // link budget of its laser and receiver
    SubrayDirections beam;  // subrays, shared with emitters of equal beams
    bool errs = false;      // true if its receiver has range errors
  };

  /// Refuses a footprint whose shares do not sum to the whole beam.
  static void require_whole_beam(const Pattern& footprint) {
    double sum = 0;
    for (std::size_t j = 0; j < footprint.size(); ++j) {
      const double share = footprint.share(j);
      require_not_negative("Footprint::share", share, "");
      require_finite("Footprint::offset (length)", length(footprint.offset(j)), "");
      sum += share;
    }
    require_within("Footprint::share (sum)", sum, 1 - 1e-6, 1 + 1e-6,
                   "");  // tolerates the rounding of a sum of a million
  }

  /// Refuses receivers whose results do not fit in one batch.
  void require_alike() const {
    const double interval = sample_interval(), subrays = static_cast<double>(receivers_.front().footprint.size());
    for (const Unit& unit : receivers_) {
      if (interval_of(unit) != interval)
        throw SettingError("Survey::receivers (sample interval)", interval_of(unit), "s", "equal for all");
      if (recorded)
        require_within("Survey::receivers (subrays)", static_cast<double>(unit.footprint.size()), subrays, subrays, "");
    }
  }

  static double interval_of(const Unit& unit) noexcept {
    if constexpr (SamplesWaveforms<Instrument>) return unit.detector.sample_interval();
    return 0;
  }

  /// Validates the receivers and emitters, and computes what depends on them alone.
  void prepare() {
    require_within("Survey::receivers (number)", static_cast<double>(receivers_.size()), 1, max_emitters, "");
    for (Unit& unit : receivers_) {
      validate_in_place(unit.footprint);
      validate_in_place(unit.receiver);
      validate_in_place(unit.detector);
      require_whole_beam(unit.footprint);
    }
    require_alike();
    const std::vector<Emitter> emitters = source_.emitters();
    require_within("PulseSource::emitters (number)", static_cast<double>(emitters.size()), size() > 0 ? 1 : 0,
                   max_emitters, "");
    const std::shared_ptr<EmitterConstants[]> constants = std::make_unique<EmitterConstants[]>(emitters.size());
    EmitterConstants* next = constants.get();
    for (const Emitter& emitter : emitters) set(next++, validated(emitter), constants.get());
    emitters_ = {constants.get(), emitters.size()};
    identity_ = constants;
  }

  /// Computes the constants of a valid emitter; those from `first` on are known. Throws a `SettingError` if it has no
  /// receiver, or if the detector refuses its laser.
  void set(EmitterConstants* constants, const Emitter& emitter, const EmitterConstants* first) {
    require_within("Emitter::receiver", emitter.receiver, 0, static_cast<double>(receivers_.size()) - 1, "");
    Unit& unit = receivers_[emitter.receiver];
    if constexpr (RotatesPerPulse<Pattern>)
      require_within("Laser::divergence (up by across)", emitter.laser.divergence.aspect(), 1, 1, "");
    if constexpr (ValidatesLaser<Instrument>) unit.detector.validate(emitter.laser);
    if constexpr (PreparesForLasers<Instrument>) unit.detector.prepare(emitter.laser);
    const EmitterConstants* alike = first;
    while (alike != constants &&
           !(alike->emitter.receiver == emitter.receiver && SubrayDirections::equal(alike->emitter, emitter)))
      ++alike;
    *constants = {emitter, LinkBudget(unit.receiver, emitter.laser),
                  alike == constants ? SubrayDirections(unit.footprint, emitter) : alike->beam,
                  !unit.receiver.range_errors.none()};
  }

  static constexpr bool recorded = RecordsSubrays<Pattern>;

  /// Pulse i with its beam turned about its axis.
  [[nodiscard]] Pulse<frame::World> turned(Pulse<frame::World> pulse, PulseIndex i) const noexcept {
    const Rotation turn = rotation_about(axis::forward, 2 * pi * uniform({seed_, i, 0, Purpose::beam_turn}));
    pulse.pose.rotation = pulse.pose.rotation * turn;
    if (pulse.reported) pulse.reported->rotation = pulse.reported->rotation * turn;
    return pulse;
  }

  [[nodiscard]] TransportResult trace(const Pulse<frame::World>& pulse, PulseIndex i, const EmitterConstants& constants,
                                      Workspace& w) const noexcept {
    const Unit& unit = receivers_[constants.emitter.receiver];
    const TransportInput light{pulse,
                               i,
                               seed_,
                               constants.emitter,
                               constants.beam,
                               unit.footprint.size(),
                               constants.budget,
                               w.white_target,
                               unit.receiver.gate(),
                               recorded ? std::span(w.subrays) : std::span<SubrayRecord>{}};
    if constexpr (ReadsVelocity<Instrument>)
      return transport_.template trace<true>(*map_, light, w.transport, w.reflections);
    else
      return transport_.trace(*map_, light, w.transport, w.reflections);
  }

  /// Error of a pulse that may have one: light did not return, the map answered with NaN, or a pose is reported.
  static PulseError error_of(const Pulse<frame::World>& pulse, bool nan_of_map) noexcept {
    if (!pulse.pose.finite() || (pulse.reported && !pulse.reported->finite())) return PulseError::pose;
    return nan_of_map ? PulseError::map : PulseError::none;
  }

  Source source_;
  const Map* map_;
  Light transport_;
  std::vector<Unit> receivers_;
  std::uint64_t seed_;
  std::span<const EmitterConstants> emitters_{};  // by number
  std::shared_ptr<const void> identity_{};        // owner of the constants, shared with copies
};

/// Names the mistake in the arguments.
template <class Source, class Pattern, class Map, class Instrument>
requires(!detail::Surveyable<Source, Pattern, Map, Instrument>)
    Survey(Source, Pattern, Map&&, Receiver, Instrument, std::uint64_t = 0)
->Survey<typename detail::SurveyArguments<Source, Pattern, Map, Instrument>::First, Pattern, Map, Instrument>;
/// As above.
template <class Source, class Pattern, class Map, class Light, class Instrument>
requires(!detail::Surveyable<Source, Pattern, Map, Instrument> || !Transport<Light, std::remove_cvref_t<Map>>)
    Survey(Source, Pattern, Map&&, Light, Receiver, Instrument, std::uint64_t = 0)
->Survey<typename detail::TransportArguments<Source, Pattern, Map, Light, Instrument>::First, Pattern,
         std::remove_cvref_t<Map>, Instrument, Light>;
/// As above.
template <class Source, class Pattern, class Map, class Instrument>
requires(detail::Temporary<Map>)
    Survey(Source, std::vector<ReceiverUnit<Pattern, Instrument>>, Map&&, std::uint64_t = 0)
->Survey<typename detail::SurveyArguments<Source, Pattern, Map, Instrument>::First, Pattern, Map, Instrument>;

}  // namespace PULSECAST_NAMESPACE

#endif
