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

struct PulseTextSettings {
  double start_time = 0;  ///< what the clock shows at tick 0 [s]

  void validate() const { require_finite("PulseTextSettings::start_time", start_time, "s"); }
};

/// Writes the pulses that were sent as text, with or without echoes, one a line, with these columns and a blank between them:
///
///     ox oy oz dx dy dz time pulseIndex deviceIndex fate
///
/// ox, oy, oz: where it left [m], 4 decimals; dx, dy, dz: its direction, unit, 9 decimals; time: when [ns], 4 decimals, exact to the last
/// of them however large; pulseIndex: its slot, the number that points and waveforms have as fullwaveIndex; deviceIndex: its emitter, from
/// 0; fate: the number of its `Fate`: 0 returned, 2 missed, 3 out of range, 4 below threshold, 5 absorbed. Pulses that the optic blocked
/// (1) were never sent, and have no line. There is no head line.
/// The first nine are the columns of HELIOS++ pulse files, so that what reads those reads these: time is in nanoseconds there, too, unlike
/// the seconds of all other files; here pulseIndex counts from 0 and over all devices, and directions have more decimals.
/// Only `close()` makes the file: see `OutputFile`.
class PulseTextWriter {
 public:
  explicit PulseTextWriter(std::filesystem::path path, const PulseTextSettings& settings = {})
      : settings_(validated(settings)), text_(OutputFile(std::move(path))) {}
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
