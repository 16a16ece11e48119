// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_DETECTOR_BAND_LIMITED_RECEIVER_HPP
#define PULSECAST_DETECTOR_BAND_LIMITED_RECEIVER_HPP

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <pulsecast/base/random.hpp>
#include <pulsecast/base/require.hpp>
#include <pulsecast/base/simd.hpp>
#include <pulsecast/base/units.hpp>
#include <pulsecast/concepts.hpp>
#include <pulsecast/detector/by_pulse_length.hpp>
#include <pulsecast/detector/echo_timing.hpp>
#include <pulsecast/detector/filtered_noise.hpp>
#include <pulsecast/detector/pulse_form.hpp>
#include <pulsecast/detector/pulse_sum.hpp>
#include <pulsecast/detector/received_pulse.hpp>
#include <pulsecast/detector/receiver_chain.hpp>
#include <pulsecast/detector/waveform_settings.hpp>

namespace PULSECAST_NAMESPACE {

namespace detail {

/// Pulses of one length behind a receiver.
struct ReceivedPulses {
  LowPass filter;              ///< of the receiver
  ReceivedPulse pulse;         ///< behind it
  std::vector<double> taps{};  ///< of the matched filter; none without one
  std::int64_t first_tap = 0;  ///< number of the first tap from the sample of a pulse's arrival on

  /// Delay of the maximum [s]: that of a matched filter's output is the arrival.
  [[nodiscard]] double delay() const noexcept { return taps.empty() ? pulse.peak() : 0; }
};

}  // namespace detail

/// Samples behind a receiver of finite bandwidth, in sections with gaps where nothing is heard. With noise there is one section: the range
/// gate, up to the last reflection if it has no end, and of 1e7 samples at most.
class BandLimitedSamples {
 public:
  /// Scratch memory.
  struct Workspace {
    std::vector<double> sums;    ///< sums of pulses in the next samples, in a ring
    std::vector<double> phases;  ///< powers by phase, of reflections between two samples [W]
    std::vector<double> before;  ///< last samples before the matched filter, in a ring
  };

  /// For reflections sorted by range.
  BandLimitedSamples(const ReceiverChain& chain, const detail::ReceivedPulses& pulses, const WaveformSettings& s, const Heard& heard,
                     std::span<const Reflection> reflections, Workspace& w) noexcept
      : chain_(chain),
        pulses_(pulses),
        reflections_(reflections),
        w_(w),
        interval_(s.sample_interval),
        wavelength_(heard.emitter.laser.wavelength),
        noise_(pulses.filter, noise_key(heard.key)),
        noisy_(chain.noisy()) {
    std::fill(w_.sums.begin(), w_.sums.end(), 0.0);
    if (chain_.noise_power > 0 || chain_.shot_noise) deviation_ = deviation(0);
    held_decay_ = chain_.recovery > 0 ? std::exp(-interval_ / chain_.recovery) : 0;
    if (noisy_) {
      const double near = 2 * heard.gate.near / speed_of_light, far = 2 * heard.gate.far / speed_of_light;
      number_ = std::ceil((near + pulses_.pulse.begin()) / interval_) - margin;
      end_ =
          std::isfinite(far) ? std::min(std::floor((far + pulses_.pulse.end()) / interval_) + margin, number_ + samples_max) : number_ - 1;
    } else if (!reflections_.empty()) {
      number_ = first_of(0);
    }
    start_ = number_;
  }

  /// Shape of a reflection's pulse in the samples, about its maximum.
  struct Shape {
    const ReceivedPulse& pulse;  ///< about the arrival
    [[nodiscard]] double operator()(double t) const noexcept { return pulse(t + pulse.peak()); }
    [[nodiscard]] double begin() const noexcept { return pulse.begin() - pulse.peak(); }
    [[nodiscard]] double end() const noexcept { return pulse.end() - pulse.peak(); }
  };
  [[nodiscard]] Shape shape() const noexcept { return {pulses_.pulse}; }          ///< shape of the pulses of these samples
  [[nodiscard]] double start() const noexcept { return start_; }                  ///< number of the first sample
  [[nodiscard]] double delay() const noexcept { return pulses_.delay(); }         ///< of a pulse's maximum in the samples [s]
  [[nodiscard]] double background() const noexcept { return chain_.background; }  ///< mean that is not in the samples [W]
  [[nodiscard]] bool independent_noise() const noexcept { return false; }         ///< noise is filtered

  /// Begins the next section; false if there is none.
  [[nodiscard]] bool begin_section() noexcept {
    if (noisy_ ? begun_ || !(number_ <= end_ || !reflections_.empty()) : next_ == reflections_.size()) return false;
    if (!noisy_) {
      number_ = first_of(next_);
      end_ = number_;
    }
    begun_ = true;
    held_ = 0;
    raw_ = static_cast<std::int64_t>(number_) + pulses_.first_tap;
    for (std::size_t k = 1; k < pulses_.taps.size(); ++k) keep_raw();
    return true;
  }

  /// Number of the next sample of the section.
  [[nodiscard]] double number() const noexcept { return number_; }

  /// Next sample [W]; sets `more` if the section goes on behind it.
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
    return power;
  }

