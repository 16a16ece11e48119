// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_LAS_PACKETS_HPP
#define PULSECAST_IO_DETAIL_LAS_PACKETS_HPP

#include <bitset>

#include <pulsecast/io/detail/las/bytes.hpp>
#include <pulsecast/io/output_file.hpp>

namespace PULSECAST_NAMESPACE::io {

/// Place of a point's waveform; all zero without one.
struct LasPacket {
  std::uint8_t descriptor = 0;  ///< record id of its descriptor, minus 99
  std::uint64_t offset = 0;     ///< offset from the beginning of the packet file [byte]
  std::uint32_t size = 0;       ///< size of the packet [byte]
};

/// Writes waveforms as packets of a `.wdp` file beside the LAS file. Source: LAS 1.4 R15, Waveform
/// Packet Descriptor, Waveform Data Packets, Extended Variable Length Records.
///
/// A sample is an unsigned 16-bit number: power [W] is `offset + gain * number`. Number 4096 is
/// zero power, so noise may be negative. Each packet has the smallest gain that its samples fit, of
/// eleven powers of 16 from 2^-52 to 2^-12 W. The error is at most 1/7680 of the packet's peak, or
/// 2^-53 W, unless noise reaches 1/15 of the peak. Samples above 15 W are clipped. Packets are
/// padded with zero power to one of 23 sizes, two an octave, from 16 to 32768 samples. So there are
/// 253 descriptors; a file has those that its packets use, in room for all of them.
class LasPackets {
 public:
  /// Throws a `FileError` if the file cannot be made.
  explicit LasPackets(std::filesystem::path to) : file_(std::move(to)) { file_.write(header()); }

  /// Piece of such a file without header; offsets count from the beginning of the piece.
  explicit LasPackets(OutputFile piece) : file_(std::move(piece)) {}
  void end_piece() { file_.commit(); }  ///< ends such a piece

  /// Takes over packets that others wrote up to `end` [byte]; `spacing` of samples [ps].
  void adopt(std::uint64_t end, std::uint32_t spacing) {
    file_.continue_at(end);
    spacing_ = spacing;
  }

  /// Offset of the next packet [byte]
  [[nodiscard]] std::uint64_t position() const noexcept { return file_.position(); }
  /// Interval of samples, 0 without packets [ps]
  [[nodiscard]] std::uint32_t spacing() const noexcept { return spacing_; }

  /// Writes a waveform [W] of at least one sample; `interval` of samples [s]. Throws a `FileError`
  /// for more than `max_samples`, or an interval other than before or not of whole picoseconds.
  [[nodiscard]] LasPacket add(std::span<const float> waveform, double interval) {
    require_interval(interval);
    const unsigned size_class = size_class_of(waveform.size());
    const unsigned gain_class = gain_class_of(waveform);
    raw_.assign(samples_of(size_class), no_light);
    const double per_watt = 1 / gain_of(gain_class);
    for (std::size_t i = 0; i < waveform.size(); ++i) {
      const double number = no_light + 0.5 + double{waveform[i]} * per_watt;
      raw_[i] = static_cast<std::uint16_t>(number > 0 ? (number < 65535 ? number : 65535) : 0);
    }
    const std::span<const std::byte> bytes = std::as_bytes(std::span(raw_));
    file_.write(bytes);
    const auto size = static_cast<std::uint32_t>(bytes.size());
    return {index_of(size_class, gain_class), file_.position() - size, size};
  }

  /// Descriptors by their number, `LasPacket::descriptor`.
  using Used = std::bitset<256>;

