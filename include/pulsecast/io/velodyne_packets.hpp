// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_VELODYNE_PACKETS_HPP
#define PULSECAST_IO_VELODYNE_PACKETS_HPP

#include <pulsecast/io/detail/packets/packet_stream.hpp>
#include <pulsecast/io/point_records.hpp>

namespace PULSECAST_NAMESPACE::io {

namespace detail {

/// Data packets of a VLP-16 or VLP-32C. Source of every offset and value: Velodyne, VLP-16 user
/// manual 63-9243 rev. D, 2018, 9.3, and VLP-32C user manual 63-9325 rev. C, 2019, 9.3.
struct VelodyneFormat {
  static constexpr std::uint16_t port = 2368;      // of data packets
  static constexpr std::size_t blocks = 12;        // in a packet
  static constexpr std::size_t block_size = 100;   // flag, azimuth and points [byte]
  static constexpr std::size_t block_points = 32;  // in a block, of 3 bytes each

  static void validate(const SpinningSensor& sensor) {
    const std::size_t lasers = sensor.lasers.size();
    if (lasers != 16) require_within("SpinningSensor::lasers (number other than 16)", lasers, 32, 32, "");
    require_within("SpinningSensor::exit_radius", sensor.exit_radius, 0, 0, "m");
  }

  [[nodiscard]] static std::size_t size(const PacketSource&) noexcept { return 1206; }

  [[nodiscard]] static std::size_t sequences(const PacketSource& source) noexcept {
    return blocks / copies(source) * block_sequences(source);
  }

  static void begin(const PacketSource& source, PulseIndex first, std::span<std::byte> payload) noexcept {
    for (std::size_t block = 0; block < blocks; ++block) {
      put(payload, block * block_size, std::uint16_t{0xEEFF});  // so that the bytes are FF EE
      const PulseIndex sequence = first + block / copies(source) * block_sequences(source);
      const Tick start = source.sensor.sequence_start(sequence);
      const double hundredths = std::nearbyint(source.sensor.heading(start) * (36'000 / (2 * pi)));
      put(payload, block * block_size + 2, static_cast<std::uint16_t>(hundredths < 36'000 ? hundredths : 0));
    }
    const std::uint64_t microseconds = parts_of(source.clock(first), 1'000'000);
    put(payload, 1200, static_cast<std::uint32_t>(microseconds % 3'600'000'000));
    put(payload, 1204, mode(source.settings.returns));
    put(payload, 1205, source.sensor.lasers.size() == 16 ? std::uint8_t{0x22} : std::uint8_t{0x28});
  }

  static void write(const PacketSource& source, std::span<std::byte> payload, std::size_t sequence, std::size_t laser,
                    Echoes echoes) noexcept {
    const std::size_t block = sequence / block_sequences(source) * copies(source);
    const std::size_t point = sequence % block_sequences(source) * source.sensor.lasers.size() + laser;
    const auto put_return = [&](std::size_t to_block, const Echo& echo) {
      const double steps = std::nearbyint(echo.range / distance_resolution(source.sensor));
      if (!(steps >= 1 && steps <= 0xFFFF)) return;
      const std::size_t position = to_block * block_size + 4 + 3 * point;
      put(payload, position, static_cast<std::uint16_t>(steps));
      store_number<std::uint8_t>(reflectivity_byte(echo.reflectance), payload.data() + position + 2);
    };
    if (!source.is_dual()) return put_return(block, single_return(echoes, source.settings.returns));
    const Echo& last = echoes.back();
    const Echo* other = strongest_but(nullptr, echoes);
    if (other == &last && echoes.size() > 1) other = strongest_but(&last, echoes);
    put_return(block, last);
    put_return(block + 1, *other);
  }

  /// Step of distances [m].
  [[nodiscard]] static double distance_resolution(const SpinningSensor& sensor) noexcept {
    return sensor.lasers.size() == 16 ? 2e-3 : 4e-3;
  }

 private:
  /// Blocks of the same firings.
  static std::size_t copies(const PacketSource& source) noexcept { return source.is_dual() ? 2 : 1; }
  /// Firing sequences of a block.
  [[nodiscard]] static std::size_t block_sequences(const PacketSource& source) noexcept {
    return block_points / source.sensor.lasers.size();
  }
  [[nodiscard]] static std::uint8_t mode(PacketReturns returns) noexcept {
    return returns == PacketReturns::strongest ? 0x37 : returns == PacketReturns::last ? 0x38 : 0x39;
  }
};

}  // namespace detail

/// Sink that writes the echoes of a VLP-16 or VLP-32C, by the number of its lasers, as its data
/// packets of 1206 bytes: `VelodynePackets packets(velodyne_vlp_16(), {.returns =
/// PacketReturns::last}, std::ref(file))`. Of dual returns, even blocks hold the last and odd ones
/// the strongest; the second strongest if that is the last; the same if there is only one.
/// Distances are from the sensor's axis; 0 beyond 16 bits, as without a return.
using VelodynePackets = detail::PacketStream<detail::VelodyneFormat>;
static_assert(EchoSink<VelodynePackets> && ChoosesShots<VelodynePackets>);

}  // namespace PULSECAST_NAMESPACE::io

#endif
