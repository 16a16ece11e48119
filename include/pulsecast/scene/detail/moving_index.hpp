// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SCENE_DETAIL_MOVING_INDEX_HPP
#define PULSECAST_SCENE_DETAIL_MOVING_INDEX_HPP

#include <pulsecast/accel/bvh.hpp>

namespace PULSECAST_NAMESPACE {

/// Time span and size limit of an index of moving bodies.
struct MovingIndexSettings {
  double from = 0, to = 3600;                    ///< times since the start of the survey [s]
  std::size_t boxes_max = std::size_t{1} << 20;  ///< most boxes, of about 70 bytes each

  void validate() const {
    require_within("MovingIndexSettings::from", from, -1e15, 1e15, "s");
    if (!(to > from && to <= 1e15))
      throw SettingError("MovingIndexSettings::to", to, "s", "after `from`, at most 1e+15");
    require_within("MovingIndexSettings::boxes_max", boxes_max, 1, 4294967295, "");
  }
};

/// Index of moving bodies: the time span is divided into windows, each with a tree over the boxes
/// swept in it. Faster bodies get shorter windows, halved until a body moves about its own size in
/// one, while boxes suffice. Outside of the time span all bodies are tested: slow but correct.
class MovingIndex {
 public:
  /// `swept(i, from, to)` returns the box [m] that body i sweeps between two ticks, and `size(i)`
  /// about its greatest side at rest [m], for i < `things`; called by the caller's thread.
  /// `workers` build the trees. @throws SettingError for a time span out of range
  template <class Swept, class Size>
  MovingIndex(std::size_t things, const MovingIndexSettings& time, const Swept& swept, const Size& size,
              const Workers& workers = {})
      : time_(validated(time)), span_(time.to - time.from) {
    std::array<std::vector<PrimitiveIndex>, max_level + 1> at_level;
    std::vector<Box> whole(things), boxes;  // of all the time; in one window
    for (std::size_t i = 0; i < things; ++i) {
      const auto thing = static_cast<PrimitiveIndex>(i);
      whole[i] = box_in(thing, 0, 1, swept);
      at_level[level_of(thing, size(thing), whole[i], swept)].push_back(thing);
    }
    for (std::size_t k = max_level; k > 0 && boxes_held(at_level) > time.boxes_max; --k) {
      auto &slower = at_level[k - 1], &faster = at_level[k];
      slower.insert(slower.end(), faster.begin(), faster.end());
      faster.clear();
    }
    for (std::size_t level = 0; level <= max_level; ++level) {
      if (at_level[level].empty()) continue;
      levels_.push_back({std::move(at_level[level]), {}});
      Level& made = levels_.back();
      const std::size_t windows = std::size_t{1} << level;
      made.windows.reserve(windows);
      boxes.resize(made.things.size());
      for (std::size_t w = 0; w < windows; ++w) {
        for (std::size_t k = 0; k < boxes.size(); ++k)
          boxes[k] = level == 0 ? whole[made.things[k]] : box_in(made.things[k], w, windows, swept);
        made.windows.emplace_back(boxes, workers);
        bounds_.extend(made.windows.back().bounds());
      }
    }
    all_ = things;
  }

  [[nodiscard]] const Box& bounds() const noexcept { return bounds_; }

  [[nodiscard]] std::size_t memory() const noexcept {
    std::size_t bytes = levels_.capacity() * sizeof(Level);
    for (const Level& level : levels_) {
      bytes += level.things.capacity() * sizeof(PrimitiveIndex);
      bytes += level.windows.capacity() * sizeof(Bvh<float>);
      for (const Bvh<float>& window : level.windows) bytes += window.memory();
    }
    return bytes;
  }

