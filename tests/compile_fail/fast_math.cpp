// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
// error: pulsecast needs IEEE 754 arithmetic: compile without -ffast-math
// option: -ffast-math
// option: -Ofast
// option: -ffinite-math-only
#include <pulsecast/pulsecast.hpp>

int main() {}
