// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_DETECTOR_PHASE_SHIFT_HPP
#define PULSECAST_DETECTOR_PHASE_SHIFT_HPP

#include <pulsecast/detector/detail/pulse_sum.hpp>

namespace PULSECAST_NAMESPACE {

/// Settings of a phase-shift scanner.
struct PhaseShiftSettings {
  /// Modulation frequencies, ascending, from 1 to 8: the finest gives the range, the coarser ones
  /// its place, and the coarsest the ambiguity c / 2f [Hz].
  std::vector<double> frequencies{1e6, 10e6, 120e6};
  double contrast = 1;       ///< modulated share of the power, in (0, 1]
  double threshold = 1e-12;  ///< minimum modulated power of an echo at the finest frequency [W]
  double deviation = 0;      ///< standard deviation of the noise of each component of a phasor [W]

  void validate() const {
    require_within("PhaseShiftSettings::frequencies (number)", frequencies.size(), 1, 8, "");
    for (std::size_t k = 0; k < frequencies.size(); ++k) {
      require_within("PhaseShiftSettings::frequencies", frequencies[k], 1e3, 1e11, "Hz");
      const double ratio = frequencies[k] / frequencies[k > 0 ? k - 1 : 0];
      require_within("PhaseShiftSettings::frequencies (by the one before)", ratio, 1, 1e4, "");
    }
    require_positive("PhaseShiftSettings::contrast", contrast, "");
    require_within("PhaseShiftSettings::contrast", contrast, 0, 1, "");
    require_not_negative("PhaseShiftSettings::threshold", threshold, "W");
    require_within("PhaseShiftSettings::deviation", deviation, 0, 1e20, "W");
  }

  /// Difference of ranges that cannot be distinguished [m].
  [[nodiscard]] double ambiguity() const noexcept { return 0.5 * speed_of_light / frequencies.front(); }
};

/// Detector of a scanner with a continuous laser whose power is modulated by sines. It measures the
/// phase of the sum of all reflections at each frequency, and gives one range: at an edge, one
/// between or beyond the surfaces (mixed pixels); beyond the ambiguity, one that is folded. Fog and
/// haze draw it near. The laser's peak power is its mean power while it measures. The echo has the
/// labels of the strongest reflection, or of continuous returns of more power than all reflections.
/// Source: Payne, Jongenelen, Dorrington, Cree & Carnegie 2009; phasors of a sum of sines.
class PhaseShift {
 public:
  /// @throws SettingError for settings out of range
  explicit PhaseShift(PhaseShiftSettings settings = {}) : s_(validated(std::move(settings))) {}

  [[nodiscard]] const PhaseShiftSettings& settings() const noexcept { return s_; }

  struct Workspace {
    Echo echo;  ///< the only echo
  };
  [[nodiscard]] Workspace workspace(std::size_t) const { return {}; }

  /// The echo of all reflections. Noise is drawn from the seed and pulse of `input.key`.
  [[nodiscard]] Detection detect(const DetectorInput& input, Workspace& w) const noexcept {
    const Reflection* strongest = nullptr;
    const ContinuousReturn* air = nullptr;
    double of_air = 0, solid = 0;
    for (const Reflection& r : input.reflections) {
      solid += r.power > 0 ? r.power : 0;
      if (r.power > 0 && (!strongest || r.power > strongest->power)) strongest = &r;
    }
    for (const ContinuousReturn& r : input.continuous) {
      of_air += r.power();
      if (!air || r.power() > air->power()) air = &r;
    }
    if (!strongest && !air) return {};
    RandomKey key = input.key.with(Purpose::receiver_noise);
    double range = 0, amplitude = 0;
    for (std::size_t k = 0; k < s_.frequencies.size(); ++k) {
      const double period = 0.5 * speed_of_light / s_.frequencies[k];  // [m]
      double in_phase = 0, quadrature = 0;
      for (const Reflection& r : input.reflections) {
        const auto phase = turned(r.range, period);
        in_phase += r.power * phase.cos;
        quadrature += r.power * phase.sin;
      }
      for (const ContinuousReturn& r : input.continuous) {
        const Phasor phasor = phasor_of(r, period);
        in_phase += phasor.in_phase;
        quadrature += phasor.quadrature;
      }
      in_phase *= s_.contrast;
      quadrature *= s_.contrast;
      if (s_.deviation > 0) {
        key.subray = static_cast<std::uint32_t>(2 * k);
        in_phase += s_.deviation * normal(key);
        ++key.subray;
        quadrature += s_.deviation * normal(key);
      }
      const double turn = std::atan2(quadrature, in_phase) / (2 * pi), fine = (turn < 0 ? turn + 1 : turn) * period;
      range = k == 0 ? fine : fine + std::round((range - fine) / period) * period;
      amplitude = std::hypot(in_phase, quadrature);
    }
    if (!(amplitude >= s_.threshold) || range < 0) return {};
    w.echo = echo_from(of_air > solid ? labels_of(*air) : *strongest, range, amplitude);
    return {{&w.echo, 1}, {}, 0};
  }

 private:
  /// Sine and cosine of the phase of a range.
  [[nodiscard]] static simd::SineCosine<double> turned(double range, double period) noexcept {
    const double turns = range / period;
    return simd::sincos(2 * pi * (turns - std::floor(turns)));
  }
  /// Sums of power by cosine and sine of a phase [W].
  struct Phasor {
    double in_phase, quadrature;
  };
  /// Phasor of a continuous return, for a period in range [m]: by parts, or at its centre.
  [[nodiscard]] static Phasor phasor_of(const ContinuousReturn& r, double period) noexcept {
    const double length = r.end - r.begin, k = 2 * pi / period, power = r.power();
    if (k * length < 1e-3) {
      const double share = power > 0 ? (r.at_begin + 2 * r.at_end) / (3 * (r.at_begin + r.at_end)) : 0;
      const auto middle = turned(r.begin + share * length, period);
      return {power * middle.cos, power * middle.sin};
    }
    const auto begin = turned(r.begin, period), end = turned(r.end, period);
    const double bend = (r.at_end - r.at_begin) / (length * k * k);
    return {(r.at_end * end.sin - r.at_begin * begin.sin) / k + bend * (end.cos - begin.cos),
            (r.at_begin * begin.cos - r.at_end * end.cos) / k + bend * (end.sin - begin.sin)};
  }

  PhaseShiftSettings s_;
};

}  // namespace PULSECAST_NAMESPACE

#endif
