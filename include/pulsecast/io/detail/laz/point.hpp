// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_LAZ_POINT_HPP
#define PULSECAST_IO_DETAIL_LAZ_POINT_HPP

#include <algorithm>
#include <array>
#include <cstring>

#include <pulsecast/io/detail/laz/coder.hpp>

namespace PULSECAST_NAMESPACE::io::detail {

inline constexpr std::size_t laz_point_size = 30;  ///< of format 6, without extra bytes [byte]

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
  std::uint8_t flags = 0;                ///< class flags, scan direction, edge of flight line
  std::uint8_t channel = 0, classification = 0, user = 0;
  std::int64_t time = 0;  ///< bit pattern of the double
};

// Coders of colours by bytes: which differ from those before, and by how much. Source: LASzip for
// LAS 1.4 (native extension), RGB and NIR layers; for the prediction of blue, laz-perf.

/// Low and high byte of a 16-bit number.
[[nodiscard]] constexpr std::array<std::uint8_t, 2> laz_halves(std::uint16_t value) noexcept {
  return {static_cast<std::uint8_t>(value & 255U), static_cast<std::uint8_t>(value >> 8)};
}

class LazColours {
 public:
  using Value = std::array<std::uint16_t, 3>;

  void encode(LazEncoder& encoder, const Value& before, const Value& now) {
    std::array<std::array<std::uint8_t, 2>, 3> old{}, next{};
    unsigned changed = 0;  // low and high byte of red, green and blue; one more bit if not grey
    for (std::size_t c = 0; c < 3; ++c) {
      old[c] = laz_halves(before[c]);
      next[c] = laz_halves(now[c]);
      for (std::size_t half = 0; half < 2; ++half)
        if (old[c][half] != next[c][half]) changed |= 1U << (2 * c + half);
    }
    if (next[0] != next[1] || next[0] != next[2]) changed |= 64U;
    encoder.encode(changed_, changed);
    for (std::size_t half = 0; half < 2; ++half)  // red
      if ((changed >> half & 1U) != 0)
        encoder.encode(steps_[half], static_cast<std::uint8_t>(next[0][half] - old[0][half]));
    if ((changed & 64U) == 0) return;
    for (std::size_t half = 0; half < 2; ++half) {
      int expected = next[0][half] - old[0][half];  // step of the colour, as red
      if ((changed >> (2 + half) & 1U) != 0)
        encoder.encode(steps_[2 + half], error(next[1][half], old[1][half], expected));
      if ((changed >> (4 + half) & 1U) == 0) continue;
      expected = (expected + next[1][half] - old[1][half]) / 2;  // as the mean of red and green
      encoder.encode(steps_[4 + half], error(next[2][half], old[2][half], expected));
    }
  }

 private:
  /// Error of the prediction that a byte steps as expected, modulo 256.
  [[nodiscard]] static std::uint8_t error(int next, int old, int expected) noexcept {
    return static_cast<std::uint8_t>(next - std::clamp(old + expected, 0, 255));
  }

  LazModel<128> changed_;
  std::array<LazModel<256>, 6> steps_;  // low and high byte of red, green and blue
};

class LazNearInfrared {
 public:
  using Value = std::uint16_t;

  void encode(LazEncoder& encoder, Value before, Value now) {
    const auto old = laz_halves(before), next = laz_halves(now);
    encoder.encode(changed_, (old[0] != next[0] ? 1U : 0U) | (old[1] != next[1] ? 2U : 0U));
    for (std::size_t half = 0; half < 2; ++half)
      if (old[half] != next[half]) encoder.encode(steps_[half], static_cast<std::uint8_t>(next[half] - old[half]));
  }

 private:
  LazModel<4> changed_;
  std::array<LazModel<256>, 2> steps_;  // low and high byte
};

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
