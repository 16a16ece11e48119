// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_DETECTOR_FULL_WAVEFORM_HPP
#define PULSECAST_DETECTOR_FULL_WAVEFORM_HPP

#include <pulsecast/detector/adaptor.hpp>
#include <pulsecast/detector/detail/by_pulse_length.hpp>
#include <pulsecast/detector/detail/sample_window.hpp>
#include <pulsecast/detector/detail/single_peak_group.hpp>
#include <pulsecast/detector/receiver_noise.hpp>

namespace PULSECAST_NAMESPACE {

/// Conversion of the light at an aperture into samples: a policy of `FullWaveform`. `samples` takes
/// a pulse's reflections, sorted by range, and returns them section by section, as `IdealSamples`
/// does. `prepare` receives each laser before the first pulse. `timing_reach` is the time beside a
/// maximum whose samples define its place [s]; 0: those next to it.
template <class R>
concept WaveformReceiver = std::copyable<R> &&
    requires(R& any, const R r, const Laser& laser, const WaveformSettings& s, const DetectorInput& input,
             std::span<const Reflection> reflections, double width_tail, typename R::Workspace& w, bool& more) {
  any.prepare(laser, s);
  any.silence();
  { r.workspace() } -> std::same_as<typename R::Workspace>;
  { r.samples(s, input, reflections, width_tail, w).begin_section() }
  noexcept->std::same_as<bool>;
  { r.samples(s, input, reflections, width_tail, w).power(more) }
  noexcept->std::same_as<double>;
  { r.timing_reach(laser) }
  noexcept->std::same_as<double>;
  { R::runs_without_reflections } -> std::convertible_to<bool>;
};

/// Digitising detector: samples what a receiver makes of all reflections, and interpolates the
/// peaks. The receiver is ideal by default; real ones are a `BandLimitedReceiver`.
///
/// With the independent noise of `ReceiverNoise`, the receiver records from the first reflection
/// on, for the record's length and as long as reflections arrive, and detects false echoes. The
/// threshold applies to the samples themselves, and echoes are timed by their peaks in place of
/// true ranges. Amplitudes and widths are relative to the mean background of the record.
///
/// Limits, of an ideal receiver: a single echo's peak errs by 0.03 mm for an interval of 1/16 of
/// the pulse length, by 0.5 mm at 1/8, by 10 mm at 1/4; its amplitude by -0.13 to 0.40 % at 1/5,
/// and 2 % at 1/4. Pulses of other than 1 to 10,000 intervals are refused.
template <EchoWidth Width = NoWidth, WaveformReceiver Receiver = ReceiverNoise>
class FullWaveform {
 public:
  using refinements = refines<tag::SamplesWaveforms, tag::ValidatesLaser>;
  /// @throws SettingError for settings out of range
  explicit FullWaveform(WaveformSettings settings = {}, Width width = {}, Receiver receiver = {})
      : s_(validated(settings)), width_(validated(std::move(width))), receiver_(validated(std::move(receiver))) {}

  static constexpr bool runs_without_reflections = Receiver::runs_without_reflections;  ///< as the receiver

  [[nodiscard]] const WaveformSettings& settings() const noexcept { return s_; }
  [[nodiscard]] double sample_interval() const noexcept { return s_.sample_interval; }

  /// Refuses pulses that samples do not resolve, or beyond the sample window. @throws SettingError
  void validate(const Laser& laser) const { s_.require_sampled(laser.pulse_length, WaveformSettings::max_samples); }

  /// Prepares receiver and correction of echo times for a laser. @throws SettingError as `validate`
  void prepare(const Laser& laser) {
    validate(laser);
    receiver_.prepare(laser, s_);
    if (reads_samples() && !corrections_.find(laser)) corrections_.add(laser, correction_for(laser));
  }

