// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Compiled with settings of GLM and of the standard library that no other file has: containers of another size, and
// such as change nothing here. Quaternions in another order do not link: package/settings.
#define GLM_FORCE_DEFAULT_ALIGNED_GENTYPES
#define GLM_FORCE_EXPLICIT_CTOR
#define GLM_FORCE_LEFT_HANDED
#define GLM_FORCE_SIZE_T_LENGTH
#define GLM_FORCE_XYZW_ONLY
#define _GLIBCXX_DEBUG  // NOLINT(bugprone-reserved-identifier): of the standard library
#include "support/mixed_instructions.hpp"

pulsecast::support::AnswerOfFile pulsecast::support::answer_of_other_settings() { return answer_of_this_file(); }
