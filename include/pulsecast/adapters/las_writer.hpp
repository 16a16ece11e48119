// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <limits>
#include <locale>
#include <optional>
#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <pulsecast/adapters/las_bytes.hpp>
#include <pulsecast/adapters/las_layout.hpp>
#include <pulsecast/adapters/las_packets.hpp>
#include <pulsecast/adapters/las_reference.hpp>
#include <pulsecast/adapters/las_settings.hpp>
#include <pulsecast/adapters/output_file.hpp>
#include <pulsecast/base/units.hpp>
#include <pulsecast/concepts.hpp>
#include <pulsecast/version.hpp>

namespace pulsecast::adapters::detail {

/// A ratio of powers as a level [dB], at least -200: the level of nothing.
[[nodiscard]] inline float las_level(double ratio) noexcept { return static_cast<float>(ratio > 1e-20 ? 10 * std::log10(ratio) : -200.0); }

/// Reads what was written from some byte on, records of so many bytes, again: `task(at, bytes)` gets whole records, some at a time.
template <class Task>
void las_in_blocks(OutputFile& file, std::uint64_t begin, std::size_t record, const Task& task) {
  const std::uint64_t at_once = (std::size_t{1} << 20) / record * record, end = file.position();
  std::vector<std::byte> bytes;
  for (std::uint64_t at = begin; at < end; at += at_once) {
    bytes.resize(static_cast<std::size_t>(std::min(at_once, end - at)));
    file.read(at, bytes);
    task(at, std::span(bytes));
  }
}

/// Writes points as LAS with extra bytes, in pulse order; `Records` puts their records into the file as it will, and may change them once
/// when all are known. It offers what `LasRecords` and `LazRecords` do.
/// Source of every field: ASPRS LAS Specification 1.4 R15. What it leaves open is decided so:
/// - coordinates are rounded to the nearest step; one that does not fit 32 bits, or is not finite, is a `FileError`;
/// - intensity is linear in what `LasIntensity` says; the extra bytes Amplitude and Reflectance are levels [dB], -200 for nothing;
/// - return numbers and their count end at 15, or 5, as the format does: later returns are written as the 15th;
/// - classes end at 255, or 31; point source id is the leg plus 1, at most 65535; scanner channel is the channel's lowest two bits;
/// - scan angle counts from down, positive to the right of the flight; GPS time is that of the pulse, alike in all its returns;
/// - a reference system that is known by its code alone, and not one of UTM, is written as GeoTIFF keys and the WKT bit is left out: the
///   specification wants well-known text with point formats 6 and 9, but a code that readers understand is more than nothing. With legacy
///   formats, a code is always written as keys;
/// - flags, scan direction, edge of flight line and user data are 0, for no field of an echo tells them.
///
/// Waveforms are written once for all echoes of their pulse, as `LasPackets` says; those of pulses without echoes are not, as no
/// point could refer to them. The location L of a point's return is the two-way time from the first sample to the echo [ps], and the vector
/// d points back to the instrument, half the speed of light long [m/ps]. So, as in the specification, `P + L d` is the anchor, where the
/// first sample is from, and sample i is from `P + (L - i spacing) d`; P is the point.
/// Only `close()` makes the file: see `OutputFile`. The `.wdp` file is made before the LAS file, so that this is whole when it is there.
template <class Records>
class LasFileWriter {
 public:
  LasFileWriter(std::filesystem::path path, LasSettings settings, Records records)
      : settings_(validated(std::move(settings))),
        records_(std::move(records)),
        layout_(settings_.format, settings_.waveforms),
        file_(std::move(path)),
        offset_(settings_.offset.value_or(Vec3{})) {
    if (settings_.format == LasFormat::las_1_0) settings_.wkt.clear();
    if (settings_.wkt.empty() && !layout_.legacy) settings_.wkt = las_utm(settings_.epsg);
    if (settings_.waveforms) packets_.emplace(packets_path());
    write_header();
    write_extra_bytes_record();
    if (!settings_.wkt.empty()) write_wkt_record();
    if (by_keys()) write_keys_record();
    descriptors_at_ = file_.position();
    if (packets_) {
      file_.write(packets_->descriptors());
      variable_records_ += LasPackets::descriptor_count;
    }
    file_.write(Records::descriptors());
    variable_records_ += Records::descriptor_count;
    if (layout_.start_signature != 0) file_.write(std::string_view("\xDD\xCC", 2));  // source: LAS 1.0, Point Data Start Signature
    points_at_ = file_.position();
    records_.begin(file_, layout_.record(), automatic_intensity());
  }

