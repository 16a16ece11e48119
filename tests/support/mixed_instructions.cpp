// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Compiled for AVX2, whatever the flags of the other files.
#include "support/mixed_instructions.hpp"

pulsecast::support::AnswerOfFile pulsecast::support::answer_of_avx2() { return answer_of_this_file(); }