 private:
  static constexpr double margin = 2;         ///< samples beside a pulse, so that a peak has neighbours
  static constexpr double samples_max = 1e7;  ///< of a gate

  [[nodiscard]] static RandomKey noise_key(RandomKey key) noexcept {
    key.purpose = Purpose::receiver_noise;
    return key;
  }

  [[nodiscard]] double deviation(double signal) const noexcept {
    return std::sqrt(chain_.density(signal, wavelength_) * pulses_.filter.noise_bandwidth()) / pulses_.pulse.gain();
  }

  /// Number of the first sample of a section that a reflection begins.
  [[nodiscard]] double first_of(std::size_t r) const noexcept {
    const double first = pulses_.pulse.first_sample(arrival(reflections_[r])) - margin;
    if (pulses_.taps.empty()) return first;
    return first - static_cast<double>(pulses_.first_tap) - static_cast<double>(pulses_.taps.size());
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
    auto k = static_cast<std::size_t>(std::max(std::int64_t{0}, raw_ - static_cast<std::int64_t>(first)));  // samples that are gone
    at = (at + k) & (size - 1);
    for (std::size_t end; k < pulse.stride(); k = end, at = 0) {
      end = std::min(pulse.stride(), k + (size - at));
      for (std::size_t q = 0; q < pulse.rows(); ++q)
        if (w_.phases[q] != 0) add(w_.phases[q], pulse.row(q) + k, end - k, w_.sums.data() + at);
    }
    end_ = std::max(end_, first + static_cast<double>(pulse.count()) + margin - static_cast<double>(pulses_.first_tap));
  }

  /// Adds `factor` times some numbers to others.
  static void add(double factor, const double* from, std::size_t count, double* to) noexcept {
    std::size_t k = 0;
    for (; k + simd::lane_count <= count; k += simd::lane_count)
      simd::store(simd::Doubles(simd::load<simd::Doubles>(to[k]) + factor * simd::load<simd::Doubles>(from[k])), to[k]);
    for (; k < count; ++k) to[k] += factor * from[k];
  }

  /// Next sample before a matched filter.
  double raw() noexcept {
    const std::size_t mask = w_.sums.size() - 1;
    while (next_ < reflections_.size() && pulses_.pulse.first_sample(arrival(reflections_[next_])) <= static_cast<double>(raw_))
      add_pulses();
    double& sum = w_.sums[static_cast<std::size_t>(raw_) & mask];
    double power = std::exchange(sum, 0.0);
    if (deviation_ > 0) power += (chain_.shot_noise ? deviation(power) : deviation_) * noise_(static_cast<double>(raw_) * interval_);
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
  Workspace& w_;
  double interval_, wavelength_;
  FilteredNoise noise_;
  bool noisy_, begun_ = false;
  double deviation_ = 0, held_decay_ = 0, held_ = 0;
  double number_ = 0, end_ = -1, start_ = 0;
  std::int64_t raw_ = 0;
  std::size_t next_ = 0;
};

/// The only maximum of the samples of a pulse.
struct OnlyPeak {
  double time;                            ///< less the receiver's delay [s]
  double height;                          ///< power [W]
  const Reflection* strongest = nullptr;  ///< reflection with the greatest share of it
};

/// Receiver of finite bandwidth, as real ones are: a policy of `FullWaveform`, by the settings of a `ReceiverChain` and the form of the
/// laser's pulse. Results do not depend on the sample interval once it resolves the bandwidth. Noise makes it listen to the whole gate.
template <PulseForm Form = GammaPulse>
class BandLimitedReceiver {
 public:
  BandLimitedReceiver() : BandLimitedReceiver(ReceiverChain{}) {}  ///< receiver without noise
  /// @throws SettingError for settings out of range
  explicit BandLimitedReceiver(ReceiverChain settings, Form form = {}) : chain_(validated(settings)), form_(std::move(form)) {}

  /// Settings, as validated.
  [[nodiscard]] const ReceiverChain& settings() const noexcept { return chain_; }

  static constexpr bool listens_always = true;  ///< true: noise is heard without light
  /// Scratch memory of one worker.
  using Workspace = BandLimitedSamples::Workspace;

  /// Computes what pulses of a laser need, before the first of them.
  void prepare(const Laser& laser, const WaveformSettings& s) {
    if (known_.find(laser)) return;
    const LowPass filter = chain_.filter(laser.pulse_length);
    const auto made = std::make_shared<detail::ReceivedPulses>(
        detail::ReceivedPulses{filter, ReceivedPulse(form_, laser.pulse_length, filter, s.sample_interval)});
    if (chain_.matched_filter) {
      const double step = s.sample_interval;
      const auto first = static_cast<std::int64_t>(std::floor(made->pulse.begin() / step));
      const auto last = static_cast<std::int64_t>(std::ceil(made->pulse.end() / step));
      double energy = 0;
      for (std::int64_t k = first; k <= last; ++k) {
        made->taps.push_back(made->pulse(static_cast<double>(k) * step));
        energy += made->taps.back() * made->taps.back();
      }
      for (double& tap : made->taps) tap /= energy;
      made->first_tap = first;
    }
    known_.add(laser, made);
  }

