// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_LAS_WRITER_HPP
#define PULSECAST_IO_DETAIL_LAS_WRITER_HPP

#include <pulsecast/io/detail/las/encoder.hpp>
#include <pulsecast/io/detail/las/reference.hpp>
#include <pulsecast/version.hpp>

namespace PULSECAST_NAMESPACE::io::detail {

/// Reads back records of `record` bytes from `begin` on, some at a time: `task(at, bytes)`.
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

/// Extended variable-length records of a file: offset of the first [byte], and number.
struct LasExtendedRecords {
  std::uint64_t begin = 0;
  std::uint32_t count = 0;
};

/// Writes points as LAS with extra bytes. `Records`, as `LasRecords`, `LazRecords` or
/// `CopcRecords`, stores the point records, in pulse order or another, and may change them once all
/// are known. Source of every field: ASPRS LAS Specification 1.4 R15. Choices that it leaves open:
/// - coordinates are rounded to nearest; one beyond 32 bits, or not finite, is a `FileError`;
/// - intensity is linear in `LasIntensity`; Amplitude, Reflectance are levels [dB], -200 for zero;
/// - returns end at 15, or 5, by format: later ones are written as the last, see `pulses_cut`;
/// - classes end at 255, or 31: greater ones are written as the last, see `classes_cut`; point source id is the leg
/// plus 1, at most 65535; user data is the channel, at most 255, and scanner channel its lowest two bits;
/// - scan angle is that of `Pulse`; GPS time is that of the pulse for all its returns;
/// - coordinates, scale and offset are in the units of the reference system, heights in metres if
/// their system is unknown; extra values stay in metres;
/// - a reference system is written as well-known text; by its codes alone, as GeoTIFF keys in legacy
/// formats; in others, which have no keys, the text of UTM is known, and other codes are left out;
/// - colours are black, and attributes of objects, which are doubles, NaN if unknown;
/// - flags, scan direction and edge of flight line are 0, as echoes have no such fields.
///
/// A waveform is written once for all echoes of its pulse, see `LasPackets`, and not without
/// echoes. The return point waveform location L is the two-way time from the first sample to the
/// echo [ps]. The vector d points back to the instrument, with half the speed of light as length
/// [unit of the coordinates/ps]. Then `P + L d` is the origin of the first sample, and sample i is from `P + (L - i
/// spacing) d`, for point P. `close()` completes the `.wdp` file, then this one: see `OutputFile`.
template <class Records>
class LasFileWriter {
 public:
  LasFileWriter(std::filesystem::path path, LasSettings how, Records records);

  void operator()(const EchoBatch& batch);

  [[nodiscard]] static bool reads_empty_shots() noexcept { return false; }  ///< see ChoosesShots

  /// Offset of `Records` in the file, and size of the waveform file so far [byte].
  [[nodiscard]] std::uint64_t records_at() const noexcept { return records_at_; }
  [[nodiscard]] std::uint64_t packets_at() const noexcept { return packets_ ? packets_->position() : 0; }

  /// Pulses with more than 15 returns, or 5, by format: later returns have the number of the last.
  [[nodiscard]] std::uint64_t pulses_cut() const noexcept { return encoder_.tally().pulses_cut; }
  /// Points of a class above 255, or 31, by format.
  [[nodiscard]] std::uint64_t classes_cut() const noexcept { return encoder_.tally().classes_cut; }

  [[nodiscard]] Records& records() noexcept { return records_; }

  /// Takes over what others wrote: points up to offset `end`, and waveforms up to `packets_end`
  /// [byte] with samples `spacing` apart [ps]. Only `close()` may follow.
  void adopt(const LasTally& tally, const Vec3& first_point, std::uint64_t end, std::uint64_t packets_end = 0,
             std::uint32_t spacing = 0) {
    encoder_.tally() = tally;
    if (tally.points > 0) encoder_.choose_offset(first_point);
    file_.continue_at(end);
    if (packets_) packets_->adopt(packets_end, spacing);
  }

  /// Completes header and intensities, and gives the file its name. @throws FileError
  void close();

 private:
  using Header = LasBytes<375>;  ///< longest header

  [[nodiscard]] const LasSettings& settings() const noexcept { return encoder_.settings(); }
  [[nodiscard]] const LasLayout& layout() const noexcept { return encoder_.layout(); }

  [[nodiscard]] static LasSettings settled(LasSettings settings) {
    SpatialReference& in = settings.reference;
    if (!settings.wkt.empty()) in.wkt = settings.wkt;
    if (settings.epsg != 0) in.epsg = settings.epsg;
    if (settings.format == LasFormat::las_1_0) in.wkt.clear();
    if (in.wkt.empty() && settings.format == LasFormat::las_1_4) in.wkt = las_utm(in.epsg);
    return settings;
  }

