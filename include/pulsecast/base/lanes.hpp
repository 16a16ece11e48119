// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

/// SIMD: several numbers that go through the same arithmetic at once, as many as one register of the processor holds. The compilers'
/// vector types give the operators; comparisons give a `LaneMask` that is all ones where they hold, and `mask ? a : b` chooses by lane.
namespace pulsecast {

#if defined(__AVX512F__)
inline constexpr std::size_t register_bytes = 64;
#elif defined(__AVX__)
inline constexpr std::size_t register_bytes = 32;
#else
inline constexpr std::size_t register_bytes = 16;
#endif

/// How many numbers of double precision go at once.
inline constexpr std::size_t lane_count = register_bytes / sizeof(double);

using Lanes [[gnu::vector_size(register_bytes)]] = double;
using LaneIds [[gnu::vector_size(register_bytes)]] = std::uint64_t;
using LaneMask [[gnu::vector_size(register_bytes)]] = std::int64_t;

/// A register filled from memory, from this number on.
template <class Register, class Number>
[[nodiscard]] inline Register load(const Number& first) noexcept {
  Register r;
  std::memcpy(&r, &first, sizeof r);
  return r;
}

/// A register put into memory, from this number on.
template <class Register, class Number>
inline void store(const Register& r, Number& first) noexcept {
  std::memcpy(&first, &r, sizeof r);
}

/// Whether the mask holds in any lane.
[[nodiscard]] inline bool any(const LaneMask& mask) noexcept {
  std::int64_t bits = 0;
  for (std::size_t lane = 0; lane < lane_count; ++lane) bits |= mask[lane];
  return bits != 0;
}

}  // namespace pulsecast
