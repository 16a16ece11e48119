// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_DETECTOR_DETAIL_BAND_LIMITED_SAMPLES_HPP
#define PULSECAST_DETECTOR_DETAIL_BAND_LIMITED_SAMPLES_HPP

#include <pulsecast/detector/detail/continuous_waveform.hpp>
#include <pulsecast/detector/detail/received_pulse.hpp>
#include <pulsecast/detector/receiver_chain.hpp>

namespace PULSECAST_NAMESPACE {

namespace detail {

/// Pulses of one length after a receiver.
struct ReceivedPulses {
  LowPass filter;              ///< of the receiver
  ReceivedPulse pulse;         ///< after the receiver
  std::vector<double> taps{};  ///< of the matched filter; none without one
  std::int64_t first_tap = 0;  ///< number of the first tap from the sample of a pulse's arrival on

  /// Delay of the maximum [s]: that of a matched filter's output is the arrival.
  [[nodiscard]] double delay() const noexcept { return taps.empty() ? pulse.peak() : 0; }
};

}  // namespace detail

/// Samples after a receiver of finite bandwidth, in sections with gaps where no light arrives. With
/// noise there is one of at most 1e7 samples: the range gate, or up to the last reflection.
class BandLimitedSamples {
 public:
  struct Workspace {
    std::vector<double> sums;    ///< sums of pulses in the next samples, in a ring
    std::vector<double> phases;  ///< powers by phase, of reflections between two samples [W]
    std::vector<double> before;  ///< last samples before the matched filter, in a ring
  };

  /// For reflections sorted by range. `peaks_only`: no width is taken.
  BandLimitedSamples(const ReceiverChain& chain, const detail::ReceivedPulses& pulses, const WaveformSettings& s,
                     const DetectorInput& input, std::span<const Reflection> reflections, bool peaks_only,
                     Workspace& w) noexcept
      : chain_(chain),
        pulses_(pulses),
        reflections_(reflections),
        continuous_(input.continuous, pulses.pulse),
        w_(w),
        interval_(s.sample_interval),
        wavelength_(input.emitter.laser.wavelength),
        noise_(pulses.filter, input.key.with(Purpose::receiver_noise)),
        noisy_(chain.noisy()),
        peaks_only_(peaks_only && !noisy_ && pulses.taps.empty() && s.record_length == 0 &&
                    s.timing == EchoTiming::peak) {
    std::fill(w_.sums.begin(), w_.sums.end(), 0.0);
    if (chain_.noise_power > 0 || chain_.shot_noise) deviation_ = deviation(0);
    held_decay_ = chain_.recovery > 0 ? std::exp(-interval_ / chain_.recovery) : 0;
    if (noisy_) {
      const double near = 2 * input.gate.near / speed_of_light, far = 2 * input.gate.far / speed_of_light;
      number_ = std::ceil((near + pulses_.pulse.begin()) / interval_) - margin;
      const double end = std::isfinite(far) ? far + pulses_.pulse.end() : continuous_.end();
      end_ = std::clamp(std::floor(end / interval_) + margin, number_ - 1, number_ + samples_max);
    } else if (const double first = first_of_section(); std::isfinite(first)) {
      number_ = first;
    }
    start_ = number_;
  }

  /// Shape of a reflection's pulse in the samples, about its maximum.
  struct Shape {
    const ReceivedPulse& pulse;  ///< about the arrival
    [[nodiscard]] double operator()(double t) const noexcept { return pulse(t + pulse.peak()); }
    [[nodiscard]] simd::Doubles operator()(const simd::Doubles& t) const noexcept {
      return simd::generate([&](std::size_t lane) noexcept { return (*this)(t[lane]); });
    }
    [[nodiscard]] double begin() const noexcept { return pulse.begin() - pulse.peak(); }
    [[nodiscard]] double end() const noexcept { return pulse.end() - pulse.peak(); }
  };
  // as `IdealSamples` describes
  [[nodiscard]] Shape shape() const noexcept { return {pulses_.pulse}; }
  [[nodiscard]] double start() const noexcept { return start_; }
  [[nodiscard]] double delay() const noexcept { return pulses_.delay(); }
  [[nodiscard]] double background() const noexcept { return chain_.background; }
  [[nodiscard]] bool independent_noise() const noexcept { return false; }

  [[nodiscard]] bool begin_section() noexcept {
    if (noisy_ ? begun_ || !(number_ <= end_ || !reflections_.empty()) : !std::isfinite(first_of_section()))
      return false;
    if (!noisy_) {
      number_ = first_of_section();
      end_ = number_;
      falling_ = 0;
    }
    begun_ = true;
    held_ = 0;
    raw_ = static_cast<std::int64_t>(number_) + pulses_.first_tap;
    for (std::size_t k = 1; k < pulses_.taps.size(); ++k) keep_raw();
    return true;
  }

  [[nodiscard]] double number() const noexcept { return number_; }

  /// Next sample [W]; sets `more` if the section continues after it.
  [[nodiscard]] double power(bool& more) noexcept {
    double power = 0;
    if (pulses_.taps.empty()) {
      power = raw();
    } else {
      keep_raw();
      const std::size_t mask = w_.before.size() - 1;
      const auto from = static_cast<std::size_t>(raw_) - pulses_.taps.size();
      for (std::size_t k = 0; k < pulses_.taps.size(); ++k) power += pulses_.taps[k] * w_.before[(from + k) & mask];
    }
    ++number_;
    more = number_ <= end_ || (next_ < reflections_.size() && (noisy_ || first_of(next_) <= number_));
    if (!noisy_ && !continuous_.empty()) more |= may_rise();
    return power;
  }

  [[nodiscard]] auto continuous() const noexcept { return continuous_.sources(pulses_.pulse.peak()); }

