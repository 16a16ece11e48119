// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_MATERIAL_SCATTERING_LAW_HPP
#define PULSECAST_MATERIAL_SCATTERING_LAW_HPP

#include <pulsecast/base/optional_member.hpp>
#include <pulsecast/base/simd.hpp>
#include <pulsecast/base/vector.hpp>

/// Contract of surfaces: what a law of scattered light models, of this folder or any type.
// clang-format off
// version 14 breaks up compound requirements
namespace PULSECAST_NAMESPACE {

/// Light at a place of a surface. A law that needs no more than the wavelength takes a `double`.
struct SurfaceLight {
  double wavelength;      ///< [m]
  double reflectance;     ///< of the material there, by its spectrum and map, in [0, 1]
  double relative_index;  ///< index behind the surface by that before it; 1.5 by default

  /// Light of a wavelength [m], by default at a white surface.
  constexpr SurfaceLight(double w, double r = 1, double index = 1.5) noexcept  // NOLINT
      : wavelength(w), reflectance(r), relative_index(index) {}
};

namespace detail {
template <class L>
concept Backscatters = requires(const L law, double cosine, double wavelength) {
  { law.backscatter(cosine, wavelength) } noexcept -> std::convertible_to<double>;
};
template <class L>
concept TellsShare = requires(const L law, double cosine, double wavelength) {
  { law.scattered_share(cosine, wavelength) } noexcept -> std::convertible_to<double>;
};
template <class L>
concept BackscattersSurfaceLight = requires(const L law, const SurfaceLight s) { law.backscatter(1.0, s); };
template <class L>
concept ScattersSurfaceLight = requires(const L law, const Vec3 v, const SurfaceLight s) { law.scattered(v, v, v, s); };
/// Law that takes a `SurfaceLight`, in all its members.
template <class L>
concept TakesSurfaceLight = requires(const L law, const SurfaceLight s) { law.scattered_share(1.0, s); };

/// Light as a law takes it.
template <class L>
[[nodiscard]] const auto& taken_by(const SurfaceLight& light) noexcept {
  if constexpr (TakesSurfaceLight<L>) return light;
  else return light.wavelength;
}
/// Type with a member of a law, in any form: meant to be one.
template <class L>
concept MeantAsLaw = requires { &L::backscatter; } || requires { &L::scattered_share; } ||
                     Backscatters<L> || TellsShare<L>;
}  // namespace detail

/// Law of the light that a surface scatters. `backscatter(cosine, wavelength)` is the light
/// returned to its source at a cosine of incidence in [0, 1], by that of a white Lambertian surface
/// at normal incidence; `scattered_share(cosine, wavelength)` the share scattered into all
/// directions. A law may take a `SurfaceLight` in place of the wavelength [m], and cosines as
/// `simd::Doubles`, too: then it is evaluated in SIMD batches.
/// Law: pure; neither is negative; a share is at most 1.
/// Not required: light into other directions, as of a law that `ScattersBetween`; `validate()`.
template <class L>
concept ScatteringLaw = std::copyable<L> && detail::Backscatters<L> && detail::TellsShare<L>;

/// Law that is evaluated in SIMD batches.
template <class L>
concept ScattersInLanes = ScatteringLaw<L> && requires(const L law, const simd::Doubles cosines, const SurfaceLight s) {
  { law.backscatter(cosines, detail::taken_by<L>(s)) } noexcept -> std::same_as<simd::Doubles>;
};

// each law has a `backscatter` of a cosine, too
PULSECAST_OPTIONAL_MEMBER(ScattersInLanes, "simd::Doubles backscatter(const simd::Doubles&, double) const noexcept", backscatter, (simd::Doubles{}, 1.0), && false)

/// Law of the light from one direction towards another, without which `MultipleScattering` refuses
/// a material. `in` and `out` are unit vectors away from the surface, on the side of its unit
/// normal; the result is by the light of a white Lambertian surface towards its normal.
/// Law: reciprocal: `scattered(in, out) / dot(out, normal)` stays the same if they are exchanged;
/// the integral of `scattered / pi` over all `out` is the share. `scattered(in, in)` is the
/// backscatter, but for peaks towards the source that other directions do not see.
template <class L>
concept ScattersBetween = ScatteringLaw<L> && requires(const L law, const Vec3 v, double wavelength) {
  { law.scattered(v, v, v, wavelength) } noexcept -> std::convertible_to<double>;
};
PULSECAST_OPTIONAL_MEMBER(ScattersBetween, "double scattered(const Vec3& in, const Vec3& out, const Vec3& normal, double or const SurfaceLight&) const noexcept",
                          scattered, (Vec3{}, Vec3{}, Vec3{}, 1.0))

/// Direction drawn by a law, with its density.
struct SampledDirection {
  Vec3 direction{};    ///< unit vector away from the surface
  double density = 0;  ///< [1/sr]
};

/// Law that draws directions by importance, for two numbers that are uniform in [0, 1). Others are
/// sampled by the cosine. Law: the density integrates to 1 over the directions.
template <class L>
concept SamplesDirections = ScattersBetween<L> && requires(const L law, const Vec3 v, double u) {
  { law.sample(v, v, u, u) } noexcept -> std::same_as<SampledDirection>;
};
PULSECAST_OPTIONAL_MEMBER(SamplesDirections, "SampledDirection sample(const Vec3& in, const Vec3& normal, double, double) const noexcept, beside scattered",
                          sample, (Vec3{}, Vec3{}, 1.0, 1.0))

/// Law with light that returns to its source in a narrow cone, as of retroreflectors.
template <class L>
concept Retroreflects = ScatteringLaw<L> && requires(const L law) {
  { law.returned_share() } noexcept -> std::same_as<double>;  ///< in the cone, along the normal
  { law.returned_half_angle() } noexcept -> std::same_as<double>;  ///< at 1/e^2; 0: wide [rad]
};
PULSECAST_OPTIONAL_MEMBER(Retroreflects, "double returned_share() const noexcept, with double returned_half_angle() const noexcept",
                          returned_share, ())

/// Law that also reflects what the face of a body would mirror, as rough facets do.
PULSECAST_OPTIONAL_CONSTANT(ReflectsInterface, reflects_interface)

}  // namespace PULSECAST_NAMESPACE
// clang-format on

#endif
