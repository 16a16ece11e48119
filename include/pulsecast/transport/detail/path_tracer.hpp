// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_TRANSPORT_DETAIL_PATH_TRACER_HPP
#define PULSECAST_TRANSPORT_DETAIL_PATH_TRACER_HPP

#include <pulsecast/scene/find_hits.hpp>
#include <pulsecast/transport/detail/refracted_paths.hpp>
#include <pulsecast/transport/detail/scattered_paths.hpp>

namespace PULSECAST_NAMESPACE::detail {

/// CoaxialRays with what its rays met.
struct PathLevel {
  CoaxialRays pencil;
  std::array<Hit, RayBundle::capacity> hits{};
  std::array<PathVertex, RayBundle::capacity> surfaces{};
  RayBundle::Column power{};
};

/// Scratch memory of a `PathTracer`.
struct PathWorkspace {
  std::vector<PathLevel> levels;            ///< by number of surfaces that passed light on
  VolumeProfile in_air, in_water;           ///< light that media scatter back
  std::vector<ContinuousReturn> returns{};  ///< of both
  SubrayDirections slope;                   ///< subrays for a smooth surface

  PathWorkspace(std::size_t passages, std::size_t cells, SubrayDirections subrays)
      : levels(passages + 1), in_air(cells), in_water(cells), slope(std::move(subrays)) {
    returns.reserve(in_air.size_max() + in_water.size_max());
  }
};

/// Follows the light of one pulse, by the settings of `LightPaths`.
template <bool with_velocity, SceneQueries Target>
class PathTracer {
 public:
  PathTracer(const Target& target, const TransportInput& light, const auto& settings, PathWorkspace& w,
             std::span<Reflection> reflections, TransportResult& result) noexcept
      : target_(target),
        light_(light),
        share_min_(settings.share_min),
        w_(w),
        ledger_(light, reflections, result),
        media_(light, settings.air, settings.share_min, ledger_, w.in_air, w.in_water, w.returns),
        bodies_(target, light, settings.share_min, settings.passages, ledger_, media_),
        scattered_(target, light, settings.air, settings.scattering, ledger_) {}

  void trace() noexcept {
    const SubrayDirections& beam = light_.beam;
    const Matrix3 world_from_beam = matrix_of(light_.pulse.pose.rotation);
    CoaxialRays& p = w_.levels[0].pencil;
    StaggeredBundle& rays = p.rays;
    set_origin(light_, rays);
    for (std::size_t first = 0; first < light_.subrays; first += rays.size) {
      rays.first_subray = static_cast<std::uint32_t>(first);
      rays.size = std::min(beam.from_a_point() ? RayBundle::capacity : 1, light_.subrays - first);
      if (!beam.from_a_point()) rays.origin = light_.pulse.origin() + world_from_beam * beam.exits[first];
      beam.to_world(world_from_beam, first, rays);
      for (std::size_t j = 0; j < rays.padded_size(); ++j) {
        p.sent[j] = p.two_way_share[j] = beam.shares[first + j];
        rays.begin[j] = p.delay[j] = p.path_rate[j] = 0;
      }
      follow(0);
      scattered_.start(p, w_.levels[0].hits, w_.levels[0].surfaces);
    }
    ledger_.close(media_.close());
  }

  [[nodiscard]] bool passed_on() const noexcept { return passed_on_; }

 private:
  void follow(std::size_t level) noexcept {
    auto& [p, hits, surfaces, power] = w_.levels[level];
    const std::span<Hit> all(hits);
    const double wavelength = p.rays.wavelength;
    const auto visit = [=, &met = surfaces](std::size_t first, std::size_t end, const SurfaceInteraction& at) noexcept {
      scatter_at(*at.material, wavelength, at.texture, all.subspan(first, end - first));
      std::fill(met.begin() + first, met.begin() + end, PathVertex{at.material, at.normal, at.foliage, at.texture});
    };
    target_.closest(p.rays, hits, visit);
    if (level > 0) retrace_before_origin(level);
    media_.pass_air(p, hits, [this](const Ray& ray, double range) noexcept { return target_.occluded(ray, range); });
    received_power(light_, p.two_way_share.data(), p.rays.size, hits, power);
    if (level == 0 && !light_.record.empty())
      record_subrays(light_, p.rays.first_subray, std::span(hits).first(p.rays.size), power);
    bool goes_on = false;
    for (std::size_t j = 0; j < p.rays.size; ++j) {
      if (!hits[j].met()) {
        ledger_.miss(p.sent[j], hits[j].range);
        continue;
      }
      goes_on |= surfaces[j].material->smooth.passes_light();
      if (refracts(surfaces[j])) continue;  // its path meets the surface once more
      Hit at = hits[j];
      at.range += p.delay[j];
      power[j] *= aperture_fraction(light_.budget, *surfaces[j].material, at.range);
      PathState way{p.kind, p.sent[j]};
      if constexpr (with_velocity) way.velocity = p.path_rate[j] + radial_velocity(target_, ray_of(p, j));
      ledger_.end_at(at, *surfaces[j].material, power[j], way);
    }
    if (goes_on) pass_on(level);
  }

