// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_MATERIAL_MEDIUM_HPP
#define PULSECAST_MATERIAL_MEDIUM_HPP

#include <pulsecast/base/require.hpp>

namespace PULSECAST_NAMESPACE {

/// Medium that light passes through: glass, water, fog.
struct Medium {
  double index = 1;        ///< refractive index, from 1 to 4
  double group_index = 0;  ///< vacuum speed by that of a pulse, from 1 to 4; 0: that of `index`
  double absorption = 0;   ///< share absorbed per metre, for short ways [1/m]
  double scattering = 0;   ///< share scattered per metre, for short ways [1/m]
  double backscatter = 0;  ///< share scattered straight back, at most `scattering` [1/(m sr)]

  void validate() const {
    require_within("Medium::index", index, 1, 4, "");
    if (group_index != 0) require_within("Medium::group_index", group_index, 1, 4, "");
    require_not_negative("Medium::absorption", absorption, "1/m");
    require_not_negative("Medium::scattering", scattering, "1/m");
    require_within("Medium::backscatter", backscatter, 0, scattering, "1/(m sr)");
  }

  /// Share of the light that is lost per metre, for short ways [1/m].
  [[nodiscard]] double extinction() const noexcept { return absorption + scattering; }
  /// Medium of two at the same place, with the index of the first: fog and rain.
  [[nodiscard]] Medium with(const Medium& other) const noexcept {
    return {index, group_index, absorption + other.absorption, scattering + other.scattering,
            backscatter + other.backscatter};
  }
  /// Vacuum speed of light by that of a pulse.
  [[nodiscard]] double delay() const noexcept { return group_index > 0 ? group_index : index; }
};

}  // namespace PULSECAST_NAMESPACE

#endif
