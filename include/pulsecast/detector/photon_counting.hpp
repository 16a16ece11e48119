// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_DETECTOR_PHOTON_COUNTING_HPP
#define PULSECAST_DETECTOR_PHOTON_COUNTING_HPP

#include <pulsecast/detector/adaptor.hpp>
#include <pulsecast/detector/detail/by_pulse_length.hpp>
#include <pulsecast/detector/detail/peaks.hpp>
#include <pulsecast/detector/pulse_form.hpp>

namespace PULSECAST_NAMESPACE {

/// Settings of a receiver that counts photons: avalanche diodes, linear or Geiger mode.
struct PhotonCountingSettings {
  double efficiency = 0.3;                        ///< detections per photon, in (0, 1]
  double dark_rate = 0;                           ///< dark counts of all pixels together, at most 1e12 [1/s]
  double background = 0;                          ///< received sunlight [W]
  std::size_t pixels = 1;                         ///< detectors that share the light evenly, at most 4096
  double dead_time = 20e-9;                       ///< after a detection; infinite: one a shot, Geiger mode [s]
  double afterpulse = 0;                          ///< probability of another detection after the dead time, below 1
  double afterpulse_time = 1e-8;                  ///< mean delay of that [s]
  double jitter = 0;                              ///< deviation of a detection's time [s]
  std::size_t shots = 1;                          ///< pulses for one histogram, at most 10,000
  double bin = 1e-9;                              ///< width of the bins [s]
  std::size_t threshold = 1;                      ///< minimum count of a peak of the histogram
  std::size_t returns_max = 15;                   ///< echoes kept, in order of range; from 1 to 255
  KeptReturns returns_kept = KeptReturns::first;  ///< which ones, of more

  void validate() const {
    require_positive("PhotonCountingSettings::efficiency", efficiency, "");
    require_within("PhotonCountingSettings::efficiency", efficiency, 0, 1, "");
    require_within("PhotonCountingSettings::dark_rate", dark_rate, 0, 1e12, "1/s");
    require_within("PhotonCountingSettings::background", background, 0, 1, "W");
    require_within("PhotonCountingSettings::pixels", pixels, 1, 4096, "");
    require_within("PhotonCountingSettings::dead_time", dead_time, 0, std::numeric_limits<double>::infinity(), "s");
    require_within("PhotonCountingSettings::afterpulse", afterpulse, 0, 0.99, "");
    require_not_negative("PhotonCountingSettings::afterpulse_time", afterpulse_time, "s");
    require_not_negative("PhotonCountingSettings::jitter", jitter, "s");
    require_within("PhotonCountingSettings::shots", shots, 1, 1e4, "");
    require_within("PhotonCountingSettings::bin", bin, 1e-13, 1e-3, "s");
    require_within("PhotonCountingSettings::threshold", threshold, 1, 1e6, "");
    require_within("PhotonCountingSettings::returns_max", returns_max, 1, 255, "");
  }
};

/// Detector that draws single photons. Photoelectrons of each reflection, of continuous returns, of
/// sunlight and of dark counts are Poisson processes. All detections make a histogram; each of its
/// peaks is an echo at the mean time of the detections in the bin and its neighbours. The energy of
/// a reflection is its power times the full width at half maximum, as in `EnergyLedger`: 8 % less
/// than in the gamma pulse. The amplitude is the power that would give as many counts without dead
/// time. With one shot and a threshold of 1, isolated detections are echoes. Nothing is detected
/// outside the gate, nor noise after the last reflection if it has no end.
///
/// At most 65,536 detections of a pulse are kept. Source: Gatt, Johnson & Nichols 2009.
template <PulseForm Form = GammaPulse>
class PhotonCounting {
 public:
  using refinements = refines<tag::RunsWithoutReflections, tag::PreparesForLasers>;
  /// @throws SettingError for settings out of range
  explicit PhotonCounting(PhotonCountingSettings settings = {}, Form form = {})
      : s_(validated(settings)), form_(std::move(form)) {}

  [[nodiscard]] const PhotonCountingSettings& settings() const noexcept { return s_; }

  static constexpr bool runs_without_reflections = true;  ///< for sunlight and dark counts

  /// Computes the distribution of photons over a laser's pulse, before the first of them.
  void prepare(const Laser& laser) {
    if (!quantiles_.find(laser)) quantiles_.add(laser, quantiles(laser));
  }

  /// Detection of a photoelectron.
  struct Count {
    double time;          ///< since the laser's pulse [s]
    std::uint32_t pixel;  ///< number of the pixel
    std::uint32_t label;  ///< index in reflections, then continuous returns, or `none`
  };
  struct Workspace {
    std::vector<Count> shot;    ///< photoelectrons of a shot
    std::vector<Count> counts;  ///< detections of all shots
    std::vector<double> blind;  ///< end of the dead time of each pixel [s]
    std::vector<Echo> echoes;   ///< echoes of the current pulse
  };
  [[nodiscard]] Workspace workspace(std::size_t) const {
    Workspace w{{}, {}, std::vector<double>(s_.pixels), {}};
    w.shot.reserve(counts_max);
    w.counts.reserve(counts_max);
    w.echoes.reserve(s_.returns_max);
    return w;
  }

