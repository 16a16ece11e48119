// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_DETECTOR_GAUSSIAN_DECOMPOSITION_HPP
#define PULSECAST_DETECTOR_GAUSSIAN_DECOMPOSITION_HPP

#include <pulsecast/detector/detail/system_waveform.hpp>
#include <pulsecast/detector/full_waveform.hpp>

namespace PULSECAST_NAMESPACE {

/// Detector that decomposes the waveform of a `FullWaveform`, which must keep it
/// (`WaveformSettings::record_length`), into waveforms of flat targets after the receiver, each
/// widened by a Gaussian: overlapping echoes get the ranges, amplitudes and widths that they have
/// alone. The next fit is taken if it leaves less than a tenth of the squared residuals: flat
/// targets, then wide ones, then two flat ones, at least a deviation of that waveform apart, for
/// the widest. Widths are those of the wide ones. Echoes outside the record, more than six that
/// overlap, and failed fits are kept as found. Source: Wagner et al. 2006, with the system waveform
/// in place of a Gaussian, as Roncat, Bergauer & Pfeifer 2011.
template <class Inner>
class GaussianDecomposition : public DetectorAdaptor<Inner> {
 public:
  /// @throws SettingError
  explicit GaussianDecomposition(Inner inside) : DetectorAdaptor<Inner>{validated(std::move(inside))} {}

  /// Prepares the detector inside, and samples a flat target. @throws SettingError as that does
  void prepare(const Laser& laser) {
    this->inner.prepare(laser);
    if (this->inner.settings().record_length > 0 && !waves_.find(laser)) waves_.add(laser, wave_of(laser));
  }

  struct Workspace {
    typename Inner::Workspace inner;  ///< of the detector inside
    std::vector<Echo> echoes;         ///< echoes of the current pulse
  };
  [[nodiscard]] Workspace workspace(std::size_t reflections) const {
    Workspace w{this->inner.workspace(reflections), {}};
    w.echoes.reserve(this->inner.settings().returns_max);
    return w;
  }

  [[nodiscard]] Detection detect(const DetectorInput& input, Workspace& w) const noexcept {
    Detection d = this->inner.detect(input, w.inner);
    const auto* wave = waves_.find(input.emitter.laser);
    if (!wave || d.waveform.empty()) return d;
    const double apart = range_at((*wave)->fall() - (*wave)->rise());  // without overlap [m]
    w.echoes.clear();
    for (std::size_t first = 0, last = 0; first < d.echoes.size(); first = last) {
      last = first + 1;
      while (last < d.echoes.size() && d.echoes[last].range - d.echoes[last - 1].range < apart) ++last;
      const std::span<const Echo> group = d.echoes.subspan(first, last - first);
      const std::size_t room = w.echoes.capacity() - w.echoes.size() - (d.echoes.size() - first);
      const Section most{first > 0 ? time_of(d.echoes[first - 1]) + (*wave)->fall() : d.waveform_start,
                         last < d.echoes.size() ? time_of(d.echoes[last]) + (*wave)->rise() : detail::infinity};
      if (!decompose(d, input, group, most, **wave, room > 0, w.echoes))
        w.echoes.insert(w.echoes.end(), group.begin(), group.end());
    }
    detail::number_by_range(w.echoes);
    d.echoes = w.echoes;
    return d;
  }

 private:
  using Sum = detail::WaveformSum;
  static constexpr int widenings = 5;
  static constexpr double better = 0.1;  ///< squared residuals, by those of a simpler fit

  [[nodiscard]] static double time_of(const Echo& echo) noexcept { return 2 * echo.range / speed_of_light; }

  /// Waveform of a flat target, from samples closer than a fortieth of a pulse.
  [[nodiscard]] std::shared_ptr<const detail::SystemWaveform> wave_of(const Laser& laser) const {
    const double interval = this->inner.sample_interval(), fine = laser.pulse_length / 40;
    const auto places = static_cast<std::size_t>(std::ceil(interval / fine));
    const double per_place = interval / static_cast<double>(places);
    const auto stride = static_cast<std::size_t>(std::max(1.0, fine * static_cast<double>(places) / interval));
    std::vector<std::pair<double, double>> samples;
    this->inner.visit_flat_targets(laser, places, [&](std::size_t k, double arrival, const Detection& d) {
      if (k == places || d.echoes.empty()) return;
      for (std::size_t i = 0; i < d.waveform.size(); ++i)
        samples.emplace_back(d.waveform_start - arrival + static_cast<double>(i) * interval,
                             d.waveform[i] / d.echoes[0].amplitude);
    });
    std::sort(samples.begin(), samples.end());
    std::vector<double> flat;
    for (std::size_t i = 0; i < samples.size(); i += stride) flat.push_back(samples[i].second);
    while (flat.size() > 1 && std::fabs(flat.back()) < 1e-7) flat.pop_back();
    const double step = per_place * static_cast<double>(stride);
    return std::make_shared<const detail::SystemWaveform>(std::move(flat), samples.front().first, step);
  }

