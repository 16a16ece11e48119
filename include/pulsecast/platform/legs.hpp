// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include <pulsecast/base/expect.hpp>
#include <pulsecast/concepts.hpp>

namespace pulsecast {

/// Passes end to end, of one type of platform: set-ups of a tripod, strips of a flight. Each leg's own clock starts at zero; the survey's
/// time runs on from one to the next.
template <WorldSource P>
class Legs {
 public:
  explicit Legs(std::vector<P> legs) : legs_(std::move(legs)) {
    expect_within("Legs::legs (number)", static_cast<double>(legs_.size()), 1, 65535, "");
    PulseIndex first = 0;
    Tick start{};
    for (const P& leg : legs_) {
      starts_.push_back({first, start});
      first += leg.size(), start = start + leg.duration();
    }
    end_ = {first, start};
  }

  [[nodiscard]] PulseIndex size() const noexcept { return end_.pulse; }
  [[nodiscard]] Tick duration() const noexcept { return end_.tick; }

  [[nodiscard]] std::optional<Pulse<frame::World>> pulse(PulseIndex i) const noexcept {
    const std::size_t k = leg_of(i);
    auto p = legs_[k].pulse(i - starts_[k].pulse);
    if (p) p->index = i, p->tick = starts_[k].tick + p->tick, p->leg = static_cast<std::uint16_t>(k);
    return p;
  }

  [[nodiscard]] const std::vector<P>& legs() const noexcept { return legs_; }

  /// When leg k begins, since the survey's start.
  [[nodiscard]] Tick start(std::size_t k) const noexcept { return starts_[k].tick; }

  /// The leg that slot i belongs to.
  [[nodiscard]] std::size_t leg_of(PulseIndex i) const noexcept {
    const auto after = std::upper_bound(starts_.begin(), starts_.end(), i, [](PulseIndex n, const Start& s) { return n < s.pulse; });
    return static_cast<std::size_t>(after - starts_.begin()) - 1;
  }

 private:
  struct Start {
    PulseIndex pulse;
    Tick tick;
  };

  std::vector<P> legs_;
  std::vector<Start> starts_;
  Start end_{};
};

}  // namespace pulsecast
