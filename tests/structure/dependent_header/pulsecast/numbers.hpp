// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

using Numbers = std::vector<double>;
