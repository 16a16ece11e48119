// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <utility>

#include <pulsecast/base/arithmetic.hpp>

/// SIMD registers: vectors of numbers that go through the same arithmetic at once. The compilers' vector types bring the operators; a
/// comparison gives a `LaneMask`, all ones in lanes where it holds, and `mask ? a : b` selects by lane.
namespace pulsecast {

#if defined(__AVX__)                               // not wider with AVX-512: a single ray would use one lane of eight and pay for all
inline constexpr std::size_t register_bytes = 32;  ///< of one SIMD register [byte]
#else
inline constexpr std::size_t register_bytes = 16;
#endif

/// Number of doubles in one register.
inline constexpr std::size_t lane_count = register_bytes / sizeof(double);

using Lanes [[gnu::vector_size(register_bytes)]] = double;           ///< doubles
using LaneIds [[gnu::vector_size(register_bytes)]] = std::uint64_t;  ///< unsigned integers of 64 bits
using LaneMask [[gnu::vector_size(register_bytes)]] = std::int64_t;  ///< results of comparisons: -1 where true, 0 where false

namespace detail {
template <std::size_t Bytes, class Number>
struct VectorOf {
  using type [[gnu::vector_size(Bytes)]] = Number;
};
/// Size of a `Pack` [byte]: one register, but at most eight numbers.
template <class Real>
inline constexpr std::size_t pack_bytes = register_bytes < 8 * sizeof(Real) ? register_bytes : 8 * sizeof(Real);
}  // namespace detail

/// Vector of floats or doubles: as many as a register holds, at most eight, the children of a tree's node.
template <class Real>
using Pack = typename detail::VectorOf<detail::pack_bytes<Real>, Real>::type;
/// Number of lanes of a `Pack`.
template <class Real>
inline constexpr std::size_t pack_count = sizeof(Pack<Real>) / sizeof(Real);

/// Converts `pack_count` 16-bit integers in memory, from `first` on, to a `Pack`.
template <class Real>
[[nodiscard]] inline Pack<Real> pack_from(const std::uint16_t& first) noexcept {
  using Halves = typename detail::VectorOf<16, std::uint16_t>::type;
  using Words = typename detail::VectorOf<4 * pack_count<Real>, std::int32_t>::type;
  if constexpr (pack_count<Real> == 8) {
    Halves halves;
    std::memcpy(&halves, &first, sizeof halves);
#if defined(__AVX2__) && !defined(__clang__)  // g++ 12 would convert them in two halves
    using Signed = typename detail::VectorOf<16, short>::type;
    return __builtin_convertvector(Words(__builtin_ia32_pmovzxwd256(Signed(halves))), Pack<Real>);
#else
    return __builtin_convertvector(__builtin_convertvector(halves, Words), Pack<Real>);
#endif
  } else if constexpr (pack_count<Real> == 4) {
    using Pair = typename detail::VectorOf<16, std::uint64_t>::type;
    std::uint64_t four;
    std::memcpy(&four, &first, sizeof four);
    const Halves halves = Halves(Pair{four, 0});
    return __builtin_convertvector(Words(__builtin_shufflevector(halves, Halves{}, 0, 8, 1, 9, 2, 10, 3, 11)), Pack<Real>);
  } else {
    static_assert(pack_count<Real> == 2);
    const std::uint16_t* two = &first;
    return Pack<Real>{static_cast<Real>(two[0]), static_cast<Real>(two[1])};
  }
}

/// Register whose lanes are `number(lane)`.
template <class Number>
[[nodiscard]] inline Lanes lanes_of(const Number& number) noexcept {
  return [&]<std::size_t... lane>(std::index_sequence<lane...>) { return Lanes{number(lane)...}; }(std::make_index_sequence<lane_count>());
}

/// Minimum and maximum of two registers, lane by lane; b where they do not compare (NaN).
template <class Register>
[[nodiscard]] inline Register smaller(const Register& a, const Register& b) noexcept {
  return a < b ? a : b;
}
template <class Register>
[[nodiscard]] inline Register greater(const Register& a, const Register& b) noexcept {
  return a > b ? a : b;
}

/// Vector of four numbers in as many registers as they need: three coordinates and a spare lane.
template <class Real>
struct Four {
  static constexpr std::size_t count = 4 * sizeof(Real) > register_bytes ? 4 * sizeof(Real) / register_bytes : 1;
  using Part = typename detail::VectorOf<4 * sizeof(Real) / count, Real>::type;
  Part parts[count];

