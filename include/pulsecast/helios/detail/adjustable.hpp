// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_ADJUSTABLE_HPP
#define PULSECAST_HELIOS_DETAIL_ADJUSTABLE_HPP

#include <pulsecast/accuracy.hpp>
#include <pulsecast/helios/simulation.hpp>

namespace PULSECAST_NAMESPACE::helios::detail {

/// Settings of a simulation to choose from, in the order of `ReceiverOverrides::of`, for a pulse length and the
/// survey's own bins [s]. Refers to the simulation.
[[nodiscard]] inline AdjustableSurvey adjustable(const Simulation& simulation, double pulse_length, double own_bin) {
  const ReceiverOverrides best = simulation.reference();
  std::vector<double> bins{own_bin}, orders, paths{1};
  for (int power = -6; power < 4; ++power)
    for (const double digit : {1, 2, 5})
      if (const double bin = digit * std::pow(10.0, power) / 1e9;
          bin >= pulse_length / 64 && bin <= pulse_length / 4 && std::fabs(bin / own_bin - 1) > 1e-9)
        bins.push_back(bin);
  std::ranges::sort(bins, std::greater<>());
  for (const int order : {1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48})
    if (order < *best.orders) orders.push_back(order);
  orders.push_back(*best.orders);
  while (*best.orders > 1 && 4 * paths.back() < *best.paths) paths.push_back(2 * paths.back());
  return {
      .ladders = {{"beamSampleQuality", {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 12, 14, 17}, static_cast<double>(*best.rings)},
                  {"binSize_ns", bins, *best.bin_size},
                  {"orders", orders, static_cast<double>(*best.orders)},
                  {"paths", paths, static_cast<double>(*best.paths)}},
      .survey =
          [&simulation](AdjustableSurvey::Values values) {
            ReceiverOverrides overrides = ReceiverOverrides::of(values);
            overrides.ideal = true;
            return simulation.with_receivers(overrides)->survey();
          },
      // in rays: bins and the rest of a pulse by docs/tradeoff.md; two for each surface of a path
      .effort =
          [pulse_length](AdjustableSurvey::Values values) {
            return static_cast<double>(RingFootprint(static_cast<std::size_t>(values[0])).size()) + 10 +
                   0.1 * pulse_length / values[1] + 2 * (values[2] - 1) * values[3];
          }};
}

}  // namespace PULSECAST_NAMESPACE::helios::detail

#endif
