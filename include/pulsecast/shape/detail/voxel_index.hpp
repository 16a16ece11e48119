// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SHAPE_DETAIL_VOXEL_INDEX_HPP
#define PULSECAST_SHAPE_DETAIL_VOXEL_INDEX_HPP

#include <pulsecast/base/shared_array.hpp>
#include <pulsecast/geometry/box.hpp>
#include <pulsecast/shape/detail/lattice_ray.hpp>

namespace PULSECAST_NAMESPACE {

struct VoxelData;
namespace detail {

class VoxelIndexBuilder;

/// Greatest extent of a lattice along an axis [cells].
inline constexpr std::uint32_t max_lattice_extent = 1U << 21;

/// Position of a cell, after `shift` bits of its coordinates, among the 4 x 4 x 4 around it.
[[nodiscard]] inline unsigned cell_bit(const LatticeCell& c, int shift) noexcept {
  const auto part = [&](std::size_t k) noexcept { return static_cast<unsigned>(c[k] >> shift & 3); };
  return part(0) | part(1) << 2 | part(2) << 4;
}

/// Child at such a position, of a fourth of the edge.
[[nodiscard]] inline LatticeCell child_cell(const LatticeCell& c, unsigned place) noexcept {
  const auto p = static_cast<std::int32_t>(place);
  return {c[0] << 2 | (p & 3), c[1] << 2 | (p >> 2 & 3), c[2] << 2 | p >> 4};
}

/// Coordinates of a cell without `shift` bits each, in one number.
[[nodiscard]] inline std::uint64_t packed_cell(const LatticeCell& c, int shift) noexcept {
  const auto part = [&](std::size_t k) noexcept { return static_cast<std::uint64_t>(c[k] >> shift); };
  return part(0) | part(1) << 21 | part(2) << 42;
}

/// Inverse of `packed_cell`, of no shift.
[[nodiscard]] inline LatticeCell unpacked_cell(std::uint64_t key) noexcept {
  const auto part = [&](int shift) noexcept {
    return static_cast<std::int32_t>(key >> shift & (max_lattice_extent - 1));
  };
  return {part(0), part(21), part(42)};
}

/// Slot of a key in a hash table. Source: multiplicative hashing by the golden ratio, Knuth 1973.
[[nodiscard]] inline std::size_t hash_slot(std::uint64_t key, std::size_t slots) noexcept {
  const std::uint64_t mixed = (key * 0x9E3779B97F4A7C15) >> 32;
  return static_cast<std::size_t>(mixed * slots >> 32);
}

/// Cubes of one size, a bit each, in words of 4 x 4 x 4. A level too large for direct indexing
/// shares its words by a hash; an unset bit still proves its cube empty.
struct VoxelLevel {
  std::uint64_t first = 0;                ///< first word
  std::uint64_t words = 0;                ///< words of a hashed level; 0 if indexed directly
  std::array<std::uint32_t, 2> extent{};  ///< words along x and y
  std::int32_t shift = 0;                 ///< log2 of the edge of a bit's cube [cells]
  std::int32_t unused = 0;                ///< makes all bytes of an archive definite

  [[nodiscard]] std::size_t word(const LatticeCell& c) const noexcept {
    const int word_shift = shift + 2;
    const auto begin = static_cast<std::size_t>(first);
    if (words > 0) return begin + hash_slot(packed_cell(c, word_shift), static_cast<std::size_t>(words));
    const auto at = [&](std::size_t k) noexcept { return static_cast<std::size_t>(c[k] >> word_shift); };
    return begin + (at(2) * extent[1] + at(1)) * extent[0] + at(0);
  }
};

/// State of a ray's traversal of a lattice, cell by cell or in leaps over empty cubes.
struct LatticeWalker {
  const LatticeRay& ray;
  LatticeCell cell{};
  Crossing in;                 ///< crossing into the cell
  std::array<double, 3> next;  ///< range of the exit plane along each axis
  bool inside = false;

