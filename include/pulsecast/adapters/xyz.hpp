// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>

#include <pulsecast/adapters/output_file.hpp>
#include <pulsecast/adapters/text_row.hpp>
#include <pulsecast/concepts.hpp>

namespace pulsecast::adapters {

struct XyzSettings {
  double start_time = 0;  ///< what the clock shows at tick 0 [s]

  void validate() const { expect_finite("XyzSettings::start_time", start_time, "s"); }
};

/// Writes points as text, one a line, with these columns and a blank between them:
///
///     x y z intensity echo_width returnNumber pulseReturnNumber fullwaveIndex hitObjectId classification gpsTime
///
/// x, y, z [m], intensity, which is the echo's amplitude [nW], and echo_width [ns] have 4 decimals, gpsTime [s] has 9; the others are whole
/// numbers: return number, returns of the pulse, index of the pulse, object, class. There is no head line.
/// These are the columns of HELIOS++ point files, so that what reads those reads these; only the unit of intensity is stated here.
/// Only `close()` makes the file: see `OutputFile`.
class XyzWriter {
 public:
  explicit XyzWriter(std::filesystem::path path, const XyzSettings& settings = {})
      : settings_(validated(settings)), file_(std::move(path)) {}

  void operator()(const EchoBatch& batch) {
    for (const Shot& shot : batch.shots) {
      for (const Echo& echo : batch.echoes_of(shot)) write(shot, echo);
    }
  }

  void close() { file_.commit(); }

 private:
  void write(const Shot& shot, const Echo& echo) {
    const Vec3 point = point_of(shot, echo);
    if (!finite(point)) {
      file_.discard();
      throw FileError(file_.path().string(), "line " + std::to_string(points_ + 1),
                      "cannot be written: the echo of pulse " + std::to_string(shot.index) + " has no place; expected finite coordinates");
    }
    constexpr double nano = 1e9;  // of a unit
    row_.add(point.x, 4).add(point.y, 4).add(point.z, 4).add(echo.amplitude * nano, 4).add(echo.width * nano, 4);
    row_.add(echo.number).add(shot.echoes).add(shot.index).add(echo.object).add(echo.classification);
    row_.add(settings_.start_time + shot.tick.seconds(), 9);
    file_.write(row_.end());
    ++points_;
  }

  XyzSettings settings_;
  OutputFile file_;
  TextRow row_;
  std::uint64_t points_ = 0;
};
static_assert(EchoSink<XyzWriter>);

}  // namespace pulsecast::adapters