  void write(const Shot& shot, const EchoBatch& batch) {
    std::optional<LasPacket> packet;
    if (packets_ && shot.samples != 0) packet = packets_->add(batch.waveform_of(shot), batch.sample_interval);
    encoder_.encode(shot, batch, packet ? &*packet : nullptr, [&](auto& record, const Vec3& point) {
      if (encoder_.tally().points == 0) encoder_.choose_offset(point);
      if (!encoder_.locate(record.data(), point)) misfit(point);
      records_.write(file_, std::span<const std::byte>(record).first(layout().record()));
    });
  }

  [[nodiscard]] std::filesystem::path packets_path() const {
    std::filesystem::path path = file_.path();
    if (path.replace_extension(".wdp") != file_.path()) return path;
    throw FileError(path.string(), "", "is the name of its waveform file; expected another extension, as .las");
  }

  [[noreturn]] void misfit(const Vec3& point) {
    file_.discard();
    throw FileError(file_.path().string(), "point " + std::to_string(encoder_.tally().points + 1),
                    encoder_.misfit(point));
  }

  /// Writes the header in its current state. Offsets: LAS 1.4 R15, Public Header Block. Other bytes
  /// are 0, as required of legacy counts with formats 6 to 9, and of the start of waveforms in a
  /// file of their own. Version 1.0 ends before it, and has no global encoding.
  void write_header() {
    const LasTally& tally = encoder_.tally();
    Header h{};
    h.put_text(0, "LASF");
    if (layout().minor != 0) h.put(6, global_encoding());
    h.put(24, std::uint8_t{1});
    h.put(25, layout().minor);
    h.put_text(26, "simulation");
    h.put_text(58, "pulsecast " PULSECAST_VERSION);
    if (settings().created) {
      using std::chrono::sys_days;
      const std::chrono::year year = settings().created->year();
      const auto day = sys_days{*settings().created} - sys_days{year / std::chrono::January / 1};
      h.put(90, static_cast<std::uint16_t>(day.count() + 1));  // 1 January is day 1
      h.put(92, static_cast<std::uint16_t>(int{year}));
    }
    h.put(94, static_cast<std::uint16_t>(layout().header));
    h.put(96, static_cast<std::uint32_t>(points_at_));
    h.put(100, variable_records_);
    h.put(104, static_cast<std::uint8_t>(layout().format | Records::format_bits));
    h.put(105, static_cast<std::uint16_t>(layout().record()));
    if (layout().legacy && tally.points <= std::numeric_limits<std::uint32_t>::max()) {
      h.put(107, static_cast<std::uint32_t>(tally.points));
      for (std::size_t i = 0; i < 5; ++i) h.put(111 + 4 * i, static_cast<std::uint32_t>(tally.points_by_return[i]));
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double offset = encoder_.offset()[static_cast<int>(axis)];
      h.put(131 + 8 * axis, settings().scale);
      h.put(155 + 8 * axis, offset);
      if (tally.points == 0) continue;
      h.put(179 + 16 * axis, tally.most[axis] * settings().scale + offset);
      h.put(187 + 16 * axis, tally.least[axis] * settings().scale + offset);
    }
    h.put(235, records_.extended().begin);
    h.put(243, records_.extended().count);
    h.put(247, tally.points);
    h.put(255, tally.points_by_return);
    const std::span<const std::byte> bytes = std::span(h).first(layout().header);
    if (file_.position() == 0)
      file_.write(bytes);
    else
      file_.overwrite(0, bytes);
  }

  /// Global encoding: bit 0 is the kind of time, bit 2 marks waveforms in a file of their own, bit
  /// 4 is set with well-known text, and always with formats 6 to 10. Source: LAS 1.4 R15, Global
  /// Encoding, Coordinate Reference System Representation.
  [[nodiscard]] std::uint16_t global_encoding() const noexcept {
    const bool wkt = !layout().legacy || !wkt_text().empty();
    const auto time = static_cast<unsigned>(settings().gps_time);
    return static_cast<std::uint16_t>(time | (packets_ ? 1U << 2 : 0U) | (wkt ? 1U << 4 : 0U));
  }

  /// Writes a whole record, or nothing.
  void write_descriptor(std::span<const std::byte> record) {
    file_.write(record);
    variable_records_ += record.empty() ? 0 : 1;
  }

