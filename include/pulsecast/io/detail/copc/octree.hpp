// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_COPC_OCTREE_HPP
#define PULSECAST_IO_DETAIL_COPC_OCTREE_HPP

#include <array>
#include <bit>
#include <compare>
#include <cstring>

#include <pulsecast/base/namespace.hpp>

/// Octree of a COPC file, in steps of the stored coordinates. Sides are powers of two; borders are
/// half a step below whole steps, so no point is on one. Source: copc.io, COPC 1.0, hierarchy VLR.
namespace PULSECAST_NAMESPACE::io::detail {

/// Key of a point, and its number. In the order of keys, and of numbers among equal keys.
struct CopcRank {
  std::uint64_t key = 0;
  std::uint32_t number = 0;

  friend auto operator<=>(const CopcRank&, const CopcRank&) = default;
};

/// Place in the space of stored coordinates, shifted by 2^31: from 0 to 2^32 - 1 for points.
using CopcPlace = std::array<std::int64_t, 3>;

[[nodiscard]] inline CopcPlace copc_place(const std::byte* record) noexcept {
  std::array<std::int32_t, 3> stored{};
  std::memcpy(stored.data(), record, sizeof stored);
  CopcPlace place{};
  for (std::size_t axis = 0; axis < 3; ++axis) place[axis] = stored[axis] + (std::int64_t{1} << 31);
  return place;
}

inline constexpr unsigned copc_grid_bits = 7;     ///< a node has 128 cells an axis
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
  std::uint64_t morton = 0;
  for (unsigned k = 0; k < 3; ++k) morton |= copc_spread(static_cast<std::uint64_t>(p[k])) << k;
  return morton;
}

[[nodiscard]] constexpr CopcPlace copc_place_of(std::uint64_t morton) noexcept {
  CopcPlace place{};
  for (unsigned k = 0; k < 3; ++k) place[k] = static_cast<std::int64_t>(copc_compact(morton >> k));
  return place;
}

/// Squared distance of a place from the centre of its aligned cube of side 2^bits, in half steps.
[[nodiscard]] constexpr std::uint64_t copc_off_centre(const CopcPlace& place, unsigned bits) noexcept {
  std::uint64_t sum = 0;
  const std::int64_t side = std::int64_t{1} << bits;
  for (const std::int64_t p : place) {
    const std::int64_t off = 2 * (p & (side - 1)) + 1 - side;
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
    const auto n = static_cast<std::int32_t>(i);
    return {level + 1, 2 * x + (n & 1), 2 * y + (n >> 1 & 1), 2 * z + (n >> 2 & 1)};
  }
};

/// Order of nodes: parents before children, these by Morton numbers.
[[nodiscard]] constexpr bool copc_before(const CopcKey& a, const CopcKey& b) noexcept {
  const std::int32_t level = a.level < b.level ? a.level : b.level;
  const CopcKey p = a.ancestor(level), q = b.ancestor(level);
  const std::array of_a{p.z, p.y, p.x}, of_b{q.z, q.y, q.x};
  const auto other = [&](std::size_t i) { return std::bit_width(static_cast<std::uint32_t>(of_a[i] ^ of_b[i])); };
  std::size_t first = 0;  // axis of the highest bit that differs
  for (std::size_t i = 1; i < 3; ++i)
    if (other(i) > other(first)) first = i;
  return other(first) == 0 ? a.level < b.level : of_a[first] < of_b[first];
}

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
