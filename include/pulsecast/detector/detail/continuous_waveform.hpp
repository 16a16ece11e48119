// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_DETECTOR_DETAIL_CONTINUOUS_WAVEFORM_HPP
#define PULSECAST_DETECTOR_DETAIL_CONTINUOUS_WAVEFORM_HPP

#include <pulsecast/detector/detail/peaks.hpp>

namespace PULSECAST_NAMESPACE::detail {

/// Slope of a return's density [W/m^2]; 0 for one so short that only its power counts.
[[nodiscard]] inline double slope_of(const ContinuousReturn& r, double negligible) noexcept {
  return r.end - r.begin > negligible ? (r.at_end - r.at_begin) / (r.end - r.begin) : 0;
}

/// Waveform of continuous returns of linear density, for `PulseShape`, at ascending times: exact.
///
/// A step J of the density by range, whose edge passed an age u [tau] ago, contributes J (2 - e^-u
/// (u^2 + 2 u + 2)) to the sum of pulses u^2 e^-u; a change K of its slope by tau, K (2 u - 6 +
/// e^-u (u^2 + 4 u + 6)). Without e^-u that is 2 q - 6 q', of the density q at the leading edge;
/// the rest is a quadratic in time, times an exponential. By integration of `PulseShape`.
class ContinuousSum {
 public:
  ContinuousSum(std::span<const ContinuousReturn> returns, const PulseShape& shape) noexcept
      : returns_(returns), tau_(shape.tau) {}

  [[nodiscard]] bool empty() const noexcept { return returns_.empty(); }  ///< true without returns

  /// Goes on to a time, no earlier than before [s].
  void advance(double time) noexcept {
    const double edge = (time + PulseShape::peak * tau_) * metres, per_tau = metres * tau_, before = edge_;
    const double x = (edge - before) / per_tau, left = x < faded ? exponential(-x) : 0;
    second_ = left > 0 ? left * (second_ + x * (first_ + x * zeroth_)) : 0;
    first_ = left > 0 ? left * (first_ + 2 * x * zeroth_) : 0;
    zeroth_ *= left;
    density_ = slope_ = 0;
    edge_ = edge;
    while (passed_ < returns_.size() && returns_[passed_].end <= edge - faded * per_tau) ++passed_;
    begun_ = std::max(begun_, passed_);
    while (begun_ < returns_.size() && returns_[begun_].begin <= edge) ++begun_;
    for (std::size_t i = passed_; i < begun_; ++i) {
      const ContinuousReturn& r = returns_[i];
      if (r.end <= before) continue;
      const double by_range = slope_of(r, negligible * per_tau), mean = 0.5 * (r.at_begin + r.at_end);
      if (r.begin > before) add(by_range != 0 ? r.at_begin : mean, by_range * per_tau, (edge - r.begin) / per_tau);
      if (r.end <= edge) {
        add(by_range != 0 ? -r.at_end : -mean, -by_range * per_tau, (edge - r.end) / per_tau);
      } else {
        density_ += (by_range != 0 ? r.at_begin : mean) + by_range * (edge - r.begin);
        slope_ += by_range * per_tau;
      }
    }
    while (passed_ < begun_ && returns_[passed_].end <= edge) ++passed_;
  }

  /// Power now [W].
  [[nodiscard]] double power() const noexcept { return scale() * (2 * density_ - 6 * slope_ + second_); }
  /// Its slope [W/tau].
  [[nodiscard]] double slope() const noexcept { return scale() * (2 * slope_ + first_ - second_); }

 private:
  static constexpr double metres = 0.5 * speed_of_light;
  static constexpr double faded = 40;         ///< age at which 1e-14 of a pulse is left [tau]
  static constexpr double negligible = 1e-5;  ///< length of a return [tau]

  [[nodiscard]] double scale() const noexcept { return PulseShape::to_unit_peak * tau_ * metres; }

