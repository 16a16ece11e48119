// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_TRANSPORT_DETAIL_MEDIA_PASSAGE_HPP
#define PULSECAST_TRANSPORT_DETAIL_MEDIA_PASSAGE_HPP

#include <pulsecast/transport/detail/beam_particles.hpp>
#include <pulsecast/transport/detail/light_path.hpp>
#include <pulsecast/transport/detail/volume_profile.hpp>

namespace PULSECAST_NAMESPACE::detail {

/// Takes the light of a pulse through media: what they absorb, scatter and send back.
class MediaPassage {
 public:
  /// `air`: media between the surfaces; `share_min` as in `LightPaths`; others are memory.
  MediaPassage(const TransportInput& light, const Media& air, double share_min, LightLedger& ledger,
               VolumeProfile& in_air, VolumeProfile& in_water, std::vector<ContinuousReturn>& returns) noexcept
      : light_(light),
        air_(air),
        share_min_(share_min),
        ledger_(ledger),
        in_air_(in_air),
        in_water_(in_water),
        returns_(returns),
        pulse_(speed_of_light / 2 * light.emitter.laser.pulse_length),
        particles_(light, ledger) {
    in_air_.begin(light.budget.aperture_radius(), pulse_, light.gate);
    in_water_.begin(light.budget.aperture_radius(), pulse_, light.gate);
  }

  /// Names the body that light enters.
  void label_body(ObjectId object, std::uint16_t classification) noexcept {
    in_water_.object = object;
    in_water_.classification = classification;
  }

  /// Takes rays through the air up to their hits: what is lost of each, and what returns of all.
  /// `occluded(ray, range)` tells if a ray meets a surface.
  void pass_air(CoaxialRays& p, std::span<const Hit> hits, const auto& occluded) noexcept {
    if (air_.empty()) return;
    struct End {
      double range, two_way_share;
    };
    std::array<End, RayBundle::capacity> ends;
    const std::size_t size = p.rays.size, middle = size / 2;
    double together = 0, passed = 1;  // share of the light on both ways, and what is left of it
    for (std::size_t j = 0; j < size; ++j) {
      ends[j] = {hits[j].met() ? hits[j].range : std::numeric_limits<double>::infinity(), p.two_way_share[j]};
      together += p.two_way_share[j];
    }
    std::sort(ends.begin(), ends.begin() + static_cast<std::ptrdiff_t>(size),
              [](const End& a, const End& b) { return a.range < b.range; });
    const double resolution = pulse_ / 32;
    for (std::size_t j = 0, next = 0; j < size; j = next) {  // that end together
      double two_way_share = 0, moment = 0;
      for (next = j; next < size && ends[next].range - ends[j].range < resolution; ++next) {
        two_way_share += ends[next].two_way_share;
        moment += ends[next].two_way_share * (ends[next].range - ends[j].range);
      }
      const double mean = two_way_share > 0 ? ends[j].range + moment / two_way_share : ends[j].range;
      for (std::size_t k = j; k < next; ++k) ends[k].range = mean;
      next = std::max(next, j + 1);  // of rays without end
    }
    const bool of_beam = p.passages == 0, meets_particles = of_beam && p.rays.first_subray == 0;
    const double least = least_return() * together;
    std::size_t ended = 0;
    const auto same = [](double s) noexcept { return s; };
    const auto stretch = [&](double from, double to, const MediumRegion& region, double density) noexcept {
      const Medium& medium = region.medium;
      const double loss = density * medium.extinction();
      const double grains = of_beam ? particles_.end(from, to, region, density) : from;
      if (meets_particles && grains > from) particles_.meet(from, grains, region, density, passed, occluded);
      for (double at = from; at < to;) {
        for (; ended < size && !(ends[ended].range > at); ++ended) together -= ends[ended].two_way_share;
        if (ended == size) return;
        double end = std::min(to, ends[ended].range);
        if (at < grains) end = std::min(end, grains);
        const bool straight = of_beam && at == 0 && p.rays.begin[middle] == 0;
        const VolumeSegment way{
            at, end, together * passed, least, loss, density * medium.backscatter, at + p.delay[middle], 1, straight};
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
                   p.two_way_share[j] *= left * left;
                 });
  }

