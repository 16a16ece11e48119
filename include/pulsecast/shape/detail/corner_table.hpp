// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SHAPE_DETAIL_CORNER_TABLE_HPP
#define PULSECAST_SHAPE_DETAIL_CORNER_TABLE_HPP

#include <array>
#include <bit>

#include <pulsecast/base/shared_array.hpp>
#include <pulsecast/base/vector.hpp>

namespace PULSECAST_NAMESPACE::detail {

/// Hash table of the unique corners of a block.
class CornerTable {
 public:
  explicit CornerTable(std::size_t triangles) : places_(std::bit_ceil(4 * triangles)) {
    std::fill(places_.begin(), places_.end(), nowhere);
    corners_.reserve(triangles);
  }

  [[nodiscard]] std::uint16_t number_of(const Vec3& corner) {
    const auto bits = std::bit_cast<Bits>(corner);
    // multiplicative hashing. Source: Knuth 1998, sec. 6.4
    std::uint64_t hash = 0;
    for (const std::uint64_t word : bits) hash = (hash ^ hash >> 32 ^ word) * 0x9E3779B97F4A7C15;
    for (std::size_t i = hash >> 32;; ++i) {
      std::uint16_t& place = places_[i & (places_.size() - 1)];
      if (place == nowhere) {
        place = static_cast<std::uint16_t>(corners_.size());
        corners_.push_back(corner);
      }
      if (std::bit_cast<Bits>(corners_[place]) == bits) return place;
    }
  }

  [[nodiscard]] std::vector<Vec3> corners() && noexcept { return std::move(corners_); }

 private:
  using Bits = std::array<std::uint64_t, 3>;
  static constexpr std::uint16_t nowhere = 0xFFFF;

  SharedBuffer<std::uint16_t> places_;
  std::vector<Vec3> corners_;
};

}  // namespace PULSECAST_NAMESPACE::detail

#endif