  void operator()(const EchoBatch& batch) {
    for (const Shot& shot : batch.shots) {
      if (shot.echoes != 0) write(shot, batch);
    }
  }

  /// Enters numbers and bounds into the header, gives intensities their scale if it is automatic, and the file its name.
  void close() {
    if (layout_.minor == 0 && points_ > std::numeric_limits<std::uint32_t>::max())
      throw FileError(file_.path().string(), "", "has too many points; expected fewer than 2^32, with version 1.0");
    if (automatic_intensity()) records_.change(file_, [this](std::span<std::byte> some) { scale_intensities(some); });
    records_.finish(file_);
    write_header();
    if (packets_) {
      file_.overwrite(descriptors_at_, packets_->descriptors());
      packets_->close();
    }
    file_.commit();
  }

 private:
  using Header = LasBytes<375>;  ///< the longest
  using Record = LasBytes<30 + las_packet_size + las_extras_size>;
  static constexpr std::size_t range_at = 0, amplitude_at = 8, reflectance_at = 12, width_at = 16, pulse_at = 20, object_at = 28;

  void write(const Shot& shot, const EchoBatch& batch) {
    Record record{};
    const std::span<const std::byte> bytes = std::span(record).first(layout_.record());
    const std::uint32_t returns = std::min(shot.echoes, layout_.most_returns);
    const auto source = static_cast<std::uint16_t>(std::min(shot.leg + 1U, 65535U));
    const double time = settings_.start_time + shot.tick.seconds();
    if (layout_.legacy) {  // positions: LAS 1.4 R15, Point Data Record Format 1
      record.put(16, las_rounded<std::int8_t>(degrees(shot.scan_angle), -90, 90));
      record.put(18, source);
      record.put(20, time);
    } else {  // Point Data Record Format 6
      record.put(15, static_cast<std::uint8_t>((shot.channel & 3U) << 4));
      record.put(18, las_rounded<std::int16_t>(degrees(shot.scan_angle) / 0.006, -30000, 30000));
      record.put(20, source);
      record.put(22, time);
    }
    const bool has_waveform = packets_ && shot.samples != 0;
    if (has_waveform) put_packet(record, shot, packets_->add(batch.waveform_of(shot), batch.sample_interval));
    const std::size_t extras = layout_.extras;
    record.put(extras + pulse_at, shot.index);
    for (const Echo& echo : batch.echoes_of(shot)) {
      const Vec3 point = point_of(shot, echo);
      if (points_ == 0 && !settings_.offset) choose_offset(point);
      const std::uint32_t number = std::clamp<std::uint32_t>(echo.number, 1, returns);
      const float amplitude = las_level(echo.amplitude / settings_.amplitude_reference);
      most_amplitude_ = std::max(most_amplitude_, amplitude);
      record.put(0, coordinate(point.x, offset_.x, 0));
      record.put(4, coordinate(point.y, offset_.y, 1));
      record.put(8, coordinate(point.z, offset_.z, 2));
      record.put(12, intensity(echo));
      record.put(14, static_cast<std::uint8_t>(number | returns << (layout_.legacy ? 3 : 4)));
      record.put(layout_.legacy ? 15 : 16, static_cast<std::uint8_t>(std::min<std::uint32_t>(echo.classification, layout_.most_class)));
      if (has_waveform) record.put(layout_.packet + 13, static_cast<float>((2 / speed_of_light * echo.range - shot.waveform_start) * 1e12));
      record.put(extras + range_at, echo.range);
      record.put(extras + amplitude_at, amplitude);
      record.put(extras + reflectance_at, las_level(echo.reflectance));
      record.put(extras + width_at, static_cast<float>(echo.width * 1e9));
      record.put(extras + object_at, echo.object);
      records_.write(file_, bytes);
      ++points_;
      ++points_by_return_[number - 1];
    }
  }

  [[nodiscard]] std::filesystem::path packets_path() const {
    std::filesystem::path path = file_.path();
    if (path.replace_extension(".wdp") != file_.path()) return path;
    throw FileError(path.string(), "", "is where its waveforms go; expected a name that ends otherwise, as in .las");
  }

