// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include <pulsecast/base/expect.hpp>
#include <pulsecast/base/units.hpp>
#include <pulsecast/concepts.hpp>
#include <pulsecast/detector/echo_width.hpp>
#include <pulsecast/detector/pulse_shape.hpp>

namespace pulsecast {

/// Settings of `FullWaveform`. All times are two-way.
struct WaveformSettings {
  double sample_interval = 0.25e-9;  ///< of the digitiser: one bin [s]
  double threshold = 1e-12;          ///< weaker peaks are no echoes [W]
  double window = 1e-9;              ///< an echo is the highest within this time before and after it [s]
  std::size_t max_returns = 15;      ///< the first so many in order of range; at least 1
  double record_length = 0;          ///< how much of the waveform is kept, from its first sample on; 0 for none [s]
  double shape_divisor = 3.5;        ///< full width at half maximum of the pulse by its tau, see `PulseShape`
};

/// Samples the sum of the pulse shapes of all reflections, and finds its peaks. Their times are interpolated between samples.
///
/// The shape is a polynomial times an exponential, so the sum of any number of shapes is carried from sample to sample by three
/// moments: exact, and at a cost of samples plus reflections, not of their product.
/// Limits: a lone echo's range errs by 0.03 mm where an interval is a sixteenth of the pulse's length, by 0.5 mm at an eighth and by
/// 10 mm at a quarter, where its amplitude errs by 2 %.
template <EchoWidth Width = NoWidth>
class FullWaveform {
 public:
  explicit FullWaveform(WaveformSettings settings = {}, Width width = {}) : s_(settings), width_(width) {
    expect_positive("WaveformSettings::sample_interval", s_.sample_interval, "s");
    expect_not_negative("WaveformSettings::threshold", s_.threshold, "W");
    expect_not_negative("WaveformSettings::window", s_.window, "s");
    expect_within("WaveformSettings::max_returns", static_cast<double>(s_.max_returns), 1, 255, "");
    expect_within("WaveformSettings::record_length", s_.record_length, 0, 1e7 * s_.sample_interval, "s");
    expect_positive("WaveformSettings::shape_divisor", s_.shape_divisor, "");
  }

  [[nodiscard]] const WaveformSettings& settings() const noexcept { return s_; }
  [[nodiscard]] double sample_interval() const noexcept { return s_.sample_interval; }

  struct Workspace {
    std::vector<double> samples;  ///< of the stretch at hand [W]
    std::vector<Echo> echoes;
    std::vector<float> record;
  };

  [[nodiscard]] Workspace workspace(std::size_t subrays) const {
    Workspace w;
    w.samples.reserve(stretch);
    w.echoes.reserve(subrays);
    w.record.reserve(record_capacity());
    return w;
  }

