// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_DETECTOR_TIMING_ERRORS_HPP
#define PULSECAST_DETECTOR_TIMING_ERRORS_HPP

#include <pulsecast/concepts.hpp>

namespace PULSECAST_NAMESPACE {

/// Error of the ranges that a detector measures, for light of a plane: a table by amplitude and broadening, from echoes
/// that the detector itself finds. Errors by the place of the pulse between two samples are among its noise.
class TimingErrors {
 public:
  /// Error of an echo.
  struct Error {
    double deviation = 0;  ///< standard deviation of the range [m]
    double bias = 0;       ///< mean of reported minus true range [m]
    bool weak = false;     ///< true if such echoes are lost, or their amplitudes vary by an eighth
    bool beyond = false;   ///< true for a broadening beyond the table
  };

  /// Simulates up to some 25,000 echoes, if the detector has noise. Equal detectors give equal tables.
  template <Detector Detector>
  TimingErrors(const Detector& detector, const Emitter& emitter)
      : unit_(0.5 * speed_of_light * emitter.laser.pulse_length / 2.4) {
    const Trials<Detector> trials(detector, emitter);
    double power = 1e-18;  // far below one photon
    while (power < 1e18 && 2 * trials(power, 0, 16).found < 16) power *= 4;
    const bool noisy = trials.are_noisy(16 * power);
    for (std::size_t k = 0; k < broadenings.size(); ++k)
      for (const int doublings : powers)
        if (noisy || doublings == powers.back())
          rows_[k].push_back(trials(std::ldexp(power, doublings), unit_ * broadenings[k],
                                    !noisy   ? 64
                                    : k == 0 ? 1024
                                             : 384));
  }

  /// Error of an echo of this amplitude [W], from ranges that spread by a standard deviation [m].
  [[nodiscard]] Error of(double amplitude, double spread) const noexcept {
    const double place = spread / unit_;
    std::size_t k = 0;
    while (k + 2 < broadenings.size() && broadenings[k + 1] < place) ++k;
    const double share = std::clamp((place - broadenings[k]) / (broadenings[k + 1] - broadenings[k]), 0.0, 1.0);
    const Error near = at(rows_[k], amplitude);
    if (share == 0) return near;
    const Error far = at(rows_[k + 1], amplitude);
    const auto between = [&](double a, double b) noexcept { return a + share * (b - a); };
    return {between(near.deviation, far.deviation), between(near.bias, far.bias), near.weak || far.weak,
            place > broadenings.back()};
  }

 private:
  static constexpr std::array broadenings{0.0, 0.5, 1.0, 2.0, 4.0};   ///< in deviations of the pulse
  static constexpr std::array powers{0, 2, 4, 6, 8, 12, 16, 20, 24};  ///< in doublings of the least one heard

  /// Echoes of one power and broadening.
  struct Level {
    std::size_t found = 0;  ///< number of echoes
    double amplitude = 0;   ///< mean [W]
    Error error{};
  };
  using Row = std::vector<Level>;

  /// Trials of a detector with a plane at a range of some 30 pulses.
  template <Detector Detector>
  class Trials {
   public:
    Trials(const Detector& detector, const Emitter& emitter)
        : detector_(detector), emitter_(emitter), pulse_(0.5 * speed_of_light * emitter.laser.pulse_length) {
      for (const double nearer : {20.0, 5.0, 1.0})  // farther is ambiguous to some detectors
        if ((*this)(1e18, 0, 16).found < 16) base_ = nearer;
    }

