// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_LAS_ENCODER_HPP
#define PULSECAST_IO_DETAIL_LAS_ENCODER_HPP

#include <pulsecast/io/detail/las/packets.hpp>
#include <pulsecast/io/detail/las/settings.hpp>

namespace PULSECAST_NAMESPACE::io {

/// Point statistics for the header of a LAS file. Those of parts add up, in any order.
struct LasTally {
  std::array<std::int32_t, 3> least{}, most{};       ///< extent of stored coordinates, in steps
  std::uint64_t points = 0;                          ///< number of points
  std::array<std::uint64_t, 15> points_by_return{};  ///< number of points by return number, from 1
  float max_amplitude = -200;                        ///< highest amplitude [dB]
  std::uint64_t pulses_cut = 0;                      ///< pulses with too many returns
  std::uint64_t classes_cut = 0;                     ///< points of a class beyond the greatest
  LasPackets::Used descriptors{};                    ///< those of the waveforms

  void add(const LasTally& other) noexcept {
    if (other.points == 0) return;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      least[axis] = points == 0 ? other.least[axis] : std::min(least[axis], other.least[axis]);
      most[axis] = points == 0 ? other.most[axis] : std::max(most[axis], other.most[axis]);
    }
    points += other.points;
    for (std::size_t i = 0; i < 15; ++i) points_by_return[i] += other.points_by_return[i];
    max_amplitude = std::max(max_amplitude, other.max_amplitude);
    pulses_cut += other.pulses_cut;
    classes_cut += other.classes_cut;
    descriptors |= other.descriptors;
  }
};

/// Encodes echoes as point records of a LAS file, as `detail::LasFileWriter`, and counts them.
/// Coordinates come last, so that all else is done before their offset is known. Points are in
/// metres, and their coordinates in units of the reference system.
class LasEncoder {
 public:
  using Record = detail::LasFields<std::vector<std::byte>>;  ///< point record

  /// `settings` must be valid.
  explicit LasEncoder(LasSettings settings)
      : settings_(std::move(settings)),
        layout_(settings_),
        columns_(layout_.columns, detail::las_points(settings_)),
        offset_(settings_.offset.value_or(Vec3{})) {
    const SpatialReference& in = settings_.reference;
    per_metre_ = {1 / in.unit, 1 / in.unit, 1 / in.vertical_unit};
  }

  /// Size of a point record with these settings [byte].
  [[nodiscard]] static std::size_t record_size(const LasSettings& settings) {
    return detail::LasLayout(settings).record();
  }

  /// Calls put(record, point) for every echo of a shot. `record`, which is reused, has no
  /// coordinates yet. `packet` is null without a waveform.
  template <class Put>
  void encode(const Shot& shot, const EchoBatch& batch, const LasPacket* packet, const Put& put) {
    Record& record = record_;
    record.assign(layout_.record(), std::byte{0});
    const std::uint32_t returns = std::min(shot.echoes, layout_.max_returns);
    if (shot.echoes > returns) ++tally_.pulses_cut;
    const auto source = static_cast<std::uint16_t>(std::min(shot.leg + 1U, 65535U));
    const double time = settings_.start_time + shot.tick.seconds();
    record.put(17, static_cast<std::uint8_t>(std::min<std::uint16_t>(shot.channel, 255)));
    if (layout_.legacy) {  // offsets: LAS 1.4 R15, Point Data Record Format 1
      record.put(16, detail::las_rounded<std::int8_t>(degrees(shot.scan_angle), -90, 90));
      record.put(18, source);
      record.put(20, time);
    } else {  // Point Data Record Format 6
      record.put(15, static_cast<std::uint8_t>((shot.channel & 3U) << 4));
      const double steps = degrees(shot.scan_angle) / 0.006;
      record.put(18, detail::las_rounded<std::int16_t>(steps, -30000, 30000));
      record.put(20, source);
      record.put(22, time);
    }
    if (packet) put_packet(record, shot, *packet);
    if (packet) tally_.descriptors.set(packet->descriptor);
    for (const Echo& echo : batch.echoes_of(shot)) {
      const std::uint32_t number = std::clamp<std::uint32_t>(echo.number, 1, returns);
      record.put(12, intensity(echo));
      record.put(14, static_cast<std::uint8_t>(number | returns << (layout_.legacy ? 3 : 4)));
      const auto classification = std::min<std::uint32_t>(echo.classification, layout_.max_class);
      record.put(layout_.legacy ? 15 : 16, static_cast<std::uint8_t>(classification));
      if (echo.classification > classification) ++tally_.classes_cut;
      const double delay = 2 / speed_of_light * echo.range - shot.waveform_start;
      if (packet) record.put(layout_.packet + 13, static_cast<float>(delay * 1e12));
      const PointView view{shot, echo, columns_.settings(), columns_.scan_start()};
      put_extras(view, record.data() + layout_.extras, std::make_index_sequence<detail::las_usual_extras.size()>());
      if (!layout_.columns.fields.empty()) columns_.store(batch, shot, echo, record.data());
      tally_.max_amplitude = std::max(tally_.max_amplitude, amplitude_in(record.data()));
      ++tally_.points_by_return[number - 1];
      put(record, point_of(shot, echo));
    }
  }

