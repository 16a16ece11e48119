// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_TRANSPORT_DETAIL_PATH_TRACER_HPP
#define PULSECAST_TRANSPORT_DETAIL_PATH_TRACER_HPP

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include <pulsecast/concepts.hpp>
#include <pulsecast/transport/detail/light_path.hpp>
#include <pulsecast/transport/detail/returned_light.hpp>
#include <pulsecast/transport/illumination.hpp>

namespace PULSECAST_NAMESPACE::detail {

/// Pencil with what its rays met.
struct PencilHits {
  Pencil pencil;
  std::array<Hit, RayBundle::capacity> hits{};
  std::array<HitSurface, RayBundle::capacity> surfaces{};
  RayBundle::Column power{};
};

/// Follows the light of one pulse.
template <bool with_velocity, OpticalTarget Map>
class PathTracer {
 public:
  /// `levels` has one entry more than light is passed on.
  PathTracer(const Map& map, const Illumination& light, double least_share, std::span<PencilHits> levels, std::span<Reflection> reflections,
             TransportResult& result) noexcept
      : map_(map), light_(light), least_share_(least_share), levels_(levels), reflections_(reflections), result_(result) {}

  /// Follows all subrays.
  void trace() noexcept {
    const SubrayDirections& beam = light_.beam;
    const Matrix3 world_from_beam = matrix_of(light_.pulse.pose.rotation);
    Pencil& p = levels_[0].pencil;
    RayBundle& rays = p.rays;
    rays.origin = light_.pulse.origin();
    rays.wavelength = light_.emitter.laser.wavelength;
    rays.tick = light_.pulse.tick;
    rays.seed = light_.seed;
    rays.pulse = light_.index;
    for (std::size_t first = 0; first < light_.subrays; first += rays.size) {
      rays.first_subray = static_cast<std::uint32_t>(first);
      rays.size = std::min(beam.from_a_point() ? RayBundle::capacity : 1, light_.subrays - first);
      if (!beam.from_a_point()) rays.origin = light_.pulse.origin() + world_from_beam * beam.exits[first];
      beam.to_world(world_from_beam, first, rays);
      for (std::size_t j = 0; j < rays.padded_size(); ++j) {
        p.sent[j] = p.both[j] = beam.shares[first + j];
        p.begin[j] = p.delay[j] = p.drift[j] = 0;
      }
      follow(0);
    }
    const double sent = light_.energy();
    result_.fate = in_gate_ ? Fate::absorbed : met_ ? Fate::out_of_range : Fate::missed;
    result_.energy = energy_.times(sent);
    result_.energy.sent = sent;
    result_.energy.received = received_ * light_.emitter.laser.pulse_length;
  }

  /// True if a surface passed light on.
  [[nodiscard]] bool passed_on() const noexcept { return passed_on_; }

 private:
  static constexpr double apart = 1e-6;  // surfaces nearer to each other than this are one [m]

  // -------------------------------------------------------------------------------------------------------------- pencils

  void follow(std::size_t level) noexcept {
    auto& [p, hits, surfaces, power] = levels_[level];
    map_.closest(p.rays, hits, surfaces);
    received_power(light_, p.both.data(), p.rays.size, hits, power);
    if (level == 0 && !light_.record.empty()) record_subrays(light_, p.rays.first_subray, std::span(hits).first(p.rays.size), power);
    bool goes_on = false;
    for (std::size_t j = 0; j < p.rays.size; ++j) {
      if (!hits[j].met()) {
        result_.nan |= std::isnan(hits[j].range);
        energy_.missed += p.sent[j];
        continue;
      }
      goes_on |= surfaces[j].material->smooth.passes_light();
      if (refracts(surfaces[j])) continue;  // its path meets the surface once more
      const Hit at{hits[j].range + p.delay[j], hits[j].cos_incidence, hits[j].backscatter, hits[j].object, hits[j].classification};
      end_at(at, *surfaces[j].material, p.sent[j], power[j], p.kind, [&] { return p.drift[j] + radial_velocity(map_, p.rays.ray(j)); });
    }
    if (goes_on) pass_on(level);
  }

  static bool refracts(const HitSurface& surface) noexcept {
    return surface.material->smooth.passes_light() && !surface.material->smooth.keeps_pencils();
  }

