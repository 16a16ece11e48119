// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SHAPE_WIND_WAVES_HPP
#define PULSECAST_SHAPE_WIND_WAVES_HPP

#include <pulsecast/base/random.hpp>
#include <pulsecast/shape/wave_field.hpp>

namespace PULSECAST_NAMESPACE {

/// Slopes of a clean sea under wind, of all waves: normally distributed about the level,
/// independent along and across the wind. Source: Cox & Munk 1954, Measurement of the roughness of
/// the sea surface from photographs of the sun's glitter, J. Opt. Soc. Am. 44; observed at 1 to 14
/// m/s. Limits: without the skewness and peakedness of their Gram-Charlier series.
struct SlopeDistribution {
  double along = 0;   ///< variance of the slope upwind and downwind
  double across = 0;  ///< variance of the slope crosswind
  double toward = 0;  ///< direction that the wind blows to, from east towards north [rad]

  /// Of the wind speed at 12.5 m above the mean level [m/s].
  [[nodiscard]] static SlopeDistribution of(double wind_speed, double toward = 0) noexcept {
    return {0.00316 * wind_speed, 0.003 + 0.00192 * wind_speed, toward};
  }

  /// Probability density of a slope, the derivatives of the height; no number without a variance.
  [[nodiscard]] double density(const Vec2& slope) const noexcept {
    const double c = std::cos(toward), s = std::sin(toward);
    const double u = c * slope.x + s * slope.y, v = c * slope.y - s * slope.x;
    return std::exp(-0.5 * (u * u / along + v * v / across)) / (2 * pi * std::sqrt(along * across));
  }
};

/// Waves raised by a steady wind on deep water.
struct WindWaves {
  double wind_speed = 5;            ///< 10 to 12.5 m above the mean level, from 0 (flat) to 30 [m/s]
  double toward = 0;                ///< direction that the wind blows to, from east towards north [rad]
  double fetch = detail::infinity;  ///< from the windward shore, at least 1 [m]
  double shortest = 3e-3;           ///< minimum wavelength, from 2 mm to 0.1 m [m]
  std::size_t components = 96;      ///< sine waves, from 16 to `WaveField::max_size`
  std::uint64_t seed = 0;           ///< of the draws of lengths, directions and phases

  void validate() const {
    require_within("WindWaves::wind_speed", wind_speed, 0, 30, "m/s");
    require_angle("WindWaves::toward", toward);
    require_within("WindWaves::fetch", fetch, 1, detail::infinity, "m");
    require_within("WindWaves::shortest", shortest, 2e-3, 0.1, "m");
    require_within("WindWaves::components (number)", components, 16, WaveField::max_size);
  }
};

namespace detail {

/// Spectrum of wind waves over wavenumbers [rad/m] and directions, down to capillary waves. Source:
/// Elfouhaily, Chapron, Katsaros & Vandemark 1997, A unified directional spectrum for long and
/// short wind-driven waves, J. Geophys. Res. 102; drag coefficient: Wu 1982, J. Geophys. Res. 87.
/// Limits: winds below 0.5 m/s count as 0.5 m/s, inverse wave ages above 5 as 5.
class WindSpectrum {
 public:
  /// Of a wind speed 10 m above the mean level [m/s] and a fetch [m].
  WindSpectrum(double wind_speed, double fetch) noexcept {
    const double wind = std::max(wind_speed, 0.5), scale = standard_gravity / (wind * wind);
    age_ = std::min(0.84 * std::pow(std::tanh(std::pow(scale * fetch / 2.2e4, 0.4)), -0.75), 5.0);
    peak_ = scale * age_ * age_;
    peak_speed_ = wind / age_;
    friction_ = wind * std::sqrt((0.8 + 0.065 * wind) * 1e-3);
    long_ = 6e-3 * std::pow(age_, 0.55);
    const double rough = std::log(friction_ / least_speed);
    short_ = 1e-2 * std::max(0.0, 1 + (friction_ > least_speed ? 3 : 1) * rough);
    overshoot_ = age_ > 1 ? 1.7 + 6 * std::log10(age_) : 1.7;
    width_ = 0.08 * (1 + 4 / (age_ * age_ * age_));
  }

