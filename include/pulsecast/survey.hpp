// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <pulsecast/base/random.hpp>
#include <pulsecast/concepts.hpp>
#include <pulsecast/detector/radiometry.hpp>
#include <pulsecast/scanner/footprint.hpp>

namespace pulsecast {

/// What came of one pulse slot. The spans stay valid until the workspace is used again; the shot's places in a batch are not set.
struct Outcome {
  Shot shot;
  std::span<const Echo> echoes;
  std::span<const float> waveform;
  std::size_t hits = 0;  ///< subrays that met something
};

/// The whole of a simulation, as a pure function from a pulse index to echoes. Made once; from then on nothing in it changes, so that
/// pulses may be asked for in any order and from any number of threads. The map is referred to, not copied, and must live as long.
template <WorldSource Source, Footprint Pattern, Target Map, Detector Instrument>
class Survey {
 public:
  Survey(Source source, Pattern footprint, const Map& map, Receiver receiver, Instrument detector, std::uint64_t seed = 0)
      : source_(validated(std::move(source))),
        footprint_(validated(std::move(footprint))),
        map_(&map),
        receiver_(validated(receiver)),
        detector_(validated(std::move(detector))),
        seed_(seed) {}

  Survey(Source, Pattern, const Map&&, Receiver, Instrument, std::uint64_t = 0) = delete;  // a temporary map would be gone

  /// The scratch memory of one worker, and what need not be computed again from pulse to pulse.
  struct Workspace {
    Laser laser;  ///< that `budget` and `fan` are made for
    LinkBudget budget;
    std::vector<Vec3> fan;  ///< directions of the subrays in the frame of the beam
    std::vector<Hit> hits;  ///< of a bundle
    std::vector<Reflection> reflections;
    decltype(std::declval<const Instrument&>().workspace(0)) detector;
  };

  [[nodiscard]] Workspace workspace() const {
    const Laser laser{};
    const std::size_t n = footprint_.size();
    Workspace w{laser, {receiver_, laser}, std::vector<Vec3>(n), std::vector<Hit>(RayBundle::capacity), {}, detector_.workspace(n)};
    spread(w.fan, laser.divergence);
    w.reflections.reserve(n);
    return w;
  }

  [[nodiscard]] PulseIndex size() const noexcept { return source_.size(); }
  [[nodiscard]] std::size_t subrays() const noexcept { return footprint_.size(); }
  [[nodiscard]] const Source& source() const noexcept { return source_; }
  [[nodiscard]] const Instrument& detector() const noexcept { return detector_; }

  /// Between two samples of a waveform; 0 if the detector has none [s].
  [[nodiscard]] double sample_interval() const noexcept {
    if constexpr (requires { detector_.sample_interval(); })
      return detector_.sample_interval();
    else
      return 0;
  }

  /// What pulse i brings back.
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
    out.shot.origin = reported.position, out.shot.direction = reported.direction(forward);
    out.shot.scan_angle = pulse->scan_angle;
    out.shot.leg = pulse->leg, out.shot.channel = pulse->channel;

    if (pulse->laser != w.laser) make_for(pulse->laser, w);
    out.hits = trace(*pulse, w);
    if (w.reflections.empty()) {
      out.shot.fate = out.hits > 0 ? Fate::out_of_range : Fate::missed;
      return out;
    }

    const Detection detection = detector_.detect(pulse->laser, w.reflections, w.detector);
    for (Echo& echo : detection.echoes) {
      echo.reflectance = echo.amplitude / w.budget.power(1, 1, echo.range);
      if (!receiver_.range_errors.none())
        echo.range += receiver_.range_errors.at(echo.range, echo.cos_incidence, normal({seed_, i, echo.number, Purpose::range_noise}));
    }
    out.echoes = detection.echoes;
    out.waveform = detection.waveform;
    out.shot.waveform_start = detection.waveform_start;
    out.shot.fate = detection.echoes.empty() ? Fate::below_threshold : Fate::returned;
    return out;
  }

 private:
  /// Sets the directions of the subrays for a divergence [rad].
  void spread(std::span<Vec3> fan, double divergence) const noexcept {
    for (std::size_t j = 0; j < fan.size(); ++j) fan[j] = subray_direction(footprint_.offset(j), divergence);
  }

  void make_for(const Laser& laser, Workspace& w) const noexcept {
    if (laser.divergence != w.laser.divergence) spread(w.fan, laser.divergence);
    w.budget = LinkBudget(receiver_, laser);
    w.laser = laser;
  }

  /// Fills in the reflections that pass the range gate; returns how many subrays met anything.
  std::size_t trace(const Pulse<frame::World>& pulse, Workspace& w) const noexcept {
    w.reflections.clear();
    std::size_t met = 0;
    RayBundle rays;
    rays.origin = pulse.origin();
    rays.wavelength = pulse.laser.wavelength, rays.tick = pulse.tick, rays.seed = seed_, rays.pulse = pulse.index;
    const Matrix3 world_from_beam = matrix_of(pulse.pose.rotation);
    for (std::size_t first = 0; first < w.fan.size(); first += rays.size) {
      rays.first_subray = static_cast<std::uint32_t>(first);
      rays.size = std::min(RayBundle::capacity, w.fan.size() - first);
      for (std::size_t j = 0; j < rays.size; ++j) rays.set_direction(j, world_from_beam * w.fan[first + j]);
      rays.pad();
      ask(rays, w.hits);
      for (std::size_t j = 0; j < rays.size; ++j) {
        const Hit& hit = w.hits[j];
        if (!hit.met()) continue;
        ++met;
        if (receiver_.in_gate(hit.range))
          w.reflections.push_back({hit.range, w.budget.power(footprint_.share(first + j), hit.backscatter, hit.range), hit.object,
                                   hit.classification, hit.cos_incidence});
      }
    }
    return met;
  }

  void ask(const RayBundle& rays, std::span<Hit> hits) const noexcept {
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
};

}  // namespace pulsecast
