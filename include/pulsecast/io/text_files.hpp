// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_TEXT_FILES_HPP
#define PULSECAST_IO_TEXT_FILES_HPP

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <utility>
#include <vector>

#include <pulsecast/concepts.hpp>
#include <pulsecast/io/detail/packed_points.hpp>
#include <pulsecast/io/detail/text/output.hpp>
#include <pulsecast/io/output_file.hpp>

/// Text files of points, pulses, subrays and waveforms.
namespace PULSECAST_NAMESPACE::io {

/// Settings of a text file.
struct TextFileSettings {
  double start_time = 0;  ///< clock time at tick 0 [s]

  void validate() const { require_finite("TextFileSettings::start_time", start_time, "s"); }
};

/// Further columns of a text file of points, after the standard ones.
struct PointTextColumns {
  std::vector<PointField> columns{};  ///< columns in order, see `layouts::columns`
  PointSettings points{};             ///< their values; the start time is that of the file
};

/// Writes points as text, one a line, in these columns, separated by blanks, without a header line:
///
///     x y z intensity echo_width returnNumber pulseReturnNumber fullwaveIndex hitObjectId classification gpsTime
///
/// x, y, z [m], intensity (amplitude of the echo [nW]) and echo_width [ns], nan if none was found,
/// have 4 decimals; gpsTime [s] has 9. The others are integers: return number, returns of the
/// pulse, index of the pulse, object, class. HELIOS++ has these columns. Further ones follow on
/// request, in the shortest form that reads back the same, nan if unknown. Only `close()` completes
/// the file: see `OutputFile`. @throws FileError @throws SettingError
class XyzWriter {
 public:
  explicit XyzWriter(std::filesystem::path path, const TextFileSettings& settings = {}, PointTextColumns more = {})
      : settings_(validated(settings)), more_(encoder(settings, std::move(more))), text_(OutputFile(std::move(path))) {}
  explicit XyzWriter(OutputFile file, const TextFileSettings& settings = {}, PointTextColumns more = {})
      : settings_(validated(settings)), more_(encoder(settings, std::move(more))), text_(std::move(file)) {}

  void operator()(const EchoBatch& batch) {
    for (const Shot& shot : batch.shots)
      for (const Echo& echo : batch.echoes_of(shot)) write(batch, shot, echo);
  }

  [[nodiscard]] static bool reads_empty_shots() noexcept { return false; }  ///< see ChoosesShots
  void close() { text_.close(); }

 private:
  [[nodiscard]] static std::optional<PointEncoder> encoder(const TextFileSettings& settings, PointTextColumns more) {
    if (more.columns.empty()) return std::nullopt;
    more.points.start_time = settings.start_time;
    return PointEncoder(PointLayout::packed(more.columns), std::move(more.points));
  }

  void write(const EchoBatch& batch, const Shot& shot, const Echo& echo) {
    constexpr double nano = 1e9;  // per unit
    text_.vector("the position of an echo", point_of(shot, echo), 4).reals(4, echo.amplitude * nano, echo.width * nano);
    text_.wholes(echo.number, shot.echoes, shot.index, echo.object, echo.classification);
    text_.reals(9, settings_.start_time + shot.tick.seconds());
    if (more_) more_->see(batch, shot, echo, [&](const PointView& view) { write_more(view); });
    text_.end_row();
  }

  void write_more(const PointView& view) {
    more_->store(view, record_.data());
    for (std::size_t k = 0; k < more_->layout().fields.size(); ++k) {
      const PointField& field = more_->layout().fields[k];
      if (std::isnan(more_->value(k, view)))
        text_.word("nan");
      else
        detail::add_number(text_.row(), field.type, record_.data() + field.offset);
    }
  }

  TextFileSettings settings_;
  std::optional<PointEncoder> more_;
  std::vector<std::byte> record_ = std::vector<std::byte>(more_ ? more_->layout().size : 0);  // of further columns
  TextOutput text_;
};
static_assert(EchoSink<XyzWriter>);

/// Writes pulses as text, with or without echoes, one a line, in these columns, without header:
///
///     ox oy oz dx dy dz time pulseIndex deviceIndex fate
///
/// ox, oy, oz: origin [m], 4 decimals; dx, dy, dz: unit direction, 9; time: departure [ns], 4, all exact;
/// pulseIndex: slot, the fullwaveIndex of points; deviceIndex: emitter, from 0; fate: number of its `Fate`:
/// 0 returned, 2 missed, 3 out of range, 4 below threshold, 5 absorbed. Pulses blocked by the optic (1) have no line.
/// HELIOS++ has the first nine, also in nanoseconds; but pulseIndex counts from 0 and over all devices, and directions
/// have more decimals. Only `close()` completes the file: see `OutputFile`. @throws FileError @throws SettingError
class PulseTextWriter {
 public:
  explicit PulseTextWriter(std::filesystem::path path, const TextFileSettings& settings = {})
      : settings_(validated(settings)), text_(OutputFile(std::move(path))) {}
  explicit PulseTextWriter(OutputFile file, const TextFileSettings& settings = {})
      : settings_(validated(settings)), text_(std::move(file)) {}