  /// Sorts the reflections by range. Those so far away that samples could not be counted, 2^50 of them, are left out.
  [[nodiscard]] Detection detect(const Laser& laser, std::span<Reflection> all, Workspace& w) const noexcept {
    const auto countless = [&](const Reflection& r) { return !(arrival(r) < 0x1p50 * s_.sample_interval); };
    const std::span<Reflection> reflections(all.begin(), std::remove_if(all.begin(), all.end(), countless));
    std::sort(reflections.begin(), reflections.end(), [](const Reflection& a, const Reflection& b) { return a.range < b.range; });
    w.echoes.clear(), w.record.clear();
    if (reflections.empty()) return {};

    const PulseShape shape(laser.pulse_length, s_.shape_divisor);
    const bool to_the_end = record_capacity() > 0 || !std::same_as<Width, NoWidth>;
    const double tail = to_the_end ? negligible * shape.tau : 3 * s_.sample_interval;
    const double record_start = first_sample(reflections.front(), shape);
    for (std::size_t next = 0; next < reflections.size();) {
      Sum sum(shape.tau, s_.sample_interval);
      double n = first_sample(reflections[next], shape);  // number of the sample
      w.samples.clear();
      for (double last_peak = arrival(reflections[next]);; ++n) {
        const double t = n * s_.sample_interval;
        sum.advance();
        for (; next < reflections.size() && arrival(reflections[next]) - PulseShape::peak * shape.tau <= t; ++next) {
          last_peak = arrival(reflections[next]);
          sum.add(reflections[next].power, (t - last_peak) / shape.tau + PulseShape::peak);
        }
        w.samples.push_back(sum.power());
        keep(n - record_start, sum.power(), w.record);
        if (t > last_peak + tail && (next == reflections.size() || first_sample(reflections[next], shape) > n + gap(shape))) break;
        if (w.samples.size() == stretch) {
          const std::size_t cut = last_valley(w.samples);  // so that no echo is cut in two
          find_peaks(n, cut, shape, reflections, w);
          w.samples.erase(w.samples.begin(), w.samples.begin() + static_cast<std::ptrdiff_t>(cut - 2));
        }
      }
      find_peaks(n, w.samples.size() - 2, shape, reflections, w);
    }
    keep_the_highest(w.echoes);
    return {w.echoes, w.record, record_start * s_.sample_interval};
  }

 private:
  static constexpr std::size_t stretch = 4096;  ///< samples at hand at one time
  static constexpr double negligible = 20;      ///< after so many tau since its peak, 1e-6 of a pulse is left

  /// The sum of pulse shapes at one sample, as moments about the leading edges: sums of P e^-u, P u e^-u and P u^2 e^-u.
  class Sum {
   public:
    Sum(double tau, double interval) noexcept : step_(interval / tau), decay_(std::exp(-step_)) {}

    void advance() noexcept {
      second_ = decay_ * (second_ + step_ * (2 * first_ + step_ * zeroth_));
      first_ = decay_ * (first_ + step_ * zeroth_);
      zeroth_ *= decay_;
    }

    /// A pulse whose leading edge has passed u tau ago.
    void add(double power, double u) noexcept {
      const double p = power * std::exp(-u);
      zeroth_ += p, first_ += p * u, second_ += p * u * u;
    }

    [[nodiscard]] double power() const noexcept { return second_ * PulseShape::to_unit_peak; }

   private:
    double step_, decay_;
    double zeroth_ = 0, first_ = 0, second_ = 0;
  };

  [[nodiscard]] std::size_t record_capacity() const noexcept {
    return static_cast<std::size_t>(std::ceil(s_.record_length / s_.sample_interval));
  }

  /// When a reflection's peak arrives [s].
  static double arrival(const Reflection& r) noexcept { return 2 * r.range / speed_of_light; }

  /// Number of the first sample that a reflection needs: two before its leading edge.
  [[nodiscard]] double first_sample(const Reflection& r, const PulseShape& shape) const noexcept {
    return std::floor((arrival(r) - PulseShape::peak * shape.tau) / s_.sample_interval) - 2;
  }

  /// Samples without a new reflection after which the sum has died away.
  [[nodiscard]] double gap(const PulseShape& shape) const noexcept { return negligible * shape.tau / s_.sample_interval; }

  void keep(double at, double power, std::vector<float>& record) const noexcept {
    if (at < 0 || at >= static_cast<double>(record_capacity())) return;
    record.resize(static_cast<std::size_t>(at) + 1);  // within its capacity; a gap is filled with zeros
    record.back() = static_cast<float>(power);
  }

  /// Where the last echo that is whole ends; two samples before the end if there is no valley.
  static std::size_t last_valley(const std::vector<double>& y) noexcept {
    for (std::size_t i = y.size() - 2; i > 4; --i)
      if (y[i] < y[i - 1] && y[i] <= y[i + 1]) return i;
    return y.size() - 2;
  }

