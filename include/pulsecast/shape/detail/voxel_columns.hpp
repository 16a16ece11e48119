// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SHAPE_DETAIL_VOXEL_COLUMNS_HPP
#define PULSECAST_SHAPE_DETAIL_VOXEL_COLUMNS_HPP

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include <pulsecast/base/shared_array.hpp>
#include <pulsecast/base/vector.hpp>

/// Columns of a voxel grid: numbers for each voxel, in the order of the index.
namespace PULSECAST_NAMESPACE::detail {

/// Three numbers from -1 to 1, each within 5e-7; -1, 0 and 1 are exact.
class PackedVector {
 public:
  PackedVector() = default;
  explicit PackedVector(const std::array<float, 3>& v) noexcept {
    for (const float x : v)
      bits_ = bits_ << 21 | static_cast<std::uint64_t>(std::lround(std::clamp(x, -1.0F, 1.0F) * steps) + middle);
  }

  [[nodiscard]] Vec3 unpacked() const noexcept { return {part(42), part(21), part(0)}; }

 private:
  static constexpr double steps = 1048575;
  static constexpr std::int64_t middle = 1048576;

  double part(int shift) const noexcept {
    return static_cast<double>(static_cast<std::int64_t>(bits_ >> shift & 0x1FFFFF) - middle) / steps;
  }

  std::uint64_t bits_ = 0;
};

/// Reorders and converts a column of the data; empty for an empty column.
template <class To, class From>
[[nodiscard]] SharedArray<To> reordered(const std::vector<From>& column, std::span<const std::uint32_t> order) {
  std::vector<To> kept;
  if (column.empty()) return kept;
  kept.reserve(order.size());
  for (const std::uint32_t i : order) kept.push_back(To(column[i]));
  return kept;
}

}  // namespace PULSECAST_NAMESPACE::detail

#endif
