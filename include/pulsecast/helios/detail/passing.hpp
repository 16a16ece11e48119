// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_PASSING_HPP
#define PULSECAST_HELIOS_DETAIL_PASSING_HPP

#include <pulsecast/platform/ground_vehicle.hpp>
#include <pulsecast/platform/multicopter.hpp>

/// Times at which a planned path passes its waypoints.
namespace PULSECAST_NAMESPACE::helios::detail {

/// Time after `from` at which a plan is horizontally nearest to waypoint `number` at `place` [s].
template <class Plan>
[[nodiscard]] double nearest_moment(const Plan& plan, std::size_t number, const Vec3& place, double from,
                                    double whole) {
  const auto distance = [&](double t) {
    const Tick tick = Tick::of_seconds(t);
    Vec3 off = -place;
    if constexpr (std::same_as<Plan, MulticopterFlight>)
      off += plan.motion().at(tick).position;
    else
      off += plan.at(tick).position;
    return std::hypot(off.x, off.y);
  };
  constexpr int steps = 20'000;
  const double step = (whole - from) / steps;
  const auto after = [&](int i) { return distance(from + i * step); };
  int nearest = steps;
  if constexpr (std::same_as<Plan, MulticopterFlight>) {  // it gives an approximate time
    const double begun = (plan.passes()[number].seconds() - from) / step;
    nearest = begun > 0 ? static_cast<int>(std::min(begun, static_cast<double>(steps))) : 0;
    while (nearest > 0 && after(nearest - 1) < after(nearest)) --nearest;
    while (nearest < steps && after(nearest + 1) <= after(nearest)) ++nearest;
  } else {  // the first local minimum within 1 m of the global one
    double least = after(0), before = least;
    for (int i = 1; i <= steps; ++i) least = std::min(least, after(i));
    for (int i = 1; i <= steps && nearest == steps; ++i) {
      const double now = after(i);
      if (now > before && before <= least + 1) nearest = i - 1;
      before = now;
    }
  }
  const double best = nearest < steps ? from + nearest * step : whole;
  // Ternary search: slower than a golden-section search, and as exact.
  double low = std::max(from, best - step), high = std::min(whole, best + step);
  for (int i = 0; i < 60; ++i) {
    const double a = low + (high - low) / 3, b = high - (high - low) / 3;
    const bool first_is_nearer = distance(a) < distance(b);
    (first_is_nearer ? high : low) = first_is_nearer ? b : a;
  }
  return 0.5 * (low + high);
}

/// Flight over its waypoints: up to 8 rounds move them outwards, as turns cut corners, until all miss by less than 1
/// cm.
[[nodiscard]] inline MulticopterFlight flight_over(std::vector<FlightPoint> points, const MulticopterSettings& s) {
  const std::vector<FlightPoint> wanted = points;
  MulticopterFlight flight = plan_multicopter(points, s);
  if (s.turn != MulticopterTurn::smooth) return flight;
  for (int round = 0; round < 8; ++round) {
    double from = 0, most = 0;
    const double whole = flight.duration().seconds();
    for (std::size_t i = 1; i + 1 < points.size(); ++i) {
      from = nearest_moment(flight, i, wanted[i].position, from, whole);
      const Vec3 miss = wanted[i].position - flight.at(Tick::of_seconds(from)).position;
      points[i].position += miss;
      most = std::max(most, length(miss));
    }
    if (most < 0.01) break;
    flight = plan_multicopter(points, s);
  }
  return flight;
}

/// First time at which a flight heads for `place` within 1 degree; `from` if there is none [s].
[[nodiscard]] inline double end_of_turn(const MulticopterFlight& flight, double from, const Vec3& place, double until) {
  for (double t = from; t < until; t += 0.01) {
    const auto state = flight.motion().at(Tick::of_seconds(t));
    const Vec3 way = place - state.position;
    if (dot(state.velocity, way) >= std::cos(radians(1)) * length(state.velocity) * length(way)) return t;
  }
  return from;
}

}  // namespace PULSECAST_NAMESPACE::helios::detail

#endif