  /// Takes a path through the media up to its next surface, at a range [m].
  void pass(LightPath& path, double range) noexcept {
    const double least = least_return() * path.two_way_share;
    const auto stretch = [&](double from, double to, const Medium& medium, double density,
                             VolumeProfile& bins) noexcept {
      if (medium.backscatter > 0) {
        const VolumeSegment way{from,
                                to,
                                path.two_way_share,
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

  /// Puts what media sent back in order of range.
  [[nodiscard]] std::span<const ContinuousReturn> close() noexcept {
    const std::size_t from_air = in_air_.write_to(returns_, 0, ReflectionKind::air);
    const std::size_t count = in_water_.write_to(returns_, from_air, ReflectionKind::water);
    const std::span<ContinuousReturn> all = std::span(returns_).first(count);
    if (count == from_air) return all;
    in_air_.forget();
    if (from_air > 0)
      std::sort(all.begin(), all.end(), [](const ContinuousReturn& one, const ContinuousReturn& other) {
        return one.begin != other.begin ? one.begin < other.begin : one.end < other.end;
      });
    return all;
  }

 private:
  /// Takes away what a medium absorbs and scatters on a way [m]. Returns the share that is left.
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
  struct VolumeSegment {
    double from = 0, to = 0;   ///< ends of the stretch, from where `spread` counts [m]
    double two_way_share = 0;  ///< as in `CoaxialRays`, at its beginning
    double least = 0;          ///< least of it of which the return counts
    double extinction = 0;     ///< of the medium [1/m]
    double backscatter = 0;    ///< of the medium [1/(m sr)]
    double optical = 0;        ///< optical path up to its beginning [m]
    double delay = 1;          ///< optical path by way
    bool straight = false;     ///< true if all of the way so far was through the medium
  };
  /// Adds returns of a stretch. `spread(s)`: range of its spread; `air(s)`: way in air [m].
  ///
  /// Between nodes, power by range is a chord, which is above the curve by 1/12 of its bend in the
  /// mean. Nodes are lowered by that: f'' h^2 / 12, for f as exp(-k s) / (s^2 + a^2).
  void add_volume(VolumeProfile& profile, const VolumeSegment& way, const auto& spread, const auto& air) noexcept {
    const double aperture2 = light_.budget.aperture_radius() * light_.budget.aperture_radius(),
                 white = pi * way.backscatter / way.delay;
    const double loss = 2 * way.extinction + light_.budget.loss(), most = loss > 0 ? loss_step / loss : infinity;
    const auto density_at = [&](double at, double two_way_share) noexcept {
      const double s = spread(at), square = s * s + aperture2, wide = std::sqrt(square);
      const double h = std::min(VolumeProfile::step(wide, pulse_), most), x = loss * h, y = h / wide;
      const double bend = x * x + 4 * x * y * s / wide + y * y * (8 * s * s / square - 2);
      return light_.budget.power_through(two_way_share, white, s, air(at)) * (1 - bend / 12);
    };
    const auto range_at = [&](double at) noexcept { return way.optical + way.delay * (at - way.from); };
    const auto place_of = [&](double range) noexcept { return way.from + (range - way.optical) / way.delay; };
    const double begin = std::max(way.from, place_of(light_.gate.near));
    double end = std::min(way.to, place_of(light_.gate.far));
    if (way.extinction > 0 && way.least > 0)
      end = std::min(end, way.from + std::log(way.two_way_share / way.least) / (2 * way.extinction));
    if (!(begin < end)) return;
    double two_way_share = way.two_way_share * std::exp(-2 * way.extinction * (begin - way.from));
    double density = density_at(begin, two_way_share);
    std::size_t cell = profile.cell_of(range_at(begin));
    bool at_node = range_at(begin) == 0;
    for (double at = begin; at < end;) {
      if (at_node && way.straight &&
          add_straight(profile, way, end, most, density_at, cell, at, two_way_share, density))
        continue;
      const double node = cell + 1 < VolumeProfile::cells ? place_of(profile.end_of(cell)) : infinity;
      const double to = std::min(node, end), s = spread(at), wide = std::sqrt(s * s + aperture2);
      const double widest = std::min(most, 1.2 * VolumeProfile::step(wide, pulse_));
      const bool whole = to - at <= widest;
      const double next = whole ? to : to < infinity ? at + (to - at) / std::ceil((to - at) / widest) : at + widest;
      two_way_share *= std::exp(-2 * way.extinction * (next - at));
      const double then = density_at(next, two_way_share);
      if (at_node && whole && to == node)
        ledger_.receive(profile.add(cell, density, then));
      else if (next > at)
        ledger_.receive(profile.add(range_at(at), range_at(next), density, then));
      at_node = next == node;
      if (at_node) ++cell;
      at = next;
      density = then;
    }
  }
  /// Adds the next whole cells of a straight way, from a node up to an end [m], while they are no
  /// wider than `most` [m]; false if there are none.
  bool add_straight(VolumeProfile& profile, const VolumeSegment& way, double end, double most, const auto& density_at,
                    std::size_t& cell, double& at, double& two_way_share, double& density) noexcept {
    VolumeProfile::Straight& known = profile.straight(light_.budget, way.extinction, way.backscatter);
    const auto node = [&](std::size_t k) noexcept { return k > 0 ? profile.end_of(k - 1) : 0; };
    std::size_t to = profile.cell_of(end);
    if (node(to + 1) <= end) ++to;  // beyond the last node
    for (; known.known <= to; ++known.known) {
      const std::size_t k = known.known;
      known.left[k] = std::exp(-2 * way.extinction * node(k));
      known.density[k] = density_at(node(k), known.left[k]);
      const double mean = k > 0 ? 0.5 * (known.density[k - 1] + known.density[k]) : 0;
      known.power[k] = k > 0 ? known.power[k - 1] + mean * (node(k) - node(k - 1)) : 0;
    }
    to = first_not(to, [&](std::size_t k) { return node(k + 1) - node(k) <= most; });
    if (!(to > cell)) return false;
    ledger_.receive(profile.add(cell, to, way.two_way_share));
    cell = to;
    at = profile.end_of(cell - 1);
    two_way_share = way.two_way_share * known.left[cell];
    density = way.two_way_share * known.density[cell];
    return true;
  }
  /// Share of light to and fro, by that at a way's begin, below which nothing returns.
  [[nodiscard]] double least_return() const noexcept { return std::max(1e-9, share_min_ * share_min_); }

  static constexpr double loss_step = 0.08;  ///< between nodes: power is linear to 0.4 %

  const TransportInput& light_;
  const Media& air_;
  double share_min_;
  LightLedger& ledger_;
  VolumeProfile &in_air_, &in_water_;
  std::vector<ContinuousReturn>& returns_;
  double pulse_;  ///< length of the pulse in range [m]
  BeamParticles particles_;
};

}  // namespace PULSECAST_NAMESPACE::detail

#endif
