// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SURVEY_HPP
#define PULSECAST_SURVEY_HPP

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include <pulsecast/base/random.hpp>
#include <pulsecast/base/require.hpp>
#include <pulsecast/base/simd.hpp>
#include <pulsecast/concepts.hpp>
#include <pulsecast/detector/radiometry.hpp>
#include <pulsecast/scanner/footprint.hpp>

namespace pulsecast {

/// Result of one pulse slot. The spans stay valid until the workspace is used again; the shot's indices into a batch are not set.
struct Outcome {
  Shot shot;                        ///< pulse as reported
  std::span<const Echo> echoes;     ///< echoes, sorted by reported range
  std::span<const float> waveform;  ///< received power [W]; empty if not kept
  std::size_t hits = 0;             ///< subrays with a hit
  double energy = 0;                ///< energy sent: peak power times pulse length; the pulse shape makes some percent of difference [J]
  std::array<double, fate_count> shares{};  ///< shares of that energy by `Fate`; they sum to one, or to zero if nothing was sent
  std::span<const SubrayHit> subrays{};     ///< all subrays, if the footprint is `WithSubrayRecord`

  [[nodiscard]] double share(Fate fate) const noexcept { return shares[static_cast<std::size_t>(fate)]; }
};

/// Receiving half of a device, for the emitters with its index as their `Emitter::receiver`.
template <Footprint Pattern, Detector Instrument>
struct ReceiverUnit {
  Pattern footprint;    ///< sampling of the beams
  Receiver receiver;    ///< aperture, range gate and range errors
  Instrument detector;  ///< detector
};

/// Simulation as a pure function from a pulse index to echoes. Immutable, so that pulses may be requested in any order and from any number
/// of threads. Refers to the map, which must outlive it.
template <WorldSource Source, Footprint Pattern, Target Map, Detector Instrument>
class Survey {
 public:
  /// Survey with one receiver for all emitters.
  /// @throws SettingError for settings out of range, footprint shares that do not sum to one, or a laser that the detector refuses
  Survey(Source source, Pattern footprint, const Map& map, Receiver receiver, Instrument detector, std::uint64_t seed = 0)
      : Survey(std::move(source), std::vector<Unit>(1, {std::move(footprint), std::move(receiver), std::move(detector)}), map, seed) {}

  /// Survey with a receiver for each group of emitters. Sample intervals must be equal, and numbers of subrays if they are recorded.
  /// @throws SettingError as above, or for an emitter without a receiver
  Survey(Source source, std::vector<ReceiverUnit<Pattern, Instrument>> receivers, const Map& map, std::uint64_t seed = 0)
      : source_(validated(std::move(source))), map_(&map), receivers_(std::move(receivers)), seed_(seed) {
    require_within("Survey::receivers (number)", static_cast<double>(receivers_.size()), 1, max_emitters, "");
    for (Unit& unit : receivers_) {
      validate(unit.footprint);
      validate(unit.receiver);
      validate(unit.detector);
      require_whole_beam(unit.footprint);
    }
    require_alike();
    const std::vector<Emitter> emitters = source_.emitters();
    require_within("PulseSource::emitters (number)", static_cast<double>(emitters.size()), size() > 0 ? 1 : 0, max_emitters, "");
    for (std::size_t e = 0; e < emitters.size(); ++e) add_emitter(validated(emitters[e]), {emitters.data(), e});
  }

  Survey(Source, Pattern, const Map&&, Receiver, Instrument, std::uint64_t = 0) = delete;  // a temporary map would dangle
  Survey(Source, std::vector<ReceiverUnit<Pattern, Instrument>>, const Map&&, std::uint64_t = 0) = delete;

  /// Scratch memory of one worker.
  struct Workspace {
    using OfDetector = decltype(std::declval<const Instrument&>().workspace(0));

    std::array<Hit, RayBundle::capacity> hits;  ///< hits of a bundle
    std::vector<Reflection> reflections;        ///< reflections of a pulse, with room for all subrays
    std::vector<SubrayHit> subrays;             ///< all of a pulse, if recorded
    std::vector<OfDetector> detectors;          ///< workspace of each receiver's detector
    struct {
      std::uint16_t emitter = 0;  ///< emitter of the last pulse
      double range = -1;          ///< last range requested for it [m]
      double power = 0;           ///< power received from a white target there [W]
    } white_target{};             ///< last result of `white_target_power`
  };

