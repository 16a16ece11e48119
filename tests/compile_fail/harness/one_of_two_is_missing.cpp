// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
// error: frames that do not touch
// error: a message that is not there

#ifdef SHOULD_NOT_COMPILE
#error "frames that do not touch"
#endif

int main() {}