  /// Records for the LAS file, with headers: the descriptors in use, and one that fills their room,
  /// always `descriptors_size` bytes. Source: LAS 1.4 R15, Superseded, which tells to ignore it.
  [[nodiscard]] std::vector<std::byte> descriptors(const Used& used) const {
    std::vector<std::byte> bytes;
    for (unsigned size_class = 0; size_class < size_classes; ++size_class)
      for (unsigned gain_class = 0; gain_class < gain_classes; ++gain_class) {
        if (!used[index_of(size_class, gain_class)]) continue;
        const auto record = static_cast<std::uint16_t>(99 + index_of(size_class, gain_class));
        const auto head = detail::las_vlr_header("LASF_Spec", record, descriptor_size, "Waveform Packet Descriptor");
        detail::LasBytes<descriptor_size> d{};
        d.put(0, std::uint8_t{16});  // bits per sample; then 0: not compressed
        d.put(2, static_cast<std::uint32_t>(samples_of(size_class)));
        d.put(6, spacing_);
        d.put(10, gain_of(gain_class));
        d.put(18, -no_light * gain_of(gain_class));
        bytes.insert(bytes.end(), head.begin(), head.end());
        bytes.insert(bytes.end(), d.begin(), d.end());
      }
    if (const std::size_t rest = descriptors_size - bytes.size(); rest > 0) {
      const auto head = detail::las_vlr_header("LASF_Spec", 7, rest - 54, "room for descriptors");
      bytes.insert(bytes.end(), head.begin(), head.end());
    }
    bytes.resize(descriptors_size);
    return bytes;
  }

  /// Finishes the file and gives it its name.
  void close() {
    file_.overwrite(0, header());
    file_.commit();
  }

  static constexpr double max_samples = 32768;  ///< samples of a waveform, at most
  static constexpr unsigned size_classes = 23, gain_classes = 11;
  static constexpr unsigned descriptor_count = size_classes * gain_classes;
  static constexpr std::size_t descriptors_size = std::size_t{descriptor_count} * (54 + 26);  ///< [byte]

 private:
  static constexpr std::size_t header_size = 60, descriptor_size = 26;  // [byte]
  static constexpr std::uint16_t no_light = 4096;

  [[nodiscard]] static constexpr std::size_t samples_of(unsigned size_class) noexcept {
    return (size_class % 2 == 0 ? std::size_t{16} : std::size_t{24}) << (size_class / 2);
  }
  [[nodiscard]] static double gain_of(unsigned gain_class) noexcept {
    return std::ldexp(1.0, static_cast<int>(4 * gain_class) - 52);
  }
  static constexpr std::uint8_t index_of(unsigned size_class, unsigned gain_class) noexcept {
    return static_cast<std::uint8_t>(1 + size_class * gain_classes + gain_class);
  }

  [[nodiscard]] unsigned size_class_of(std::size_t samples) {
    unsigned c = 0;
    while (c < size_classes && samples_of(c) < samples) ++c;
    if (c < size_classes) return c;
    reject({"a waveform has ", std::to_string(samples), " samples; expected at most ",
            std::to_string(samples_of(size_classes - 1))});
  }

  [[nodiscard]] static unsigned gain_class_of(std::span<const float> waveform) noexcept {
    const auto [low, high] = std::minmax_element(waveform.begin(), waveform.end());
    unsigned c = 0;
    while (c + 1 < gain_classes && (*high > (65535 - no_light) * gain_of(c) || *low < -no_light * gain_of(c))) ++c;
    return c;
  }

  /// Checks the sample interval, one per file, in whole picoseconds up to a rounding of 1e-6 ps.
  void require_interval(double interval) {
    const double picoseconds = interval * 1e12, whole = std::nearbyint(picoseconds);
    const bool can_be = std::fabs(picoseconds - whole) <= 1e-6 && whole >= 1 && whole < 0x1p32;
    if (can_be && spacing_ == 0) spacing_ = static_cast<std::uint32_t>(whole);
    if (can_be && spacing_ == whole) return;
    const std::string before = std::to_string(spacing_) + " ps, as before";
    reject({"samples are ", text::to_text(picoseconds), " ps apart; expected ",
            spacing_ == 0 ? "a whole number from 1 to 2^32 - 1" : before});
  }

  [[noreturn]] void reject(std::initializer_list<std::string_view> problem) {
    file_.discard();
    throw FileError(file_.path().string(), "byte " + std::to_string(file_.position()), text::joined(problem));
  }

  [[nodiscard]] detail::LasBytes<header_size> header() const {
    detail::LasBytes<header_size> h{};
    h.put_text(2, "LASF_Spec");
    h.put(18, std::uint16_t{65535});
    h.put(20, std::max<std::uint64_t>(file_.position(), header_size) - header_size);
    h.put_text(28, "Waveform Data Packets");
    return h;
  }

  OutputFile file_;
  std::uint32_t spacing_ = 0;  // interval of samples; 0 before the first packet [ps]
  std::vector<std::uint16_t> raw_;
};

}  // namespace PULSECAST_NAMESPACE::io

#endif
