// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_DETECTOR_DETAIL_SYSTEM_WAVEFORM_HPP
#define PULSECAST_DETECTOR_DETAIL_SYSTEM_WAVEFORM_HPP

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include <pulsecast/base/namespace.hpp>

namespace PULSECAST_NAMESPACE::detail {

/// Waveform of a flat target after the receiver, and of targets whose ranges spread as a Gaussian
/// about it: a table for each of some variances, interpolated by cubics in time and variance. By
/// the equation of heat, the slope in the variance is half the second derivative in time.
class SystemWaveform {
 public:
  /// Takes samples of a flat target of power 1, every `step` [s], from `begin` on [s].
  SystemWaveform(std::vector<double> flat, double begin, double step) : begin_(begin), step_(step) {
    double energy = 0, first = 0, second = 0;
    for (std::size_t i = 0; i < flat.size(); ++i) {
      const double t = begin + static_cast<double>(i) * step;
      energy += flat[i];
      first += flat[i] * t;
      second += flat[i] * t * t;
    }
    variance_ = second / energy - first / energy * (first / energy);
    for (std::size_t i = flat.size(); i-- > 0;)
      if (flat[i] > 1e-3) rise_ = begin + static_cast<double>(i) * step;
    for (std::size_t i = 0; i < flat.size(); ++i)
      if (flat[i] > 1e-3) fall_ = begin + static_cast<double>(i) * step;
    levels_[0] = {2, std::vector<double>(flat.size() + 4)};
    std::copy(flat.begin(), flat.end(), levels_[0].values.begin() + 2);
    for (std::size_t j = 1; j < levels_.size(); ++j)
      levels_[j] = widened(levels_[j - 1], std::sqrt(added(j) - added(j - 1)) / step);
  }

  [[nodiscard]] double variance() const noexcept { return variance_; }  ///< of a flat target [s^2]
  [[nodiscard]] double rise() const noexcept { return rise_; }          ///< at a thousandth [s]
  [[nodiscard]] double fall() const noexcept { return fall_; }          ///< at a thousandth [s]
  // least and greatest variance in use [s^2]
  [[nodiscard]] double least_added() const noexcept { return -0.3 * variance_; }
  [[nodiscard]] double most_added() const noexcept { return 0.999 * added(levels_.size() - 1); }

  /// Place between two tables.
  struct Blend {
    std::size_t level = 0;
    double place = 0;  ///< from 0 to 1; below 0 for less than a flat target
    double span = 0;   ///< distance of the tables [s^2]
  };
  /// Place of a variance beyond that of a flat target [s^2]; extrapolated below 0, for noise.
  [[nodiscard]] Blend blend(double variance) const noexcept {
    std::size_t j = 0;
    while (j + 2 < levels_.size() && added(j + 1) <= variance) ++j;
    const double span = added(j + 1) - added(j);
    return {j, (variance - added(j)) / span, span};
  }

  /// Waveform at a time since the arrival, and its slopes by time and variance.
  struct Value {
    double value = 0, by_time = 0, by_variance = 0;
  };
  [[nodiscard]] Value at(double time, const Blend& b) const noexcept {
    const double x = (time - begin_) / step_, whole = std::floor(x), f = x - whole, u = b.place;
    const Cubic low = levels_[b.level].at(whole, f);
    const double slope = 0.5 * low.bend / (step_ * step_);
    if (u < 0) return {low.value + u * b.span * slope, low.slope / step_, slope};
    const Cubic high = levels_[b.level + 1].at(whole, f);
    const double then = 0.5 * high.bend / (step_ * step_);
    return {
        (1 + 2 * u) * (1 - u) * (1 - u) * low.value + u * u * (3 - 2 * u) * high.value +
            b.span * u * (1 - u) * ((1 - u) * slope - u * then),
        ((1 - u) * low.slope + u * high.slope) / step_,
        6 * u * (1 - u) * (high.value - low.value) / b.span + (1 - u) * (1 - 3 * u) * slope + u * (3 * u - 2) * then};
  }

 private:
  /// Cubic through four samples, and its derivatives by sample.
  struct Cubic {
    double value = 0, slope = 0, bend = 0;
  };
  struct Level {
    double before = 0;           ///< samples before the first of a flat target
    std::vector<double> values;  ///< 0 beyond

