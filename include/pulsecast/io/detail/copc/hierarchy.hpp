// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_COPC_HIERARCHY_HPP
#define PULSECAST_IO_DETAIL_COPC_HIERARCHY_HPP

#include <algorithm>
#include <deque>
#include <utility>
#include <vector>

#include <pulsecast/io/detail/copc/octree.hpp>
#include <pulsecast/io/detail/las/bytes.hpp>

namespace PULSECAST_NAMESPACE::io::detail {

/// Entry: a node, or a page (`points` -1). Source: copc.io, COPC 1.0, hierarchy VLR.
struct CopcEntry {
  CopcKey key{};
  std::uint64_t offset = 0;  ///< offset of its chunk or page in the file, 0 without points [byte]
  std::int32_t size = 0;     ///< size of that [byte]
  std::int32_t points = 0;   ///< number of its points
};

inline constexpr std::size_t copc_entry_size = 32;  ///< [byte]

/// Hierarchy in pages: nodes of four levels and small subtrees below; others have pages after it.
class CopcHierarchy {
 public:
  /// `page_nodes` of a subtree that has no page of its own; at least one entry.
  CopcHierarchy(std::vector<CopcEntry> entries, std::size_t page_nodes)
      : entries_(std::move(entries)), page_nodes_(page_nodes) {
    std::ranges::sort(entries_, copc_before, &CopcEntry::key);
    ranges_.push_back({0, entries_.size()});
    for (std::size_t i = 0; i < ranges_.size(); ++i) list(ranges_[i]);  // ranges_ grows meanwhile
  }

  /// Size of the first page [byte].
  [[nodiscard]] std::size_t root_size() const noexcept { return pages_[0].size() * copc_entry_size; }

  /// Bytes of all pages, the root's first, for offset `begin` in the file.
  [[nodiscard]] std::vector<std::byte> bytes(std::uint64_t begin) const {
    std::vector<CopcEntry> places;  // of the pages
    for (const auto& page : pages_) {
      places.push_back({{}, begin, static_cast<std::int32_t>(page.size() * copc_entry_size), -1});
      begin += page.size() * copc_entry_size;
    }
    std::vector<std::byte> bytes;
    for (const auto& page : pages_)
      for (CopcEntry e : page) {
        if (e.points < 0) {
          const CopcEntry& place = places[static_cast<std::size_t>(e.offset)];
          e.offset = place.offset;
          e.size = place.size;
        }
        LasBytes<copc_entry_size> b{};
        b.put(0, e.key);
        b.put(16, e.offset);
        b.put(24, e.size);
        b.put(28, e.points);
        bytes.insert(bytes.end(), b.begin(), b.end());
      }
    return bytes;
  }

 private:
  static constexpr std::int32_t page_levels = 4;
  struct Range {
    std::size_t begin, end;  // entries of a subtree
  };

  void list(Range range) {
    std::vector<CopcEntry> page;
    const std::int32_t below = entries_[range.begin].key.level + page_levels;
    while (range.begin < range.end) {
      const CopcEntry& entry = entries_[range.begin];
      std::size_t end = range.begin + 1;
      if (entry.key.level == below)
        while (end < range.end && entries_[end].key.level > below) ++end;  // to the next
      if (entry.key.level == below && end - range.begin > page_nodes_) {
        page.push_back({entry.key, ranges_.size(), 0, -1});  // the number of its page, for now
        ranges_.push_back({range.begin, end});
      } else {
        page.insert(page.end(), &entry, &entry + (end - range.begin));
      }
      range.begin = end;
    }
    pages_.push_back(std::move(page));
  }

  std::vector<CopcEntry> entries_;
  std::size_t page_nodes_;
  std::deque<Range> ranges_;  // of the pages
  std::vector<std::vector<CopcEntry>> pages_;
};

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
