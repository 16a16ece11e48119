// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <csignal>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace pulsecast::support {

/// Whether assertions are compiled in.
#ifdef NDEBUG
inline constexpr bool has_assertions = false;
#else
inline constexpr bool has_assertions = true;
#endif

/// Whether a call ends in an assertion that fails; it runs in a process of its own, in silence.
template <class Call>
[[nodiscard]] bool aborts(const Call& call) {
  const pid_t child = fork();
  if (child == 0) {
    const rlimit no_core{0, 0};
    setrlimit(RLIMIT_CORE, &no_core);
    std::signal(SIGABRT, SIG_DFL);
    close(STDERR_FILENO);
    call();
    _exit(0);
  }
  int status = 0;
  return child > 0 && waitpid(child, &status, 0) == child && WIFSIGNALED(status) && WTERMSIG(status) == SIGABRT;
}

}  // namespace pulsecast::support
