// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <utility>

#include <pulsecast/concepts.hpp>
#include <pulsecast/io/detail/text/output.hpp>
#include <pulsecast/io/output_file.hpp>

namespace pulsecast::io {

/// Settings of a pulse file.
struct PulseTextSettings {
  double start_time = 0;  ///< clock time at tick 0 [s]

  void validate() const { require_finite("PulseTextSettings::start_time", start_time, "s"); }
};

/// Writes pulses as text, with or without echoes, one a line, in these columns, separated by blanks, without a header line:
///
///     ox oy oz dx dy dz time pulseIndex deviceIndex fate
///
/// ox, oy, oz: origin [m], 4 decimals; dx, dy, dz: unit direction, 9 decimals; time: departure [ns], 4 decimals, all exact; pulseIndex:
/// slot, the fullwaveIndex of points and waveforms; deviceIndex: emitter, from 0; fate: number of its `Fate`: 0 returned, 2 missed, 3 out
/// of range, 4 below threshold, 5 absorbed. Pulses blocked by the optic (1) were never sent, and have no line.
/// The first nine are the columns of HELIOS++ pulse files, so that their readers work. As there, time is in nanoseconds, unlike the seconds
/// of all other files; pulseIndex counts from 0 and over all devices, and directions have more decimals.
/// Only `close()` completes the file: see `OutputFile`. Throws a `FileError`.
class PulseTextWriter {
 public:
  /// Opens the file. @throws SettingError for settings out of range @throws FileError
  explicit PulseTextWriter(std::filesystem::path path, const PulseTextSettings& settings = {})
      : settings_(validated(settings)), text_(OutputFile(std::move(path))) {}
  /// Writes to an open file.
  explicit PulseTextWriter(OutputFile file, const PulseTextSettings& settings = {})
      : settings_(validated(settings)), text_(std::move(file)) {}

  void operator()(const EchoBatch& batch) {
    const Tick start = Tick::of_seconds(settings_.start_time);
    for (const Shot& shot : batch.shots) {
      text_.vector("the origin of a pulse", shot.origin, 4).vector("the direction of a pulse", shot.direction, 9);
      text_.nanoseconds(start + shot.tick).wholes(shot.index, shot.channel, static_cast<std::uint8_t>(shot.fate)).end_row();
    }
  }

  void close() { text_.close(); }

 private:
  PulseTextSettings settings_;
  TextOutput text_;
};
static_assert(EchoSink<PulseTextWriter>);

}  // namespace pulsecast::io
