// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_LAZ_POINT_HPP
#define PULSECAST_IO_DETAIL_LAZ_POINT_HPP

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

  /// Writes positions, returns, flags and class to a record.
  void put_place(std::byte* record) const noexcept {
    std::memcpy(record, &x, 12);
    record[14] = static_cast<std::byte>(returns << 4 | number);
    record[15] = static_cast<std::byte>((flags & 15U) | channel * 16U | (flags & 48U) << 2);
    record[16] = static_cast<std::byte>(classification);
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

/// Coder of an extra byte as its difference to the last one.
struct LazExtraByte {
  using Value = std::uint8_t;

  template <class Coder>
  Value code(Coder& coder, Value before, Value now) {
    return static_cast<Value>(before + coder.code(steps, static_cast<Value>(now - before)));
  }
  LazModel<> steps;
};

// Coders of colours by bytes: which differ from those before, and by how much. Source: LASzip for
// LAS 1.4 (native extension), RGB and NIR layers; for the prediction of blue, laz-perf.

/// Low and high byte of a 16-bit number.
[[nodiscard]] constexpr std::array<std::uint8_t, 2> laz_halves(std::uint16_t value) noexcept {
  return {static_cast<std::uint8_t>(value & 255U), static_cast<std::uint8_t>(value >> 8)};
}

[[nodiscard]] constexpr std::uint16_t laz_whole(std::array<std::uint8_t, 2> halves) noexcept {
  return static_cast<std::uint16_t>(halves[1] << 8 | halves[0]);
}

class LazColours {
 public:
  using Value = std::array<std::uint16_t, 3>;

  template <class Coder>
  Value code(Coder& coder, const Value& before, const Value& now) {
    std::array<std::array<std::uint8_t, 2>, 3> old{}, next{};
    unsigned changed = 0;  // low and high byte of red, green and blue; one more bit if not grey
    for (std::size_t c = 0; c < 3; ++c) {
      old[c] = laz_halves(before[c]);
      next[c] = laz_halves(now[c]);
      for (std::size_t half = 0; half < 2; ++half)
        if (old[c][half] != next[c][half]) changed |= 1U << (2 * c + half);
    }
    if (next[0] != next[1] || next[0] != next[2]) changed |= 64U;
    changed = coder.code(changed_, changed);
    const auto step = [&](std::size_t c, std::size_t half, int expected) {  // of a byte
      const int from = std::clamp(old[c][half] + expected, 0, 255);
      next[c][half] = (changed >> (2 * c + half) & 1U) == 0
                          ? old[c][half]
                          : static_cast<std::uint8_t>(
                                from + static_cast<int>(coder.code(steps_[2 * c + half],
                                                                   static_cast<std::uint8_t>(next[c][half] - from))));
      return next[c][half] - old[c][half];
    };
    const std::array<int, 2> red{step(0, 0, 0), step(0, 1, 0)};
    if ((changed & 64U) == 0) return {laz_whole(next[0]), laz_whole(next[0]), laz_whole(next[0])};
    for (std::size_t half = 0; half < 2; ++half) {
      const int green = step(1, half, red[half]);  // expected to step as red
      step(2, half, (red[half] + green) / 2);      // as the mean of both
    }
    return {laz_whole(next[0]), laz_whole(next[1]), laz_whole(next[2])};
  }

 private:
  LazModel<128> changed_;
  std::array<LazModel<256>, 6> steps_;  // low and high byte of red, green and blue
};

class LazNearInfrared {
 public:
  using Value = std::uint16_t;

  Value code(LazEncoder& encoder, Value before, Value now) {
    const auto old = laz_halves(before), next = laz_halves(now);
    encoder.code(changed_, (old[0] != next[0] ? 1U : 0U) | (old[1] != next[1] ? 2U : 0U));
    for (std::size_t half = 0; half < 2; ++half)
      if (old[half] != next[half]) encoder.code(steps_[half], static_cast<std::uint8_t>(next[half] - old[half]));
    return now;
  }

 private:
  LazModel<4> changed_;
  std::array<LazModel<256>, 2> steps_;  // low and high byte
};

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