    [[nodiscard]] Cubic at(double whole, double f) const noexcept {
      const double place = whole + before;
      if (!(place >= 1 && place + 2 < static_cast<double>(values.size()))) return {};
      const double* const v = values.data() + static_cast<std::size_t>(place);
      const double a = v[-1], b = v[0], c = v[1], d = v[2];
      const double c1 = c - b / 2 - a / 3 - d / 6, c2 = (a + c) / 2 - b, c3 = (d - a) / 6 + (b - c) / 2;
      return {b + f * (c1 + f * (c2 + f * c3)), c1 + f * (2 * c2 + f * 3 * c3), 2 * c2 + f * 6 * c3};
    }
  };

  /// Variance of a level beyond that of a flat target [s^2].
  [[nodiscard]] double added(std::size_t level) const noexcept {
    return variance_ * (std::pow(1.2, static_cast<double>(level)) - 1);
  }

  /// Convolution with a Gaussian of a deviation [samples].
  static Level widened(const Level& from, double deviation) {
    const auto reach = static_cast<std::size_t>(std::ceil(6 * deviation));
    std::vector<double> kernel(2 * reach + 1);
    double sum = 0;
    for (std::size_t i = 0; i < kernel.size(); ++i) {
      const double x = (static_cast<double>(i) - static_cast<double>(reach)) / deviation;
      sum += kernel[i] = std::exp(-0.5 * x * x);
    }
    std::vector<double> values(from.values.size() + 2 * reach);
    for (std::size_t i = 0; i < from.values.size(); ++i)
      for (std::size_t k = 0; k < kernel.size(); ++k) values[i + k] += from.values[i] * kernel[k] / sum;
    const auto counts = [](double value) { return std::fabs(value) > 1e-9; };
    const auto first = std::find_if(values.begin(), values.end(), counts) - 2;  // some zeros stay
    values.erase(std::find_if(values.rbegin(), values.rend(), counts).base() + 2, values.end());
    Level to{from.before + static_cast<double>(reach) - static_cast<double>(first - values.begin()), {}};
    to.values.assign(first, values.end());
    return to;
  }

  double begin_, step_, variance_ = 0, rise_ = 0, fall_ = 0;
  std::array<Level, 24> levels_{};  ///< up to 8 times the deviation of a flat target
};

/// Sum of up to six system waveforms and a constant, fitted to samples by least squares, whose
/// weights are equal, as the noise of a digitiser. Source: Levenberg 1944; Marquardt 1963.
class WaveformSum {
 public:
  static constexpr std::size_t most = 6;  ///< parts

  struct Part {
    double power = 0, arrival = 0;  ///< power of a flat target [W], and arrival [s]
    double added = 0;               ///< variance beyond that of a flat target [s^2]
    bool flat = false;              ///< true if that is 0 and not fitted
    double spread = 0;              ///< the same, as measured aside of a flat part [s^2]
  };

  std::array<Part, most> parts{};  ///< estimate, and result
  std::size_t count = 0;           ///< number of parts
  double constant = 0;             ///< what is added to all samples [W]
  double start = 0;                ///< time of the first sample [s]
  double squares = 0;              ///< sum of the squared residuals [W^2]

  /// Improves the estimate; false if it does not converge to positive parts within the samples.
  [[nodiscard]] bool fit(const SystemWaveform& wave, std::span<const float> y, double interval) noexcept {
    double damping = 1e-3;
    Equations here = equations(wave, y, interval);
    for (int step = 0; step < 60 && damping < 1e6; ++step) {
      WaveformSum next = *this;
      if (!next.step(wave, here, damping)) return false;
      const Equations there = next.equations(wave, y, interval);
      if (!(there.squares < here.squares)) {
        damping *= 10;
        continue;
      }
      const bool settled = here.squares - there.squares <= 1e-10 * here.squares;
      *this = next;
      here = there;
      damping = std::max(1e-12, 0.1 * damping);
      if (settled) break;
    }
    squares = here.squares;
    for (Part& p : parts)
      if (!p.flat) p.spread = p.added;
    const double end = start + static_cast<double>(y.size()) * interval;
    return std::all_of(parts.begin(), parts.begin() + static_cast<std::ptrdiff_t>(count), [&](const Part& p) {
      return p.power > 0 && p.arrival > start && p.arrival < end && p.added < wave.most_added();
    });
  }

