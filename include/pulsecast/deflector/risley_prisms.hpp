// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_DEFLECTOR_RISLEY_PRISMS_HPP
#define PULSECAST_DEFLECTOR_RISLEY_PRISMS_HPP

#include <pulsecast/concepts.hpp>
#include <pulsecast/deflector/aim.hpp>

namespace PULSECAST_NAMESPACE {

/// Glass wedge that rotates about forward. One face is normal to forward, the other inclined.
/// Unrotated, its thick end, towards which it bends the beam, is below.
struct Prism {
  double wedge = pi / 10;          ///< angle between the faces [rad]
  double rotation_rate = 100;      ///< from up to right, seen along forward; up to 1e12 either way [Hz]
  double refractive_index = 1.51;  ///< refractive index of the glass at the laser's wavelength
  double start = 0;                ///< rotation at the survey's start, from -2 pi to 2 pi [rad]
  bool inclined_exit = false;      ///< true if the beam leaves through the inclined face
};

namespace detail {

/// Refracts unit directions in lanes by Snell's law; returns the lanes without total reflection.
/// `normal` is unit, towards the light; `ratio` is the refractive index before the face by that
/// after it. Source: Born & Wolf 1999, sec. 1.5.1, in vector form.
inline simd::Mask refract(Vec3Lanes& direction, const Vec3Lanes& normal, double ratio) noexcept {
  const simd::Doubles zero{}, ratios = zero + ratio, cosine = -dot(direction, normal);
  const simd::Doubles sine_squared = ratios * ratios * (1.0 - cosine * cosine);
  const simd::Mask passes = (cosine > zero) & (sine_squared <= 1.0);
  const simd::Doubles bend = ratios * cosine - simd::sqrt(simd::Doubles(1.0 - sine_squared));
  direction = normalize(ratios * direction + bend * normal);
  return passes;
}

}  // namespace detail

/// Risley prisms: wedges in series that rotate at rates of their own draw a rosette. Total
/// reflection blocks the beam. The wedges do not shift it: thickness and distance are neglected.
struct RisleyPrisms {
  using refinements = refines<tag::Gated, tag::MovesInLanes, tag::Validated>;
  std::vector<Prism> prisms{};    ///< wedges in the order of the beam, from 1 to 16
  double surrounding_index = 1;   ///< refractive index between and around the prisms
  Vec3 incident = axis::forward;  ///< direction of the laser, of any length but zero

  void validate() const {
    require_within("RisleyPrisms::prisms (number)", prisms.size(), 1, 16, "");
    for (const Prism& p : prisms) {
      require_within("Prism::wedge", p.wedge, 0, 1.5, "rad");
      require_within("Prism::rotation_rate", p.rotation_rate, -1e12, 1e12, "Hz");
      require_within("Prism::refractive_index", p.refractive_index, 0.5, 10, "");
      require_angle("Prism::start", p.start);
    }
    require_within("RisleyPrisms::surrounding_index", surrounding_index, 0.5, 10, "");
    require_positive("RisleyPrisms::incident (length)", length(incident), "");
  }

  /// Unit direction of the beam after the last wedge; empty at total reflection.
  [[nodiscard]] std::optional<Vec3> direction(Tick t) const noexcept {
    Vec3Lanes light;
    if (directions(TickLanes(t), light)[0] == 0) return std::nullopt;
    return light[0];
  }

  [[nodiscard]] bool open(Tick t) const noexcept { return direction(t).has_value(); }

  /// Forward at total reflection.
  [[nodiscard]] auto at(Tick t) const noexcept { return pose_in_lanes(*this, t); }

  simd::Mask poses(const TickLanes& t, PoseLanes<frame::Beam, frame::Instrument>& poses) const noexcept {
    Vec3Lanes light;
    const simd::Mask passes = directions(t, light);
    const simd::Doubles zero{}, one = zero + 1.0;
    poses = aimed_along(Vec3Lanes{passes ? light.x : zero, passes ? light.y : one, passes ? light.z : zero});
    return passes;
  }

 private:
  /// Unit directions after the last wedge; returns the lanes without total reflection.
  simd::Mask directions(const TickLanes& t, Vec3Lanes& light) const noexcept {
    simd::Mask passes = all_lanes();
    light = Vec3Lanes(normalize(incident));
    for (const Prism& p : prisms) {
      const auto turn = simd::sincos(simd::Doubles(p.start + 2 * pi * t.phase(p.rotation_rate)));
      const auto wedge = simd::sincos(p.wedge);
      const double aside = p.inclined_exit ? -wedge.sin : wedge.sin;
      const Vec3Lanes square(-axis::forward);
      const Vec3Lanes inclined{turn.sin * aside, simd::Doubles{} - wedge.cos, turn.cos * aside};
      const double ratio = surrounding_index / p.refractive_index;
      passes &= detail::refract(light, p.inclined_exit ? square : inclined, ratio);
      passes &= detail::refract(light, p.inclined_exit ? inclined : square, 1 / ratio);
    }
    return passes;
  }
};

}  // namespace PULSECAST_NAMESPACE

#endif
