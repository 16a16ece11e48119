// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/base/parallel.hpp>

#include <atomic>
#include <cstddef>
#include <stdexcept>
#include <vector>

#include <doctest/doctest.h>

using namespace pulsecast;

TEST_CASE("zero threads are those of the machine, any other number is itself") {
  CHECK(thread_count(0) >= 1);
  CHECK(thread_count(1) == 1);
  CHECK(thread_count(17) == 17);
  CHECK(thread_count(max_threads) == max_threads);
}

TEST_CASE("more threads than a machine can have are refused before any is started") {
  for (const unsigned threads : {max_threads + 1, 1'000'000U, ~0U}) {
    bool began = false;
    CHECK_THROWS_AS(static_cast<void>(thread_count(threads)), SettingError);
    CHECK_THROWS_AS(for_each_index(2, threads, [&](std::size_t) { began = true; }), SettingError);
    CHECK_FALSE(began);
  }
}

TEST_CASE("every index is done once, on any number of threads") {
  for (const unsigned threads : {0U, 1U, 2U, 7U})
    for (const std::size_t count : {0U, 1U, 2U, 1000U}) {
      CAPTURE(threads);
      CAPTURE(count);
      std::vector<std::atomic<int>> done(count);
      for_each_index(count, threads, [&](std::size_t i) { ++done[i]; });
      for (const std::atomic<int>& times : done) CHECK(times == 1);
    }
}

TEST_CASE("what a task throws comes out, and what has not begun is left out") {
  for (const unsigned threads : {1U, 2U, 7U}) {
    CAPTURE(threads);
    std::atomic<std::size_t> done = 0;
    const auto task = [&](std::size_t i) {
      if (i == 10) throw std::runtime_error("ten");
      ++done;
    };
    CHECK_THROWS_WITH_AS(for_each_index(1'000'000, threads, task), "ten", std::runtime_error);
    CHECK(done < 1'000'000 - 1);
    CHECK(done >= (threads == 1 ? 10 : 0));
  }
}
