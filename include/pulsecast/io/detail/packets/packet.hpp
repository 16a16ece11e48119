// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_PACKETS_PACKET_HPP
#define PULSECAST_IO_DETAIL_PACKETS_PACKET_HPP

#include <array>
#include <bit>
#include <cstring>
#include <functional>
#include <span>

#include <pulsecast/base/tick.hpp>

namespace PULSECAST_NAMESPACE::io {

/// Data packet of a sensor.
struct SensorPacket {
  Tick time{};                           ///< clock time at the end of its last firing sequence
  std::uint16_t port = 0;                ///< UDP port of the receiver
  std::span<const std::byte> payload{};  ///< UDP payload, valid during the call that passes it on
};

/// Consumer of packets, in order of time.
using TakePacket = std::function<void(const SensorPacket& packet)>;

/// Address of a host, as in 192.168.1.201.
using Ipv4Address = std::array<std::uint8_t, 4>;

namespace detail {

static_assert(std::endian::native == std::endian::little,
              "packets are little-endian, and are written as the numbers lie in memory");

template <class Number>
void put(std::span<std::byte> bytes, std::size_t position, Number value) noexcept {
  std::memcpy(bytes.data() + position, &value, sizeof value);
}

/// Clock time in whole parts of a second, rounded to the nearest; from 0.
[[nodiscard]] inline std::uint64_t parts_of(Tick time, std::uint64_t per_second) noexcept {
  const double parts = std::nearbyint(time.fraction * static_cast<double>(per_second));
  return static_cast<std::uint64_t>(time.second) * per_second + static_cast<std::uint64_t>(parts);
}

}  // namespace detail

}  // namespace PULSECAST_NAMESPACE::io

#endif
