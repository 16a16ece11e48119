// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_TRANSPORT_DETAIL_MEDIA_PASSAGE_HPP
#define PULSECAST_TRANSPORT_DETAIL_MEDIA_PASSAGE_HPP

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include <pulsecast/base/units.hpp>
#include <pulsecast/scene/media.hpp>
#include <pulsecast/transport/detail/beam_particles.hpp>
#include <pulsecast/transport/detail/light_ledger.hpp>
#include <pulsecast/transport/detail/light_path.hpp>
#include <pulsecast/transport/detail/volume_bins.hpp>
#include <pulsecast/transport/illumination.hpp>

namespace PULSECAST_NAMESPACE::detail {

/// Takes the light of one pulse through media: what they absorb and scatter, and what they send back.
class MediaPassage {
 public:
  /// `air`: media between the surfaces; `least_share` as in `LightPaths`; `in_air`, `in_water`: memory for what media in the air and bodies
  /// send back.
  MediaPassage(const Illumination& light, const Media& air, double least_share, LightLedger& ledger, VolumeBins& in_air,
               VolumeBins& in_water) noexcept
      : light_(light),
        air_(air),
        least_share_(least_share),
        ledger_(ledger),
        in_air_(in_air),
        in_water_(in_water),
        particles_(light, ledger) {
    const double interval = light.sample_interval > 0 ? light.sample_interval : light.emitter.laser.pulse_length / 16;
    in_air_.begin(speed_of_light / 2 * interval);
    in_water_.begin(speed_of_light / 2 * interval);
  }

  /// Names the body that light enters.
  void label_body(ObjectId object, std::uint16_t classification) noexcept {
    in_water_.object = object;
    in_water_.classification = classification;
  }

  /// Takes the rays of a pencil through the air up to their hits: what is lost of each, and what returns of all. `occluded(ray, range)`
  /// tells if a ray meets a surface.
  template <class Occluded>
  void pass_air(Pencil& p, std::span<const Hit> hits, const Occluded& occluded) noexcept {
    if (air_.empty()) return;
    struct End {
      double range, both;
    };
    std::array<End, RayBundle::capacity> ends;
    const std::size_t size = p.rays.size, middle = size / 2;
    double together = 0, passed = 1;  // share of the light on both ways, and what is left of it
    for (std::size_t j = 0; j < size; ++j) {
      ends[j] = {hits[j].met() ? hits[j].range : std::numeric_limits<double>::infinity(), p.both[j]};
      together += p.both[j];
    }
    std::sort(ends.begin(), ends.begin() + static_cast<std::ptrdiff_t>(size), [](const End& a, const End& b) { return a.range < b.range; });
    const bool of_beam = p.passages == 0, meets_particles = of_beam && p.rays.first_subray == 0;
    const double least = least_return() * together;
    std::size_t ended = 0;
    const auto same = [](double s) noexcept { return s; };
    const auto stretch = [&](double from, double to, const MediumRegion& region, double density) noexcept {
      const Medium& medium = region.medium;
      const double loss = density * medium.extinction(), grains = of_beam ? particles_.end(from, to, region, density) : from;
      if (meets_particles && grains > from) particles_.meet(from, grains, region, density, passed, occluded);
      for (double at = from; at < to;) {
        for (; ended < size && !(ends[ended].range > at); ++ended) together -= ends[ended].both;
        if (ended == size) return;
        double end = std::min(to, ends[ended].range);
        if (at < grains) end = std::min(end, grains);
        const VolumeWay way{at, end, together * passed, least, loss, density * medium.backscatter, at + p.delay[middle]};
        if (medium.backscatter > 0 && !(at < grains)) add_volume(in_air_, way, same, same);
        passed *= std::exp(-2 * loss * (end - at));
        at = end;
      }
    };
    air_.along(p.rays.origin, p.rays.direction(middle), p.rays.begin[middle], ends[size - 1].range, stretch);
    for (std::size_t j = 0; j < size; ++j)
      air_.along(p.rays.origin, p.rays.direction(j), p.rays.begin[j], hits[j].range,
                 [&](double from, double to, const MediumRegion& region, double density) noexcept {
                   const double left = lose(region.medium, density, to - from, p.sent[j]);
                   p.sent[j] *= left;
                   p.both[j] *= left * left;
                 });
  }