  /// Samples that some echoes may affect, of a record.
  struct Section {
    double first = 0, last = 0;  ///< times [s]
  };

  /// Appends the parts of overlapping echoes, from a section at most; false if there is no fit.
  bool decompose(const Detection& d, const DetectorInput& input, std::span<const Echo> group, const Section& most,
                 const detail::SystemWaveform& wave, bool may_part, std::vector<Echo>& echoes) const noexcept {
    if (group.size() > Sum::most) return false;
    const double interval = this->inner.sample_interval();
    Sum sum;
    for (const Echo& echo : group) sum.parts[sum.count++] = {echo.amplitude, time_of(echo)};
    std::span<const float> y;
    for (int step = 0; step < widenings; ++step) {  // wider echoes reach further
      Section section{most.last, most.first};
      for (const Sum::Part& p : std::span(sum.parts).first(sum.count)) {
        const double beside = 3 * std::sqrt(std::max(p.added, 0.0));
        section.first = std::max(most.first, std::min(section.first, p.arrival + wave.rise() - beside));
        section.last = std::min(most.last, std::max(section.last, p.arrival + wave.fall() + beside));
      }
      const double from = std::max(0.0, std::floor((section.first - d.waveform_start) / interval) - 1);
      const double to =
          std::min(static_cast<double>(d.waveform.size()), std::ceil((section.last - d.waveform_start) / interval) + 2);
      if (!(to - from > static_cast<double>(y.size()))) break;
      y = d.waveform.subspan(static_cast<std::size_t>(from), static_cast<std::size_t>(to - from));
      sum.start = d.waveform_start + from * interval;
      if (!sum.fit(wave, y, interval)) return false;
    }
    if (y.empty()) return false;
    if (Sum flat = sum.flattened(); flat.fit(wave, y, interval) && !(sum.squares < better * flat.squares)) sum = flat;
    if (may_part) part(sum, wave, y);
    for (std::size_t k = 0; k < sum.count; ++k) {
      const Sum::Part& p = sum.parts[k];
      Echo echo = k < group.size() ? group[k] : Echo{};
      if (sum.count > group.size()) set_labels(echo, input, wave, p.arrival);
      echo.range = range_at(p.arrival);
      echo.amplitude = p.power;
      echo.width = std::sqrt(wave.variance() + p.spread);
      echoes.push_back(echo);
    }
    return true;
  }

  /// Parts the widest part into two flat targets, if these fit better and there are residuals.
  void part(Sum& sum, const detail::SystemWaveform& wave, std::span<const float> y) const noexcept {
    constexpr double none = 1e-3;  // of the peak
    if (sum.count == Sum::most) return;
    std::size_t widest = 0;
    for (std::size_t k = 1; k < sum.count; ++k)
      if (sum.parts[k].spread > sum.parts[widest].spread) widest = k;
    const Sum::Part whole = sum.parts[widest];
    if (!(sum.squares > none * none * whole.power * whole.power * static_cast<double>(y.size()))) return;
    const double interval = this->inner.sample_interval(), aside = std::sqrt(std::max(whole.spread, 0.0));
    const Sum::Part left = sum.greatest_residual(wave, y, interval);
    const std::array<std::array<Sum::Part, 2>, 2> guesses{
        {{{{0.5 * whole.power, whole.arrival - aside, 0, true},
           {0.5 * whole.power, whole.arrival + aside, 0, true}}},  // of its variance
         {{{whole.power, whole.arrival, 0, true}, left}}}};
    Sum best = sum;
    for (const auto& guess : guesses) {
      Sum two = sum;
      two.parts[widest] = guess[0];
      two.parts[two.count++] = guess[1];
      if (two.fit(wave, y, interval) && two.squares < best.squares) best = two;
    }
    const Sum::Part &one = best.parts[widest], &other = best.parts[sum.count];
    if (best.count > sum.count && best.squares < better * sum.squares &&
        std::min(one.power, other.power) >= this->inner.settings().threshold &&
        std::fabs(one.arrival - other.arrival) > std::sqrt(wave.variance()))
      sum = best;
  }

  /// Gives an echo the labels of the reflection that is strongest at a time [s].
  static void set_labels(Echo& echo, const DetectorInput& input, const detail::SystemWaveform& wave,
                         double time) noexcept {
    double strongest = 0;
    const auto flat = wave.blend(0);
    for (const Reflection& r : input.reflections) {
      const double power = r.power * wave.at(time - arrival(r), flat).value;
      if (!(power > strongest)) continue;
      strongest = power;
      echo = echo_from(r, 0, 0);
    }
  }

  ByPulseLength<std::shared_ptr<const detail::SystemWaveform>> waves_;  ///< shared by copies
};

}  // namespace PULSECAST_NAMESPACE

#endif
