// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_DETECTOR_DETAIL_CONTINUOUS_WAVEFORM_HPP
#define PULSECAST_DETECTOR_DETAIL_CONTINUOUS_WAVEFORM_HPP

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include <pulsecast/base/exponential.hpp>
#include <pulsecast/base/units.hpp>
#include <pulsecast/concepts.hpp>
#include <pulsecast/detector/peaks.hpp>
#include <pulsecast/detector/pulse_shape.hpp>

namespace PULSECAST_NAMESPACE::detail {

/// Integrals of a `PulseShape`: incomplete gamma functions of order 3 and 4, by parts.
class GammaIntegrals {
 public:
  explicit GammaIntegrals(const PulseShape& shape) noexcept : shape_(shape) {}

  [[nodiscard]] double begin() const noexcept { return shape_.begin(); }  ///< time of the leading edge since the arrival [s]
  [[nodiscard]] double end() const noexcept { return 36 * shape_.tau; }   ///< time since the arrival when 1e-13 of a pulse is left [s]
  [[nodiscard]] double peak() const noexcept { return 0; }                ///< time of the maximum since the arrival [s]
  /// Pulse at a time since the arrival [s].
  [[nodiscard]] double operator()(double t) const noexcept { return shape_(t); }
  /// Integrals up to a time since the arrival [s].
  [[nodiscard]] PulseIntegrals until(double t) const noexcept {
    if (!(t < end())) return of(2, 6);
    const double u = t / shape_.tau + PulseShape::peak;
    if (!(u > 0)) return {};
    const double left = exponential(-u), second = u * (u + 2) + 2;
    return of(2 - left * second, 6 - left * (u * u * u + 3 * second));
  }

 private:
  [[nodiscard]] PulseIntegrals of(double zeroth, double first) const noexcept {  // of u^2 e^-u, and of u^3 e^-u
    const double scale = PulseShape::to_unit_peak * shape_.tau;
    return {scale * zeroth, scale * shape_.tau * (first - PulseShape::peak * zeroth)};
  }

  PulseShape shape_;
};

/// Waveform of the continuous returns of a pulse: exact at any time, as density is linear in each stretch. Stretches that are far from a
/// time cost nothing there. `Pulse` is as `GammaIntegrals`.
///
/// The waveform rises only where density does, and until the light of there has passed its maximum, as a pulse has only one: a search for
/// maxima looks there alone.
template <class Pulse>
class ContinuousWaveform {
 public:
  ContinuousWaveform(std::span<const ContinuousReturn> returns, const Pulse& pulse) noexcept : returns_(returns), pulse_(pulse) {
    if (!returns_.empty()) all_ = pulse_.until(pulse_.end());
  }

  /// Power [W] and its slope [W/s].
  struct Value {
    double power = 0, slope = 0;
  };

  [[nodiscard]] bool empty() const noexcept { return returns_.empty(); }  ///< true without returns
  /// Time at which light begins to arrive; infinite without any [s].
  [[nodiscard]] double start() const noexcept { return empty() ? infinity : time_of(returns_.front().begin) + pulse_.begin(); }
  /// Time from which no more light arrives [s].
  [[nodiscard]] double end() const noexcept {
    double last = -infinity;
    for (const ContinuousReturn& r : returns_) last = std::max(last, r.end);
    return time_of(last) + pulse_.end();
  }

  /// Time from which the next stretch that `pass` has not passed may let the waveform rise; infinite if there is none [s].
  [[nodiscard]] double next_rise() const noexcept {
    return rise_ < returns_.size() ? time_of(returns_[rise_].begin) + pulse_.begin() : infinity;
  }
  /// Time of the maxima of light that may let the waveform rise, of that passed [s].
  [[nodiscard]] double risen() const noexcept { return risen_; }
  /// Passes all stretches whose light has begun to arrive at a time [s].
  void pass(double time) noexcept {
    while (next_rise() <= time) {
      const ContinuousReturn& r = returns_[rise_];
      risen_ = std::max(risen_, time_of(r.at_end > r.at_begin ? r.end : r.begin) + pulse_.peak());
      do ++rise_;
      while (rise_ < returns_.size() && goes_on(returns_[rise_ - 1], returns_[rise_]));
    }
  }

