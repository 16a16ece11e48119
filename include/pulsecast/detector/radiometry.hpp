// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_DETECTOR_RADIOMETRY_HPP
#define PULSECAST_DETECTOR_RADIOMETRY_HPP

#include <pulsecast/base/extinction.hpp>
#include <pulsecast/base/random.hpp>
#include <pulsecast/base/search.hpp>
#include <pulsecast/base/shared_array.hpp>
#include <pulsecast/echo.hpp>
#include <pulsecast/pulse.hpp>

namespace PULSECAST_NAMESPACE {

/// Row of a table of range noise.
struct DeviationAtRange {
  double range = 0;      ///< true range [m]
  double deviation = 0;  ///< standard deviation of the noise at that range [m]
};

/// Range errors of an instrument, none by default.
struct RangeErrors {
  double bias = 0;                    ///< reported minus true range [m]
  double scale = 0;                   ///< reported minus true range, per metre of range
  double deviation = 0;               ///< standard deviation of the noise, at any range [m]
  double deviation_per_metre = 0;     ///< increase of the deviation per metre of range
  bool grows_with_incidence = false;  ///< by its cosine. Source: Soudarissanane et al. 2011
  double deviation_at_watt = 0;       ///< further, at 1 W [m]. Source: Wujanz et al. 2018
  double power_exponent = -0.5;       ///< exponent of the amplitude in that deviation, from -4 to 0
  /// Table that replaces both deviations if not empty, by ascending range: linear, constant beyond.
  SharedArray<DeviationAtRange> deviations{};
  SharedArray<double> channel_biases{};  ///< further bias by channel of `Emitter`; 0 beyond [m]
  double bias_deviation = 0;             ///< of a further bias, drawn once for a survey [m]
  double scale_deviation = 0;            ///< of a further scale, drawn once for a survey, from 0 to 0.5

  void validate() const {
    require_finite("RangeErrors::bias", bias, "m");
    require_not_negative("RangeErrors::deviation", deviation, "m");
    require_within("RangeErrors::scale", scale, -0.5, 0.5, "");
    require_not_negative("RangeErrors::deviation_per_metre", deviation_per_metre, "");
    require_not_negative("RangeErrors::deviation_at_watt", deviation_at_watt, "m");
    require_within("RangeErrors::power_exponent", power_exponent, -4, 0, "");
    require_not_negative("RangeErrors::bias_deviation", bias_deviation, "m");
    require_within("RangeErrors::scale_deviation", scale_deviation, 0, 0.5, "");
    for (const double offset : channel_biases) require_finite("RangeErrors::channel_biases", offset, "m");
    for (std::size_t i = 0; i < deviations.size(); ++i) {
      require_finite("RangeErrors::deviations (range)", deviations[i].range, "m");
      require_not_negative("RangeErrors::deviations (deviation)", deviations[i].deviation, "m");
      const double step = i > 0 ? deviations[i].range - deviations[i - 1].range : 1;
      require_positive("RangeErrors::deviations (from range to range)", step, "m");
    }
  }

  /// True without errors.
  [[nodiscard]] bool none() const noexcept {
    return bias == 0 && scale == 0 && deviation == 0 && deviation_per_metre == 0 && deviation_at_watt == 0 &&
           deviations.size() == 0 && channel_biases.size() == 0 && bias_deviation == 0 && scale_deviation == 0;
  }

  /// Standard deviation of the noise at a range, at normal incidence [m].
  [[nodiscard]] double deviation_at(double range) const noexcept {
    if (deviations.size() == 0) return deviation + deviation_per_metre * range;
    return detail::interpolated(deviations, range, &DeviationAtRange::range, &DeviationAtRange::deviation);
  }

  /// Standard deviation of the noise of an echo [m].
  [[nodiscard]] double noise_of(const Echo& echo) const noexcept {
    constexpr double least = 0.01;  // bounds the noise of an edge-on surface
    const double slant = !grows_with_incidence ? 1 : echo.cos_incidence > least ? echo.cos_incidence : least;
    const double by_power = deviation_at_watt > 0 ? deviation_at_watt * std::pow(echo.amplitude, power_exponent) : 0;
    return (deviation_at(echo.range) + by_power) / slant;
  }

  /// Reported minus true range without noise [m] of an echo of a channel.
  [[nodiscard]] double bias_of(const Echo& echo, std::size_t channel = 0) const noexcept {
    const double of_channel = channel < channel_biases.size() ? channel_biases[channel] : 0;
    return bias + of_channel + scale * echo.range;
  }

