// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <compare>
#include <cstdint>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "support/laz_reader.hpp"

/// Reads COPC files by the rules of https://copc.io, and checks what the rules demand and the library promises: plain
/// and slow, written for the tests; shares nothing with the writer. Throws `std::runtime_error` at the first thing that
/// is not as it should be.
namespace pulsecast::support {

/// A node's name.
struct CopcName {
  std::int32_t level = 0, x = 0, y = 0, z = 0;
  friend auto operator<=>(const CopcName&, const CopcName&) = default;
  [[nodiscard]] CopcName above() const { return {level - 1, x / 2, y / 2, z / 2}; }
  [[nodiscard]] bool is_below(const CopcName& other) const {
    return *this == other || (level > other.level && above().is_below(other));
  }
};

/// A node: its point records, one behind another.
struct CopcReadNode {
  std::size_t points = 0;
  std::uint64_t offset = 0;  ///< of its chunk [byte]
  std::string records;
  bool is_leaf = true;
};

struct CopcFile {
  std::array<double, 3> centre{};
  double half = 0, spacing = 0, first_time = 0, last_time = 0;
  std::map<CopcName, CopcReadNode> nodes;
  std::size_t pages = 0;
  std::size_t record = 0;  ///< its size [byte]
  std::string las;         ///< the LAS file of the same points, in the order of the chunks

  [[nodiscard]] std::size_t levels() const {
    return nodes.empty() ? 0 : static_cast<std::size_t>(nodes.rbegin()->first.level) + 1;
  }
  [[nodiscard]] std::vector<std::string> records() const {
    std::vector<std::string> all;
    for (const auto& [name, node] : nodes)
      for (std::size_t i = 0; i < node.points; ++i) all.push_back(node.records.substr(i * record, record));
    return all;
  }
};

namespace detail {

class CopcReader {
 public:
  explicit CopcReader(const std::string& bytes) : bytes_(bytes) {}

  [[nodiscard]] CopcFile read() {
    laz_expect(bytes_.substr(0, 4) == "LASF" && whole(94, 2) == 375, "signature and header");
    format_ = whole(104, 1) - 128;
    laz_expect(format_ >= 6 && format_ <= 8, "point format");
    file_.record = whole(105, 2);
    read_info();
    read_records();
    read_table();
    read_hierarchy();
    for (auto& [name, node] : file_.nodes) read_node(name, node);
    laz_expect(chunks_.empty(), "a chunk without node");
    laz_expect(points_ == whole(247, 8), "number of points");
    if (points_ > 0) laz_expect(file_.first_time == first_ && file_.last_time == last_, "times");
    return std::move(file_);
  }

 private:
  [[nodiscard]] std::uint64_t whole(std::size_t at, std::size_t n) const { return laz_whole(bytes_, at, n); }
  [[nodiscard]] double real(std::size_t at) const { return std::bit_cast<double>(whole(at, 8)); }
  [[nodiscard]] std::int32_t number(std::size_t at) const { return static_cast<std::int32_t>(whole(at, 4)); }

  void read_info() {
    laz_expect(bytes_.substr(377, 5) == std::string("copc\0", 5) && whole(393, 2) == 1 && whole(395, 2) == 160,
               "the info record is the first");
    const std::size_t at = 375 + 54;
    for (std::size_t axis = 0; axis < 3; ++axis) file_.centre[axis] = real(at + 8 * axis);
    file_.half = real(at + 24);
    file_.spacing = real(at + 32);
    root_at_ = whole(at + 40, 8);
    root_size_ = whole(at + 48, 8);
    file_.first_time = real(at + 56);
    file_.last_time = real(at + 64);
    for (std::size_t i = 72; i < 160; ++i) laz_expect(whole(at + i, 1) == 0, "reserved bytes");
    laz_expect(std::fabs(file_.spacing * 64 / file_.half - 1) < 1e-12, "spacing of 128 cells");
  }