  /// Enters every peak before `end` of the stretch whose last sample has the number `last`.
  void find_peaks(double last, std::size_t end, const PulseShape& shape, std::span<const Reflection> reflections,
                  Workspace& w) const noexcept {
    const std::vector<double>& y = w.samples;
    for (std::size_t i = 2; i < end; ++i) {
      if (!(y[i] > y[i - 1] && y[i] >= y[i + 1])) continue;
      const auto [offset, height] = vertex(&y[i]);
      if (height < s_.threshold) continue;
      if (w.echoes.size() == w.echoes.capacity()) return;
      const double time = (last - static_cast<double>(y.size() - 1 - i) + offset) * s_.sample_interval;
      const Reflection& strongest =
          *std::max_element(reflections.begin(), reflections.end(), [&](const Reflection& a, const Reflection& b) {
            return a.power * shape(time - arrival(a)) < b.power * shape(time - arrival(b));
          });
      w.echoes.push_back({.range = 0.5 * speed_of_light * time,
                          .amplitude = height,
                          .width = width_.width(between_valleys(y, i), s_.sample_interval),
                          .cos_incidence = strongest.cos_incidence,
                          .object = strongest.object,
                          .classification = strongest.classification});
    }
  }

  struct Vertex {
    double offset, height;  ///< from the middle sample [samples], [W]
  };

  /// The top of the quartic through five samples about a peak, by Newton's method from the parabola through the middle three.
  static Vertex vertex(const double* y) noexcept {
    const double c1 = (8 * (y[1] - y[-1]) - (y[2] - y[-2])) / 12, c2 = (16 * (y[1] + y[-1]) - (y[2] + y[-2]) - 30 * y[0]) / 24;
    const double c3 = ((y[2] - y[-2]) - 2 * (y[1] - y[-1])) / 12, c4 = ((y[2] + y[-2]) - 4 * (y[1] + y[-1]) + 6 * y[0]) / 24;
    double x = 0.5 * (y[-1] - y[1]) / (y[-1] - 2 * y[0] + y[1]);
    for (int step = 0; step < 3; ++step) {
      const double slope = c1 + x * (2 * c2 + x * (3 * c3 + x * 4 * c4)), bend = 2 * c2 + x * (6 * c3 + x * 12 * c4);
      if (!(bend < 0)) break;
      x = std::clamp(x - slope / bend, -1.0, 1.0);
    }
    return {x, y[0] + x * (c1 + x * (c2 + x * (c3 + x * c4)))};
  }

  static std::span<const double> between_valleys(const std::vector<double>& y, std::size_t peak) noexcept {
    std::size_t from = peak, to = peak;
    while (from > 0 && y[from - 1] < y[from]) --from;
    while (to + 1 < y.size() && y[to + 1] < y[to]) ++to;
    return {y.data() + from, to - from + 1};
  }

  /// Drops every echo that a higher one stands too close to, numbers the others, and ends with the last one allowed.
  void keep_the_highest(std::vector<Echo>& echoes) const noexcept {
    const double reach = 0.5 * speed_of_light * s_.window;
    const auto outdone = [&](const Echo& e) {
      return std::any_of(echoes.begin(), echoes.end(), [&](const Echo& other) {
        return std::fabs(other.range - e.range) <= reach &&
               (other.amplitude > e.amplitude || (other.amplitude == e.amplitude && other.range < e.range));
      });
    };
    for (Echo& e : echoes) e.number = outdone(e) ? 0 : 1;
    std::erase_if(echoes, [](const Echo& e) { return e.number == 0; });
    if (echoes.size() > s_.max_returns) echoes.resize(s_.max_returns);
    for (std::size_t i = 0; i < echoes.size(); ++i) echoes[i].number = static_cast<std::uint8_t>(i + 1);
  }

  WaveformSettings s_;
  Width width_;
};

static_assert(Detector<FullWaveform<>> && Detector<FullWaveform<MomentWidth>>);

}  // namespace pulsecast