  /// Calls `test(i)` for each body that a bundle or a `SingleRayPacket` may meet before its hits.
  template <class Rays, class Test, class Hits>
  void closest(const Rays& rays, const Test& test, Hits& nearest) const noexcept {
    const double share = share_at(rays.tick);
    if (!(share >= 0 && share <= 1)) {
      for (std::size_t i = 0; i < all_; ++i) test(static_cast<PrimitiveIndex>(i));
      return;
    }
    for (const Level& level : levels_) {
      const auto test_found = [&](std::span<const PrimitiveIndex> found) noexcept {
        for (const PrimitiveIndex k : found) test(level.things[k]);
      };
      level.window_at(share).closest(rays, test_found, nearest);
    }
  }

  /// True only if no ray of a cone comes near a body at its tick, as of one that `MissesCones`.
  [[nodiscard]] bool misses_cone(const RayCone& cone) const noexcept {
    const double share = share_at(cone.tick);
    const auto passed = [&](const Level& l) noexcept { return l.window_at(share).misses_cone(cone); };
    return share >= 0 && share <= 1 && std::all_of(levels_.begin(), levels_.end(), passed);
  }

 private:
  static constexpr std::size_t max_level = 20;

  /// Bodies of about equal speed, and equal windows over the time span.
  struct Level {
    std::vector<PrimitiveIndex> things;
    std::vector<Bvh<float>> windows;

    [[nodiscard]] const Bvh<float>& window_at(double share) const noexcept {
      const auto window = static_cast<std::size_t>(share * static_cast<double>(windows.size()));
      return windows[std::min(window, windows.size() - 1)];
    }
  };

  [[nodiscard]] double share_at(const Tick& tick) const noexcept { return (tick.seconds() - time_.from) / span_; }

  /// Number of boxes held; each tree counts as three more.
  static std::size_t boxes_held(const auto& at_level) noexcept {
    std::size_t sum = 0;
    for (std::size_t level = 0; level <= max_level; ++level)
      if (!at_level[level].empty()) sum += (at_level[level].size() + 3) << level;
    return sum;
  }

  /// Swept box in a window; windows overlap by more than the rounding of times.
  template <class Swept>
  Box box_in(PrimitiveIndex i, std::size_t window, std::size_t windows, const Swept& swept) const {
    const double width = span_ / static_cast<double>(windows);
    const double start = time_.from + static_cast<double>(window) * width;
    const double latest = std::max(std::fabs(time_.from), std::fabs(time_.to));
    const double overlap = 32 * std::numeric_limits<double>::epsilon() * latest;
    return swept(i, Tick::of_seconds(start - overlap), Tick::of_seconds(start + width + overlap));
  }

  /// First level in whose windows a body of a size [m] moves at most about it, judged by samples;
  /// `whole` is its box of all the time. Affects speed only.
  template <class Swept>
  std::size_t level_of(PrimitiveIndex thing, double size, const Box& whole, const Swept& swept) const {
    constexpr std::size_t max_samples = 8;
    constexpr double small = 0.5;  // a smaller body gains nothing from a tight box [m]
    if (max_norm(whole.size()) <= 2 * std::max(small, size)) return 0;
    for (std::size_t level = 1; level < max_level; ++level) {
      const std::size_t windows = std::size_t{1} << level, samples = std::min(windows, max_samples);
      double moving = 0, still = 0;
      for (std::size_t k = 0; k < samples; ++k) {
        const std::size_t window = (windows * k + windows / 2) / samples;
        const double before = span_ * static_cast<double>(window) / static_cast<double>(windows);
        const Tick start = Tick::of_seconds(time_.from + before);
        moving += max_norm(box_in(thing, window, windows, swept).size());
        still += std::max(small, max_norm(swept(thing, start, start).size()));
      }
      if (moving <= 2 * still) return level;
    }
    return max_level;
  }

  MovingIndexSettings time_;
  double span_;  ///< [s]
  std::vector<Level> levels_;
  std::size_t all_ = 0;
  Box bounds_;
};

}  // namespace PULSECAST_NAMESPACE

#endif
