// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_COPC_OCTREE_HPP
#define PULSECAST_IO_DETAIL_COPC_OCTREE_HPP

#include <array>
#include <bit>
#include <compare>
#include <cstring>

#include <pulsecast/base/namespace.hpp>

/// Octree of a COPC file, in whole steps of the stored coordinates. Sides are powers of two; borders are half a step
/// below whole steps, so no point is on one. Source of the keys: https://copc.io, COPC 1.0, hierarchy VLR.
namespace PULSECAST_NAMESPACE::io::detail {

/// Key of a point, and its number. In the order of keys, and of numbers among equal keys.
struct CopcRank {
  std::uint64_t key = 0;
  std::uint32_t number = 0;

  friend auto operator<=>(const CopcRank&, const CopcRank&) = default;
};

/// Place in the space of stored coordinates, shifted by 2^31: from 0 to 2^32 - 1 for points.
using CopcPlace = std::array<std::int64_t, 3>;

/// Place of a point record.
[[nodiscard]] inline CopcPlace copc_place(const std::byte* record) noexcept {
  std::array<std::int32_t, 3> stored{};
  std::memcpy(stored.data(), record, sizeof stored);
  CopcPlace place{};
  for (std::size_t axis = 0; axis < 3; ++axis) place[axis] = std::int64_t{stored[axis]} + (std::int64_t{1} << 31);
  return place;
}

inline constexpr unsigned copc_grid_bits = 7;  ///< a node has 128 cells an axis, of at most a point each but in leaves
inline constexpr unsigned copc_morton_bits = 21;  ///< bits of an axis in a Morton number

/// Spreads the lowest 21 bits of a number: bit i becomes bit 3i.
[[nodiscard]] constexpr std::uint64_t copc_spread(std::uint64_t v) noexcept {
  v &= 0x1FFFFF;
  v = (v | v << 32) & 0x1F00000000FFFF;
  v = (v | v << 16) & 0x1F0000FF0000FF;
  v = (v | v << 8) & 0x100F00F00F00F00F;
  v = (v | v << 4) & 0x10C30C30C30C30C3;
  return (v | v << 2) & 0x1249249249249249;
}

/// Inverse of `copc_spread`: bit 3i becomes bit i.
[[nodiscard]] constexpr std::uint64_t copc_compact(std::uint64_t v) noexcept {
  v &= 0x1249249249249249;
  v = (v | v >> 2) & 0x10C30C30C30C30C3;
  v = (v | v >> 4) & 0x100F00F00F00F00F;
  v = (v | v >> 8) & 0x1F0000FF0000FF;
  v = (v | v >> 16) & 0x1F00000000FFFF;
  return (v | v >> 32) & 0x1FFFFF;
}

/// Morton number of a place, of up to 21 bits an axis.
[[nodiscard]] constexpr std::uint64_t copc_morton(const CopcPlace& p) noexcept {
  return copc_spread(static_cast<std::uint64_t>(p[0])) | copc_spread(static_cast<std::uint64_t>(p[1])) << 1 |
         copc_spread(static_cast<std::uint64_t>(p[2])) << 2;
}

/// Place of a Morton number.
[[nodiscard]] constexpr CopcPlace copc_place_of(std::uint64_t morton) noexcept {
  return {static_cast<std::int64_t>(copc_compact(morton)), static_cast<std::int64_t>(copc_compact(morton >> 1)),
          static_cast<std::int64_t>(copc_compact(morton >> 2))};
}

/// Squared distance of a place from the centre of its aligned cube of side 2^bits, in half steps.
[[nodiscard]] constexpr std::uint64_t copc_off_centre(const CopcPlace& place, unsigned bits) noexcept {
  std::uint64_t sum = 0;
  for (const std::int64_t p : place) {
    const std::int64_t within = p & ((std::int64_t{1} << bits) - 1), off = 2 * within + 1 - (std::int64_t{1} << bits);
    sum += static_cast<std::uint64_t>(off * off);
  }
  return sum;
}

/// Name of a node: level and place among those of its level.
struct CopcKey {
  std::int32_t level = 0, x = 0, y = 0, z = 0;

  friend bool operator==(const CopcKey&, const CopcKey&) = default;

  [[nodiscard]] constexpr CopcKey parent() const noexcept { return {level - 1, x >> 1, y >> 1, z >> 1}; }
  [[nodiscard]] constexpr CopcKey ancestor(std::int32_t of_level) const noexcept {
    const int up = level - of_level;
    return {of_level, x >> up, y >> up, z >> up};
  }
  /// Child of a Morton number from 0 to 7.
  [[nodiscard]] constexpr CopcKey child(unsigned i) const noexcept {
    return {level + 1, 2 * x + static_cast<std::int32_t>(i & 1U), 2 * y + static_cast<std::int32_t>(i >> 1 & 1U),
            2 * z + static_cast<std::int32_t>(i >> 2 & 1U)};
  }
};

/// True if a node comes before another from the root down: parents before children, these by Morton numbers.
[[nodiscard]] constexpr bool copc_before(const CopcKey& a, const CopcKey& b) noexcept {
  const std::int32_t level = a.level < b.level ? a.level : b.level;
  const CopcKey p = a.ancestor(level), q = b.ancestor(level);
  const std::array<std::uint32_t, 3> other{static_cast<std::uint32_t>(p.z ^ q.z), static_cast<std::uint32_t>(p.y ^ q.y),
                                           static_cast<std::uint32_t>(p.x ^ q.x)};
  std::size_t first = 0;  // axis of the highest bit that differs
  for (std::size_t i = 1; i < 3; ++i)
    if (std::bit_width(other[i]) > std::bit_width(other[first])) first = i;
  if (other[first] == 0) return a.level < b.level;
  return first == 0 ? p.z < q.z : first == 1 ? p.y < q.y : p.x < q.x;
}

/// Cube of the root.
struct CopcRoot {
  CopcPlace corner{};  ///< least place within
  unsigned bits = 0;   ///< its side is 2^bits steps

  /// Least place within a node.
  [[nodiscard]] constexpr CopcPlace corner_of(const CopcKey& key) const noexcept {
    const unsigned b = bits_of(key);
    return {corner[0] + (std::int64_t{key.x} << b), corner[1] + (std::int64_t{key.y} << b),
            corner[2] + (std::int64_t{key.z} << b)};
  }
  /// Side of a node, as that of the root.
  [[nodiscard]] constexpr unsigned bits_of(const CopcKey& key) const noexcept {
    return bits - static_cast<unsigned>(key.level);
  }
};

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
