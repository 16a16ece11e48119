// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SHAPE_WAVE_FIELD_HPP
#define PULSECAST_SHAPE_WAVE_FIELD_HPP

#include <pulsecast/base/lanes.hpp>
#include <pulsecast/base/require.hpp>
#include <pulsecast/base/shared_array.hpp>
#include <pulsecast/base/units.hpp>

namespace PULSECAST_NAMESPACE {

/// Angular frequency of waves on deep water of 20 degrees Celsius [rad/s]; `wavenumber` in rad/m.
/// Source: Lamb 1932, Hydrodynamics, article 267; tension: IAPWS R1-76(2014).
[[nodiscard]] inline double wave_frequency(double wavenumber) noexcept {
  constexpr double tension = 72.74e-3 / 998.2;  // per density [m^3/s^2]
  return std::sqrt(wavenumber * (standard_gravity + tension * wavenumber * wavenumber));
}

/// Long-crested sine wave on deep water; its speed follows from its length.
struct SineWave {
  double amplitude = 0;   ///< half of the height from trough to crest [m], from 0 to 100
  double wavelength = 1;  ///< distance between crests [m], from 1 mm to 1000 km
  double toward = 0;      ///< direction that the wave travels to, from east towards north [rad]
  double phase = 0;       ///< at the origin and the start; at 0 the crest is a quarter wavelength ahead [rad]

  void validate() const {
    require_within("SineWave::amplitude", amplitude, 0, 100, "m");
    require_within("SineWave::wavelength", wavelength, 1e-3, 1e6, "m");
    require_angle("SineWave::toward", toward);
    require_angle("SineWave::phase", phase);
  }
};

class WaterSurface;

namespace detail {

inline constexpr std::size_t max_waves = 512;  ///< greatest number of waves of a field
inline constexpr std::size_t wave_group = 16;  ///< waves that are summed before the rest is bounded

/// Sum over waves, in lanes that are the same for every instruction set.
class WaveSum {
 public:
  static constexpr std::size_t count = simd::sum_stride / simd::lane_count;  ///< registers

  void add(std::size_t part, const simd::Doubles& v) noexcept { parts_[part] += v; }
  [[nodiscard]] double total() const noexcept {
    double sum = 0;
    for (const simd::Doubles& part : parts_) simd::add_lanes(sum, part);
    return sum;
  }

 private:
  simd::Doubles parts_[count]{};
};

/// Calls `add(i, part)` for each register of waves from `first` up to `last`, by part of the sum.
[[gnu::always_inline]] inline void each_wave(std::size_t first, std::size_t last, const auto& add) noexcept {
  // unrolled, so that the sums stay in registers
  const auto each_part = [&]<std::size_t... part>(std::size_t i, std::index_sequence<part...>) noexcept {
    (add(i + part * simd::lane_count, part), ...);
  };
  for (std::size_t i = first; i < last; i += simd::sum_stride) each_part(i, std::make_index_sequence<WaveSum::count>());
}

/// Sine and cosine of phases in half turns, below 2^51; errors 2e-16 and 2e-15.
struct WaveSine {
  simd::Doubles sin, cos;

  /// Source: sin(pi r) / r and cos(pi r), as polynomials in r^2 at the Chebyshev nodes of [0, 1/4].
  [[gnu::always_inline]] explicit WaveSine(const simd::Doubles& half_turns) noexcept {
    constexpr double whole = 0x1.8p52;
    const simd::Doubles shifted = half_turns + whole, r = half_turns - (shifted - whole), z = r * r;
    const simd::Ids sign = simd::Ids(shifted) << 63;
    const simd::Doubles s =
        r * simd::detail::polynomial(z, -2.113362735205297e-05, 0.0004659870158043378, -0.0073703643265304155,
                                     0.08214587881631043, -0.599264528825224, 2.5501640398618677, -5.1677127800497855,
                                     3.1415926535897927);
    const simd::Doubles c = simd::detail::polynomial(z, -0.0001004164642205389, 0.0019278700526981333,
                                                     -0.025806531975921563, 0.23533058831317874, -1.3352627661817635,
                                                     4.058712126333295, -4.934802200543686, 0.9999999999999981);
    sin = simd::Doubles(simd::Ids(s) ^ sign);
    cos = simd::Doubles(simd::Ids(c) ^ sign);
  }
};

/// Phases of the waves of a field at a place and a time [half turns].
struct WavePhases {
  alignas(64) std::array<double, max_waves> at;
  [[nodiscard]] simd::Doubles lanes(std::size_t i) const noexcept { return simd::load<simd::Doubles>(at[i]); }
};

class WaveProfile;

}  // namespace detail

/// Waves on a water surface about its mean level: a sum of linear sine waves, in closed form in
/// place and time. Copies share the waves. Places are within 1e9 m of the origin.
class WaveField {
 public:
  static constexpr std::size_t max_size = detail::max_waves;  ///< greatest number of waves