  /// What of a wave packet all returns share. Positions: LAS 1.4 R15, Point Data Record Format 4, from the packet's first byte.
  void put_packet(Record& record, const Shot& shot, const LasPacket& packet) const noexcept {
    record.put(layout_.packet, packet.descriptor);
    record.put(layout_.packet + 1, packet.offset);
    record.put(layout_.packet + 9, packet.size);
    const Vec3 back = shot.direction * (-speed_of_light / 2 * 1e-12);
    for (int axis = 0; axis < 3; ++axis)
      record.put(layout_.packet + 17 + 4 * static_cast<std::size_t>(axis), static_cast<float>(back[axis]));
  }

  [[nodiscard]] bool automatic_intensity() const noexcept {
    return settings_.intensity == LasIntensity::amplitude && !settings_.intensity_full_scale;
  }

  [[nodiscard]] std::uint16_t intensity(const Echo& echo) const noexcept {
    if (automatic_intensity()) return 0;  // until `close()`
    const double value = settings_.intensity == LasIntensity::amplitude ? echo.amplitude : echo.reflectance;
    return las_rounded<std::uint16_t>(value / settings_.intensity_full_scale.value_or(1) * 65535, 0, 65535);
  }

  /// Of whole records: the greatest amplitude is known now, and those of the points are in their extra bytes.
  void scale_intensities(std::span<std::byte> bytes) const noexcept {
    for (std::size_t at = 0; at < bytes.size(); at += layout_.record()) {
      float level = 0;
      std::memcpy(&level, bytes.data() + at + layout_.extras + amplitude_at, sizeof level);
      const auto scaled = las_rounded<std::uint16_t>(65535 * std::pow(10, (double{level} - most_amplitude_) / 10), 0, 65535);
      std::memcpy(bytes.data() + at + 12, &scaled, sizeof scaled);
    }
  }

  /// Far from the origin numbers stay small this way, and the offset reads well: with steps of 0.1 mm it is a multiple of 100 m.
  void choose_offset(const Vec3& first) {
    const double unit = settings_.scale * 1e6;
    if (finite(first))
      offset_ = {std::nearbyint(first.x / unit) * unit, std::nearbyint(first.y / unit) * unit, std::nearbyint(first.z / unit) * unit};
  }

  [[nodiscard]] std::int32_t coordinate(double value, double offset, std::size_t axis) {
    const double steps = std::nearbyint((value - offset) / settings_.scale);
    if (!(steps >= std::numeric_limits<std::int32_t>::min() && steps <= std::numeric_limits<std::int32_t>::max()))
      misfit(value, offset, axis);
    const auto stored = static_cast<std::int32_t>(steps);
    least_[axis] = points_ == 0 ? stored : std::min(least_[axis], stored);
    most_[axis] = points_ == 0 ? stored : std::max(most_[axis], stored);
    return stored;
  }

  [[noreturn]] void misfit(double value, double offset, std::size_t axis) {
    file_.discard();
    std::ostringstream problem;
    problem.imbue(std::locale::classic());
    problem.precision(12);
    problem << "xyz"[axis] << " is " << value << " m, which does not fit 32 bits; expected " << offset << " m +- "
            << settings_.scale * std::numeric_limits<std::int32_t>::max() << " m (offset, and 2^31 steps of " << settings_.scale << " m)";
    throw FileError(file_.path().string(), "point " + std::to_string(points_ + 1), problem.str());
  }

