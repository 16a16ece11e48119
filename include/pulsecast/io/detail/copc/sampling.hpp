// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_COPC_SAMPLING_HPP
#define PULSECAST_IO_DETAIL_COPC_SAMPLING_HPP

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <pulsecast/base/namespace.hpp>

namespace PULSECAST_NAMESPACE::io::detail {

/// Picks one point of each cell of a node: that nearest to the cell's centre, the first of several. The points are
/// those of the node's children, `counts` of each, in order of the cells: `cell(child, i)` is the cell of a point,
/// `off(child, i)` its distance from the centre. Returns the picked points of each child, ascending.
template <class CellOf, class OffOf>
[[nodiscard]] std::vector<std::vector<std::uint32_t>> copc_sample(std::span<const std::size_t> counts,
                                                                  const CellOf& cell, const OffOf& off) {
  std::vector<std::vector<std::uint32_t>> picked(counts.size());
  bool any = false;
  std::uint64_t now = 0, least = 0;
  for (std::size_t child = 0; child < counts.size(); ++child)
    for (std::uint32_t i = 0; i < counts[child]; ++i) {  // a cell never spans two children
      const std::uint64_t of = cell(child, i), distance = off(child, i);
      if (!any || of != now) {
        picked[child].push_back(i);
      } else if (distance < least) {
        picked[child].back() = i;
      } else {
        continue;
      }
      any = true;
      now = of;
      least = distance;
    }
  return picked;
}

/// Calls take(i) for the picked of `count` points, and leave(i) for the others, in order.
template <class Take, class Leave>
void copc_part(std::size_t count, std::span<const std::uint32_t> picked, const Take& take, const Leave& leave) {
  std::size_t next = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    if (next < picked.size() && picked[next] == i) {
      take(i);
      ++next;
    } else {
      leave(i);
    }
  }
}

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