  LatticeWalker(const LatticeRay& r, double near, const LatticeCell& extent) noexcept
      : ray(r), in{near, Crossing::begin} {
    if (!ray.valid()) return;
    for (int k = 0; k < 3; ++k) {
      if (ray.sense(k) == 0) continue;
      const Crossing wall = ray.crossing(k, ray.sense(k) > 0 ? 0 : extent[static_cast<std::size_t>(k)]);
      if (wall.range > in.range || (wall.range == in.range && in.axis != Crossing::begin)) in = wall;
    }
    if (!(in.range < infinity)) return;
    for (int k = 0; k < 3; ++k)
      if (!find(k, 0, extent[static_cast<std::size_t>(k)] - 1)) return;
    inside = true;
  }

  /// Sets the cell along an axis to that of the ray at `in`; false if not between `low` and `high`.
  bool find(int k, std::int32_t low, std::int32_t high) noexcept {
    const auto axis = static_cast<std::size_t>(k);
    const int sense = ray.sense(k);
    const double guess = ray.position(k, in.range);  // truncated, as `low` is not negative
    std::int32_t c = guess > low ? guess < high ? static_cast<std::int32_t>(guess) : high : low;
    if (sense == 0) {
      while (c < high && ray.above(k, c + 1)) ++c;
      while (c > low && !ray.above(k, c)) --c;
      cell[axis] = c;
      next[axis] = infinity;
      return ray.above(k, c) && !ray.above(k, c + 1);
    }
    const std::int32_t first = sense > 0 ? low : high, last = sense > 0 ? high : low;
    const std::int32_t front = sense > 0 ? 1 : 0, back = 1 - front;
    while (c != last && !in.before(ray.crossing(k, c + front))) c += sense;
    while (c != first && in.before(ray.crossing(k, c + back))) c -= sense;
    cell[axis] = c;
    next[axis] = ray.crossing(k, c + front).range;
    return in.before({next[axis], k});
  }

  /// Axis of the first crossing.
  static int first_of(const std::array<double, 3>& ranges) noexcept {
    const int xy = ranges[0] <= ranges[1] ? 0 : 1;
    return ranges[static_cast<std::size_t>(xy)] <= ranges[2] ? xy : 2;
  }

  /// True if two coordinates along an axis are in the same group of four.
  static bool neighbours(std::int32_t a, std::int32_t b) noexcept { return a >> 2 == b >> 2; }

  /// Steps to the next cell; false if it is in another brick.
  bool step(int k) noexcept {
    const auto axis = static_cast<std::size_t>(k);
    const int sense = ray.sense(k);
    in = {next[axis], k};
    const std::int32_t from = cell[axis];
    cell[axis] = from + sense;
    next[axis] = ray.crossing(k, cell[axis] + (sense > 0 ? 1 : 0)).range;
    return neighbours(from, cell[axis]);
  }

  /// Leaps over empty cubes of edge 2^shift cells, from the one around the cell, up to one that is
  /// occupied by the mask `occupied`, or outside of its 4 x 4 x 4. False if the ray never leaves.
  bool leap(int shift, std::uint64_t occupied) noexcept {
    LatticeCell at;
    std::array<double, 3> exit;
    for (int k = 0; k < 3; ++k) {
      const auto axis = static_cast<std::size_t>(k);
      at[axis] = cell[axis] >> shift;
      exit[axis] =
          ray.sense(k) == 0 ? infinity : ray.crossing(k, (at[axis] + (ray.sense(k) > 0 ? 1 : 0)) << shift).range;
    }
    for (;;) {
      const int k = first_of(exit);
      const auto axis = static_cast<std::size_t>(k);
      if (!(exit[axis] < infinity)) return false;
      in = {exit[axis], k};
      const std::int32_t from = at[axis];
      at[axis] += ray.sense(k);
      if (!neighbours(from, at[axis]) || (occupied >> cell_bit(at, 0) & 1)) break;
      exit[axis] = ray.crossing(k, (at[axis] + (ray.sense(k) > 0 ? 1 : 0)) << shift).range;
    }
    for (int k = 0; k < 3; ++k) {
      const auto axis = static_cast<std::size_t>(k);
      const std::int32_t low = at[axis] << shift, high = low | ((1 << shift) - 1);
      if (k == in.axis) {
        cell[axis] = ray.sense(k) > 0 ? low : high;
        next[axis] = ray.crossing(k, cell[axis] + (ray.sense(k) > 0 ? 1 : 0)).range;
      } else if (ray.sense(k) != 0) {
        find(k, low, high);
      }
    }
    return true;
  }
};

}  // namespace detail

/// Sparse index of the occupied cells of a lattice, and their numbers: bits of bricks of 4 x 4 x 4,
/// which are bits of blocks of as many, where that saves memory. A hash finds them; a bit pyramid
/// lets rays leap over empty cubes. 26 bytes a cell and 16. Source: Amanatides & Woo 1987.
class VoxelIndex {
 public:
  /// Greatest extent along an axis [cells].
  static constexpr std::uint32_t longest = detail::max_lattice_extent;

