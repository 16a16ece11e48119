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

/// A number of successive reflections, in lanes. Those beyond `count` repeat the first.
[[nodiscard, gnu::always_inline]] inline simd::Doubles lanes_of(const Reflection* from, std::size_t count,
                                                                double Reflection::*member) noexcept {
  return simd::generate([&](std::size_t lane) noexcept { return from[lane < count ? lane : 0].*member; });
}

/// Sorts up to `RayBundle::capacity` reflections by range, those of equal ranges as they come. Each moves once, to its
/// rank, which lanes count without branches.
inline void sort_by_rank(std::span<Reflection> all) noexcept {
  static_assert(std::is_trivially_copyable_v<Reflection>);
  std::array<double, RayBundle::capacity> ranges;
  std::array<std::int64_t, RayBundle::capacity> ranks;
  alignas(Reflection) std::array<std::byte, RayBundle::capacity * sizeof(Reflection)> copies;
  std::memcpy(copies.data(), all.data(), all.size_bytes());
  for (std::size_t i = 0; i < all.size(); ++i) ranges[i] = all[i].range;
  for (std::size_t i = all.size(); i % simd::lane_count != 0; ++i) ranges[i] = infinity;
  const auto places = simd::generate([](std::size_t lane) { return static_cast<double>(lane); });
  for (std::size_t block = 0; block < all.size(); block += simd::lane_count) {
    const auto own = simd::load<simd::Doubles>(ranges[block]);
    simd::Mask rank{};
    for (std::size_t i = 0; i < block; i += simd::lane_count)
      for (std::size_t lane = 0; lane < simd::lane_count; ++lane) rank -= ranges[i + lane] <= own;
    for (std::size_t lane = 0; lane < simd::lane_count; ++lane)
      rank -= (ranges[block + lane] < own) | ((ranges[block + lane] == own) & (static_cast<double>(lane) < places));
    for (std::size_t i = block + simd::lane_count; i < all.size(); i += simd::lane_count)
      for (std::size_t lane = 0; lane < simd::lane_count; ++lane) rank -= ranges[i + lane] < own;
    simd::store(rank, ranks[block]);
  }
  for (std::size_t i = 0; i < all.size(); ++i)
    std::memcpy(&all[static_cast<std::size_t>(ranks[i])], &copies[i * sizeof(Reflection)], sizeof(Reflection));
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

/// True if a reflection can be an echo, by power [W] and range [m], or lanes of them: of power, and
/// nearer than 2^52 samples.
[[nodiscard]] inline auto can_count(const auto& power, const auto& range, double sample_interval) noexcept {
  return (power > 0) & (range < 0x1p51 * speed_of_light * sample_interval);
}

/// Sorts reflections by range and drops those that cannot be echoes. Up to `RayBundle::capacity` of equal ranges keep
/// their order.
[[nodiscard]] inline std::span<Reflection> in_order_of_range(std::span<Reflection> all,
                                                             double sample_interval) noexcept {
  const auto nearer = [](const Reflection& a, const Reflection& b) { return a.range < b.range; };
  const auto useless = [&](const Reflection& r) { return !can_count(r.power, r.range, sample_interval); };
  Reflection* const begin = all.data();
  Reflection* const end = std::remove_if(begin, begin + all.size(), useless);
  const std::span<Reflection> useful(begin, end);
  if (std::is_sorted(begin, end, nearer)) return useful;
  if (useful.size() <= RayBundle::capacity)
    detail::sort_by_rank(useful);
  else
    std::sort(begin, end, nearer);
  return useful;
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
    sum_.advance(step_, decay_);
    for (const double t = time(); next_edge_ <= t; ++next_, find_next_edge()) {
      const double u = (t - next_edge_) / shape_.tau;
      sum_.add(u, reflections_[next_].power * exponential(-u));
    }
    ++sample_;
    return sum_.power();
  }

  /// Appends samples, as of `power`, up to a number, or until the last pulse peaked `tail` ago [s] and
  /// the next edge is more than `gap` samples ahead. That must not have passed.
  void append(std::vector<double>& y, double tail, double gap) noexcept {
    std::array<double, 128> samples;
    double* to = samples.data();
    Moments sum = sum_;  // copies stay in registers
    double n = sample_;
    const double full = n + static_cast<double>(std::min(samples.size(), y.capacity() - y.size() - 1));
    Edges edges;
    find_edges(edges);
    std::size_t lane = 0;
    if (edges.sample[0] <= n + gap && edges.sample[0] < full) {
      sum.advance(step_, decay_);
      do {
        for (; n < edges.sample[lane]; ++n) {
          *to++ = sum.power();
          sum.advance(step_, decay_);
        }
        sum.add(edges.age[lane], edges.weight[lane]);
        ++next_;
        if (++lane == simd::lane_count) {
          find_edges(edges);
          lane = 0;
        }
      } while (edges.sample[lane] <= n + gap && edges.sample[lane] < full);
      *to++ = sum.power();
      ++n;
    }
    const double heard = next_ > 0 ? last_peak() + tail : -std::numeric_limits<double>::infinity();
    for (const double end = std::min(edges.sample[lane], full); n < end && n * interval_ <= heard; ++n) {
      sum.advance(step_, decay_);
      *to++ = sum.power();
    }
    y.insert(y.end(), samples.data(), to);
    sum_ = sum;
    sample_ = n;
    find_next_edge();
  }

 private:
  struct Moments {
    double zeroth = 0, first = 0, second = 0;

    void advance(double step, double decay) noexcept {
      second = decay * (second + step * (2 * first + step * zeroth));
      first = decay * (first + step * zeroth);
      zeroth *= decay;
    }
    void add(double u, double p) noexcept {
      zeroth += p;
      first += p * u;
      second += p * u * u;
    }
    [[nodiscard]] double power() const noexcept { return second * PulseShape::to_unit_peak; }
  };

  /// Edges of successive reflections: the number of the first sample that is not before one, infinite
  /// beyond the last, its age there [tau], and P e^-u [W].
  struct Edges {
    std::array<double, simd::lane_count> sample, age, weight;
  };
  /// Sets those of the next reflections.
  void find_edges(Edges& edges) const noexcept {
    const std::size_t left = reflections_.size() - next_;
    const Reflection* const from = reflections_.data() + (left > 0 ? next_ : 0);
    const auto of = [&](double Reflection::*member) noexcept { return detail::lanes_of(from, left, member); };
    const simd::Doubles edge = 2 * of(&Reflection::range) / speed_of_light - PulseShape::peak * shape_.tau;
    const simd::Doubles whole = simd::floor(edge / interval_), at = whole * interval_, then = (whole + 1) * interval_;
    const auto later = at < edge;  // or at the sample `whole`, as rounded
    const simd::Doubles age = ((later ? then : at) - edge) / shape_.tau;
    simd::store(later ? whole + 1 : whole, edges.sample);
    simd::store(age, edges.age);
    simd::store(simd::Doubles(of(&Reflection::power) * exponential(simd::Doubles(-age))), edges.weight);
    for (std::size_t lane = left; lane < simd::lane_count; ++lane)
      edges.sample[lane] = std::numeric_limits<double>::infinity();
  }

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
  Moments sum_{};
};

}  // namespace PULSECAST_NAMESPACE

#endif
