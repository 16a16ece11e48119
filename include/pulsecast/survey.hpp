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

/// Simulation as a pure function from a pulse index to echoes. Immutable, so that pulses may be requested in any order and from any number
/// of threads. Refers to the map, which must outlive it.
template <WorldSource Source, Footprint Pattern, Target Map, Detector Instrument>
class Survey {
 public:
  /// @throws SettingError for settings out of range, footprint shares that do not sum to one, or a laser that the detector refuses
  Survey(Source source, Pattern footprint, const Map& map, Receiver receiver, Instrument detector, std::uint64_t seed = 0)
      : source_(validated(std::move(source))),
        footprint_(validated(std::move(footprint))),
        map_(&map),
        receiver_(validated(receiver)),
        detector_(validated(std::move(detector))),
        seed_(seed) {
    require_whole_beam();
    if constexpr (requires(const Laser& laser) { detector_.validate(laser); }) require_lasers();
  }

  Survey(Source, Pattern, const Map&&, Receiver, Instrument, std::uint64_t = 0) = delete;  // a temporary map would dangle

  /// Directions, shares and exits of the subrays in the beam's frame, by number, padded to whole SIMD vectors.
  struct SubrayDirections {
    std::vector<double> x, y, z;  ///< components of the unit directions
    std::vector<double> shares;   ///< shares of the energy
    std::vector<Vec3> exits;      ///< exit points; not set for a beam from a point [m]
  };

  /// Scratch memory of one worker, with values cached between pulses.
  struct Workspace {
    Laser laser;                                                        ///< laser of `budget` and `directions`
    LinkBudget budget;                                                  ///< link budget of that laser
    SubrayDirections directions;                                        ///< directions for that laser
    std::array<Hit, RayBundle::capacity> hits;                          ///< hits of a bundle
    std::vector<Reflection> reflections;                                ///< reflections of a pulse, with room for all subrays
    std::vector<SubrayHit> subrays;                                     ///< all of a pulse, if recorded
    decltype(std::declval<const Instrument&>().workspace(0)) detector;  ///< workspace of the detector
    struct {
      double range = -1;  ///< last range requested [m]
      double power = 0;   ///< power received from a white target there [W]
    } white_target{};     ///< last result of `white_target_power`
  };

  /// Scratch memory for one worker.
  [[nodiscard]] Workspace workspace() const {
    const Laser laser{};
    const std::size_t n = footprint_.size();
    const std::vector<double> column(n + RayBundle::lanes);
    Workspace w{laser,
                {receiver_, laser},
                {column, column, column, column, std::vector<Vec3>(n)},
                {},
                std::vector<Reflection>(n),
                std::vector<SubrayHit>(recorded_subrays()),
                detector_.workspace(n)};
    for (std::size_t j = 0; j < n; ++j) w.directions.shares[j] = footprint_.share(j);
    fill_subrays(laser, w.directions);
    return w;
  }

  [[nodiscard]] PulseIndex size() const noexcept { return source_.size(); }
  /// Subrays of a pulse.
  [[nodiscard]] std::size_t subrays() const noexcept { return footprint_.size(); }
  [[nodiscard]] std::size_t recorded_subrays() const noexcept { return recorded ? subrays() : 0; }  ///< subrays passed on with each pulse
  /// Source of the pulses.
  [[nodiscard]] const Source& source() const noexcept { return source_; }
  /// Detector.
  [[nodiscard]] const Instrument& detector() const noexcept { return detector_; }

  /// Sample spacing of a waveform; 0 if the detector has none [s].
  [[nodiscard]] double sample_interval() const noexcept {
    if constexpr (requires { detector_.sample_interval(); })
      return detector_.sample_interval();
    else
      return 0;
  }

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
    out.shot.channel = pulse->channel;

    if (pulse->laser != w.laser) adapt_to(pulse->laser, w);
    const EnergyByFate by_fate = trace(*pulse, reported, w);
    out.energy = pulse->laser.peak_power * pulse->laser.pulse_length;
    out.subrays = w.subrays;
    out.shares[static_cast<std::size_t>(Fate::missed)] = by_fate.missed;
    out.shares[static_cast<std::size_t>(Fate::out_of_range)] = by_fate.out_of_range;
    out.shares[static_cast<std::size_t>(Fate::absorbed)] = by_fate.absorbed;
    out.hits = by_fate.hits;
    if (by_fate.reflections == 0) {
      out.shot.fate = by_fate.any_in_gate ? Fate::absorbed : by_fate.hits > 0 ? Fate::out_of_range : Fate::missed;
      return out;
    }

