// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_RECEIVERS_HPP
#define PULSECAST_HELIOS_DETAIL_RECEIVERS_HPP

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include <pulsecast/base/require.hpp>
#include <pulsecast/helios/detail/leg.hpp>
#include <pulsecast/helios/detail/optics.hpp>
#include <pulsecast/helios/settings.hpp>
#include <pulsecast/platform/legs.hpp>
#include <pulsecast/scanner/footprint.hpp>
#include <pulsecast/survey.hpp>

/// Surveys with a separate receiver for each channel.
namespace pulsecast::helios {

/// Pulses of a survey, shared by several receivers.
struct SharedLegs {
  std::shared_ptr<const Legs<SurveyLeg>> legs;

  [[nodiscard]] PulseIndex size() const noexcept { return legs->size(); }
  [[nodiscard]] Tick duration() const noexcept { return legs->duration(); }
  [[nodiscard]] std::optional<Pulse<frame::World>> pulse(PulseIndex i) const noexcept { return legs->pulse(i); }
};

static_assert(WorldSource<SharedLegs>);

/// Receiving half of a channel.
template <Detector Instrument>
struct ChannelReceiver {
  RingFootprint footprint;
  Receiver receiver;
  Instrument detector;
};

/// `Survey` with a receiver for each channel. It runs like any other.
template <Target Map, Detector Instrument>
class SurveyByChannel {
 public:
  using OfOne = Survey<SharedLegs, RingFootprint, Map, Instrument>;

  /// `receivers` are the distinct ones; `of_channel` holds an index into them for each channel. Sample intervals must be equal.
  SurveyByChannel(Legs<SurveyLeg> legs, std::vector<ChannelReceiver<Instrument>> receivers, std::vector<std::size_t> of_channel,
                  const Map& map, std::uint64_t seed)
      : of_channel_(std::move(of_channel)) {
    require_within("SurveyByChannel::of_channel (number)", static_cast<double>(of_channel_.size()), 1, 256, "");
    for (const std::size_t place : of_channel_)
      require_within("SurveyByChannel::of_channel", static_cast<double>(place), 0, static_cast<double>(receivers.size()) - 1, "");
    const SharedLegs source{std::make_shared<const Legs<SurveyLeg>>(std::move(legs))};
    for (ChannelReceiver<Instrument>& r : receivers)
      all_.emplace_back(source, std::move(r.footprint), map, r.receiver, std::move(r.detector), seed);
    for (const OfOne& one : all_)
      if (one.sample_interval() != all_.front().sample_interval())
        throw SettingError("SurveyByChannel::receivers (sample interval)", one.sample_interval(), "s", "equal for all");
  }

  using Workspace = std::vector<typename OfOne::Workspace>;
  [[nodiscard]] Workspace workspace() const {
    Workspace w;
    for (const OfOne& one : all_) w.push_back(one.workspace());
    return w;
  }

  [[nodiscard]] PulseIndex size() const noexcept { return all_.front().size(); }
  /// Subrays of a pulse: the mean over the channels, if they differ.
  [[nodiscard]] std::size_t subrays() const noexcept {
    const auto add = [this](std::size_t sum, std::size_t place) { return sum + all_[place].subrays(); };
    return std::accumulate(of_channel_.begin(), of_channel_.end(), std::size_t{0}, add) / of_channel_.size();
  }
  [[nodiscard]] std::size_t recorded_subrays() const noexcept { return 0; }
  [[nodiscard]] double sample_interval() const noexcept { return all_.front().sample_interval(); }

  /// Outcome of pulse `i`. Channels take turns from slot to slot, in every leg.
  [[nodiscard]] Outcome operator()(PulseIndex i, Workspace& w) const noexcept {
    const std::size_t place = all_.size() == 1 ? 0 : of_channel_[i % of_channel_.size()];
    return all_[place](i, w[place]);
  }

 private:
  std::vector<OfOne> all_;
  std::vector<std::size_t> of_channel_;
};

/// True if two channels have equal receivers; their lasers may differ.
[[nodiscard]] inline bool same_receiver(const ChannelSettings& a, const ChannelSettings& b) {
  return a.receiver_diameter == b.receiver_diameter && a.efficiency == b.efficiency && a.visibility == b.visibility &&
         a.accuracy == b.accuracy && a.errors.range_noise == b.errors.range_noise && a.range_min == b.range_min &&
         a.range_max == b.range_max && a.returns_max == b.returns_max && a.received_power_min == b.received_power_min &&
         a.pulse_length == b.pulse_length && a.waveform == b.waveform;
}

/// Survey of channels. `make(channel)` gives a receiver; it is called once for channels with equal ones. The legs must be those of that
/// scanner.
template <Target Map, class Make>
[[nodiscard]] auto survey_by_channel(const ScannerSettings& scanner, Legs<SurveyLeg> legs, const Map& map, std::uint64_t seed,
                                     const Make& make) {
  using Instrument = decltype(make(scanner.channels.front()).detector);
  std::vector<const ChannelSettings*> different;
  std::vector<std::size_t> of_channel;
  for (const ChannelSettings& channel : scanner.channels) {
    const auto alike = std::find_if(different.begin(), different.end(), [&](const auto* other) { return same_receiver(*other, channel); });
    of_channel.push_back(static_cast<std::size_t>(alike - different.begin()));
    if (alike == different.end()) different.push_back(&channel);
  }
  std::vector<ChannelReceiver<Instrument>> receivers;
  for (const ChannelSettings* channel : different) receivers.push_back(make(*channel));
  return SurveyByChannel<Map, Instrument>(std::move(legs), std::move(receivers), std::move(of_channel), map, seed);
}

}  // namespace pulsecast::helios

#endif
