// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_TRANSPORT_DETAIL_SCATTERED_PATHS_HPP
#define PULSECAST_TRANSPORT_DETAIL_SCATTERED_PATHS_HPP

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include <pulsecast/base/random.hpp>
#include <pulsecast/base/units.hpp>
#include <pulsecast/concepts.hpp>
#include <pulsecast/scene/media.hpp>
#include <pulsecast/transport/detail/light_ledger.hpp>
#include <pulsecast/transport/detail/light_path.hpp>
#include <pulsecast/transport/illumination.hpp>

namespace PULSECAST_NAMESPACE {

/// Light that is scattered more than once before it returns.
struct MultipleScattering {
  std::size_t orders = 1;     ///< greatest number of surfaces that scatter it, from 1 to 64; 1: none of it
  std::size_t paths = 8;      ///< number of random paths of a pulse, from 1 to 100,000
  double field_of_view = pi;  ///< full angle about the beam's axis that the receiver sees, from 0 to 2 pi [rad]

  void validate() const {
    require_within("MultipleScattering::orders", static_cast<double>(orders), 1, 64, "");
    require_within("MultipleScattering::paths", static_cast<double>(paths), 1, 100'000, "");
    require_within("MultipleScattering::field_of_view", field_of_view, 0, 2 * pi * (1 + 1e-9), "rad");
  }
  /// Number of reflections that it may add to a pulse.
  [[nodiscard]] std::size_t reflections() const noexcept { return (orders - 1) * paths; }
};

namespace detail {

/// Follows light from surface to surface at random, and at each takes what returns straight to the receiver.
/// Source: next-event estimation, Coveyou, Cain & Yost 1967; cosine-weighted directions by the disk, Shirley & Chiu 1997.
template <OpticalTarget Map>
class ScatteredPaths {
 public:
  ScatteredPaths(const Map& map, const Illumination& light, const Media& air, const MultipleScattering& settings,
                 LightLedger& ledger) noexcept
      : map_(map), light_(light), air_(air), settings_(settings), ledger_(ledger) {}

  /// Continues some of the subrays of a pencil from the beam, that met these surfaces: as many as their share of all paths.
  void start(const Pencil& p, std::span<const Hit> hits, std::span<const HitSurface> surfaces) noexcept {
    if (settings_.orders < 2) return;
    const auto paths = static_cast<double>(settings_.paths);
    for (std::size_t j = 0; j < p.rays.size; ++j) {
      const double share = light_.beam.shares[p.rays.first_subray + j];
      passed_ += share;
      // the k-th path belongs to the subray in which the sum of shares reaches (k + u) / paths
      for (; next_ < settings_.paths && (static_cast<double>(next_) + draw(next_, 0)[0]) / paths < passed_; ++next_) {
        if (!hits[j].met() || !(share > 0) || surfaces[j].material->smooth.passes_light()) continue;
        const Vec3 direction = p.rays.direction(j);
        follow({p.rays.origin + hits[j].range * direction, direction, surfaces[j].normal, surfaces[j].material, p.sent[j] / (share * paths),
                hits[j].range},
               next_);
      }
    }
  }

 private:
  /// Light that arrives at a surface.
  struct Arrival {
    Vec3 place{}, direction{};
    Vec3 normal{};  ///< either side
    const Material* material = nullptr;
    double share = 0;  ///< share of the pulse's energy
    double way = 0;    ///< length of the way so far [m]
  };

  std::array<double, 2> draw(std::size_t path, std::uint32_t order) const noexcept {
    const auto words = random_words({light_.seed, light_.index, static_cast<std::uint32_t>(path), Purpose::scattering, order});
    return {(words[0] + 0.5) * 0x1p-32, (words[1] + 0.5) * 0x1p-32};
  }

