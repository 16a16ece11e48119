// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SHAPE_DETAIL_VOXEL_KEYS_HPP
#define PULSECAST_SHAPE_DETAIL_VOXEL_KEYS_HPP

#include <array>

#include <pulsecast/shape/lattice_ray.hpp>

/// Keys, bits and hash slots of the cells of a lattice.
namespace PULSECAST_NAMESPACE::detail {

/// Greatest extent of a lattice along an axis [cells].
inline constexpr std::uint32_t max_lattice_extent = 1U << 21;

/// Position of a cell, after `shift` bits of its coordinates, among the 4 x 4 x 4 around it.
[[nodiscard]] inline unsigned cell_bit(const LatticeCell& c, int shift) noexcept {
  return static_cast<unsigned>((c[0] >> shift & 3) | (c[1] >> shift & 3) << 2 | (c[2] >> shift & 3) << 4);
}

/// Child at such a position, of a fourth of the edge.
[[nodiscard]] inline LatticeCell child_cell(const LatticeCell& c, unsigned place) noexcept {
  const auto p = static_cast<std::int32_t>(place);
  return {c[0] << 2 | (p & 3), c[1] << 2 | (p >> 2 & 3), c[2] << 2 | p >> 4};
}

/// Coordinates of a cell without `shift` bits each, in one number.
[[nodiscard]] inline std::uint64_t packed_cell(const LatticeCell& c, int shift) noexcept {
  return static_cast<std::uint64_t>(c[0] >> shift) | static_cast<std::uint64_t>(c[1] >> shift) << 21 |
         static_cast<std::uint64_t>(c[2] >> shift) << 42;
}

/// Inverse of `packed_cell`, of no shift.
[[nodiscard]] inline LatticeCell unpacked_cell(std::uint64_t key) noexcept {
  return {static_cast<std::int32_t>(key & (max_lattice_extent - 1)),
          static_cast<std::int32_t>(key >> 21 & (max_lattice_extent - 1)), static_cast<std::int32_t>(key >> 42)};
}

/// Slot of a key in a hash table. Source: multiplicative hashing by the golden ratio, Knuth 1973.
[[nodiscard]] inline std::size_t hash_slot(std::uint64_t key, std::size_t slots) noexcept {
  const std::uint64_t mixed = (key * 0x9E3779B97F4A7C15) >> 32;
  return static_cast<std::size_t>(mixed * slots >> 32);
}

/// Cubes of one size, a bit each, in words of 4 x 4 x 4. A level too large for direct indexing shares its words by a
/// hash; an unset bit still proves its cube empty.
struct VoxelLevel {
  std::uint64_t first = 0;                ///< first word
  std::uint64_t words = 0;                ///< words of a hashed level; 0 if indexed directly
  std::array<std::uint32_t, 2> extent{};  ///< words along x and y
  std::int32_t shift = 0;                 ///< log2 of the edge of a bit's cube [cells]
  std::int32_t unused = 0;                ///< makes all bytes of an archive definite

  [[nodiscard]] std::size_t word(const LatticeCell& c) const noexcept {
    const int word_shift = shift + 2;
    if (words > 0)
      return static_cast<std::size_t>(first) + hash_slot(packed_cell(c, word_shift), static_cast<std::size_t>(words));
    const auto x = static_cast<std::size_t>(c[0] >> word_shift), y = static_cast<std::size_t>(c[1] >> word_shift),
               z = static_cast<std::size_t>(c[2] >> word_shift);
    return static_cast<std::size_t>(first) + (z * extent[1] + y) * extent[0] + x;
  }
};

}  // namespace PULSECAST_NAMESPACE::detail

#endif
