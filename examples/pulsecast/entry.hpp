// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

/// The whole program; in packages a function of a shared object, of which there is one for each level of instructions.
[[gnu::visibility("default")]] int pulsecast_main(int argc, char** argv);
