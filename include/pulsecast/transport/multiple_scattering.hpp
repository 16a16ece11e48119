// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_TRANSPORT_MULTIPLE_SCATTERING_HPP
#define PULSECAST_TRANSPORT_MULTIPLE_SCATTERING_HPP

#include <pulsecast/base/require.hpp>
#include <pulsecast/base/vector.hpp>

namespace PULSECAST_NAMESPACE {

/// Light that is scattered more than once before it returns.
struct MultipleScattering {
  std::size_t orders = 1;       ///< most surfaces that scatter it, from 1 to 64; 1: none of it
  std::size_t paths = 8;        ///< number of random paths of a pulse, from 1 to 100,000
  double field_of_view = 2e-3;  ///< full angle that the receiver sees, from the beam's to 2 pi [rad]

  void validate() const {
    require_within("MultipleScattering::orders", orders, 1, 64, "");
    require_within("MultipleScattering::paths", paths, 1, 100'000, "");
    require_within("MultipleScattering::field_of_view", field_of_view, 0, 2 * pi * (1 + 1e-9), "rad");
  }
  /// Number of reflections that it may add to a pulse.
  [[nodiscard]] std::size_t reflections() const noexcept { return (orders - 1) * paths; }
};

}  // namespace PULSECAST_NAMESPACE

#endif
