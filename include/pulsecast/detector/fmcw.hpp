// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_DETECTOR_FMCW_HPP
#define PULSECAST_DETECTOR_FMCW_HPP

#include <pulsecast/detector/adaptor.hpp>
#include <pulsecast/detector/detail/pulse_sum.hpp>
#include <pulsecast/detector/echo_timing.hpp>

namespace PULSECAST_NAMESPACE {

/// Settings of a scanner with frequency-modulated continuous waves.
struct FmcwSettings {
  double bandwidth = 1e9;         ///< frequency change in a sweep, from 1e6 to 1e12 [Hz]
  double sweep_time = 10e-6;      ///< duration of a sweep, up or down, from 1e-8 to 1 [s]
  double threshold = 1e-12;       ///< minimum power of an echo, greater than 0 [W]
  double quantum_efficiency = 1;  ///< share of the photons detected, in (0, 1]
  bool shot_noise = false;        ///< of the reference beam: one photon by efficiency in a sweep
  bool speckle = false;           ///< adds fields of random phases, as of rough surfaces
  std::size_t returns_max = 15;   ///< strongest echoes kept, from 1 to 64

  void validate() const {
    require_within("FmcwSettings::bandwidth", bandwidth, 1e6, 1e12, "Hz");
    require_within("FmcwSettings::sweep_time", sweep_time, 1e-8, 1, "s");
    require_positive("FmcwSettings::threshold", threshold, "W");
    require_positive("FmcwSettings::quantum_efficiency", quantum_efficiency, "");
    require_within("FmcwSettings::quantum_efficiency", quantum_efficiency, 0, 1, "");
    require_within("FmcwSettings::returns_max", returns_max, 1, 64, "");
  }

  /// Range that adds one period to the beat in a sweep, c / 2B: closer surfaces are one echo [m].
  [[nodiscard]] double resolution() const noexcept { return 0.5 * speed_of_light / bandwidth; }
  /// Radial velocity that does so: half a wavelength [m] by the duration of a sweep [m/s].
  [[nodiscard]] double velocity_resolution(double wavelength) const noexcept { return 0.5 * wavelength / sweep_time; }
};

/// Detector of a coherent scanner, whose laser sweeps its frequency up and down. The light that
/// returns beats with a share of the light that leaves: delay and Doppler shift add in one sweep,
/// and differ in the other, which gives range and radial velocity. Beats have a sign, as a receiver
/// of both quadratures measures it. The spectrum of each sweep, through a window of Hann, is
/// searched for peaks, which are paired in order of power, and in order of frequency where powers
/// are similar: the latter are wrong if surfaces overtake each other in a spectrum, and flagged as
/// `Echo::ambiguous`. So are pairs of different powers, such as two peaks that are one in the other
/// sweep. Surfaces do not move from one sweep to the next; the range is that in the middle. The
/// peak power is that while it measures. Amplitudes are the mean of both peaks' powers. Continuous
/// returns stand still, and are searched near surfaces only. It needs a target with `SceneQueries`.
/// Source: Amann, Bosch, Lescure, Myllyla & Rioux 2001; Behroozpour, Sandborn, Wu & Boser 2017.
class Fmcw {
 public:
  using refinements = refines<tag::ReadsVelocity>;
  /// @throws SettingError for settings out of range
  explicit Fmcw(FmcwSettings settings = {}) : s_(validated(settings)) {}

  static constexpr bool reads_velocity = true;  ///< as the concept ReadsVelocity describes

  [[nodiscard]] const FmcwSettings& settings() const noexcept { return s_; }

  /// Peak of a spectrum.
  struct Peak {
    double beat = 0;                        ///< frequency [periods in a sweep]
    double power = 0;                       ///< [W]
    const Reflection* strongest = nullptr;  ///< strongest reflection near it
  };