  /// Ray of a pencil, from where it exists.
  static Ray ray_of(const CoaxialRays& p, std::size_t j) noexcept {
    Ray ray = p.rays.ray(j);
    ray.near = p.rays.begin[j];
    return ray;
  }

  /// Traces rays again that met something before they begin: only triangles heed that.
  void retrace_before_origin(std::size_t level) noexcept {
    auto& [p, hits, surfaces, power] = w_.levels[level];
    for (std::size_t j = 0; j < p.rays.size; ++j) {
      if (!(hits[j].range <= p.rays.begin[j])) continue;
      const Ray ray = ray_of(p, j);
      hits[j] = Hit{};
      const auto hit = target_.closest_hit(ray);
      if (!hit) continue;
      const auto at = target_.surface(*hit, ray);
      surfaces[j] = {at.material, at.normal, at.foliage, at.texture};
      hits[j] = {.range = hit->range, .object = at.object, .classification = at.classification};
      if (at.normal != Vec3{}) hits[j].cos_incidence = std::min(1.0, std::fabs(dot(at.normal, ray.direction)));
      scatter_at(*at.material, p.rays.wavelength, at.texture, {&hits[j], 1});
    }
  }

  static bool refracts(const PathVertex& surface) noexcept {
    return surface.material->smooth.passes_light() && !surface.material->smooth.keeps_pencils();
  }

  /// Passes on the rays of a level that met smooth surfaces: those on one plane together.
  void pass_on(std::size_t level) noexcept {
    auto& [p, hits, surfaces, power] = w_.levels[level];
    for (std::size_t first = 0, end = 0; first < p.rays.size; first = end) {
      end = first + 1;
      if (!hits[first].met()) continue;
      const SmoothInterface& smooth = surfaces[first].material->smooth;
      if (!smooth.passes_light()) continue;
      passed_on_ = true;
      if (!smooth.keeps_pencils()) {
        trace_individually(p, first);
        continue;
      }
      while (end < p.rays.size && on_one_plane(level, first, end)) ++end;
      const double reaching = 1 - hits[first].scattered_share;
      const bool mirror = smooth.kind == InterfaceKind::mirror;
      const double lost = mirror ? std::max(0.0, reaching - smooth.reflectance) : 0;
      for (std::size_t j = first; j < end; ++j) ledger_.shares.absorbed += lost * p.sent[j];
      if (p.passages + 1 == w_.levels.size()) {
        for (std::size_t j = first; j < end; ++j) ledger_.shares.cut += (reaching - lost) * p.sent[j];
      } else if (mirror) {
        send_mirrored(level, first, end, [&](std::size_t) noexcept { return reaching - lost; });
      } else {
        pass_pane(level, first, end, smooth, reaching);
      }
    }
  }

  /// True if two rays met the same plane of one material.
  bool on_one_plane(std::size_t level, std::size_t a, std::size_t b) const noexcept {
    const auto& [p, hits, surfaces, power] = w_.levels[level];
    if (!hits[b].met() || surfaces[a].material != surfaces[b].material) return false;
    const Vec3 n = surfaces[a].normal, turned = surfaces[b].normal - n;
    if (!(dot(turned, turned) < 1e-24)) return false;
    return std::fabs(dot(hits[a].range * p.rays.direction(a) - hits[b].range * p.rays.direction(b), n)) < 1e-9;
  }

  /// Sends rays on from the image of their origin in a plane; `share(j)` is the share reflected.
  void send_mirrored(std::size_t level, std::size_t first, std::size_t end, const auto& share) noexcept {
    const PathLevel& met = w_.levels[level];
    const CoaxialRays& p = met.pencil;
    const auto& hits = met.hits;
    const Vec3 n = towards(met.surfaces[first].normal, p.rays.direction(first));
    const double above = -dot(p.rays.direction(first), n) * hits[first].range;
    const auto next = [&](std::size_t j) noexcept -> Next {
      return {mirrored(p.rays.direction(j), n), share(j), hits[j].range, p.delay[j]};
    };
    send(level, first, end, p.rays.origin - 2 * above * n, ReflectionKind::mirror, next);
  }

  /// Reflects rays at a pane, and lets them through.
  void pass_pane(std::size_t level, std::size_t first, std::size_t end, const SmoothInterface& pane,
                 double reaching) noexcept {
    const PathLevel& met = w_.levels[level];
    const CoaxialRays& p = met.pencil;
    const auto& hits = met.hits;
    std::array<PaneSplit, RayBundle::capacity> split;
    double least = infinity, most = 0;
    for (std::size_t j = first; j < end; ++j) {
      split[j] = pane_split(hits[j].cos_incidence, pane);
      least = std::min(least, split[j].shift);
      most = std::max(most, split[j].shift);
      ledger_.shares.absorbed += std::max(0.0, 1 - split[j].reflected - split[j].transmitted) * reaching * p.sent[j];
    }
    send_mirrored(level, first, end, [&](std::size_t j) noexcept { return reaching * split[j].reflected; });
    const Vec3 n = towards(met.surfaces[first].normal, p.rays.direction(first));
    const auto next = [&](std::size_t j) noexcept -> Next {
      const double inside = pane.thickness / (pane.inside.index * split[j].cos_inside);  // [m]
      return {p.rays.direction(j), reaching * split[j].transmitted, hits[j].range + inside,
              p.delay[j] + split[j].delay};
    };
    const bool together = most - least < surface_epsilon;  // twice the greatest displacement
    for (std::size_t from = first, to = 0; from < end; from = to) {
      to = together ? end : from + 1;
      const double shift = together ? (least + most) / 2 : split[from].shift;
      send(level, from, to, p.rays.origin - shift * n, ReflectionKind::glass, next);
    }
  }

