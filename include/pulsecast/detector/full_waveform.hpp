// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_DETECTOR_FULL_WAVEFORM_HPP
#define PULSECAST_DETECTOR_FULL_WAVEFORM_HPP

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <pulsecast/base/random.hpp>
#include <pulsecast/base/require.hpp>
#include <pulsecast/base/simd.hpp>
#include <pulsecast/base/units.hpp>
#include <pulsecast/concepts.hpp>
#include <pulsecast/detector/echo_width.hpp>
#include <pulsecast/detector/peaks.hpp>
#include <pulsecast/detector/pulse_shape.hpp>
#include <pulsecast/detector/pulse_sum.hpp>
#include <pulsecast/detector/receiver_noise.hpp>
#include <pulsecast/detector/single_peak_group.hpp>
#include <pulsecast/detector/waveform_settings.hpp>

namespace PULSECAST_NAMESPACE {

/// Digitising detector: samples the sum of the pulse shapes of all reflections and finds its peaks. Their heights and times are
/// interpolated between samples.
///
/// With noise, the receiver records from the first reflection on, for the record's length and as long as reflections arrive, and detects
/// false echoes. The threshold applies to the samples themselves. Amplitudes and widths are relative to the mean background. Echoes are
/// timed by their peaks, since noisy samples do not tell the reflections apart. The record includes the background.
///
/// Limits: a single echo's peak errs by 0.03 mm for an interval of 1/16 of the pulse length, and by 0.5 mm at 1/8. At 1/4 it errs by 10 mm,
/// and its amplitude by 2 %. Pulses shorter than one interval or longer than 10,000 are refused. At most 4096 noise peaks per pulse are
/// considered.
template <EchoWidth Width = NoWidth>
class FullWaveform {
 public:
  /// @throws SettingError for settings out of range
  explicit FullWaveform(WaveformSettings settings = {}, Width width = {}, ReceiverNoise noise = {})
      : s_(validated(settings)), width_(validated(std::move(width))), noise_(validated(noise)) {}

  /// Settings, as validated.
  [[nodiscard]] const WaveformSettings& settings() const noexcept { return s_; }
  [[nodiscard]] double sample_interval() const noexcept { return s_.sample_interval; }

  /// Refuses pulses that the samples do not resolve, or that exceed the sample window. @throws SettingError
  void validate(const Laser& laser) const { s_.require_sampled(laser.pulse_length, WaveformSettings::max_samples); }

  /// Width of a laser's outgoing pulse, by the measure of its echoes [s]. @throws SettingError as `validate`
  [[nodiscard]] double pulse_width(const Laser& laser) const {
    validate(laser);
    return pulsecast::pulse_width(width_, PulseShape(laser.pulse_length, s_.shape_divisor), s_.sample_interval);
  }

  /// Scratch memory of one worker.
  struct Workspace {
    std::vector<double> samples;       ///< current window [W]
    std::vector<Peak> peaks;           ///< peaks of the current pulse
    std::vector<Echo> echoes;          ///< echoes of the current pulse
    std::vector<float> record;         ///< samples of the kept waveform [W]
    SinglePeakGroup::Workspace group;  ///< ages and weights
  };

  /// Scratch memory for pulses of up to `reflections` reflections.
  [[nodiscard]] Workspace workspace(std::size_t reflections) const {
    Workspace w{{}, {}, {}, {}, SinglePeakGroup::Workspace(reflections)};
    w.samples.reserve(window_samples);
    w.peaks.reserve(noise_.none() ? reflections : std::max(reflections, max_peaks));
    w.echoes.reserve(std::min(w.peaks.capacity(), s_.returns_max));
    w.record.reserve(s_.record_capacity());
    return w;
  }

