// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_BASE_SEARCH_HPP
#define PULSECAST_BASE_SEARCH_HPP

#include <pulsecast/base/namespace.hpp>

namespace PULSECAST_NAMESPACE::detail {

/// Index of the first of `count` elements for which `before(i)` is false, by binary search.
/// Requires a partition: true, then false. Compiles in a fraction of the time of std::lower_bound.
[[nodiscard]] constexpr std::size_t first_not(std::size_t count, const auto& before) noexcept {
  std::size_t first = 0;
  while (count > 0) {
    const std::size_t half = count / 2;
    if (before(first + half)) {
      first += half + 1;
      count -= half + 1;
    } else {
      count = half;
    }
  }
  return first;
}

/// Indices of the elements before and after a place; twice the outermost one if it is beyond.
struct Neighbours {
  std::size_t before, behind;
  friend bool operator==(const Neighbours&, const Neighbours&) = default;
};

/// Neighbours of a place in a table of `count` > 0 elements; `before(i)` is true before the place.
[[nodiscard]] constexpr Neighbours neighbours(std::size_t count, const auto& before) noexcept {
  const std::size_t i = first_not(count, before);
  return {i == 0 ? 0 : i - 1, i == count ? count - 1 : i};
}

/// Value at `x` in a table that ascends in the member `key`: linear between entries, else constant.
template <class Table, class Entry>
[[nodiscard]] constexpr double interpolated(const Table& table, double x, double Entry::*key,
                                            double Entry::*value) noexcept {
  const auto [i, k] = neighbours(table.size(), [&](std::size_t n) noexcept { return !(x < table[n].*key); });
  const Entry &a = table[i], &b = table[k];
  return i == k ? a.*value : a.*value + (b.*value - a.*value) * (x - a.*key) / (b.*key - a.*key);
}

}  // namespace PULSECAST_NAMESPACE::detail

#endif
