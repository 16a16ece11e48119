// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <utility>

#include <pulsecast/concepts.hpp>
#include <pulsecast/io/detail/text/output.hpp>
#include <pulsecast/io/output_file.hpp>

namespace pulsecast::io {

struct WaveformTextSettings {
  double start_time = 0;  ///< what the clock shows at tick 0 [s]

  void validate() const { require_finite("WaveformTextSettings::start_time", start_time, "s"); }
};

/// Writes waveforms as text, one a line, for all pulses that have one, be there echoes in it or not, with these columns and a blank
/// between:
///
///     fullwaveIndex ox oy oz dx dy dz tmin tmax gpsTime w_0 ... w_(n-1)
///
/// fullwaveIndex: the pulse's slot, as in the files of points; ox, oy, oz: where it left [m], 4 decimals; dx, dy, dz: its direction, unit,
/// 9 decimals; tmin, tmax: times of the first and the last sample [ns], 6 decimals; gpsTime: when it left [s], 9 decimals; then the
/// samples: received power [nW], as the points' intensity, 9 decimals, as many as the line is long. There is no head line. These are the
/// columns of HELIOS++ waveform files, so that what reads those reads these. As there, tmin and tmax are one-way times, range by speed of
/// light: sample i is from the range `c (tmin + (tmax - tmin) i / (n - 1))`, and only half of its two-way travel time. Only `close()` makes
/// the file: see `OutputFile`.
class WaveformTextWriter {
 public:
  explicit WaveformTextWriter(std::filesystem::path path, const WaveformTextSettings& settings = {})
      : settings_(validated(settings)), text_(OutputFile(std::move(path))) {}
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
