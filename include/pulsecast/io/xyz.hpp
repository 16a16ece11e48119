// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <utility>

#include <pulsecast/concepts.hpp>
#include <pulsecast/io/detail/text/output.hpp>
#include <pulsecast/io/output_file.hpp>

namespace pulsecast::io {

/// Settings of a point file.
struct XyzSettings {
  double start_time = 0;  ///< clock time at tick 0 [s]

  void validate() const { require_finite("XyzSettings::start_time", start_time, "s"); }
};

/// Writes points as text, one a line, in these columns, separated by blanks, without a header line:
///
///     x y z intensity echo_width returnNumber pulseReturnNumber fullwaveIndex hitObjectId classification gpsTime
///
/// x, y, z [m], intensity (amplitude of the echo [nW]) and echo_width [ns], nan if none was found, have 4 decimals; gpsTime [s] has 9. The
/// others are integers: return number, returns of the pulse, index of the pulse, object, class.
/// These are the columns of HELIOS++ point files, so that their readers work; only the unit of intensity is stated here.
/// Only `close()` completes the file: see `OutputFile`. Throws a `FileError`.
class XyzWriter {
 public:
  /// Opens the file. @throws SettingError for settings out of range @throws FileError
  explicit XyzWriter(std::filesystem::path path, const XyzSettings& settings = {})
      : settings_(validated(settings)), text_(OutputFile(std::move(path))) {}
  /// Writes to an open file.
  explicit XyzWriter(OutputFile file, const XyzSettings& settings = {}) : settings_(validated(settings)), text_(std::move(file)) {}

  void operator()(const EchoBatch& batch) {
    for (const Shot& shot : batch.shots) {
      for (const Echo& echo : batch.echoes_of(shot)) write(shot, echo);
    }
  }

  void close() { text_.close(); }

 private:
  void write(const Shot& shot, const Echo& echo) {
    constexpr double nano = 1e9;  // per unit
    text_.vector("the position of an echo", point_of(shot, echo), 4).reals(4, echo.amplitude * nano, echo.width * nano);
    text_.wholes(echo.number, shot.echoes, shot.index, echo.object, echo.classification);
    text_.reals(9, settings_.start_time + shot.tick.seconds()).end_row();
  }

  XyzSettings settings_;
  TextOutput text_;
};
static_assert(EchoSink<XyzWriter>);

}  // namespace pulsecast::io