  void write_record_header(std::string_view user, std::uint16_t record, std::size_t size,
                           std::string_view description) {
    auto h = las_vlr_header(user, record, size, description);
    if (layout().minor == 0) h.put(0, std::uint16_t{0xAABB});  // source: LAS 1.0, Record Signature
    file_.write(h);
    ++variable_records_;
  }

  /// Writes the descriptions of the extra bytes. Source: LAS 1.4 R15, Extra Bytes.
  void write_extra_bytes_record() {
    constexpr std::array<std::uint8_t, 11> types{0, 2, 1, 4, 3, 6, 5, 9, 10, 8, 7};  // by `NumberType`
    const std::vector<PointField> extras = las_extras(settings());
    write_record_header("LASF_Spec", 4, extras.size() * las_descriptor_size, "Extra Bytes");
    for (std::size_t k = 0; k < extras.size(); ++k) {
      LasBytes<las_descriptor_size> descriptor{};
      descriptor.put(2, types[static_cast<std::size_t>(extras[k].type)]);
      descriptor.put_text(4, las_cut(extras[k].name));
      descriptor.put_text(160, k < las_usual_extras.size() ? std::string(las_usual_extras[k].description)
                                                           : las_description(*extras[k].column));
      file_.write(descriptor);
    }
  }

  /// Writes the well-known text. Source: LAS 1.4 R15, OGC Coordinate System WKT.
  void write_wkt_record() {
    write_record_header("LASF_Projection", 2112, wkt_text().size() + 1, "OGC Coordinate System WKT");
    file_.write(std::string_view(wkt_text().c_str(), wkt_text().size() + 1));
  }
  [[nodiscard]] const std::string& wkt_text() const noexcept { return settings().reference.wkt; }

  /// Writes the GeoTIFF keys. Source: LAS 1.4 R15, GeoKeyDirectoryTag Record.
  void write_keys_record() {
    const std::vector<std::uint16_t> keys = las_geo_keys(settings().reference);
    write_record_header("LASF_Projection", 34735, std::span(keys).size_bytes(), "GeoTIFF GeoKeyDirectoryTag");
    file_.write(std::as_bytes(std::span(keys)));
  }

  LasEncoder encoder_;
  Records records_;
  OutputFile file_;
  std::optional<LasPackets> packets_;
  std::uint32_t variable_records_ = 0;                                 // number of them
  std::uint64_t descriptors_at_ = 0, points_at_ = 0, records_at_ = 0;  // offsets in the file [byte]
};

template <class Records>
LasFileWriter<Records>::LasFileWriter(std::filesystem::path path, LasSettings how, Records records)
    : encoder_(settled(validated(std::move(how)))), records_(std::move(records)), file_(std::move(path)) {
  if (settings().waveforms) packets_.emplace(packets_path());
  write_header();
  write_descriptor(Records::first_descriptor());
  write_extra_bytes_record();
  if (!wkt_text().empty()) write_wkt_record();
  if (layout().legacy && wkt_text().empty() && settings().reference.epsg != 0) write_keys_record();
  descriptors_at_ = file_.position();
  if (packets_) {
    file_.write(packets_->descriptors({}));
    ++variable_records_;
  }
  write_descriptor(Records::descriptor(layout()));
  if (layout().start_signature != 0) file_.write(std::string_view("\xDD\xCC", 2));  // as `LasLayout`
  points_at_ = file_.position();
  records_.begin(file_, layout(), encoder_.automatic_intensity());
  records_at_ = file_.position();
}

template <class Records>
void LasFileWriter<Records>::operator()(const EchoBatch& batch) {
  for (const Shot& shot : batch.shots)
    if (shot.echoes != 0) write(shot, batch);
}

template <class Records>
void LasFileWriter<Records>::close() {
  if (layout().minor == 0 && encoder_.tally().points > std::numeric_limits<std::uint32_t>::max())
    throw FileError(file_.path().string(), "", "has too many points; expected fewer than 2^32, with version 1.0");
  if (encoder_.automatic_intensity())
    records_.change(file_, [this](std::span<std::byte> some) { encoder_.scale_intensities(some); });
  records_.finish(file_, encoder_);
  const LasPackets::Used& used = encoder_.tally().descriptors;
  if (packets_)  // without the one in the room of the others, if there are none
    variable_records_ +=
        static_cast<std::uint32_t>(std::min<std::size_t>(used.count(), LasPackets::descriptor_count - 1));
  write_header();
  if (packets_) {
    file_.overwrite(descriptors_at_, packets_->descriptors(used));
    packets_->close();
  }
  file_.commit();
}

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
