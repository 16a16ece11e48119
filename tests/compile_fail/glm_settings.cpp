// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
// error: vectors must be copied as memory: compile without GLM_FORCE_CTOR_INIT
// option: -DGLM_FORCE_CTOR_INIT
// option: -DGLM_FORCE_CXX98
// option: -DGLM_FORCE_CXX03
#include <pulsecast/pulsecast.hpp>

int main() {}
