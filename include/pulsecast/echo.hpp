// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_ECHO_HPP
#define PULSECAST_ECHO_HPP

#include <span>

#include <pulsecast/base/scan_angle.hpp>
#include <pulsecast/hit.hpp>

namespace PULSECAST_NAMESPACE {

/// Way that returned light took. Of several, the last in this list names it.
enum class ReflectionKind : std::uint8_t {
  surface,  ///< from a surface that the beam met directly
  glass,    ///< through glass or another clear body
  water,    ///< from water: its surface, its column, or what is under it
  mirror,   ///< by a mirror, or by glass or water that mirrored it: a ghost, as its surface is elsewhere
  air,      ///< from what is in the air: fog, rain, smoke
  multiple  ///< scattered by more than one surface
};
inline constexpr std::size_t reflection_kind_count = 6;  ///< number of kinds

/// One return of a pulse, as the instrument reports it.
struct Echo {
  double range = 0;          ///< distance along the pulse's axis [m]
  double amplitude = 0;      ///< received power at the echo's peak [W]
  double reflectance = 0;    ///< amplitude relative to a white Lambertian surface at normal incidence and this range
  double width = 0;          ///< standard deviation in time; 0 if not measured, NaN if not found [s]
  double cos_incidence = 1;  ///< cosine of incidence of the strongest contributor
  ObjectId object = 0;       ///< object of the strongest contributor
  std::uint16_t classification = 0;               ///< class of the strongest contributor
  std::uint8_t number = 1;                        ///< return number, from 1 in order of `range`
  ReflectionKind kind = ReflectionKind::surface;  ///< way of the light of the strongest contributor
  double velocity =
      std::numeric_limits<double>::quiet_NaN();  ///< radial velocity, positive away; NaN if not measured [m/s]
  float shape_deviation =
      std::numeric_limits<float>::quiet_NaN();  ///< of `ShapeDeviation`; NaN if not measured [1/1000]
  bool ambiguous = false;  ///< true if the instrument cannot exclude another range and velocity: of `Fmcw`
};

/// Fate of a pulse slot. A sink sees all pulses, with or without echoes, unless it `ChoosesShots`. Blocked slots are
/// counted, not passed on.
enum class Fate : std::uint8_t {
  returned,         ///< at least one echo
  blocked,          ///< the optic let no pulse out
  missed,           ///< no subray hit anything
  out_of_range,     ///< hits, but none inside the range gate
  below_threshold,  ///< light from inside the range gate, but no echo: too weak, or measured outside the gate
  absorbed,         ///< hits inside the range gate, but no light: black, edge-on, or too far in the haze
};
inline constexpr std::size_t fate_count = 6;  ///< number of fates

/// Energy of a pulse, or of all pulses of a run, by the end of its paths [J]. To rounding, `sent` is the sum of the
/// five terms that follow. Each term is summed from its own paths; none is the remainder.
struct EnergyLedger {
  double sent = 0;          ///< peak power times pulse length; the pulse shape makes some percent of difference
  double missed = 0;        ///< met nothing
  double out_of_range = 0;  ///< met a surface outside the range gate
  double absorbed = 0;      ///< absorbed by surfaces inside the range gate, and by media
  double scattered = 0;     ///< scattered by surfaces inside the range gate, and by media, in all directions
  double cut = 0;           ///< left on paths that the transport follows no further
  double received = 0;      ///< arrived at the receiver, of `scattered`

  /// Adds another ledger.
  void add(const EnergyLedger& other) noexcept {
    sent += other.sent;
    missed += other.missed;
    out_of_range += other.out_of_range;
    absorbed += other.absorbed;
    scattered += other.scattered;
    cut += other.cut;
    received += other.received;
  }

  /// Ledger of `factor` times the energy.
  [[nodiscard]] EnergyLedger times(double factor) const noexcept {
    return {factor * sent,      factor * missed, factor * out_of_range, factor * absorbed,
            factor * scattered, factor * cut,    factor * received};
  }

  /// Term by the energy sent, as `share(&EnergyLedger::missed)`; 0 if nothing was sent.
  [[nodiscard]] double share(double EnergyLedger::*term) const noexcept { return sent > 0 ? this->*term / sent : 0; }

  friend bool operator==(const EnergyLedger&, const EnergyLedger&) = default;
};

/// Distances inside which a receiver listens, and outside of which it reports no range; both included [m].
struct RangeGate {
  double near = 0;                                       ///< start [m]
  double far = std::numeric_limits<double>::infinity();  ///< end [m]