  /// Calls `visit(k, arrival, detection)` for flat targets without noise, at ten times the
  /// threshold, whose pulse arrives at the place k of `places` between two samples [s], the last
  /// the next sample. Records, if any, hold the whole pulse.
  void visit_flat_targets(const Laser& laser, std::size_t places, const auto& visit) const {
    FullWaveform quiet = *this;
    quiet.receiver_.silence();
    quiet.s_.threshold = s_.threshold > 0 ? s_.threshold : 1;
    if (s_.record_length > 0) quiet.s_.record_length = std::max(s_.record_length, 1e5 * s_.sample_interval);
    Workspace w = quiet.workspace(1);
    const Emitter emitter{.laser = laser};
    const double first = (8192 + std::floor(100 * laser.pulse_length / s_.sample_interval)) * s_.sample_interval;
    for (std::size_t k = 0; k <= places; ++k) {
      const double arrival = first + static_cast<double>(k) / static_cast<double>(places) * s_.sample_interval;
      Reflection reflection{.range = range_at(arrival), .power = 10 * quiet.s_.threshold};
      visit(k, arrival, quiet.detect({.emitter = emitter, .reflections = {&reflection, 1}}, w));
    }
  }

  [[nodiscard]] double pulse_width(const Laser& laser) const {
    validate(laser);
    return pulsecast::pulse_width(width_, PulseShape(laser.pulse_length, s_.shape_divisor), s_.sample_interval);
  }

  struct Workspace {
    SampleWindow<Width> window;               ///< current samples [W]
    std::vector<Peak> peaks;                  ///< peaks of the current pulse
    std::vector<Echo> echoes;                 ///< echoes of the current pulse
    std::vector<float> record;                ///< samples of the kept waveform [W]
    SinglePeakGroup::Workspace group;         ///< ages and weights
    typename Receiver::Workspace receiver{};  ///< of the receiver
  };

  /// Scratch memory for pulses of up to `reflections` reflections, of lasers that were prepared.
  [[nodiscard]] Workspace workspace(std::size_t reflections) const {
    Workspace w{{}, {}, {}, {}, SinglePeakGroup::Workspace(reflections), receiver_.workspace()};
    const bool noiseless = [&] {
      if constexpr (ideal) return receiver_.none();
      return false;
    }();
    w.peaks.reserve(noiseless ? reflections + continuous_peaks : std::max(reflections, max_peaks));
    w.echoes.reserve(std::min(w.peaks.capacity(), s_.returns_max));
    w.record.reserve(s_.record_capacity());
    return w;
  }

  /// Sorts the reflections by range. Drops those without power, or too far away to count samples.
  /// Noise is drawn from the seed and pulse of `input.key`.
  [[nodiscard]] Detection detect(const DetectorInput& input, Workspace& w) const noexcept {
    const Laser& laser = input.emitter.laser;
    w.peaks.clear();
    w.echoes.clear();
    w.record.clear();
    std::optional<OnlyPeak> only;
    if constexpr (ideal) {
      if (std::same_as<Width, NoWidth> && s_.record_length == 0 && receiver_.none() && s_.timing <= EchoTiming::peak &&
          is_apart(input)) {
        const PulseShape shape(laser.pulse_length, s_.shape_divisor);
        const SinglePeakGroup group(input.reflections, shape, s_.sample_interval, w.group);
        if (group.one() && !input.continuous.empty())
          only = only_peak(group, shape, input.continuous);
        else if (group.one() && detect(group, shape, w.echoes))
          return {w.echoes, {}, 0};
      }
    } else if constexpr (std::same_as<Width, NoWidth>) {
      if (s_.record_length == 0 && s_.timing == EchoTiming::peak && is_apart(input))
        only = receiver_.only_peak(s_, input, reach_of(laser));
      if (only && input.continuous.empty()) {
        keep_only(only, laser, w.echoes);
        return {w.echoes, {}, 0};
      }
    }
    const std::span<const Reflection> reflections =
        only ? std::span<Reflection>{} : in_order_of_range(input.reflections, s_.sample_interval);
    auto samples = receiver_.samples(s_, input, reflections, tail(), w.receiver);
    const double apart = s_.min_separation(laser.pulse_length);
    const typename SampleWindow<Width>::Search search{
        s_, width_, apart, samples.delay(), samples.independent_noise(), reach_of(laser)};
    while (samples.begin_section()) {
      w.window.clear();
      for (bool more = true; more;) {
        if constexpr (ideal) samples.append(w.window.samples());
        const double n = samples.number(), power = samples.power(more);
        keep(n - samples.start(), power + samples.background(), w.record);
        w.window.take(n, power, more, search, w.peaks);
      }
    }
    if (const Correction* correction = corrections_.find(laser))
      for (Peak& peak : w.peaks) peak.mark = correction->arrival(peak.mark, s_.sample_interval);
    if constexpr (runs_without_reflections)  // pulses at the ends reach beyond it
      std::erase_if(w.peaks, [&](const Peak& peak) { return !input.gate.contains(range_at(peak.mark)); });
    keep_echoes(s_, w.peaks);
    const EchoTiming timing =
        samples.independent_noise() && s_.timing == EchoTiming::true_range ? EchoTiming::peak : s_.timing;
    for (const Peak& peak : w.peaks) {
      if (only && peak.time > only->time) keep_only(only, laser, w.echoes);
      keep_return(echo_of(peak, reflections, samples.shape(), timing, samples.continuous()), s_, w.echoes);
    }
    if (only) keep_only(only, laser, w.echoes);
    number_echoes(w.echoes);
    return {w.echoes, w.record, samples.start() * s_.sample_interval};
  }

