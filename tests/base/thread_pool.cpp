// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/base/thread_pool.hpp>

#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <memory>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

#include <doctest/doctest.h>

using namespace pulsecast;

TEST_CASE("a pool has as many threads as it is asked for, the caller's included") {
  CHECK(ThreadPool(1).threads() == 1);
  CHECK(ThreadPool(5).threads() == 5);
  CHECK(ThreadPool().threads() == thread_count(0));
  CHECK_THROWS_AS(ThreadPool(max_threads + 1), SettingError);
}

TEST_CASE("a pool does every index once, in call after call") {
  for (const unsigned threads : {1U, 2U, 7U}) {
    ThreadPool pool(threads);
    for (const std::size_t count : {0U, 1U, 2U, 1000U}) {
      CAPTURE(threads);
      CAPTURE(count);
      std::vector<std::atomic<int>> done(count);
      pool.for_each(count, [&](std::size_t i) { ++done[i]; });
      for_each_index(count, pool, [&](std::size_t i) { ++done[i]; });
      for (const std::atomic<int>& times : done) CHECK(times == 2);
    }
  }
}

TEST_CASE("the threads of a pool work at the same time, and are the same in each call") {
  ThreadPool pool(3);
  std::set<std::thread::id> ids;
  for (int call = 0; call < 3; ++call) {
    std::mutex mutex;
    std::condition_variable arrived;
    std::size_t here = 0;
    pool.for_each(3, [&](std::size_t) {  // each task waits for all
      std::unique_lock lock(mutex);
      ids.insert(std::this_thread::get_id());
      ++here;
      arrived.notify_all();
      arrived.wait(lock, [&] { return here == 3; });
    });
  }
  CHECK(ids.size() == 3);
  CHECK(ids.count(std::this_thread::get_id()) == 1);
}

TEST_CASE("calls of a pool may be nested, and come from several threads") {
  ThreadPool pool(3);
  std::atomic<int> done = 0;
  {
    std::vector<std::jthread> callers;
    for (int k = 0; k < 3; ++k)
      callers.emplace_back([&] {
        pool.for_each(10,
                      [&](std::size_t) { pool.for_each(10, [&](std::size_t) { for_each_index(5, pool, [&](std::size_t) { ++done; }); }); });
      });
  }
  CHECK(done == 3 * 10 * 10 * 5);
}

TEST_CASE("what a task throws comes out of a pool, which goes on") {
  ThreadPool pool(4);
  const auto task = [](std::size_t i) {
    if (i == 10) throw std::runtime_error("ten");
  };
  for (int call = 0; call < 3; ++call) {
    CHECK_THROWS_WITH_AS(pool.for_each(100'000, task), "ten", std::runtime_error);
    CHECK_THROWS_WITH_AS(for_each_index(100'000, pool, task), "ten", std::runtime_error);
    std::atomic<int> done = 0;
    pool.for_each(100, [&](std::size_t) { ++done; });
    CHECK(done == 100);
  }
}

TEST_CASE("a process that is forked off works with a copy of the pool, and destroys it") {
  auto pool = std::make_unique<ThreadPool>(4);
  std::atomic<int> done = 0;
  pool->for_each(100, [&](std::size_t) { ++done; });
  const pid_t child = fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    alarm(60);  // ends a child that hangs
    pool->for_each(100, [&](std::size_t) { ++done; });
    pool.reset();
    _exit(done == 200 ? 0 : 1);
  }
  int status = -1;
  REQUIRE(waitpid(child, &status, 0) == child);
  CHECK(WIFEXITED(status));
  CHECK(WEXITSTATUS(status) == 0);
  pool->for_each(100, [&](std::size_t) { ++done; });
  CHECK(done == 200);
}
