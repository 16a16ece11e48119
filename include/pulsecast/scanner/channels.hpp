// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SCANNER_CHANNELS_HPP
#define PULSECAST_SCANNER_CHANNELS_HPP

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <pulsecast/base/require.hpp>
#include <pulsecast/concepts.hpp>

namespace pulsecast {

namespace detail {
template <class S>
concept SourceInSomeFrame = BeamSource<S> || InstrumentSource<S> || WorldSource<S>;
}  // namespace detail

/// Device with many emitters, each a pulse source with its own laser, origin and optic, all in one frame and of one type. Of n channels,
/// slot i is slot `i / n` of channel `i % n`. Emitters that fire in turn differ in `Scanner::delay`, which must not decrease from channel
/// to channel; emitters that fire together share it.
template <detail::SourceInSomeFrame Source>
class Channels {
 public:
  /// From 1 to 256 channels, all of one size and duration. Throws a `SettingError`.
  explicit Channels(std::vector<Source> channels) : channels_(std::move(channels)) {
    require_within("Channels::channels (number)", static_cast<double>(channels_.size()), 1, 256, "");
    for (Source& c : channels_) c = validated(std::move(c));
    const double size = static_cast<double>(channels_[0].size()), duration = channels_[0].duration().seconds();
    for (const Source& c : channels_) {
      require_within("Channels::channels (slots)", static_cast<double>(c.size()), size, size, "");
      require_within("Channels::channels (duration)", c.duration().seconds(), duration, duration, "s");
    }
    require_order();
  }

  [[nodiscard]] PulseIndex size() const noexcept { return channels_.size() * channels_[0].size(); }
  [[nodiscard]] Tick duration() const noexcept { return channels_[0].duration(); }

  [[nodiscard]] auto pulse(PulseIndex i) const noexcept -> decltype(std::declval<const Source&>().pulse(i)) {
    const std::size_t k = i % channels_.size();
    auto p = channels_[k].pulse(i / channels_.size());
    if (p) {
      p->index = i;
      p->channel = static_cast<std::uint8_t>(k);
    }
    return p;
  }

  /// Channels in the order of firing.
  [[nodiscard]] const std::vector<Source>& channels() const noexcept { return channels_; }

 private:
  /// Throws a `SettingError` if time decreases from one channel to the next. Samples some rounds spread over the whole; channels of one
  /// rate show it in any round.
  void require_order() const {
    const PulseIndex n = channels_.size(), rounds = channels_[0].size(), step = rounds / 64 + 1;
    for (PulseIndex round = 0; round < rounds; round += step) {
      std::optional<Tick> last;
      for (PulseIndex i = round * n; i < (round + 2) * n && i < size(); ++i) {
        const auto p = pulse(i);
        if (p && last && p->tick < *last)
          throw SettingError("Channels::channels (pulse of channel " + std::to_string(i % n) + ")", p->tick.seconds(), "s",
                             "at least that of the previous channel, " + detail::to_text(last->seconds()) + " s");
        if (p) last = p->tick;
      }
    }
  }

  std::vector<Source> channels_;
};

}  // namespace pulsecast

#endif