  /// Adds steps of the density [W/m] and its slope [W/m by tau], of an age [tau].
  void add(double step, double bend, double age) noexcept {
    if (!(age < faded)) return;
    const double left = exponential(-age), square = bend - step, linear = 4 * bend - 2 * step;
    zeroth_ += left * square;
    first_ += left * (linear + 2 * square * age);
    second_ += left * (age * (square * age + linear) + linear + 2 * bend);
  }

  std::span<const ContinuousReturn> returns_;
  double tau_, edge_ = -std::numeric_limits<double>::infinity();  ///< range of the edge now [m]
  double density_ = 0, slope_ = 0;                                ///< at the edge [W/m], by tau
  double zeroth_ = 0, first_ = 0, second_ = 0;                    ///< e^-x (second + first x + zeroth x^2) in x [tau]
  std::size_t passed_ = 0, begun_ = 0;
};

/// Integrals of a `PulseShape`: incomplete gamma functions of order 3 and 4, by parts.
class GammaIntegrals {
 public:
  explicit GammaIntegrals(const PulseShape& shape) noexcept : shape_(shape) {}

  /// Time of the leading edge since the arrival [s].
  [[nodiscard]] double begin() const noexcept { return shape_.begin(); }
  /// Time since the arrival when 1e-13 of a pulse is left [s].
  [[nodiscard]] double end() const noexcept { return 36 * shape_.tau; }
  [[nodiscard]] double peak() const noexcept { return 0; }  ///< maximum since the arrival [s]
  /// Integrals up to a time since the arrival [s].
  [[nodiscard]] PulseIntegrals until(double t) const noexcept {
    if (!(t < end())) return of(2, 6);
    const double u = t / shape_.tau + PulseShape::peak;
    if (!(u > 0)) return {};
    const double left = exponential(-u), second = u * (u + 2) + 2;
    return of(2 - left * second, 6 - left * (u * u * u + 3 * second));
  }

 private:
  [[nodiscard]] PulseIntegrals of(double zeroth, double first) const noexcept {  // u^2 e^-u, u^3 e^-u
    const double scale = PulseShape::to_unit_peak * shape_.tau;
    return {scale * zeroth, scale * shape_.tau * (first - PulseShape::peak * zeroth)};
  }

  PulseShape shape_;
};

/// Places of maxima of continuous returns, and their echoes. `Pulse`: as `GammaIntegrals`.
///
/// The waveform rises only where density does, and until the light of there has passed its maximum:
/// a search for maxima looks there alone, and at reflections.
template <class Pulse>
class ContinuousRises {
 public:
  ContinuousRises(std::span<const ContinuousReturn> returns, const Pulse& pulse) noexcept
      : returns_(returns), pulse_(pulse) {}

  [[nodiscard]] bool empty() const noexcept { return returns_.empty(); }  ///< true without returns
  /// Time at which light begins to arrive; infinite without any [s].
  [[nodiscard]] double start() const noexcept {
    return empty() ? infinity : time_of(returns_.front().begin) + pulse_.begin();
  }
  /// Time from which no more light arrives [s].
  [[nodiscard]] double end() const noexcept {
    double last = -infinity;
    for (const ContinuousReturn& r : returns_) last = std::max(last, r.end);
    return time_of(last) + pulse_.end();
  }

  /// Time from which the next return may let the waveform rise; infinite if there is none [s].
  [[nodiscard]] double next() const noexcept {
    return next_ < returns_.size() ? time_of(returns_[next_].begin) + pulse_.begin() : infinity;
  }
  /// Time up to which the waveform only rises, if `next` is the first return [s].
  [[nodiscard]] double first_peak() const noexcept {
    return next_ == 0 && !empty() ? start() - pulse_.begin() + pulse_.peak() : -infinity;
  }
  /// Time up to which returns that have passed may let it rise, although it falls before [s].
  [[nodiscard]] double until() const noexcept { return until_; }
  /// Passes all returns whose light has begun to arrive at a time [s].
  void pass(double time) noexcept {
    while (next() <= time) {
      const ContinuousReturn& r = returns_[next_];
      const double late = next_ == 0 ? pulse_.peak() : pulse_.end() / 3;  // others may fall faster
      until_ = std::max(until_, time_of(r.at_end > r.at_begin ? r.end : r.begin) + late);
      const ContinuousReturn *last = &r, *const end = returns_.data() + returns_.size();
      while (last + 1 != end && goes_on(last[0], last[1])) ++last;
      next_ = static_cast<std::size_t>(last - returns_.data()) + 1;
    }
  }

