// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_BASE_SIMD_HPP
#define PULSECAST_BASE_SIMD_HPP

#include <bit>
#include <cstring>
#include <type_traits>
#include <utility>
#if defined(__aarch64__)
#include <arm_neon.h>
#endif

#include <pulsecast/base/namespace.hpp>

/// SIMD registers as vector types of the compiler, with their operators. A comparison gives a
/// `Mask` with all bits set in the lanes where it holds; `mask ? a : b` selects by lane.
namespace PULSECAST_NAMESPACE::simd {

/// Size of a SIMD register [byte].
#if defined(__AVX__)  // 32 with AVX-512, too: of eight lanes, a single ray would use one
inline constexpr std::size_t register_bytes = 32;
#else
inline constexpr std::size_t register_bytes = 16;
#endif

namespace detail {
template <class T, std::size_t N>
struct Vector {
  using type [[gnu::vector_size(N * sizeof(T))]] = T;
};
}  // namespace detail

/// Vector of N numbers of type T; N is a power of two.
template <class T, std::size_t N>
using Vec = typename detail::Vector<T, N>::type;

/// Number of lanes of double precision in a register.
inline constexpr std::size_t lane_count = register_bytes / sizeof(double);

/// Register of double-precision numbers.
using Doubles = Vec<double, lane_count>;
/// Register of 64-bit identifiers, as many as `Doubles`.
using Ids = Vec<std::uint64_t, lane_count>;
/// Result of a comparison of `Doubles`: -1 where it holds, else 0.
using Mask = Vec<std::int64_t, lane_count>;

/// Lanes of a `Packet`: those of a register, but at most eight, the children of a tree node.
template <class Real>
inline constexpr std::size_t packet_size = register_bytes < 8 * sizeof(Real) ? register_bytes / sizeof(Real) : 8;

/// Register of numbers of single or double precision.
template <class Real>
using Packet = Vec<Real, packet_size<Real>>;

/// Register whose lanes are `number(lane)`.
[[nodiscard]] inline Doubles generate(const auto& number) noexcept {
  return [&]<std::size_t... lane>(std::index_sequence<lane...>) { return Doubles{number(lane)...}; }
  (std::make_index_sequence<lane_count>());
}

/// Lane-wise minimum; `b` in lanes with a NaN.
template <class V>
[[nodiscard]] inline V min(const V& a, const V& b) noexcept {
  return a < b ? a : b;
}
/// Lane-wise maximum; `b` in lanes with a NaN.
template <class V>
[[nodiscard]] inline V max(const V& a, const V& b) noexcept {
  return a > b ? a : b;
}

namespace detail {
/// Bits of a number, or of the lanes of a vector. Unsigned: sums may overflow in unused lanes.
template <class V>
using Bits = std::conditional_t<std::is_same_v<V, double>, std::uint64_t, Vec<std::uint64_t, sizeof(V) / 8>>;
}  // namespace detail

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"  // of vectors wider than a register
/// Magnitude of a number of double precision, or of each lane of a vector.
template <class V>
[[nodiscard, gnu::always_inline]] inline V magnitude(const V& v) noexcept {
  return std::bit_cast<V>(static_cast<detail::Bits<V>>(std::bit_cast<detail::Bits<V>>(v) & 0x7FFF'FFFF'FFFF'FFFF));
}
/// Lanes of two vectors by their numbers, where those of `b` follow those of `a`.
template <std::size_t... lane, class V>
[[nodiscard, gnu::always_inline]] inline auto shuffle(const V& a, const V& b) noexcept {
#if __has_builtin(__builtin_shufflevector)
  return __builtin_shufflevector(a, b, lane...);
#else  // g++ 11
  constexpr std::size_t own = sizeof a / sizeof a[0];
  return Vec<std::remove_cvref_t<decltype(a[0])>, sizeof...(lane)>{(lane < own ? a[lane % own] : b[lane % own])...};
#endif
}
#pragma GCC diagnostic pop

/// Numbers that a sum over a column adds up side by side, in one register or two: the same for
/// every instruction set, so that sums are.
inline constexpr std::size_t sum_stride = 4;
static_assert(sum_stride % lane_count == 0);

/// Adds all lanes to a sum, in order.
inline void add_lanes(double& sum, const Doubles& v) noexcept {
  for (std::size_t lane = 0; lane < lane_count; ++lane) sum += v[lane];
}

/// Minimum of all lanes. A NaN is ignored, except in the first lane.
[[nodiscard]] inline double min(const Doubles& v) noexcept {
  double least = v[0];
  for (std::size_t lane = 1; lane < lane_count; ++lane) least = v[lane] < least ? v[lane] : least;
  return least;
}
/// Maximum of all lanes. A NaN is ignored, except in the first lane.
[[nodiscard]] inline double max(const Doubles& v) noexcept {
  double most = v[0];
  for (std::size_t lane = 1; lane < lane_count; ++lane) most = v[lane] > most ? v[lane] : most;
  return most;
}

/// Bit mask of the lanes where a mask is set.
[[nodiscard]] inline unsigned bits(const auto& mask) noexcept {
  constexpr std::size_t lanes = sizeof mask / sizeof mask[0];
#if defined(__SSE2__)
  if constexpr (sizeof mask == 16)
    return static_cast<unsigned>(lanes == 4 ? __builtin_ia32_movmskps(Vec<float, 4>(mask))
                                            : __builtin_ia32_movmskpd(Vec<double, 2>(mask)));
#endif
#if defined(__AVX__)
  if constexpr (sizeof mask == 32)
    return static_cast<unsigned>(lanes == 8 ? __builtin_ia32_movmskps256(Vec<float, 8>(mask))
                                            : __builtin_ia32_movmskpd256(Vec<double, 4>(mask)));
#endif
#if defined(__aarch64__)
  if constexpr (sizeof mask == 16 && lanes == 4) return vaddvq_u32(uint32x4_t(mask) & uint32x4_t{1, 2, 4, 8});
  if constexpr (sizeof mask == 16 && lanes == 2)
    return static_cast<unsigned>(vaddvq_u64(uint64x2_t(mask) & uint64x2_t{1, 2}));
#endif
  unsigned set = 0;
  for (std::size_t lane = 0; lane < lanes; ++lane) set |= mask[lane] != 0 ? 1U << lane : 0U;
  return set;
}

/// Four numbers in one or more registers: three coordinates and a spare lane.
template <class Real>
struct Vec4 {
  /// Number of registers.
  static constexpr std::size_t count = 4 * sizeof(Real) > register_bytes ? 4 * sizeof(Real) / register_bytes : 1;
  /// One register.
  using Part = Vec<Real, 4 / count>;
  /// Registers, in order of the lanes.
  Part parts[count];

  Vec4() = default;
  /// Sets all lanes to one number.
  explicit Vec4(Real all) noexcept {
    each([&](std::size_t i) { parts[i] = Part{} + all; });
  }
  /// Sets the lanes to x, y, z and 0.
  Vec4(Real x, Real y, Real z) noexcept {
    const Vec<Real, 4> whole{x, y, z, 0};
    std::memcpy(parts, &whole, sizeof parts);
  }
  /// Loads four consecutive numbers, beginning with `first`.
  [[nodiscard]] static Vec4 from(const Real& first) noexcept {
    Vec4 four;
    std::memcpy(four.parts, &first, sizeof four.parts);
    return four;
  }
  /// Lane `i`.
  [[nodiscard]] Real operator[](std::size_t i) const noexcept { return parts[i * count / 4][i % (4 / count)]; }

  /// Converts to another precision.
  template <class Other>
  [[nodiscard]] Vec4<Other> as() const noexcept {
    Vec<Real, 4> whole;
    std::memcpy(&whole, parts, sizeof parts);
    const auto converted = __builtin_convertvector(whole, Vec<Other, 4>);
    Vec4<Other> four;
    std::memcpy(four.parts, &converted, sizeof four.parts);
    return four;
  }

  /// Vector whose registers are `make(i)`.
  [[nodiscard]] static Vec4 made(const auto& make) noexcept {
    Vec4 four;
    each([&](std::size_t i) { four.parts[i] = make(i); });
    return four;
  }

  friend Vec4 operator+(const Vec4& a, const Vec4& b) noexcept {
    return made([&](std::size_t i) { return a.parts[i] + b.parts[i]; });
  }
  friend Vec4 operator-(const Vec4& a, const Vec4& b) noexcept {
    return made([&](std::size_t i) { return a.parts[i] - b.parts[i]; });
  }
  friend Vec4 operator*(const Vec4& a, const Vec4& b) noexcept {
    return made([&](std::size_t i) { return a.parts[i] * b.parts[i]; });
  }
  friend Vec4 operator/(const Vec4& a, const Vec4& b) noexcept {
    return made([&](std::size_t i) { return a.parts[i] / b.parts[i]; });
  }
  friend Vec4 magnitude(const Vec4& a) noexcept {
    return made([&](std::size_t i) { return Part(Bits(a.parts[i]) & ~sign_bit); });
  }
  /// Magnitudes with the signs of `b`.
  friend Vec4 with_sign(const Vec4& magnitudes, const Vec4& b) noexcept {
    return made([&](std::size_t i) { return Part(Bits(magnitudes.parts[i]) | (Bits(b.parts[i]) & sign_bit)); });
  }
  /// Bit mask of the lanes with a sign bit.
  friend unsigned signs(const Vec4& a) noexcept {
    unsigned set = 0;
    each([&](std::size_t i) {
      set |= bits(Vec<std::make_signed_t<Word>, 4 / count>(a.parts[i]) < 0) << (i * 4 / count);
    });
    return set;
  }

 private:
  using Word = std::conditional_t<sizeof(Real) == 4, std::uint32_t, std::uint64_t>;
  using Bits = Vec<Word, 4 / count>;
  static constexpr Word sign_bit = Word{1} << (8 * sizeof(Real) - 1);

  static void each(const auto& act) noexcept {
    for (std::size_t i = 0; i < count; ++i) act(i);
  }
};

/// Lane-wise minimum; `b` in lanes with a NaN.
template <class Real>
[[nodiscard]] inline Vec4<Real> min(const Vec4<Real>& a, const Vec4<Real>& b) noexcept {
  return Vec4<Real>::made([&](std::size_t i) { return a.parts[i] < b.parts[i] ? a.parts[i] : b.parts[i]; });
}
/// Lane-wise maximum; `b` in lanes with a NaN.
template <class Real>
[[nodiscard]] inline Vec4<Real> max(const Vec4<Real>& a, const Vec4<Real>& b) noexcept {
  return Vec4<Real>::made([&](std::size_t i) { return a.parts[i] > b.parts[i] ? a.parts[i] : b.parts[i]; });
}

/// Loads consecutive numbers into `v`, beginning with `first`.
inline void fill(auto& v, const auto& first) noexcept { std::memcpy(&v, &first, sizeof v); }

/// Vector of consecutive numbers in memory, beginning with `first`.
template <class V, class Number>
[[nodiscard]] inline V load(const Number& first) noexcept {
  V v;
  fill(v, first);
  return v;
}

/// Stores a vector to consecutive numbers, beginning with `first`.
inline void store(const auto& v, auto& first) noexcept { std::memcpy(&first, &v, sizeof v); }

}  // namespace PULSECAST_NAMESPACE::simd

namespace PULSECAST_NAMESPACE {

/// Prefetches an object into the cache.
template <class T>
[[gnu::always_inline]] inline void prefetch(const T* object) noexcept {
  for (std::size_t byte = 0; byte < sizeof(T); byte += 64)
    __builtin_prefetch(reinterpret_cast<const char*>(object) + byte);
}

}  // namespace PULSECAST_NAMESPACE

#endif