  struct Workspace {
    /// Light of one frequency.
    struct Line {
      double beat = 0;                     ///< [periods in a sweep]
      double power = 0, cos = 1, sin = 0;  ///< power [W], and phase
      const Reflection* from = nullptr;    ///< its reflection
    };
    std::vector<Line> lines;                 ///< lines of a spectrum, in order
    std::array<std::vector<Peak>, 2> peaks;  ///< of the sweeps
    std::vector<Echo> echoes;                ///< of the pulse
  };
  [[nodiscard]] Workspace workspace(std::size_t reflections) const {
    Workspace w;
    w.lines.reserve(reflections);
    for (std::vector<Peak>& peaks : w.peaks) peaks.reserve(s_.returns_max + 1);
    w.echoes.reserve(s_.returns_max);
    return w;
  }

  /// Echoes of all reflections. Noise and phases are drawn from the seed and pulse of `input.key`.
  [[nodiscard]] Detection detect(const DetectorInput& input, Workspace& w) const noexcept {
    const double metres = s_.resolution(), speed = s_.velocity_resolution(input.emitter.laser.wavelength);
    for (std::size_t sweep = 0; sweep < 2; ++sweep) {
      set_lines(input, sweep == 0 ? 1 / speed : -1 / speed, w);
      find_peaks(input, w.lines, noise_of(input, sweep), w.peaks[sweep]);
    }
    const auto& [up, down] = w.peaks;
    const std::size_t pairs = std::min(up.size(), down.size());
    w.echoes.clear();
    for (std::size_t first = 0, last = 0; first < pairs; first = last) {
      const bool sure = pair_next(first, last, noise_of(input, 0).deviation, w.peaks);
      for (std::size_t e = first; e < last; ++e) {
        Echo echo = echo_from(*up[e].strongest, 0.5 * (up[e].beat + down[e].beat) * metres,
                              0.5 * (up[e].power + down[e].power));
        echo.velocity = 0.5 * (up[e].beat - down[e].beat) * speed;
        echo.ambiguous = !sure;
        if (echo.range >= 0) w.echoes.push_back(echo);
      }
    }
    detail::number_by_range(w.echoes);
    return {w.echoes, {}, 0};
  }

 private:
  using Line = Workspace::Line;
  static constexpr double reach = 2;    ///< half the main lobe of the window [periods in a sweep]
  static constexpr double grid = 0.25;  ///< spacing of the spectrum [periods in a sweep]

  /// Noise of a sweep: complex amplitudes of white noise by whole periods in the sweep.
  struct Noise {
    double deviation = 0;  ///< of each component [sqrt(W)]
    RandomKey key{};       ///< of the sweep

    /// Adds that of a frequency through the window, which is smaller than 1e-3 beyond six periods.
    void add(double beat, double& real, double& imaginary) const noexcept {
      if (deviation == 0) return;
      const double nearest = std::round(beat);
      for (int step = -6; step <= 6; ++step) {
        RandomKey of_bin = key;
        of_bin.part = static_cast<std::uint32_t>(static_cast<std::int64_t>(nearest) + step) & 0x3FFFFFU;
        const double weight = deviation * window(beat - nearest - step);
        real += weight * normal(of_bin);
        ++of_bin.subray;
        imaginary += weight * normal(of_bin);
      }
    }
  };

  [[nodiscard]] Noise noise_of(const DetectorInput& input, std::size_t sweep) const noexcept {
    RandomKey key = input.key.with(Purpose::receiver_noise);
    key.subray = static_cast<std::uint32_t>(2 * sweep);
    const double photon = planck_constant * speed_of_light / input.emitter.laser.wavelength;
    return {s_.shot_noise ? std::sqrt(0.5 * photon / (s_.quantum_efficiency * s_.sweep_time)) : 0, key};
  }

  /// A sine's amplitude `x` periods off, through the window of Hann. Source: Harris 1978.
  [[nodiscard]] static double window(double x) noexcept {
    const double square = x * x;
    if (square < 1e-8) return 1;
    if (std::fabs(square - 1) < 1e-6) return 0.5;
    return simd::sincos(pi * x).sin / (pi * x * (1 - square));
  }

