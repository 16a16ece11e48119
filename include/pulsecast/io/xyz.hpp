// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <utility>

#include <pulsecast/concepts.hpp>
#include <pulsecast/io/detail/text/output.hpp>
#include <pulsecast/io/output_file.hpp>

namespace pulsecast::io {

struct XyzSettings {
  double start_time = 0;  ///< what the clock shows at tick 0 [s]

  void validate() const { require_finite("XyzSettings::start_time", start_time, "s"); }
};

/// Writes points as text, one a line, with these columns and a blank between them:
///
///     x y z intensity echo_width returnNumber pulseReturnNumber fullwaveIndex hitObjectId classification gpsTime
///
/// x, y, z [m], intensity, which is the echo's amplitude [nW], and echo_width [ns], nan if there was none to be found, have 4 decimals,
/// gpsTime [s] has 9; the others are whole numbers: return number, returns of the pulse, index of the pulse, object, class. There is no
/// head line.
/// These are the columns of HELIOS++ point files, so that what reads those reads these; only the unit of intensity is stated here.
/// Only `close()` makes the file: see `OutputFile`.
class XyzWriter {
 public:
  explicit XyzWriter(std::filesystem::path path, const XyzSettings& settings = {})
      : settings_(validated(settings)), text_(OutputFile(std::move(path))) {}
  explicit XyzWriter(OutputFile file, const XyzSettings& settings = {}) : settings_(validated(settings)), text_(std::move(file)) {}

  void operator()(const EchoBatch& batch) {
    for (const Shot& shot : batch.shots) {
      for (const Echo& echo : batch.echoes_of(shot)) write(shot, echo);
    }
  }

  void close() { text_.close(); }

 private:
  void write(const Shot& shot, const Echo& echo) {
    constexpr double nano = 1e9;  // of a unit
    text_.vector("the place of an echo", point_of(shot, echo), 4).reals(4, echo.amplitude * nano, echo.width * nano);
    text_.wholes(echo.number, shot.echoes, shot.index, echo.object, echo.classification);
    text_.reals(9, settings_.start_time + shot.tick.seconds()).end_row();
  }

  XyzSettings settings_;
  TextOutput text_;
};
static_assert(EchoSink<XyzWriter>);

}  // namespace pulsecast::io
