// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_BASE_NAMESPACE_HPP
#define PULSECAST_BASE_NAMESPACE_HPP

/// Namespace of the library, with an inline namespace by the instruction set of the compiler's flags. Files of one program may thus be
/// compiled for different processors: their functions have different names, so that the linker never takes one for another.
/// `pulsecast::Scene` names that of the file's own flags.
#if defined(__AVX512F__)
#define PULSECAST_INSTRUCTIONS avx512
#elif defined(__AVX2__)
#define PULSECAST_INSTRUCTIONS avx2
#elif defined(__AVX__)
#define PULSECAST_INSTRUCTIONS avx
#elif defined(__SSE4_1__)
#define PULSECAST_INSTRUCTIONS sse4
#else
#define PULSECAST_INSTRUCTIONS baseline
#endif
#define PULSECAST_NAMESPACE pulsecast::inline PULSECAST_INSTRUCTIONS

#endif