  /// Pairs the peaks from `first` on, both in descending order of power, up to `last`, the first of
  /// less power in both sweeps. True if there is one pair, of one power.
  static bool pair_next(std::size_t first, std::size_t& last, double deviation,
                        std::array<std::vector<Peak>, 2>& peaks) noexcept {
    std::vector<Peak>& up = peaks[0];
    std::vector<Peak>& down = peaks[1];
    const std::size_t pairs = std::min(up.size(), down.size());
    const auto amplitude = [](const std::vector<Peak>& of, std::size_t k) {
      return k < of.size() ? std::sqrt(of[k].power) : 0;
    };
    // Powers of a surface differ by side lobes of the window, of -32 dB (source: Harris 1978), and
    // three deviations of a difference of amplitudes. The window passes 1 + 1/4 + 1/4 of the noise.
    const double high = std::max(amplitude(up, first), amplitude(down, first));
    const double alike = 2 * std::pow(10, -32.0 / 20) * high + 3 * std::sqrt(2 * 1.5) * deviation;
    const auto low = [&](std::size_t k) { return std::min(amplitude(up, k), amplitude(down, k)); };
    const auto apart = [&](std::size_t k) {
      return low(k - 1) - std::max(amplitude(up, k), amplitude(down, k)) > alike;
    };
    last = first + 1;
    while (last < pairs && !apart(last)) ++last;
    if (last == first + 1) return apart(last) && high - low(first) <= alike;
    for (std::vector<Peak>& of : peaks) std::ranges::sort(&of[first], &of[first] + (last - first), {}, &Peak::beat);
    return false;
  }

  /// Sets the lines of a sweep, for periods by radial velocity [s/m].
  void set_lines(const DetectorInput& input, double per_velocity, Workspace& w) const noexcept {
    w.lines.clear();
    for (std::size_t i = 0; i < input.reflections.size(); ++i) {
      const Reflection& r = input.reflections[i];
      if (!(r.power > 0)) continue;
      Line line{.beat = r.range / s_.resolution() + r.velocity * per_velocity, .power = r.power, .from = &r};
      if (!(std::fabs(line.beat) < 0x1p40)) continue;  // else it could not be counted
      if (s_.speckle) {
        RandomKey key{input.key.seed, input.key.pulse, static_cast<std::uint32_t>(i), Purpose::speckle};
        const auto phase = simd::sincos(2 * pi * uniform(key));
        line.cos = phase.cos;
        line.sin = phase.sin;
      }
      w.lines.push_back(line);
    }
    std::ranges::sort(w.lines, {}, &Line::beat);
  }

  /// Power of continuous returns by whole periods in the sweep. Their sum through the window has no
  /// ripple, as the square of Hann's window has no higher harmonics than its own.
  struct Haze {
    std::span<const ContinuousReturn> returns;  ///< those that matter
    double resolution;                          ///< of `FmcwSettings` [m]
    RandomKey key;                              ///< of the speckle

    /// Calls `visit(period, power)` for the periods within 8 of a frequency that have power [W].
    void visit_near(double beat, const auto& visit) const noexcept {
      if (returns.empty()) return;
      for (double period = std::ceil(beat - 8); period <= beat + 8; ++period) {
        const double from = (period - 0.5) * resolution, to = (period + 0.5) * resolution;
        double power = 0;
        for (const ContinuousReturn& r : returns) {
          const double begin = std::max(from, r.begin), end = std::min(to, r.end);
          if (!(begin < end)) continue;
          const double middle = (0.5 * (begin + end) - r.begin) / (r.end - r.begin);
          power += (end - begin) * (r.at_begin + middle * (r.at_end - r.at_begin));
        }
        if (power > 0) visit(period, power);
      }
    }
  };

