// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// The module of packages: empty, as `PyInit__core` is in the shared object that it is linked with, one for each level
// of instructions.
