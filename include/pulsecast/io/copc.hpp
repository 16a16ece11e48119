// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_COPC_HPP
#define PULSECAST_IO_COPC_HPP

#include <pulsecast/io/detail/copc/tree.hpp>
#include <pulsecast/io/laz.hpp>

namespace PULSECAST_NAMESPACE::io {

namespace detail {

/// Point records of a COPC file. They wait in a temporary file, and `finish` builds the octree.
/// Source of the records: https://copc.io, COPC 1.0, info VLR and hierarchy VLR.
class CopcRecords {
 public:
  explicit CopcRecords(unsigned threads, CopcSizes sizes = {})
      : threads_(std::min(thread_count(threads), 12U)), sizes_(sizes) {}

  static constexpr std::uint8_t format_bits = 128;
  [[nodiscard]] static std::vector<std::byte> first_descriptor() {
    return std::vector<std::byte>(las_vlr_header_size + info_size);
  }
  [[nodiscard]] static std::vector<std::byte> descriptor(const LasLayout& layout) {
    return laz_descriptor(layout, std::numeric_limits<std::uint32_t>::max());  // chunks of any size
  }

  void begin(OutputFile& file, const LasLayout& layout, bool /*changed*/) {
    layout_ = layout;
    table_position_at_ = file.position();
    file.write(LasBytes<8>{});  // placeholder
    const std::filesystem::path path = file.path().string() + ".points";
    runs_.emplace(path, layout.record(), threads_, sizes_.run_bytes, sizes_.most_cells);
  }

  void write(OutputFile& /*file*/, std::span<const std::byte> record) {
    double time = 0;
    std::memcpy(&time, record.data() + 22, sizeof time);  // LAS 1.4 R15, Point Data Record Format 6
    first_time_ = std::fmin(first_time_, time);
    last_time_ = std::fmax(last_time_, time);
    runs_->add(record);
  }

  template <class Change>
  void change(OutputFile& /*file*/, const Change& change) {
    change_ = change;
  }

  void finish(OutputFile& file, const LasEncoder& encoder) {
    runs_->end();
    CopcTree tree(file, *layout_, threads_, sizes_, std::move(change_));
    constexpr std::int64_t middle = std::int64_t{1} << 31;
    CopcRoot root{{middle, middle, middle}, copc_grid_bits};
    if (runs_->points() > 0) {
      const CopcPlan plan(*runs_, sizes_);
      root = plan.root();
      tree.write(*runs_, plan);
    } else {
      tree.entries().push_back({});  // the root, without points
    }
    runs_.reset();
    LasBytes<8> position{};
    position.put(0, file.position());
    file.overwrite(table_position_at_, position);
    file.write(laz_chunk_table(tree.sizes(), tree.points()));
    write_hierarchy(file, encoder, root, std::move(tree.entries()));
  }

  [[nodiscard]] LasExtendedRecords extended() const noexcept { return extended_; }

 private:
  static constexpr std::size_t info_size = 160, info_at = 375, extended_header_size = 60;  // [byte]

  void write_hierarchy(OutputFile& file, const LasEncoder& encoder, const CopcRoot& root,
                       std::vector<CopcEntry> entries) {
    extended_ = {file.position(), 1};
    const CopcHierarchy hierarchy(std::move(entries), sizes_.page_nodes);
    const std::uint64_t begin = file.position() + extended_header_size;
    const std::vector<std::byte> pages = hierarchy.bytes(begin);
    LasBytes<extended_header_size> h{};  // source: LAS 1.4 R15, Extended Variable Length Records
    h.put_text(2, "copc");
    h.put(18, std::uint16_t{1000});
    h.put(20, std::uint64_t{pages.size()});
    h.put_text(28, "EPT hierarchy");
    file.write(h);
    file.write(pages);

    const double scale = encoder.settings().scale;
    const double side = std::ldexp(scale, static_cast<int>(root.bits));
    LasBytes<info_size> info{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double corner = static_cast<double>(root.corner[axis] - (std::int64_t{1} << 31)) - 0.5;  // [step]
      info.put(8 * axis, encoder.offset()[static_cast<int>(axis)] + corner * scale + side / 2);
    }
    info.put(24, side / 2);
    info.put(32, std::ldexp(side, -int{copc_grid_bits}));  // spacing of the root: its cells
    info.put(40, begin);
    info.put(48, std::uint64_t{hierarchy.root_size()});
    const bool empty = encoder.tally().points == 0;
    info.put(56, empty ? 0.0 : first_time_);
    info.put(64, empty ? 0.0 : last_time_);
    file.overwrite(info_at, las_vlr_header("copc", 1, info_size, "COPC info VLR"));
    file.overwrite(info_at + las_vlr_header_size, info);
  }

  unsigned threads_;
  CopcSizes sizes_;
  std::optional<LasLayout> layout_;
  std::optional<CopcRuns> runs_;
  CopcTree::Change change_;
  std::uint64_t table_position_at_ = 0;  // offset of the table's position in the file [byte]
  double first_time_ = std::numeric_limits<double>::infinity(), last_time_ = -first_time_;
  LasExtendedRecords extended_{};
};

}  // namespace detail

/// Writes points as COPC 1.0, a LAZ file with an octree for maps and viewers that read a part of
/// it: as `LazWriter`, but for the order of the points. A node with children has at most one point
/// in each of its 128^3 cells, that nearest to the centre, so all points down to some level are an
/// even sample. Another node has at most 50,000, or one in each cell, unless its side is 128 steps
/// of the coordinates. The bytes are the same for any number of threads.
///
/// `close()` does most of the work; until then, points wait in `NAME.points.part`, uncompressed, so
/// the disk must have room for both. Memory is independent of the number of points: some 200 MB,
/// and 60 MB more for each of at most 12 threads, below 1 GB in all. But points within a cube of
/// 2048 steps are held at once. `docs/performance.md` has the figures.
class CopcWriter : public detail::LasFileWriter<detail::CopcRecords> {
 public:
  /// @throws SettingError for settings out of range, or that LAZ does not support @throws FileError
  explicit CopcWriter(std::filesystem::path path, LasSettings settings = {}, unsigned threads = 0)
      : LasFileWriter(std::move(path), LazWriter::compressible(std::move(settings)), detail::CopcRecords(threads)) {}
};
static_assert(EchoSink<CopcWriter>);

}  // namespace PULSECAST_NAMESPACE::io

#endif