  /// Reported minus true range [m] of an echo of a channel, for a standard normal draw.
  [[nodiscard]] double at(const Echo& echo, double draw, std::size_t channel = 0) const noexcept {
    return bias_of(echo, channel) + draw * noise_of(echo);
  }

  /// The same errors, with the bias and scale that a survey of this seed draws added to theirs.
  [[nodiscard]] RangeErrors drawn(std::uint64_t seed, std::uint32_t receiver) const noexcept {
    RangeErrors errors = *this;  // `WithPoseErrors` draws numbers 0 to 4
    errors.bias += bias_deviation * normal({seed, 5, receiver, Purpose::calibration});
    errors.scale += scale_deviation * normal({seed, 6, receiver, Purpose::calibration});
    return errors;
  }

  /// Mean square of what is alike for all echoes of a survey: drawn once, or of a given size [m^2].
  [[nodiscard]] double systematic_variance(const Echo& echo, std::size_t channel = 0) const noexcept {
    const double known = bias_of(echo, channel), scaled = scale_deviation * echo.range;
    return known * known + bias_deviation * bias_deviation + scaled * scaled;
  }
};

namespace detail {

/// Echoes whose reported range is inside the gate, in order. Numbers stay in place.
[[nodiscard]] inline std::span<Echo> inside(const RangeGate& gate, std::span<Echo> echoes) noexcept {
  std::size_t kept = 0;
  for (std::size_t e = 0; e < echoes.size(); ++e) {
    if (!gate.contains(echoes[e].range)) continue;
    std::swap(echoes[e], echoes[kept]);
    std::swap(echoes[e].number, echoes[kept++].number);
  }
  return echoes.first(kept);
}

/// Sorts echoes by reported range, after errors. Numbers stay in place: echoes are renumbered.
/// Insertion sort: a pulse has few echoes, most of them in order.
inline void sort_by_range(std::span<Echo> echoes) noexcept {
  for (std::size_t unsorted = 1; unsorted < echoes.size(); ++unsorted)
    for (std::size_t e = unsorted; e > 0 && echoes[e].range < echoes[e - 1].range; --e) {
      std::swap(echoes[e - 1], echoes[e]);
      std::swap(echoes[e - 1].number, echoes[e].number);
    }
}

}  // namespace detail

/// Row of a table of overlap.
struct OverlapAtRange {
  double range = 0;  ///< range [m]
  double share = 1;  ///< share of the light scattered there that reaches the detector, in [0, 1]
};

/// Receiver of an instrument, and the atmosphere before it.
struct Receiver {
  double diameter = 0.15;                                      ///< aperture, from 0.1 mm to 1 km [m]
  double efficiency = 0.99;                                    ///< transmission of the optics, both ways, in [0, 1]
  double visibility = 23e3;                                    ///< at least 1; infinite without aerosols [m]
  AerosolModel aerosols = AerosolModel::kim;                   ///< extinction in haze and fog
  double absorption = 0;                                       ///< by molecules of the air [1/m]
  double range_min = 0;                                        ///< range gate's start [m]
  double range_max = std::numeric_limits<double>::infinity();  ///< range gate's end [m]
  RangeErrors range_errors{};                                  ///< errors of reported ranges
  /// Share of the light that the receiver sees, by ascending range, as of `aperture_overlap`:
  /// linear between rows, constant beyond them. All light if empty.
  SharedArray<OverlapAtRange> overlap{};

  void validate() const {
    require_within("Receiver::diameter", diameter, 1e-4, 1e3, "m");
    require_within("Receiver::efficiency", efficiency, 0, 1, "");
    require_within("Receiver::visibility", visibility, 1, std::numeric_limits<double>::infinity(), "m");
    require_not_negative("Receiver::absorption", absorption, "1/m");
    require_not_negative("Receiver::range_min", range_min, "m");
    range_errors.validate();
    for (std::size_t i = 0; i < overlap.size(); ++i) {
      require_finite("Receiver::overlap (range)", overlap[i].range, "m");
      require_within("Receiver::overlap (share)", overlap[i].share, 0, 1, "");
      const double step = i > 0 ? overlap[i].range - overlap[i - 1].range : 1;
      require_positive("Receiver::overlap (from range to range)", step, "m");
    }
    require_within("Receiver::range_max", range_max, range_min, std::numeric_limits<double>::infinity(), "m");
  }

