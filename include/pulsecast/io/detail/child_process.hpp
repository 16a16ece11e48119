// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_CHILD_PROCESS_HPP
#define PULSECAST_IO_DETAIL_CHILD_PROCESS_HPP

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <new>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <type_traits>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>
#if defined(__linux__)
#include <sys/prctl.h>
#endif

#include <pulsecast/base/error.hpp>
#include <pulsecast/io/detail/no_network.hpp>

/// Calls of foreign libraries in a child process, so that what kills or hangs them is an error.
namespace PULSECAST_NAMESPACE::io::detail {

/// Writes the result of a child into a file.
class ChildOutput {
 public:
  explicit ChildOutput(int file) : file_(file) {}

  /// A number, or a struct of plain numbers.
  template <class T>
  requires std::is_trivially_copyable_v<T>
  void value(const T& value) { bytes(&value, sizeof value); }
  void text(std::string_view text) { array(std::span<const char>(text)); }
  /// Elements, in place for the reader.
  template <class T>
  requires std::is_trivially_copyable_v<T>
  void array(std::span<const T> elements) {
    value(std::uint64_t{elements.size()});
    align();
    bytes(elements.data(), elements.size_bytes());
  }

  /// Number of items, and each by a function.
  template <class Item, class Write>
  void items(std::vector<Item>& all, const Write& write) {
    value(std::uint64_t{all.size()});
    for (Item& item : all) write(item);
  }

  /// Raises the limit of memory by some bytes. Calls before the work grow what it may take.
  static void allow(double bytes) {
    rlimit limit{};
    if (::getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return;
    const double more = static_cast<double>(limit.rlim_cur) + bytes;
    limit.rlim_cur = more < 9e18 ? std::min<rlim_t>(static_cast<rlim_t>(more), limit.rlim_max) : limit.rlim_max;
    ::setrlimit(RLIMIT_AS, &limit);
  }

  /// Writes the pending bytes, and a word that marks the end for the parent.
  void end(const std::array<char, 8>& word) {
    align();
    value(word);
    flush();
  }
  /// Removes all that was written.
  void clear() {
    buffer_.clear();
    position_ = 0;
    if (::ftruncate(file_, 0) != 0 || ::lseek(file_, 0, SEEK_SET) != 0) ::_exit(1);
  }

 private:
  static constexpr std::size_t alignment = 16;

  void align() {
    static constexpr std::array<char, alignment> zeros{};
    bytes(zeros.data(), (alignment - position_ % alignment) % alignment);
  }
  void bytes(const void* data, std::size_t size) {
    if (size == 0) return;
    position_ += size;
    if (buffer_.size() + size > std::size_t{1} << 16) flush();
    if (size > std::size_t{1} << 16) return put(static_cast<const char*>(data), size);
    buffer_.insert(buffer_.end(), static_cast<const char*>(data), static_cast<const char*>(data) + size);
  }
  void flush() {
    put(buffer_.data(), buffer_.size());
    buffer_.clear();
  }
  void put(const char* data, std::size_t size) {
    while (size > 0) {
      const ssize_t done = ::write(file_, data, size);
      if (done < 0 && errno == EINTR) continue;
      if (done <= 0) throw std::bad_alloc();  // the file is in memory
      data += done;
      size -= static_cast<std::size_t>(done);
    }
  }

  int file_;
  std::uint64_t position_ = 0;
  std::vector<char> buffer_;
};

/// Reads the result of a child. Errors are a `FileError`: the child may have been damaged by what it read.
class ChildResult {
 public:
  ChildResult(std::string path, std::span<const std::byte> bytes, std::shared_ptr<const void> owner)
      : path_(std::move(path)), bytes_(bytes), owner_(std::move(owner)) {}

  template <class T>
  requires std::is_trivially_copyable_v<T>
  [[nodiscard]] T value() {
    T made;
    std::memcpy(&made, take(sizeof made).data(), sizeof made);
    return made;
  }
  [[nodiscard]] std::string text() {
    const std::span<const char> letters = array<char>();
    return {letters.begin(), letters.end()};
  }
  /// Elements, which live as long as `owner`.
  template <class T>
  requires std::is_trivially_copyable_v<T>
  [[nodiscard]] std::span<const T> array() {
    const auto count = value<std::uint64_t>();
    position_ = (position_ + 15) / 16 * 16;
    if (position_ > bytes_.size() || count > (bytes_.size() - position_) / sizeof(T)) fail();
    return {reinterpret_cast<const T*>(take(count * sizeof(T)).data()), static_cast<std::size_t>(count)};
  }
  /// As above, into what they are for.
  template <class T>
  requires std::is_trivially_copyable_v<T>
  void value(T& to) { to = value<T>(); }
  void text(std::string& to) { to = text(); }
  template <class T>
  void array(std::span<const T>& to) {
    to = array<T>();
  }
  /// Items of at least a byte each, each by a function.
  template <class Item, class Read>
  void items(std::vector<Item>& all, const Read& read) {
    const auto count = value<std::uint64_t>();
    if (count > bytes_.size()) fail();
    while (all.size() < count) read(all.emplace_back());
  }

  [[nodiscard]] const std::shared_ptr<const void>& owner() const noexcept { return owner_; }
  [[noreturn]] void fail() const {
    throw FileError(path_, "", "its import in a child process gave an inconsistent result");
  }

