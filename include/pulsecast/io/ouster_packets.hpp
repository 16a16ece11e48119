// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_OUSTER_PACKETS_HPP
#define PULSECAST_IO_OUSTER_PACKETS_HPP

#include <pulsecast/io/detail/packets/packet_stream.hpp>
#include <pulsecast/io/point_records.hpp>

namespace PULSECAST_NAMESPACE::io {

namespace detail {

/// Lidar packets of an OS1-64: profile LEGACY for single returns, RNG19_RFL8_SIG16_NIR16_DUAL for
/// dual ones. Source: Ouster, firmware user manual, 2.x and 3.x, lidar data packet format.
struct OusterFormat {
  static constexpr std::uint16_t port = 7502;              // of lidar packets
  static constexpr std::size_t lasers = 64;                // pixels of a column
  static constexpr std::size_t packet_columns = 16;        // columns of a packet
  static constexpr std::size_t header = 32;                // of dual returns; also the footer [byte]
  static constexpr std::uint32_t encoder_counts = 90'112;  // of a turn

  /// Columns of a turn.
  [[nodiscard]] static std::size_t frame_columns(const SpinningSensor& sensor) noexcept {
    return static_cast<std::size_t>(std::nearbyint(sensor.sequence_rate / sensor.rotation_rate));
  }

  static void validate(const SpinningSensor& sensor) {
    const auto number = static_cast<double>(sensor.lasers.size());
    require_within("SpinningSensor::lasers (number)", number, lasers, lasers, "");
    require_within("SpinningSensor::start", sensor.start, pi - 1e-9, pi + 1e-9, "rad");  // encoder 0
    const double columns = sensor.sequence_rate / sensor.rotation_rate;
    if (columns != 512 && columns != 1024 && columns != 2048)
      throw SettingError("SpinningSensor::sequence_rate (sequences a turn)", columns, "", "512, 1024 or 2048");
  }

  [[nodiscard]] static std::size_t size(const PacketSource& source) noexcept {
    return packet_columns * column_size(source) + (source.is_dual() ? 2 * header : 0);
  }

  static std::size_t sequences(const PacketSource&) noexcept { return packet_columns; }

  static void begin(const PacketSource& source, PulseIndex first, std::span<std::byte> payload) noexcept {
    const std::size_t columns = frame_columns(source.sensor);
    if (source.is_dual()) {
      put(payload, 0, std::uint16_t{1});  // lidar packet
      put(payload, 2, static_cast<std::uint16_t>(first / columns));
    }
    for (std::size_t k = 0; k < packet_columns; ++k) {
      const PulseIndex sequence = first + k, number = sequence % columns;
      const std::size_t at = column(source, k);
      put(payload, at, parts_of(source.clock(sequence), 1'000'000'000));
      put(payload, at + 8, static_cast<std::uint16_t>(number));
      if (source.is_dual()) {
        put(payload, at + 10, std::uint16_t{1});  // valid
      } else {
        put(payload, at + 10, static_cast<std::uint16_t>(sequence / columns));
        put(payload, at + 12, static_cast<std::uint32_t>(number * encoder_counts / columns));
        put(payload, at + column_size(source) - 4, std::uint32_t{0xFFFFFFFF});  // valid
      }
    }
  }

  static void write(const PacketSource& source, std::span<std::byte> payload, std::size_t sequence, std::size_t laser,
                    Echoes echoes) noexcept {
    const std::size_t pixel = column(source, sequence) + column_header(source) + laser * pixel_size(source);
    if (!source.is_dual()) {
      const Echo& echo = single_return(echoes, source.settings.returns);
      if (const std::uint32_t range = millimetres(source, echo, 0xFFFFF); range != 0) {
        put(payload, pixel, range);
        put(payload, pixel + 4, reflectivity(echo));
        put(payload, pixel + 6, photons(source, echo));
      }
      return;
    }
    const Echo* const strongest = strongest_but(nullptr, echoes);
    std::size_t number = 0;
    for (const Echo* const echo : {strongest, strongest_but(strongest, echoes)}) {
      const std::uint32_t range = echo != nullptr ? millimetres(source, *echo, 0x7FFFF) : 0;
      if (range != 0) {
        put(payload, pixel + 4 * number, range | std::uint32_t{reflectivity(*echo)} << 24);
        put(payload, pixel + 8 + 2 * number, photons(source, *echo));
      }
      ++number;
    }
  }

 private:
  [[nodiscard]] static std::size_t column_header(const PacketSource& source) noexcept {
    return source.is_dual() ? 12 : 16;
  }
  [[nodiscard]] static std::size_t pixel_size(const PacketSource& source) noexcept {
    return source.is_dual() ? 16 : 12;
  }
  [[nodiscard]] static std::size_t column_size(const PacketSource& source) noexcept {
    return column_header(source) + lasers * pixel_size(source) + (source.is_dual() ? 0 : 4);
  }
  [[nodiscard]] static std::size_t column(const PacketSource& source, std::size_t k) noexcept {
    return (source.is_dual() ? header : 0) + k * column_size(source);
  }

  /// Range, which includes the way from the axis to the lenses; 0 if it exceeds `most`.
  static std::uint32_t millimetres(const PacketSource& source, const Echo& echo, double most) noexcept {
    const double steps = std::nearbyint(1e3 * (echo.range + source.sensor.exit_radius));
    return steps >= 1 && steps <= most ? static_cast<std::uint32_t>(steps) : 0;
  }

  [[nodiscard]] static std::uint8_t reflectivity(const Echo& echo) noexcept {
    return static_cast<std::uint8_t>(std::nearbyint(reflectivity_byte(echo.reflectance)));
  }

  [[nodiscard]] static std::uint16_t photons(const PacketSource& source, const Echo& echo) noexcept {
    const double number = photon_count(echo.amplitude, source.sensor.beam);
    return static_cast<std::uint16_t>(std::nearbyint(std::fmin(std::fmax(number, 0), 0xFFFF)));
  }
};

}  // namespace detail

/// Sink that writes the echoes of an OS1-64 as its lidar packets: `OusterPackets
/// packets(ouster_os1_64(), {}, std::ref(file))`. Single returns are of the profile LEGACY, of
/// 12608 bytes; dual ones of RNG19_RFL8_SIG16_NIR16_DUAL, of 16640 bytes, the strongest first. All
/// columns are valid; the near infrared is 0. Ranges r are as in the manual: (r - n) is from the
/// lens at the radius n to the point; 0 beyond what their bits hold, as without a return.
using OusterPackets = detail::PacketStream<detail::OusterFormat>;
static_assert(EchoSink<OusterPackets> && ChoosesShots<OusterPackets>);

}  // namespace PULSECAST_NAMESPACE::io

#endif
