// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_TRANSPORT_DIRECT_LIGHT_HPP
#define PULSECAST_TRANSPORT_DIRECT_LIGHT_HPP

#include <pulsecast/scene/find_hits.hpp>
#include <pulsecast/transport/detail/plane_spread.hpp>
#include <pulsecast/transport/detail/returned_light.hpp>

namespace PULSECAST_NAMESPACE {

/// Transport of light that first surfaces scatter straight back; the rest is absorbed.
struct DirectLight {
  bool spread_planes = true;  ///< spreads light over smooth surfaces: `spread_over_plane`

  struct Workspace {
    std::array<Hit, RayBundle::capacity> hits;  ///< hits of a bundle
    bool met_nothing = false;                   ///< true if the last pulse met nothing
    unsigned pass = 0;                          ///< pulses until another test of a cone, after one in vain
    SubrayDirections slope{};                   ///< subrays for a smooth surface
  };

  /// Room for the reflections of a pulse.
  [[nodiscard]] std::size_t reflections(std::size_t subrays) const noexcept {
    return spreads(subrays) ? std::max(subrays, slope_subrays_max) : subrays;
  }
  [[nodiscard]] Workspace workspace(std::size_t subrays) const {
    return {.hits = {}, .slope = spreads(subrays) ? SubrayDirections::room(slope_subrays_max) : SubrayDirections()};
  }

  /// Traces all subrays. After a pulse that met nothing, the beam's cone is tested first: the next one
  /// often meets nothing, too. Asks rays that return again for velocities, if `with_velocity`.
  // always inlined: a footprint of one subray is then known to be one, which saves 140 instructions
  template <bool with_velocity = false, Target Target>
  [[nodiscard, gnu::always_inline]] TransportResult trace(const Target& target, const TransportInput& light,
                                                          Workspace& w,
                                                          std::span<Reflection> reflections) const noexcept {
    TransportResult result;
    const bool may_spread = !with_velocity && spreads(light.subrays);  // while one is known to be one
    if (w.met_nothing && light.subrays > 1 && light.beam.from_a_point() && light.record.empty()) {
      if (w.pass == 0 && misses(target, light)) {
        result.energy.sent = light.energy();
        result.energy.missed = light.beam.share_sum * result.energy.sent;
        return result;
      }
      w.pass = w.pass == 0 ? 3 : w.pass - 1;
    }
    trace_subrays<with_velocity>(target, light, w, reflections, result);
    w.met_nothing = result.fate == Fate::missed;
    if (may_spread)
      if (const double span = span_of_ranges(light, reflections.first(result.reflections)); span > 1) [[unlikely]]
        spread(target, light, span, w, reflections, result);
    return result;
  }

  /// Result of a pulse of a single subray, as of `trace`, from its hit and the power that returns from a white surface
  /// there [W]. Sets the reflection, if there is one.
  [[nodiscard, gnu::always_inline]] static TransportResult of_hit(const Hit& hit, double white, const RangeGate& gate,
                                                                  const Laser& laser, Reflection& reflection) noexcept {
    const double energy = laser.energy();
    TransportResult result;
    result.energy.sent = energy;
    if (!hit.met()) {
      result.energy.missed = energy;
      result.nan = std::isnan(hit.range);
    } else if (!gate.contains(hit.range)) {
      result.fate = Fate::out_of_range;
      result.energy.out_of_range = energy;
    } else {
      const double power = hit.backscatter * white;
      result.fate = Fate::absorbed;
      result.energy.scattered = hit.scattered_share * energy;
      result.energy.absorbed = (1 - hit.scattered_share) * energy;
      result.nan = std::isnan(power);
      if (!(power > 0)) return result;
      result.energy.received = power * laser.pulse_length;
      result.reflections = 1;
      detail::set_reflection(reflection, hit, power);
    }
    return result;
  }

 private:
  [[nodiscard]] bool spreads(std::size_t subrays) const noexcept { return spread_planes && subrays > 2; }

