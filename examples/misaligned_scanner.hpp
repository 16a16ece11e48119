// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <pulsecast/deflector/aim.hpp>
#include <pulsecast/scanner/scanner.hpp>

/// Panoramic scanner whose parts are not where it takes them to be, in the frame of its head: y forward, z up, and the
/// axis of the mirror to the left. The laser shines along this axis onto a mirror at 45 degrees, which sweeps the beam
/// through a whole turn of zenith angles. So a head that turns once around sees every place twice: in face 1, and with
/// head and mirror reversed in face 2.
namespace misaligned {

using namespace pulsecast;

/// Misalignments of its parts: those of Muralikrishnan et al. 2015 but for encoders and the wobble of the head's axis.
enum Parameter : std::size_t {
  x1n,  ///< beam before the mirror, offset forward [m]
  x1z,  ///< the same, offset upwards [m]
  x2,   ///< mirror's axis, offset forward from the head's [m]
  x3,   ///< mirror, offset along its axis [m]
  x4,   ///< index of the zenith angle [rad]
  x5n,  ///< beam before the mirror, tilted forward [rad]
  x5z,  ///< the same, tilted upwards [rad]
  x6,   ///< mirror, tilted against its axis [rad]
  x7,   ///< mirror's axis, tilted about forward [rad]
  x10,  ///< zero of ranges [m]
  parameter_count
};
inline constexpr std::array names{"x1n", "x1z", "x2", "x3", "x4", "x5n", "x5z", "x6", "x7", "x10"};
using Parameters = std::array<double, parameter_count>;

/// Normal draws with these standard deviations.
inline Parameters drawn(const Parameters& deviations, std::uint64_t seed) {
  Parameters x{};
  for (std::size_t k = 0; k < x.size(); ++k) x[k] = deviations[k] * normal({seed, k, 0, Purpose::calibration});
  return x;
}

inline const Vec3 forward = axis::forward, left = -axis::right;
/// Direction of the beam at a zenith angle [rad], and direction in which it moves as the angle grows.
inline Vec3 beam_at(double zenith) { return std::sin(zenith) * forward + std::cos(zenith) * axis::up; }
inline Vec3 ahead_at(double zenith) { return std::cos(zenith) * forward - std::sin(zenith) * axis::up; }

/// Beam that it reports at a zenith angle: from where the axes cross.
inline Pose<frame::Beam, frame::Instrument> reported_beam(double zenith) { return aimed_above(pi / 2 - zenith); }

/// Beam that leaves it at this reading: traced from the laser over the mirror, without approximation.
inline Pose<frame::Beam, frame::Instrument> true_beam(const Parameters& x, double zenith) {
  const double mirror = pi / 4 + x[x6];
  const Vec3 normal = std::cos(mirror) * left - std::sin(mirror) * beam_at(zenith + x[x4]);
  const Vec3 laser = normalize(left + x[x5n] * forward + x[x5z] * axis::up);
  const Vec3 offset = x[x1n] * forward + x[x1z] * axis::up;
  const double to_mirror = -dot(offset, normal) / dot(laser, normal);
  const Vec3 direction = laser - 2 * dot(laser, normal) * normal;
  const Vec3 exit = offset + to_mirror * laser + (x[x10] - to_mirror) * direction + x[x3] * left;
  const Rotation tilt = rotation_about(forward, x[x7]), reported = reported_beam(zenith).rotation;
  const Rotation deflection = aimed_along(conjugate(reported) * (tilt * direction)).rotation;
  return {reported * deflection, x[x2] * forward + tilt * exit};
}

/// Displacement of true points from reported ones for each parameter, to first order: a translation, and a rotation
/// about the exit of the beam.
struct Form {
  Vec3 moved{}, turned{};
  [[nodiscard]] Vec3 at(const Vec3& from_exit) const { return moved + cross(turned, from_exit); }
};

/// Forms at a zenith angle. Source: Muralikrishnan et al. 2015, whose corrections of range, horizontal angle and zenith
/// angle they are; face 2 follows from zenith angles beyond pi.
inline std::array<Form, parameter_count> forms_at(double zenith) {
  const Vec3 beam = beam_at(zenith), ahead = ahead_at(zenith);
  const double s = std::sin(zenith), c = std::cos(zenith);
  const Vec3 by_forward = s * left + c * ahead, by_up = c * left - s * ahead;  // reflected into the cross-section
  return {Form{by_forward},
          {by_up},
          {forward},
          {left},
          {{}, left},
          {{}, cross(beam, by_forward)},
          {{}, cross(beam, by_up)},
          {{}, 2.0 * cross(beam, left)},
          {{}, forward},
          {beam}};
}

/// Laser and mirror. A `Deflector` with a `RotatingHead` makes a scanner of them.
struct MirrorUnit {
  using refinements = refines<tag::MeasuresBeam, tag::StatesErrors>;
  Scanner scanner{};           ///< laser
  double rotation_rate = 10;   ///< of the mirror [Hz]
  Parameters misalignments{};  ///< its own
  Parameters deviations{};     ///< standard deviations of the population that these were drawn from

  [[nodiscard]] double zenith(Tick t) const noexcept { return 2 * pi * t.phase(rotation_rate); }

  [[nodiscard]] PulseIndex size() const noexcept { return scanner.size(); }
  [[nodiscard]] Tick duration() const noexcept { return scanner.duration(); }
  [[nodiscard]] std::vector<Emitter> emitters() const { return scanner.emitters(); }
  [[nodiscard]] std::optional<Pulse<frame::Instrument>> pulse(PulseIndex i) const noexcept {
    const Pulse<frame::Beam> fired = *scanner.pulse(i);
    return Pulse<frame::Instrument>(true_beam(misalignments, zenith(fired.tick)), fired);
  }
  /// Reports where the beam would leave it without misalignments.
  [[nodiscard]] std::optional<Pose<frame::Beam, frame::Instrument>> measured(PulseIndex, Tick t) const noexcept {
    return reported_beam(zenith(t));
  }
  /// States what to expect of it: the same for all its pulses.
  void visit_errors(PulseIndex, Tick t, const auto& visit) const noexcept {
    const auto forms = forms_at(zenith(t));
    for (std::size_t k = 0; k < forms.size(); ++k)
      if (deviations[k] > 0)
        visit(PoseError<frame::Instrument>{
            -deviations[k] * forms[k].moved, -deviations[k] * forms[k].turned, {}, ErrorScope::survey});
  }
  void validate() const { scanner.validate(); }
};

static_assert(InstrumentSource<MirrorUnit> && MeasuresBeam<MirrorUnit> && StatesErrors<MirrorUnit>);

}  // namespace misaligned
