// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
// mistake 1: frames that do not touch

#if defined(MISTAKE) && MISTAKE == 1
#error "another message"
#error "frames that do not touch"
#endif

int main() {}
