// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

#include "entry.hpp"

int main(int argc, char** argv) { return pulsecast_main(argc, argv); }
