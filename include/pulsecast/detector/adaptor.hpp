// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_DETECTOR_ADAPTOR_HPP
#define PULSECAST_DETECTOR_ADAPTOR_HPP

#include <cstddef>
#include <cstdint>
#include <span>

#include <pulsecast/base/require.hpp>
#include <pulsecast/concepts.hpp>

namespace PULSECAST_NAMESPACE {

/// Numbers the echoes of a pulse from 1, in their order.
inline void number_echoes(std::span<Echo> echoes) noexcept {
  for (std::size_t e = 0; e < echoes.size(); ++e) echoes[e].number = static_cast<std::uint8_t>(e + 1);
}

/// Base of detectors around another one, `inner`. It hands on whatever a derived detector does not define itself, so
/// that none of the optional members is lost:
///
///     template <Detector Inner>
///     struct LastEcho : DetectorAdaptor<Inner> {
///       Detection detect(const DetectorInput& input, auto& workspace) const noexcept { ... this->inner.detect(input,
///       workspace) ... }
///     };
///     template <Detector Inner>
///     LastEcho(Inner) -> LastEcho<Inner>;  // so that LastEcho{FullWaveform{}} names no type
template <Detector Inner>
struct DetectorAdaptor {
  static_assert(detail::detector_checked<Inner>);
  Inner inner;  ///< detector inside

  static constexpr bool runs_without_reflections = RunsWithoutReflections<Inner>;  ///< as of the detector inside
  static constexpr bool reads_velocity = ReadsVelocity<Inner>;                     ///< as of the detector inside

  /// Validates the detector inside. @throws SettingError
  void validate() const {
    if constexpr (Validated<Inner>) inner.validate();
  }
  /// Refuses the lasers that the detector inside refuses. @throws SettingError
  void validate(const Laser& laser) const {
    if constexpr (ValidatesLaser<Inner>) inner.validate(laser);
  }
  /// Prepares the detector inside for the pulses of a laser. @throws SettingError as that does
  void prepare(const Laser& laser) requires PreparesForLasers<Inner> { inner.prepare(laser); }
  /// Normalizes the detector inside.
  void normalize() noexcept requires Normalizable<Inner> { inner.normalize(); }

  /// Sample spacing of waveforms [s].
  [[nodiscard]] double sample_interval() const noexcept requires SamplesWaveforms<Inner> {
    return inner.sample_interval();
  }

  /// Scratch memory of the detector inside.
  [[nodiscard]] auto workspace(std::size_t reflections) const { return inner.workspace(reflections); }

  /// Echoes of the detector inside.
  template <class Workspace>
  [[nodiscard]] Detection detect(const DetectorInput& input, Workspace& workspace) const noexcept {
    return inner.detect(input, workspace);
  }
};

}  // namespace PULSECAST_NAMESPACE

#endif
