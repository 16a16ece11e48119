// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_TEXT_FILES_HPP
#define PULSECAST_IO_TEXT_FILES_HPP

#include <pulsecast/io/detail/packed_points.hpp>

/// Text files of points, pulses, subrays and waveforms.
namespace PULSECAST_NAMESPACE::io {

namespace detail {

/// Text file with a time of its tick 0.
class TextFileWriter {
 public:
  /// Opens the file. @throws SettingError for settings out of range @throws FileError
  explicit TextFileWriter(std::filesystem::path path, const TextFileSettings& settings = {})
      : TextFileWriter(OutputFile(std::move(path)), settings) {}
  explicit TextFileWriter(OutputFile file, const TextFileSettings& settings = {})
      : settings_(validated(settings)), text_(std::move(file)) {}

  void close() { text_.close(); }

 protected:
  [[nodiscard]] double clock(const Shot& shot) const { return settings_.start_time + shot.tick.seconds(); }

  TextFileSettings settings_;
  TextOutput text_;
};

}  // namespace detail

/// Further columns of a text file of points, after the standard ones.
struct PointTextColumns {
  std::vector<PointField> columns{};  ///< columns in order, see `layouts::columns`
  PointSettings points{};             ///< their values; the start time is that of the file
};

/// Writes points as text, one a line, in these blank-separated columns, without a header:
///
///     x y z intensity echo_width returnNumber pulseReturnNumber fullwaveIndex hitObjectId classification gpsTime
///
/// x, y, z [m], intensity (amplitude [nW]) and echo_width [ns], nan if unknown, have 4 decimals;
/// gpsTime [s] has 9. Then integers: return number, returns of the pulse, its index, object, class.
/// These are the columns of HELIOS++. Further ones follow on request, in the shortest form that
/// reads back the same, or nan. `close()` completes the file: see `OutputFile`.
class XyzWriter : public detail::TextFileWriter {
 public:
  /// Opens the file. @throws SettingError for settings out of range @throws FileError
  explicit XyzWriter(std::filesystem::path path, const TextFileSettings& settings = {}, PointTextColumns more = {})
      : XyzWriter(OutputFile(std::move(path)), settings, std::move(more)) {}
  explicit XyzWriter(OutputFile file, const TextFileSettings& settings = {}, PointTextColumns more = {})
      : TextFileWriter(std::move(file), settings), more_(encoder(settings, std::move(more))) {}

  void operator()(const EchoBatch& batch) {
    for (const Shot& shot : batch.shots)
      for (const Echo& echo : batch.echoes_of(shot)) write(batch, shot, echo);
  }

  [[nodiscard]] static bool reads_empty_shots() noexcept { return false; }  ///< see ChoosesShots

 private:
  [[nodiscard]] static std::optional<PointEncoder> encoder(const TextFileSettings& settings, PointTextColumns more) {
    if (more.columns.empty()) return std::nullopt;
    more.points.start_time = settings.start_time;
    return PointEncoder(PointLayout::packed(more.columns), std::move(more.points));
  }

  void write(const EchoBatch& batch, const Shot& shot, const Echo& echo) {
    constexpr double nano = 1e9;  // per unit
    text_.vector("the position of an echo", point_of(shot, echo), 4);
    text_.reals(4, echo.amplitude * nano, echo.width * nano);
    text_.wholes(echo.number, shot.echoes, shot.index, echo.object, echo.classification);
    text_.reals(9, clock(shot));
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

  std::optional<PointEncoder> more_;
  std::vector<std::byte> record_ = std::vector<std::byte>(more_ ? more_->layout().size : 0);
};
static_assert(EchoSink<XyzWriter>);

/// Writes pulses as text, with or without echoes, one a line, in these columns, without a header:
///
///     ox oy oz dx dy dz time pulseIndex deviceIndex fate
///
/// ox, oy, oz: origin [m], 4 decimals; dx, dy, dz: unit direction, 9; time: departure [ns], 4, all
/// exact; pulseIndex: slot, the fullwaveIndex of points and waveforms; deviceIndex: emitter, from
/// 0; fate: number of its `Fate`: 0 returned, 2 missed, 3 out of range, 4 below threshold, 5
/// absorbed. Pulses blocked by the optic (1) were never sent. The first nine are columns of
/// HELIOS++; pulseIndex counts over all devices. `close()` completes the file: see `OutputFile`.
class PulseTextWriter : public detail::TextFileWriter {
 public:
  using TextFileWriter::TextFileWriter;