  /// Writes the coordinates of a point into its record and counts it; false if they do not fit.
  [[nodiscard]] bool locate(std::byte* record, const Vec3& point) noexcept {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double steps = steps_of(point, axis);
      if (!fits(steps)) return false;
      const auto stored = static_cast<std::int32_t>(steps);
      tally_.least[axis] = tally_.points == 0 ? stored : std::min(tally_.least[axis], stored);
      tally_.most[axis] = tally_.points == 0 ? stored : std::max(tally_.most[axis], stored);
      std::memcpy(record + 4 * axis, &stored, sizeof stored);
    }
    ++tally_.points;
    return true;
  }

  /// Error text for a point that `locate` refuses.
  [[nodiscard]] std::string misfit(const Vec3& point) const {
    std::size_t axis = 0;
    while (axis < 2 && fits(steps_of(point, axis))) ++axis;
    const std::string_view unit = per_metre_[static_cast<int>(axis)] == 1 ? " m" : " units of the reference system";
    const auto text = [](double value) {
      std::array<char, 32> digits;
      constexpr auto general = std::chars_format::general;
      return std::string(digits.begin(), std::to_chars(digits.begin(), digits.end(), value, general, 12).ptr);
    };
    const int k = static_cast<int>(axis);
    return text::joined({std::string_view("xyz").substr(axis, 1), " is ", text(point[k] * per_metre_[k]), unit,
                         ", which does not fit 32 bits; expected ", text(offset_[k]), unit, " +- ",
                         text(settings_.scale * std::numeric_limits<std::int32_t>::max()), unit,
                         " (offset, and 2^31 steps of ", text(settings_.scale), unit,
                         "; a greater scale, by LasSettings::scale or --lasScale, reaches farther)"});
  }

  /// Chooses the offset of the coordinates by the first point, unless set: stored numbers stay
  /// small. It is round: with a scale of 0.1 mm a multiple of 100 m.
  void choose_offset(const Vec3& first) noexcept {
    const double unit = settings_.scale * 1e6;
    for (int axis = 0; !settings_.offset && finite(first) && axis < 3; ++axis)
      offset_[axis] = std::nearbyint(first[axis] * per_metre_[axis] / unit) * unit + 0.0;  // + 0.0 avoids -0
  }

  /// True if intensities are 0 until `scale_intensities`.
  [[nodiscard]] bool automatic_intensity() const noexcept {
    return settings_.intensity == LasIntensity::amplitude && !settings_.intensity_full_scale;
  }

  /// Sets the intensities of whole records by their amplitudes, once the maximum is known.
  void scale_intensities(std::span<std::byte> bytes) const noexcept {
    for (std::size_t at = 0; at < bytes.size(); at += layout_.record()) {
      const double level = amplitude_in(bytes.data() + at);
      const double share = std::pow(10, (level - tally_.max_amplitude) / 10);
      const auto scaled = detail::las_rounded<std::uint16_t>(65535 * share, 0, 65535);
      std::memcpy(bytes.data() + at + 12, &scaled, sizeof scaled);
    }
  }

  /// Shifts the packet offsets of whole records by `later` bytes.
  void move_packets(std::span<std::byte> bytes, std::uint64_t later) const noexcept {
    for (std::size_t at = 0; at < bytes.size(); at += layout_.record()) {
      std::byte* const packet = bytes.data() + at + layout_.packet;
      std::uint64_t offset = 0;
      std::memcpy(&offset, packet + 1, sizeof offset);
      offset += packet[0] != std::byte{0} ? later : 0;  // only with a packet
      std::memcpy(packet + 1, &offset, sizeof offset);
    }
  }

  [[nodiscard]] const LasSettings& settings() const noexcept { return settings_; }
  [[nodiscard]] const detail::LasLayout& layout() const noexcept { return layout_; }
  [[nodiscard]] const Vec3& offset() const noexcept { return offset_; }    ///< of coordinates [unit of the file]
  [[nodiscard]] const LasTally& tally() const noexcept { return tally_; }  ///< of the points so far
  [[nodiscard]] LasTally& tally() noexcept { return tally_; }              ///< to sum over encoders

 private:
  /// Writes the usual extra values. Their columns are constants, so that no call is indirect.
  template <std::size_t... K>
  static void put_extras(const PointView& view, std::byte* to, std::index_sequence<K...>) noexcept {
    ((to = put_extra<K>(view, to)), ...);
  }
  template <std::size_t K>
  [[gnu::always_inline]] static std::byte* put_extra(const PointView& view, std::byte* to) noexcept {
    constexpr detail::LasUsualExtra extra = detail::las_usual_extras[K];
    constexpr auto get = extra.column->get;
    constexpr auto whole = extra.column->whole;
    return detail::visit_number_type(extra.type, [&]<class Number>() {
      if constexpr (std::is_integral_v<Number>)
        detail::store_whole<Number>(whole(view), to);
      else
        detail::store_number<Number>(get(view) * extra.scale, to);
      return to + sizeof(Number);
    });
  }
  /// Amplitude of a record, its second extra value [dB].
  [[nodiscard]] float amplitude_in(const std::byte* record) const noexcept {
    float level;
    std::memcpy(&level, record + layout_.extras + sizeof(double), sizeof level);
    return level;
  }

  /// Writes what all returns share of a packet. Offsets: LAS 1.4 R15, Point Data Record Format 4.
  void put_packet(Record& record, const Shot& shot, const LasPacket& packet) const noexcept {
    record.put(layout_.packet, packet.descriptor);
    record.put(layout_.packet + 1, packet.offset);
    record.put(layout_.packet + 9, packet.size);
    const Vec3 back = shot.direction * (-speed_of_light / 2 * 1e-12) * per_metre_;
    const std::array<float, 3> b{static_cast<float>(back.x), static_cast<float>(back.y), static_cast<float>(back.z)};
    record.put(layout_.packet + 17, b);
  }

  [[nodiscard]] std::uint16_t intensity(const Echo& echo) const noexcept {
    if (automatic_intensity()) return 0;
    const double ranges = echo.range / settings_.intensity_range;
    double value = settings_.intensity == LasIntensity::reflectance ? echo.reflectance : echo.amplitude;
    if (settings_.intensity == LasIntensity::range_normalized) value = value * ranges * ranges;
    value = value / settings_.intensity_full_scale.value_or(1) * 65535;
    return detail::las_rounded<std::uint16_t>(value, 0, 65535);
  }

  [[nodiscard]] double steps_of(const Vec3& point, std::size_t axis) const noexcept {
    const int k = static_cast<int>(axis);
    return std::nearbyint((point[k] * per_metre_[k] - offset_[k]) / settings_.scale);
  }
  [[nodiscard]] static bool fits(double steps) noexcept {
    using Limits = std::numeric_limits<std::int32_t>;
    return steps >= Limits::min() && steps <= Limits::max();
  }

  LasSettings settings_;
  detail::LasLayout layout_;
  PointEncoder columns_;  // colours and extra values
  Vec3 offset_;           // [unit of the file]
  Vec3 per_metre_;        // units of the coordinates in a metre
  LasTally tally_;
  Record record_;  // of the point that is encoded
};

}  // namespace PULSECAST_NAMESPACE::io

#endif