  /// Sorts the reflections by range. Drops those without power, and those too far away for their samples to be counted. Noise is drawn per
  /// sample from the seed and pulse of `heard.key`.
  [[nodiscard]] Detection detect(const Heard& heard, Workspace& w) const noexcept {
    const Laser& laser = heard.emitter.laser;
    const std::span<Reflection> all = heard.reflections;
    w.peaks.clear();
    w.echoes.clear();
    w.record.clear();
    const PulseShape shape(laser.pulse_length, s_.shape_divisor);
    if (std::same_as<Width, NoWidth> && s_.record_length == 0 && noise_.none()) {
      const SinglePeakGroup group(all, shape, s_.sample_interval, w.group);
      if (group.one() && detect(group, shape, w.echoes)) return {w.echoes, {}, 0};
    }
    const std::span<const Reflection> reflections = in_order_of_range(all, s_.sample_interval);
    if (reflections.empty()) return {};
    const bool noisy = !noise_.none();
    const double deviation = noisy ? noise_.deviation_of_sample(laser.wavelength, s_.sample_interval) : 0;
    const auto record_size = static_cast<double>(s_.record_capacity());
    const double died_away = SampledSum::negligible * shape.tau;
    const bool to_the_end = noisy || record_size > 0;
    const double tail = to_the_end ? died_away : std::fmax(3 * s_.sample_interval, tail_of(width_) * shape.tau);
    const auto first_sample = [&](std::size_t r) { return SampledSum::first_sample(reflections[r], shape, s_.sample_interval); };
    const double record_start = first_sample(0);
    const double min_separation = s_.min_separation(laser.pulse_length);

    RandomKey key = heard.key;
    key.purpose = Purpose::receiver_noise;
    for (std::size_t next = 0; next < reflections.size();) {
      SampledSum sum(reflections, shape, s_.sample_interval, next, first_sample(next));
      w.samples.clear();
      for (bool going_on = true; going_on;) {
        const double n = sum.sample(), t = sum.time();
        double power = sum.power();
        next = sum.next();
        if (noisy) {
          const auto number = static_cast<std::uint64_t>(n - record_start);
          key.subray = static_cast<std::uint32_t>(number);
          key.part = static_cast<std::uint32_t>(number >> 32);
          power += deviation * normal(key);
        }
        w.samples.push_back(power);
        keep(n - record_start, power + noise_.background, w.record);
        const bool silent = next > 0 && t > sum.last_peak() + tail;
        const bool listening = noisy && n - record_start < record_size;
        going_on = !silent || listening || (next < reflections.size() && first_sample(next) <= n + died_away / s_.sample_interval);
        if (going_on && w.samples.size() == window_samples) {
          const std::size_t cut = last_valley(w.samples);  // a cut between two echoes
          find_peaks(n, cut, min_separation, w);
          w.samples.erase(w.samples.begin(), w.samples.begin() + static_cast<std::ptrdiff_t>(cut - 2));
        }
        if (!going_on) find_peaks(n, w.samples.size() - 2, min_separation, w);
      }
    }
    keep_echoes(s_, w.peaks);
    for (const Peak& peak : w.peaks) {
      const Echo echo = echo_of(peak, reflections, shape, noisy ? EchoTiming::peak : s_.timing, w.echoes.size() + 1);
      w.echoes.push_back(echo);
    }
    return {w.echoes, w.record, record_start * s_.sample_interval};
  }

 private:
  static constexpr std::size_t window_samples = 262144;  ///< capacity of the sample window: the longest pulse until it has decayed
  static constexpr std::size_t max_peaks = 4096;         ///< peaks of noise

  /// Appends the only echo of a group, if it reaches the threshold: equal to full sampling, from the samples near its peak. False if these
  /// reach back before the last edge.
  bool detect(const SinglePeakGroup& group, const PulseShape& shape, std::vector<Echo>& echoes) const noexcept {
    const double per_tau = 1 / shape.tau;
    const double before = std::floor((group.last_edge() + group.peak() * shape.tau) / s_.sample_interval);  // last sample before the peak
    const double first = ((before - 2) * s_.sample_interval - group.last_edge()) * per_tau, step = s_.sample_interval * per_tau;
    if (!(first >= 0)) return false;
    std::array<double, 8> y;  // samples from two before it on
    for (std::size_t j = 0; j < y.size(); j += simd::lane_count)
      simd::store(group.power(simd::generate([&](std::size_t lane) { return first + static_cast<double>(j + lane) * step; })), y[j]);
    const std::size_t top = y[3] > y[2] ? 3 : 2;
    const auto [offset, height] = vertex(&y[top]);
    if (height < s_.threshold) return true;
    const double time = (before - 2 + static_cast<double>(top) + offset) * s_.sample_interval;
    const Echo echo = group.echo(time, height, s_.timing);
    echoes.push_back(echo);
    return true;
  }

