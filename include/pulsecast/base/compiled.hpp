// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_BASE_COMPILED_HPP
#define PULSECAST_BASE_COMPILED_HPP

#include <pulsecast/base/namespace.hpp>
#include <pulsecast/version.hpp>

/// `pulsecast::compiled` is a library with the definitions of readers and XML surveys. Its users
/// get `PULSECAST_COMPILED` from the target, and include declarations only.

/// True where a header ends with its definitions: not for users of the library, only in its source.
#if defined(PULSECAST_COMPILED)
#define PULSECAST_DEFINES(header) PULSECAST_DEFINES_##header
#else
#define PULSECAST_DEFINES(header) 1
#endif

#if defined(PULSECAST_COMPILED_SOURCE)
#define PULSECAST_INLINE  ///< in sources of the library, which define each function once
#else
#define PULSECAST_INLINE inline
#endif

namespace PULSECAST_NAMESPACE::detail {

/// Version as a number: `0.1.1` is 101.
[[nodiscard]] consteval unsigned version_number() {
  unsigned whole = 0, part = 0;
  for (const char* c = PULSECAST_VERSION;; ++c) {
    if (*c >= '0' && *c <= '9') {
      part = 10 * part + static_cast<unsigned>(*c - '0');
      continue;
    }
    whole = 100 * whole + part;
    part = 0;
    if (*c == '\0') return whole;
  }
}

}  // namespace PULSECAST_NAMESPACE::detail

#if defined(PULSECAST_COMPILED)
namespace PULSECAST_NAMESPACE::detail {

/// Marks a build of the library by its version, and by all else in the namespace: a program of
/// another build does not link, as it misses this function.
template <unsigned version>
void compiled_library_of_this_build()
#if defined(PULSECAST_COMPILED_SOURCE)
    {}
#else
    ;
#endif

namespace {
  [[gnu::used]] void (*const compiled_library)() = &compiled_library_of_this_build<version_number()>;
}

}  // namespace PULSECAST_NAMESPACE::detail
#endif

#endif