    const Detection detection = detect(pulse->laser, i, {w.reflections.data(), by_fate.reflections}, w.detector);
    for (Echo& echo : detection.echoes) {
      echo.reflectance = echo.amplitude / white_target_power(w, echo.range);
      if (!receiver_.range_errors.none())
        echo.range += receiver_.range_errors.at(echo.range, echo.cos_incidence, normal({seed_, i, echo.number, Purpose::range_noise}));
    }
    if (detection.echoes.size() > 1 && !receiver_.range_errors.none()) sort_by_range(detection.echoes);
    out.echoes = detection.echoes;
    out.waveform = detection.waveform;
    out.shot.waveform_start = detection.waveform_start;
    out.shot.fate = detection.echoes.empty() ? Fate::below_threshold : Fate::returned;
    out.shares[static_cast<std::size_t>(out.shot.fate)] = by_fate.reflected;
    return out;
  }

 private:
  using Scratch = decltype(Workspace::detector);

  /// Refuses a footprint whose shares do not sum to the whole beam.
  void require_whole_beam() const {
    double sum = 0;
    for (std::size_t j = 0; j < footprint_.size(); ++j) {
      const double share = footprint_.share(j);
      require_not_negative("Footprint::share", share, "");
      require_finite("Footprint::offset (length)", length(footprint_.offset(j)), "");
      sum += share;
    }
    require_within("Footprint::share (sum)", sum, 1 - 1e-6, 1 + 1e-6, "");  // tolerates the rounding of a sum of a million
  }

  /// Refuses a laser that the detector refuses, as sampled: the first slots, of every channel, and some at random numbers.
  void require_lasers() const {
    constexpr PulseIndex first = 256;
    for (PulseIndex k = 0; k < 2 * first && k < size(); ++k) {
      const PulseIndex i = k < first ? k : static_cast<PulseIndex>(uniform({.pulse = k}) * static_cast<double>(size()));
      if (const auto pulse = source_.pulse(i)) detector_.validate(pulse->laser);
    }
  }

  [[nodiscard]] Detection detect(const Laser& laser, PulseIndex i, std::span<Reflection> reflections, Scratch& scratch) const noexcept {
    const RandomKey key{.seed = seed_, .pulse = i};
    if constexpr (requires { detector_.detect(laser, reflections, scratch, key); })
      return detector_.detect(laser, reflections, scratch, key);
    else
      return detector_.detect(laser, reflections, scratch);
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

  void fill_subrays(const Laser& laser, SubrayDirections& directions) const noexcept {
    for (std::size_t j = 0; j < footprint_.size(); ++j) {
      const Vec3 direction = subray_direction(footprint_.offset(j), laser.divergence);
      directions.x[j] = direction.x;
      directions.y[j] = direction.y;
      directions.z[j] = direction.z;
      if (!laser.from_a_point()) directions.exits[j] = subray_exit(footprint_.offset(j), laser);
    }
  }

  void adapt_to(const Laser& laser, Workspace& w) const noexcept {
    if (laser.divergence != w.laser.divergence || laser.waist_diameter != w.laser.waist_diameter ||
        laser.waist_range != w.laser.waist_range)
      fill_subrays(laser, w.directions);
    w.budget = LinkBudget(receiver_, laser);
    w.white_target = {};
    w.laser = laser;
  }

  /// Shares of a pulse's energy by fate, and counts of its subrays.
  struct EnergyByFate {
    double missed = 0, out_of_range = 0, absorbed = 0, reflected = 0;
    std::size_t hits = 0, reflections = 0;
    bool any_in_gate = false;
  };

  /// Traces all subrays; sets the reflections, and the subrays if they are recorded.
  EnergyByFate trace(const Pulse<frame::World>& pulse, const Pose<frame::Beam, frame::World>& reported, Workspace& w) const noexcept {
    EnergyByFate by_fate;
    RayBundle rays;
    rays.origin = pulse.origin();
    rays.wavelength = pulse.laser.wavelength;
    rays.tick = pulse.tick;
    rays.seed = seed_;
    rays.pulse = pulse.index;
    const Matrix3 world_from_beam = matrix_of(pulse.pose.rotation);
    const bool from_a_point = pulse.laser.from_a_point();
    const std::size_t subrays = footprint_.size();
    RayBundle::Column power;
    for (std::size_t first = 0; first < subrays; first += rays.size) {
      rays.first_subray = static_cast<std::uint32_t>(first);
      rays.size = std::min(from_a_point ? RayBundle::capacity : 1, subrays - first);
      if (!from_a_point) rays.origin = pulse.origin() + world_from_beam * w.directions.exits[first];
      to_world(world_from_beam, w.directions, first, rays);
      intersect(rays, w.hits);
      received_power(w, first, rays.size, power);
      for (std::size_t j = 0; j < rays.size; ++j) {
        const Hit& hit = w.hits[j];
        const double share = w.directions.shares[first + j];
        if constexpr (recorded) {
          const Vec3 exit = from_a_point ? Vec3{} : w.directions.exits[first + j];
          const Vec3 direction{w.directions.x[first + j], w.directions.y[first + j], w.directions.z[first + j]};
          w.subrays[first + j] = {hit, 0, hit.met() ? reported.point(exit + hit.range * direction) : Vec3{}};
        }
        if (!hit.met()) {
          by_fate.missed += share;
          continue;
        }
        ++by_fate.hits;
        if (!receiver_.in_gate(hit.range)) {
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

  /// Sets the directions of a bundle from those of subrays `first` on.
  static void to_world(const Matrix3& world_from_beam, const SubrayDirections& directions, std::size_t first, RayBundle& rays) noexcept {
    const Vec3 across = world_from_beam[0], ahead = world_from_beam[1], above = world_from_beam[2];
    for (std::size_t j = 0; j < rays.size; j += simd::lane_count) {
      const simd::Doubles x = simd::load<simd::Doubles>(directions.x[first + j]), y = simd::load<simd::Doubles>(directions.y[first + j]),
                          z = simd::load<simd::Doubles>(directions.z[first + j]);
      simd::store(simd::Doubles(x * across.x + y * ahead.x + z * above.x), rays.x[j]);
      simd::store(simd::Doubles(x * across.y + y * ahead.y + z * above.y), rays.y[j]);
      simd::store(simd::Doubles(x * across.z + y * ahead.z + z * above.z), rays.z[j]);
    }
    rays.pad();
  }

  /// Power received from a white Lambertian target facing the beam at `range` [W]. Cached: a single ray's echo has the range of its hit.
  static double white_target_power(Workspace& w, double range) noexcept {
    if (range != w.white_target.range) w.white_target = {range, w.budget.power(1, 1, range)};
    return w.white_target.power;
  }

  /// Power received from the hits of a bundle, without the range gate [W]. Undefined for misses.
  static void received_power(Workspace& w, std::size_t first, std::size_t size, RayBundle::Column& power) noexcept {
    if (size == 1) {
      power[0] = w.directions.shares[first] * w.hits[0].backscatter * white_target_power(w, w.hits[0].range);
      return;
    }
    for (std::size_t j = 0; j < size; j += simd::lane_count) {
      const simd::Doubles range = simd::generate([&](std::size_t lane) { return w.hits[j + lane].range; });
      const simd::Doubles backscatter = simd::generate([&](std::size_t lane) { return w.hits[j + lane].backscatter; });
      simd::store(w.budget.power(simd::load<simd::Doubles>(w.directions.shares[first + j]), backscatter, range), power[j]);
    }
  }

  void intersect(const RayBundle& rays, std::span<Hit> hits) const noexcept {
    if constexpr (BundleTarget<Map>)
      map_->closest(rays, hits);
    else
      for (std::size_t j = 0; j < rays.size; ++j) hits[j] = map_->closest_hit(rays.ray(j)).value_or(Hit{});
  }

  Source source_;
  Pattern footprint_;
  const Map* map_;
  Receiver receiver_;
  Instrument detector_;
  std::uint64_t seed_;
  std::shared_ptr<const void> identity_{new char};  // compiles faster than make_shared
};

}  // namespace pulsecast

#endif
