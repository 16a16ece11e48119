// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <utility>

#include <pulsecast/concepts.hpp>
#include <pulsecast/io/detail/text/output.hpp>
#include <pulsecast/io/output_file.hpp>

namespace pulsecast::io {

/// Settings of a waveform file.
struct WaveformTextSettings {
  double start_time = 0;  ///< clock time at tick 0 [s]

  void validate() const { require_finite("WaveformTextSettings::start_time", start_time, "s"); }
};

/// Writes waveforms as text, one a line, with or without echoes, in these columns, separated by blanks, without a header line:
///
///     fullwaveIndex ox oy oz dx dy dz tmin tmax gpsTime w_0 ... w_(n-1)
///
/// fullwaveIndex: slot of the pulse, as in point files; ox, oy, oz: origin [m], 4 decimals; dx, dy, dz: unit direction, 9 decimals; tmin,
/// tmax: times of the first and last sample [ns], 6 decimals; gpsTime: departure [s], 9 decimals; w: samples of received power [nW], as the
/// points' intensity, 9 decimals, to the end of the line.
/// These are the columns of HELIOS++ waveform files, so that their readers work. As there, tmin and tmax are one-way times, range by speed
/// of light: sample i is from the range `c (tmin + (tmax - tmin) i / (n - 1))`, half of its two-way travel time.
/// Only `close()` completes the file: see `OutputFile`. Throws a `FileError`.
class WaveformTextWriter {
 public:
  /// Opens the file. @throws SettingError for settings out of range @throws FileError
  explicit WaveformTextWriter(std::filesystem::path path, const WaveformTextSettings& settings = {})
      : settings_(validated(settings)), text_(OutputFile(std::move(path))) {}
  /// Writes to an open file.
  explicit WaveformTextWriter(OutputFile file, const WaveformTextSettings& settings = {})
      : settings_(validated(settings)), text_(std::move(file)) {}

  void operator()(const EchoBatch& batch) {
    for (const Shot& shot : batch.shots) {
      if (shot.samples != 0) write(shot, batch);
    }
  }

  void close() { text_.close(); }

 private:
  void write(const Shot& shot, const EchoBatch& batch) {
    constexpr double nano = 1e9, one_way = 0.5;
    const double last = shot.waveform_start + (shot.samples - 1) * batch.sample_interval;
    text_.wholes(shot.index).vector("the origin of a pulse", shot.origin, 4).vector("the direction of a pulse", shot.direction, 9);
    text_.reals(6, shot.waveform_start * one_way * nano, last * one_way * nano).reals(9, settings_.start_time + shot.tick.seconds());
    for (const float sample : batch.waveform_of(shot)) text_.reals(9, double{sample} * nano);
    text_.end_row();
  }

  WaveformTextSettings settings_;
  TextOutput text_;
};
static_assert(EchoSink<WaveformTextWriter>);

}  // namespace pulsecast::io
