// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_INSTRUMENT_HPP
#define PULSECAST_HELIOS_INSTRUMENT_HPP

#include <pulsecast/base/compiled.hpp>
#include <pulsecast/helios/detail/receivers.hpp>
#include <pulsecast/scanner/channels.hpp>

/// Scanners of documents as stages of the library, for user-defined platforms, maps and surveys.
namespace PULSECAST_NAMESPACE::helios {

/// State of an instrument beside its settings.
struct InstrumentOptions {
  Rotation boresight = no_rotation;  ///< of its `Mount`: beam origins are along the body's axes
  double optic_time = 0;             ///< earlier running time of the optic [s]
};

/// Scanner of a document, as `read_assets` returns it, with the settings of a leg: its channels,
/// which fire together, with optics, head and error formulas. For any trajectory: `Platform{
/// trajectory, mount, Instrument{scanner, settings, 60}}`. If inactive, it has no pulses.
class Instrument {
 public:
  using refinements = refines<tag::MakesLanes, tag::MeasuresBeam, tag::SkipsBlocked, tag::StatesErrors>;
  /// `duration` is rounded up to whole slots [s]. @throws SettingError with the attribute at fault
  Instrument(const ScannerSettings& scanner, const LegScannerSettings& settings, double duration,
             const InstrumentOptions& options = {});

  [[nodiscard]] PulseIndex size() const noexcept { return channels_.size(); }
  [[nodiscard]] Tick duration() const noexcept { return channels_.duration(); }
  /// Emitter of each channel. Its receiver is an index into `receivers_of` the same scanner.
  [[nodiscard]] std::vector<Emitter> emitters() const { return channels_.emitters(); }

  [[nodiscard]] std::optional<Pulse<frame::Instrument>> pulse(PulseIndex i) const noexcept {
    return channels_.pulse(i);
  }
  [[nodiscard]] PulseLanes<frame::Instrument> pulse_lanes(PulseIndex i, std::size_t count) const noexcept {
    return channels_.pulse_lanes(i, count);
  }
  [[nodiscard]] PulseIndex slot_from(Tick t) const noexcept { return channels_.slot_from(t); }
  [[nodiscard]] PulseIndex next_pulse(PulseIndex i) const noexcept { return channels_.next_pulse(i); }

  /// Beam of pulse i, fired at t, without errors of deflection and head, shifted by that of range; or empty.
  [[nodiscard]] std::optional<Pose<frame::Beam, frame::Instrument>> measured(PulseIndex i, Tick t) const noexcept {
    const SurveyOptic& optic = channels_.channels()[i % channels()].moving();
    if (!optic.errs()) return std::nullopt;
    return optic.reported(t);
  }

  /// Errors of deflection, head and range, as the concept StatesErrors requires: of a known size.
  template <class Visit>
  void visit_errors(PulseIndex i, Tick t, const Visit& visit) const noexcept {
    const SurveyOptic& optic = channels_.channels()[i % channels()].moving();
    if (optic.errs()) visit(error_between(optic.at(t), optic.reported(t)));
  }

  /// Number of channels: of n, slot i is slot `i / n` of channel `i % n`.
  [[nodiscard]] std::size_t channels() const noexcept { return channels_.channels().size(); }

 private:
  Channels<SurveyChannel> channels_;
};

static_assert(InstrumentSource<Instrument> && MeasuresBeam<Instrument> && SkipsBlocked<Instrument>);

/// Options of the receivers of a scanner.
struct ReceiverOptions {
  double record_length = 0;  ///< length of the waveforms that are kept; 0: none [s]
  bool noise = false;        ///< adds noise: a quarter of the minimum power of an echo
};

/// Receivers of a scanner for `Survey`, each distinct one once, with the smallest bins of all.
/// @throws SettingError, or std::invalid_argument for an invalid noise formula
template <EchoWidth Width = NoWidth>
[[nodiscard]] std::vector<ReceiverUnit<RingFootprint, FullWaveform<Width>>> receivers_of(
    const ScannerSettings& scanner, const ReceiverOptions& options = {}) {
  const double bin = finest_bin(scanner);
  return ReceiverGroups(scanner).units(scanner, [&](const ChannelSettings& channel) {
    WaveformSettings waveform = survey_waveform(channel, options.record_length);
    waveform.sample_interval = bin;
    return survey_receiver_unit<Width>(channel, waveform, options.noise);
  });
}

}  // namespace PULSECAST_NAMESPACE::helios

#if PULSECAST_DEFINES(HELIOS_INSTRUMENT)

namespace PULSECAST_NAMESPACE::helios {

PULSECAST_INLINE Instrument::Instrument(const ScannerSettings& scanner, const LegScannerSettings& settings,
                                        double duration, const InstrumentOptions& options)
    : channels_([&] {
        if (scanner.channels.empty()) throw SettingError("channels (number)", 0, "", "at least 1");
        scanner.validate();
        settings.validate();
        const double rate = pulse_rate_of(scanner, settings);
        require_within("Instrument::duration", duration, 0, 1e15, "s");
        require_within("Instrument::duration (pulses)", duration * rate, 0, 1e15, "");
        const auto slots = static_cast<PulseIndex>(std::max(0.0, std::ceil(duration * rate - 1e-6)));
        const bool fires = slots > 0 && settings.active;  // otherwise, optics are never called
        const ReceiverGroups receivers(scanner);
        std::vector<SurveyChannel> channels;
        for (std::size_t c = 0; c < scanner.channels.size(); ++c) {
          const ChannelSettings& channel = scanner.channels[c];
          SurveyOptic optic;
          if (fires) optic = survey_optic(channel, settings, rate, options.boresight, options.optic_time);
          const Laser laser = survey_laser(channel, settings);
          const Scanner fired{.pulse_rate = rate, .pulses = slots, .laser = laser, .receiver = receivers.of_channel[c]};
          channels.emplace_back(std::move(optic), fired);
        }
        return channels;
      }()) {}

}  // namespace PULSECAST_NAMESPACE::helios

#endif

#endif
