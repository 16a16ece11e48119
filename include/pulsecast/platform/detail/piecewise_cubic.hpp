// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_PLATFORM_DETAIL_PIECEWISE_CUBIC_HPP
#define PULSECAST_PLATFORM_DETAIL_PIECEWISE_CUBIC_HPP

#include <algorithm>
#include <vector>

#include <pulsecast/base/require.hpp>
#include <pulsecast/base/search.hpp>
#include <pulsecast/base/tick.hpp>

namespace PULSECAST_NAMESPACE {

/// Time interval of constant jerk. `V` is a number or a vector, here in metres.
template <class V>
struct CubicPiece {
  double duration = 0;  ///< length of the interval [s]
  V position{};         ///< position at the start of the interval [m]
  V velocity{};         ///< velocity at the start [m/s]
  V acceleration{};     ///< acceleration at the start [m/s^2]
  V jerk{};             ///< constant jerk [m/s^3]

  /// State after a time [s]; `duration` is the rest.
  [[nodiscard]] CubicPiece after(double t) const noexcept {
    return {duration - t, position + t * (velocity + t / 2 * (acceleration + t / 3 * jerk)),
            velocity + t * (acceleration + t / 2 * jerk), acceleration + t * jerk, jerk};
  }
};

/// Motion in closed form: pieces in order of time, each valid until the next begins. The last state
/// of a shorter or the last piece holds on, and the start state of the first one holds before it.
template <class V>
class PiecewiseCubic {
 public:
  /// Rests at a position [m].
  explicit PiecewiseCubic(const V& position) { add({}, {.position = position}); }

  /// Appends a piece that replaces the motion from `start` on. Starts must not decrease.
  void add(Tick start, const CubicPiece<V>& piece) {
    PULSECAST_ASSERT(pieces_.empty() || !(start < pieces_.back().start));
    pieces_.push_back({start, piece});
  }

  /// State at a time; its duration is the rest of the piece.
  [[nodiscard]] CubicPiece<V> at(Tick t) const noexcept {
    const Timed& now = pieces_[detail::neighbours(pieces_.size(), [&](std::size_t i) noexcept {
                                 return !(t < pieces_[i].start);
                               }).before];
    const double elapsed = static_cast<double>(t.second - now.start.second) + (t.fraction - now.start.fraction);
    return now.piece.after(std::clamp(elapsed, 0.0, now.piece.duration));
  }

  struct Timed {
    Tick start;           ///< start of the piece
    CubicPiece<V> piece;  ///< motion from its start on
  };
  [[nodiscard]] const std::vector<Timed>& pieces() const noexcept { return pieces_; }

 private:
  std::vector<Timed> pieces_;
};

}  // namespace PULSECAST_NAMESPACE

#endif
