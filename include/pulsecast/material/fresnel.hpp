// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_MATERIAL_FRESNEL_HPP
#define PULSECAST_MATERIAL_FRESNEL_HPP

#include <pulsecast/base/vector.hpp>
#include <pulsecast/material/smooth_interface.hpp>

/// Contract: closed forms of light at smooth surfaces, for incoherent, unpolarised light.
namespace PULSECAST_NAMESPACE {

/// Light at the face between two media.
struct FresnelSplit {
  double reflected = 0;      ///< share reflected; the rest is refracted
  double perpendicular = 0;  ///< reflected of the light polarised across the plane of incidence
  double parallel = 0;       ///< reflected of the light polarised in the plane of incidence
  double cos_refracted = 0;  ///< of the refracted ray to the normal; 0 if all is reflected
  [[nodiscard]] double refracted() const noexcept { return 1 - reflected; }  ///< share refracted
};

/// Splits light at a cosine of incidence on a face, by the index beyond over that before. Beyond
/// the critical angle all is reflected. Source: Fresnel's equations, Born & Wolf 1999, 1.5.2.
[[nodiscard]] inline FresnelSplit fresnel_split(double cos_incidence, double n) noexcept {
  const double sine2 = (1 - cos_incidence * cos_incidence) / (n * n);
  if (!(sine2 < 1)) return {1, 1, 1, 0};
  const double inside = std::sqrt(1 - sine2);
  const double s = (cos_incidence - n * inside) / (cos_incidence + n * inside),
               p = (n * cos_incidence - inside) / (n * cos_incidence + inside);
  if (!(cos_incidence > 0)) return {1, 1, 1, inside};
  return {(s * s + p * p) / 2, s * s, p * p, inside};
}

/// Direction of a ray mirrored at a plane; unit vectors.
[[nodiscard]] inline Vec3 mirrored(const Vec3& direction, const Vec3& normal) noexcept {
  return direction - 2 * dot(direction, normal) * normal;
}

/// Direction of a ray refracted at a plane with a normal towards it; unit vectors. `split` is that
/// of the ray and the relative index. Source: Snell's law.
[[nodiscard]] inline Vec3 refracted(const Vec3& direction, const Vec3& normal, double relative_index,
                                    const FresnelSplit& split) noexcept {
  const double per = 1 / relative_index;
  return per * direction + (-per * dot(direction, normal) - split.cos_refracted) * normal;
}

/// Light at a pane, with all orders of reflection inside, each as if it left where the first does.
struct PaneSplit {
  double reflected = 0;    ///< share reflected
  double transmitted = 0;  ///< transmitted share
  double shift = 0;        ///< by which the ray seems to begin nearer, along the normal [m]
  double delay = 0;        ///< optical path between the faces, less that of the shifted ray [m]
  double cos_inside = 1;   ///< cosine between the ray inside and the normal
};

/// Splits light at a pane in a medium, by default air. Source: sum of the geometric series of
/// reflections, for each polarisation; Born & Wolf 1999, 7.6, without interference.
[[nodiscard]] inline PaneSplit pane_split(double cos_incidence, const SmoothInterface& pane,
                                          const Medium& around = {}) noexcept {
  const double n = pane.inside.index / around.index, d = pane.thickness;
  const FresnelSplit face = fresnel_split(cos_incidence, n);
  const double inside = face.cos_refracted;
  const double pass = std::exp(-pane.inside.absorption * d / inside);
  const auto through = [&](double r) noexcept {
    return r < 1 ? (1 - r) * (1 - r) * pass / (1 - r * r * pass * pass) : 0;
  };
  const auto back = [&](double r) noexcept { return r * (1 + pass * through(r)); };
  return {.reflected = (back(face.perpendicular) + back(face.parallel)) / 2,
          .transmitted = (through(face.perpendicular) + through(face.parallel)) / 2,
          .shift = d * (1 - cos_incidence / (n * inside)),
          .delay = d / inside * (pane.inside.delay() - around.delay() / n),
          .cos_inside = inside};
}

}  // namespace PULSECAST_NAMESPACE

#endif