  [[nodiscard]] double peak() const noexcept { return peak_; }  ///< of the highest waves [rad/m]

  /// Variance of the slope per logarithm of the wavenumber [rad/m]; by k^2, of the height [m^2].
  [[nodiscard]] double curvature(double k) const noexcept {
    const double root = std::sqrt(k / peak_) - 1, speed = phase_speed(k), ratio = peak_ / k;
    const double by_peak = std::exp(-root * root / (2 * width_ * width_));
    const double peaked = std::exp(-1.25 * ratio * ratio) * std::pow(overshoot_, by_peak);
    const double from_long = long_ * peak_speed_ * std::exp(-age_ / std::sqrt(10.0) * root);
    const double capillary = k / least_speed_wavenumber - 1;
    const double from_short = short_ * least_speed * std::exp(-0.25 * capillary * capillary);
    return 0.5 * (from_long + from_short) / speed * peaked;
  }

  /// Coefficient of cos(2 angle) in the distribution of directions about the wind, in [0, 1].
  [[nodiscard]] double spread(double k) const noexcept {
    const double speed = phase_speed(k);
    return std::tanh(0.25 * std::log(2.0) + 4 * std::pow(speed / peak_speed_, 2.5) +
                     0.13 * friction_ / least_speed * std::pow(least_speed / speed, 2.5));
  }

 private:
  static constexpr double least_speed = 0.23;            ///< of waves [m/s]
  static constexpr double least_speed_wavenumber = 370;  ///< of the slowest waves [rad/m]

  [[nodiscard]] static double phase_speed(double k) noexcept {
    const double ratio = k / least_speed_wavenumber;
    return std::sqrt(standard_gravity / k * (1 + ratio * ratio));
  }

  double age_;                ///< inverse wave age: wind speed over that of the highest waves
  double peak_, peak_speed_;  ///< wavenumber [rad/m] and phase speed [m/s] of the highest waves
  double friction_;           ///< friction velocity of the wind [m/s]
  double long_, short_;       ///< equilibrium ranges of long and short waves
  double overshoot_, width_;  ///< height and width of the peak, as in JONSWAP
};

/// Wave of a given vector of slopes, before its phase is drawn.
struct DrawnWave {
  double wavenumber;  ///< [rad/m]
  Vec2 slope;         ///< amplitude times wavenumber, along and across the wind
};

struct SlopeVariance {
  double along = 0, mixed = 0, across = 0;

  void add(const Vec2& slope) noexcept {
    along += 0.5 * slope.x * slope.x;
    mixed += 0.5 * slope.x * slope.y;
    across += 0.5 * slope.y * slope.y;
  }
  [[nodiscard]] friend SlopeVariance operator-(const SlopeVariance& a, const SlopeVariance& b) noexcept {
    return {a.along - b.along, a.mixed - b.mixed, a.across - b.across};
  }
  [[nodiscard]] friend SlopeVariance operator*(double factor, const SlopeVariance& v) noexcept {
    return {factor * v.along, factor * v.mixed, factor * v.across};
  }
  [[nodiscard]] double determinant() const noexcept { return along * across - mixed * mixed; }
  [[nodiscard]] bool positive() const noexcept { return along > 0 && determinant() > 0; }
};

/// Lower triangular matrix that maps slopes of one variance to another, by their Cholesky factors.
class SlopeMap {
 public:
  SlopeMap(const SlopeVariance& from, const SlopeVariance& to) noexcept {
    const double from_side = std::sqrt(from.determinant() / from.along),
                 to_side = std::sqrt(to.determinant() / to.along);
    const double of_from = std::sqrt(from.along), of_to = std::sqrt(to.along);
    along_ = std::sqrt(to.along / from.along);
    across_ = to_side / from_side;
    mixed_ = (to.mixed / of_to - across_ * from.mixed / of_from) / of_from;
  }
  [[nodiscard]] Vec2 operator()(const Vec2& slope) const noexcept {
    return {along_ * slope.x, mixed_ * slope.x + across_ * slope.y};
  }