  /// Takes away noise, saturation and the steps of the digitiser.
  void silence() noexcept {
    chain_.noise_power = chain_.background = chain_.dark_current = chain_.saturation = chain_.full_scale = 0;
    chain_.shot_noise = false;
  }

  /// As the concept WaveformReceiver requires: for `filtered_top`, where noise or steps may be finer than the pulse.
  [[nodiscard]] double timing_reach(const Laser& laser) const noexcept {
    return chain_.matched_filter || (chain_.bandwidth == 0 && chain_.full_scale == 0) ? 0 : 0.6 * (*known_.find(laser))->pulse.width();
  }

  /// Scratch memory for the pulses that were prepared.
  [[nodiscard]] Workspace workspace() const {
    std::size_t samples = 1, taps = 0, phases = 0;
    known_.each([&](const auto& pulses) {
      samples = std::max(samples, pulses->pulse.stride());
      phases = std::max(phases, pulses->pulse.rows());
      taps = std::max(taps, pulses->taps.size());
    });
    return {std::vector<double>(std::bit_ceil(samples)), std::vector<double>(phases),
            std::vector<double>(taps == 0 ? 0 : std::bit_ceil(taps))};
  }

  /// Maximum of the samples, if there is only one, from those near it: as full sampling gives it. Empty for reflections that are none or
  /// too far apart, and for receivers whose samples are more than the sum of the pulses. `reach` is that of `timing_reach`.
  [[nodiscard]] std::optional<OnlyPeak> only_peak(const WaveformSettings& s, const Heard& heard, double reach) const noexcept {
    if (!is_linear() || heard.reflections.empty()) return {};
    const ReceivedPulse& pulse = (*known_.find(heard.emitter.laser))->pulse;
    double nearest = std::numeric_limits<double>::infinity(), farthest = 0;
    for (const Reflection& r : heard.reflections) {
      if (!can_count(r, s.sample_interval)) return {};
      nearest = std::min(nearest, arrival(r));
      farthest = std::max(farthest, arrival(r));
    }
    constexpr std::size_t most = 64;
    const double beside = 3 + std::ceil(reach / s.sample_interval);  // samples
    const double from = std::floor((nearest + pulse.peak()) / s.sample_interval) - beside;
    const double to = std::ceil((farthest + pulse.peak()) / s.sample_interval) + beside;
    if (!(farthest - nearest <= pulse.concave() && to - from < most)) return {};
    const auto count = static_cast<std::size_t>(to - from) + 1;
    std::array<double, most + simd::lane_count> y{};
    for (const Reflection& r : heard.reflections) {
      const ReceivedPulse::Phase phase = pulse.phase(arrival(r));
      const double before = from - pulse.first_sample(arrival(r));
      if (!(before >= 0 && before + static_cast<double>(count + simd::lane_count) <= static_cast<double>(pulse.stride()))) return {};
      const double* const row = pulse.row(phase.first) + static_cast<std::size_t>(before);
      for (std::size_t k = 0; k < count; k += simd::lane_count) {
        simd::Doubles sum{};
        for (std::size_t j = 0; j < 4; ++j) sum += phase.weights[j] * simd::load<simd::Doubles>(row[j * pulse.stride() + k]);
        simd::store(simd::Doubles(simd::load<simd::Doubles>(y[k]) + r.power * sum), y[k]);
      }
    }
    const auto top =
        static_cast<std::size_t>(std::max_element(y.begin() + 2, y.begin() + static_cast<std::ptrdiff_t>(count) - 2) - y.begin());
    const Vertex between = vertex(&y[top]);
    const double place = static_cast<double>(top) + between.offset, time = (from + place) * s.sample_interval;
    const double mark = detail::filtered_top(std::span(y).first(count), place, reach / s.sample_interval);
    OnlyPeak only{(from + mark) * s.sample_interval - pulse.peak(), between.height};
    double strongest = 0;
    for (const Reflection& r : heard.reflections)
      if (const double power = r.power * pulse(time - arrival(r)); power > strongest) {
        strongest = power;
        only.strongest = &r;
      }
    return only;
  }

  /// As the concept WaveformReceiver requires; for pulses that were prepared.
  [[nodiscard]] BandLimitedSamples samples(const WaveformSettings& s, const Heard& heard, std::span<const Reflection> reflections,
                                           double /*width_tail*/, Workspace& w) const noexcept {
    const auto* pulses = known_.find(heard.emitter.laser);
    PULSECAST_ASSERT(pulses != nullptr);
    return {chain_, **pulses, s, heard, reflections, w};
  }

 private:
  /// True if samples are the sum of the pulses.
  [[nodiscard]] bool is_linear() const noexcept {
    return !chain_.noisy() && !chain_.shot_noise && chain_.saturation == 0 && chain_.full_scale == 0 && !chain_.matched_filter;
  }

  ReceiverChain chain_;
  Form form_;
  ByPulseLength<std::shared_ptr<const detail::ReceivedPulses>> known_;  ///< shared by copies
};

}  // namespace PULSECAST_NAMESPACE

#endif