  /// Without waves.
  WaveField() = default;

  /// Of at most `max_size` waves. @throws SettingError for a wave out of range, or too many of them
  explicit WaveField(std::vector<SineWave> waves) {
    require_within("WaveField::waves (number)", waves.size(), 0, max_size);
    for (const SineWave& wave : waves) wave.validate();
    std::erase_if(waves, [](const SineWave& wave) { return wave.amplitude == 0; });
    if (waves.empty()) return;
    const auto is_longer = [](const SineWave& a, const SineWave& b) { return a.wavelength > b.wavelength; };
    std::stable_sort(waves.begin(), waves.end(), is_longer);
    size_ = (waves.size() + detail::wave_group - 1) / detail::wave_group * detail::wave_group;
    std::vector<double> columns(column_count * size_), rest(size_ / detail::wave_group + 1);
    for (std::size_t i = waves.size(); i-- > 0;) {
      const SineWave& wave = waves[i];
      const double half_turns = 2 / wave.wavelength, wavenumber = pi * half_turns;
      const auto column = [&](Column c) -> double& { return columns[c * size_ + i]; };
      column(amplitude) = wave.amplitude;
      column(east) = half_turns * std::cos(wave.toward);
      column(north) = half_turns * std::sin(wave.toward);
      column(frequency) = wave_frequency(wavenumber) / pi;
      column(phase) = wave.phase / pi;
      highest_ += wave.amplitude;
      steepest_ += wave.amplitude * wavenumber;
      rest[i / detail::wave_group] = highest_;
    }
    columns_ = std::move(columns);
    rest_ = std::move(rest);
  }

  [[nodiscard]] bool empty() const noexcept { return size_ == 0; }      ///< true if flat
  [[nodiscard]] double highest() const noexcept { return highest_; }    ///< bound of heights [m]
  [[nodiscard]] double steepest() const noexcept { return steepest_; }  ///< bound of slopes
  [[nodiscard]] std::size_t memory() const noexcept { return columns_.memory() + rest_.memory(); }

  /// Height above the mean level at a place [m east, m north] [m].
  [[nodiscard]] double height(const Vec2& place, const Tick& t) const noexcept {
    detail::WavePhases phases;
    set_phases(place, t, phases);
    detail::WaveSum sum;
    detail::each_wave(0, size_, [&](std::size_t i, std::size_t part) noexcept {
      sum.add(part, lanes(amplitude, i) * detail::WaveSine(phases.lanes(i)).sin);
    });
    return sum.total();
  }

  /// Slope at a place [m east, m north]: derivatives of the height by x and y.
  [[nodiscard]] Vec2 slope(const Vec2& place, const Tick& t) const noexcept {
    detail::WavePhases phases;
    set_phases(place, t, phases);
    detail::WaveSum x, y;
    detail::each_wave(0, size_, [&](std::size_t i, std::size_t part) noexcept {
      const simd::Doubles rise = lanes(amplitude, i) * detail::WaveSine(phases.lanes(i)).cos;
      x.add(part, lanes(east, i) * rise);
      y.add(part, lanes(north, i) * rise);
    });
    return {pi * x.total(), pi * y.total()};
  }

 private:
  friend class detail::WaveProfile;
  friend class WaterSurface;

  /// Amplitude [m], wavenumber [half turns/m], frequency [half turns/s], phase [half turns].
  enum Column : std::size_t { amplitude, east, north, frequency, phase, column_count };

  [[nodiscard]] const double* column(Column c) const noexcept { return columns_.data() + c * size_; }
  [[nodiscard]] simd::Doubles lanes(Column c, std::size_t i) const noexcept {
    return simd::load<simd::Doubles>(column(c)[i]);
  }

