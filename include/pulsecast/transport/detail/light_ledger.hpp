// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_TRANSPORT_DETAIL_LIGHT_LEDGER_HPP
#define PULSECAST_TRANSPORT_DETAIL_LIGHT_LEDGER_HPP

#include <pulsecast/material/material.hpp>
#include <pulsecast/transport/detail/returned_light.hpp>

namespace PULSECAST_NAMESPACE::detail {

/// Way by which light came to where it ends.
struct PathState {
  ReflectionKind kind = ReflectionKind::surface;  ///< kind of the way
  double share = 0;                               ///< share of the pulse's energy that arrives
  double velocity = 0;                            ///< rate at which the optical path grows [m/s]
};

/// Share of a retroreflector's Gaussian lobe that the aperture catches from where light spreads as
/// over a range [m], by that of a much wider lobe; 1 without a width.
inline double aperture_fraction(const LinkBudget& budget, const Material& material, double range) noexcept {
  const double half_angle = material.law.returned_half_angle();
  if (!(half_angle > 0)) return 1;
  const double apertures = budget.aperture_radius() / (half_angle * range), x = 2 * apertures * apertures;
  return x > 0 ? -std::expm1(-x) / x : 1;
}

/// Account of one pulse: shares of its energy by their end, and reflections.
class LightLedger {
 public:
  EnergyLedger shares{};  ///< shares of the energy sent

  LightLedger(const TransportInput& light, std::span<Reflection> reflections, TransportResult& result) noexcept
      : light_(light), reflections_(reflections), result_(result) {}

  /// Light that misses at a range: NaN if the map answered so.
  void miss(double share, double range) noexcept {
    result_.nan |= std::isnan(range);
    shares.missed += share;
  }

  /// Counts the share of the light that a surface scatters, what it keeps, and what returns [W].
  /// The range of the hit is half the optical path [m].
  void end_at(const Hit& hit, const Material& material, double power, const PathState& way) noexcept {
    met_ = true;
    const double scattered = hit.scattered_share;
    const double kept = material.smooth.passes_light() ? 0 : 1 - scattered;
    if (!light_.gate.contains(hit.range)) {
      shares.out_of_range += (scattered + kept) * way.share;
      return;
    }
    in_gate_ = true;
    shares.absorbed += kept * way.share;
    result_.nan |= std::isnan(power);
    if (power > 0)
      reflect(hit, power, {way.kind, scattered * way.share, way.velocity});
    else
      shares.scattered += scattered * way.share;
  }

  /// Adds a reflection of a power [W], for light that is scattered or comes back into the aperture.
  void reflect(const Hit& hit, double power, const PathState& way) noexcept {
    met_ = true;
    if (!light_.gate.contains(hit.range)) {
      shares.out_of_range += way.share;
      return;
    }
    in_gate_ = true;
    if (result_.reflections == reflections_.size()) {
      shares.cut += way.share;
      return;
    }
    shares.scattered += way.share;
    received_ += power;
    Reflection& reflection = reflections_[result_.reflections++];
    set_reflection(reflection, hit, power);
    reflection.kind = way.kind;
    reflection.velocity = way.velocity;
  }

  /// Adds the power of a continuous return from inside the gate [W].
  void receive(double power) noexcept { received_ += power; }

  /// Enters the sums and the continuous returns into the result.
  void close(std::span<const ContinuousReturn> continuous) noexcept {
    result_.continuous = continuous;
    const double sent = light_.energy();
    result_.fate = in_gate_ ? Fate::absorbed : met_ ? Fate::out_of_range : Fate::missed;
    result_.energy = shares.times(sent);
    result_.energy.sent = sent;
    result_.energy.received = received_ * light_.emitter.laser.pulse_length;
  }

 private:
  const TransportInput& light_;
  std::span<Reflection> reflections_;
  TransportResult& result_;
  double received_ = 0;  ///< power [W]
  bool met_ = false, in_gate_ = false;
};

}  // namespace PULSECAST_NAMESPACE::detail

#endif
