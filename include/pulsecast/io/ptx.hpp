// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_PTX_HPP
#define PULSECAST_IO_PTX_HPP

#include <pulsecast/concepts.hpp>
#include <pulsecast/io/detail/text/output.hpp>

namespace PULSECAST_NAMESPACE::io {

/// Scan of a PTX file: slots in lines of equal number, as those of a polygon mirror on a tripod.
/// Row r of column c is slot `first - before + c * line_slots + r`.
struct PtxScan {
  PulseIndex first = 0, end = 1;                    ///< range of its slots
  std::uint64_t line_slots = 1;                     ///< slots from a column to the next
  std::uint64_t before = 0;                         ///< slots of the first column that do not exist
  std::uint64_t rows = 1;                           ///< slots of a column that have a place
  Pose<frame::Instrument, frame::World> scanner{};  ///< pose of the scanner

  [[nodiscard]] std::uint64_t columns() const noexcept { return (end - first + before + line_slots - 1) / line_slots; }

  void validate() const {
    require_within("PtxScan::end - first", static_cast<double>(end) - static_cast<double>(first), 1, 1e12, "");
    require_within("PtxScan::line_slots", line_slots, 1, 1e9, "");
    require_within("PtxScan::before", before, 0, static_cast<double>(line_slots) - 1, "");
    require_within("PtxScan::rows", rows, 1, static_cast<double>(line_slots), "");
    require_finite("PtxScan::scanner (distance)", length(scanner.position), "m");
  }
};

/// Writes scans as PTX, one after another: a header with columns, rows and pose, then a line for each row of each
/// column: x y z [m] in the frame of the scanner, and reflectance up to 1, with 6 decimals. The point is the first echo
/// of the slot; without one the line is `0 0 0 0.5`. Echoes of slots without a place, and further ones of a slot, are
/// counted and left out. `close()` completes the file: see `OutputFile`. Source: Leica Cyclone, PTX: ten lines of
/// header; rows of the 4 by 4 matrix are the images of the axes, and the translation.
class PtxWriter {
 public:
  /// Scans are in ascending order of slots. @throws SettingError, also for others @throws FileError
  PtxWriter(std::filesystem::path path, std::vector<PtxScan> scans)
      : scans_(std::move(scans)), text_(OutputFile(std::move(path))) {
    for (PulseIndex end = 0; const PtxScan& scan : scans_) {
      require_within("PtxScan::first", static_cast<double>(validated(scan).first), static_cast<double>(end), 1e18, "");
      end = scan.end;
    }
    begin_scan();
  }

  void operator()(const EchoBatch& batch) {
    for (const Shot& shot : batch.shots) {
      if (shot.echoes == 0) continue;
      while (scan_ < scans_.size() && shot.index >= scans_[scan_].end) end_scan();
      left_out_ += shot.echoes;
      if (scan_ == scans_.size() || shot.index < scans_[scan_].first) continue;
      const PtxScan& scan = scans_[scan_];
      const std::uint64_t at = shot.index - scan.first + scan.before, row = at % scan.line_slots;
      if (row >= scan.rows) continue;
      fill(at / scan.line_slots * scan.rows + row);
      const Echo& echo = batch.echoes_of(shot).front();
      text_.vector("the position of an echo", scan.scanner.inverse().point(point_of(shot, echo)), 6);
      text_.reals(6, echo.reflectance > 0 ? std::min(double{echo.reflectance}, 1.0) : 0.0).end_row();
      ++lines_;
      --left_out_;
    }
  }
  [[nodiscard]] static bool reads_empty_shots() noexcept { return false; }  ///< see ChoosesShots

  /// Echoes without a place in the file.
  [[nodiscard]] std::uint64_t echoes_left_out() const noexcept { return left_out_; }

  /// Completes the scans, and gives the file its name. @throws FileError
  void close() {
    while (scan_ < scans_.size()) end_scan();
    text_.close();
  }

 private:
  /// Writes the header of the scan, if there is one.
  void begin_scan() {
    if (scan_ == scans_.size()) return;
    const PtxScan& scan = scans_[scan_];
    text_.wholes(scan.columns()).end_row();
    text_.wholes(scan.rows).end_row();
    const auto row = [&](const Vec3& v) -> TextOutput& { return text_.reals(9, v.x, v.y, v.z); };
    const std::array axes{scan.scanner.direction(axis::right), scan.scanner.direction(axis::forward),
                          scan.scanner.direction(axis::up)};
    row(scan.scanner.position).end_row();
    for (const Vec3& v : axes) row(v).end_row();
    for (const Vec3& v : axes) row(v).wholes(0).end_row();
    row(scan.scanner.position).wholes(1).end_row();
  }

  /// Writes lines without a point up to a number of lines.
  void fill(std::uint64_t lines) {
    for (; lines_ < lines; ++lines_) text_.wholes(0, 0, 0).word("0.5").end_row();
  }

  void end_scan() {
    fill(scans_[scan_].columns() * scans_[scan_].rows);
    ++scan_;
    lines_ = 0;
    begin_scan();
  }

  std::vector<PtxScan> scans_;
  TextOutput text_;
  std::size_t scan_ = 0;                    // number of the scan
  std::uint64_t lines_ = 0, left_out_ = 0;  // lines of the scan; echoes
};
static_assert(EchoSink<PtxWriter>);

}  // namespace PULSECAST_NAMESPACE::io

#endif
