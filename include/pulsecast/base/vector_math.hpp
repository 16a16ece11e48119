// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_BASE_VECTOR_MATH_HPP
#define PULSECAST_BASE_VECTOR_MATH_HPP

#include <cmath>
#include <limits>

#include <pulsecast/base/exponential.hpp>

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"  // of wide vectors: all functions are inlined

/// Elementary functions of a number or of lanes of a vector, without tables and branches by lane.
/// If products and sums are not contracted (`-ffp-contract=off`), a lane has the bits of the
/// number, for all lanes and instruction sets. Errors in units in the last place (ulp).
namespace PULSECAST_NAMESPACE::simd {

/// Sine and cosine of the same angle.
template <class V>
struct SineCosine {
  V sin;  ///< sine
  V cos;  ///< cosine
};

namespace detail {
template <class V>
[[nodiscard, gnu::always_inline]] inline Bits<V> bits_of(const V& x) noexcept {
  return std::bit_cast<Bits<V>>(x);
}
inline constexpr std::uint64_t sign_bit = std::uint64_t{1} << 63;

/// `x` with the sign of `sign`.
template <class V>
[[nodiscard, gnu::always_inline]] inline V with_sign(const V& x, const V& sign) noexcept {
  const Bits<V> bits = (bits_of(x) & ~sign_bit) | (bits_of(sign) & sign_bit);
  return std::bit_cast<V>(bits);
}
/// True if a comparison holds in any lane.
[[nodiscard]] inline bool any(bool mask) noexcept { return mask; }
[[nodiscard, gnu::always_inline]] inline bool any(const auto& mask) noexcept {
  std::int64_t set = 0;
  for (std::size_t lane = 0; lane < sizeof mask / sizeof mask[0]; ++lane) set |= mask[lane];
  return set != 0;
}

/// Greatest argument of `reduced`: 20 bits of quarter turns, so products with 33 bits are exact.
inline constexpr double greatest_angle = 1e6;

/// Angle less its nearest multiple of pi/2, as a sum of two numbers, and the quarter turns.
template <class V>
struct Reduced {
  V high, low;
  Bits<V> quarters;  ///< exact in the two lowest bits
};
/// Source: Cody & Waite 1980; fdlibm e_rem_pio2.c for pi/2; two-sum: Knuth, TAOCP vol. 2, 4.2.2.
template <class V>
[[nodiscard, gnu::always_inline]] inline Reduced<V> reduced(const V& x) noexcept {
  constexpr double per_quarter = 6.36619772367581382433e-01, whole = 0x1.8p52;
  constexpr double first = 1.57079632673412561417e+00, second = 6.07710050630396597660e-11,
                   third = 2.02226624879595063154e-21;
  const V shifted = x * per_quarter + whole;
  const V n = shifted - whole;
  const V coarse = x - n * first;
  const V fine = n * second;
  const V r = coarse - fine;
  const V taken = r - coarse;
  const V rest = ((coarse - (r - taken)) - (fine + taken)) - n * third;
  const V high = r + rest;
  return {high, (r - high) + rest, bits_of(shifted)};
}

/// Sine of an angle high + low, at most pi/4 in magnitude. Source: fdlibm k_sin.c.
template <class V>
[[nodiscard, gnu::always_inline]] inline V short_sine(const V& high, const V& low) noexcept {
  const V z = high * high, v = z * high;
  const V r = polynomial(z, 2.75573137070700676789e-06, -1.98412698298579493134e-04, 8.33333333332248946124e-03) +
              z * (z * z) * (-2.50507602534068634195e-08 + z * 1.58969099521155010221e-10);
  return high - ((z * (0.5 * low - v * r) - low) + v * 1.66666666666666324348e-01);
}
/// Cosine of an angle high + low, at most pi/4 in magnitude. Source: fdlibm k_cos.c.
template <class V>
[[nodiscard, gnu::always_inline]] inline V short_cosine(const V& high, const V& low) noexcept {
  const V z = high * high, w = z * z;
  const V r =
      z * polynomial(z, 2.48015872894767294178e-05, -1.38888888888741095749e-03, 4.16666666666666019037e-02) +
      w * w * polynomial(z, -1.13596475577881948265e-11, 2.08757232129817482790e-09, -2.75573143513906633035e-07);
  const V half = 0.5 * z, most = 1.0 - half;
  return most + (((1.0 - most) - half) + (z * r - high * low));
}

/// Sets the lanes of angles beyond `greatest_angle`.
template <class V>
[[gnu::noinline, gnu::cold]] void set_great_angles(const V& x, SineCosine<V>& both) noexcept {
  constexpr std::size_t lanes = sizeof(V) / sizeof(double);
  double angles[lanes], sines[lanes], cosines[lanes];
  std::memcpy(angles, &x, sizeof x);
  std::memcpy(sines, &both.sin, sizeof x);
  std::memcpy(cosines, &both.cos, sizeof x);
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    if (!(std::fabs(angles[lane]) > greatest_angle)) continue;
    sines[lane] = std::sin(angles[lane]);
    cosines[lane] = std::cos(angles[lane]);
  }
  std::memcpy(&both.sin, sines, sizeof x);
  std::memcpy(&both.cos, cosines, sizeof x);
}

/// Natural logarithm of positive, normal numbers; error at most 1 ulp. Source: fdlibm e_log.c.
template <class V>
[[nodiscard, gnu::always_inline]] inline V log_of_normal(const V& x) noexcept {
  constexpr std::uint64_t one = 0x3ff0000000000000, root_half = 0x3fe6a09e00000000;
  const Bits<V> shifted = bits_of(x) + (one - root_half);
  const Bits<V> whole = ((shifted >> 52) & 0xfff) | 0x4330000000000000,
                part = (shifted & 0x000fffffffffffff) + root_half;
  const V k = std::bit_cast<V>(whole) - (0x1p52 + 1023), f = std::bit_cast<V>(part) - 1.0;
  const V s = f / (2.0 + f), z = s * s, w = z * z, half_square = 0.5 * f * f;
  const V r = w * polynomial(w, 1.531383769920937332e-01, 2.222219843214978396e-01, 3.999999999940941908e-01) +
              z * polynomial(w, 1.479819860511658591e-01, 1.818357216161805012e-01, 2.857142874366239149e-01,
                             6.666666666666735130e-01);
  return k * 6.93147180369123816490e-01 -
         ((half_square - (s * (half_square + r) + k * 1.90821492927058770002e-10)) - f);
}
}  // namespace detail

