// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_CHILD_PROCESS_HPP
#define PULSECAST_IO_DETAIL_CHILD_PROCESS_HPP

#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>
#if defined(__linux__)
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#endif

#include <pulsecast/io/detail/archive.hpp>
#include <pulsecast/io/input_file.hpp>

/// Calls of foreign libraries in a child process, so that what kills or hangs them is an error.
namespace PULSECAST_NAMESPACE::io::detail {

/// Takes the network from this process for good: calls that make a socket fail with EACCES. Has an
/// effect only on Linux on x86-64 or 64-bit ARM with filters of system calls, and needs no
/// privilege. Source: Linux kernel, Documentation/userspace-api/seccomp_filter.rst.
inline void leave_network() noexcept {
#if defined(__linux__) && (defined(__x86_64__) || defined(__aarch64__))
#if defined(__x86_64__)
  constexpr std::uint32_t machine = AUDIT_ARCH_X86_64, other_numbers = 0x40000000;  // those of x32
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
      sock_filter BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, machine, 0, 5),  // calls of another machine
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

struct ChildLimits {
  double memory = 1e9;  ///< beside that of the parent [byte]
  double time = 60;     ///< of computation, and by the clock [s]
};

/// Child process that does one piece of work: a fork, or a program that calls `serve`. The child has
/// no network. A fork has one thread, and must not use locks that other threads may hold; those of
/// memory and of streams are none of these.
class ChildProcess {
 public:
  /// Result of `make`, called in a child: an object that an `ArchiveWriter` takes, whose arrays
  /// stay where they are read. Throws the `FileError` of `make`, or one of `path` about the child's
  /// death or an inconsistent result, as the child may be damaged by what it read.
  template <class Make>
  [[nodiscard]] static auto result(const std::string& path, const ChildLimits& limits, const Make& make) {
    decltype(make()) made{};
    const File file(path);
    const int status =
        run(path, limits, [&] { be_child(file.number, limits, [&](ArchiveWriter& to) { to(make()); }); });
    take(path, file.number, status, limits, [&](ArchiveReader& from) { from(made); });
    return made;
  }

  /// Result of a program of this build, of the type that it makes of `request`; errors are those of `result`. The
  /// program is started with the number of a file, which has the request, and inherits no other but 0, 1 and 2.
  template <class Made>
  [[nodiscard]] static Made result_of(const std::filesystem::path& program, const std::string& path,
                                      const ChildLimits& limits, const auto& request) {
    Made made{};
    const File file(path);
    write(file.number, requested, [&](ArchiveWriter& to) { to(limits, request); });
    const std::string number = std::to_string(file.number);
    const int status = run(path, limits, [&] { start(program, file.number, number); });
    if (last_word(file.number) == requested && !(WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU))
      detail::fail(path, "cannot be imported, as ", program.string(),
                   " does not start: expected that program, of this build, and its libraries");
    take(path, file.number, status, limits, [&](ArchiveReader& from) { from(made); });
    return made;
  }

  /// In such a program: takes the request from the file of that number, hands the result of `make` over, and exits.
  /// Returns if there is no request, or one of another build.
  template <class Request>
  static void serve(int file, const auto& make) {
    ChildLimits limits;
    Request request{};
    try {
      if (last_word(file) != requested) return;
      ArchiveReader from = content(file);
      from(limits, request);
      from.require_end();
    } catch (const ArchiveError&) {
      return;
    }
    if (::ftruncate(file, 0) != 0) return;
    be_child(file, limits, [&](ArchiveWriter& to) { to(make(request)); });
  }

  /// In a child: raises the limit of memory by some bytes.
  static void allow(double bytes) {
    rlimit limit{};
    if (::getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return;
    const double more = static_cast<double>(limit.rlim_cur) + bytes;
    limit.rlim_cur = more < 9e18 ? std::min<rlim_t>(static_cast<rlim_t>(more), limit.rlim_max) : limit.rlim_max;
    ::setrlimit(RLIMIT_AS, &limit);
  }

 private:
  using Work = std::function<void(ArchiveWriter&)>;
  using Word = std::array<char, 8>;  ///< end of a result

  struct File {
    int number;
    explicit File(const std::string& path) {
#if defined(__linux__)
      number = ::memfd_create("pulsecast", MFD_CLOEXEC);
#else
      std::string name = (std::filesystem::temp_directory_path() / "pulsecast_XXXXXX").string();
      number = ::mkstemp(name.data());
      ::unlink(name.c_str());
#endif
      if (number < 0) detail::fail(path, "no file for the result of its import: ", system_error());
    }
    File(const File&) = delete;
    File& operator=(const File&) = delete;
    ~File() { ::close(number); }
  };

  static constexpr Word requested{'p', 'c', ' ', 'a', 's', 'k', 's', '.'}, done{'p', 'c', ' ', 'd', 'o', 'n', 'e', '.'},
      failed{'p', 'c', ' ', 'f', 'a', 'i', 'l', '.'};

  [[nodiscard]] static int run(const std::string& path, const ChildLimits& limits, const auto& in_child) {
    std::fflush(nullptr);
    const pid_t child = ::fork();
    if (child < 0) detail::fail(path, "no child process can be started for its import: ", system_error());
    if (child == 0) in_child();  // which does not return
    return wait(child, limits.time);
  }

  [[noreturn]] static void start(const std::filesystem::path& program, int file, const std::string& number) noexcept {
#if defined(__linux__)
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    ::syscall(SYS_close_range, 3, file - 1, 0);
    ::syscall(SYS_close_range, file + 1, ~0U, 0);
#endif
    ::fcntl(file, F_SETFD, 0);
    ::execl(program.c_str(), program.c_str(), number.c_str(), nullptr);
    ::_exit(127);
  }

  [[noreturn]] static void be_child(int file, const ChildLimits& limits, const Work& work) noexcept {
#if defined(__linux__)
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
#endif
    for (const int one : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGXCPU, SIGTERM}) std::signal(one, SIG_DFL);
    if (const int quiet = ::open("/dev/null", O_RDWR); quiet >= 0) {  // for libraries that print
      ::dup2(quiet, STDOUT_FILENO);
      ::dup2(quiet, STDERR_FILENO);
    }
    limit(RLIMIT_CORE, 0);
    limit(RLIMIT_CPU, std::ceil(limits.time) + 1);
    limit(RLIMIT_AS, memory_in_use() + limits.memory);
    leave_network();
    const auto tell = [file](const FileError& error) {
      write(file, failed, [&](ArchiveWriter& to) { to(error.path(), error.place(), error.problem()); });
    };
    try {
      try {
        write(file, done, work);
      } catch (const FileError& error) {
        tell(error);
      } catch (const std::bad_alloc&) {
        throw;
      } catch (const std::exception& error) {
        tell({"", "", error.what()});
      } catch (...) {
        tell({"", "", "its import failed without a reason"});
      }
    } catch (...) {
      ::_exit(out_of_memory);
    }
    ::_exit(0);
  }