  /// Scratch memory for one worker.
  [[nodiscard]] Workspace workspace() const {
    Workspace w{{}, {}, std::vector<SubrayHit>(recorded_subrays()), {}};
    std::size_t most = 0;
    for (const Unit& unit : receivers_) {
      const std::size_t n = unit.footprint.size();
      most = std::max(most, n);
      w.detectors.push_back(unit.detector.workspace(n));
    }
    w.reflections.resize(most);
    return w;
  }

  [[nodiscard]] PulseIndex size() const noexcept { return source_.size(); }
  /// Subrays of a pulse: the mean over the emitters, if their receivers differ.
  [[nodiscard]] std::size_t subrays() const noexcept {
    if (receivers_.size() == 1 || emitters_.empty()) return receivers_.front().footprint.size();
    std::size_t sum = 0;
    for (const EmitterConstants& e : emitters_) sum += receivers_[e.receiver].footprint.size();
    return sum / emitters_.size();
  }
  [[nodiscard]] std::size_t recorded_subrays() const noexcept { return recorded ? subrays() : 0; }  ///< subrays passed on with each pulse
  /// Source of the pulses.
  [[nodiscard]] const Source& source() const noexcept { return source_; }
  /// Receivers.
  [[nodiscard]] std::span<const ReceiverUnit<Pattern, Instrument>> receivers() const noexcept { return receivers_; }
  /// Sample spacing of a waveform; 0 if the detectors have none [s].
  [[nodiscard]] double sample_interval() const noexcept { return interval_of(receivers_.front()); }

  /// Token that this survey shares with its copies alone: they may use each other's workspaces.
  [[nodiscard]] const std::shared_ptr<const void>& identity() const noexcept { return identity_; }

  /// Simulates pulse i.
  [[nodiscard]] Outcome operator()(PulseIndex i, Workspace& w) const noexcept {
    Outcome out;
    out.shot.index = i;
    const auto pulse = source_.pulse(i);
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
    const EmitterConstants& emitter = emitters_[pulse->emitter];
    const Unit& unit = receivers_[emitter.receiver];
    out.shot.channel = emitter.channel;

    if (pulse->emitter != w.white_target.emitter) w.white_target = {pulse->emitter};
    const EnergyByFate by_fate = trace(*pulse, i, emitter, reported, w);
    out.energy = emitter.laser.peak_power * emitter.laser.pulse_length;
    out.subrays = w.subrays;
    out.shares[static_cast<std::size_t>(Fate::missed)] = by_fate.missed;
    out.shares[static_cast<std::size_t>(Fate::out_of_range)] = by_fate.out_of_range;
    out.shares[static_cast<std::size_t>(Fate::absorbed)] = by_fate.absorbed;
    out.hits = by_fate.hits;
    if (by_fate.reflections == 0) {
      out.shot.fate = by_fate.any_in_gate ? Fate::absorbed : by_fate.hits > 0 ? Fate::out_of_range : Fate::missed;
      return out;
    }

    const Detection detection =
        detect(unit.detector, emitter.laser, i, {w.reflections.data(), by_fate.reflections}, w.detectors[emitter.receiver]);
    const RangeErrors& errors = unit.receiver.range_errors;
    for (Echo& echo : detection.echoes) {
      echo.reflectance = echo.amplitude / white_target_power(emitter.budget, w, echo.range);
      if (!errors.none()) echo.range += errors.at(echo.range, echo.cos_incidence, normal({seed_, i, echo.number, Purpose::range_noise}));
    }
    if (detection.echoes.size() > 1 && !errors.none()) sort_by_range(detection.echoes);
    out.echoes = detection.echoes;
    out.waveform = detection.waveform;
    out.shot.waveform_start = detection.waveform_start;
    out.shot.fate = detection.echoes.empty() ? Fate::below_threshold : Fate::returned;
    out.shares[static_cast<std::size_t>(out.shot.fate)] = by_fate.reflected;
    return out;
  }

 private:
  using Unit = ReceiverUnit<Pattern, Instrument>;

  /// Constants of an emitter, computed once for all pulses.
  struct EmitterConstants {
    Laser laser;             // laser of its pulses
    LinkBudget budget;       // link budget of that laser and its receiver
    std::uint32_t beam;      // index of its subrays, which it shares with emitters of equal beams
    std::uint16_t receiver;  // index of its receiver
    std::uint16_t channel;   // number in its device
  };