  template <Target Target>
  [[gnu::noinline]] static void spread(const Target& target, const TransportInput& light, double span, Workspace& w,
                                       std::span<Reflection> reflections, TransportResult& result) noexcept {
    spread_over_plane(light, span, reflections, w.slope, result, [&](const TransportInput& again) noexcept {
      TransportResult other;
      for (Reflection& r : reflections.first(again.subrays)) r.velocity = 0;
      trace_subrays<false>(target, again, w, reflections, other);
      return other;
    });
  }

  template <bool with_velocity, Target Target>
  [[gnu::always_inline]] static void trace_subrays(const Target& target, const TransportInput& light, Workspace& w,
                                                   std::span<Reflection> reflections,
                                                   TransportResult& result) noexcept {
    const SubrayDirections& beam = light.beam;
    RayBundle rays;
    detail::set_origin(light, rays);
    const Matrix3 world_from_beam = matrix_of(light.pulse.pose.rotation);
    const bool from_a_point = beam.from_a_point();
    double missed = 0, out_of_range = 0, absorbed = 0, scattered = 0, received = 0;
    bool met = false, in_gate = false;
    RayBundle::Column power;
    for (std::size_t first = 0; first < light.subrays; first += rays.size) {
      rays.first_subray = static_cast<std::uint32_t>(first);
      rays.size = std::min(from_a_point ? RayBundle::capacity : 1, light.subrays - first);
      detail::set_directions(light, world_from_beam, first, rays);
      find_hits(target, rays, w.hits);
      if (all_missed(light, first, std::span(w.hits).first(rays.size), missed)) continue;
      detail::received_power(light, &beam.shares[first], rays.size, w.hits, power);
      if (!light.record.empty()) detail::record_subrays(light, first, std::span(w.hits).first(rays.size), power);
      for (std::size_t j = 0; j < rays.size; ++j) {
        const Hit& hit = w.hits[j];
        const double share = beam.shares[first + j];
        if (!hit.met()) {
          missed += share;
          result.nan |= std::isnan(hit.range);
          continue;
        }
        met = true;
        if (!light.gate.contains(hit.range)) {
          out_of_range += share;
          continue;
        }
        in_gate = true;
        const double back = share * hit.scattered_share;
        scattered += back;
        absorbed += share - back;
        if (!(power[j] > 0)) {
          result.nan |= std::isnan(power[j]);
          continue;
        }
        received += power[j];
        Reflection& reflection = reflections[result.reflections++];
        detail::set_reflection(reflection, hit, power[j]);
        if constexpr (with_velocity) reflection.velocity = detail::radial_velocity(target, rays.ray(j));
      }
    }
    result.fate = in_gate ? Fate::absorbed : met ? Fate::out_of_range : Fate::missed;
    const double sent = light.energy();
    result.energy = {.sent = sent,
                     .missed = missed * sent,
                     .out_of_range = out_of_range * sent,
                     .absorbed = absorbed * sent,
                     .scattered = scattered * sent,
                     .received = received * light.emitter.laser.pulse_length};
  }

  /// Adds the shares of subrays from `first` on to `missed`, and returns true, if none meets anything.
  static bool all_missed(const TransportInput& light, std::size_t first, std::span<const Hit> hits,
                         double& missed) noexcept {
    for (const Hit& hit : hits)
      if (hit.range != detail::infinity || !light.record.empty()) return false;  // a NaN is none
    for (std::size_t j = 0; j < hits.size(); ++j) missed += light.beam.shares[first + j];
    return true;
  }

  /// True only if no subray of a beam from a point meets anything.
  template <Target Target>
  [[nodiscard]] static bool misses(const Target& target, const TransportInput& light) noexcept {
    const Pose<frame::Beam, frame::World>& pose = light.pulse.pose;
    const double spread = 1.01 * light.beam.spread;  // rotations are unit within a thousandth
    return detail::misses_cone(target, RayCone{pose.position, matrix_of(pose.rotation)[1], spread, light.pulse.tick});
  }
};

}  // namespace PULSECAST_NAMESPACE

#endif
