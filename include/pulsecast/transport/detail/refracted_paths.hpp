// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_TRANSPORT_DETAIL_REFRACTED_PATHS_HPP
#define PULSECAST_TRANSPORT_DETAIL_REFRACTED_PATHS_HPP

#include <pulsecast/transport/detail/media_passage.hpp>

namespace PULSECAST_NAMESPACE::detail {

/// Follows subrays one by one, from where they meet a body.
template <bool with_velocity, SceneQueries Target>
class RefractedPaths {
 public:
  /// `passages`: greatest number of surfaces that pass light on.
  RefractedPaths(const Target& target, const TransportInput& light, double share_min, std::size_t passages,
                 LightLedger& ledger, MediaPassage& media) noexcept
      : target_(target), light_(light), share_min_(share_min), passages_(passages), ledger_(ledger), media_(media) {}

  /// Follows a path to its end. `passed_air`: the media up to the first surface are passed already.
  void follow(LightPath path, bool passed_air = false) noexcept {
    while (path.two_way_share >= share_min_ * path.sent && path.two_way_share > 0) {
      const auto hit = target_.closest_hit(path.ray);
      const double range = hit ? hit->range : infinity;
      if (!passed_air) media_.pass(path, range);
      passed_air = false;
      if (!hit) return ledger_.miss(path.sent, infinity);
      const auto at = target_.surface(*hit, path.ray);
      const Material& material = *at.material;
      path.advance(range, at.normal);
      const Face face = face_at(path, at);
      end_at(path, at, face);
      if (!material.smooth.passes_light() || !pass_on(path, at, face)) return;
      path.ray.near = surface_epsilon;
      ++path.passages;
    }
    ledger_.shares.cut += path.sent;
  }

 private:
  /// Surface of a body where a path meets it.
  struct Face {
    Vec3 normal{};         ///< towards the path
    double cosine = 1;     ///< of incidence
    double relative = 1;   ///< index behind it by that before it
    double scattered = 0;  ///< share of the light that it scatters
  };
  Face face_at(const LightPath& path, const SurfaceInteraction& at) const noexcept {
    Face face{towards(at.normal, path.ray.direction)};
    if (at.normal != Vec3{}) face.cosine = std::min(1.0, -dot(face.normal, path.ray.direction));
    face.relative = path.behind(*at.material).index / path.medium().index;
    SurfaceLight light = at.material->light(light_.emitter.laser.wavelength, at.texture);
    if (at.material->smooth.passes_light()) light.relative_index = face.relative;
    face.scattered = at.material->scattered_share(light, face.cosine);
    return face;
  }

  /// Light that a surface sends back to a path that ends there.
  void end_at(const LightPath& path, const SurfaceInteraction& at, const Face& face) noexcept {
    Hit hit{.range = path.optical,
            .cos_incidence = face.cosine,
            .object = at.object,
            .classification = at.classification,
            .scattered_share = face.scattered};
    hit.backscatter = at.material->backscatter(hit.cos_incidence, light_.emitter.laser.wavelength, at.texture);
    const double spread = path.spread();
    const double wide = light_.budget.power_through(path.two_way_share, hit.backscatter, spread, path.air);
    const double power = wide * aperture_fraction(light_.budget, *at.material, spread);
    PathState way{path.kind, path.sent};
    if constexpr (with_velocity)
      way.velocity = path.path_rate + path.medium().index * dot(at.velocity, path.ray.direction);
    ledger_.end_at(hit, *at.material, power, way);
  }

  /// Passes a path on: reflects a part of it, and goes on with the other; false if nothing goes on.
  bool pass_on(LightPath& path, const SurfaceInteraction& at, const Face& face) noexcept {
    const SmoothInterface& smooth = at.material->smooth;
    const double reaching = 1 - face.scattered;
    const Vec3 n = face.normal, before = path.ray.direction;
    const Medium around = path.medium();
    if (path.passages >= passages_) {
      ledger_.shares.cut += reaching * path.sent;
      return false;
    }
    const auto moved = [&](LightPath& p) noexcept {
      if constexpr (with_velocity)
        p.path_rate += dot(at.velocity, around.index * before - p.medium().index * p.ray.direction);
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
      other.ray.near = surface_epsilon;
      ++other.passages;
      follow(other);
    };
    if (smooth.kind == InterfaceKind::mirror) {
      ledger_.shares.absorbed += std::max(0.0, reaching - smooth.reflectance) * path.sent;
      reflect(path, std::min(smooth.reflectance, reaching));
      return true;
    }
    if (smooth.kind == InterfaceKind::pane) {
      const PaneSplit split = pane_split(face.cosine, smooth, around);
      ledger_.shares.absorbed += std::max(0.0, 1 - split.reflected - split.transmitted) * reaching * path.sent;
      reflect_too(reaching * split.reflected);
      path.keep(reaching * split.transmitted);
      path.kind = std::max(path.kind, ReflectionKind::glass);
      path.ray.origin -= split.shift * n;
      path.optical += split.delay;
      return true;
    }
    const FresnelSplit split = fresnel_split(face.cosine, face.relative);
    const bool rough = at.material->law.reflects_interface();  // what it reflects is scattered
    if (split.reflected >= 1) {
      if (rough) return false;
      reflect(path, reaching);
      return true;
    }
    if (!rough) reflect_too(reaching * split.reflected);
    path.keep(rough ? reaching : reaching * split.refracted());
    const bool water = smooth.kind == InterfaceKind::water;
    path.kind = std::max(path.kind, water ? ReflectionKind::water : ReflectionKind::glass);
    path.refract(n, face.relative, split);
    path.cross_face(*at.material);
    media_.label_body(at.object, at.classification);
    moved(path);
    return true;
  }

  const Target& target_;
  const TransportInput& light_;
  double share_min_;
  std::size_t passages_;
  LightLedger& ledger_;
  MediaPassage& media_;
};

}  // namespace PULSECAST_NAMESPACE::detail

#endif
