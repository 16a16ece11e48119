// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_BASE_EXPONENTIAL_HPP
#define PULSECAST_BASE_EXPONENTIAL_HPP

#include <concepts>

#include <pulsecast/base/simd.hpp>

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"  // of vectors wider than a register

namespace PULSECAST_NAMESPACE {

namespace simd::detail {
/// Polynomial in x by Horner's rule, its coefficients from the highest power down.
template <class V, class... Lower>
[[nodiscard, gnu::always_inline]] constexpr V polynomial(const V& x, double highest, double second,
                                                         Lower... lower) noexcept {
  V value = highest * x + second;
  ((value = value * x + lower), ...);
  return value;
}
}  // namespace simd::detail

/// e^x of a number or of lanes; 0 for x below -708. Relative error at most 4e-16. Source: Cody &
/// Waite 1980: x = n ln 2 + r, ln 2 in two parts; Taylor series for r to 4e-18.
template <class Number>
requires std::same_as<Number, double> || std::same_as<Number, simd::Vec<double, 2>> ||
    std::same_as<Number, simd::Vec<double, 4>> || std::same_as<Number, simd::Vec<double, 8>>
[[nodiscard, gnu::always_inline]] inline Number exponential(const Number& x) noexcept {
  using Bits = simd::detail::Bits<Number>;
  constexpr double per_ln2 = 1.4426950408889634;
  constexpr double ln2_high = 0x1.62e42fee00000p-1, ln2_low = 0x1.a39ef35793c76p-33;
  constexpr double whole = 0x1.8p52;  // a sum with it ends in the bits of n
  constexpr double least = -708;
  const Number shifted = x * per_ln2 + whole, n = shifted - whole;
  const Number r = (x - n * ln2_high) - n * ln2_low;
  using simd::detail::polynomial;
  const Number series = polynomial(r, 1.0 / 6227020800, 1.0 / 479001600, 1.0 / 39916800, 1.0 / 3628800, 1.0 / 362880,
                                   1.0 / 40320, 1.0 / 5040, 1.0 / 720, 1.0 / 120, 1.0 / 24, 1.0 / 6, 0.5, 1.0, 1.0);
  const Bits exponent = (std::bit_cast<Bits>(shifted) + 1023) << 52;
  return x < least ? Number{} : series * std::bit_cast<Number>(exponent);
}

}  // namespace PULSECAST_NAMESPACE

#pragma GCC diagnostic pop

#endif
