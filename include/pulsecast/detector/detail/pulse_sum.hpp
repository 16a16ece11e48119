// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_DETECTOR_DETAIL_PULSE_SUM_HPP
#define PULSECAST_DETECTOR_DETAIL_PULSE_SUM_HPP

#include <pulsecast/base/search.hpp>
#include <pulsecast/concepts.hpp>
#include <pulsecast/detector/pulse_shape.hpp>

namespace PULSECAST_NAMESPACE {

/// Arrival time of the peak of a reflection's pulse, since emission [s].
[[nodiscard]] inline double arrival(const Reflection& r) noexcept { return 2 * r.range / speed_of_light; }

/// Range from which light arrives at a time since emission [s], in [m].
[[nodiscard]] inline double range_at(double time) noexcept { return 0.5 * speed_of_light * time; }

namespace detail {
/// Index of the first reflection, of some sorted by range, that does not arrive before a time [s].
[[nodiscard]] inline std::size_t first_arrival(std::span<const Reflection> all, double time) noexcept {
  return first_not(all.size(), [&](std::size_t i) { return arrival(all[i]) < time; });
}
}  // namespace detail

/// Echo of a range [m] and an amplitude [W] with the labels of a reflection.
[[nodiscard]] inline Echo echo_from(const Reflection& r, double range, double amplitude) noexcept {
  return {.range = range,
          .amplitude = amplitude,
          .cos_incidence = r.cos_incidence,
          .object = r.object,
          .classification = r.classification,
          .kind = r.kind};
}

/// Reflection with the labels of a continuous return alone.
[[nodiscard]] inline Reflection labels_of(const ContinuousReturn& r) noexcept {
  return {.object = r.object, .classification = r.classification, .kind = r.kind};
}

/// True if a reflection can be an echo: of power, and nearer than 2^52 samples.
[[nodiscard]] inline bool can_count(const Reflection& r, double sample_interval) noexcept {
  return r.power > 0 && r.range < 0x1p51 * speed_of_light * sample_interval;
}

/// Sorts reflections by range and drops those that cannot be echoes.
[[nodiscard]] inline std::span<Reflection> in_order_of_range(std::span<Reflection> all,
                                                             double sample_interval) noexcept {
  const auto nearer = [](const Reflection& a, const Reflection& b) { return a.range < b.range; };
  const auto useless = [&](const Reflection& r) { return !can_count(r, sample_interval); };
  Reflection* const begin = all.data();
  Reflection* const end = std::remove_if(begin, begin + all.size(), useless);
  if (!std::is_sorted(begin, end, nearer)) std::sort(begin, end, nearer);
  return {begin, static_cast<std::size_t>(end - begin)};
}

/// Sum of the pulse shapes of reflections, sorted by range, sample by sample. Three moments about
/// the leading edges advance the sum of any number of shapes by one sample: the sums of P e^-u, P u
/// e^-u and P u^2 e^-u. This is exact, and costs samples plus reflections instead of their product.
class SampledSum {
 public:
  static constexpr double negligible = 20;  ///< time since a peak with 1e-6 left [tau]

  /// Starts at a reflection and a sample number. Earlier reflections are ignored.
  SampledSum(std::span<const Reflection> reflections, const PulseShape& shape, double interval, std::size_t first,
             double sample) noexcept
      : reflections_(reflections),
        shape_(shape),
        interval_(interval),
        step_(interval / shape.tau),
        decay_(std::exp(-step_)),
        next_(first),
        sample_(sample) {
    find_next_edge();
  }

  /// Number of the first sample that a reflection needs: two before its leading edge.
  [[nodiscard]] static double first_sample(const Reflection& r, const PulseShape& shape, double interval) noexcept {
    return std::floor((arrival(r) - PulseShape::peak * shape.tau) / interval) - 2;
  }

  [[nodiscard]] double sample() const noexcept { return sample_; }            ///< next sample
  [[nodiscard]] double time() const noexcept { return sample_ * interval_; }  ///< of the next sample [s]
  [[nodiscard]] std::size_t next() const noexcept { return next_; }           ///< reflection to arrive
  /// True if the edges of all reflections have passed.
  [[nodiscard]] bool all_in() const noexcept { return next_ == reflections_.size(); }
  /// Arrival of the last reflection so far [s].
  [[nodiscard]] double last_peak() const noexcept { return arrival(reflections_[next_ - 1]); }

  /// Returns the sum at the next sample [W] and advances.
  double power() noexcept {
    second_ = decay_ * (second_ + step_ * (2 * first_ + step_ * zeroth_));
    first_ = decay_ * (first_ + step_ * zeroth_);
    zeroth_ *= decay_;
    for (const double t = time(); next_edge_ <= t; ++next_, find_next_edge()) {
      const double u = (t - next_edge_) / shape_.tau, p = reflections_[next_].power * exponential(-u);
      zeroth_ += p;
      first_ += p * u;
      second_ += p * u * u;
    }
    ++sample_;
    return second_ * PulseShape::to_unit_peak;
  }

 private:
  void find_next_edge() noexcept {
    next_edge_ = all_in() ? std::numeric_limits<double>::infinity()
                          : arrival(reflections_[next_]) - PulseShape::peak * shape_.tau;
  }

  std::span<const Reflection> reflections_;
  PulseShape shape_;
  double interval_, step_, decay_;
  std::size_t next_;
  double next_edge_ = 0;  ///< leading edge of reflection `next_` [s]
  double sample_;
  double zeroth_ = 0, first_ = 0, second_ = 0;
};

}  // namespace PULSECAST_NAMESPACE

#endif