  /// Echoes of pulses of a prepared laser. Photons are drawn by `input.key`.
  [[nodiscard]] Detection detect(const DetectorInput& input, Workspace& w) const noexcept {
    const std::vector<double>* quantiles = quantiles_.find(input.emitter.laser);
    PULSECAST_ASSERT(quantiles != nullptr);
    w.counts.clear();
    w.echoes.clear();
    Draws draws{input.key.with(Purpose::receiver_noise)};
    for (std::size_t shot = 0; shot < s_.shots; ++shot) {
      w.shot.clear();
      draw_photoelectrons(input, *quantiles, draws, w.shot);
      keep_detections(input.gate, draws, w);
    }
    std::ranges::sort(w.counts, {}, &Count::time);
    find_echoes(input, w);
    number_echoes(w.echoes);
    return {w.echoes, {}, 0};
  }

 private:
  static constexpr std::size_t counts_max = 65'536;
  static constexpr std::uint32_t none = 0xffffffff;
  static constexpr std::size_t quantile_count = 4096;

  /// Random numbers of a pulse, one after the other.
  struct Draws {
    RandomKey key;
    double uniform() noexcept {
      if (++key.subray == 0) ++key.part;
      return pulsecast::uniform(key);
    }
    double exponential() noexcept { return -std::log(uniform()); }
  };

  /// Times about the mean of a pulse before which evenly spaced shares of its photons are sent [s].
  [[nodiscard]] std::vector<double> quantiles(const Laser& laser) const {
    const double length = laser.pulse_length, begin = form_.begin(length), end = form_.end(length);
    constexpr std::size_t steps = 1 << 16;
    const double step = (end - begin) / steps;
    std::vector<double> sums(steps + 1);
    for (std::size_t i = 0; i < steps; ++i)
      sums[i + 1] = sums[i] + form_.power(begin + (static_cast<double>(i) + 0.5) * step, length);
    std::vector<double> times(quantile_count + 1);
    std::size_t i = 0;
    for (std::size_t q = 0; q <= quantile_count; ++q) {
      const double share = sums.back() * static_cast<double>(q) / quantile_count;
      while (i + 1 < steps && sums[i + 1] < share) ++i;
      const double within = sums[i + 1] > sums[i] ? (share - sums[i]) / (sums[i + 1] - sums[i]) : 0;
      times[q] = begin + (static_cast<double>(i) + std::clamp(within, 0.0, 1.0)) * step;
    }
    double mean = 0;
    for (std::size_t q = 0; q < quantile_count; ++q) mean += 0.5 * (times[q] + times[q + 1]) / quantile_count;
    for (double& time : times) time -= mean;
    return times;
  }

  /// Energy of a photoelectron's share of the light [J].
  [[nodiscard]] double energy_per_count(const Laser& laser) const noexcept {
    return planck_constant * speed_of_light / (laser.wavelength * s_.efficiency);
  }

  /// Draws the photoelectrons of a shot, in order of time.
  void draw_photoelectrons(const DetectorInput& input, const std::vector<double>& quantiles, Draws& draws,
                           std::vector<Count>& shot) const noexcept {
    const Laser& laser = input.emitter.laser;
    const double per_watt = laser.pulse_length / energy_per_count(laser);
    double last = 0;
    const auto enter = [&](double time, std::size_t label) {
      const auto pixel = static_cast<std::uint32_t>(draws.uniform() * static_cast<double>(s_.pixels));
      if (shot.size() < counts_max) shot.push_back({time, pixel, static_cast<std::uint32_t>(label)});
    };
    const auto spread = [&] {  // time of a photon about the mean of its pulse
      const double place = draws.uniform() * quantile_count;
      const auto q = std::min(static_cast<std::size_t>(place), quantile_count - 1);
      return quantiles[q] + (place - static_cast<double>(q)) * (quantiles[q + 1] - quantiles[q]);
    };
    for (std::size_t r = 0; r < input.reflections.size(); ++r) {
      const double mean = input.reflections[r].power * per_watt, at = arrival(input.reflections[r]);
      last = std::max(last, at + quantiles.back());
      for (double gone = draws.exponential(); gone < mean && shot.size() < counts_max; gone += draws.exponential())
        enter(at + spread(), r);
    }
    const auto enter_continuous = [&](double at, std::size_t label) {
      last = std::max(last, at + quantiles.back());
      enter(at + spread(), label);
      return shot.size() < counts_max;
    };
    draw_continuous(input, per_watt, enter_continuous, draws);
    const double rate = s_.dark_rate + s_.background / energy_per_count(laser);
    const double begin = 2 * input.gate.near / speed_of_light, end = 2 * input.gate.far / speed_of_light;
    if (rate > 0)
      for (double t = begin + draws.exponential() / rate;
           t < (std::isfinite(end) ? end : last) && shot.size() < counts_max; t += draws.exponential() / rate)
        enter(t, none);
    std::ranges::sort(shot, {}, &Count::time);
  }