  /// Continuous returns within 9 periods of some frequencies.
  [[nodiscard]] Haze haze_of(const DetectorInput& input, double first, double last) const noexcept {
    std::size_t begin = 0, end = input.continuous.size();
    while (begin < end && input.continuous[begin].end < (first - 9) * s_.resolution()) ++begin;
    while (end > begin && input.continuous[end - 1].begin > (last + 9) * s_.resolution()) --end;
    return {input.continuous.subspan(begin, end - begin), s_.resolution(), input.key.with(Purpose::speckle)};
  }

  /// Power of the spectrum of a sweep at a frequency [W]. Only lines within 8 periods matter.
  [[nodiscard]] double power_at(std::span<const Line> lines, const Haze& haze, const Noise& noise,
                                double beat) const noexcept {
    double real = 0, imaginary = 0, power = 0;
    for (const Line& line : lines) {
      if (std::fabs(line.beat - beat) > 8) continue;
      const double h = window(beat - line.beat);
      if (s_.speckle) {
        const double amplitude = std::sqrt(line.power) * h;
        real += amplitude * line.cos;
        imaginary += amplitude * line.sin;
      } else {
        power += line.power * h * h;
      }
    }
    haze.visit_near(beat, [&](double period, double of_haze) noexcept {
      const double h = window(beat - period);
      if (!s_.speckle) {
        power += of_haze * h * h;
        return;
      }
      RandomKey key = haze.key;  // fields of many drops: normal, and independent of each other
      key.part = static_cast<std::uint32_t>(static_cast<std::int64_t>(period)) & 0x3FFFFFU;
      key.subray = 0x80000000U;
      const double amplitude = std::sqrt(0.5 * of_haze) * h;
      real += amplitude * normal(key);
      ++key.subray;
      imaginary += amplitude * normal(key);
    });
    if (!s_.speckle) real = std::sqrt(power);
    noise.add(beat, real, imaginary);
    return real * real + imaginary * imaginary;
  }

  /// Strongest peaks of a sweep's spectrum near lines, in descending order of power.
  void find_peaks(const DetectorInput& input, std::span<const Line> lines, const Noise& noise,
                  std::vector<Peak>& peaks) const noexcept {
    peaks.clear();
    for (std::size_t first = 0, last = 0; first < lines.size(); first = last) {
      for (last = first + 1; last < lines.size() && lines[last].beat - lines[last - 1].beat < 2 * reach;) ++last;
      const double begin = std::floor((lines[first].beat - reach) / grid),
                   end = std::ceil((lines[last - 1].beat + reach) / grid);
      const Haze haze = haze_of(input, lines[first].beat - reach, lines[last - 1].beat + reach);
      std::array<double, 5> y{};  // the last five powers, about the one that may be a peak
      for (double g = begin; g <= end; ++g) {
        std::shift_left(y.begin(), y.end(), 1);
        y[4] = power_at(lines, haze, noise, g * grid);
        if (g < begin + 4 || !(y[2] >= s_.threshold && y[2] > y[1] && y[2] >= y[3])) continue;
        const detail::Vertex top = detail::vertex(&y[2]);
        keep({(g - 2 + top.offset) * grid, top.height, nullptr}, lines, peaks);
      }
    }
    std::ranges::sort(peaks, std::ranges::greater{}, &Peak::power);
  }

  /// Keeps a peak, with the strongest line in half the window, unless enough are stronger.
  void keep(Peak peak, std::span<const Line> lines, std::vector<Peak>& peaks) const noexcept {
    double strongest = 0;
    for (const Line& line : lines) {
      const double h = window(peak.beat - line.beat), power = line.power * h * h;
      if (!(power > strongest)) continue;
      strongest = power;
      peak.strongest = line.from;
    }
    if (!peak.strongest) return;
    peaks.push_back(peak);
    if (peaks.size() > s_.returns_max) peaks.erase(std::ranges::min_element(peaks, {}, &Peak::power));
  }

  FmcwSettings s_;
};

}  // namespace PULSECAST_NAMESPACE

#endif
