// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_PCD_HPP
#define PULSECAST_IO_PCD_HPP

#include <liblzf/lzf.h>

#include <pulsecast/io/detail/packed_points.hpp>

namespace PULSECAST_NAMESPACE::io {

/// Encoding of the points of a PCD file.
enum class PcdEncoding : std::uint8_t {
  ascii,             ///< a line a point; each number in the shortest form that reads back the same
  binary,            ///< records as in memory
  binary_compressed  ///< columns, one a field, compressed by LZF; held in memory until `close()`
};

/// Settings of a PCD file.
struct PcdSettings {
  PcdEncoding encoding = PcdEncoding::binary;  ///< encoding of the points
  PointLayout layout = layouts::xyzi();        ///< fields, written without gaps
  PointSettings points{};                      ///< values; set the origin for large coordinates

  void validate() const {
    require_within("PcdSettings::encoding", static_cast<double>(encoding), 0,
                   static_cast<double>(PcdEncoding::binary_compressed), "");
    detail::require_packable(layout, points);
  }
};

namespace detail {

/// Room for the output of LZF [byte]. Source: liblzf, lzf.h: 104 %, and bytes kept free.
constexpr std::uint64_t lzf_room(std::uint64_t size) noexcept { return size + size / 25 + 16; }
/// Greatest input of LZF: the sizes before and after are 32-bit numbers [byte].
inline constexpr std::uint64_t lzf_size_max = 4'129'776'230;
static_assert(lzf_room(lzf_size_max) <= std::numeric_limits<std::uint32_t>::max());

/// Bytes compressed by LZF, after their sizes with and without it. Source: as `PcdWriter`.
[[nodiscard]] inline std::vector<std::byte> pcd_compressed(std::span<const std::byte> bytes) {
  std::array<std::uint32_t, 2> sizes{0, static_cast<std::uint32_t>(bytes.size())};
  const auto room = static_cast<std::uint32_t>(lzf_room(bytes.size()));
  std::vector<std::byte> out(sizeof sizes + room);
  if (!bytes.empty()) sizes[0] = lzf_compress(bytes.data(), sizes[1], out.data() + sizeof sizes, room);
  std::memcpy(out.data(), sizes.data(), sizeof sizes);
  out.resize(sizeof sizes + sizes[0]);
  return out;
}

}  // namespace detail

/// Writes points as PCD, the format of PCL, as an unorganized cloud; 64-bit integers, which not all
/// readers take, become `float64`. Memory does not grow with the number of points, unless
/// compressed: then the file takes up to four times the memory of its points until `close()`, and
/// at most 4.1 GB before compression. A comment names an origin other than 0. Times since a scan's start count from
/// tick 0, but in `add`. `close()` completes the file: see `OutputFile`. Source: PCL, PCD file format 0.7.
class PcdWriter {
 public:
  /// Opens the file. @throws SettingError for settings out of range @throws FileError
  explicit PcdWriter(std::filesystem::path path, const PcdSettings& settings = {})
      : points_(validated(settings).layout.without_int64(), settings.points),
        encoding_(settings.encoding),
        origin_(settings.points.origin),
        columns_(points_.layout()),
        file_(std::move(path)) {
    file_.write(header());
  }

  void operator()(const EchoBatch& batch) { write(points_.of(batch)); }
  [[nodiscard]] static bool reads_empty_shots() noexcept { return false; }  ///< see ChoosesShots

  /// Appends the points of a buffer. @throws SettingError for other fields @throws FileError
  void add(const PointBuffer& points) { write(points_.of(points)); }

  /// Completes points and header, and gives the file its name. @throws FileError
  void close() {
    if (encoding_ == PcdEncoding::binary_compressed) {
      std::vector<std::byte> bytes;
      bytes.reserve(count_ * points_.layout().size);
      for (const std::vector<std::byte>& column : columns_.all())
        bytes.insert(bytes.end(), column.begin(), column.end());
      file_.write(detail::pcd_compressed(bytes));
    }
    const std::string head = header();
    file_.overwrite(0, std::as_bytes(std::span(head)));
    file_.commit();
  }

 private:
  void write(std::span<const std::byte> records) {
    count_ += records.size() / points_.layout().size;
    switch (encoding_) {
      case PcdEncoding::ascii:
        return write_rows(records);
      case PcdEncoding::binary:
        return file_.write(records);
      case PcdEncoding::binary_compressed:
        if (count_ * points_.layout().size > detail::lzf_size_max) refuse();
        columns_.add(records);
    }
  }

  void write_rows(std::span<const std::byte> records) {
    for (; !records.empty(); records = records.subspan(points_.layout().size)) {
      for (const PointField& field : points_.layout().fields)
        detail::add_number(row_, field.type, records.data() + field.offset);
      file_.write(row_.end());
    }
  }

  [[noreturn]] void refuse() {
    file_.discard();
    const std::string most = std::to_string(detail::lzf_size_max), count = std::to_string(count_);
    throw FileError(file_.path().string(), "",
                    text::joined({"has ", count, " points, which are too large for LZF: expected at most ", most,
                                  " bytes; without compression, there is no limit"}));
  }

  /// Header for the points so far, of equal length for any number.
  [[nodiscard]] std::string header() const {
    constexpr std::array<std::string_view, 9> types{"", "I", "U", "I", "U", "I", "U", "F", "F"};
    constexpr std::array<std::string_view, 3> encodings{"ascii", "binary", "binary_compressed"};
    std::string names, sizes, letters, counts;
    for (const PointField& field : points_.layout().fields) {
      names.append(" ").append(field.name);
      sizes.append(" ").append(std::to_string(size_of(field.type)));
      letters.append(" ").append(types[static_cast<std::size_t>(field.type)]);
      counts.append(" 1");
    }
    const detail::CountText points(count_);
    const std::string at = text::message("\n# origin of x, y, z [m]: ", origin_.x, " ", origin_.y, " ", origin_.z);
    return text::joined({"# .PCD v0.7 - Point Cloud Data file format", points.blanks, points.blanks,
                         origin_ == Vec3{} ? "" : at, "\nVERSION 0.7\nFIELDS", names, "\nSIZE", sizes, "\nTYPE",
                         letters, "\nCOUNT", counts, "\nWIDTH ", points.digits,
                         "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS ", points.digits, "\nDATA ",
                         encodings[static_cast<std::size_t>(encoding_)], "\n"});
  }

  detail::PackedPoints points_;
  PcdEncoding encoding_;
  Vec3 origin_;
  detail::FieldColumns columns_;  // of a compressed file
  OutputFile file_;
  TextRow row_;
  std::uint64_t count_ = 0;  // points so far
};
static_assert(EchoSink<PcdWriter>);

}  // namespace PULSECAST_NAMESPACE::io

#endif
