// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_DETECTOR_GAUSSIAN_DECOMPOSITION_HPP
#define PULSECAST_DETECTOR_GAUSSIAN_DECOMPOSITION_HPP

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>
#include <utility>

#include <pulsecast/base/require.hpp>
#include <pulsecast/base/units.hpp>
#include <pulsecast/detector/adaptor.hpp>
#include <pulsecast/detector/by_pulse_length.hpp>

namespace PULSECAST_NAMESPACE {

namespace detail {

/// Sum of up to six Gaussians and a constant, fitted to samples by least squares without weights, as noise of a digitiser is the same for
/// all samples. Source: Levenberg 1944; Marquardt 1963.
class GaussianSum {
 public:
  static constexpr std::size_t most = 6;  ///< Gaussians

  /// One of the Gaussians; times in samples.
  struct Gaussian {
    double height = 0, centre = 0, deviation = 1;
  };

  std::array<Gaussian, most> gaussians{};  ///< estimate, and result
  std::size_t count = 0;                   ///< number of Gaussians
  double constant = 0;                     ///< what is added to all samples

  /// Improves the estimate; false if it does not converge to a sum of positive Gaussians.
  [[nodiscard]] bool fit(std::span<const float> y) noexcept {
    double error = error_of(*this, y), damping = 1e-3;
    for (int step = 0; step < 60; ++step) {
      set_normal_equations(y);
      GaussianSum next = *this;
      if (!next.step(damping)) return false;
      const double then = error_of(next, y);
      if (!(then < error)) {
        if (damping > 1e6) break;
        damping *= 10;
        continue;
      }
      const bool settled = error - then <= 1e-12 * error;
      *this = next;
      error = then;
      damping = std::max(1e-12, 0.1 * damping);
      if (settled) break;
    }
    return std::all_of(gaussians.begin(), gaussians.begin() + static_cast<std::ptrdiff_t>(count), [](const Gaussian& g) {
      return g.height > 0 && std::isfinite(g.centre) && g.deviation > 0 && std::isfinite(g.deviation);
    });
  }

 private:
  static constexpr std::size_t parameters_max = 3 * most + 1;

  [[nodiscard]] std::size_t parameters() const noexcept { return 3 * count + 1; }

  static double error_of(const GaussianSum& sum, std::span<const float> y) noexcept {
    double squares = 0;
    for (std::size_t i = 0; i < y.size(); ++i) {
      double value = sum.constant;
      for (std::size_t k = 0; k < sum.count; ++k) {
        const Gaussian& g = sum.gaussians[k];
        const double u = (static_cast<double>(i) - g.centre) / g.deviation;
        value += g.height * std::exp(-0.5 * u * u);
      }
      squares += (static_cast<double>(y[i]) - value) * (static_cast<double>(y[i]) - value);
    }
    return squares;
  }

  void set_normal_equations(std::span<const float> y) noexcept {
    matrix_ = {};
    right_ = {};
    std::array<double, parameters_max> slopes{};
    for (std::size_t i = 0; i < y.size(); ++i) {
      double value = constant;
      slopes[3 * count] = 1;
      for (std::size_t k = 0; k < count; ++k) {
        const Gaussian& g = gaussians[k];
        const double u = (static_cast<double>(i) - g.centre) / g.deviation, share = std::exp(-0.5 * u * u);
        value += g.height * share;
        slopes[3 * k] = share;
        slopes[3 * k + 1] = g.height * share * u / g.deviation;
        slopes[3 * k + 2] = slopes[3 * k + 1] * u;
      }
      const double residual = static_cast<double>(y[i]) - value;
      for (std::size_t a = 0; a < parameters(); ++a) {
        right_[a] += slopes[a] * residual;
        for (std::size_t b = 0; b <= a; ++b) matrix_[a][b] += slopes[a] * slopes[b];
      }
    }
  }

  /// Solves the damped normal equations by Cholesky's decomposition and takes the step; false if they are singular.
  [[nodiscard]] bool step(double damping) noexcept {
    const std::size_t n = parameters();
    for (std::size_t a = 0; a < n; ++a) matrix_[a][a] *= 1 + damping;
    for (std::size_t a = 0; a < n; ++a)
      for (std::size_t b = 0; b <= a; ++b) {
        double sum = matrix_[a][b];
        for (std::size_t k = 0; k < b; ++k) sum -= matrix_[a][k] * matrix_[b][k];
        if (a == b && !(sum > 0)) return false;
        matrix_[a][b] = a == b ? std::sqrt(sum) : sum / matrix_[b][b];
      }
    for (std::size_t a = 0; a < n; ++a) {
      for (std::size_t k = 0; k < a; ++k) right_[a] -= matrix_[a][k] * right_[k];
      right_[a] /= matrix_[a][a];
    }
    for (std::size_t a = n; a-- > 0;) {
      for (std::size_t k = a + 1; k < n; ++k) right_[a] -= matrix_[k][a] * right_[k];
      right_[a] /= matrix_[a][a];
    }
    for (std::size_t k = 0; k < count; ++k) {
      gaussians[k].height += right_[3 * k];
      gaussians[k].centre += right_[3 * k + 1];
      gaussians[k].deviation = std::fabs(gaussians[k].deviation + right_[3 * k + 2]);
    }
    constant += right_[3 * count];
    return true;
  }