  /// Calls `enter(arrival, label)`, while that is true, for the photons of continuous returns in a
  /// shot: one Poisson process along all, placed by the quantile of the density.
  static void draw_continuous(const DetectorInput& input, double per_watt, const auto& enter, Draws& draws) noexcept {
    if (input.continuous.empty()) return;
    double next = draws.exponential();
    for (std::size_t k = 0; k < input.continuous.size(); ++k) {
      const ContinuousReturn& r = input.continuous[k];
      const double mean = r.power() * per_watt, a = r.at_begin, b = r.at_end;
      for (; next < mean; next += draws.exponential()) {
        const double share = next / mean, place = share * (a + b) / (a + std::sqrt(a * a + share * (b * b - a * a)));
        if (!enter(2 / speed_of_light * (r.begin + place * (r.end - r.begin)), input.reflections.size() + k)) return;
      }
      next -= mean;
    }
  }

  /// Appends the photoelectrons of a shot that pixels detect, with afterpulses and jitter. Pixels
  /// are armed during the gate alone, and the histogram has its length.
  void keep_detections(const RangeGate& gate, Draws& draws, Workspace& w) const noexcept {
    const auto armed = [&](double time) { return gate.contains(range_at(time)); };
    std::fill(w.blind.begin(), w.blind.end(), -std::numeric_limits<double>::infinity());
    for (std::size_t i = 0; i < w.shot.size(); ++i) {
      const Count count = w.shot[i];
      double& blind = w.blind[count.pixel];
      if (count.time < blind || !armed(count.time)) continue;
      blind = count.time + s_.dead_time;
      if (s_.afterpulse > 0 && std::isfinite(s_.dead_time) && draws.uniform() < s_.afterpulse &&
          w.shot.size() < counts_max) {
        const Count after{blind + s_.afterpulse_time * draws.exponential(), count.pixel, none};
        const auto later = [&](const Count& other) { return other.time > after.time; };
        w.shot.insert(std::find_if(w.shot.begin() + static_cast<std::ptrdiff_t>(i) + 1, w.shot.end(), later), after);
      }
      const double time = s_.jitter > 0 ? count.time + s_.jitter * normal_quantile(draws.uniform()) : count.time;
      if (w.counts.size() < counts_max && armed(time)) w.counts.push_back({time, count.pixel, count.label});
    }
  }

  /// Appends an echo for each bin of the threshold, above that before, not below that after.
  void find_echoes(const DetectorInput& input, Workspace& w) const noexcept {
    const Laser& laser = input.emitter.laser;
    const double watts = energy_per_count(laser) / (laser.pulse_length * static_cast<double>(s_.shots));
    struct Bin {
      double number = -1e300;
      std::size_t begin = 0, end = 0;
      [[nodiscard]] std::size_t count() const noexcept { return end - begin; }
    };
    const auto number_of = [&](std::size_t i) {
      return i < w.counts.size() ? std::floor(w.counts[i].time / s_.bin) : std::numeric_limits<double>::infinity();
    };
    Bin before{}, bin{}, behind{};
    do {
      behind = {number_of(behind.end), behind.end, behind.end};
      while (behind.end < w.counts.size() && number_of(behind.end) == behind.number) ++behind.end;
      const std::size_t left = before.number == bin.number - 1 ? before.count() : 0;
      const std::size_t right = behind.number == bin.number + 1 ? behind.count() : 0;
      if (bin.count() >= s_.threshold && bin.count() > left && bin.count() >= right) {
        const auto counts = std::span(w.counts).subspan(bin.begin - left, left + bin.count() + right);
        keep_return(echo_of(input, counts, watts), s_, w.echoes);
      }
      before = std::exchange(bin, behind);
    } while (bin.count() > 0);
  }

  /// Echo of some detections: their mean time, and the labels of the first reflection, or of the
  /// first continuous return, if more of them are of such.
  [[nodiscard]] static Echo echo_of(const DetectorInput& input, std::span<const Count> counts, double watts) noexcept {
    double beyond = 0;
    std::ptrdiff_t continuous = 0;  // more detections of continuous returns than of reflections
    const Count *solid = nullptr, *air = nullptr;
    for (const Count& count : counts) {
      beyond += count.time - counts.front().time;
      if (count.label == none) continue;
      const bool of_air = count.label >= input.reflections.size();
      continuous += of_air ? 1 : -1;
      const Count*& first = of_air ? air : solid;
      if (!first) first = &count;
    }
    Reflection source;
    if (continuous > 0) {
      source = labels_of(input.continuous[air->label - input.reflections.size()]);
    } else if (solid) {
      source = input.reflections[solid->label];
    }
    const double number = static_cast<double>(counts.size());
    return echo_from(source, range_at(counts.front().time + beyond / number), number * watts);
  }

  PhotonCountingSettings s_;
  Form form_;
  ByPulseLength<std::vector<double>> quantiles_;
};

}  // namespace PULSECAST_NAMESPACE

#endif