  /// Passes on the rays of a level that met smooth surfaces: those on one plane together.
  void pass_on(std::size_t level) noexcept {
    auto& [p, hits, surfaces, power] = levels_[level];
    for (std::size_t first = 0, end = 0; first < p.rays.size; first = end) {
      end = first + 1;
      if (!hits[first].met()) continue;
      const SmoothInterface& smooth = surfaces[first].material->smooth;
      if (!smooth.passes_light()) continue;
      passed_on_ = true;
      if (!smooth.keeps_pencils()) {
        leave_pencil(p, first);
        continue;
      }
      while (end < p.rays.size && on_one_plane(level, first, end)) ++end;
      const double scattered = surfaces[first].material->scattered_share(p.rays.wavelength);
      if (p.passages + 1 == levels_.size()) {
        for (std::size_t j = first; j < end; ++j) {
          const double lost = smooth.kind == InterfaceKind::mirror ? std::max(0.0, 1 - scattered - smooth.reflectance) : 0;
          energy_.absorbed += lost * p.sent[j];
          energy_.cut += (1 - scattered - lost) * p.sent[j];
        }
      } else if (smooth.kind == InterfaceKind::mirror) {
        for (std::size_t j = first; j < end; ++j) energy_.absorbed += std::max(0.0, 1 - scattered - smooth.reflectance) * p.sent[j];
        send_mirrored(level, first, end, [&](std::size_t) noexcept { return smooth.reflectance; });
      } else {
        pass_pane(level, first, end, smooth, 1 - scattered);
      }
    }
  }

  /// True if two rays met the same plane of one material.
  bool on_one_plane(std::size_t level, std::size_t a, std::size_t b) const noexcept {
    const auto& [p, hits, surfaces, power] = levels_[level];
    if (!hits[b].met() || surfaces[a].material != surfaces[b].material) return false;
    const Vec3 n = surfaces[a].normal, turned = surfaces[b].normal - n;
    if (!(dot(turned, turned) < 1e-24)) return false;
    return std::fabs(dot(hits[a].range * p.rays.direction(a) - hits[b].range * p.rays.direction(b), n)) < 1e-9;
  }

  /// Normal of a plane that a ray met, towards the ray.
  static Vec3 towards(const Vec3& normal, const Vec3& direction) noexcept { return dot(normal, direction) > 0 ? -normal : normal; }

  /// Sends rays on from the image of their origin in a plane; `share(j)` is the share reflected.
  template <class Share>
  void send_mirrored(std::size_t level, std::size_t first, std::size_t end, const Share& share) noexcept {
    const auto& [p, hits, surfaces, power] = levels_[level];
    const Vec3 n = towards(surfaces[first].normal, p.rays.direction(first));
    const double above = -dot(p.rays.direction(first), n) * hits[first].range;  // height of the origin above the plane
    const auto next = [&](std::size_t j) noexcept -> Next {
      return {mirrored(p.rays.direction(j), n), share(j), hits[j].range, p.delay[j]};
    };
    send(level, first, end, p.rays.origin - 2 * above * n, ReflectionKind::mirror, next);
  }

  /// Reflects rays at a pane, and lets them through.
  void pass_pane(std::size_t level, std::size_t first, std::size_t end, const SmoothInterface& pane, double reaching) noexcept {
    const auto& [p, hits, surfaces, power] = levels_[level];
    std::array<PaneSplit, RayBundle::capacity> split;
    double least = std::numeric_limits<double>::infinity(), most = 0;
    for (std::size_t j = first; j < end; ++j) {
      split[j] = pane_split(hits[j].cos_incidence, pane);
      least = std::min(least, split[j].shift);
      most = std::max(most, split[j].shift);
      energy_.absorbed += std::max(0.0, 1 - split[j].reflected - split[j].transmitted) * reaching * p.sent[j];
    }
    send_mirrored(level, first, end, [&](std::size_t j) noexcept { return reaching * split[j].reflected; });
    const Vec3 n = towards(surfaces[first].normal, p.rays.direction(first));
    const auto next = [&](std::size_t j) noexcept -> Next {
      const double inside = pane.thickness / (pane.inside.index * split[j].cos_inside);  // of the way of the shifted ray [m]
      return {p.rays.direction(j), reaching * split[j].transmitted, hits[j].range + inside, p.delay[j] + split[j].delay};
    };
    const bool together = most - least < apart / 4;
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
    double begin = 0;  ///< as in `Pencil`
    double delay = 0;  ///< as in `Pencil`
  };

