// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_PLY_HPP
#define PULSECAST_IO_PLY_HPP

#include <pulsecast/io/detail/packed_points.hpp>

namespace PULSECAST_NAMESPACE::io {

/// Settings of a PLY file.
struct PlySettings {
  PointLayout layout = layouts::map();  ///< properties of a vertex, written without gaps
  PointSettings points{};               ///< values; set the origin for large coordinates

  void validate() const { detail::require_packable(layout, points); }
};

/// Writes points as binary little-endian PLY: an element `vertex` with a property for each field;
/// 64-bit integers become `double`. Memory does not grow with the number of points. Times since a
/// scan's start count from tick 0, but in `add`. `close()` completes the file: see `OutputFile`.
/// Source: Turk 1994, The PLY Polygon File Format.
class PlyWriter {
 public:
  /// Opens the file. @throws SettingError for settings out of range @throws FileError
  explicit PlyWriter(std::filesystem::path path, const PlySettings& settings = {})
      : points_(validated(settings).layout.without_int64(), settings.points), file_(std::move(path)) {
    file_.write(header(0));
    points_at_ = file_.position();
  }

  void operator()(const EchoBatch& batch) { file_.write(points_.of(batch)); }
  [[nodiscard]] static bool reads_empty_shots() noexcept { return false; }  ///< see ChoosesShots

  /// Appends the points of a buffer. @throws SettingError for other fields @throws FileError
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
    std::string properties;
    for (const PointField& f : points_.layout().fields)
      properties += text::joined({"property ", types[static_cast<std::size_t>(f.type)], " ", f.name, "\n"});
    return text::joined({"ply\nformat binary_little_endian 1.0\ncomment written by pulsecast", points.blanks,
                         "\nelement vertex ", points.digits, "\n", properties, "end_header\n"});
  }

  detail::PackedPoints points_;
  OutputFile file_;
  std::uint64_t points_at_ = 0;  // offset of the first record [byte]
};
static_assert(EchoSink<PlyWriter>);

}  // namespace PULSECAST_NAMESPACE::io

#endif
