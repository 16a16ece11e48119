// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_TRANSPORT_DETAIL_SCATTERED_PATHS_HPP
#define PULSECAST_TRANSPORT_DETAIL_SCATTERED_PATHS_HPP

#include <pulsecast/material/media.hpp>
#include <pulsecast/transport/detail/light_ledger.hpp>
#include <pulsecast/transport/detail/light_path.hpp>
#include <pulsecast/transport/multiple_scattering.hpp>

namespace PULSECAST_NAMESPACE::detail {

/// Follows light from surface to surface at random, and at each takes what returns straight to the
/// receiver. Of foliage's leaves of all directions, light meets each as often as its cosine of
/// incidence says: their normals are by the cosine about its way back, and their mean is the phase
/// function of a turbid medium. Source: next-event estimation, Coveyou, Cain & Yost 1967;
/// directions by the cosine, from a uniform disk; leaves: Ross 1981.
template <SceneQueries Target>
class ScatteredPaths {
 public:
  ScatteredPaths(const Target& target, const TransportInput& light, const Media& air,
                 const MultipleScattering& settings, LightLedger& ledger) noexcept
      : target_(target), light_(light), air_(air), settings_(settings), ledger_(ledger) {}

  /// Continues some of a beam's subrays that met these surfaces, by their share of all paths.
  void start(const CoaxialRays& p, std::span<const Hit> hits, std::span<const PathVertex> surfaces) noexcept {
    if (settings_.orders < 2) return;
    const auto paths = static_cast<double>(settings_.paths);
    for (std::size_t j = 0; j < p.rays.size; ++j) {
      const double share = light_.beam.shares[p.rays.first_subray + j];
      passed_ += share;
      // the k-th path belongs to the subray in which the sum of shares reaches (k + u) / paths
      for (; next_ < settings_.paths && (static_cast<double>(next_) + draw(next_, 0).turn[0]) / paths < passed_;
           ++next_) {
        if (!hits[j].met() || !light_.gate.contains(hits[j].range) || !(share > 0) ||
            surfaces[j].material->smooth.passes_light())
          continue;
        const Vec3 direction = p.rays.direction(j);
        follow({p.rays.origin + hits[j].range * direction, direction, normal_at(surfaces[j], direction, draw(next_, 0)),
                surfaces[j].material, p.sent[j] / (share * paths), hits[j].range, surfaces[j].texture},
               next_);
      }
    }
  }

 private:
  /// Light that arrives at a surface.
  struct Arrival {
    Vec3 place{}, direction{};
    Vec3 normal{};  ///< towards the light; zero for a surface without direction
    const Material* material = nullptr;
    double share = 0;  ///< share of the pulse's energy
    double way = 0;    ///< length of the way so far [m]
    std::optional<Vec2> texture{};
  };

  /// Random numbers of a surface on a path: uniform in [0, 1).
  struct Draw {
    std::array<double, 2> turn;  ///< for the direction in which light goes on
    std::array<double, 2> leaf;  ///< for the normal of the leaf that it meets there
  };
  Draw draw(std::size_t path, std::uint32_t order) const noexcept {
    const auto words =
        random_words({light_.seed, light_.index, static_cast<std::uint32_t>(path), Purpose::scattering, order});
    const auto number = [&](std::size_t k) noexcept { return (words[k] + 0.5) * 0x1p-32; };
    return {{number(0), number(1)}, {number(2), number(3)}};
  }

  /// Normal of a surface that light along a direction meets.
  static Vec3 normal_at(const auto& surface, const Vec3& direction, const Draw& any) noexcept {
    if (surface.normal == Vec3{}) return {};
    return surface.foliage ? by_cosine(-direction, any.leaf[0], any.leaf[1]) : towards(surface.normal, direction);
  }

