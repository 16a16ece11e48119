// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/detail/child_process.hpp>

#include <array>
#include <cerrno>
#include <concepts>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

#include <doctest/doctest.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include "support/file_errors.hpp"
#include "support/sanitized.hpp"

using namespace pulsecast;
using namespace pulsecast::io::detail;
using support::contains;

namespace {

/// The error of some work in a child.
FileError error_of(const std::function<void()>& work, const ChildLimits& limits = {.memory = 2e8, .time = 20}) {
  return support::file_error([&] {
    (void)ChildProcess::result("some.file", limits, [&] {
      work();
      return 0;
    });
  });
}

/// What a child hands over.
struct Luggage {
  int number = 0;
  std::string text{}, other{};
  SharedArray<double> many{}, few{};
  bool may_travel = true;

  template <class Archive>
  void archive(Archive& a) {
    a(number, text, many, other, few, may_travel);
  }
  [[nodiscard]] bool is_consistent() const { return may_travel; }
};

/// A result in the middle of which the child ends.
struct Fragment {
  SharedArray<double> many{};

  template <class Archive>
  void archive(Archive& a) {
    a(many);
    if constexpr (std::same_as<Archive, io::ArchiveWriter>) ::_exit(0);
  }
};

}  // namespace

TEST_CASE("a child hands over numbers, texts and arrays, small and large") {
  std::vector<double> many(300'001);
  std::iota(many.begin(), many.end(), 0.5);
  int here = 1;
  const auto luggage = ChildProcess::result("some.file", {}, [&] {
    here = 2;  // of the child alone
    return Luggage{42, "a text", "", many, std::vector<double>(many.begin(), many.begin() + 3)};
  });
  CHECK(here == 1);
  CHECK(luggage.number == 42);
  CHECK(luggage.text == "a text");
  CHECK(std::vector<double>(luggage.many.begin(), luggage.many.end()) == many);
  CHECK(luggage.other.empty());
  CHECK(luggage.few.size() == 3);
  CHECK(luggage.few[2] == 2.5);
}

TEST_CASE("a result that is not consistent is an error") {
  const FileError error = support::file_error(
      [] { (void)ChildProcess::result("some.file", {}, [] { return Luggage{.may_travel = false}; }); });
  CHECK(error.path() == "some.file");
  CHECK(contains(error.problem(), "gave an inconsistent result"));
}

TEST_CASE("an error in a child is the same in its parent") {
  const FileError known = error_of([] { throw FileError("other.file", "line 3", "holds nonsense"); });
  CHECK(known.path() == "other.file");
  CHECK(known.place() == "line 3");
  CHECK(known.problem() == "holds nonsense");
  const FileError other = error_of([] { throw std::runtime_error("no idea"); });
  CHECK(other.path() == "some.file");
  CHECK(other.problem() == "no idea");
  CHECK(contains(error_of([] { throw 1; }).problem(), "without a reason"));
}

TEST_CASE("a child has no network, and its parent keeps it") {
#if defined(__linux__) && (defined(__x86_64__) || defined(__aarch64__))
  const bool has_filters = ::prctl(PR_GET_SECCOMP) >= 0;  // not in an emulator
  for (const int family : has_filters ? std::vector{AF_INET, AF_INET6, AF_UNIX} : std::vector<int>{}) {
    const auto socket_and_error = ChildProcess::result("some.file", {}, [&] {
      const int made = ::socket(family, SOCK_STREAM, 0);
      return std::array{made, errno};
    });
    CHECK(socket_and_error[0] == -1);
    CHECK(socket_and_error[1] == EACCES);
  }
#endif
  const int mine = ::socket(AF_INET, SOCK_STREAM, 0);
  CHECK(mine >= 0);
  ::close(mine);
}

TEST_CASE("the death of a child is explained") {
  CHECK(
      contains(error_of([] { std::raise(SIGKILL); }).problem(), "was killed, as the system does when memory runs out"));
  CHECK(contains(error_of([] { std::raise(SIGSEGV); }).problem(), "ended by signal 11"));
  CHECK(contains(error_of([] { std::abort(); }).problem(), "ended by signal 6"));
  CHECK(contains(error_of([] { ::_exit(0); }).problem(), "ended without a result"));
  const auto half = [] { return Fragment{std::vector<double>(300'001)}; };
  CHECK(contains(support::file_error([&] { (void)ChildProcess::result("some.file", {}, half); }).problem(),
                 "ended without a result"));
}

TEST_CASE("a child that hangs is ended") {
  CHECK(contains(error_of([] { ::pause(); }, {.time = 0.05}).problem(), "more than 0.05 s"));
  CHECK(contains(error_of(
                     [] {
                       for (volatile int i = 0;;) i = i + 1;
                     },
                     {.time = 0.05})
                     .problem(),
                 "more than 0.05 s"));
}

TEST_CASE("a program that takes no request is an error, and one that hangs is ended") {
  const auto error_by = [](const char* program, double time = 20) {
    return support::file_error(
        [&] { (void)ChildProcess::result_of<int>(program, "some.file", {.time = time}, std::string("a request")); });
  };
  for (const char* program : {"/bin/true", "/bin/false", "/nowhere/program", "/"}) {
    const FileError error = error_by(program);
    CHECK(error.path() == "some.file");
    CHECK(contains(error.problem(), std::string("as ") + program + " does not start"));
  }
  CHECK(contains(error_by("/bin/sleep", 0.05).problem(), "more than 0.05 s"));  // for as long as the file's number
}

TEST_CASE("a file without a request is not served") {
  bool served = false;
  std::FILE* const file = std::tmpfile();
  REQUIRE(file != nullptr);
  for (const char* content : {"", "short", "no request, though it ends as one: pc asks."}) {
    std::fputs(content, file);
    std::fflush(file);
    ChildProcess::serve<std::string>(::fileno(file), [&](const std::string&) { return served = true; });
  }
  ChildProcess::serve<std::string>(-1, [&](const std::string&) { return served = true; });
  CHECK_FALSE(served);
  std::fclose(file);
}

#if !defined(PULSECAST_TEST_SANITIZED)  // whose own memory fails otherwise
TEST_CASE("a child that takes too much memory is ended, unless it is allowed") {
  const auto take = [](std::size_t bytes) {
    return [bytes] {
      const std::vector<char> memory(bytes, 'x');
      [[maybe_unused]] const volatile char used = memory[bytes / 2];
    };
  };
  CHECK(contains(error_of(take(400'000'000)).problem(), "more memory than is allowed"));
  CHECK(error_of(take(50'000'000)).problem() == "no error");
  CHECK(error_of([&] {
          ChildProcess::allow(5e8);
          take(400'000'000)();
        }).problem() == "no error");
}
#endif

TEST_CASE("what a child prints is not seen, and what its parent has not printed yet is not printed twice") {
  CHECK(error_of([] {
          std::puts("a library speaks");
          std::fflush(stdout);
        }).problem() == "no error");
}
