// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

double product(const Numbers& numbers);  // fails to include numbers.hpp
