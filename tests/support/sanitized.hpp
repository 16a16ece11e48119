// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

/// Defines PULSECAST_TEST_SANITIZED under the address and thread sanitizers, which need address space of their own, and
/// no threads in a child.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define PULSECAST_TEST_SANITIZED
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define PULSECAST_TEST_SANITIZED
#endif
#endif