  /// Validates and normalizes settings in place. Compiles faster than assigning `validated` ones.
  template <class Settings>
  static void validate(Settings& settings) {
    if constexpr (requires { settings.validate(); }) settings.validate();
    if constexpr (Normalizable<Settings>) settings.normalize();
  }

  /// Refuses a footprint whose shares do not sum to the whole beam.
  static void require_whole_beam(const Pattern& footprint) {
    double sum = 0;
    for (std::size_t j = 0; j < footprint.size(); ++j) {
      const double share = footprint.share(j);
      require_not_negative("Footprint::share", share, "");
      require_finite("Footprint::offset (length)", length(footprint.offset(j)), "");
      sum += share;
    }
    require_within("Footprint::share (sum)", sum, 1 - 1e-6, 1 + 1e-6, "");  // tolerates the rounding of a sum of a million
  }

  /// Refuses receivers whose results do not fit in one batch.
  void require_alike() const {
    const double interval = sample_interval(), subrays = static_cast<double>(receivers_.front().footprint.size());
    for (const Unit& unit : receivers_) {
      if (interval_of(unit) != interval) throw SettingError("Survey::receivers (sample interval)", interval_of(unit), "s", "equal for all");
      if (recorded) require_within("Survey::receivers (subrays)", static_cast<double>(unit.footprint.size()), subrays, subrays, "");
    }
  }

  static double interval_of(const Unit& unit) noexcept {
    if constexpr (requires { unit.detector.sample_interval(); })
      return unit.detector.sample_interval();
    else
      return 0;
  }

  /// Adds a valid emitter to the `earlier` ones. Throws a `SettingError` if it has no receiver, or if the detector refuses its laser.
  void add_emitter(const Emitter& emitter, std::span<const Emitter> earlier) {
    require_within("Emitter::receiver", emitter.receiver, 0, static_cast<double>(receivers_.size()) - 1, "");
    const Unit& unit = receivers_[emitter.receiver];
    if constexpr (requires { unit.detector.validate(emitter.laser); }) unit.detector.validate(emitter.laser);
    const auto alike = std::find_if(earlier.begin(), earlier.end(), [&](const Emitter& other) {
      return other.receiver == emitter.receiver && SubrayDirections::equal(other, emitter);
    });
    const std::size_t beam = alike == earlier.end() ? beams_.size() : emitters_[static_cast<std::size_t>(alike - earlier.begin())].beam;
    if (beam == beams_.size()) beams_.emplace_back(unit.footprint, emitter);
    emitters_.push_back(
        {emitter.laser, LinkBudget(unit.receiver, emitter.laser), static_cast<std::uint32_t>(beam), emitter.receiver, emitter.channel});
  }

  [[nodiscard]] Detection detect(const Instrument& detector, const Laser& laser, PulseIndex i, std::span<Reflection> reflections,
                                 typename Workspace::OfDetector& scratch) const noexcept {
    const RandomKey key{.seed = seed_, .pulse = i};
    if constexpr (requires { detector.detect(laser, reflections, scratch, key); })
      return detector.detect(laser, reflections, scratch, key);
    else
      return detector.detect(laser, reflections, scratch);
  }

  /// Sorts echoes by reported range, in which errors may have reordered them. Numbers stay in place: echoes are renumbered in order.
  static void sort_by_range(std::span<Echo> echoes) noexcept {
    for (std::size_t unsorted = 1; unsorted < echoes.size(); ++unsorted)  // insertion sort: a pulse has few echoes, most of them in order
      for (std::size_t e = unsorted; e > 0 && echoes[e].range < echoes[e - 1].range; --e) {
        std::swap(echoes[e - 1], echoes[e]);
        std::swap(echoes[e - 1].number, echoes[e].number);
      }
  }

  static constexpr bool recorded = requires { requires bool{Pattern::recorded}; };

  /// Shares of a pulse's energy by fate, and counts of its subrays.
  struct EnergyByFate {
    double missed = 0, out_of_range = 0, absorbed = 0, reflected = 0;
    std::size_t hits = 0, reflections = 0;
    bool any_in_gate = false;
  };

