// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include <pulsecast/base/tick.hpp>
#include <pulsecast/base/vector.hpp>

namespace pulsecast {

/// Number of an object of the scene, as its user chose it.
using ObjectId = std::uint32_t;

/// What one subray met: numbers only, so that any map can answer.
struct Hit {
  double range = std::numeric_limits<double>::infinity();  ///< from the pulse's origin; infinite if nothing was met [m]
  double cos_incidence = 1;                                ///< cosine of the angle between beam and surface normal, in [0, 1]
  double backscatter = 1;  ///< reflectance times the angular law, cosine included: 1 for a white Lambertian surface met squarely
  ObjectId object = 0;
  std::uint16_t classification = 0;

  [[nodiscard]] bool met() const noexcept { return range < std::numeric_limits<double>::infinity(); }
};

/// One return of a pulse, as the instrument reports it.
struct Echo {
  double range = 0;                  ///< along the pulse's axis [m]
  double amplitude = 0;              ///< received power at the echo's peak [W]
  double reflectance = 0;            ///< amplitude as a share of that of a white Lambertian surface met squarely at this range
  double width = 0;                  ///< standard deviation in time; 0 if not asked for, NaN if none was found [s]
  double cos_incidence = 1;          ///< of the strongest contributor
  ObjectId object = 0;               ///< of the strongest contributor
  std::uint16_t classification = 0;  ///< of the strongest contributor
  std::uint8_t number = 1;           ///< return number, from 1 in order of `range`
};

/// What became of a pulse slot. A sink sees all pulses, with or without echoes: slots that were blocked are counted, not handed on.
enum class Fate : std::uint8_t {
  returned,         ///< at least one echo
  blocked,          ///< the optic let no pulse out
  missed,           ///< no subray met anything
  out_of_range,     ///< met something, but nothing inside the range gate
  below_threshold,  ///< light came back from inside the range gate, but none that the detector takes for an echo
  absorbed,         ///< met something inside the range gate, but no light came back: it was black, met edge-on, or too far in the haze
};
inline constexpr std::size_t fate_count = 6;

/// A pulse that was sent, as the instrument reports it.
struct Shot {
  PulseIndex index = 0;
  Tick tick{};               ///< when it left, since the survey's start
  Vec3 origin{};             ///< in the world [m]
  Vec3 direction{};          ///< unit, in the world
  double scan_angle = 0;     ///< as in `Pulse` [rad]
  std::uint16_t leg = 0;     ///< number of the leg, from 0
  std::uint8_t channel = 0;  ///< number of the emitter, from 0
  Fate fate = Fate::missed;
  std::uint32_t first_echo = 0;    ///< of its echoes in the batch
  std::uint32_t echoes = 0;        ///< how many
  std::uint64_t first_sample = 0;  ///< of its waveform in the batch
  std::uint32_t samples = 0;       ///< how many; 0 if waveforms are not kept
  double waveform_start = 0;       ///< two-way travel time of the first sample [s]
};

/// What one subray of a pulse brought back, for those who study footprints. A subray that met nothing has an infinite range.
struct SubrayHit : Hit {
  double power = 0;  ///< received, as if the pulse had no length; 0 from outside the range gate [W]
  Vec3 point{};      ///< where it met something, as the instrument takes its pose: in the world [m]
};

/// A run of consecutive pulses and what came back, in pulse order. The spans live as long as the call of the sink.
struct EchoBatch {
  std::span<const Shot> shots;
  std::span<const Echo> echoes;          ///< those of one shot stand together, sorted by the range that is reported
  std::span<const float> samples;        ///< waveforms: received power [W]
  double sample_interval = 0;            ///< between two samples of a waveform [s]
  std::span<const SubrayHit> subrays{};  ///< all of each shot, in the order of the footprint; empty unless it is `WithSubrayRecord`

  [[nodiscard]] std::span<const Echo> echoes_of(const Shot& s) const noexcept { return echoes.subspan(s.first_echo, s.echoes); }
  [[nodiscard]] std::span<const float> waveform_of(const Shot& s) const noexcept { return samples.subspan(s.first_sample, s.samples); }

  /// Of the shot that stands at this place in `shots`.
  [[nodiscard]] std::span<const SubrayHit> subrays_of(std::size_t shot) const noexcept {
    const std::size_t each = subrays.size() / shots.size();
    return subrays.subspan(shot * each, each);
  }
};

/// Where an echo is in the world [m].
[[nodiscard]] inline Vec3 point_of(const Shot& shot, const Echo& echo) noexcept { return shot.origin + shot.direction * echo.range; }

}  // namespace pulsecast
