// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_BASE_NAMESPACE_HPP
#define PULSECAST_BASE_NAMESPACE_HPP

#include <cstddef>  // for all headers; with the macros of the standard library
#include <cstdint>  // for all headers

/// Rejects compiler options that give up IEEE 754 arithmetic: infinities, NaN, the order of
/// additions. Contraction of a product and a sum into one rounding (-ffp-contract=fast) is welcome.
#if defined(__FAST_MATH__) || defined(__ASSOCIATIVE_MATH__) || \
    (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__ > 0)
// clang-format off
#error "pulsecast needs IEEE 754 arithmetic: compile without -ffast-math, -Ofast, -ffinite-math-only, -funsafe-math-optimizations; -O3 will do"
// clang-format on
#endif

/// Namespace of the library. Inline namespaces name the instruction set of the compiler's flags,
/// and macros that change layouts or constructors. So files of one program may be compiled for
/// different processors, and with different settings of GLM and of the standard library: the linker
/// never takes one's function for another's. What passes between such files does not link.
#if defined(__AVX512F__)
#define PULSECAST_INSTRUCTIONS avx512
#elif defined(__AVX2__)
#define PULSECAST_INSTRUCTIONS avx2
#elif defined(__AVX__)
#define PULSECAST_INSTRUCTIONS avx
#elif defined(__SSE4_1__)
#define PULSECAST_INSTRUCTIONS sse4
#elif defined(__aarch64__)
#define PULSECAST_INSTRUCTIONS neon
#else
#define PULSECAST_INSTRUCTIONS baseline
#endif
#if defined(__FMA__)
#define PULSECAST_FUSED ::inline fma
#else
#define PULSECAST_FUSED
#endif
#if defined(GLM_FORCE_QUAT_DATA_WXYZ) || \
    defined(GLM_FORCE_QUAT_DATA_XYZW)  // of GLM 0.9.9 and 1.0: the other order than by default
#define PULSECAST_QUATERNIONS ::inline other_quaternions
#else
#define PULSECAST_QUATERNIONS
#endif
#if defined(GLM_FORCE_QUAT_CTOR_XYZW)  // of GLM 1.0
#define PULSECAST_CTORS ::inline constructors_xyzw
#else
#define PULSECAST_CTORS
#endif
#if defined(_GLIBCXX_DEBUG) || (defined(_LIBCPP_DEBUG) && _LIBCPP_DEBUG > 0) || defined(_LIBCPP_ENABLE_DEBUG_MODE)
#define PULSECAST_CONTAINERS ::inline checked_containers
#else
#define PULSECAST_CONTAINERS
#endif
#if defined(_LIBCPP_VERSION)
#define PULSECAST_LIBRARY ::inline libcpp
#elif defined(_GLIBCXX_USE_CXX11_ABI) && !_GLIBCXX_USE_CXX11_ABI
#define PULSECAST_LIBRARY ::inline old_strings
#else
#define PULSECAST_LIBRARY
#endif
#define PULSECAST_NAMESPACE                                                                                           \
  pulsecast::inline PULSECAST_INSTRUCTIONS PULSECAST_FUSED PULSECAST_QUATERNIONS PULSECAST_CTORS PULSECAST_CONTAINERS \
      PULSECAST_LIBRARY

#endif
