// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_DETECTOR_GAUSSIAN_FIT_HPP
#define PULSECAST_DETECTOR_GAUSSIAN_FIT_HPP

#include <pulsecast/concepts.hpp>

namespace PULSECAST_NAMESPACE {

/// Gaussian amplitude exp(-(i - position)^2 / (2 width^2)) over sample indices i.
struct Gaussian {
  double amplitude = 0;  ///< peak value, in the unit of the samples
  double position = 0;   ///< [samples]
  double width = 0;      ///< standard deviation [samples]
};

/// Echo width by a least-squares Gaussian (Levenberg-Marquardt). NaN without convergence.
///
/// Each sample is weighted by its own power, so that the Gaussian matches the echo, not the tail
/// that a Gaussian lacks. The places of samples on a steep edge change widths by less than 0.5 %.
/// Source: Levenberg 1944, Marquardt 1963, damping by the scaled diagonal of the normal equations.
struct GaussianFit {
  using refinements = refines<tag::TruncatedWidthMeasure, tag::Validated>;
  int iterations_max = 50;  ///< iteration limit, from 1 to 1000
  double share = 0.03;      ///< of the highest sample, in [0, 1): lower ones end the fit

  void validate() const {
    require_within("GaussianFit::iterations_max", iterations_max, 1, 1000, "");
    if (!(share >= 0 && share < 1)) throw SettingError("GaussianFit::share", share, "", "at least 0 and less than 1");
  }

  [[nodiscard]] double min_share() const noexcept { return share; }

  /// Outcome of a fit.
  struct Result {
    Gaussian gaussian{};     ///< last iterate
    int iterations = 0;      ///< iterations done
    bool converged = false;  ///< true for a Gaussian no wider than the samples, and near them
  };

  [[nodiscard]] double width(std::span<const double> samples, double interval) const noexcept {
    const Result r = fit(samples);
    return r.converged ? r.gaussian.width * interval : std::numeric_limits<double>::quiet_NaN();
  }

  /// Fits a Gaussian to samples of power, at unit distance.
  [[nodiscard]] Result fit(std::span<const double> all) const noexcept {
    if (all.empty()) return {};
    const auto top = static_cast<std::size_t>(std::max_element(all.begin(), all.end()) - all.begin());
    const double least = share * all[top];
    if (!(all[top] > 0)) return {};
    std::size_t from = top, to = top;
    while (from > 0 && all[from - 1] >= least) --from;
    while (to + 1 < all.size() && all[to + 1] >= least) ++to;
    if (to - from < 2) return {};
    const std::span<const double> samples = all.subspan(from, to - from + 1);

    // initial guess: the squares of a Gaussian are one at its position, narrower by the root of two
    double sum = 0, first = 0, second = 0, x = 0;
    for (const double y : samples) {
      const double square = y * y;
      sum += square;
      first += square * x;
      second += square * x * x;
      ++x;
    }
    const double position = first / sum;
    Result r;
    r.gaussian = {all[top], position, std::sqrt(2 * std::fmax(second / sum - position * position, 0.1))};
    Equations e = equations(samples, r.gaussian);
    double damping = 1e-3;
    while (r.iterations < iterations_max && !r.converged) {
      ++r.iterations;
      const Gaussian step = solution(e, damping);
      const Gaussian next{r.gaussian.amplitude + step.amplitude, r.gaussian.position + step.position,
                          r.gaussian.width + step.width};
      const double size = std::fmax(std::fabs(step.amplitude / r.gaussian.amplitude),
                                    std::fmax(std::fabs(step.position), std::fabs(step.width)) / r.gaussian.width);
      const bool possible = next.amplitude > 0 && next.width > 0.1 && std::isfinite(size);
      const Equations there = possible ? equations(samples, next) : Equations{};
      if (possible && there.squares <= e.squares) {
        r.gaussian = next;
        e = there;
        damping *= 0.1;
        r.converged = size < small_enough;
      } else if (possible && size < small_enough) {
        r.converged = true;  // at the minimum within rounding
      } else {
        damping *= 10;
      }
    }
    const Gaussian& g = r.gaussian;
    const auto size = static_cast<double>(samples.size());
    r.converged = r.converged && g.width <= size && g.position >= -g.width && g.position <= size - 1 + g.width;
    r.gaussian.position += static_cast<double>(from);
    return r;
  }

