// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <vector>

#include <pulsecast/base/require.hpp>
#include <pulsecast/base/tick.hpp>

namespace pulsecast {

/// A stretch of time in which the jerk does not change. `V` is a number or a vector, in units of its own: here [m].
template <class V>
struct CubicPiece {
  double duration = 0;  ///< [s]
  V position{};         ///< at the start, as all that follows [m]
  V velocity{};         ///< [m/s]
  V acceleration{};     ///< [m/s^2]
  V jerk{};             ///< [m/s^3]

  /// What follows after a time; the duration is left to do.
  [[nodiscard]] CubicPiece after(double t) const noexcept {
    return {duration - t, position + t * (velocity + t / 2 * (acceleration + t / 3 * jerk)), velocity + t * (acceleration + t / 2 * jerk),
            acceleration + t * jerk, jerk};
  }
};

/// A motion in closed form: pieces in order of time, each from its own start until the next begins. A piece that is over before that
/// holds its last state, as does the last one for ever. Before the first piece the motion is at that one's start.
template <class V>
class PiecewiseCubic {
 public:
  explicit PiecewiseCubic(const V& position) { add({}, {.position = position}); }

  /// A piece that cuts short what was there from its start on. Starts do not decrease.
  void add(Tick start, const CubicPiece<V>& piece) {
    PULSECAST_ASSERT(pieces_.empty() || !(start < pieces_.back().start));
    pieces_.push_back({start, piece});
  }

  /// State at a time; its duration is what is left of the piece.
  [[nodiscard]] CubicPiece<V> at(Tick t) const noexcept {
    const auto after = std::upper_bound(pieces_.begin(), pieces_.end(), t, [](Tick a, const Timed& b) { return a < b.start; });
    const Timed& now = after == pieces_.begin() ? *after : *(after - 1);
    const double elapsed = static_cast<double>(t.second - now.start.second) + (t.fraction - now.start.fraction);
    return now.piece.after(std::clamp(elapsed, 0.0, now.piece.duration));
  }

  struct Timed {
    Tick start;           ///< of the piece
    CubicPiece<V> piece;  ///< in its own time
  };
  [[nodiscard]] const std::vector<Timed>& pieces() const noexcept { return pieces_; }

 private:
  std::vector<Timed> pieces_;
};

}  // namespace pulsecast
