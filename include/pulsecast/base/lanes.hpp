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

namespace detail {
template <class Real>
struct FourOf;
template <>
struct FourOf<float> {
  using type [[gnu::vector_size(16)]] = float;
};
template <>
struct FourOf<double> {
  using type [[gnu::vector_size(32)]] = double;
};
}  // namespace detail

/// Four numbers of either precision: the three coordinates of a point, and one more.
template <class Real>
using Four = typename detail::FourOf<Real>::type;

/// Fills a register from memory, from this number on.
template <class Register, class Number>
inline void fill(Register& r, const Number& first) noexcept {
  std::memcpy(&r, &first, sizeof r);
}

/// A register of `register_bytes` filled from memory, from this number on.
template <class Register, class Number>
[[nodiscard]] inline Register load(const Number& first) noexcept {
  Register r;
  fill(r, first);
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