  void follow(Arrival at, std::size_t path) noexcept {
    const double wavelength = light_.emitter.laser.wavelength;
    for (std::size_t order = 2; order <= settings_.orders; ++order) {
      const Draw any = draw(path, static_cast<std::uint32_t>(order - 1));
      const auto [u, v] = any.turn;
      const bool even = at.normal == Vec3{};
      const auto drawn = at.material->sample(-at.direction, at.normal, u, v);
      Ray ray{.origin = at.place,
              .direction = drawn  ? drawn->direction
                           : even ? evenly(u, v)
                                  : by_cosine(at.normal, u, v),
              .near = surface_epsilon,
              .tick = light_.pulse.tick};
      name(ray);
      const double per_draw =  // inverse density of the directions, by pi
          drawn  ? 1 / (pi * drawn->density)
          : even ? 4
                 : 1 / dot(ray.direction, at.normal);
      at.share *= per_draw * at.material->scattered(-at.direction, ray.direction, at.normal, wavelength, at.texture);
      if (!(at.share > 0)) return;
      const auto hit = target_.closest_hit(ray);
      if (!hit) return;
      const auto next = target_.surface(*hit, ray);
      at = {next.position,
            ray.direction,
            normal_at(next, ray.direction, any),
            next.material,
            at.share * left(ray.origin, ray.direction, hit->range),
            at.way + hit->range,
            next.texture};
      if (at.material->smooth.passes_light()) return;
      return_from(at, next.object, next.classification);
    }
  }

  /// Names a ray for what the scene draws at random.
  void name(Ray& ray) noexcept {
    ray.seed = light_.seed;
    ray.pulse = light_.index;
    ray.subray = 0x8000'0000U | rays_++;
  }

  /// Adds what returns to the receiver from a surface.
  void return_from(const Arrival& at, ObjectId object, std::uint16_t classification) noexcept {
    const Vec3 back = light_.pulse.origin() - at.place, axis = light_.pulse.pose.rotation * axis::forward;
    const double distance = length(back);
    const Vec3 direction = back / distance;
    const double cosine = -dot(axis, direction);  // of the incidence at the aperture, which is flat
    const Divergence& beam = light_.emitter.laser.divergence;
    const double view = std::max({settings_.field_of_view, beam.across, beam.up});
    if (!(cosine > 0 && cosine >= std::cos(view / 2))) return;
    const double scattered =
        at.material->scattered(-at.direction, direction, at.normal, light_.emitter.laser.wavelength, at.texture);
    if (!(scattered > 0)) return;
    Ray ray{.origin = at.place, .direction = direction, .near = surface_epsilon, .tick = light_.pulse.tick};
    name(ray);
    if (target_.occluded(ray, distance)) return;
    const double both_ways = (at.way + distance) / 2;
    const double share = cosine * at.share * left(at.place, direction, distance);
    const double power = light_.budget.power_through(share, scattered, distance, both_ways);
    if (!(power > 0) || !light_.gate.contains(both_ways)) return;
    const Hit hit{.range = both_ways,
                  .cos_incidence = at.normal == Vec3{} ? 1 : dot(at.normal, direction),
                  .object = object,
                  .classification = classification};
    ledger_.reflect(hit, power, {ReflectionKind::multiple});
  }

  /// Share of the light that the media leave over on a way [m].
  double left(const Vec3& origin, const Vec3& direction, double way) const noexcept {
    double depth = 0;
    air_.along(origin, direction, 0, way,
               [&](double from, double to, const MediumRegion& region, double density) noexcept {
                 depth += density * region.medium.extinction() * (to - from);
               });
    return depth > 0 ? std::exp(-depth) : 1;
  }

  static Vec3 evenly(double u, double v) noexcept {
    const double z = 1 - 2 * u, r = std::sqrt(std::max(0.0, 1 - z * z));
    return {r * std::cos(2 * pi * v), r * std::sin(2 * pi * v), z};
  }
  static Vec3 by_cosine(const Vec3& normal, double u, double v) noexcept {
    const Vec3 aside = normalize(cross(normal, std::fabs(normal.z) < 0.9 ? axis::up : axis::right)),
               other = cross(normal, aside);
    const double r = std::sqrt(u);
    return normalize(r * std::cos(2 * pi * v) * aside + r * std::sin(2 * pi * v) * other +
                     std::sqrt(std::max(0.0, 1 - u)) * normal);
  }

  const Target& target_;
  const TransportInput& light_;
  const Media& air_;
  const MultipleScattering& settings_;
  LightLedger& ledger_;
  double passed_ = 0;     ///< shares of the subrays so far
  std::size_t next_ = 0;  ///< next path
  std::uint32_t rays_ = 0;
};

}  // namespace PULSECAST_NAMESPACE::detail

#endif