  /// Sends rays of a level on from a common origin; `next(j)` tells of each how. Where something is in front of the plane so near that one
  /// ray may meet it before another leaves the plane, they go one by one.
  template <class NextOf>
  void send(std::size_t level, std::size_t first, std::size_t end, const Vec3& origin, ReflectionKind kind, const NextOf& next) noexcept {
    const Pencil& p = levels_[level].pencil;
    Pencil& to = levels_[level + 1].pencil;
    static_cast<BundleOrigin&>(to.rays) = p.rays;
    to.rays.origin = origin;
    to.rays.near = 0;
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
      to.both[k] = p.both[j] * ray.share * ray.share;
      to.begin[k] = ray.begin;
      to.delay[k] = ray.delay;
      to.drift[k] = p.drift[j];
      if constexpr (with_velocity) to.drift[k] += dot(velocity_at(p.rays.ray(j)), p.rays.direction(j) - ray.direction);
      to.rays.near = std::max(to.rays.near, ray.begin + apart);
      if (kind == ReflectionKind::mirror) take_captured(to, k);
      sum += to.sent[k];
      if (to.sent[k] > 0) most = std::max(most, to.both[k] / to.sent[k]);
    }
    if (most < least_share_) {
      energy_.cut += sum;
      return;
    }
    for (std::size_t k = to.rays.size; k < to.rays.padded_size(); ++k) to.both[k] = 0;
    to.rays.pad();
    for (std::size_t k = 0; k < to.rays.size && to.rays.size > 1; ++k) {
      if (to.rays.near - to.begin[k] < 10 * apart) continue;
      Ray between = to.rays.ray(k);
      between.near = to.begin[k] + apart;
      if (!map_.occluded(between, to.rays.near)) continue;
      for (std::size_t j = first; j < end; ++j) send(level, j, j + 1, origin, kind, next);
      return;
    }
    follow(level + 1);
  }

  /// Takes the light of a ray that comes back into the aperture.
  void take_captured(Pencil& p, std::size_t k) noexcept {
    const Vec3 to_exit = light_.pulse.origin() - p.rays.origin, direction = p.rays.direction(k);
    const double way = dot(to_exit, direction), radius = light_.budget.aperture_radius();
    const Vec3 off = to_exit - way * direction;
    if (!(way > p.begin[k] && dot(off, off) < radius * radius)) return;
    Ray back{.origin = p.rays.origin, .direction = direction, .near = p.begin[k] + apart, .tick = p.rays.tick};
    if (map_.occluded(back, way)) return;
    const Hit at{.range = (way + p.delay[k]) / 2, .cos_incidence = 1, .backscatter = 1};
    if (light_.gate.contains(at.range))
      capture(at, p.sent[k], light_.budget.power_captured(p.sent[k], way), p.kind, p.drift[k] / 2);
    else
      energy_.out_of_range += p.sent[k];
    p.sent[k] = p.both[k] = 0;
  }

  /// Velocity of the surface that a ray meets [m/s].
  Vec3 velocity_at(const Ray& ray) const noexcept {
    if constexpr (VelocityTarget<Map>) {
      if (const auto hit = map_.closest_hit(ray)) return map_.surface(*hit, ray).velocity;
    }
    return Vec3{};
  }

  // ---------------------------------------------------------------------------------------------------------------- paths

  /// Follows a ray that meets a body by itself.
  void leave_pencil(const Pencil& p, std::size_t j) noexcept {
    LightPath path;
    Ray ray = p.rays.ray(j);
    ray.near = std::max(ray.near, p.begin[j]);
    path.start(ray);
    path.sent = p.sent[j];
    path.both = p.both[j];
    path.optical = p.delay[j];
    path.drift = p.drift[j];
    path.passages = p.passages;
    path.kind = p.kind;
    follow(path);
  }

  void follow(LightPath path) noexcept {
    while (path.both >= least_share_ * path.sent && path.both > 0) {
      const auto hit = map_.closest_hit(path.ray);
      if (!hit) {
        energy_.missed += path.sent;
        return;
      }
      const auto at = map_.surface(*hit, path.ray);
      const Material& material = *at.material;
      lose(path, hit->range);
      path.advance(hit->range, at.normal);
      end_at(path, at);
      if (!material.smooth.passes_light() || !pass_on(path, at)) return;
      path.ray.near = apart;
      ++path.passages;
    }
    energy_.cut += path.sent;
  }

  /// Takes away what the medium absorbs and scatters on a way [m].
  void lose(LightPath& path, double way) noexcept {
    const Medium& medium = path.medium();
    if (!(medium.extinction() > 0)) return;
    const double left = std::exp(-medium.extinction() * way), lost = (1 - left) * path.sent / medium.extinction();
    energy_.absorbed += lost * medium.absorption;
    energy_.scattered += lost * medium.scattering;
    path.keep(left);
  }

  /// Light that a surface sends back to a path that ends there.
  template <class Point>
  void end_at(const LightPath& path, const Point& at) noexcept {
    const double wavelength = light_.emitter.laser.wavelength;
    Hit hit{.range = path.optical, .object = at.object, .classification = at.classification};
    if (at.normal != Vec3{}) hit.cos_incidence = std::min(1.0, std::fabs(dot(at.normal, path.ray.direction)));
    hit.backscatter = at.material->backscatter(hit.cos_incidence, wavelength);
    const double power = light_.budget.power_through(path.both, hit.backscatter, path.spread(), path.air);
    end_at(hit, *at.material, path.sent, power, path.kind,
           [&] { return path.drift + path.medium().index * dot(at.velocity, path.ray.direction); });
  }