 private:
  static constexpr bool ideal = std::same_as<Receiver, ReceiverNoise>;
  static constexpr std::size_t max_peaks = 4096;  ///< peaks of noise that count
  static constexpr std::size_t continuous_peaks = 64;

  /// Time of a flat target's echo less its arrival, by its place between two samples.
  struct Correction {
    static constexpr std::size_t places = 16;
    std::array<double, places + 1> time{};  ///< at evenly spaced places [s]
    double reach = 0;                       ///< as `timing_reach` [s]

    /// Arrival of the flat target that would have an echo at this time [s].
    [[nodiscard]] double arrival(double mark, double interval) const noexcept {
      double arrival = mark;
      for (int step = 0; step < 4; ++step) {
        const double place = (arrival / interval - std::floor(arrival / interval)) * places;
        const auto i = std::min(static_cast<std::size_t>(place), places - 1);
        arrival = mark - (time[i] + (place - static_cast<double>(i)) * (time[i + 1] - time[i]));
      }
      return arrival;
    }
  };

  /// Time after the last pulse's peak up to which a waveform affects a width or a time [tau]. After
  /// their peaks, the sum of pulses falls at least as fast as one that is at its peak.
  [[nodiscard]] double tail() const noexcept {
    const double of_time = s_.timing == EchoTiming::centroid ? PulseShape::fallen_to(detail::centroid_level) : 0;
    return std::fmax(detail::tail_of(width_), of_time);
  }

  [[nodiscard]] double reach_of(const Laser& laser) const noexcept {
    const Correction* correction = corrections_.find(laser);
    return correction ? correction->reach : 0;
  }

  /// True for echo times that need a correction: of samples, but for an ideal receiver's peak.
  [[nodiscard]] bool reads_samples() const noexcept {
    return s_.timing != EchoTiming::true_range && !(ideal && s_.timing == EchoTiming::peak);
  }

  /// Correction for a laser, from echoes without noise whose peaks are ten times the threshold.
  [[nodiscard]] Correction correction_for(const Laser& laser) const {
    FullWaveform unrecorded = *this;
    unrecorded.s_.record_length = 0;
    Correction c{.reach = s_.timing == EchoTiming::peak ? receiver_.timing_reach(laser) : 0};
    unrecorded.corrections_.add(laser, c);
    unrecorded.visit_flat_targets(laser, Correction::places, [&](std::size_t k, double arrival, const Detection& d) {
      if (!d.echoes.empty()) c.time[k] = 2 * d.echoes[0].range / speed_of_light - arrival;
    });
    return c;
  }

  /// Keeps the only echo of reflections, if it reaches the threshold.
  void keep_only(std::optional<OnlyPeak>& only, const Laser& laser, std::vector<Echo>& echoes) const noexcept {
    const Correction* correction = corrections_.find(laser);
    const double time = correction ? correction->arrival(only->time, s_.sample_interval) : only->time;
    if (only->height >= s_.threshold)
      keep_return(echo_from(*only->strongest, range_at(time), only->height), s_, echoes);
    only.reset();
  }

