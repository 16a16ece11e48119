// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_COPC_TREE_HPP
#define PULSECAST_IO_DETAIL_COPC_TREE_HPP

#include <pulsecast/io/detail/copc/hierarchy.hpp>
#include <pulsecast/io/detail/copc/plan.hpp>
#include <pulsecast/io/detail/copc/subtree.hpp>
#include <pulsecast/io/detail/las/settings.hpp>
#include <pulsecast/io/detail/laz/chunk.hpp>

namespace PULSECAST_NAMESPACE::io::detail {

/// Writes the nodes of a plan as chunks of a file. Blocks are built in parallel and written in
/// order, nodes above them when all below are. Points of a chunk are in order of time.
class CopcTree {
 public:
  using Change = std::function<void(std::span<std::byte>)>;

  /// `change` is called on all records once read; it may be empty.
  CopcTree(OutputFile& file, const LasLayout& layout, unsigned threads, const CopcSizes& sizes, Change change)
      : file_(file),
        record_(layout.record()),
        colour_(layout.colour_size),
        threads_(threads),
        sizes_(sizes),
        change_(std::move(change)) {}

  /// Writes all. @throws FileError
  void write(const CopcRuns& runs, const CopcPlan& plan) {
    write_below(runs, plan);
    for (const OpenNode& root : open_) put(chunk_of(root));
    open_ = {};
  }

  [[nodiscard]] std::vector<CopcEntry>& entries() noexcept { return entries_; }  ///< nodes
  /// Sizes [byte] and points of the chunks.
  [[nodiscard]] const std::vector<std::size_t>& sizes() const noexcept { return chunk_sizes_; }
  [[nodiscard]] const std::vector<std::uint32_t>& points() const noexcept { return chunk_points_; }

 private:
  /// Compressed node; without bytes if it has no point, but nodes below it have.
  struct Chunk {
    CopcKey key{};
    std::size_t points = 0;
    std::vector<std::byte> bytes{};
    bool has_children = false;
  };
  /// Node from which its parent has not yet picked. Its records are in order of the cells.
  struct OpenNode {
    CopcKey key{};
    bool has_children = false;
    std::vector<std::byte> records{};
  };
  struct Built {
    std::vector<Chunk> chunks{};
    OpenNode root{};
  };

  /// Writes what is below the node that is divided, and leaves it open.
  void write_below(const CopcRuns& runs, const CopcPlan& plan) {
    const std::span<const CopcBlock> blocks = plan.blocks();
    const std::uint64_t at_once = std::uint64_t{threads_ + 3} * sizes_.block_points;
    const auto dense = [&](const CopcBlock& block) {
      return block.points > sizes_.block_points && runs.bits() > CopcRuns::least_bits;
    };
    for (std::size_t first = 0, end = 0; first < blocks.size(); first = end) {
      if (dense(blocks[first])) {
        write_dense(runs, plan.root(), blocks[first]);
        close_above(plan, end++);
        continue;
      }
      for (std::uint64_t points = 0; end < blocks.size() && !dense(blocks[end]); ++end) {
        points += blocks[end].points;
        if (end > first && points > at_once) break;
      }
      std::vector<Built> built(end - first);
      const auto build_one = [&](std::size_t i) { built[i] = build(runs, plan.root(), blocks[first + i]); };
      for_each_index(built.size(), threads_, build_one);
      for (std::size_t i = first; i < end; ++i) {
        put(std::exchange(built[i - first], {}));
        close_above(plan, i);
      }
    }
  }

  /// Writes what is below a block of a cell with more points than others, by smaller cells.
  void write_dense(const CopcRuns& runs, const CopcRoot& root, const CopcBlock& block) {
    const CopcRuns finer = runs.finer(block.extents);
    if (finer.bits() < runs.bits()) return write_below(finer, CopcPlan(finer, sizes_, root, block.key));
    put(build(runs, root, block));
  }

  /// Picks the points of the nodes above a block that have no block to come.
  void close_above(const CopcPlan& plan, std::size_t i) {
    const std::span<const CopcBlock> blocks = plan.blocks();
    for (std::int32_t level = blocks[i].key.level; level-- > plan.top().level;) {
      const CopcKey above = blocks[i].key.ancestor(level);
      if (i + 1 < blocks.size())
        if (const CopcKey& next = blocks[i + 1].key; next.level > level && next.ancestor(level) == above) return;
      merge(plan.root(), above);
    }
  }

  [[nodiscard]] Built build(const CopcRuns& runs, const CopcRoot& root, const CopcBlock& block) const {
    std::vector<std::byte> records = runs.read(block.extents);
    if (change_) change_(records);
    CopcSubtree subtree(records, record_, root, block.key, sizes_.leaf_points);
    Built built;
    for (CopcNode& node : subtree.nodes()) {
      if (node.key == block.key) {
        built.root = {node.key, node.has_children, {}};
        built.root.records.reserve(node.points.size() * record_);
        for (const std::uint32_t point : node.points) append(built.root.records, records, point);
      } else {
        built.chunks.push_back(chunk_of(node.key, node.has_children, records, node.points));
      }
      node.points = {};
    }
    return built;
  }