    [[nodiscard]] Level operator()(double power, double broadening, std::size_t trials) const {
      auto w = detector_.workspace(reflections);
      const double reach = 4 * pulse_ + 4 * broadening;
      double sum = 0, squares = 0, height = 0, heights = 0;
      Level level;
      for (std::size_t k = 0; k < trials; ++k) {
        const Echo* const echo = nearest(detect(power, broadening, k, k, w), range_of(k), reach);
        if (!echo) continue;
        const double off = echo->range - range_of(k);
        ++level.found;
        sum += off;
        squares += off * off;
        height += echo->amplitude;
        heights += echo->amplitude * echo->amplitude;
      }
      const double n = static_cast<double>(std::max<std::size_t>(level.found, 1));
      level.amplitude = height / n;
      level.error.bias = sum / n;
      level.error.deviation = std::sqrt(std::max(0.0, squares / n - level.error.bias * level.error.bias));
      const double varied = std::max(0.0, heights / n - level.amplitude * level.amplitude);
      level.error.weak = 200 * level.found < 199 * trials || 64 * varied > level.amplitude * level.amplitude;
      return level;
    }

    /// True if equal light gives different ranges.
    [[nodiscard]] bool are_noisy(double power) const {
      auto w = detector_.workspace(reflections);
      std::optional<double> before;
      for (std::size_t key = 0; key < 16; ++key) {
        const Echo* const echo = nearest(detect(power, 0, 0, key, w), range_of(0), 4 * pulse_);
        if (!echo || before.value_or(echo->range) != echo->range) return true;
        before = echo->range;
      }
      return false;
    }

   private:
    static constexpr std::size_t reflections = 24;

    /// Range of a trial: places between samples follow the multiples of the golden ratio [m].
    [[nodiscard]] double range_of(std::size_t k) const noexcept {
      const double place = static_cast<double>(k) * 0.5 * (std::sqrt(5.0) - 1);
      return base_ + std::min(pulse_, 1.0) * (place - std::floor(place));
    }
    [[nodiscard]] std::span<const Echo> detect(double power, double broadening, std::size_t place, std::size_t key,
                                               auto& w) const noexcept {
      std::array<Reflection, reflections> light;
      const std::size_t count = broadening > 0 ? reflections : 1;
      const double n = static_cast<double>(count);
      for (std::size_t j = 0; j < count; ++j)
        light[j] = {.range = range_of(place) + broadening * normal_quantile((static_cast<double>(j) + 0.5) / n),
                    .power = power / n};
      const double reach = 6 * pulse_ + 6 * broadening, range = range_of(place);
      const RangeGate gate{std::max(0.0, range - reach), range + reach};
      return detector_.detect({emitter_, gate, {light.data(), count}, {.seed = 0, .pulse = key}}, w).echoes;
    }
    [[nodiscard]] static const Echo* nearest(std::span<const Echo> echoes, double range, double reach) noexcept {
      const Echo* best = nullptr;
      for (const Echo& echo : echoes)
        if (const double off = std::fabs(echo.range - range); off < reach) {
          reach = off;
          best = &echo;
        }
      return best;
    }

    const Detector& detector_;
    const Emitter& emitter_;
    double pulse_;               // length [m]
    double base_ = 30 * pulse_;  // range of the trials [m]
  };

  /// Between two levels, powers of the amplitude.
  [[nodiscard]] static Error at(const Row& row, double amplitude) noexcept {
    if (row.size() == 1) return row[0].error;
    std::size_t k = 0;
    while (k + 2 < row.size() && row[k + 1].amplitude < amplitude) ++k;
    const Level &low = row[k], &high = row[k + 1];
    if (!(amplitude > low.amplitude)) return {low.error.deviation, low.error.bias, true, false};
    const double share = std::log(amplitude / low.amplitude) / std::log(high.amplitude / low.amplitude);
    const double deviation = low.error.deviation > 0 && high.error.deviation > 0
                                 ? low.error.deviation * std::pow(high.error.deviation / low.error.deviation, share)
                                 : 0;
    return {deviation, low.error.bias + std::min(share, 1.0) * (high.error.bias - low.error.bias), low.error.weak,
            false};
  }

  double unit_;  // standard deviation of the pulse in range [m]
  std::array<Row, broadenings.size()> rows_{};
};

}  // namespace PULSECAST_NAMESPACE

#endif
