// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstddef>

namespace pulsecast::support {

/// Number of calls of operator new so far, which allocations.cpp replaces in all test programs; none is counted under a
/// sanitizer.
extern std::atomic<std::size_t> allocations;

/// Number of calls of operator new up to one that throws `std::bad_alloc`, counted down; 0: none does. Without effect
/// under a sanitizer.
extern std::atomic<std::size_t> allocations_left;

}  // namespace pulsecast::support
