// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
// error: frames that do not touch

#ifdef SHOULD_NOT_COMPILE
#include <no_such_header>
#endif

int main() {}
