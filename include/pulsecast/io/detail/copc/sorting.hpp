// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_COPC_SORTING_HPP
#define PULSECAST_IO_DETAIL_COPC_SORTING_HPP

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <pulsecast/base/namespace.hpp>

namespace PULSECAST_NAMESPACE::io::detail {

/// Key of a point, and its number.
struct CopcRank {
  std::uint64_t key = 0;
  std::uint32_t number = 0;
};

/// Sorts by key, and by number among equal keys. Many ranks are sorted digit by digit, by those digits that differ.
inline void copc_sort(std::vector<CopcRank>& ranks) {
  const auto before = [](const CopcRank& a, const CopcRank& b) {
    return a.key != b.key ? a.key < b.key : a.number < b.number;
  };
  if (ranks.size() < 4096) return std::sort(ranks.begin(), ranks.end(), before);
  constexpr unsigned digit = 11;
  std::uint64_t differ = 0;
  for (const CopcRank& rank : ranks) differ |= rank.key ^ ranks[0].key;
  std::vector<CopcRank> sorted(ranks.size());
  for (unsigned shift = 0; shift < 64 && differ >> shift != 0; shift += digit) {
    constexpr std::uint64_t mask = (1U << digit) - 1;
    if ((differ >> shift & mask) == 0) continue;
    std::array<std::uint32_t, mask + 1> begin{};
    for (const CopcRank& rank : ranks) ++begin[rank.key >> shift & mask];
    std::uint32_t sum = 0;
    for (std::uint32_t& b : begin) sum += std::exchange(b, sum);
    for (const CopcRank& rank : ranks) sorted[begin[rank.key >> shift & mask]++] = rank;
    ranks.swap(sorted);
  }
  for (auto same = ranks.begin(); same != ranks.end();) {
    const auto end = std::find_if(same, ranks.end(), [&](const CopcRank& rank) { return rank.key != same->key; });
    if (!std::is_sorted(same, end, before)) std::sort(same, end, before);
    same = end;
  }
}

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
