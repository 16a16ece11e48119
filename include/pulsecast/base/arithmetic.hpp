// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_BASE_ARITHMETIC_HPP
#define PULSECAST_BASE_ARITHMETIC_HPP

/// Rejects compiler options that give up IEEE 754 arithmetic: infinities, NaN rays, the order of additions. Contraction
/// of a product and a sum into one rounding (-ffp-contract=fast, on machines that have it) is welcome.
#if defined(__FAST_MATH__) || defined(__ASSOCIATIVE_MATH__) || \
    (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__ > 0)
// clang-format off
#error "pulsecast needs IEEE 754 arithmetic: compile without -ffast-math, -Ofast, -ffinite-math-only, -funsafe-math-optimizations; -O3 will do"
// clang-format on
#endif

#endif