  /// Writes the header as of now. Positions: LAS 1.4 R15, Public Header Block; what is not put is 0, as the legacy numbers must be with
  /// formats 6 and 9, and the start of waveforms with those in a file of their own. Version 1.0 ends before it, and has no global encoding.
  void write_header() {
    Header h{};
    h.put_text(0, "LASF");
    if (layout_.minor != 0) h.put(6, global_encoding());
    h.put(24, std::uint8_t{1});
    h.put(25, layout_.minor);
    h.put_text(26, "simulation");
    h.put_text(58, "pulsecast " PULSECAST_VERSION);
    if (settings_.created) {
      using std::chrono::sys_days;
      const std::chrono::year year = settings_.created->year();
      const auto day = sys_days{*settings_.created} - sys_days{year / std::chrono::January / 1};
      h.put(90, static_cast<std::uint16_t>(day.count() + 1));  // 1 January is day 1
      h.put(92, static_cast<std::uint16_t>(int{year}));
    }
    h.put(94, static_cast<std::uint16_t>(layout_.header));
    h.put(96, static_cast<std::uint32_t>(points_at_));
    h.put(100, variable_records_);
    h.put(104, static_cast<std::uint8_t>(layout_.format | Records::format_bits));
    h.put(105, static_cast<std::uint16_t>(layout_.record()));
    if (layout_.legacy && points_ <= std::numeric_limits<std::uint32_t>::max()) {
      h.put(107, static_cast<std::uint32_t>(points_));
      for (std::size_t i = 0; i < 5; ++i) h.put(111 + 4 * i, static_cast<std::uint32_t>(points_by_return_[i]));
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double offset = offset_[static_cast<int>(axis)];
      h.put(131 + 8 * axis, settings_.scale);
      h.put(155 + 8 * axis, offset);
      if (points_ == 0) continue;
      h.put(179 + 16 * axis, most_[axis] * settings_.scale + offset);
      h.put(187 + 16 * axis, least_[axis] * settings_.scale + offset);
    }
    h.put(247, points_);
    for (std::size_t i = 0; i < points_by_return_.size(); ++i) h.put(255 + 8 * i, points_by_return_[i]);
    const std::span<const std::byte> bytes = std::span(h).first(layout_.header);
    if (file_.position() == 0)
      file_.write(bytes);
    else
      file_.overwrite(0, bytes);
  }

  /// Source: LAS 1.4 R15, Global Encoding: bit 0 is the kind of time, bit 2 says waveforms are in a file of their own, bit 4 must be set
  /// with well-known text, and with formats 6 and 9.
  [[nodiscard]] std::uint16_t global_encoding() const noexcept {
    const bool wkt = layout_.legacy ? !settings_.wkt.empty() : !by_keys();
    return static_cast<std::uint16_t>(static_cast<unsigned>(settings_.gps_time) | (packets_ ? 1U << 2 : 0U) | (wkt ? 1U << 4 : 0U));
  }

  void write_record_header(std::string_view user, std::uint16_t record, std::size_t size, std::string_view description) {
    auto h = las_vlr_header(user, record, size, description);
    if (layout_.minor == 0) h.put(0, std::uint16_t{0xAABB});  // source: LAS 1.0, Variable Length Records, Record Signature
    file_.write(h);
    ++variable_records_;
  }

  /// Source: LAS 1.4 R15, Extra Bytes.
  void write_extra_bytes_record() {
    write_record_header("LASF_Spec", 4, las_extras.size() * las_descriptor_size, "Extra Bytes");
    for (const LasExtra& extra : las_extras) {
      LasBytes<las_descriptor_size> descriptor{};
      descriptor.put(2, extra.type);
      descriptor.put_text(4, extra.name);
      descriptor.put_text(160, extra.description);
      file_.write(descriptor);
    }
  }

  /// Source: LAS 1.4 R15, OGC Coordinate System WKT.
  void write_wkt_record() {
    write_record_header("LASF_Projection", 2112, settings_.wkt.size() + 1, "OGC Coordinate System WKT");
    file_.write(std::string_view(settings_.wkt.c_str(), settings_.wkt.size() + 1));
  }

  /// Whether the reference system is known by its code alone.
  [[nodiscard]] bool by_keys() const noexcept { return settings_.wkt.empty() && settings_.epsg != 0; }

  /// Source: LAS 1.4 R15, GeoKeyDirectoryTag Record.
  void write_keys_record() {
    const auto keys = las_geo_keys(settings_.epsg);
    write_record_header("LASF_Projection", 34735, sizeof keys, "GeoTIFF GeoKeyDirectoryTag");
    file_.write(std::as_bytes(std::span(keys)));
  }

  LasSettings settings_;
  Records records_;
  LasLayout layout_;
  OutputFile file_;
  std::optional<LasPackets> packets_;
  Vec3 offset_;
  std::uint32_t variable_records_ = 0;                // of variable length
  std::uint64_t descriptors_at_ = 0, points_at_ = 0;  // from the beginning of the file [byte]
  std::array<std::int32_t, 3> least_{}, most_{};      // of the coordinates as stored
  std::uint64_t points_ = 0;
  std::array<std::uint64_t, 15> points_by_return_{};
  float most_amplitude_ = -200;  // [dB]
};

}  // namespace pulsecast::adapters::detail
