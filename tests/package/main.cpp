// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/pulsecast.hpp>

#include <iostream>
#ifdef WITH_las
#include <pulsecast/adapters/las.hpp>
#endif
#ifdef WITH_obj
#include <pulsecast/adapters/obj.hpp>
#endif

static void unused() {}

int main() { std::cout << "pulsecast " PULSECAST_VERSION " has a consumer with " ADAPTERS "\n"; }