  void keep(double at, double power, std::vector<float>& record) const noexcept {
    if (at < 0 || at >= static_cast<double>(s_.record_capacity())) return;
    record.resize(static_cast<std::size_t>(at) + 1);  // within the capacity; a gap is filled with zeros
    record.back() = static_cast<float>(power);
  }

  /// End of the last complete echo; two samples before the end if there is no valley.
  static std::size_t last_valley(const std::vector<double>& y) noexcept {
    for (std::size_t i = y.size() - 2; i > 4; --i)
      if (y[i] < y[i - 1] && y[i] <= y[i + 1]) return i;
    return y.size() - 2;
  }

  /// Appends every peak before index `end` of the window, whose last sample has the number `last`.
  void find_peaks(double last, std::size_t end, double min_separation, Workspace& w) const noexcept {
    const std::vector<double>& y = w.samples;
    const double start = last - static_cast<double>(y.size() - 1);
    const auto time = [&](std::size_t i) { return (start + static_cast<double>(i)) * s_.sample_interval; };
    const auto valley = [&](std::size_t i) {
      const bool turns = i >= 2 && i + 2 < y.size() && y[i] < y[i - 1] && y[i] <= y[i + 1];
      if (!turns) return time(i);
      const std::array<double, 5> below{-y[i - 2], -y[i - 1], -y[i], -y[i + 1], -y[i + 2]};
      return time(i) + vertex(&below[2]).offset * s_.sample_interval;
    };
    std::size_t entered = w.peaks.size();
    for (std::size_t i = 2; i < end; ++i) {
      if (!(y[i] > y[i - 1] && y[i] >= y[i + 1])) continue;
      const auto [offset, height] = vertex(&y[i]);
      if ((noise_.none() ? height : y[i]) < s_.threshold) continue;
      std::size_t from = i, to = i;
      while (from > 0 && y[from - 1] < y[from]) --from;
      while (to + 1 < y.size() && y[to + 1] < y[to]) ++to;
      merge_or_append({.time = time(i) + offset * s_.sample_interval, .height = height, .begin = valley(from), .end = valley(to)},
                      min_separation, w.peaks);
    }
    if constexpr (!std::same_as<Width, NoWidth>) {
      for (; entered < w.peaks.size(); ++entered) {
        Peak& peak = w.peaks[entered];
        if (is_dominated(entered, s_, w.peaks)) continue;
        const auto from = static_cast<std::size_t>(std::lround(peak.begin / s_.sample_interval - start));
        const auto to = static_cast<std::size_t>(std::lround(peak.end / s_.sample_interval - start));
        peak.width = width_.width(std::span(y).subspan(from, to - from + 1), s_.sample_interval);
      }
    }
  }

  struct Vertex {
    double offset, height;  ///< offset from the middle sample [samples]; power [W]
  };

  /// Maximum of the quartic through five samples about a peak, by Newton's method from the vertex of the parabola through the middle three.
  /// Returns that vertex where the quartic has no maximum, as in noise.
  static Vertex vertex(const double* y) noexcept {
    const double c1 = (8 * (y[1] - y[-1]) - (y[2] - y[-2])) / 12, c2 = (16 * (y[1] + y[-1]) - (y[2] + y[-2]) - 30 * y[0]) / 24;
    const double c3 = ((y[2] - y[-2]) - 2 * (y[1] - y[-1])) / 12, c4 = ((y[2] + y[-2]) - 4 * (y[1] + y[-1]) + 6 * y[0]) / 24;
    const double middle = 0.5 * (y[-1] - y[1]) / (y[-1] - 2 * y[0] + y[1]);
    double x = middle;
    for (int step = 0; step < 3; ++step) {
      const double slope = c1 + x * (2 * c2 + x * (3 * c3 + x * 4 * c4)), bend = 2 * c2 + x * (6 * c3 + x * 12 * c4);
      if (!(bend < 0)) break;
      x = std::clamp(x - slope / bend, -1.0, 1.0);
    }
    const double height = y[0] + x * (c1 + x * (c2 + x * (c3 + x * c4)));
    return height >= y[0] ? Vertex{x, height} : Vertex{middle, y[0] + 0.25 * middle * (y[1] - y[-1])};
  }

  WaveformSettings s_;
  Width width_;
  ReceiverNoise noise_;
};

static_assert(Detector<FullWaveform<>>);

}  // namespace PULSECAST_NAMESPACE

#endif