  Four() = default;
  explicit Four(Real all) noexcept { each([&](std::size_t i) { parts[i] = Part{} + all; }); }
  Four(Real x, Real y, Real z) noexcept {  // point, and 1 in the spare lane
    const Whole<Real> whole{x, y, z, 1};
    std::memcpy(parts, &whole, sizeof parts);
  }
  /// Loads four consecutive numbers from memory, from `first` on.
  [[nodiscard]] static Four from(const Real& first) noexcept {
    Four four;
    std::memcpy(four.parts, &first, sizeof four.parts);
    return four;
  }
  [[nodiscard]] Real operator[](std::size_t i) const noexcept { return parts[i * count / 4][i % (4 / count)]; }

  /// Conversion to another precision.
  template <class Other>
  [[nodiscard]] Four<Other> as() const noexcept {
    Whole<Real> whole;
    std::memcpy(&whole, parts, sizeof parts);
    const auto converted = __builtin_convertvector(whole, Whole<Other>);
    Four<Other> four;
    std::memcpy(four.parts, &converted, sizeof four.parts);
    return four;
  }

  friend Four operator+(const Four& a, const Four& b) noexcept {
    return made([&](std::size_t i) { return a.parts[i] + b.parts[i]; });
  }
  friend Four operator-(const Four& a, const Four& b) noexcept {
    return made([&](std::size_t i) { return a.parts[i] - b.parts[i]; });
  }
  friend Four operator*(const Four& a, const Four& b) noexcept {
    return made([&](std::size_t i) { return a.parts[i] * b.parts[i]; });
  }
  friend Four operator/(const Four& a, const Four& b) noexcept {
    return made([&](std::size_t i) { return a.parts[i] / b.parts[i]; });
  }
  friend Four magnitude(const Four& a) noexcept {
    return made([&](std::size_t i) { return a.parts[i] < 0 ? -a.parts[i] : a.parts[i]; });
  }
  /// Sign, lane by lane: -1 if negative, else 1.
  friend Four sense(const Four& a) noexcept {
    return made([&](std::size_t i) { return a.parts[i] < 0 ? Part{} - 1 : Part{} + 1; });
  }
  friend Four smaller(const Four& a, const Four& b) noexcept {
    return made([&](std::size_t i) { return a.parts[i] < b.parts[i] ? a.parts[i] : b.parts[i]; });
  }
  friend Four greater(const Four& a, const Four& b) noexcept {
    return made([&](std::size_t i) { return a.parts[i] > b.parts[i] ? a.parts[i] : b.parts[i]; });
  }

 private:
  template <class Number>
  using Whole = typename detail::VectorOf<4 * sizeof(Number), Number>::type;

  template <class Do>
  static void each(const Do& act) noexcept {
    for (std::size_t i = 0; i < count; ++i) act(i);
  }
  template <class Make>
  static Four made(const Make& make) noexcept {
    Four four;
    each([&](std::size_t i) { four.parts[i] = make(i); });
    return four;
  }
};

/// Fills a register from memory, from `first` on.
template <class Register, class Number>
inline void fill(Register& r, const Number& first) noexcept {
  std::memcpy(&r, &first, sizeof r);
}

/// Register of `register_bytes` loaded from memory, from `first` on.
template <class Register, class Number>
[[nodiscard]] inline Register load(const Number& first) noexcept {
  Register r;
  fill(r, first);
  return r;
}

/// Stores a register in memory, from `first` on.
template <class Register, class Number>
inline void store(const Register& r, Number& first) noexcept {
  std::memcpy(&first, &r, sizeof r);
}

/// Prefetches an object that will be read soon, cache line by cache line.
template <class T>
inline void prefetch(const T* object) noexcept {
  for (std::size_t byte = 0; byte < sizeof(T); byte += 64) __builtin_prefetch(reinterpret_cast<const char*>(object) + byte);
}

/// Bit mask of the lanes where a mask holds; lane 0 is bit 0.
template <class Mask>
[[nodiscard]] inline unsigned bits(const Mask& mask) noexcept {
  constexpr std::size_t lanes = sizeof mask / sizeof mask[0];
#if defined(__SSE2__)
  using Floats = typename detail::VectorOf<16, float>::type;
  using Doubles = typename detail::VectorOf<16, double>::type;
  if constexpr (sizeof mask == 16)
    return static_cast<unsigned>(lanes == 4 ? __builtin_ia32_movmskps(Floats(mask)) : __builtin_ia32_movmskpd(Doubles(mask)));
#endif
#if defined(__AVX__)
  using WideFloats = typename detail::VectorOf<32, float>::type;
  using WideDoubles = typename detail::VectorOf<32, double>::type;
  if constexpr (sizeof mask == 32)
    return static_cast<unsigned>(lanes == 8 ? __builtin_ia32_movmskps256(WideFloats(mask)) : __builtin_ia32_movmskpd256(WideDoubles(mask)));
#endif
  unsigned set = 0;
  for (std::size_t lane = 0; lane < lanes; ++lane) set |= mask[lane] != 0 ? 1U << lane : 0U;
  return set;
}

}  // namespace pulsecast