  void operator()(const EchoBatch& batch) {
    const Tick start = Tick::of_seconds(settings_.start_time);
    for (const Shot& shot : batch.shots) {
      text_.beam(shot).nanoseconds(start + shot.tick);
      text_.wholes(shot.index, shot.channel, static_cast<std::uint8_t>(shot.fate)).end_row();
    }
  }
};
static_assert(EchoSink<PulseTextWriter>);

/// Writes hits of subrays of a `WithSubrayRecord` footprint as text in these columns, no header:
///
///     fullwaveIndex subray x y z range intensity cosIncidence backscatter hitObjectId classification
///
/// fullwaveIndex: slot of the pulse; subray: number in the footprint, from 0; x, y, z: hit point [m], 4 decimals; range
/// [m], 4; intensity: received power of a pulse without length [nW], 9; cosIncidence and backscatter as in `Hit`, 6
/// each; object and class. Subrays without a hit have no line. `close()` completes the file: see `OutputFile`.
class SubrayTextWriter {
 public:
  /// Opens the file. @throws FileError
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
    text_.wholes(shot.index, subray).vector("the position of a hit", hit.point, 4);
    text_.reals(4, hit.range).reals(9, hit.power * nano);
    text_.reals(6, hit.cos_incidence, hit.backscatter).wholes(hit.object, hit.classification).end_row();
  }

  TextOutput text_;
};
static_assert(EchoSink<SubrayTextWriter>);

/// Writes waveforms as text, with or without echoes, one a line, in these columns, no header:
///
///     fullwaveIndex ox oy oz dx dy dz tmin tmax gpsTime w_0 ... w_(n-1)
///
/// fullwaveIndex: slot of the pulse; ox, oy, oz: origin [m], 4 decimals; dx, dy, dz: unit
/// direction, 9; tmin, tmax: one-way times of the first and last sample [ns], 6; gpsTime: departure
/// [s], 9; w: samples of received power [nW], 9. These are the columns of HELIOS++. Sample i is
/// from the range `c (tmin + (tmax - tmin) i / (n - 1))`. With `waveform_samples`, all rows have
/// that many, and tmax is of the last. `close()` completes the file: see `OutputFile`.
class WaveformTextWriter : public detail::TextFileWriter {
 public:
  using TextFileWriter::TextFileWriter;

  void operator()(const EchoBatch& batch) {
    for (const Shot& shot : batch.shots)
      if (shot.samples != 0) write(shot, batch);
  }

  [[nodiscard]] static bool reads_empty_shots() noexcept { return false; }  ///< see ChoosesShots

  [[nodiscard]] std::uint64_t waveforms_cut() const noexcept { return cut_; }        ///< longer ones
  [[nodiscard]] std::uint32_t samples_max() const noexcept { return samples_max_; }  ///< of a waveform

 private:
  void write(const Shot& shot, const EchoBatch& batch) {
    constexpr double nano = 1e9, one_way = 0.5;
    const std::uint32_t samples = settings_.waveform_samples != 0 ? settings_.waveform_samples : shot.samples;
    const double last = shot.waveform_start + (samples - 1) * batch.sample_interval;
    text_.wholes(shot.index).beam(shot);
    text_.reals(6, shot.waveform_start * one_way * nano, last * one_way * nano).reals(9, clock(shot));
    const std::span<const float> waveform = batch.waveform_of(shot);
    for (std::uint32_t i = 0; i < samples; ++i) text_.reals(9, i < shot.samples ? double{waveform[i]} * nano : 0.0);
    text_.end_row();
    cut_ += shot.samples > samples ? 1 : 0;
    samples_max_ = std::max(samples_max_, shot.samples);
  }

  std::uint64_t cut_ = 0;
  std::uint32_t samples_max_ = 0;
};
static_assert(EchoSink<WaveformTextWriter>);

}  // namespace PULSECAST_NAMESPACE::io

#endif