  /// Waveform at a time [W]; fast if times ascend [s].
  [[nodiscard]] double power(double time) noexcept {
    if (time < last_) first_ = 0;
    last_ = time;
    while (first_ < returns_.size() && time_of(returns_[first_].end) + pulse_.end() <= time) ++first_;
    return at(time, first_);
  }

  /// Sources of peaks, as `echo_of` takes them.
  struct Sources {
    const ContinuousRises& rises;  ///< of the waveform
    double delay;                  ///< as in `source`

    [[nodiscard]] bool needs_sum() const noexcept { return !rises.empty(); }
    [[nodiscard]] const ContinuousReturn* operator()(const Peak& peak, double solid, bool met) const noexcept {
      return rises.source(peak, delay, solid, met);
    }
  };
  [[nodiscard]] Sources sources(double delay) const noexcept { return {*this, delay}; }

  /// Return that a peak is of, whose height has `solid` of reflections [W], and whose times count
  /// from `delay` before those of the waveform [s]; null if it would rise without continuous
  /// returns. `met`: true if there are reflections in it.
  [[nodiscard]] const ContinuousReturn* source(const Peak& peak, double delay, double solid, bool met) const noexcept {
    if (empty() || (met && (solid >= 0.5 * peak.height || at(peak.begin + delay, 0) >= peak.height - 2 * solid)))
      return nullptr;
    const double begun = range_at(peak.time + delay - pulse_.begin());
    const ContinuousReturn* source = nullptr;
    for (const ContinuousReturn& r : returns_) {
      if (r.begin >= begun) break;
      if (!(source && source->end > r.end)) source = &r;
    }
    return source;
  }

 private:
  [[nodiscard]] static double time_of(double range) noexcept { return 2 / speed_of_light * range; }
  /// True if a return continues the one before without a rise.
  [[nodiscard]] static bool goes_on(const ContinuousReturn& before, const ContinuousReturn& r) noexcept {
    return r.at_end <= r.at_begin && r.begin <= before.end && r.at_begin <= before.at_end * (1 + 1e-9);
  }

  /// Waveform at a time [s], of the returns from a number on [W].
  [[nodiscard]] double at(double time, std::size_t from) const noexcept {
    const double begun = range_at(time - pulse_.begin()), passed = range_at(time - pulse_.end());
    const double negligible = 1e-6 * pulse_.end() * speed_of_light;
    double sum = 0, known = -infinity;  // range
    PulseIntegrals of_known;            // the end of a return is mostly the begin of the next
    for (const ContinuousReturn& r : returns_.subspan(from)) {
      if (r.begin >= begun) break;
      if (r.end <= passed) continue;
      const PulseIntegrals old = r.begin == known ? of_known : pulse_.until(time - time_of(r.begin));
      const double young = time - time_of(r.end);
      known = r.end;
      of_known = pulse_.until(young);
      const double slope = -slope_of(r, negligible) * 0.5 * speed_of_light;  // by age
      const double origin = slope != 0 ? r.at_end - slope * young : 0.5 * (r.at_begin + r.at_end);
      sum += origin * (old.zeroth - of_known.zeroth) + slope * (old.first - of_known.first);
    }
    return 0.5 * speed_of_light * sum;
  }

  std::span<const ContinuousReturn> returns_;
  Pulse pulse_;
  std::size_t next_ = 0, first_ = 0;
  double until_ = -infinity, last_ = -infinity;
};

}  // namespace PULSECAST_NAMESPACE::detail

#endif