  void read_records() {
    file_.las = bytes_.substr(0, 375);
    std::size_t at = 375, described = 0;
    const std::size_t count = whole(100, 4);
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t size = 54 + whole(at + 20, 2);
      const std::string user = bytes_.substr(at + 2, 15);
      if (user == std::string("laszip encoded\0", 15)) {
        ++described;
        check_laz_record(bytes_, at, 0xFFFFFFFF);
      } else if (i > 0) {
        file_.las += bytes_.substr(at, size);
      }
      at += size;
    }
    begin_ = whole(96, 4);
    laz_expect(described == 1 && at == begin_, "records of variable length");
    file_.las[104] = static_cast<char>(format_);
    const auto put = [&](std::size_t place, std::size_t value, std::size_t n) {
      for (std::size_t i = 0; i < n; ++i) file_.las[place + i] = static_cast<char>(i < 8 ? value >> (8 * i) : 0);
    };
    put(96, file_.las.size(), 4);
    put(100, count - 2, 4);
    put(235, 0, 8);
    put(243, 0, 4);
  }

  /// The table of the chunks, which lie one behind another.
  void read_table() {
    const std::size_t table = whole(begin_, 8), count = whole(table + 4, 4);
    laz_expect(whole(table, 4) == 0 && whole(243, 4) == 1, "version of the chunk table, and one extended record");
    extended_ = whole(235, 8);
    std::uint64_t at = begin_ + 8;
    if (count > 0) {
      LazDecoder decoder(bytes_.substr(table + 8, extended_ - table - 8));
      LazNumbers numbers(32);
      std::int64_t points = 0, size = 0;
      for (std::size_t i = 0; i < count; ++i) {
        points = numbers.decode(decoder, points, 0);
        size = numbers.decode(decoder, size, 1);
        laz_expect(points > 0 && size > 0, "an empty chunk");
        chunks_[at] = {static_cast<std::uint64_t>(points), static_cast<std::uint64_t>(size)};
        at += static_cast<std::uint64_t>(size);
      }
      laz_expect(decoder.at_end(), "something is behind the chunk table");
    } else {
      laz_expect(table + 8 == extended_, "something is behind an empty chunk table");
    }
    laz_expect(at == table, "the chunks end where their table begins");
  }

  void read_hierarchy() {
    laz_expect(bytes_.substr(extended_ + 2, 5) == std::string("copc\0", 5) && whole(extended_ + 18, 2) == 1000,
               "hierarchy record");
    laz_expect(extended_ + 60 + whole(extended_ + 20, 8) == bytes_.size(), "the hierarchy ends where the file does");
    laz_expect(root_at_ == extended_ + 60, "the first page is the first");
    read_page(root_at_, root_size_, {});
    std::uint64_t end = extended_ + 60;
    for (const auto& [begin, size] : pages_) {
      laz_expect(begin == end, "pages lie one behind another");
      end = begin + size;
    }
    laz_expect(end == bytes_.size(), "a page that cannot be reached");
    file_.pages = pages_.size();
    for (auto& [name, node] : file_.nodes) {
      if (name.level == 0) continue;
      const auto above = file_.nodes.find(name.above());
      laz_expect(above != file_.nodes.end(), "a node without parent");
      above->second.is_leaf = false;
    }
    for (const auto& [name, node] : file_.nodes)
      laz_expect(node.points > 0 || !node.is_leaf || whole(247, 8) == 0, "a leaf without points");
  }

  void read_page(std::uint64_t at, std::uint64_t size, const CopcName& root) {
    laz_expect(size % 32 == 0 && size > 0 && at + size <= bytes_.size() && pages_.emplace(at, size).second, "page");
    for (std::uint64_t e = at; e < at + size; e += 32) {
      const CopcName name{number(e), number(e + 4), number(e + 8), number(e + 12)};
      const std::uint64_t offset = whole(e + 16, 8);
      const std::int32_t bytes = number(e + 24), points = number(e + 28);
      laz_expect(e > at || name == root, "a page begins with its root");
      laz_expect(name.is_below(root), "a page lists what is below its root");
      for (const std::int32_t c : {name.x, name.y, name.z})
        laz_expect(c >= 0 && (name.level == 31 || c >> name.level == 0), "name of a node");
      if (points == -1) {
        read_page(offset, static_cast<std::uint64_t>(bytes), name);
        continue;
      }
      laz_expect(points >= 0 && (points > 0 || (offset == 0 && bytes == 0)), "entry");
      laz_expect(file_.nodes.emplace(name, CopcReadNode{static_cast<std::size_t>(points), offset, {}, true}).second,
                 "a node comes twice");
      if (points == 0) continue;
      const auto chunk = chunks_.find(offset);
      laz_expect(chunk != chunks_.end() && chunk->second == std::pair(std::uint64_t(points), std::uint64_t(bytes)),
                 "chunk of a node");
    }
  }