  /// Ray that goes on from a surface.
  struct Next {
    Vec3 direction{};
    double share = 0;  ///< share of the light
    double begin = 0;  ///< as in `CoaxialRays`
    double delay = 0;  ///< as in `CoaxialRays`
  };

  /// Sends rays of a level on from a common origin; `next(j)` tells of each how.
  void send(std::size_t level, std::size_t first, std::size_t end, const Vec3& origin, ReflectionKind kind,
            const auto& next) noexcept {
    const CoaxialRays& p = w_.levels[level].pencil;
    CoaxialRays& to = w_.levels[level + 1].pencil;
    static_cast<BundleOrigin&>(to.rays) = p.rays;
    to.rays.origin = origin;
    to.rays.near = infinity;
    to.rays.first_subray = p.rays.first_subray + static_cast<std::uint32_t>(first);
    to.rays.size = end - first;
    to.passages = p.passages + 1;
    to.kind = std::max(p.kind, kind);
    double most = 0, sum = 0;  // greatest share that is left of a ray; energy
    for (std::size_t j = first; j < end; ++j) {
      const std::size_t k = j - first;
      const Next ray = next(j);
      to.rays.set_direction(k, ray.direction);
      to.sent[k] = p.sent[j] * ray.share;
      to.two_way_share[k] = p.two_way_share[j] * ray.share * ray.share;
      to.rays.begin[k] = ray.begin + surface_epsilon;
      to.delay[k] = ray.delay;
      to.path_rate[k] = p.path_rate[j];
      if constexpr (with_velocity)
        to.path_rate[k] += dot(velocity_at(ray_of(p, j)), p.rays.direction(j) - ray.direction);
      to.rays.near = std::min(to.rays.near, to.rays.begin[k]);
      if (kind == ReflectionKind::mirror) capture_in_aperture(to, k);
      sum += to.sent[k];
      if (to.sent[k] > 0) most = std::max(most, to.two_way_share[k] / to.sent[k]);
    }
    if (most < share_min_) {
      ledger_.shares.cut += sum;
      return;
    }
    for (std::size_t k = to.rays.size; k < to.rays.padded_size(); ++k) to.two_way_share[k] = to.rays.begin[k] = 0;
    to.rays.pad();
    follow(level + 1);
  }

  /// Takes the light of a ray that comes back into the aperture.
  void capture_in_aperture(CoaxialRays& p, std::size_t k) noexcept {
    const Vec3 to_exit = light_.pulse.origin() - p.rays.origin, direction = p.rays.direction(k);
    const double way = dot(to_exit, direction), radius = light_.budget.aperture_radius();
    const Vec3 off = to_exit - way * direction;
    if (!(way > p.rays.begin[k] && dot(off, off) < radius * radius)) return;
    Ray back{.origin = p.rays.origin, .direction = direction, .near = p.rays.begin[k], .tick = p.rays.tick};
    if (target_.occluded(back, way)) return;
    const Hit at{.range = (way + p.delay[k]) / 2, .cos_incidence = 1, .backscatter = 1};
    ledger_.reflect(at, light_.budget.power_captured(p.sent[k], way), {p.kind, p.sent[k], p.path_rate[k] / 2});
    p.sent[k] = p.two_way_share[k] = 0;
  }

  /// Velocity of the surface that a ray meets [m/s].
  Vec3 velocity_at(const Ray& ray) const noexcept {
    const auto hit = target_.closest_hit(ray);
    return hit ? target_.surface(*hit, ray).velocity : Vec3{};
  }

  /// Follows a ray that meets a body by itself.
  void trace_individually(const CoaxialRays& p, std::size_t j) noexcept {
    LightPath path;
    path.start(ray_of(p, j));
    path.sent = p.sent[j];
    path.two_way_share = p.two_way_share[j];
    path.optical = p.delay[j];
    path.path_rate = p.path_rate[j];
    path.passages = p.passages;
    path.kind = p.kind;
    bodies_.follow(path, true);
  }

  const Target& target_;
  const TransportInput& light_;
  double share_min_;
  PathWorkspace& w_;
  LightLedger ledger_;
  MediaPassage media_;
  RefractedPaths<with_velocity, Target> bodies_;
  ScatteredPaths<Target> scattered_;
  bool passed_on_ = false;
};

}  // namespace PULSECAST_NAMESPACE::detail

#endif