  [[nodiscard]] WaveformSum flattened() const noexcept {
    WaveformSum sum = *this;
    for (Part& p : sum.parts) {
      p.added = 0;
      p.flat = true;
    }
    return sum;
  }

  [[nodiscard]] Part greatest_residual(const SystemWaveform& wave, std::span<const float> y,
                                       double interval) const noexcept {
    std::array<SystemWaveform::Blend, most> blends{};
    for (std::size_t k = 0; k < count; ++k) blends[k] = wave.blend(parts[k].added);
    Part greatest{.flat = true};
    for (std::size_t i = 0; i < y.size(); ++i) {
      const double time = start + static_cast<double>(i) * interval;
      double residual = static_cast<double>(y[i]) - constant;
      for (std::size_t k = 0; k < count; ++k)
        residual -= parts[k].power * wave.at(time - parts[k].arrival, blends[k]).value;
      if (residual > greatest.power) greatest = {residual, time, 0, true};
    }
    return greatest;
  }

 private:
  static constexpr std::size_t parameters_max = 3 * most + 1;

  struct Equations {
    std::array<std::array<double, parameters_max>, parameters_max> matrix{};
    std::array<double, parameters_max> right{};
    double squares = 0;
  };

  [[nodiscard]] Equations equations(const SystemWaveform& wave, std::span<const float> y,
                                    double interval) const noexcept {
    Equations e;
    std::array<SystemWaveform::Blend, most> blends{};
    for (std::size_t k = 0; k < count; ++k) blends[k] = wave.blend(parts[k].added);
    std::array<double, parameters_max> slopes{};
    slopes[3 * count] = 1;
    for (std::size_t i = 0; i < y.size(); ++i) {
      double residual = static_cast<double>(y[i]) - constant;
      for (std::size_t k = 0; k < count; ++k) {
        const Part& p = parts[k];
        const auto at = wave.at(static_cast<double>(i) * interval - (p.arrival - start), blends[k]);
        residual -= p.power * at.value;
        slopes[3 * k] = at.value;
        slopes[3 * k + 1] = -p.power * at.by_time;
        slopes[3 * k + 2] = p.flat ? 0 : p.power * at.by_variance;
      }
      e.squares += residual * residual;
      for (std::size_t a = 0; a <= 3 * count; ++a) {
        e.right[a] += slopes[a] * residual;
        for (std::size_t b = 0; b <= a; ++b) e.matrix[a][b] += slopes[a] * slopes[b];
      }
    }
    for (std::size_t k = 0; k < count; ++k)
      if (parts[k].flat) e.matrix[3 * k + 2][3 * k + 2] = 1;
    return e;
  }

  /// Takes the step of the damped normal equations, by Cholesky's decomposition; false if singular.
  [[nodiscard]] bool step(const SystemWaveform& wave, Equations e, double damping) noexcept {
    const std::size_t n = 3 * count + 1;
    auto& [matrix, right, squares_here] = e;
    for (std::size_t a = 0; a < n; ++a) matrix[a][a] *= 1 + damping;
    for (std::size_t a = 0; a < n; ++a)
      for (std::size_t b = 0; b <= a; ++b) {
        double sum = matrix[a][b];
        for (std::size_t k = 0; k < b; ++k) sum -= matrix[a][k] * matrix[b][k];
        if (a == b && !(sum > 0)) return false;
        matrix[a][b] = a == b ? std::sqrt(sum) : sum / matrix[b][b];
      }
    for (std::size_t a = 0; a < n; ++a) {
      for (std::size_t k = 0; k < a; ++k) right[a] -= matrix[a][k] * right[k];
      right[a] /= matrix[a][a];
    }
    for (std::size_t a = n; a-- > 0;) {
      for (std::size_t k = a + 1; k < n; ++k) right[a] -= matrix[k][a] * right[k];
      right[a] /= matrix[a][a];
    }
    for (std::size_t k = 0; k < count; ++k) {
      parts[k].power += right[3 * k];
      parts[k].arrival += right[3 * k + 1];
      parts[k].added = std::clamp(parts[k].added + right[3 * k + 2], wave.least_added(), wave.most_added());
    }
    constant += right[3 * count];
    return std::isfinite(constant);
  }
};

}  // namespace PULSECAST_NAMESPACE::detail

#endif