  /// Traces all subrays; sets the reflections, and the subrays if they are recorded.
  EnergyByFate trace(const Pulse<frame::World>& pulse, PulseIndex i, const EmitterConstants& emitter,
                     const Pose<frame::Beam, frame::World>& reported, Workspace& w) const noexcept {
    const SubrayDirections& beam = beams_[emitter.beam];
    const Receiver& receiver = receivers_[emitter.receiver].receiver;
    EnergyByFate by_fate;
    RayBundle rays;
    rays.origin = pulse.origin();
    rays.wavelength = emitter.laser.wavelength;
    rays.tick = pulse.tick;
    rays.seed = seed_;
    rays.pulse = i;
    const Matrix3 world_from_beam = matrix_of(pulse.pose.rotation);
    const bool from_a_point = beam.from_a_point();
    const std::size_t subrays = receivers_[emitter.receiver].footprint.size();
    RayBundle::Column power;
    for (std::size_t first = 0; first < subrays; first += rays.size) {
      rays.first_subray = static_cast<std::uint32_t>(first);
      rays.size = std::min(from_a_point ? RayBundle::capacity : 1, subrays - first);
      if (!from_a_point) rays.origin = pulse.origin() + world_from_beam * beam.exits[first];
      beam.to_world(world_from_beam, first, rays);
      intersect(rays, w.hits);
      received_power(emitter.budget, beam, first, rays.size, w, power);
      for (std::size_t j = 0; j < rays.size; ++j) {
        const Hit& hit = w.hits[j];
        const double share = beam.shares[first + j];
        if constexpr (recorded) {
          const Vec3 exit = from_a_point ? Vec3{} : beam.exits[first + j];
          const Vec3 direction{beam.x[first + j], beam.y[first + j], beam.z[first + j]};
          w.subrays[first + j] = {hit, 0, hit.met() ? reported.point(exit + hit.range * direction) : Vec3{}};
        }
        if (!hit.met()) {
          by_fate.missed += share;
          continue;
        }
        ++by_fate.hits;
        if (!receiver.in_gate(hit.range)) {
          by_fate.out_of_range += share;
          continue;
        }
        by_fate.any_in_gate = true;
        if (!(power[j] > 0)) {
          by_fate.absorbed += share;
          continue;
        }
        by_fate.reflected += share;
        w.reflections[by_fate.reflections++] = {hit.range, power[j], hit.object, hit.classification, hit.cos_incidence};
        if constexpr (recorded) w.subrays[first + j].power = power[j];
      }
    }
    return by_fate;
  }

  /// Power received from a white Lambertian target facing the beam at `range` [W]. Cached: a single ray's echo has the range of its hit.
  static double white_target_power(const LinkBudget& budget, Workspace& w, double range) noexcept {
    if (range != w.white_target.range) w.white_target = {w.white_target.emitter, range, budget.power(1, 1, range)};
    return w.white_target.power;
  }

  /// Power received from the hits of a bundle, without the range gate [W]. Undefined for misses.
  static void received_power(const LinkBudget& budget, const SubrayDirections& beam, std::size_t first, std::size_t size, Workspace& w,
                             RayBundle::Column& power) noexcept {
    if (size == 1) {
      power[0] = beam.shares[first] * w.hits[0].backscatter * white_target_power(budget, w, w.hits[0].range);
      return;
    }
    for (std::size_t j = 0; j < size; j += simd::lane_count) {
      const simd::Doubles range = simd::generate([&](std::size_t lane) { return w.hits[j + lane].range; });
      const simd::Doubles backscatter = simd::generate([&](std::size_t lane) { return w.hits[j + lane].backscatter; });
      simd::store(budget.power(simd::load<simd::Doubles>(beam.shares[first + j]), backscatter, range), power[j]);
    }
  }

  void intersect(const RayBundle& rays, std::span<Hit> hits) const noexcept {
    if constexpr (BundleTarget<Map>)
      map_->closest(rays, hits);
    else
      for (std::size_t j = 0; j < rays.size; ++j) hits[j] = map_->closest_hit(rays.ray(j)).value_or(Hit{});
  }

  Source source_;
  const Map* map_;
  std::vector<Unit> receivers_;
  std::vector<EmitterConstants> emitters_;  // by number
  std::vector<SubrayDirections> beams_;     // distinct beams of the emitters
  std::uint64_t seed_;
  std::shared_ptr<const void> identity_{new char};  // compiles faster than make_shared
};

}  // namespace pulsecast

#endif