  /// True if a maximum of reflections, a pulse away from others, is an echo whatever these are.
  [[nodiscard]] bool is_apart(const DetectorInput& input) const noexcept {
    return input.continuous.empty() || (s_.dead_time == 0 && s_.prominence == 0 &&
                                        std::fmax(s_.window, s_.separation) <= input.emitter.laser.pulse_length);
  }

  /// Samples near the peak of a group, from two before it on.
  struct TopSamples {
    double first;             ///< number of the first sample
    std::array<double, 8> y;  ///< [W]
  };
  /// Takes those of a group; false if they reach back before the last edge.
  [[nodiscard, gnu::always_inline]] bool sample(const SinglePeakGroup& group, const PulseShape& shape,
                                                TopSamples& top) const noexcept {
    const double per_tau = 1 / shape.tau;
    const double before = std::floor((group.last_edge() + group.peak() * shape.tau) / s_.sample_interval);
    const double first = ((before - 2) * s_.sample_interval - group.last_edge()) * per_tau;
    const double step = s_.sample_interval * per_tau;
    if (!(first >= 0)) return false;
    top.first = before - 2;
    for (std::size_t j = 0; j < top.y.size(); j += simd::lane_count)
      simd::store(
          group.power(simd::generate([&](std::size_t lane) { return first + static_cast<double>(j + lane) * step; })),
          top.y[j]);
    return true;
  }

  /// Maximum of a group among continuous returns that only fall near it; none on their flank.
  [[nodiscard]] std::optional<OnlyPeak> only_peak(const SinglePeakGroup& group, const PulseShape& shape,
                                                  std::span<const ContinuousReturn> continuous) const noexcept {
    TopSamples top;
    if (!sample(group, shape, top)) return {};
    const detail::GammaIntegrals pulse(shape);
    detail::ContinuousRises rises(continuous, pulse);
    const auto time = [&](double j) { return (top.first + j) * s_.sample_interval; };
    rises.pass(time(8));
    if (!(rises.until() <= time(0) - pulse.end() && rises.next() >= time(8) + pulse.end())) return {};
    detail::ContinuousSum sum(continuous, shape);
    for (std::size_t j = 0; j < 6; ++j) {  // those that `vertex` may read
      sum.advance(time(static_cast<double>(j)));
      top.y[j] += sum.power();
    }
    const std::size_t k = top.y[3] > top.y[2] ? 3 : 2;
    if (!(top.y[k] > top.y[k - 1] && top.y[k] >= top.y[k + 1])) return {};
    const detail::Vertex at = detail::vertex(&top.y[k]);
    const double peak = time(static_cast<double>(k) + at.offset);
    const double mark = s_.timing == EchoTiming::true_range ? 2 * group.mean_range() / speed_of_light : peak;
    return OnlyPeak{mark, at.height, &group.strongest((peak - group.last_edge()) / shape.tau)};
  }

  /// Appends the only echo of a group, if it reaches the threshold: as full sampling, from the
  /// samples near its peak. False if these reach back before the last edge.
  bool detect(const SinglePeakGroup& group, const PulseShape& shape, std::vector<Echo>& echoes) const noexcept {
    TopSamples samples;
    if (!sample(group, shape, samples)) return false;
    const auto& y = samples.y;
    const std::size_t top = y[3] > y[2] ? 3 : 2;
    const auto [offset, height] = detail::vertex(&y[top]);
    if (height < s_.threshold) return true;
    const double time = (samples.first + static_cast<double>(top) + offset) * s_.sample_interval;
    echoes.push_back(group.echo(time, height, s_.timing));
    return true;
  }

  void keep(double at, double power, std::vector<float>& record) const noexcept {
    if (at < 0 || at >= static_cast<double>(s_.record_capacity())) return;
    record.resize(static_cast<std::size_t>(at) + 1);  // gaps are filled with zeros
    record.back() = static_cast<float>(power);
  }

  WaveformSettings s_;
  Width width_;
  Receiver receiver_;
  ByPulseLength<Correction> corrections_;
};

}  // namespace PULSECAST_NAMESPACE

#endif
