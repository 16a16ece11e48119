// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_PCAP_HPP
#define PULSECAST_IO_PCAP_HPP

#include <pulsecast/io/detail/packets/packet.hpp>
#include <pulsecast/io/output_file.hpp>

namespace PULSECAST_NAMESPACE::io {

/// Settings of a capture file.
struct PcapSettings {
  Ipv4Address source{192, 168, 1, 201};         ///< address of the sensor
  Ipv4Address destination{255, 255, 255, 255};  ///< address of the receiver: by default, all hosts
  bool nanoseconds = false;                     ///< times in nanoseconds, in place of microseconds
};

namespace detail {

/// Frame of a packet: record of the file, and big-endian headers of Ethernet, IPv4 and UDP.
class PacketFrame {
 public:
  static constexpr std::size_t record = 16;           // source: IETF draft-ietf-opsawg-pcap, 5 [byte]
  static constexpr std::size_t ethernet = 14;         // source: IEEE 802.3, frame format [byte]
  static constexpr std::size_t ip = 20, udp = 8;      // source: RFC 791, 3.1; RFC 768 [byte]
  static constexpr std::size_t payload_max = 65'507;  // by the lengths of IPv4 and UDP [byte]

  explicit PacketFrame(const PcapSettings& settings) noexcept {
    for (std::size_t k = 0; k < 6; ++k) bytes_[record + k] = std::byte{0xFF};  // to all hosts
    bytes_[record + 6] = std::byte{0x02};                                      // locally unique
    bytes_[record + 11] = std::byte{0x01};
    put_big(record + 12, 0x0800);  // IPv4
    put_big(start, 0x4500);        // version 4, a header of 5 words
    put_big(start + 6, 0x4000);    // not to be divided
    put_big(start + 8, 0x4011);    // 64 hops, UDP
    for (std::size_t k = 0; k < 4; ++k) {
      bytes_[start + 12 + k] = std::byte{settings.source[k]};
      bytes_[start + 16 + k] = std::byte{settings.destination[k]};
    }
  }

  [[nodiscard]] std::span<const std::byte> before(const SensorPacket& packet, std::uint64_t per_second) noexcept {
    const std::uint64_t parts = parts_of(packet.time, per_second);
    const auto length = static_cast<std::uint32_t>(ethernet + ip + udp + packet.payload.size());
    put(bytes_, 0, static_cast<std::uint32_t>(parts / per_second));
    put(bytes_, 4, static_cast<std::uint32_t>(parts % per_second));
    put(bytes_, 8, length);   // captured
    put(bytes_, 12, length);  // sent
    put_big(start + 2, length - ethernet);
    put_big(start + 10, 0);
    put_big(start + 10, checksum());
    put_big(start + ip, packet.port);
    put_big(start + ip + 2, packet.port);
    put_big(start + ip + 4, length - ethernet - ip);  // the checksum of UDP stays 0: none
    return bytes_;
  }

 private:
  static constexpr std::size_t start = record + ethernet;  // of the header of IPv4 [byte]

  void put_big(std::size_t position, std::size_t value) noexcept {
    bytes_[position] = static_cast<std::byte>(value >> 8);
    bytes_[position + 1] = static_cast<std::byte>(value);
  }

  /// Checksum of the header of IPv4. Source: RFC 1071.
  [[nodiscard]] std::size_t checksum() const noexcept {
    std::size_t sum = 0;
    for (std::size_t k = 0; k < ip; ++k) sum += std::to_integer<std::size_t>(bytes_[start + k]) << (k % 2 == 0 ? 8 : 0);
    while (sum > 0xFFFF) sum = (sum & 0xFFFF) + (sum >> 16);
    return ~sum & 0xFFFF;
  }

  std::array<std::byte, record + ethernet + ip + udp> bytes_{};
};

}  // namespace detail

/// Writes packets to a capture file of tcpdump: undivided frames of Ethernet, IPv4 and UDP.
/// `close()` completes the file: see `OutputFile`. Source: IETF draft-ietf-opsawg-pcap, 4, 5.
class PcapWriter {
 public:
  /// Opens the file. @throws FileError
  explicit PcapWriter(std::filesystem::path path, const PcapSettings& settings = {})
      : file_(std::move(path)), frame_(settings), per_second_(settings.nanoseconds ? 1'000'000'000 : 1'000'000) {
    std::array<std::byte, 24> header{};
    detail::put(header, 0, settings.nanoseconds ? std::uint32_t{0xA1B23C4D} : std::uint32_t{0xA1B2C3D4});
    detail::put(header, 4, std::uint16_t{2});  // version 2.4
    detail::put(header, 6, std::uint16_t{4});
    detail::put(header, 16, std::uint32_t{65'550});  // longest frame, of IPv4
    detail::put(header, 20, std::uint32_t{1});       // Ethernet
    file_.write(header);
  }

  /// Appends a packet. @throws SettingError for one longer than UDP allows @throws FileError
  void operator()(const SensorPacket& packet) {
    require_within("SensorPacket::payload (size)", static_cast<double>(packet.payload.size()), 0,
                   detail::PacketFrame::payload_max, "byte");
    file_.write(frame_.before(packet, per_second_));
    file_.write(packet.payload);
  }

  void close() { file_.commit(); }

 private:
  OutputFile file_;
  detail::PacketFrame frame_;
  std::uint64_t per_second_;  // parts of a time
};

}  // namespace PULSECAST_NAMESPACE::io

#endif