  [[nodiscard]] RangeGate gate() const noexcept { return {range_min, range_max}; }  ///< range gate
};

/// Link budget: received power of a subray from the power of a pulse. Source: laser radar equation
/// for an extended target, Jelalian 1992, as Winiwarter et al. 2022. Close by, an aperture on the
/// axis collects sin^2 of half its angle: D^2 / (4 R^2 + D^2) for D^2 / (4 R^2).
class LinkBudget {
 public:
  /// Budget of no power.
  LinkBudget() = default;
  /// Takes valid settings.
  LinkBudget(const Receiver& receiver, const Laser& laser) noexcept
      : gain_(laser.peak_power * receiver.diameter * receiver.diameter * receiver.efficiency / 4),
        near_(receiver.diameter * receiver.diameter / 4),
        both_ways_(-2 * (extinction(laser.wavelength, receiver.visibility, receiver.aerosols) + receiver.absorption)),
        overlap_(receiver.overlap) {}

  [[nodiscard]] friend bool operator==(const LinkBudget& a, const LinkBudget& b) noexcept {
    return a.gain_ == b.gain_ && a.near_ == b.near_ && a.both_ways_ == b.both_ways_ &&
           a.overlap_.data() == b.overlap_.data();
  }

  /// Received power [W] of a subray with this share of the pulse's energy, from a surface of this
  /// backscatter (as in `Hit`) at a range [m]. At range 0 all the scattered power is received.
  [[nodiscard]] double power(double share, double backscatter, double range) const noexcept {
    const double all = power_in_view(share, backscatter, range);
    return sees_all() ? all : all * overlap_at(range);
  }

  /// Received power of a subray, or several [W], if the receiver sees all of the light.
  // always inlined: lanes of it were passed through memory
  template <class Number>
  [[nodiscard, gnu::always_inline]] Number power_in_view(const Number& share, const Number& backscatter,
                                                         const Number& range) const noexcept {
    return gain_ * share * backscatter / (range * range + near_) * exponential(Number(both_ways_ * range));
  }

  /// As `power`, of light that spreads as over a range [m], through so much air out and back [m].
  [[nodiscard]] double power_through(double share, double backscatter, double range, double air) const noexcept {
    const double power_in_air = power(share, backscatter, range);
    return air == range ? power_in_air : power_in_air * std::exp(both_ways_ * (air - range));
  }
  /// Received power [W] of a share of the pulse that comes back into the aperture after air [m].
  [[nodiscard]] double power_captured(double share, double air) const noexcept {
    return near_ > 0 ? gain_ / near_ * share * std::exp(both_ways_ * air / 2) : 0;
  }
  /// Share of the received power lost per metre of range, on both ways [1/m].
  [[nodiscard]] double loss() const noexcept { return -both_ways_; }
  /// Radius of the aperture [m].
  [[nodiscard]] double aperture_radius() const noexcept { return std::sqrt(near_); }

  [[nodiscard]] bool sees_all() const noexcept { return overlap_.empty(); }  ///< true if it sees all light
  /// Share of the light from a range [m] that the receiver sees.
  [[nodiscard]] double overlap_at(double range) const noexcept {
    return sees_all() ? 1 : detail::interpolated(overlap_, range, &OverlapAtRange::range, &OverlapAtRange::share);
  }

 private:
  double gain_ = 0;       ///< power by squared range of a white surface in vacuum [W m^2]
  double near_ = 0;       ///< square of half the aperture's diameter [m^2]
  double both_ways_ = 0;  ///< slope of the logarithm of the power over range [1/m]
  SharedArray<OverlapAtRange> overlap_{};
};

/// Power received from a white Lambertian target facing the beam, of one link budget. Keeps the
/// last result: the echo of a single ray has the range of its hit.
class WhiteTarget {
 public:
  WhiteTarget() = default;
  /// Keeps a known power [W] from a range [m].
  WhiteTarget(double range, double power) noexcept : range_(range), power_(power) {}

  /// Power received from a range [m] by the link budget, always the same one [W].
  [[nodiscard]] double power(const LinkBudget& budget, double range) noexcept {
    if (range != range_) {
      power_ = budget.power(1, 1, range);
      range_ = range;
    }
    return power_;
  }

 private:
  double range_ = std::numeric_limits<double>::quiet_NaN();  ///< none yet [m]
  double power_ = 0;                                         ///< [W]
};

}  // namespace PULSECAST_NAMESPACE

#endif
