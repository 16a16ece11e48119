// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_DETECTOR_SHAPE_DEVIATION_HPP
#define PULSECAST_DETECTOR_SHAPE_DEVIATION_HPP

#include <pulsecast/detector/full_waveform.hpp>

namespace PULSECAST_NAMESPACE {

/// Waveform detector that adds each echo's deviation from the shape of a flat target,
/// `Echo::shape_deviation`: the mean over the samples within a pulse length, in thousandths of the
/// echo's maximum. Slopes, edges and leaves have more. The detector inside keeps waveforms
/// (`record_length`); echoes beyond have none. Source: Pfennigbauer & Ullrich 2010, SPIE 7684.
template <class Inner>
class ShapeDeviation : public DetectorAdaptor<Inner> {
 public:
  /// Takes a `FullWaveform`. @throws SettingError if it keeps no waveforms
  explicit ShapeDeviation(Inner inside) : DetectorAdaptor<Inner>{std::move(inside)} {
    require_positive("WaveformSettings::record_length", this->inner.settings().record_length, "s");
  }

  /// Samples the shape of a flat target. @throws SettingError as the detector inside
  void prepare(const Laser& laser) {
    this->inner.prepare(laser);
    if (!shapes_.find(laser)) shapes_.add(laser, shape_of(laser));
  }

  [[nodiscard]] Detection detect(const DetectorInput& input, auto& w) const noexcept {
    const Detection d = this->inner.detect(input, w);
    if (const std::vector<double>* shape = shapes_.find(input.emitter.laser))
      for (Echo& echo : d.echoes)
        echo.shape_deviation = static_cast<float>(deviation(d, echo, input.emitter.laser.pulse_length, *shape));
    return d;
  }

 private:
  static constexpr std::size_t places = 32;  ///< samples of a shape for each of the digitiser's

  [[nodiscard]] double interval() const noexcept { return this->inner.settings().sample_interval; }

  /// Waveform of a flat target from a pulse length before its range to one after, by its amplitude.
  [[nodiscard]] std::vector<double> shape_of(const Laser& laser) const {
    const auto reach = static_cast<std::size_t>(std::ceil(laser.pulse_length / interval())) + 1;
    std::vector<double> shape(2 * reach * places + 1);
    this->inner.visit_flat_targets(laser, places, [&](std::size_t k, double arrival, const Detection& d) {
      if (k == places || d.echoes.empty()) return;
      for (std::size_t i = 0; i < shape.size(); ++i) {
        // sample i of the shape is `place` digitised samples after the arrival
        const double place = static_cast<double>(i) / places - static_cast<double>(reach);
        const double sample = (arrival - d.waveform_start) / interval() + place;
        if (std::fabs(sample - std::round(sample)) > 0.25 / places) continue;
        shape[i] = at(d.waveform, std::lround(sample)) / d.echoes[0].amplitude;
      }
    });
    return shape;
  }

  [[nodiscard]] static double at(std::span<const float> samples, long i) noexcept {
    return i >= 0 && i < static_cast<long>(samples.size()) ? static_cast<double>(samples[static_cast<std::size_t>(i)])
                                                           : 0;
  }

  [[nodiscard]] double deviation(const Detection& d, const Echo& echo, double pulse_length,
                                 const std::vector<double>& shape) const noexcept {
    const double reach = 0.5 * static_cast<double>(shape.size() - 1) / places;  // [samples]
    const double centre = (2 * echo.range / speed_of_light - d.waveform_start) / interval(),
                 half = pulse_length / interval();
    if (!(centre + half < static_cast<double>(d.waveform.size()))) return std::numeric_limits<double>::quiet_NaN();
    double sum = 0, samples = 0;
    for (double i = std::ceil(centre - half); i <= centre + half; ++i, ++samples) {
      const double place = (i - centre + reach) * places;
      const auto k = std::min(static_cast<std::size_t>(place), shape.size() - 2);
      const double expected = shape[k] + (place - static_cast<double>(k)) * (shape[k + 1] - shape[k]);
      sum += std::fabs(at(d.waveform, std::lround(i)) / echo.amplitude - expected);
    }
    return 1000 * sum / samples;
  }

  ByPulseLength<std::vector<double>> shapes_;
};

}  // namespace PULSECAST_NAMESPACE

#endif