  void follow(Arrival at, std::size_t path) noexcept {
    for (std::size_t order = 2; order <= settings_.orders; ++order) {
      at.share *= at.material->scattered_share(light_.emitter.laser.wavelength);
      if (!(at.share > 0)) return;
      const bool leaf = at.normal == Vec3{};
      const auto [u, v] = draw(path, static_cast<std::uint32_t>(order - 1));
      const Ray ray{.origin = at.place,
                    .direction = leaf ? evenly(u, v) : by_cosine(towards(at.normal, at.direction), u, v),
                    .near = apart,
                    .tick = light_.pulse.tick,
                    .seed = light_.seed,
                    .pulse = light_.index,
                    .subray = 0x8000'0000U | static_cast<std::uint32_t>(path * settings_.orders + order)};
      const auto hit = map_.closest_hit(ray);
      if (!hit) return;
      const auto next = map_.surface(*hit, ray);
      at = {next.position,      ray.direction, next.normal, next.material, at.share * left(ray.origin, ray.direction, hit->range),
            at.way + hit->range};
      if (at.material->smooth.passes_light()) return;
      return_from(at, next.object, next.classification);
    }
  }

  /// Adds what returns to the receiver from a surface.
  void return_from(const Arrival& at, ObjectId object, std::uint16_t classification) noexcept {
    const Vec3 exit = light_.pulse.origin(), back = exit - at.place;
    const double distance = length(back);
    const Vec3 direction = back / distance;
    const double seen = -dot(light_.pulse.pose.rotation * axis::forward, direction);
    if (!(seen >= std::cos(settings_.field_of_view / 2))) return;
    const bool leaf = at.normal == Vec3{};
    const double cosine = leaf ? 0.25 : dot(towards(at.normal, at.direction), direction);  // a leaf scatters into the whole sphere
    const double scattered = at.material->scattered_share(light_.emitter.laser.wavelength) * cosine;
    if (!(scattered > 0)) return;
    Ray ray{
        .origin = at.place, .direction = direction, .near = apart, .tick = light_.pulse.tick, .seed = light_.seed, .pulse = light_.index};
    ray.subray = 0xC000'0000U | next_shadow_++;
    if (map_.occluded(ray, distance)) return;
    const double both_ways = (at.way + distance) / 2;
    const double power = light_.budget.power_through(at.share * left(at.place, direction, distance), scattered, distance, both_ways);
    if (!(power > 0) || !light_.gate.contains(both_ways)) return;
    const Hit hit{.range = both_ways, .cos_incidence = leaf ? 1 : cosine, .object = object, .classification = classification};
    ledger_.reflect(hit, power, {ReflectionKind::multiple});
  }

  /// Share of the light that the media leave over on a way [m].
  double left(const Vec3& origin, const Vec3& direction, double way) const noexcept {
    double depth = 0;
    air_.along(origin, direction, 0, way,
               [&](double from, double to, const Medium& m, double density) noexcept { depth += density * m.extinction() * (to - from); });
    return depth > 0 ? std::exp(-depth) : 1;
  }

  static Vec3 evenly(double u, double v) noexcept {
    const double z = 1 - 2 * u, r = std::sqrt(std::max(0.0, 1 - z * z));
    return {r * std::cos(2 * pi * v), r * std::sin(2 * pi * v), z};
  }
  static Vec3 by_cosine(const Vec3& normal, double u, double v) noexcept {
    const Vec3 aside = normalize(cross(normal, std::fabs(normal.z) < 0.9 ? axis::up : axis::right)), other = cross(normal, aside);
    const double r = std::sqrt(u);
    return normalize(r * std::cos(2 * pi * v) * aside + r * std::sin(2 * pi * v) * other + std::sqrt(std::max(0.0, 1 - u)) * normal);
  }

  const Map& map_;
  const Illumination& light_;
  const Media& air_;
  const MultipleScattering& settings_;
  LightLedger& ledger_;
  double passed_ = 0;     ///< shares of the subrays so far
  std::size_t next_ = 0;  ///< next path
  std::uint32_t next_shadow_ = 0;
};

}  // namespace detail

}  // namespace PULSECAST_NAMESPACE

#endif
