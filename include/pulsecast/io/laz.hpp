// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_LAZ_HPP
#define PULSECAST_IO_LAZ_HPP

#include <pulsecast/base/parallel.hpp>
#include <pulsecast/io/detail/las/writer.hpp>
#include <pulsecast/io/detail/laz/chunk.hpp>

namespace PULSECAST_NAMESPACE::io {

namespace detail {

inline constexpr std::size_t laz_chunk_points = 50000;  ///< default of LASzip

/// Variable-length record, header included, on the compression of points in chunks of `chunk`
/// points. Source: `laszip encoded` as documented by LASzip, LAStools.
[[nodiscard]] inline std::vector<std::byte> laz_descriptor(const LasLayout& layout,
                                                           std::uint32_t chunk = laz_chunk_points) {
  struct Item {
    std::uint16_t type;
    std::size_t size;
  };
  std::vector<Item> items{{10, laz_point_size}};           // POINT14
  if (layout.colour_size == 6) items.push_back({11, 6});   // RGB14
  if (layout.colour_size == 8) items.push_back({12, 8});   // RGBNIR14
  items.push_back({14, layout.record() - layout.extras});  // BYTE14
  LasBytes<34> d{};
  d.put(0, std::uint16_t{3});  // layered chunks; then 0: arithmetic coder
  d.put(4, std::uint8_t{3});   // version 3.4, revision 3, that of LASzip
  d.put(5, std::uint8_t{4});
  d.put(6, std::uint16_t{3});
  d.put(12, chunk);
  d.put(16, std::int64_t{-1});  // no special extended records:
  d.put(24, std::int64_t{-1});  // number and offset
  d.put(32, static_cast<std::uint16_t>(items.size()));
  const auto head = las_vlr_header("laszip encoded", 22204, d.size() + 6 * items.size(), "https://laszip.org");
  std::vector<std::byte> bytes(head.begin(), head.end());
  bytes.insert(bytes.end(), d.begin(), d.end());
  for (const Item& item : items) {
    LasBytes<6> i{};
    i.put(0, item.type);
    i.put(2, static_cast<std::uint16_t>(item.size));
    i.put(4, std::uint16_t{3});  // version
    bytes.insert(bytes.end(), i.begin(), i.end());
  }
  return bytes;
}

/// Chunk table: sizes of all chunks [byte], for random access, and their numbers of points, unless
/// `points` is empty. Source: Isenburg 2013, LASzip, 3 (chunk table).
[[nodiscard]] inline std::vector<std::byte> laz_chunk_table(std::span<const std::size_t> sizes,
                                                            std::span<const std::uint32_t> points = {}) {
  LasBytes<8> head{};  // version, 0, and number of chunks
  head.put(4, static_cast<std::uint32_t>(sizes.size()));
  std::vector<std::byte> bytes(head.begin(), head.end());
  if (sizes.empty()) return bytes;
  LazEncoder encoder;
  LazIntegers integers(32, 2);  // contexts: numbers of points, sizes
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const auto step = [&](const auto& values, std::size_t context) {
      integers.code(encoder, i == 0 ? 0 : static_cast<std::int32_t>(values[i - 1]),
                    static_cast<std::int32_t>(values[i]), context);
    };
    if (!points.empty()) step(points, 0);
    step(sizes, 1);
  }
  const std::vector<std::byte> coded = std::move(encoder).finish();
  bytes.insert(bytes.end(), coded.begin(), coded.end());
  return bytes;
}

/// Point records of a LAZ file. As many chunks as threads, at most 16, are gathered, compressed in
/// parallel and written in order. Records to be changed wait uncompressed in a file of their own.
class LazRecords {
 public:
  explicit LazRecords(unsigned threads) : threads_(std::min(thread_count(threads), 16U)) {}

  static constexpr std::uint8_t format_bits = 128;
  [[nodiscard]] static std::vector<std::byte> first_descriptor() { return {}; }
  [[nodiscard]] static std::vector<std::byte> descriptor(const LasLayout& how) { return laz_descriptor(how); }

  void begin(OutputFile& file, const LasLayout& layout, bool changed) {
    record_ = layout.record();
    colour_ = layout.colour_size;
    table_position_at_ = file.position();
    file.write(table_position(-1));  // placeholder
    if (changed) unchanged_.emplace(file.path().string() + ".points");
  }