 private:
  static constexpr double margin = 2;         ///< samples beside a pulse, for its peaks
  static constexpr double samples_max = 1e7;  ///< of a gate
  static constexpr std::size_t fallen = 4;    ///< falling samples after a maximum

  [[nodiscard]] double deviation(double signal) const noexcept {
    const double variance = chain_.density(signal, wavelength_) * pulses_.filter.noise_bandwidth();
    return std::sqrt(variance) / pulses_.pulse.gain();
  }

  /// Number of the first sample of a section, from that of the light that begins it.
  [[nodiscard]] double before(double first) const noexcept {
    if (pulses_.taps.empty()) return first - margin;
    return first - margin - static_cast<double>(pulses_.first_tap) - static_cast<double>(pulses_.taps.size());
  }
  /// Number of the first sample of a section that a reflection begins.
  [[nodiscard]] double first_of(std::size_t r) const noexcept {
    return before(pulses_.pulse.first_sample(arrival(reflections_[r])));
  }
  /// Number of the first sample of the next section; infinite if there is none.
  [[nodiscard]] double first_of_section() const noexcept {
    const double rise = before(std::ceil(continuous_.next() / interval_));
    const double solid = next_ < reflections_.size() ? first_of(next_) : detail::infinity;
    const double late = before(std::floor(continuous_.first_peak() / interval_));
    return std::fmin(solid, peaks_only_ && late < solid ? std::fmax(late, rise) : rise);
  }
  [[nodiscard]] bool may_rise() noexcept {
    continuous_.pass((number_ + margin) * interval_);
    const double settled = continuous_.until() / interval_ + margin - static_cast<double>(pulses_.first_tap);
    return falling_ < fallen + pulses_.taps.size() || number_ <= settled || first_of_section() <= number_;
  }

  void keep_raw() noexcept {
    const auto at = static_cast<std::size_t>(raw_) & (w_.before.size() - 1);
    w_.before[at] = raw();
  }

  /// Adds the pulses of the next reflections, whose first sample is the same.
  void add_pulses() noexcept {
    const ReceivedPulse& pulse = pulses_.pulse;
    const double first = pulse.first_sample(arrival(reflections_[next_]));
    std::fill(w_.phases.begin(), w_.phases.end(), 0.0);
    for (; next_ < reflections_.size(); ++next_) {
      const double time = arrival(reflections_[next_]);
      if (pulse.first_sample(time) != first) break;
      const ReceivedPulse::Phase phase = pulse.phase(time);
      for (std::size_t j = 0; j < 4; ++j) w_.phases[phase.first + j] += reflections_[next_].power * phase.weights[j];
    }
    const std::size_t size = w_.sums.size();
    std::size_t at = static_cast<std::size_t>(static_cast<std::int64_t>(first)) & (size - 1);
    const std::int64_t gone = raw_ - static_cast<std::int64_t>(first);  // samples of the pulse
    auto k = static_cast<std::size_t>(std::max(std::int64_t{0}, gone));
    at = (at + k) & (size - 1);
    for (std::size_t end; k < pulse.stride(); k = end, at = 0) {
      end = std::min(pulse.stride(), k + (size - at));
      for (std::size_t q = 0; q < pulse.rows(); ++q)
        if (w_.phases[q] != 0) add(w_.phases[q], pulse.row(q) + k, end - k, w_.sums.data() + at);
    }
    const double last = first + static_cast<double>(pulse.count()) + margin;
    end_ = std::max(end_, last - static_cast<double>(pulses_.first_tap));
  }

  static void add(double factor, const double* from, std::size_t count, double* to) noexcept {
    std::size_t k = 0;
    for (; k + simd::lane_count <= count; k += simd::lane_count)
      simd::store(simd::Doubles(simd::load<simd::Doubles>(to[k]) + factor * simd::load<simd::Doubles>(from[k])), to[k]);
    for (; k < count; ++k) to[k] += factor * from[k];
  }

  /// Next sample before a matched filter.
  double raw() noexcept {
    const std::size_t mask = w_.sums.size() - 1;
    while (next_ < reflections_.size() &&
           pulses_.pulse.first_sample(arrival(reflections_[next_])) <= static_cast<double>(raw_))
      add_pulses();
    double& sum = w_.sums[static_cast<std::size_t>(raw_) & mask];
    double power = std::exchange(sum, 0.0);
    if (!continuous_.empty()) {
      const double now = continuous_.power(static_cast<double>(raw_) * interval_);
      falling_ = now <= last_ ? falling_ + 1 : 0;
      last_ = now;
      power += now;
    }
    if (deviation_ > 0)
      power += (chain_.shot_noise ? deviation(power) : deviation_) * noise_(static_cast<double>(raw_) * interval_);
    ++raw_;
    if (chain_.saturation > 0) {
      held_ *= held_decay_;
      if (power >= chain_.saturation) held_ = chain_.saturation;
      power = std::max(std::min(power, chain_.saturation), held_);
    }
    return chain_.quantized(power);
  }

  const ReceiverChain& chain_;
  const detail::ReceivedPulses& pulses_;
  std::span<const Reflection> reflections_;
  detail::ContinuousRises<const ReceivedPulse&> continuous_;
  Workspace& w_;
  double interval_, wavelength_;
  FilteredNoise noise_;
  bool noisy_, peaks_only_, begun_ = false;
  double deviation_ = 0, held_decay_ = 0, held_ = 0, last_ = 0;
  double number_ = 0, end_ = -1, start_ = 0;
  std::int64_t raw_ = 0;
  std::size_t next_ = 0, falling_ = 0;
};

}  // namespace PULSECAST_NAMESPACE

#endif
