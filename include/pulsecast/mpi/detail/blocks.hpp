// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_MPI_DETAIL_BLOCKS_HPP
#define PULSECAST_MPI_DETAIL_BLOCKS_HPP

#include <algorithm>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include <pulsecast/base/tick.hpp>
#include <pulsecast/base/vector.hpp>

namespace PULSECAST_NAMESPACE::mpi {

/// Consecutive pulse slots of a run, simulated by one process.
struct MpiBlock {
  std::uint64_t number = 0;     ///< number of the block, from 0 in pulse order
  PulseIndex from = 0, to = 0;  ///< half-open range, counted from the first slot of the run
};

/// Size of a block's results for an output: one or two amounts, and its first point, if any.
struct MpiExtent {
  std::uint64_t amounts[2] = {};  ///< in units of the output
  Vec3 first{};                   ///< first point
};

/// Place of a block's results in the output.
struct MpiPlace {
  std::uint64_t starts[2] = {};  ///< for each amount, the sum before the block
  Vec3 first{};                  ///< first point of the whole output
  int chunk_owner = 0;           ///< process with the begin of the chunk in which the block begins
};

struct MpiCost {
  PulseIndex slots = 0;
  std::uint64_t echoes = 0, bytes = 0;
  double seconds = 0;  ///< computing time [s]
};

/// Schedule of a run, on the first process: blocks are handed out in order, and finish in any. They
/// shrink towards the end, so that all end together; memory and time of each are bounded.
class MpiBlockScheduler {
 public:
  MpiBlockScheduler(PulseIndex slots, unsigned processes) : slots_(slots), processes_(std::max(1U, processes)) {}

  /// Next block for a process; none at the end.
  [[nodiscard]] std::optional<MpiBlock> next(int owner) {
    if (handed_out_ == slots_) return std::nullopt;
    const PulseIndex left = slots_ - handed_out_;
    const PulseIndex size =
        std::min(left, std::clamp(left / (4 * processes_), min_slots, most()) / min_slots * min_slots);
    const MpiBlock block{next_, handed_out_, handed_out_ + size};
    owners_.emplace(next_++, owner);
    handed_out_ += size;
    return block;
  }

  void stop() noexcept { slots_ = handed_out_; }

  void finish(std::uint64_t number, std::vector<MpiExtent> extents, const MpiCost& cost) {
    finished_.emplace(number, std::move(extents));
    cost_.slots += cost.slots;
    cost_.echoes += cost.echoes;
    cost_.bytes += cost.bytes;
    cost_.seconds += cost.seconds;
  }

  /// Calls place(number, owner, extents) for blocks up to the first unfinished, while may().
  template <class May, class Place>
  void settle(const May& may, const Place& place) {
    while (may()) {
      const auto due = finished_.extract(placed_);
      if (due.empty()) return;
      place(placed_, owners_.extract(placed_).mapped(), std::as_const(due.mapped()));
      ++placed_;
    }
  }

  [[nodiscard]] const MpiCost& cost() const noexcept { return cost_; }

  static constexpr PulseIndex min_slots = 2048;  ///< of a block, except the last

 private:
  static constexpr double max_bytes = 16 << 20, max_seconds = 0.5;  // of a block [byte], [s]
  static constexpr PulseIndex max_slots = PulseIndex{1} << 18, first_slots = PulseIndex{1} << 13;

  /// Upper limit of a block's slots; small until a cost is known.
  [[nodiscard]] PulseIndex most() const noexcept {
    if (cost_.slots == 0) return first_slots;
    const double slots = static_cast<double>(cost_.slots), bytes = static_cast<double>(cost_.bytes);
    const double by_bytes = max_bytes / std::max(1.0, bytes) * slots;
    const double by_seconds = max_seconds / std::max(1e-9, cost_.seconds) * slots;
    const double allowed = std::min({by_bytes, by_seconds, static_cast<double>(max_slots)});
    return std::max(min_slots, static_cast<PulseIndex>(allowed));
  }

  PulseIndex slots_, handed_out_ = 0;
  PulseIndex processes_;
  std::uint64_t next_ = 0, placed_ = 0;
  std::map<std::uint64_t, int> owners_;
  std::map<std::uint64_t, std::vector<MpiExtent>> finished_;  // finished, without a place
  MpiCost cost_;
};

}  // namespace PULSECAST_NAMESPACE::mpi

#endif