  /// Waveform at a time [s]; fast if times ascend.
  template <bool with_slope = false>
  [[nodiscard]] Value next(double time) noexcept {
    if (time < last_) first_ = 0;
    last_ = time;
    while (first_ < returns_.size() && time_of(returns_[first_].end) + pulse_.end() <= time) ++first_;
    return sum<with_slope>(time, first_);
  }

  /// Waveform at any time [s].
  [[nodiscard]] Value at(double time) const noexcept { return sum<false>(time, 0); }

  /// Share of continuous returns in a peak, whose times count from `delay` before those of the waveform [s].
  [[nodiscard]] ContinuousShare share(const Peak& peak, double delay) const noexcept {
    ContinuousShare share;
    const double power = at(peak.time + delay).power, solid = peak.height - power;
    if (!(power > 0)) return share;
    share.all = power - at(peak.begin + delay).power > solid;
    double most = 0;
    for (const ContinuousReturn& r : returns_) {
      if (time_of(r.begin) + pulse_.begin() >= peak.time + delay) break;
      const double part = sum<false>(peak.time + delay, std::span(&r, 1)).power;
      if (part > most) share.strongest = &r;
      most = std::max(most, part);
    }
    return share;
  }

 private:
  static constexpr double infinity = std::numeric_limits<double>::infinity();

  [[nodiscard]] static double time_of(double range) noexcept { return 2 / speed_of_light * range; }
  /// True if a stretch goes on from the one before without a rise.
  [[nodiscard]] static bool goes_on(const ContinuousReturn& before, const ContinuousReturn& r) noexcept {
    return r.at_end <= r.at_begin && r.begin <= before.end * (1 + 1e-12) && r.at_begin <= before.at_end * (1 + 1e-9);
  }

  template <bool with_slope>
  [[nodiscard]] Value sum(double time, std::size_t first) const noexcept {
    return sum<with_slope>(time, returns_.subspan(first));
  }
  template <bool with_slope>
  [[nodiscard]] Value sum(double time, std::span<const ContinuousReturn> returns) const noexcept {
    Value sum;
    const double in = time - pulse_.begin(), gone = time - pulse_.end();  // arrivals of light that begins to arrive, and that has arrived
    double known = -infinity;
    PulseIntegrals of_known;  // the end of a stretch is mostly the begin of the next
    for (const ContinuousReturn& r : returns) {
      const double begin = time_of(r.begin), end = time_of(r.end);
      if (!(begin < in)) break;
      if (end <= gone) continue;
      const PulseIntegrals young = end < in ? pulse_.until(time - end) : PulseIntegrals{};
      const PulseIntegrals old = begin == known ? of_known : begin <= gone ? all_ : pulse_.until(time - begin);
      known = end;
      of_known = young;
      const double zeroth = old.zeroth - young.zeroth, first = old.first - young.first, length = end - begin;
      const double rise = length > 1e-6 * pulse_.end() ? (r.at_begin - r.at_end) / length : 0;  // by the age of the light
      const double origin = rise != 0 ? r.at_end - rise * (time - end) : 0.5 * (r.at_begin + r.at_end);
      sum.power += origin * zeroth + rise * first;
      if constexpr (with_slope) {
        sum.slope -= rise * zeroth;
        if (begin > gone) sum.slope += r.at_begin * pulse_(time - begin);
        if (end < in) sum.slope -= r.at_end * pulse_(time - end);
      }
    }
    sum.power *= 0.5 * speed_of_light;
    sum.slope *= 0.5 * speed_of_light;
    return sum;
  }

  std::span<const ContinuousReturn> returns_;
  Pulse pulse_;
  PulseIntegrals all_{};
  std::size_t first_ = 0, rise_ = 0;
  double risen_ = -infinity, last_ = -infinity;
};

}  // namespace PULSECAST_NAMESPACE::detail

#endif
