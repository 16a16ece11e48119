// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_PLY_HPP
#define PULSECAST_IO_PLY_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include <pulsecast/io/detail/packed_points.hpp>
#include <pulsecast/io/output_file.hpp>

namespace PULSECAST_NAMESPACE::io {

/// Settings of a PLY file.
struct PlySettings {
  PointLayout layout = layouts::map();  ///< properties of a vertex, written without gaps
  PointSettings points{};  ///< values of the properties; set the origin for large coordinates in single precision

  void validate() const { detail::require_packable(layout, points); }
};

/// Writes points as binary little-endian PLY: an element `vertex` with a property for each field of the layout. Source:
/// Turk 1994, The PLY Polygon File Format. It has no 64-bit integers, which become `double`. Streams: memory does not
/// grow with the number of points. Readers find coordinates by the names x, y and z, and many keep them in single
/// precision only: set `PointSettings::origin` for those. Times since a scan's start count from tick 0, except of scans
/// that `add` appends. Only `close()` completes the file: see `OutputFile`. Throws a `FileError`.
class PlyWriter {
 public:
  /// Opens the file. @throws SettingError for settings out of range @throws FileError
  explicit PlyWriter(std::filesystem::path path, const PlySettings& settings = {})
      : points_(validated(settings).layout.without_int64(), settings.points), file_(std::move(path)) {
    file_.write(header(0));
    points_at_ = file_.position();
  }

  void operator()(const EchoBatch& batch) { file_.write(points_.of(batch)); }
  [[nodiscard]] static bool reads_empty_shots() noexcept { return false; }  ///< as the concept ChoosesShots describes

  /// Appends the points of a buffer, such as a scan. @throws SettingError for fields other than its @throws FileError
  void add(const PointBuffer& points) { file_.write(points_.of(points)); }

  /// Completes the header, and gives the file its name. Throws a `FileError`.
  void close() {
    const std::string head = header((file_.position() - points_at_) / points_.layout().size);
    file_.overwrite(0, std::as_bytes(std::span(head)));
    file_.commit();
  }

 private:
  /// Header for a number of points, of equal length for all.
  [[nodiscard]] std::string header(std::uint64_t count) const {
    constexpr std::array<std::string_view, 9> types{"",    "char", "uchar", "short", "ushort",
                                                    "int", "uint", "float", "double"};
    const detail::CountText points(count);
    std::string text = "ply\nformat binary_little_endian 1.0\ncomment written by pulsecast" + points.blanks +
                       "\nelement vertex " + points.digits + '\n';
    for (const PointField& field : points_.layout().fields)
      text.append("property ")
          .append(types[static_cast<std::size_t>(field.type)])
          .append(" ")
          .append(field.name)
          .append("\n");
    return text + "end_header\n";
  }

  detail::PackedPoints points_;
  OutputFile file_;
  std::uint64_t points_at_ = 0;  // offset of the first record [byte]
};
static_assert(EchoSink<PlyWriter>);

}  // namespace PULSECAST_NAMESPACE::io

#endif