  void append(std::vector<std::byte>& to, std::span<const std::byte> records, std::size_t point) const {
    const auto bytes = records.subspan(point * record_, record_);
    to.insert(to.end(), bytes.begin(), bytes.end());
  }

  [[nodiscard]] Chunk chunk_of(const OpenNode& node) const {
    std::vector<std::uint32_t> points(node.records.size() / record_);
    std::iota(points.begin(), points.end(), 0U);
    return chunk_of(node.key, node.has_children, node.records, points);
  }

  [[nodiscard]] Chunk chunk_of(const CopcKey& key, bool has_children, std::span<const std::byte> records,
                               std::span<const std::uint32_t> points) const {
    Chunk chunk{key, points.size(), {}, has_children};
    if (points.empty()) return chunk;
    std::vector<CopcRank> ranks;
    ranks.reserve(points.size());
    for (const std::uint32_t point : points) ranks.push_back({time_key(records.data() + point * record_), point});
    std::sort(ranks.begin(), ranks.end());
    std::vector<std::byte> sorted(points.size() * record_);
    for (std::size_t i = 0; i < ranks.size(); ++i)
      std::memcpy(sorted.data() + i * record_, records.data() + ranks[i].number * record_, record_);
    chunk.bytes = LazChunk(sorted, record_, colour_).compressed();
    return chunk;
  }

  /// Number in the order of the times. Offset: LAS 1.4 R15, Point Data Record Format 6.
  [[nodiscard]] static std::uint64_t time_key(const std::byte* record) noexcept {
    std::uint64_t bits = 0;
    std::memcpy(&bits, record + 22, sizeof bits);
    return bits >> 63 != 0 ? ~bits : bits | std::uint64_t{1} << 63;
  }

  /// Picks the points of a node from its children, the last of the open nodes, and writes these.
  void merge(const CopcRoot& root, const CopcKey& key) {
    std::size_t first = open_.size();
    while (first > 0 && open_[first - 1].key.parent() == key) --first;
    const std::span<OpenNode> children = std::span(open_).subspan(first);
    const CopcPlace corner = root.corner_of(key);
    const unsigned cell_bits = root.bits_of(key) - copc_grid_bits;
    const auto place = [&](std::size_t child, std::uint32_t i) {
      CopcPlace p = copc_place(children[child].records.data() + i * record_);
      for (std::size_t axis = 0; axis < 3; ++axis) p[axis] -= corner[axis];
      return p;
    };
    const auto cell = [&](std::size_t child, std::uint32_t i) {
      CopcPlace p = place(child, i);
      for (std::int64_t& c : p) c >>= cell_bits;
      return copc_morton(p);
    };
    std::vector<std::size_t> counts;
    for (const OpenNode& child : children) counts.push_back(child.records.size() / record_);
    const auto off = [&](auto child, auto i) { return copc_off_centre(place(child, i), cell_bits); };
    const auto picked = copc_sample(counts, cell, off);

    OpenNode node{key, false, {}};
    std::vector<Chunk> chunks(children.size());
    for (std::size_t child = 0; child < children.size(); ++child) {
      OpenNode& below = children[child];
      std::byte* const records = below.records.data();
      std::size_t left = 0;
      const auto take = [&](auto i) { append(node.records, below.records, i); };
      const auto leave = [&](auto i) { std::memmove(records + left++ * record_, records + i * record_, record_); };
      copc_part(counts[child], picked[child], take, leave);
      below.records.resize(left * record_);
      node.has_children = node.has_children || below.has_children || left > 0;
    }
    for_each_index(chunks.size(), threads_, [&](std::size_t child) { chunks[child] = chunk_of(children[child]); });
    for (const Chunk& chunk : chunks) put(chunk);
    open_.resize(first);
    open_.push_back(std::move(node));
  }

  void put(Built built) {
    for (const Chunk& chunk : built.chunks) put(chunk);
    open_.push_back(std::move(built.root));
  }

  void put(const Chunk& chunk) {
    constexpr std::size_t most = std::numeric_limits<std::int32_t>::max();
    if (chunk.points == 0) {
      if (chunk.has_children) entries_.push_back({chunk.key, 0, 0, 0});
      return;
    }
    if (chunk.bytes.size() > most || chunk.points > most)
      throw FileError(file_.path().string(), "",
                      text::joined({"has ", std::to_string(chunk.points),
                                    " points in one place; expected fewer than 2^31, and as many bytes"}));
    entries_.push_back({chunk.key, file_.position(), static_cast<std::int32_t>(chunk.bytes.size()),
                        static_cast<std::int32_t>(chunk.points)});
    chunk_sizes_.push_back(chunk.bytes.size());
    chunk_points_.push_back(static_cast<std::uint32_t>(chunk.points));
    file_.write(chunk.bytes);
  }

  OutputFile& file_;
  std::size_t record_, colour_;  // sizes of a record and of its colour [byte]
  unsigned threads_;
  CopcSizes sizes_;
  Change change_;
  std::vector<OpenNode> open_;  // in order, on the way to the next block
  std::vector<CopcEntry> entries_;
  std::vector<std::size_t> chunk_sizes_;
  std::vector<std::uint32_t> chunk_points_;
};

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
