// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

namespace pulsecast::detail {

/// Index of the first of `count` elements for which `before(i)` is false, by binary search. Requires a partition: true, then false.
/// Compiles in a fraction of the time of std::lower_bound.
template <class Before>
[[nodiscard]] constexpr std::size_t first_not(std::size_t count, const Before& before) noexcept {
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

}  // namespace pulsecast::detail
