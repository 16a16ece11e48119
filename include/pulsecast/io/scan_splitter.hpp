// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_SCAN_SPLITTER_HPP
#define PULSECAST_IO_SCAN_SPLITTER_HPP

#include <pulsecast/io/point_records.hpp>

namespace PULSECAST_NAMESPACE::io {

/// Divides pulses into scans of equal time. Scan n begins at n / `scan_rate`. Scans with pulses,
/// even without points, are passed on in order when the next begins or at `close()`.
class ScanSplitter {
 public:
  /// Takes the points of a scan, which are valid during the call.
  using Take = std::function<void(const PointBuffer& scan)>;

  /// `scan_rate` in scans per second, from 1e-3 to 1e6 [Hz]. @throws SettingError
  ScanSplitter(PointBuffer buffer, double scan_rate, Take take)
      : buffer_(std::move(buffer)), scan_rate_(scan_rate), take_(std::move(take)) {
    require_within("ScanSplitter::scan_rate", scan_rate, 1e-3, 1e6, "Hz");
    next_ = Tick::of(0, scan_rate_);
  }

  /// Appends the pulses of a batch to their scans.
  void operator()(const EchoBatch& batch) {
    const std::size_t count = batch.shots.size();
    for (std::size_t first = 0, end = 0; first < count; first = end) {
      if (batch.shots[first].tick >= next_) begin_scan(batch.shots[first].tick);
      begun_ = true;
      while (end < count && batch.shots[end].tick < next_) ++end;
      const std::size_t subrays = batch.subrays.size() / count;
      EchoBatch part = batch;
      part.shots = batch.shots.subspan(first, end - first);
      part.subrays = batch.subrays.subspan(first * subrays, (end - first) * subrays);
      buffer_(part);
    }
  }

  /// Passes the last scan on.
  void close() {
    if (std::exchange(begun_, false)) take_(buffer_);
  }

 private:
  /// Passes the current scan on, and begins that of a tick.
  void begin_scan(Tick tick) {
    close();
    auto number = static_cast<PulseIndex>(tick.seconds() * scan_rate_);
    while (number > 0 && tick < Tick::of(number, scan_rate_)) --number;
    while (!(tick < Tick::of(number + 1, scan_rate_))) ++number;
    next_ = Tick::of(number + 1, scan_rate_);
    buffer_.begin_scan(Tick::of(number, scan_rate_));
  }

  PointBuffer buffer_;
  double scan_rate_;
  Take take_;
  Tick next_;           // start of the scan after the current one
  bool begun_ = false;  // true if the current scan has pulses
};
static_assert(EchoSink<ScanSplitter>);

}  // namespace PULSECAST_NAMESPACE::io

#endif