  void write(OutputFile& file, std::span<const std::byte> record) {
    if (unchanged_) return unchanged_->write(record);
    gather(file, record);
  }

  template <class Change>
  void change(OutputFile& file, const Change& change) {
    las_in_blocks(*unchanged_, 0, record_, [&](std::uint64_t, std::span<std::byte> some) {
      change(some);
      for (std::size_t at = 0; at < some.size(); at += record_) gather(file, some.subspan(at, record_));
    });
  }

  /// Takes over chunks of these sizes [byte], written by others.
  void adopt(std::vector<std::size_t> sizes) { sizes_ = std::move(sizes); }

  void finish(OutputFile& file, const LasEncoder& /*encoder*/) { finish(file); }
  void finish(OutputFile& file) {
    compress(file);
    file.overwrite(table_position_at_, table_position(static_cast<std::int64_t>(file.position())));
    file.write(laz_chunk_table(sizes_));
  }

  [[nodiscard]] static LasExtendedRecords extended() noexcept { return {}; }

 private:
  [[nodiscard]] static LasBytes<8> table_position(std::int64_t position) noexcept {
    LasBytes<8> bytes{};
    bytes.put(0, position);
    return bytes;
  }

  void gather(OutputFile& file, std::span<const std::byte> record) {
    gathered_.insert(gathered_.end(), record.begin(), record.end());
    if (gathered_.size() == threads_ * laz_chunk_points * record_) compress(file);
  }

  /// Compresses the gathered records; every chunk but the last is full.
  void compress(OutputFile& file) {
    const std::size_t full = laz_chunk_points * record_;
    std::vector<std::vector<std::byte>> chunks((gathered_.size() + full - 1) / full);
    for_each_index(chunks.size(), threads_, [&](std::size_t i) {
      const auto rest = std::span<const std::byte>(gathered_).subspan(i * full);
      chunks[i] = LazChunk(rest.first(std::min(full, rest.size())), record_, colour_).compressed();
    });
    for (const auto& chunk : chunks) {
      file.write(chunk);
      sizes_.push_back(chunk.size());
    }
    gathered_.clear();
  }

  unsigned threads_;
  std::size_t record_ = 0, colour_ = 0;  // sizes of a record and of its colour [byte]
  std::uint64_t table_position_at_ = 0;  // offset of the table's position in the file [byte]
  std::optional<OutputFile> unchanged_;
  std::vector<std::byte> gathered_;
  std::vector<std::size_t> sizes_;  // of the written chunks [byte]
};

}  // namespace detail

/// Writes points as LAZ: as `LasWriter` in version 1.4 with point format 6, 7 or 8, compressed as
/// LASzip does. Chunks of 50,000 points are compressed on `threads` threads, 0 as in
/// `thread_count`; the bytes are the same for any number. With intensities scaled to the maximum
/// amplitude, `close()` compresses all; until then, points wait in `NAME.points.part`.
class LazWriter : public detail::LasFileWriter<detail::LazRecords> {
 public:
  /// @throws SettingError for settings out of range, or that LAZ does not support @throws FileError
  explicit LazWriter(std::filesystem::path path, LasSettings settings = {}, unsigned threads = 0)
      : LasFileWriter(std::move(path), compressible(std::move(settings)), detail::LazRecords(threads)) {}

  /// Settings, if LAZ supports them. Throws a `SettingError` for another format, or for waveforms.
  [[nodiscard]] static LasSettings compressible(LasSettings settings) {
    if (settings.format != LasFormat::las_1_4)
      throw SettingError("LasSettings::format", static_cast<double>(settings.format), "",
                         "0 for LAZ: LAS 1.4 with point formats 6 to 8");
    if (settings.waveforms)
      throw SettingError("LasSettings::waveforms", 1, "", "false for LAZ, which is written without waveforms");
    return settings;
  }

  static constexpr std::uint64_t chunk_points = detail::laz_chunk_points;  ///< but for the last

  /// Compresses a chunk of whole records by these settings: at least one, at most `chunk_points`.
  [[nodiscard]] static std::vector<std::byte> compressed_chunk(std::span<const std::byte> records,
                                                               const LasSettings& settings) {
    const detail::LasLayout layout(settings);
    return detail::LazChunk(records, layout.record(), layout.colour_size).compressed();
  }
};
static_assert(EchoSink<LazWriter>);

}  // namespace PULSECAST_NAMESPACE::io

#endif
