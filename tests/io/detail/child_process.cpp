// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/detail/child_process.hpp>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <numeric>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include <doctest/doctest.h>
#include <sys/socket.h>
#include <unistd.h>

#include "support/file_errors.hpp"
#include "support/sanitized.hpp"

using namespace pulsecast;
using namespace pulsecast::io::detail;
using support::contains;

namespace {

/// The error of some work in a child.
FileError error_of(const ChildProcess::Work& work, const ChildLimits& limits = {.memory = 2e8, .time = 20}) {
  return support::file_error([&] { (void)ChildProcess::result("some.file", limits, work); });
}

}  // namespace

TEST_CASE("a child hands over numbers, texts and arrays, small and large") {
  std::vector<double> many(300'001);
  std::iota(many.begin(), many.end(), 0.5);
  int here = 1;
  ChildResult result = ChildProcess::result("some.file", {}, [&](ChildOutput& to) {
    here = 2;  // of the child alone
    to.value(std::uint64_t{42});
    to.text("a text");
    to.array(std::span<const double>(many));
    to.text("");
    to.array(std::span<const float>());
    to.value('x');
    to.array(std::span<const double>(many).first(3));
  });
  CHECK(here == 1);
  CHECK(result.value<std::uint64_t>() == 42);
  CHECK(result.text() == "a text");
  const auto array = result.array<double>();
  CHECK(std::vector<double>(array.begin(), array.end()) == many);
  CHECK(result.text().empty());
  CHECK(result.array<float>().empty());
  CHECK(result.value<char>() == 'x');
  CHECK(result.array<double>()[2] == 2.5);
  CHECK(contains(support::file_error([&] { (void)result.value<std::array<char, 99>>(); }).problem(), "inconsistent"));
}

TEST_CASE("an error in a child is the same in its parent") {
  const FileError known = error_of([](ChildOutput& to) {
    to.text("something before");
    throw FileError("other.file", "line 3", "holds nonsense");
  });
  CHECK(known.path() == "other.file");
  CHECK(known.place() == "line 3");
  CHECK(known.problem() == "holds nonsense");
  const FileError other = error_of([](ChildOutput&) { throw std::runtime_error("no idea"); });
  CHECK(other.path() == "some.file");
  CHECK(other.problem() == "no idea");
  CHECK(contains(error_of([](ChildOutput&) { throw 1; }).problem(), "without a reason"));
}

TEST_CASE("a child has no network, and its parent keeps it") {
#if defined(__linux__) && (defined(__x86_64__) || defined(__aarch64__))
  for (const int family : {AF_INET, AF_INET6, AF_UNIX}) {
    ChildResult result = ChildProcess::result("some.file", {}, [&](ChildOutput& to) {
      to.value(::socket(family, SOCK_STREAM, 0));
      to.value(errno);
    });
    CHECK(result.value<int>() == -1);
    CHECK(result.value<int>() == EACCES);
  }
#endif
  const int mine = ::socket(AF_INET, SOCK_STREAM, 0);
  CHECK(mine >= 0);
  ::close(mine);
}

TEST_CASE("the death of a child is explained") {
  CHECK(contains(error_of([](ChildOutput&) { std::raise(SIGKILL); }).problem(),
                 "was killed, as the system does when memory runs out"));
  CHECK(contains(error_of([](ChildOutput&) { std::raise(SIGSEGV); }).problem(), "ended by signal 11"));
  CHECK(contains(error_of([](ChildOutput&) { std::abort(); }).problem(), "ended by signal 6"));
  CHECK(contains(error_of([](ChildOutput& to) {
                   to.text("half of it");
                   ::_exit(0);
                 }).problem(),
                 "ended without a result"));
}

TEST_CASE("a child that hangs is ended") {
  CHECK(contains(error_of([](ChildOutput&) { ::pause(); }, {.time = 0.05}).problem(), "more than 0.05 s"));
  CHECK(contains(error_of(
                     [](ChildOutput&) {
                       for (volatile int i = 0;;) i = i + 1;
                     },
                     {.time = 0.05})
                     .problem(),
                 "more than 0.05 s"));
}

#if !defined(PULSECAST_TEST_SANITIZED)  // whose own memory fails otherwise
TEST_CASE("a child that takes too much memory is ended, unless it is allowed") {
  const auto take = [](std::size_t bytes) {
    return [bytes](ChildOutput& to) {
      std::vector<char> memory(bytes, 'x');
      to.value(memory[bytes / 2]);
    };
  };
  CHECK(contains(error_of(take(400'000'000)).problem(), "more memory than is allowed"));
  CHECK(error_of(take(50'000'000)).problem() == "no error");
  CHECK(error_of([&](ChildOutput& to) {
          ChildOutput::allow(5e8);
          take(400'000'000)(to);
        }).problem() == "no error");
}
#endif

TEST_CASE("what a child prints is not seen, and what its parent has not printed yet is not printed twice") {
  CHECK(error_of([](ChildOutput&) {
          std::puts("a library speaks");
          std::fflush(stdout);
        }).problem() == "no error");
}
