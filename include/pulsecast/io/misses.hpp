// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_MISSES_HPP
#define PULSECAST_IO_MISSES_HPP

#include <pulsecast/io/text_files.hpp>

/// Pulses without echoes: as points, and as a table.
namespace PULSECAST_NAMESPACE::io {

/// Settings of points for pulses without echoes.
struct MissSettings {
  double range = 1000;                ///< distance of the points along the beam [m]
  std::uint16_t classification = 64;  ///< class; default: first of a user, LAS 1.4 R15, table 17
  ObjectId object = 0;                ///< object number of the points

  void validate() const { require_within("MissSettings::range", range, 0, 1e9, "m"); }
};

/// Adds a point to each pulse of a batch that was sent and has no echo: at a set range along the
/// beam, with amplitude and reflectance 0 and a class of its own, as return 1 of 1. Such a shot
/// keeps its fate; shots with echoes, waveforms and recorded subrays stay as they are.
class MissPoints {
 public:
  /// @throws SettingError for settings out of range
  explicit MissPoints(const MissSettings& settings = {}) : settings_(validated(settings)) {}

  /// Batch with the points, valid until the next call, and as long as the other one.
  [[nodiscard]] EchoBatch operator()(const EchoBatch& batch) {
    shots_.assign(batch.shots.begin(), batch.shots.end());
    echoes_.clear();
    for (Shot& shot : shots_) {
      const auto own = batch.echoes_of(shot);
      shot.first_echo = static_cast<std::uint32_t>(echoes_.size());
      echoes_.insert(echoes_.end(), own.begin(), own.end());
      if (!own.empty()) continue;
      const auto& [range, classification, object] = settings_;
      echoes_.push_back({.range = range, .object = object, .classification = classification});
      shot.echoes = 1;
    }
    EchoBatch all = batch;
    all.shots = shots_;
    all.echoes = echoes_;
    return all;
  }

 private:
  MissSettings settings_;
  std::vector<Shot> shots_;
  std::vector<Echo> echoes_;
};

/// Sink that must be closed.
template <class S>
concept ClosableSink = requires(S& sink) {
  sink.close();
};

/// Sink around another, which gets points for pulses without echoes, too: see `MissPoints`.
template <class Sink>
requires EchoSink<std::remove_reference_t<Sink>>
class WithMisses {
 public:
  /// @throws SettingError for settings out of range
  explicit WithMisses(Sink sink, const MissSettings& settings = {})
      : sink_(std::forward<Sink>(sink)), points_(settings) {}

  void operator()(const EchoBatch& batch) { sink_(points_(batch)); }
  [[nodiscard]] static bool reads_empty_shots() noexcept { return true; }  ///< see ChoosesShots

  void close() requires ClosableSink<std::remove_reference_t<Sink>> { sink_.close(); }
  [[nodiscard]] const std::remove_reference_t<Sink>& sink() const noexcept { return sink_; }

 private:
  Sink sink_;
  MissPoints points_;
};
/// Holds a sink of its own.
template <class Sink>
WithMisses(Sink&&, MissSettings) -> WithMisses<std::remove_cvref_t<Sink>>;
/// As above.
template <class Sink>
WithMisses(Sink&&) -> WithMisses<std::remove_cvref_t<Sink>>;

/// Name of a fate.
[[nodiscard]] constexpr std::string_view name_of(Fate fate) noexcept {
  constexpr std::array<std::string_view, fate_count> names{"returned",     "blocked",         "missed",
                                                           "out_of_range", "below_threshold", "absorbed"};
  return names[static_cast<std::size_t>(fate)];
}

/// Writes pulses that were sent and gave no echo as text, one a line, in these columns, no header:
///
///     pulseIndex time ox oy oz dx dy dz fate leg deviceIndex
///
/// pulseIndex: slot, the fullwaveIndex of points and waveforms; time: departure [s], 9 decimals;
/// ox, oy, oz: origin [m], 4; dx, dy, dz: unit direction, 9; fate: `missed`, `out_of_range`,
/// `below_threshold` or `absorbed`; leg and deviceIndex (emitter), from 0. Pulses blocked by the
/// optic were never sent. `close()` completes the file: see `OutputFile`.
class MissTextWriter : public detail::TextFileWriter {
 public:
  using TextFileWriter::TextFileWriter;

  void operator()(const EchoBatch& batch) {
    for (const Shot& shot : batch.shots)
      if (shot.fate != Fate::returned) write(shot);
  }

  [[nodiscard]] static bool reads_empty_shots() noexcept { return true; }  ///< see ChoosesShots

 private:
  void write(const Shot& shot) {
    text_.wholes(shot.index).reals(9, clock(shot)).beam(shot);
    text_.word(name_of(shot.fate)).wholes(shot.leg, shot.channel).end_row();
  }
};
static_assert(EchoSink<MissTextWriter> && EchoSink<WithMisses<XyzWriter>> && EchoSink<WithMisses<XyzWriter&>>);

}  // namespace PULSECAST_NAMESPACE::io

#endif