  /// Reads the points of a node, all of which are within its cube.
  void read_node(const CopcName& name, CopcReadNode& node) {
    if (node.points == 0) return;
    const LazReadChunk chunk = read_laz_chunk(bytes_, node.offset, file_.record,
                                              format_ == 7   ? 6
                                              : format_ == 8 ? 8
                                                             : 0);
    laz_expect(chunk.points == node.points && chunk.size == chunks_.at(node.offset).second, "size of a chunk");
    chunks_.erase(node.offset);
    node.records = chunk.records;
    points_ += node.points;
    const double side = std::ldexp(2 * file_.half, -name.level);
    const std::array<std::int32_t, 3> place{name.x, name.y, name.z};
    for (std::size_t i = 0; i < node.points; ++i) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double c =
            static_cast<std::int32_t>(laz_whole(node.records, i * file_.record + 4 * axis, 4)) * real(131 + 8 * axis) +
            real(155 + 8 * axis);
        const double low = file_.centre[axis] - file_.half + place[axis] * side;
        laz_expect(c >= low && c < low + side, "a point outside its node");
      }
      const double time = std::bit_cast<double>(laz_whole(node.records, i * file_.record + 22, 8));
      first_ = std::fmin(first_, time);
      last_ = std::fmax(last_, time);
    }
    file_.las += node.records;
  }

  const std::string& bytes_;
  CopcFile file_;
  std::size_t format_ = 0, begin_ = 0, extended_ = 0, points_ = 0;
  std::uint64_t root_at_ = 0, root_size_ = 0;
  std::map<std::uint64_t, std::pair<std::uint64_t, std::uint64_t>>
      chunks_;                                    ///< points and size, by offset, of those not yet read
  std::map<std::uint64_t, std::uint64_t> pages_;  ///< sizes, by offset
  double first_ = std::numeric_limits<double>::infinity(), last_ = -std::numeric_limits<double>::infinity();
};

}  // namespace detail

/// Reads a COPC file: every page, every node and every point.
[[nodiscard]] inline CopcFile read_copc(const std::string& bytes) { return detail::CopcReader(bytes).read(); }

/// Checks that each node but a leaf has at most one point in each of its 128^3 cells, and that wherever a point lies,
/// all of its cells down to those of its node have a point, of the cell's node or one above: levels are even samples. A
/// leaf has at most `leaf_points`, unless its cells are a step or less.
inline void check_even_samples(const CopcFile& file, std::size_t leaf_points) {
  using detail::laz_expect;
  const std::string& head = file.las;
  const auto real = [&](std::size_t at) { return std::bit_cast<double>(detail::laz_whole(head, at, 8)); };
  using Cell = std::array<std::int64_t, 3>;
  const auto cell_at = [&](const std::string& record, std::int32_t level) {
    Cell cell{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double c = static_cast<std::int32_t>(detail::laz_whole(record, 4 * axis, 4)) * real(131 + 8 * axis) +
                       real(155 + 8 * axis);
      cell[axis] = static_cast<std::int64_t>(
          std::floor((c - (file.centre[axis] - file.half)) / std::ldexp(file.spacing, -level)));
    }
    return cell;
  };
  const auto each = [&](const auto& task) {
    for (const auto& [name, node] : file.nodes)
      for (std::size_t i = 0; i < node.points; ++i) task(name, node, node.records.substr(i * file.record, file.record));
  };
  std::map<std::int32_t, std::set<Cell>> known;  // cells of a level with a point down to it
  each([&](const CopcName& name, const CopcReadNode&, const std::string& record) {
    for (std::int32_t level = name.level; level < std::int32_t(file.levels()); ++level)
      known[level].insert(cell_at(record, level));
  });
  std::map<CopcName, std::set<Cell>> own;
  each([&](const CopcName& name, const CopcReadNode&, const std::string& record) {
    own[name].insert(cell_at(record, name.level));
    for (std::int32_t level = 0; level < name.level; ++level)
      laz_expect(known[level].contains(cell_at(record, level)), "a cell with points has none in its node or above");
  });
  for (const auto& [name, node] : file.nodes) {
    const bool even = node.points == own[name].size(),
               in_one_place = std::ldexp(file.spacing, -name.level) < 1.5 * real(131);
    laz_expect(even || node.is_leaf, "two points of a node in one cell");
    laz_expect(even || node.points <= leaf_points || in_one_place, "too many points in a leaf");
  }
}

}  // namespace pulsecast::support
