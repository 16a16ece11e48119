// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_REFLECTION_HPP
#define PULSECAST_REFLECTION_HPP

#include <pulsecast/base/random.hpp>
#include <pulsecast/echo.hpp>
#include <pulsecast/pulse.hpp>

/// Light that returns from the scene: the result of a transport, and the input of a detector.
namespace PULSECAST_NAMESPACE {

/// Light that returned along one path of a subray: the input of a detector.
struct Reflection {
  double range = 0;                               ///< half the optical path from the pulse's origin and back [m]
  double power = 0;                               ///< received power for a pulse of zero length; greater than 0 [W]
  ObjectId object = 0;                            ///< as in `Hit`
  std::uint16_t classification = 0;               ///< as in `Hit`
  ReflectionKind kind = ReflectionKind::surface;  ///< way of the light
  double cos_incidence = 1;                       ///< as in `Hit`
  double velocity = 0;  ///< velocity of the surface along the ray, positive away; set for `ReadsVelocity` [m/s]
};

/// Light that returned from all ranges of a stretch, as from haze or water: a power by range that is linear from end to
/// end. It is no echo by itself, as its waveform has a maximum only where it begins or grows.
struct ContinuousReturn {
  double begin = 0, end = 0;         ///< ends of the stretch, as `Reflection::range` [m]
  double at_begin = 0, at_end = 0;   ///< received power by range there, for a pulse of zero length; not negative [W/m]
  ObjectId object = 0;               ///< as in `Hit`
  std::uint16_t classification = 0;  ///< as in `Hit`
  ReflectionKind kind = ReflectionKind::air;  ///< way of the light

  /// Power of the whole stretch [W].
  [[nodiscard]] double power() const noexcept { return 0.5 * (at_begin + at_end) * (end - begin); }
};

/// Result of a transport for one pulse.
struct TransportResult {
  EnergyLedger energy{};        ///< energy of the pulse by the end of its paths
  std::size_t reflections = 0;  ///< number of reflections
  Fate fate = Fate::missed;     ///< fate of a pulse of which no light returned: `missed`, `out_of_range` or `absorbed`
  bool nan = false;             ///< true if the map answered with NaN: an error of the run
  bool spread = false;          ///< true if the light was spread over a smooth surface: `spread_over_plane`
  bool unresolved = false;      ///< true if more subrays would have been needed for that than there is room for
  /// What returned from no one place, by ascending begin; stretches may overlap. In the workspace, until that is used
  /// again.
  std::span<const ContinuousReturn> continuous{};

  /// True if no light returned.
  [[nodiscard]] bool dark() const noexcept { return reflections == 0 && continuous.empty(); }
};

/// Input of a detector for one pulse.
struct DetectorInput {
  const Emitter& emitter;               ///< emitter of the pulse
  RangeGate gate{};                     ///< range gate of the receiver
  std::span<Reflection> reflections{};  ///< all reflections, in any order; a detector may reorder and change them
  RandomKey key{};                      ///< seed of the survey, and index of the pulse
  /// As in `TransportResult`. A detector that does not read them hears the surfaces alone, dimmed by what is between.
  std::span<const ContinuousReturn> continuous{};
};

/// Result of a detector for one pulse; the spans stay valid until the workspace is used again.
struct Detection {
  std::span<Echo> echoes;           ///< sorted by range; the survey fills in `reflectance`
  std::span<const float> waveform;  ///< received power [W]; empty if not kept
  double waveform_start = 0;        ///< two-way travel time of the first sample [s]
};

}  // namespace PULSECAST_NAMESPACE

#endif