  explicit VoxelIndex(DeserializeTag) {}

  /// Sets `order` to the data's cell index of each number. `shape/voxel_grid.hpp` defines this; it
  /// takes no part in tracing.
  /// @throws SettingError for a duplicate cell, or an extent above `longest`
  VoxelIndex(const VoxelData& data, std::vector<std::uint32_t>& order);

  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  [[nodiscard]] const Box& bounds() const noexcept { return bounds_; }
  /// Edge of a cell [m].
  [[nodiscard]] double edge() const noexcept { return edge_; }
  [[nodiscard]] std::size_t memory() const noexcept {
    return keys_.memory() + slots_.memory() + block_masks_.memory() + block_first_.memory() + brick_masks_.memory() +
           brick_first_.memory() + pyramid_.memory();
  }

  /// Cell of a number below `size()`, relative to the lower corner of the bounds.
  [[nodiscard]] LatticeCell cell(std::uint32_t number) const noexcept {
    const std::size_t brick = holder(brick_first_, number);
    const unsigned bit = nth_bit(brick_masks_[brick], number - brick_first_[brick]);
    if (height_ == 1) return detail::child_cell(detail::unpacked_cell(keys_[brick]), bit);
    const auto child = static_cast<std::uint32_t>(brick);
    const std::size_t block = holder(block_first_, child);
    const unsigned place = nth_bit(block_masks_[block], child - block_first_[block]);
    return detail::child_cell(detail::child_cell(detail::unpacked_cell(keys_[block]), place), bit);
  }

  /// Ray j in the lattice, relative to the lower corner of the bounds.
  [[nodiscard]] LatticeRay ray(const auto& rays, std::size_t j) const noexcept { return {corner_, edge_, rays, j}; }

  /// Traverses a ray from `near` on: `limit = visit(number, cell, in, out)` at each occupied cell
  /// up to the limit, in order. `in` is the crossing into the cell, or `near`.
  void walk(const LatticeRay& ray, double near, double limit, auto visit) const noexcept {
    detail::LatticeWalker at(ray, near, extent_);
    if (!at.inside) return;
    Place place;
    limit = std::min(limit, std::numeric_limits<double>::max());  // planes never crossed are beyond
    while (at.in.range <= limit) {
      if (outside(at.cell)) return;
      if (const Empty empty = around(at.cell, place); empty.shift > 0) {
        if (!at.leap(empty.shift, empty.siblings)) return;
        continue;
      }
      const std::uint64_t mask = brick_masks_[place.brick];
      for (;;) {
        const unsigned bit = detail::cell_bit(at.cell, 0);
        const int axis = detail::LatticeWalker::first_of(at.next);
        if (mask >> bit & 1) {
          const std::uint32_t number = brick_first_[place.brick] + bits_below(mask, bit);
          const Crossing out{at.next[static_cast<std::size_t>(axis)], axis};
          limit = std::min<double>(limit, visit(number, at.cell, at.in, out));
        }
        const bool same_brick = at.step(axis);
        if (!same_brick || !(at.in.range <= limit)) break;
      }
    }
  }

