// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_NO_NETWORK_HPP
#define PULSECAST_IO_DETAIL_NO_NETWORK_HPP

#include <pulsecast/base/namespace.hpp>

#if defined(__linux__)
#include <array>
#include <cerrno>

#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#endif

namespace PULSECAST_NAMESPACE::io::detail {

/// Takes the network from this process for good: calls that make a socket fail with EACCES. Needs no privilege. Without
/// effect where the system is not Linux on x86-64 or 64-bit ARM, or has no filters of system calls. Source: Linux
/// kernel, Documentation/userspace-api/seccomp_filter.rst.
inline void leave_network() noexcept {
#if defined(__linux__) && (defined(__x86_64__) || defined(__aarch64__))
#if defined(__x86_64__)
  constexpr std::uint32_t machine = AUDIT_ARCH_X86_64, other_numbers = 0x40000000;  // bit of the numbers of x32
#else
  constexpr std::uint32_t machine = AUDIT_ARCH_AARCH64, other_numbers = 0x80000000;  // none
#endif
  constexpr std::uint32_t deny = SECCOMP_RET_ERRNO | EACCES;
  const auto load = [](std::size_t offset) {
    return sock_filter BPF_STMT(BPF_LD | BPF_W | BPF_ABS, static_cast<std::uint32_t>(offset));
  };
  const auto skip_if_equal = [](std::uint32_t number, std::uint8_t steps) {
    return sock_filter BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, number, steps, 0);
  };
  std::array<sock_filter, 8> rules{
      load(offsetof(seccomp_data, arch)),
      sock_filter BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, machine, 0, 5),  // system calls of another machine
      load(offsetof(seccomp_data, nr)),
      sock_filter BPF_JUMP(BPF_JMP | BPF_JSET | BPF_K, other_numbers, 3, 0),
      skip_if_equal(SYS_socket, 2),
      skip_if_equal(SYS_io_uring_setup, 1),  // which makes sockets, too
      sock_filter BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
      sock_filter BPF_STMT(BPF_RET | BPF_K, deny)};
  sock_fprog program{.len = static_cast<unsigned short>(rules.size()), .filter = rules.data()};
  if (::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0) (void)::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program, 0, 0);
#endif
}

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
