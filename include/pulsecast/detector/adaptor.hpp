// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_DETECTOR_ADAPTOR_HPP
#define PULSECAST_DETECTOR_ADAPTOR_HPP

#include <pulsecast/concepts.hpp>

namespace PULSECAST_NAMESPACE {

/// Numbers the echoes of a pulse from 1, in their order.
inline void number_echoes(std::span<Echo> echoes) noexcept {
  std::uint8_t number = 0;
  for (Echo& echo : echoes) echo.number = ++number;
}

namespace detail {
/// Sorts the echoes of a pulse by range, and numbers them.
inline void number_by_range(std::span<Echo> echoes) noexcept {
  std::ranges::sort(echoes, {}, &Echo::range);
  number_echoes(echoes);
}
}  // namespace detail

/// Base of detectors around another one, `inner`, whose members it has, the optional ones included,
/// unless a derived detector defines them: docs/cookbook.md, or `SelectedReturns`.
template <Detector Inner>
struct DetectorAdaptor {
  static_assert(detail::detector_checked<Inner>);
  Inner inner;  ///< detector inside

  static constexpr bool runs_without_reflections = RunsWithoutReflections<Inner>;  ///< that of `inner`
  static constexpr bool reads_velocity = ReadsVelocity<Inner>;                     ///< that of `inner`

  void validate() const {
    if constexpr (Validated<Inner>) inner.validate();
  }
  /// Refuses the lasers that the detector inside refuses. @throws SettingError
  void validate(const Laser& laser) const {
    if constexpr (ValidatesLaser<Inner>) inner.validate(laser);
  }
  /// Prepares the detector inside for the pulses of a laser. @throws SettingError as that does
  void prepare(const Laser& laser) requires PreparesForLasers<Inner> { inner.prepare(laser); }
  void normalize() noexcept requires Normalizable<Inner> { inner.normalize(); }

  [[nodiscard]] double sample_interval() const noexcept requires SamplesWaveforms<Inner> {
    return inner.sample_interval();
  }

  [[nodiscard]] auto workspace(std::size_t reflections) const { return inner.workspace(reflections); }

  [[nodiscard]] Detection detect(const DetectorInput& input, auto& workspace) const noexcept {
    return inner.detect(input, workspace);
  }
};

}  // namespace PULSECAST_NAMESPACE

#endif