  void archive(auto& a) {
    a(bounds_, corner_, edge_, extent_, size_, height_, levels_, level_count_);
    a(keys_, slots_, block_masks_, block_first_, brick_masks_, brick_first_, pyramid_);
  }

 private:
  friend class detail::VoxelIndexBuilder;

  /// Position of a walk in the tree.
  struct Place {
    std::uint64_t key = ~std::uint64_t{0};  ///< key of `root`
    std::uint32_t root = 0, brick = 0;
  };

  static constexpr std::uint32_t nothing = ~std::uint32_t{0};

  /// Last node whose first child is not after `child`.
  static std::size_t holder(const SharedArray<std::uint32_t>& first, std::uint32_t child) noexcept {
    const auto after = std::upper_bound(first.begin(), first.end(), child);
    return static_cast<std::size_t>(after - first.begin()) - 1;
  }

  static std::uint32_t bits_below(std::uint64_t mask, unsigned bit) noexcept {
    return static_cast<std::uint32_t>(std::popcount(mask & ((std::uint64_t{1} << bit) - 1)));
  }
  static unsigned nth_bit(std::uint64_t mask, std::uint32_t n) noexcept {
    for (; n > 0; --n) mask &= mask - 1;
    return static_cast<unsigned>(std::countr_zero(mask));
  }

  std::uint32_t root(std::uint64_t key) const noexcept {
    for (std::size_t s = detail::hash_slot(key, slots_.size()); slots_[s] != nothing;
         s = s + 1 == slots_.size() ? 0 : s + 1)
      if (keys_[slots_[s]] == key) return slots_[s];
    return nothing;
  }

  bool outside(const LatticeCell& c) const noexcept {
    for (std::size_t k = 0; k < 3; ++k)
      if (static_cast<std::uint32_t>(c[k]) >= static_cast<std::uint32_t>(extent_[k])) return true;
    return false;
  }

  /// Empty cube: log2 of its edge [cells], 0 for none; and the occupancy mask of its 4 x 4 x 4.
  struct Empty {
    int shift = 0;
    std::uint64_t siblings = 0;
  };

  /// Largest empty cube around a cell, or none; then `place` is set to the brick.
  Empty around(const LatticeCell& c, Place& place) const noexcept {
    Empty empty;
    for (std::size_t i = 0; i < level_count_; ++i) {
      const detail::VoxelLevel& level = levels_[i];
      const std::uint64_t siblings = pyramid_[level.word(c)];
      if (!(siblings >> detail::cell_bit(c, level.shift) & 1))
        empty = {level.shift, siblings};
      else if (level.words == 0)
        break;
    }
    if (empty.shift > 0) return empty;
    const std::uint64_t key = detail::packed_cell(c, 2 * height_);
    if (key != place.key) {
      place.key = key;
      place.root = root(key);
    }
    if (place.root == nothing) return {2 * height_, ~std::uint64_t{0}};  // all around occupied
    place.brick = place.root;
    if (height_ == 1) return {};
    const std::uint64_t mask = block_masks_[place.root];
    const unsigned bit = detail::cell_bit(c, 2);
    if (!(mask >> bit & 1)) return {2, mask};
    place.brick = block_first_[place.root] + bits_below(mask, bit);
    return {};
  }

  Box bounds_;
  Vec3 corner_{};
  double edge_ = 1;
  LatticeCell extent_{};  ///< extent [cells]
  std::uint32_t size_ = 0;
  std::int32_t height_ = 1;  ///< 1 for bricks as roots, 2 for blocks
  std::array<detail::VoxelLevel, 10> levels_{};
  std::size_t level_count_ = 0;
  SharedArray<std::uint64_t> keys_;   ///< positions of the roots
  SharedArray<std::uint32_t> slots_;  ///< hash table of root numbers
  SharedArray<std::uint64_t> block_masks_;
  SharedArray<std::uint32_t> block_first_;
  SharedArray<std::uint64_t> brick_masks_;
  SharedArray<std::uint32_t> brick_first_;
  SharedArray<std::uint64_t> pyramid_;
};

}  // namespace PULSECAST_NAMESPACE

#endif