 private:
  double along_, mixed_, across_;
};

/// Angle to the wind within a quarter turn, distributed as 1 + spread cos(2 angle); `share` < 1.
[[nodiscard]] inline double angle_to_wind(double spread, double share) noexcept {
  double low = -pi / 2, high = pi / 2;
  for (int halving = 0; halving < 50; ++halving) {
    const double middle = 0.5 * (low + high);
    (middle + 0.5 * spread * std::sin(2 * middle) < pi * (share - 0.5) ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// Draws waves of a spectrum: in each interval of wavenumber one with its variances of height and
/// slope, drawn in direction. Intervals have equal sums, half heights, half slopes; drawn ends.
[[nodiscard]] inline std::vector<DrawnWave> draw_waves(const WindWaves& settings, const WindSpectrum& spectrum) {
  constexpr std::size_t cells = 1 << 14;
  const double first = std::log(0.25 * spectrum.peak());
  const double step = (std::log(2 * pi / settings.shortest) - first) / cells;
  std::vector<double> slopes(cells), heights(cells);
  double slope = 0, height = 0;
  for (std::size_t n = 0; n < cells; ++n) {
    const double k = std::exp(first + step * (static_cast<double>(n) + 0.5));
    slope += slopes[n] = step * spectrum.curvature(k);
    height += heights[n] = slopes[n] / (k * k);
  }
  std::vector<DrawnWave> waves;
  double sum = 0, slope_here = 0, height_here = 0;
  std::size_t n = 0;
  for (std::size_t i = 0; i < settings.components; ++i) {
    const double drawn = static_cast<double>(i) + 0.5 + uniform({settings.seed, i, 1});
    const double end = i + 1 < settings.components ? drawn / static_cast<double>(settings.components) : 2;
    slope_here = height_here = 0;
    for (; n < cells && sum < end; ++n) {
      slope_here += slopes[n];
      height_here += heights[n];
      sum += 0.5 * (slopes[n] / slope + heights[n] / height);
    }
    if (!(slope_here > 0)) continue;
    const double k = std::sqrt(slope_here / height_here),
                 angle = angle_to_wind(spectrum.spread(k), uniform({settings.seed, i, 2}));
    waves.push_back({k, std::sqrt(2 * slope_here) * Vec2{std::cos(angle), std::sin(angle)}});
  }
  return waves;
}

}  // namespace detail

/// Sine waves drawn for a wind: heights of the `WindSpectrum`, and slopes with exactly the
/// variances of the `SlopeDistribution`, uncorrelated. To that end slopes of waves shorter than a
/// tenth of those at the peak are mapped; of all where that would leave them less than a quarter of
/// their variance, as in winds below some 2 m/s. @throws SettingError as `WindWaves::validate`
[[nodiscard]] inline std::vector<SineWave> waves_of(const WindWaves& settings) {
  settings.validate();
  if (settings.wind_speed == 0) return {};
  const detail::WindSpectrum spectrum(settings.wind_speed, settings.fetch);
  const SlopeDistribution wanted = SlopeDistribution::of(settings.wind_speed);
  std::vector<detail::DrawnWave> waves = detail::draw_waves(settings, spectrum);
  detail::SlopeVariance of_all, of_short;
  const double limit = 10 * spectrum.peak();
  for (const detail::DrawnWave& wave : waves) {
    of_all.add(wave.slope);
    if (wave.wavenumber > limit) of_short.add(wave.slope);
  }
  const detail::SlopeVariance all{wanted.along, 0, wanted.across}, left = all - (of_all - of_short);
  const bool room = of_short.positive() && (left - 0.25 * of_short).positive();
  const detail::SlopeMap map = room ? detail::SlopeMap(of_short, left) : detail::SlopeMap(of_all, all);
  std::vector<SineWave> drawn;
  for (std::size_t i = 0; i < waves.size(); ++i) {
    const detail::DrawnWave& wave = waves[i];
    const Vec2 slope = room && wave.wavenumber <= limit ? wave.slope : map(wave.slope);
    const double toward = std::remainder(settings.toward + std::atan2(slope.y, slope.x), 2 * pi);
    const double phase = 2 * pi * uniform({settings.seed, i, 3});
    drawn.push_back({length(slope) / wave.wavenumber, 2 * pi / wave.wavenumber, toward, phase});
  }
  return drawn;
}

}  // namespace PULSECAST_NAMESPACE

#endif