  std::array<std::array<double, parameters_max>, parameters_max> matrix_{};
  std::array<double, parameters_max> right_{};
};

}  // namespace detail

/// Detector that decomposes the waveform of another, which must keep it (`WaveformSettings::record_length`), into Gaussians, one for each
/// of its echoes: overlapping echoes get the ranges, amplitudes and widths that they have alone, exactly so for Gaussian pulses. Ranges are
/// less what a flat target has. Echoes outside of the record, more than six that overlap, and fits that fail keep what the other detector
/// found. Source: Wagner et al. 2006.
template <SamplesWaveforms Inner>
class GaussianDecomposition : public DetectorAdaptor<Inner> {
 public:
  /// Takes the detector inside. @throws SettingError
  explicit GaussianDecomposition(Inner inside) : DetectorAdaptor<Inner>{validated(std::move(inside))} {}

  /// Prepares the detector inside, and finds the place of a flat target. @throws SettingError as that does
  void prepare(const Laser& laser) {
    if constexpr (PreparesForLasers<Inner>) this->inner.prepare(laser);
    if (beyond_.find(laser)) return;
    double beyond = 0;
    auto w = this->workspace(1);
    const Emitter emitter{.laser = laser};
    Reflection one{.range = 0.5 * speed_of_light * 100 * laser.pulse_length, .power = 1};
    const double expected = one.range;
    const Heard heard{emitter, {0, 2 * expected}, {&one, 1}};
    const Detection d = this->inner.detect(heard, w);
    if (d.echoes.size() == 1) {
      decompose(d, laser, d.echoes);
      beyond = d.echoes[0].range - expected;
    }
    beyond_.add(laser, beyond);
  }

  /// Echoes of the detector inside, by the decomposition of its waveform.
  template <class Workspace>
  [[nodiscard]] Detection detect(const Heard& heard, Workspace& w) const noexcept {
    const Detection d = this->inner.detect(heard, w);
    const double* beyond = beyond_.find(heard.emitter.laser);
    const double apart = 2 * speed_of_light * heard.emitter.laser.pulse_length;  // of echoes that do not overlap [m]
    for (std::size_t first = 0, last = 0; first < d.echoes.size(); first = last) {
      last = first + 1;
      while (last < d.echoes.size() && d.echoes[last].range - d.echoes[last - 1].range < apart) ++last;
      if (decompose(d, heard.emitter.laser, d.echoes.subspan(first, last - first)) && beyond)
        for (Echo& echo : d.echoes.subspan(first, last - first)) echo.range -= *beyond;
    }
    std::sort(d.echoes.begin(), d.echoes.end(), [](const Echo& a, const Echo& b) { return a.range < b.range; });
    number_echoes(d.echoes);
    return d;
  }

 private:
  /// Replaces range, amplitude and width of overlapping echoes; false if there is no fit.
  bool decompose(const Detection& d, const Laser& laser, std::span<Echo> echoes) const noexcept {
    if (echoes.empty() || echoes.size() > detail::GaussianSum::most || d.waveform.empty()) return false;
    const double interval = this->inner.sample_interval(), deviation = laser.pulse_length / (interval * std::sqrt(8 * std::numbers::ln2));
    const auto place = [&](double range) { return (2 * range / speed_of_light - d.waveform_start) / interval; };
    const double from = std::max(0.0, std::floor(place(echoes.front().range) - 6 * deviation));
    const double to = std::min(static_cast<double>(d.waveform.size()), std::ceil(place(echoes.back().range) + 6 * deviation));
    if (!(place(echoes.back().range) < to - deviation && place(echoes.front().range) > from + deviation)) return false;
    detail::GaussianSum sum;
    sum.count = echoes.size();
    for (std::size_t k = 0; k < sum.count; ++k) sum.gaussians[k] = {echoes[k].amplitude, place(echoes[k].range) - from, deviation};
    const auto samples = d.waveform.subspan(static_cast<std::size_t>(from), static_cast<std::size_t>(to - from));
    if (!sum.fit(samples)) return false;
    for (std::size_t k = 0; k < sum.count; ++k) {
      const auto& g = sum.gaussians[k];
      echoes[k].range = 0.5 * speed_of_light * (d.waveform_start + (from + g.centre) * interval);
      echoes[k].amplitude = g.height;
      echoes[k].width = g.deviation * interval;
    }
    return true;
  }

  ByPulseLength<double> beyond_;  ///< range of a flat target beyond the true one [m]
};

}  // namespace PULSECAST_NAMESPACE

#endif