  /// True if a range [m] is within the gate.
  [[nodiscard]] bool contains(double range) const noexcept { return range >= near && range <= far; }
};

/// What the subrays of a pulse met, as of a `JudgedFootprint`.
enum class MetSurface : std::uint8_t {
  unjudged,  ///< not judged, or fewer than four rays
  smooth,    ///< all met one plane, to a fiftieth of the footprint's deviation, which is evenly bright
  mixed      ///< anything else
};

/// Pulse as reported by the instrument.
struct Shot {
  PulseIndex index = 0;                       ///< number of the slot
  Tick tick{};                                ///< emission time, since the survey's start
  Vec3 origin{};                              ///< exit of the beam, in the world [m]
  Vec3 direction{};                           ///< unit vector, in the world
  ScanAngle scan_angle{};                     ///< as in `Pulse` [rad]
  std::uint16_t leg = 0;                      ///< number of the leg, from 0
  std::uint16_t channel = 0;                  ///< number of the emitter in its device, from 0
  Fate fate = Fate::missed;                   ///< fate of the slot
  MetSurface surface = MetSurface::unjudged;  ///< what its subrays met
  std::uint32_t first_echo = 0;               ///< index of its first echo in the batch
  std::uint32_t echoes = 0;                   ///< number of its echoes
  std::uint64_t first_sample = 0;             ///< index of its first waveform sample in the batch
  std::uint32_t samples = 0;                  ///< number of its samples; 0 if waveforms are not kept
  double waveform_start = 0;                  ///< two-way travel time of the first sample [s]
};

/// Return of one subray of a pulse, for studies of footprints. Infinite range for a miss.
struct SubrayRecord : Hit {
  double power = 0;  ///< received power for a pulse of zero length; 0 outside the range gate [W]
  Vec3 point{};      ///< hit in the world, by the pose as known to the instrument [m]
};

/// Consecutive pulses and their returns, in pulse order. The spans are valid during the call of the sink.
struct EchoBatch {
  std::span<const Shot> shots;   ///< pulses emitted, in ascending order of slots; empty ones only if a sink reads them
  std::span<const Echo> echoes;  ///< contiguous per shot, sorted by reported range
  std::span<const float> samples;  ///< waveforms: received power [W]
  double sample_interval = 0;      ///< sample spacing of the waveforms [s]
  std::span<const SubrayRecord>
      subrays{};  ///< all of each shot, in the order of the footprint; empty unless it is `WithSubrayRecord`

  /// Echoes of a shot of this batch.
  [[nodiscard]] std::span<const Echo> echoes_of(const Shot& s) const noexcept {
    return {echoes.data() + s.first_echo, s.echoes};
  }
  /// Waveform of a shot of this batch [W]; empty if not kept.
  [[nodiscard]] std::span<const float> waveform_of(const Shot& s) const noexcept {
    return {samples.data() + s.first_sample, s.samples};
  }

  /// Subrays of the shot at this index in `shots`.
  [[nodiscard]] std::span<const SubrayRecord> subrays_of(std::size_t shot) const noexcept {
    const std::size_t each = subrays.size() / shots.size();
    return {subrays.data() + shot * each, each};
  }
};

/// Error of a pulse that makes its results worthless: NaN from a user's own type. `run` throws it.
enum class PulseError : std::uint8_t {
  none,
  pose,  ///< a pose is not finite: an error of the trajectory, optic or pose errors
  map,   ///< the map answered with a range or backscatter of NaN
};

/// Result of one pulse slot. The spans stay valid until the workspace is used again; the shot's indices into a batch
/// are not set.
struct Outcome {
  Shot shot;                                ///< pulse as reported
  std::span<const Echo> echoes;             ///< echoes, sorted by reported range
  std::span<const float> waveform;          ///< received power [W]; empty if not kept
  EnergyLedger energy{};                    ///< energy by the end of its paths; zero if nothing was sent [J]
  bool spread = false;                      ///< as in `TransportResult`
  bool unresolved = false;                  ///< as in `TransportResult`
  std::span<const SubrayRecord> subrays{};  ///< all subrays, if the footprint is `WithSubrayRecord`
  PulseError error = PulseError::none;      ///< makes the other members worthless, unless `none`
};

/// Position of an echo in the world [m].
[[nodiscard]] inline Vec3 point_of(const Shot& shot, const Echo& echo) noexcept {
  return shot.origin + shot.direction * echo.range;
}

}  // namespace PULSECAST_NAMESPACE

#endif
