// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <bit>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

#include <pulsecast/echo.hpp>

namespace pulsecast::support {

/// SHA-256, so that a test can say that two results are the same to the last bit. Source: FIPS 180-4.
class Checksum {
 public:
  void add(std::span<const std::uint8_t> bytes) noexcept {
    for (const std::uint8_t b : bytes) add_byte(b);
    length_ += bytes.size();
  }

  void add(std::string_view text) noexcept {
    for (const char c : text) add_byte(static_cast<std::uint8_t>(c));
    length_ += text.size();
  }

  /// The bytes of a number, least significant first.
  template <class Number>
  requires std::integral<Number> || std::floating_point<Number> || std::is_enum_v<Number>
  void add(Number value) noexcept {
    if constexpr (std::is_enum_v<Number>) {
      add(static_cast<std::underlying_type_t<Number>>(value));
    } else if constexpr (std::same_as<Number, double>) {
      add(std::bit_cast<std::uint64_t>(value));
    } else if constexpr (std::same_as<Number, float>) {
      add(std::bit_cast<std::uint32_t>(value));
    } else {
      std::array<std::uint8_t, sizeof(Number)> bytes;
      for (std::size_t k = 0; k < sizeof(Number); ++k)
        bytes[k] = static_cast<std::uint8_t>(static_cast<std::uint64_t>(value) >> (8 * k));
      add(std::span<const std::uint8_t>(bytes));
    }
  }

  void add(const Vec3& v) noexcept {
    add(v.x);
    add(v.y);
    add(v.z);
  }
  void add(const Tick& t) noexcept {
    add(t.second);
    add(t.fraction);
  }

  /// Everything that a shot and its echoes say, but not where in the batch they stand: how the pulses are cut into
  /// batches does not count.
  void add(const EchoBatch& batch) noexcept {
    for (const Shot& s : batch.shots) {
      add(s.index);
      add(s.tick);
      add(s.origin);
      add(s.direction);
      add(double(s.scan_angle));
      add(s.leg);
      add(s.channel);
      add(s.fate);
      add(s.echoes);
      add(s.samples);
      add(s.waveform_start);
      for (const Echo& e : batch.echoes_of(s)) {
        add(e.range);
        add(e.amplitude);
        add(e.reflectance);
        add(e.width);
        add(e.object);
        add(e.classification);
        add(e.number);
      }
      if (s.samples > 0) add(batch.sample_interval);
      for (const float power : batch.waveform_of(s)) add(power);
    }
  }

  /// Of all that was added so far: 64 hexadecimal digits.
  [[nodiscard]] std::string hex() const {
    Checksum end = *this;
    const std::uint64_t bits = length_ * 8;
    end.add_byte(0x80);
    while (end.used_ != 56) end.add_byte(0);
    for (int shift = 56; shift >= 0; shift -= 8) end.add_byte(static_cast<std::uint8_t>(bits >> shift));
    std::string text;
    for (const std::uint32_t word : end.state_)
      for (int shift = 28; shift >= 0; shift -= 4) text += "0123456789abcdef"[(word >> shift) & 15];
    return text;
  }

 private:
  // Source: FIPS 180-4, section 4.2.2
  static constexpr std::array<std::uint32_t, 64> constants = {
      0x428a2f98, 0x71374491, 0xb5c0fbcf, 0xe9b5dba5, 0x3956c25b, 0x59f111f1, 0x923f82a4, 0xab1c5ed5,
      0xd807aa98, 0x12835b01, 0x243185be, 0x550c7dc3, 0x72be5d74, 0x80deb1fe, 0x9bdc06a7, 0xc19bf174,
      0xe49b69c1, 0xefbe4786, 0x0fc19dc6, 0x240ca1cc, 0x2de92c6f, 0x4a7484aa, 0x5cb0a9dc, 0x76f988da,
      0x983e5152, 0xa831c66d, 0xb00327c8, 0xbf597fc7, 0xc6e00bf3, 0xd5a79147, 0x06ca6351, 0x14292967,
      0x27b70a85, 0x2e1b2138, 0x4d2c6dfc, 0x53380d13, 0x650a7354, 0x766a0abb, 0x81c2c92e, 0x92722c85,
      0xa2bfe8a1, 0xa81a664b, 0xc24b8b70, 0xc76c51a3, 0xd192e819, 0xd6990624, 0xf40e3585, 0x106aa070,
      0x19a4c116, 0x1e376c08, 0x2748774c, 0x34b0bcb5, 0x391c0cb3, 0x4ed8aa4a, 0x5b9cca4f, 0x682e6ff3,
      0x748f82ee, 0x78a5636f, 0x84c87814, 0x8cc70208, 0x90befffa, 0xa4506ceb, 0xbef9a3f7, 0xc67178f2};

  void add_byte(std::uint8_t b) noexcept {
    block_[used_++] = b;
    if (used_ == block_.size()) digest_block();
  }

  void digest_block() noexcept {  // FIPS 180-4, section 6.2.2
    std::array<std::uint32_t, 64> w;
    for (std::size_t t = 0; t < 16; ++t)
      w[t] = std::uint32_t{block_[4 * t]} << 24 | std::uint32_t{block_[4 * t + 1]} << 16 |
             std::uint32_t{block_[4 * t + 2]} << 8 | std::uint32_t{block_[4 * t + 3]};
    for (std::size_t t = 16; t < 64; ++t) {
      const std::uint32_t s0 = std::rotr(w[t - 15], 7) ^ std::rotr(w[t - 15], 18) ^ (w[t - 15] >> 3);
      const std::uint32_t s1 = std::rotr(w[t - 2], 17) ^ std::rotr(w[t - 2], 19) ^ (w[t - 2] >> 10);
      w[t] = w[t - 16] + s0 + w[t - 7] + s1;
    }
    auto [a, b, c, d, e, f, g, h] = state_;
    for (std::size_t t = 0; t < 64; ++t) {
      const std::uint32_t s1 = std::rotr(e, 6) ^ std::rotr(e, 11) ^ std::rotr(e, 25);
      const std::uint32_t t1 = h + s1 + ((e & f) ^ (~e & g)) + constants[t] + w[t];
      const std::uint32_t s0 = std::rotr(a, 2) ^ std::rotr(a, 13) ^ std::rotr(a, 22);
      const std::uint32_t t2 = s0 + ((a & b) ^ (a & c) ^ (b & c));
      h = g;
      g = f;
      f = e;
      e = d + t1;
      d = c;
      c = b;
      b = a;
      a = t1 + t2;
    }
    const std::array<std::uint32_t, 8> sum = {a, b, c, d, e, f, g, h};
    for (std::size_t k = 0; k < 8; ++k) state_[k] += sum[k];
    used_ = 0;
  }

  // Source: FIPS 180-4, section 5.3.3
  std::array<std::uint32_t, 8> state_ = {0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                         0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  std::array<std::uint8_t, 64> block_{};
  std::size_t used_ = 0;
  std::uint64_t length_ = 0;
};

}  // namespace pulsecast::support