 private:
  static constexpr double small_enough = 1e-3;  ///< last step, by amplitude and width

  /// Normal equations at a Gaussian: products of derivatives, and with residuals; their squares.
  struct Equations {
    double aa = 0, ap = 0, aw = 0, pp = 0, pw = 0, ww = 0;
    double a = 0, p = 0, w = 0;
    double squares = 0;
  };

  static Equations equations(std::span<const double> samples, const Gaussian& g) noexcept {
    // exp(-x^2/2) at every sum_stride-th sample, by ratios that fall by a constant
    const double h = 1 / g.width, step = simd::sum_stride * h, decay = exponential(-step * step);
    // derivatives are value, value x k and value x^2 k, with k = amplitude / width
    std::array<double, 9> sums{};
    for (std::size_t part = 0; part < simd::sum_stride; part += simd::lane_count) {
      simd::Doubles x =
          (simd::generate([&](std::size_t lane) { return static_cast<double>(part + lane); }) - g.position) * h;
      const simd::Doubles growth = -step * (x + 0.5 * step),
                          none = simd::Doubles{} + std::numeric_limits<double>::infinity();
      simd::Doubles value = exponential(simd::Doubles(-0.5 * x * x)), ratio = growth < 700 ? exponential(growth) : none;
      simd::Doubles s0{}, s1{}, s2{}, s3{}, s4{}, r0{}, r1{}, r2{}, squares{};
      for (std::size_t i = part; i < samples.size(); i += simd::sum_stride) {
        simd::Doubles y{};
        if (i + simd::lane_count <= samples.size())
          simd::fill(y, samples[i]);
        else
          for (std::size_t k = i; k < samples.size(); ++k) y[k - i] = samples[k];
        const simd::Doubles residual = y - g.amplitude * value, weighted = y * value, xx = x * x;
        const simd::Doubles s = weighted * value, r = weighted * residual, sx = s * x, sxx = s * xx;
        s0 += s;
        s1 += sx;
        s2 += sxx;
        s3 += sx * xx;
        s4 += sxx * xx;
        r0 += r;
        r1 += r * x;
        r2 += r * xx;
        squares += y * residual * residual;
        x += step;
        value *= ratio;
        ratio *= decay;
      }
      std::size_t k = 0;
      for (const simd::Doubles* v : {&s0, &s1, &s2, &s3, &s4, &r0, &r1, &r2, &squares}) simd::add_lanes(sums[k++], *v);
    }
    const double k = g.amplitude * h;
    const auto& [s0, s1, s2, s3, s4, r0, r1, r2, squares] = sums;
    return {s0, s1 * k, s2 * k, s2 * k * k, s3 * k * k, s4 * k * k, r0, r1 * k, r2 * k, squares};
  }

  /// Step of the damped normal equations, by Cholesky decomposition; not finite if singular.
  static Gaussian solution(const Equations& e, double damping) noexcept {
    const double stretch = 1 + damping;
    const double l11 = std::sqrt(e.aa * stretch), l21 = e.ap / l11, l31 = e.aw / l11;
    const double l22 = std::sqrt(e.pp * stretch - l21 * l21), l32 = (e.pw - l31 * l21) / l22;
    const double l33 = std::sqrt(e.ww * stretch - l31 * l31 - l32 * l32);
    const double z1 = e.a / l11, z2 = (e.p - l21 * z1) / l22, z3 = (e.w - l31 * z1 - l32 * z2) / l33;
    const double w = z3 / l33, p = (z2 - l32 * w) / l22;
    return {(z1 - l21 * p - l31 * w) / l11, p, w};
  }
};

}  // namespace PULSECAST_NAMESPACE

#endif
