// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <pulsecast/numbers.hpp>

double sum(const Numbers& numbers);
