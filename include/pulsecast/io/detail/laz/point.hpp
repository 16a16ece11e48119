// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_LAZ_POINT_HPP
#define PULSECAST_IO_DETAIL_LAZ_POINT_HPP

#include <array>
#include <bit>
#include <cstring>

#include <pulsecast/base/namespace.hpp>

namespace PULSECAST_NAMESPACE::io::detail {

static_assert(std::endian::native == std::endian::little,
              "LAZ files are little-endian, and numbers are taken as they lie in memory");

inline constexpr std::size_t laz_point_size = 30;  ///< size of point format 6 without extra bytes [byte]

/// Standard fields of a point. Offsets: LAS 1.4 R15, Point Data Record Format 6.
struct LazPoint {
  LazPoint() = default;
  explicit LazPoint(const std::byte* record) noexcept {
    std::array<std::uint8_t, laz_point_size> bytes{};
    std::memcpy(bytes.data(), record, bytes.size());
    const auto take = [&](auto& to, std::size_t at) { std::memcpy(&to, bytes.data() + at, sizeof to); };
    take(x, 0);
    take(y, 4);
    take(z, 8);
    take(intensity, 12);
    take(angle, 18);
    take(source, 20);
    take(time, 22);
    number = bytes[14] & 15U;
    returns = bytes[14] >> 4;
    flags = static_cast<std::uint8_t>((bytes[15] & 15U) | (bytes[15] >> 2 & 48U));
    channel = bytes[15] >> 4 & 3U;
    classification = bytes[16];
    user = bytes[17];
  }

  [[nodiscard]] bool first() const noexcept { return number == 1; }
  [[nodiscard]] bool last() const noexcept { return number >= returns; }
  [[nodiscard]] bool only() const noexcept { return returns == 1; }

  std::int32_t x = 0, y = 0, z = 0;
  std::uint16_t intensity = 0, source = 0;
  std::int16_t angle = 0;
  std::uint8_t number = 0, returns = 0;  ///< return number and number of returns of its pulse
  std::uint8_t flags = 0;                ///< class flags, then scan direction and edge of flight line
  std::uint8_t channel = 0, classification = 0, user = 0;
  std::int64_t time = 0;  ///< bit pattern of the double
};

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
