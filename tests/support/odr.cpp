// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// A second translation unit that includes everything, in every test program: what is not inline does not link.
#include <pulsecast/pulsecast.hpp>
