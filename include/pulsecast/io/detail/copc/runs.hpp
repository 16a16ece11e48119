// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_COPC_RUNS_HPP
#define PULSECAST_IO_DETAIL_COPC_RUNS_HPP

#include <pulsecast/base/parallel.hpp>
#include <pulsecast/io/detail/copc/octree.hpp>
#include <pulsecast/io/output_file.hpp>

namespace PULSECAST_NAMESPACE::io::detail {

/// Points of a cell in a run: neighbours in the file.
struct CopcCell {
  std::uint64_t key = 0;    ///< Morton number of the cell
  std::uint32_t count = 0;  ///< number of points
};

/// Consecutive points of the file.
struct CopcExtent {
  std::uint64_t begin = 0, count = 0;  ///< number of the first point, and of points
};

/// Point records on their way into the octree, in a temporary file: runs of some megabytes, each
/// sorted by cells, which are aligned cubes of 2^bits steps. So all points of a node are in few
/// pieces of the file, whatever order they came in. Cells double whenever all runs have too many.
class CopcRuns {
 public:
  /// Records of `record` bytes, in runs of about `run_bytes`, with some `most_cells` in all.
  CopcRuns(const std::filesystem::path& path, std::size_t record, unsigned threads, std::size_t run_bytes,
           std::size_t most_cells)
      : file_(path),
        record_(record),
        threads_(threads),
        run_bytes_(run_bytes),
        run_points_(std::max<std::size_t>(run_bytes / record, 256)),
        most_cells_(most_cells) {
    file_.forget_name();
  }

  void add(std::span<const std::byte> record) {
    gathered_.insert(gathered_.end(), record.begin(), record.end());
    if (gathered_.size() == run_points_ * record_) end_run();
  }

  /// Ends the last run, and frees the memory of the gathered.
  void end() {
    end_run();
    gathered_ = {};
    sorted_ = {};
    ranks_ = {};
  }

  /// Runs of some of the points, in a file of their own, with the smallest cells. @throws FileError
  [[nodiscard]] CopcRuns finer(std::span<const CopcExtent> extents) const {
    CopcRuns runs(file_.path().string() + ".finer", record_, threads_, run_bytes_, most_cells_);
    for (const CopcExtent& e : extents)
      for (std::uint64_t at = 0; at < e.count; at += run_points_) {
        const CopcExtent some{e.begin + at, std::min<std::uint64_t>(run_points_, e.count - at)};
        const std::vector<std::byte> bytes = read(std::span(&some, 1));
        for (std::size_t i = 0; i < bytes.size(); i += record_) runs.add(std::span(bytes).subspan(i, record_));
      }
    runs.end();
    return runs;
  }

  [[nodiscard]] std::uint64_t points() const noexcept { return points_; }
  static constexpr unsigned least_bits = 32 - copc_morton_bits;   ///< of cells, at first
  [[nodiscard]] unsigned bits() const noexcept { return bits_; }  ///< cells have 2^bits steps

  /// Cells of each run, in the order of the file: ascending within a run.
  [[nodiscard]] const std::vector<std::vector<CopcCell>>& cells() const noexcept { return cells_; }

  /// Reads points, for any number of threads once ended. @throws FileError
  [[nodiscard]] std::vector<std::byte> read(std::span<const CopcExtent> extents) const {
    std::uint64_t count = 0;
    for (const CopcExtent& e : extents) count += e.count;
    std::vector<std::byte> bytes(static_cast<std::size_t>(count) * record_);
    std::span<std::byte> left(bytes);
    for (const CopcExtent& e : extents) {
      const std::size_t size = static_cast<std::size_t>(e.count) * record_;
      file_.read(e.begin * record_, left.first(size));
      left = left.subspan(size);
    }
    return bytes;
  }

 private:
  void end_run() {
    const std::size_t count = gathered_.size() / record_;
    if (count == 0) return;
    ranks_.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
      CopcPlace place = copc_place(gathered_.data() + i * record_);
      for (std::int64_t& p : place) p >>= bits_;
      ranks_[i] = {copc_morton(place), static_cast<std::uint32_t>(i)};
    }
    std::sort(ranks_.begin(), ranks_.end());
    write_run();
    std::vector<CopcCell>& cells = cells_.emplace_back();
    for (const CopcRank& rank : ranks_) add_cell(cells, {rank.key, 1});
    cell_count_ += cells.size();
    points_ += count;
    gathered_.clear();
    const auto most = std::max<std::uint64_t>(most_cells_, points_ / 256);
    while (cell_count_ > most && bits_ < 32) double_cells();
  }

  /// Writes the gathered in the order of the ranks, a block at a time.
  void write_run() {
    const std::size_t at_once = std::max<std::size_t>((8 << 20) / record_, 1), pieces = threads_;
    for (std::size_t first = 0; first < ranks_.size(); first += at_once) {
      const std::size_t some = std::min(at_once, ranks_.size() - first);
      sorted_.resize(some * record_);
      for_each_index(pieces, threads_, [&](std::size_t piece) {
        for (std::size_t i = some * piece / pieces; i < some * (piece + 1) / pieces; ++i)
          std::memcpy(sorted_.data() + i * record_, gathered_.data() + ranks_[first + i].number * record_, record_);
      });
      file_.write(sorted_);
    }
  }

  static void add_cell(std::vector<CopcCell>& cells, const CopcCell& cell) {
    if (!cells.empty() && cells.back().key == cell.key)
      cells.back().count += cell.count;
    else
      cells.push_back(cell);
  }

  void double_cells() {
    ++bits_;
    cell_count_ = 0;
    for (std::vector<CopcCell>& run : cells_) {
      std::vector<CopcCell> larger;
      for (const CopcCell& cell : run) add_cell(larger, {cell.key >> 3, cell.count});
      larger.shrink_to_fit();
      run = std::move(larger);
      cell_count_ += run.size();
    }
  }

  OutputFile file_;
  std::size_t record_;  // [byte]
  unsigned threads_, bits_ = least_bits;
  std::size_t run_bytes_, run_points_, most_cells_;
  std::vector<std::byte> gathered_, sorted_;
  std::vector<CopcRank> ranks_;
  std::vector<std::vector<CopcCell>> cells_;
  std::size_t cell_count_ = 0;
  std::uint64_t points_ = 0;
};

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
