// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_DEFLECTOR_RISLEY_PRISMS_HPP
#define PULSECAST_DEFLECTOR_RISLEY_PRISMS_HPP

#include <cmath>
#include <optional>
#include <vector>

#include <pulsecast/base/require.hpp>
#include <pulsecast/concepts.hpp>
#include <pulsecast/deflector/aim.hpp>

namespace PULSECAST_NAMESPACE {

/// Glass wedge that rotates about forward. One face is normal to forward, the other inclined. Unrotated, its thick end, towards which it
/// bends the beam, is below.
struct Prism {
  double wedge = pi / 10;          ///< angle between the faces [rad]
  double turns_per_second = 100;   ///< rotation rate, positive from up to the right as seen along forward; magnitude at most 1e12 [Hz]
  double refractive_index = 1.51;  ///< refractive index of the glass at the laser's wavelength
  double start = 0;                ///< rotation at the survey's start, from -2 pi to 2 pi [rad]
  bool inclined_exit = false;      ///< true if the beam leaves through the inclined face, false if it enters there
};

/// Unit direction of a refracted ray by Snell's law; empty at total reflection, or if the ray does not come from the front of the face.
/// `direction` and `normal` are unit, the normal on the front; `ratio` is the refractive index before the face divided by that behind it.
/// Source: Born & Wolf 1999, sec. 1.5.1, in vector form.
[[nodiscard]] inline std::optional<Vec3> refracted(const Vec3& direction, const Vec3& normal, double ratio) noexcept {
  const double cosine = -dot(direction, normal);
  const double sine_squared = ratio * ratio * (1 - cosine * cosine);
  if (!(cosine > 0 && sine_squared <= 1)) return std::nullopt;
  return normalize(ratio * direction + (ratio * cosine - std::sqrt(1 - sine_squared)) * normal);
}

/// Risley prisms: wedges in series, each rotating at its own rate, draw a rosette. Totally reflected light is blocked. The wedges bend the
/// beam without shifting it: thickness and distance are neglected.
struct RisleyPrisms {
  std::vector<Prism> prisms{};    ///< wedges in the order of the beam, from 1 to 16
  double surrounding_index = 1;   ///< refractive index between and around the prisms
  Vec3 incident = axis::forward;  ///< direction of the laser, of any length but zero

  void validate() const {
    require_within("RisleyPrisms::prisms (number)", static_cast<double>(prisms.size()), 1, 16, "");
    for (const Prism& p : prisms) {
      require_within("Prism::wedge", p.wedge, 0, 1.5, "rad");
      require_within("Prism::turns_per_second", p.turns_per_second, -1e12, 1e12, "Hz");
      require_within("Prism::refractive_index", p.refractive_index, 0.5, 10, "");
      require_angle("Prism::start", p.start);
    }
    require_within("RisleyPrisms::surrounding_index", surrounding_index, 0.5, 10, "");
    require_positive("RisleyPrisms::incident (length)", length(incident), "");
  }

  /// Unit direction of the beam behind the last wedge; empty at total reflection.
  [[nodiscard]] std::optional<Vec3> direction(Tick t) const noexcept {
    std::optional<Vec3> light = normalize(incident);
    for (const Prism& p : prisms) {
      const double turn = p.start + 2 * pi * t.phase(p.turns_per_second);
      const double aside = p.inclined_exit ? -std::sin(p.wedge) : std::sin(p.wedge);
      const Vec3 square = -axis::forward, inclined{std::sin(turn) * aside, -std::cos(p.wedge), std::cos(turn) * aside};
      const double ratio = surrounding_index / p.refractive_index;
      light = refracted(*light, p.inclined_exit ? square : inclined, ratio);
      if (light) light = refracted(*light, p.inclined_exit ? inclined : square, 1 / ratio);
      if (!light) return std::nullopt;
    }
    return light;
  }

  /// True if the beam gets through all wedges.
  [[nodiscard]] bool open(Tick t) const noexcept { return direction(t).has_value(); }

  [[nodiscard]] Pose<frame::Beam, frame::Instrument> at(Tick t) const noexcept { return aimed_along(direction(t).value_or(axis::forward)); }
};

static_assert(Optic<RisleyPrisms> && Gated<RisleyPrisms>);

}  // namespace PULSECAST_NAMESPACE

#endif
