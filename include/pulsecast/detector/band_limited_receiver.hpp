// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_DETECTOR_BAND_LIMITED_RECEIVER_HPP
#define PULSECAST_DETECTOR_BAND_LIMITED_RECEIVER_HPP

#include <pulsecast/detector/detail/band_limited_samples.hpp>
#include <pulsecast/detector/detail/by_pulse_length.hpp>

namespace PULSECAST_NAMESPACE {

/// Receiver of finite bandwidth: a policy of `FullWaveform`, by the settings of a `ReceiverChain`
/// and the form of the laser's pulse. With noise it samples the whole gate.
template <PulseForm Form = GammaPulse>
class BandLimitedReceiver {
 public:
  BandLimitedReceiver() : BandLimitedReceiver(ReceiverChain{}) {}  ///< receiver without noise
  /// @throws SettingError for settings out of range
  explicit BandLimitedReceiver(ReceiverChain settings, Form form = {})
      : chain_(validated(settings)), form_(std::move(form)) {}

  [[nodiscard]] const ReceiverChain& settings() const noexcept { return chain_; }

  static constexpr bool runs_without_reflections = true;  ///< true: noise is detected without light
  using Workspace = BandLimitedSamples::Workspace;        ///< scratch memory of one worker

  /// Computes what pulses of a laser need, before the first of them.
  void prepare(const Laser& laser, const WaveformSettings& s) {
    if (known_.find(laser)) return;
    const LowPass filter = chain_.filter(laser.pulse_length);
    const double step = s.sample_interval;
    const auto made = std::make_shared<detail::ReceivedPulses>(
        detail::ReceivedPulses{filter, ReceivedPulse(form_, laser.pulse_length, filter, step)});
    if (chain_.matched_filter) {
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

  /// For `filtered_top`, where noise or steps may be finer than the pulse.
  [[nodiscard]] double timing_reach(const Laser& laser) const noexcept {
    return chain_.matched_filter || (chain_.bandwidth == 0 && chain_.full_scale == 0)
               ? 0
               : 0.6 * (*known_.find(laser))->pulse.width();
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

  /// Maximum of the samples, if there is only one, from those near it: as full sampling gives it.
  /// Empty for reflections that are none or too far apart, where continuous returns may rise, and
  /// if samples are more than the sum of the pulses. `reach` is that of `timing_reach`.
  [[nodiscard]] std::optional<OnlyPeak> only_peak(const WaveformSettings& s, const DetectorInput& input,
                                                  double reach) const noexcept {
    if (!is_linear() || input.reflections.empty()) return {};
    const ReceivedPulse& pulse = (*known_.find(input.emitter.laser))->pulse;
    double nearest = std::numeric_limits<double>::infinity(), farthest = 0;
    for (const Reflection& r : input.reflections) {
      if (!can_count(r.power, r.range, s.sample_interval)) return {};
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
    for (const Reflection& r : input.reflections) {
      const ReceivedPulse::Phase phase = pulse.phase(arrival(r));
      const double before = from - pulse.first_sample(arrival(r));
      const double after = before + static_cast<double>(count + simd::lane_count);
      if (!(before >= 0 && after <= static_cast<double>(pulse.stride()))) return {};
      const double* const row = pulse.row(phase.first) + static_cast<std::size_t>(before);
      for (std::size_t k = 0; k < count; k += simd::lane_count) {
        simd::Doubles sum{};
        for (std::size_t j = 0; j < 4; ++j)
          sum += phase.weights[j] * simd::load<simd::Doubles>(row[j * pulse.stride() + k]);
        simd::store(simd::Doubles(simd::load<simd::Doubles>(y[k]) + r.power * sum), y[k]);
      }
    }
    if (!input.continuous.empty()) {
      detail::ContinuousRises<const ReceivedPulse&> continuous(input.continuous, pulse);
      continuous.pass((from + static_cast<double>(count)) * s.sample_interval);
      if (!(continuous.until() <= from * s.sample_interval - pulse.end() &&
            continuous.next() >= to * s.sample_interval + pulse.end()))
        return {};
      for (std::size_t k = 0; k < count; ++k)
        y[k] += continuous.power((from + static_cast<double>(k)) * s.sample_interval);
    }
    const auto top = static_cast<std::size_t>(
        std::max_element(y.begin() + 2, y.begin() + static_cast<std::ptrdiff_t>(count) - 2) - y.begin());
    if (!input.continuous.empty() && !(y[top] > y[top - 1] && y[top] >= y[top + 1])) return {};
    const detail::Vertex between = detail::vertex(&y[top]);
    const double place = static_cast<double>(top) + between.offset, time = (from + place) * s.sample_interval;
    const double mark = detail::filtered_top(std::span(y).first(count), place, reach / s.sample_interval);
    OnlyPeak only{(from + mark) * s.sample_interval - pulse.peak(), between.height};
    double strongest = 0;
    for (const Reflection& r : input.reflections)
      if (const double power = r.power * pulse(time - arrival(r)); power > strongest) {
        strongest = power;
        only.strongest = &r;
      }
    return only;
  }

  /// Samples of pulses that were prepared.
  [[nodiscard]] BandLimitedSamples samples(const WaveformSettings& s, const DetectorInput& input,
                                           std::span<const Reflection> reflections, double width_tail,
                                           Workspace& w) const noexcept {
    const auto* pulses = known_.find(input.emitter.laser);
    PULSECAST_ASSERT(pulses != nullptr);
    return {chain_, **pulses, s, input, reflections, width_tail == 0, w};
  }

 private:
  /// True if samples are the sum of the pulses.
  [[nodiscard]] bool is_linear() const noexcept {
    return !chain_.noisy() && !chain_.shot_noise && chain_.saturation == 0 && chain_.full_scale == 0 &&
           !chain_.matched_filter;
  }

  ReceiverChain chain_;
  Form form_;
  ByPulseLength<std::shared_ptr<const detail::ReceivedPulses>> known_;  ///< shared by copies
};

}  // namespace PULSECAST_NAMESPACE

#endif