  /// Passes a path on: reflects a part of it, and goes on with the other. Returns false if nothing goes on.
  template <class Point>
  bool pass_on(LightPath& path, const Point& at) noexcept {
    const SmoothInterface& smooth = at.material->smooth;
    const double reaching = 1 - at.material->scattered_share(light_.emitter.laser.wavelength);
    const Vec3 n = towards(at.normal, path.ray.direction), before = path.ray.direction;
    const Medium around = path.medium();
    const double cosine = std::min(1.0, -dot(n, before));
    if (path.passages + 1 >= levels_.size()) {
      energy_.cut += reaching * path.sent;
      return false;
    }
    const auto moved = [&](LightPath& p) noexcept {
      if constexpr (with_velocity) p.drift += dot(at.velocity, around.index * before - p.medium().index * p.ray.direction);
    };
    const auto reflect = [&](LightPath& p, double share) noexcept {
      p.keep(share);
      p.kind = std::max(p.kind, ReflectionKind::mirror);
      p.reflect(n);
      moved(p);
    };
    const auto reflect_too = [&](double share) noexcept {
      LightPath other = path;
      reflect(other, share);
      other.ray.near = apart;
      ++other.passages;
      follow(other);
    };
    switch (smooth.kind) {
      case InterfaceKind::mirror:
        energy_.absorbed += std::max(0.0, reaching - smooth.reflectance) * path.sent;
        reflect(path, smooth.reflectance);
        return true;
      case InterfaceKind::pane: {
        const PaneSplit split = pane_split(cosine, smooth, around);
        energy_.absorbed += std::max(0.0, 1 - split.reflected - split.transmitted) * reaching * path.sent;
        reflect_too(reaching * split.reflected);
        path.keep(reaching * split.transmitted);
        path.kind = std::max(path.kind, ReflectionKind::glass);
        path.ray.origin -= split.shift * n;
        path.optical += split.delay;
        return true;
      }
      default: {
        const Medium inside = path.behind(*at.material);
        const double relative = inside.index / around.index;
        const FresnelSplit split = fresnel_split(cosine, relative);
        const ReflectionKind kind = smooth.kind == InterfaceKind::water ? ReflectionKind::water : ReflectionKind::glass;
        if (split.reflected >= 1) {
          reflect(path, reaching);
          return true;
        }
        reflect_too(reaching * split.reflected);
        path.keep(reaching * split.refracted());
        path.kind = std::max(path.kind, kind);
        path.refract(n, relative, split);
        path.cross_face(*at.material);
        moved(path);
        return true;
      }
    }
  }

  // ---------------------------------------------------------------------------------------------------------- reflections

  /// Counts the light that a surface scatters, and what returns of it. `range` of the hit is the optical path [m].
  template <class Velocity>
  void end_at(const Hit& hit, const Material& material, double share, double power, ReflectionKind kind,
              const Velocity& velocity) noexcept {
    met_ = true;
    const double scattered = material.scattered_share(light_.emitter.laser.wavelength);
    const double kept = material.smooth.passes_light() ? 0 : 1 - scattered;
    if (!light_.gate.contains(hit.range)) {
      energy_.out_of_range += (scattered + kept) * share;
      return;
    }
    in_gate_ = true;
    energy_.absorbed += kept * share;
    result_.nan |= std::isnan(power);
    if (!(power > 0)) {
      energy_.scattered += scattered * share;
      return;
    }
    double moving = 0;
    if constexpr (with_velocity) moving = velocity();
    capture(hit, scattered * share, power, kind, moving);
  }

  /// Adds a reflection, if there is room, for light that is scattered.
  void capture(const Hit& hit, double share, double power, ReflectionKind kind, double velocity) noexcept {
    if (result_.reflections == reflections_.size()) {
      energy_.cut += share;
      return;
    }
    met_ = in_gate_ = true;
    energy_.scattered += share;
    received_ += power;
    Reflection& reflection = reflections_[result_.reflections++];
    set_reflection(reflection, hit, power);
    reflection.kind = kind;
    reflection.velocity = velocity;
  }

  const Map& map_;
  const Illumination& light_;
  double least_share_;
  std::span<PencilHits> levels_;
  std::span<Reflection> reflections_;
  TransportResult& result_;
  EnergyLedger energy_{};  ///< shares of the energy sent
  double received_ = 0;    ///< power [W]
  bool met_ = false, in_gate_ = false, passed_on_ = false;
};

}  // namespace PULSECAST_NAMESPACE::detail

#endif