/// Sine and cosine of angles [rad]; errors at most 1 ulp. sin(+-0) = +-0; NaN for infinities and
/// NaN. Beyond a million radians the C library computes them, lane by lane. Source: fdlibm s_sin.c.
template <class V>
[[nodiscard, gnu::always_inline]] inline SineCosine<V> sincos(const V& x) noexcept {
  const detail::Reduced<V> angle = detail::reduced(x);
  const V sine = detail::short_sine(angle.high, angle.low), cosine = detail::short_cosine(angle.high, angle.low);
  const auto odd = (angle.quarters & 1) != 0;
  const detail::Bits<V> sine_sign = (angle.quarters & 2) << 62, cosine_sign = ((angle.quarters + 1) & 2) << 62;
  const V sine_or = odd ? cosine : sine, cosine_or = odd ? sine : cosine;
  const V size = magnitude(x);
  const V turned = std::bit_cast<V>(static_cast<detail::Bits<V>>(detail::bits_of(sine_or) ^ sine_sign));
  SineCosine<V> both{size < 0x1p-27 ? x : turned,
                     std::bit_cast<V>(static_cast<detail::Bits<V>>(detail::bits_of(cosine_or) ^ cosine_sign))};
  if (detail::any(size > detail::greatest_angle)) [[unlikely]] {
    SineCosine<V> all = both;  // copies, so that the others stay in registers
    const V angles = x;
    detail::set_great_angles(angles, all);
    both = all;
  }
  return both;
}

/// Sine of angles [rad], as computed by `sincos`.
template <class V>
[[nodiscard, gnu::always_inline]] inline V sin(const V& x) noexcept {
  return sincos(x).sin;
}
/// Cosine of angles [rad], as computed by `sincos`.
template <class V>
[[nodiscard, gnu::always_inline]] inline V cos(const V& x) noexcept {
  return sincos(x).cos;
}

/// Angle of (x, y) from the x axis, in [-pi, pi] [rad]; zeros and infinities as of `std::atan2`;
/// error at most 2 ulp. Source: fdlibm s_atan.c, with the quotient reduced before the division.
template <class V>
[[nodiscard, gnu::always_inline]] inline V atan2(const V& y, const V& x) noexcept {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const V up = magnitude(y), along = magnitude(x), zero{}, one = zero + 1.0;
  const auto steep = up > along;
  const V larger = steep ? up : along, smaller = steep ? along : up;
  const V scale = larger > 0x1p1000 ? zero + 0x1p-60 : one;  // keeps 2 m + n finite
  const V m = larger == infinity ? one : (larger == 0.0 ? one : larger * scale);
  const V n = larger == infinity ? (smaller == infinity ? one : zero) : smaller * scale;
  const auto half = n > 0.4375 * m, whole = n > 0.6875 * m;  // turned by atan(1/2), or atan(1)
  const V q = (whole ? n - m : (half ? 2.0 * n - m : n)) / (whole ? n + m : (half ? 2.0 * m + n : m));
  const V z = q * q, w = z * z;
  const V even =
      z * detail::polynomial(w, 1.62858201153657823623e-02, 4.97687799461593236017e-02, 6.66107313738753120669e-02,
                             9.09088713343650656196e-02, 1.42857142725034663711e-01, 3.33333333333329318027e-01);
  const V odd =
      w * detail::polynomial(w, 3.65315727442169155270e-02, 5.83357013379057348645e-02, 7.69187620504482999495e-02,
                             1.11111104054623557880e-01, 1.99999999998764832476e-01);
  const V part = q - q * (even - odd);
  const V back = whole ? zero + 7.85398163397448278999e-01 : (half ? zero + 4.63647609000806093515e-01 : zero);
  const V back_low = whole ? zero + 3.06161699786838301793e-17 : (half ? zero + 2.26987774529616870924e-17 : zero);
  constexpr double right = 1.57079632679489655800e+00, right_low = 6.12323399573676603587e-17;  // pi/2
  const V from_up = right - back, from_up_low = ((right - from_up) - back) + (right_low - back_low);
  const V flat = steep ? from_up : back, flat_low = steep ? from_up_low : back_low, flat_part = steep ? V(-part) : part;
  const V turned = 2 * right - flat, turned_low = ((2 * right - turned) - flat) + (2 * right_low - flat_low);
  const auto behind = (detail::bits_of(x) & detail::sign_bit) != 0;
  const V angle = (behind ? turned : flat) + ((behind ? turned_low : flat_low) + (behind ? V(-flat_part) : flat_part));
  const V nan = x + y;
  return x == x ? (y == y ? detail::with_sign(angle, y) : nan) : nan;
}