  /// Whole turns over whole seconds are removed exactly, as in `Tick::phase`.
  void set_phases(const Vec2& place, const Tick& t, detail::WavePhases& phases) const noexcept {
    const TickLanes tick(t);
    for (std::size_t i = 0; i < size_; i += simd::lane_count) {
      const simd::Doubles speed = lanes(frequency, i), half_turns = speed * tick.second;
      const simd::Doubles lost = detail::product_error(speed, tick.second, half_turns);
      const simd::Doubles left = half_turns - 2.0 * simd::round(simd::Doubles(0.5 * half_turns));
      const simd::Doubles travelled = left + (speed * tick.fraction + lost);
      const simd::Doubles by_place = lanes(east, i) * place.x + lanes(north, i) * place.y;
      simd::store(simd::Doubles(by_place + (lanes(phase, i) - travelled)), phases.at[i]);
    }
  }

  std::size_t size_ = 0;  ///< waves, with idle ones to a whole number of groups
  double highest_ = 0, steepest_ = 0;
  SharedArray<double> columns_;  ///< numbers of the waves, the longest first
  SharedArray<double> rest_;     ///< sums of the amplitudes of each group and all after it [m]
};

namespace detail {

/// Waves along a straight line at one time: heights at place + t direction.
class WaveProfile {
 public:
  /// Sum over some groups of waves, and a bound of the others.
  struct Sample {
    double height, rate;  ///< height [m], and its derivative by t
    double rest;          ///< bound of the height of the waves left out [m]; 0 if there are none
    std::size_t groups;   ///< groups that were summed
  };

  /// Field and phases must outlive the profile.
  WaveProfile(const WaveField& field, const WavePhases& phases, const Vec2& direction) noexcept
      : field_(field), phases_(phases), groups_(field.size_ / wave_group) {
    double steep = 0, curved = 0;
    steepest_[0] = curviest_[0] = 0;
    for (std::size_t g = 0; g < groups_; ++g) {
      WaveSum slopes, curvatures;
      each_wave(g * wave_group, (g + 1) * wave_group, [&](std::size_t i, std::size_t part) noexcept {
        const simd::Doubles east = field.lanes(WaveField::east, i), north = field.lanes(WaveField::north, i);
        const simd::Doubles speed = east * direction.x + north * direction.y;
        const simd::Doubles rise = field.lanes(WaveField::amplitude, i) * speed;
        simd::store(speed, speeds_[i]);
        slopes.add(part, simd::magnitude(rise));
        curvatures.add(part, rise * speed);
      });
      steepest_[g + 1] = steep += pi * slopes.total();
      curviest_[g + 1] = curved += pi * pi * curvatures.total();
    }
  }

  [[nodiscard]] std::size_t groups() const noexcept { return groups_; }
  /// Bounds of |rate| and of |second derivative|, of the first groups.
  [[nodiscard]] double steepest(std::size_t groups) const noexcept { return steepest_[groups]; }
  [[nodiscard]] double curviest(std::size_t groups) const noexcept { return curviest_[groups]; }

  /// Sample at t. Leaves out the shortest waves if their bound is at most `slack`, or a quarter of
  /// the distance of the sum from `z` [m].
  [[nodiscard]] Sample at(double t, double z, double slack) const noexcept {
    WaveSum heights, rates;
    double height = 0;
    std::size_t g = 0;
    while (g < groups_ && field_.rest_[g] > slack && 4 * field_.rest_[g] > std::fabs(z - height)) {
      each_wave(g * wave_group, (g + 1) * wave_group, [&](std::size_t i, std::size_t part) noexcept {
        const simd::Doubles speed = simd::load<simd::Doubles>(speeds_[i]);
        const simd::Doubles size = field_.lanes(WaveField::amplitude, i);
        const WaveSine wave(phases_.lanes(i) + speed * t);
        heights.add(part, size * wave.sin);
        rates.add(part, size * speed * wave.cos);
      });
      height = heights.total();
      ++g;
    }
    return {height, pi * rates.total(), field_.rest_[g], g};
  }

 private:
  const WaveField& field_;
  const WavePhases& phases_;
  std::size_t groups_;
  std::array<double, max_waves / wave_group + 1> steepest_, curviest_;  ///< of the first groups
  alignas(64) std::array<double, max_waves> speeds_;                    ///< of the phases by t [half turns]
};

}  // namespace detail

}  // namespace PULSECAST_NAMESPACE

#endif