  void operator()(const EchoBatch& batch) {
    const Tick start = Tick::of_seconds(settings_.start_time);
    for (const Shot& shot : batch.shots) {
      text_.vector("the origin of a pulse", shot.origin, 4).vector("the direction of a pulse", shot.direction, 9);
      text_.nanoseconds(start + shot.tick).wholes(shot.index, shot.channel, static_cast<std::uint8_t>(shot.fate));
      text_.end_row();
    }
  }

  void close() { text_.close(); }

 private:
  TextFileSettings settings_;
  TextOutput text_;
};
static_assert(EchoSink<PulseTextWriter>);

/// Writes the hits of subrays of a `WithSubrayRecord` as text, one a line, in these columns:
///
///     fullwaveIndex subray x y z range intensity cosIncidence backscatter hitObjectId classification
///
/// fullwaveIndex: slot of the pulse; subray: number in the footprint, from 0; x, y, z: hit point
/// [m], 4 decimals; range [m], 4; intensity: received power of a pulse without length [nW], 9;
/// cosIncidence and backscatter as in `Hit`, 6; object and class. Subrays without a hit have no
/// line. There is no header. Only `close()` completes the file: see `OutputFile`. @throws FileError
class SubrayTextWriter {
 public:
  explicit SubrayTextWriter(std::filesystem::path path) : text_(OutputFile(std::move(path))) {}
  explicit SubrayTextWriter(OutputFile file) : text_(std::move(file)) {}

  void operator()(const EchoBatch& batch) {
    for (std::size_t i = 0; i < batch.shots.size(); ++i) {
      std::size_t subray = 0;
      for (const SubrayRecord& hit : batch.subrays_of(i)) {
        if (hit.met()) write(batch.shots[i], subray, hit);
        ++subray;
      }
    }
  }

  [[nodiscard]] static bool reads_empty_shots() noexcept { return false; }  ///< see ChoosesShots
  void close() { text_.close(); }

 private:
  void write(const Shot& shot, std::size_t subray, const SubrayRecord& hit) {
    constexpr double nano = 1e9;  // per unit
    text_.wholes(shot.index, subray).vector("the position of a hit", hit.point, 4).reals(4, hit.range);
    text_.reals(9, hit.power * nano).reals(6, hit.cos_incidence, hit.backscatter);
    text_.wholes(hit.object, hit.classification).end_row();
  }

  TextOutput text_;
};
static_assert(EchoSink<SubrayTextWriter>);

/// Writes waveforms as text, with or without echoes, one a line, in these columns, no header:
///
///     fullwaveIndex ox oy oz dx dy dz tmin tmax gpsTime w_0 ... w_(n-1)
///
/// fullwaveIndex: slot of the pulse; ox, oy, oz: origin [m], 4 decimals; dx, dy, dz: unit direction, 9;
/// tmin, tmax: times of the first and last sample [ns], 6; gpsTime: departure [s], 9; w: samples of power [nW], 9.
/// HELIOS++ has these columns. As there, tmin and tmax are one-way times, range by speed of light: sample i is from the
/// range `c (tmin + (tmax - tmin) i / (n - 1))`. Only `close()` completes the file: see `OutputFile`. @throws FileError
/// @throws SettingError
class WaveformTextWriter {
 public:
  explicit WaveformTextWriter(std::filesystem::path path, const TextFileSettings& settings = {})
      : settings_(validated(settings)), text_(OutputFile(std::move(path))) {}
  explicit WaveformTextWriter(OutputFile file, const TextFileSettings& settings = {})
      : settings_(validated(settings)), text_(std::move(file)) {}

  void operator()(const EchoBatch& batch) {
    for (const Shot& shot : batch.shots)
      if (shot.samples != 0) write(shot, batch);
  }

  [[nodiscard]] static bool reads_empty_shots() noexcept { return false; }  ///< see ChoosesShots
  void close() { text_.close(); }

 private:
  void write(const Shot& shot, const EchoBatch& batch) {
    constexpr double nano = 1e9, one_way = 0.5;
    const double last = shot.waveform_start + (shot.samples - 1) * batch.sample_interval;
    text_.wholes(shot.index).vector("the origin of a pulse", shot.origin, 4);
    text_.vector("the direction of a pulse", shot.direction, 9);
    text_.reals(6, shot.waveform_start * one_way * nano, last * one_way * nano);
    text_.reals(9, settings_.start_time + shot.tick.seconds());
    for (const float sample : batch.waveform_of(shot)) text_.reals(9, double{sample} * nano);
    text_.end_row();
  }

  TextFileSettings settings_;
  TextOutput text_;
};
static_assert(EchoSink<WaveformTextWriter>);

}  // namespace PULSECAST_NAMESPACE::io

#endif