/// Natural logarithm; error at most 1 ulp. -infinity for +-0; NaN below 0. Source: `log_of_normal`.
template <class V>
[[nodiscard, gnu::always_inline]] inline V log(const V& x) noexcept {
  using Limits = std::numeric_limits<double>;
  constexpr double binades = 54 * 6.93147180559945309417e-01;
  const V zero{};
  const auto subnormal = x < Limits::min();
  const V scaled = detail::log_of_normal(subnormal ? V(x * 0x1p54) : x);
  const V value = subnormal ? scaled - binades : scaled;
  const V edge = x == Limits::infinity() ? x : (x == 0.0 ? zero - Limits::infinity() : zero + Limits::quiet_NaN());
  return x > 0.0 ? (x < Limits::infinity() ? value : edge) : edge;
}

/// base^exponent for a base of at least 0, as e^(exponent ln base). Error at most 4 + 2
/// |ln(result)| ulp. 1 for the exponent 0 and for the base 1; 0 for results below e^-708, and
/// infinity for those above e^709. NaN for a base below 0, and for NaN arguments otherwise.
template <class V>
[[nodiscard, gnu::always_inline]] inline V pow(const V& base, const V& exponent) noexcept {
  const V zero{};
  const V x = exponent * log(base);
  const V value = x > 709.0 ? zero + std::numeric_limits<double>::infinity() : exponential(x);
  return exponent == 0.0 ? zero + 1.0 : (base == 1.0 ? zero + 1.0 : value);
}

/// base^exponent by squaring, with the same bits in lanes; 1 for exponent 0. Error: `exponent` ulp.
template <class V>
[[nodiscard, gnu::always_inline]] inline V whole_power(V base, unsigned exponent) noexcept {
  V power = V{} + 1.0;
  for (; exponent != 0; exponent >>= 1) {
    if ((exponent & 1) != 0) power *= base;
    base *= base;
  }
  return power;
}

/// Nearest whole numbers, the even one of two; the sign of a zero is kept.
template <class V>
[[nodiscard, gnu::always_inline]] inline V round(const V& x) noexcept {
  const V size = magnitude(x);
  const V whole = (size + 0x1p52) - 0x1p52;
  return size < 0x1p52 ? detail::with_sign(whole, x) : x;
}

/// Greatest whole numbers that are not above.
template <class V>
[[nodiscard, gnu::always_inline]] inline V floor(const V& x) noexcept {
  const V nearest = round(x);
  return nearest > x ? nearest - 1.0 : nearest;
}

/// Square roots, rounded correctly; NaN below 0.
template <class V>
[[nodiscard, gnu::always_inline]] inline V sqrt(const V& x) noexcept {
  if constexpr (std::is_same_v<V, double>) {
    return std::sqrt(x);
  } else {
    V roots = x;
    constexpr std::size_t step = sizeof(V) < register_bytes ? sizeof(V) : register_bytes;
    for (std::size_t byte = 0; byte < sizeof(V); byte += step) {
      Vec<double, step / sizeof(double)> part;
      std::memcpy(&part, reinterpret_cast<const char*>(&x) + byte, step);
#if __has_builtin(__builtin_elementwise_sqrt)  // clang 16 and later, which lack those of x86-64
      part = __builtin_elementwise_sqrt(part);
#else
#if defined(__AVX__)
      if constexpr (step == 32) part = __builtin_ia32_sqrtpd256(part);
#endif
#if defined(__SSE2__)
      if constexpr (step == 16) part = __builtin_ia32_sqrtpd(part);
#elif defined(__aarch64__)
      part = vsqrtq_f64(part);
#else
      for (std::size_t lane = 0; lane < step / sizeof(double); ++lane) part[lane] = std::sqrt(part[lane]);
#endif
#endif
      std::memcpy(reinterpret_cast<char*>(&roots) + byte, &part, step);
    }
    return roots;
  }
}

}  // namespace PULSECAST_NAMESPACE::simd

#pragma GCC diagnostic pop

#endif