 private:
  [[nodiscard]] std::span<const std::byte> take(std::uint64_t size) {
    if (position_ > bytes_.size() || size > bytes_.size() - position_) fail();
    position_ += size;
    return bytes_.subspan(position_ - size, size);
  }

  std::string path_;
  std::span<const std::byte> bytes_;
  std::shared_ptr<const void> owner_;
  std::uint64_t position_ = 0;
};

/// Limits of a child.
struct ChildLimits {
  double memory = 1e9;  ///< beside that of the parent [byte]
  double time = 60;     ///< of computation, and by the clock [s]
};

/// Child process that does one piece of work: a fork, which starts no program, so that a library without a program of
/// its own can have it. The child has one thread and no network. It must not use locks that other threads may hold,
/// which those of memory and of streams are not.
class ChildProcess {
 public:
  using Work = std::function<void(ChildOutput&)>;

  /// Calls `work` in a child and waits. Throws the `FileError` of `work`, or one of `path` about the child's death.
  [[nodiscard]] static ChildResult result(const std::string& path, const ChildLimits& limits, const Work& work) {
    const File file(path);
    std::fflush(nullptr);
    const pid_t child = ::fork();
    if (child < 0)
      throw FileError(path, "",
                      "no child process can be started for its import: " + std::generic_category().message(errno));
    if (child == 0) run(file.number, limits, work);
    const int status = wait(child, limits.time);
    return finished(path, file.number, status, limits);
  }

 private:
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
      if (number < 0)
        throw FileError(path, "", "no file for the result of its import: " + std::generic_category().message(errno));
    }
    File(const File&) = delete;
    File& operator=(const File&) = delete;
    ~File() { ::close(number); }
  };

  static constexpr std::array<char, 8> done{'p', 'c', ' ', 'd', 'o', 'n', 'e', '.'},
      failed{'p', 'c', ' ', 'f', 'a', 'i', 'l', '.'};

  /// The child's part.
  [[noreturn]] static void run(int file, const ChildLimits& limits, const Work& work) noexcept {
#if defined(__linux__)
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
#endif
    for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGXCPU, SIGTERM}) std::signal(signal, SIG_DFL);
    if (const int quiet = ::open("/dev/null", O_RDWR); quiet >= 0) {  // for libraries that print
      ::dup2(quiet, STDOUT_FILENO);
      ::dup2(quiet, STDERR_FILENO);
    }
    limit(RLIMIT_CORE, 0);
    limit(RLIMIT_CPU, std::ceil(limits.time) + 1);
    limit(RLIMIT_AS, memory_in_use() + limits.memory);
    leave_network();
    try {
      ChildOutput output(file);
      try {
        work(output);
        output.end(done);
      } catch (const FileError& error) {
        output.clear();
        for (const std::string& part : {error.path(), error.place(), error.problem()}) output.text(part);
        output.end(failed);
      } catch (const std::bad_alloc&) {
        ::_exit(out_of_memory);
      } catch (const std::exception& error) {
        output.clear();
        for (const char* part : {"", "", error.what()}) output.text(part);
        output.end(failed);
      } catch (...) {
        output.clear();
        for (const char* part : {"", "", "its import failed without a reason"}) output.text(part);
        output.end(failed);
      }
    } catch (...) {
      ::_exit(out_of_memory);
    }
    ::_exit(0);
  }

  static constexpr int out_of_memory = 77;  ///< exit status

  /// Lowers the limit in force of a resource.
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

  [[nodiscard]] static ChildResult finished(const std::string& path, int file, int status, const ChildLimits& limits) {
    const auto fail = [&](const std::string& problem) { throw FileError(path, "", problem); };
    const std::string consequence = ": the file is damaged, or too large for the limit";
    if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU)
      fail("its import took more than " + text::to_text(limits.time) + " s" + consequence);
    if (WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL)
      fail("its import was killed, as the system does when memory runs out: expected more free memory, or another try");
    if (WIFSIGNALED(status))
      fail("its import ended by signal " + std::to_string(WTERMSIG(status)) + ": the file is damaged");
    if (WIFEXITED(status) && WEXITSTATUS(status) == out_of_memory)
      fail("its import took more memory than is allowed" + consequence);
    struct stat size {};
    const std::size_t word = done.size();
    if (::fstat(file, &size) != 0 || size.st_size < static_cast<off_t>(word))
      fail("its import ended without a result: the file is damaged");
    const auto bytes = static_cast<std::size_t>(size.st_size);
    void* const memory = ::mmap(nullptr, bytes, PROT_READ, MAP_PRIVATE, file, 0);
    if (memory == MAP_FAILED) throw std::bad_alloc();
    const std::shared_ptr<const void> owner(memory,
                                            [bytes](const void* at) { ::munmap(const_cast<void*>(at), bytes); });
    const auto* const first = static_cast<const std::byte*>(memory);
    ChildResult result(path, {first, bytes - word}, owner);
    if (std::memcmp(first + bytes - word, done.data(), word) == 0) return result;
    if (std::memcmp(first + bytes - word, failed.data(), word) != 0)
      fail("its import ended without a result: the file is damaged");
    std::string of = result.text(), place = result.text(), problem = result.text();
    throw FileError(of.empty() ? path : std::move(of), std::move(place), std::move(problem));
  }
};

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