  /// Takes a path through the media up to its next surface, at a range [m].
  void pass(LightPath& path, double range) noexcept {
    const double least = least_return() * path.both;
    const auto stretch = [&](double from, double to, const Medium& medium, double density, VolumeBins& bins) noexcept {
      if (medium.backscatter > 0) {
        const VolumeWay way{from,
                            to,
                            path.both,
                            least,
                            density * medium.extinction(),
                            density * medium.backscatter,
                            path.optical + from * path.medium().delay(),
                            path.medium().delay()};
        add_volume(
            bins, way, [&](double s) noexcept { return path.spread(s); },
            [&](double s) noexcept { return path.depth == 0 ? path.air + s : path.air; });
      }
      path.keep(lose(medium, density, to - from, path.sent));
    };
    if (path.depth == 0)
      air_.along(path.ray.origin, path.ray.direction, 0, range,
                 [&](double from, double to, const MediumRegion& region, double density) noexcept {
                   stretch(from, to, region.medium, density, in_air_);
                 });
    else
      stretch(0, range, path.medium(), 1, in_water_);
  }

  /// Turns what media sent back into reflections.
  void close() noexcept {
    return_volume(in_air_, ReflectionKind::air);
    return_volume(in_water_, ReflectionKind::water);
  }

 private:
  /// Takes away what a medium absorbs and scatters of light on a way [m]. Returns the share that is left.
  double lose(const Medium& medium, double density, double way, double sent) noexcept {
    const double per_metre = density * medium.extinction(), left = per_metre > 0 ? std::exp(-per_metre * way) : 1;
    if (per_metre > 0) {
      const double lost = (1 - left) * sent / medium.extinction();
      ledger_.shares.absorbed += lost * medium.absorption;
      ledger_.shares.scattered += lost * medium.scattering;
    }
    return left;
  }

  /// Way of light that a medium scatters back.
  struct VolumeWay {
    double from = 0, to = 0;  ///< ends of the stretch, from where `spread` counts [m]
    double both = 0;          ///< as in `Pencil`, at its beginning
    double least = 0;         ///< least of it of which the return counts
    double extinction = 0;    ///< of the medium [1/m]
    double backscatter = 0;   ///< of the medium [1/(m sr)]
    double optical = 0;       ///< optical path up to its beginning [m]
    double delay = 1;         ///< optical path by way
  };
  /// Adds what returns from a stretch. `spread(s)` is the range by which light spreads up to s, `air(s)` the way in air [m].
  template <class Spread, class Air>
  void add_volume(VolumeBins& bins, const VolumeWay& way, const Spread& spread, const Air& air) noexcept {
    const double white = pi * way.backscatter, tooth = bins.spacing() / way.delay, aperture = light_.budget.aperture_radius();
    double both = way.both;
    double step = 0, left = 1, length = 0;
    for (double at = way.from; at < way.to && both > way.least;) {
      const double wide2 = spread(at) * spread(at) + aperture * aperture;
      const double next = std::min(way.to - at, wide2 < 100 * tooth * tooth ? 0.1 * std::sqrt(wide2) : tooth);
      if (next != step) {
        step = next;
        left = std::exp(-2 * way.extinction * step);
        length = way.extinction > 0 ? (1 - left) / (2 * way.extinction) : step;
      }
      const double middle = at + step / 2;
      const double range = way.optical + way.delay * (middle - way.from);
      if (range > light_.gate.far) return;
      if (light_.gate.contains(range)) bins.add(range, light_.budget.power_through(both, white * length, spread(middle), air(middle)));
      both *= left;
      at += step;
    }
  }
  /// Share of light to and fro, of that with which it begins a way, below which what media send back is left out.
  [[nodiscard]] double least_return() const noexcept { return std::max(1e-9, least_share_ * least_share_); }

  /// Turns what a medium sent back into reflections.
  void return_volume(const VolumeBins& bins, ReflectionKind kind) noexcept {
    bins.visit([&](double range, double power) noexcept {
      ledger_.reflect({.range = range, .object = bins.object, .classification = bins.classification}, power, {kind});
    });
  }

  const Illumination& light_;
  const Media& air_;
  double least_share_;
  LightLedger& ledger_;
  VolumeBins &in_air_, &in_water_;
  BeamParticles particles_;
};

}  // namespace PULSECAST_NAMESPACE::detail

#endif