  static constexpr int out_of_memory = 77;  ///< exit status

  /// Makes some objects and a word the content of a file.
  static void write(int file, const Word& word, const Work& work) {
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> out(::fdopen(::dup(file), "wb"), std::fclose);
    if (!out || ::ftruncate(file, 0) != 0 || ::lseek(file, 0, SEEK_SET) != 0) throw std::bad_alloc();
    const auto put = [&](std::span<const std::byte> bytes) {
      if (std::fwrite(bytes.data(), 1, bytes.size(), out.get()) != bytes.size()) throw std::bad_alloc();
    };
    ArchiveWriter writer(put);
    work(writer);
    put(std::as_bytes(std::span(word)));
    if (std::fflush(out.get()) != 0) throw std::bad_alloc();  // the file is in memory
  }

  static void limit(decltype(RLIMIT_AS) resource, double value) {
    rlimit now{};
    if (::getrlimit(resource, &now) != 0) return;
    const auto asked = static_cast<rlim_t>(std::min(value, 9e18));
    now.rlim_cur = now.rlim_max == RLIM_INFINITY ? asked : std::min(asked, now.rlim_max);
    ::setrlimit(resource, &now);
  }

  /// Address space of this process [byte].
  [[nodiscard]] static double memory_in_use() {
    double pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    return pages * static_cast<double>(::sysconf(_SC_PAGESIZE));
  }

  /// Waits for the child, and kills it in the end. Returns its status.
  [[nodiscard]] static int wait(pid_t child, double time) {
    const auto last = std::chrono::steady_clock::now() + std::chrono::duration<double>(time);
    timespec pause{0, 50'000};
    for (bool killed = false;;) {
      int status = 0;
      const pid_t ended = ::waitpid(child, &status, killed ? 0 : WNOHANG);
      if (ended == child) return killed && WIFSIGNALED(status) ? SIGXCPU : status;
      if (ended < 0 && errno != EINTR) return 0;  // another has waited for it: its result decides
      if (std::chrono::steady_clock::now() > last && !std::exchange(killed, true)) ::kill(child, SIGKILL);
      ::nanosleep(&pause, nullptr);
      pause.tv_nsec = std::min<long>(pause.tv_nsec * 2, 5'000'000);
    }
  }

  /// The last bytes of a file, or zeros.
  [[nodiscard]] static Word last_word(int file) {
    Word word{};
    struct stat size {};
    if (::fstat(file, &size) == 0 && size.st_size >= static_cast<off_t>(word.size()) &&
        ::pread(file, word.data(), word.size(), size.st_size - static_cast<off_t>(word.size())) < 0)
      word = {};
    return word;
  }

  /// All before its last word, in a mapping.
  [[nodiscard]] static ArchiveReader content(int file) {
    struct stat size {};
    ::fstat(file, &size);
    const auto bytes = static_cast<std::size_t>(size.st_size);
    void* const memory = ::mmap(nullptr, bytes, PROT_READ, MAP_PRIVATE, file, 0);
    if (memory == MAP_FAILED) throw std::bad_alloc();
    const std::shared_ptr<void> owner(memory, [bytes](void* at) { ::munmap(at, bytes); });
    return {{static_cast<const std::byte*>(memory), bytes - done.size()}, owner};
  }

  static void take(const std::string& path, int file, int status, const ChildLimits& limits,
                   const std::function<void(ArchiveReader&)>& by) {
    const auto fail = [&](const auto&... problem) { detail::fail(path, "its import ", problem...); };
    constexpr const char* consequence = ": the file is damaged, or too large for the limit";
    const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    if (signal == SIGXCPU) fail("took more than ", limits.time, " s", consequence);
    if (signal == SIGKILL)
      fail("was killed, as the system does when memory runs out: expected more free memory, or another try");
    if (signal != 0) fail("ended by signal ", signal, ": the file is damaged");
    if (WIFEXITED(status) && WEXITSTATUS(status) == out_of_memory)
      fail("took more memory than is allowed", consequence);
    const Word end = last_word(file);
    if (end != done && end != failed) fail("ended without a result: the file is damaged");
    constexpr const char* inconsistent = "in a child process gave an inconsistent result";
    std::string of, place, problem;
    try {
      ArchiveReader from = content(file);
      end == done ? by(from) : from(of, place, problem);
      from.require_end();
    } catch (const ArchiveError&) {
      fail(inconsistent);
    } catch (const SettingError&) {
      fail(inconsistent);
    }
    if (end == failed) throw FileError(of.empty() ? path : of, place, problem);
  }
};

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
