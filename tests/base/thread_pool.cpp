// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/base/thread_pool.hpp>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <fstream>
#include <latch>
#include <memory>
#include <mutex>
#include <set>
#include <stdexcept>
#include <system_error>
#include <thread>
#include <vector>

#include <doctest/doctest.h>

#include "support/sanitized.hpp"

using namespace pulsecast;

static_assert(MemoryKeepingExecutor<ThreadPool>);

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
        pool.for_each(10, [&](std::size_t) {
          pool.for_each(10, [&](std::size_t) { for_each_index(5, pool, [&](std::size_t) { ++done; }); });
        });
      });
  }
  CHECK(done == 3 * 10 * 10 * 5);
}

TEST_CASE("a thread of the pool takes up an older call while all of a newer one is begun") {
  ThreadPool pool(2);  // one thread beside the callers'
  std::latch both_in_first(2), second_begun(1), third_begun(1), first_over(1), second_over(1);
  const std::jthread first([&] {
    pool.for_each(2, [&](std::size_t) {
      both_in_first.arrive_and_wait();
      first_over.wait();
    });
  });
  both_in_first.wait();
  const std::jthread second([&] {
    pool.for_each(2, [&](std::size_t i) {
      if (i == 1) return second_over.count_down();
      second_begun.count_down();
      second_over.wait();
    });
  });
  second_begun.wait();
  const std::jthread third([&] {
    pool.for_each(2, [&](std::size_t i) {
      if (i == 0) return;
      third_begun.count_down();
      second_over.wait();
    });
  });
  third_begun.wait();
  first_over.count_down();
  second_over.wait();
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

TEST_CASE("a pool lends its memory to runs") {
  ThreadPool pool(2);
  CHECK(ExecutorRef(pool).memory() == &pool.memory());
}

namespace {

/// Forks; true if the child's work says so. A child that hangs ends after a minute.
template <class Work>
bool forked_off(const Work& work) {
  const pid_t child = fork();
  if (child < 0) return false;
  if (child == 0) {
    alarm(60);
    _exit(work() ? 0 : 1);
  }
  int status = -1;
  return waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

}  // namespace

TEST_CASE("a process that is forked off works with a copy of the pool, and destroys it") {
  auto pool = std::make_unique<ThreadPool>(4);
  std::atomic<int> done = 0;
  pool->for_each(100, [&](std::size_t) { ++done; });
  for (int k = 0; k < 20; ++k) {  // threads that have begun to wait, too
    const bool worked = forked_off([&] {
      pool->for_each(100, [&](std::size_t) { ++done; });
      pool.reset();
      return done == 200;
    });
    REQUIRE(worked);
  }
  pool->for_each(100, [&](std::size_t) { ++done; });
  CHECK(done == 200);
}

TEST_CASE("a process may be forked off while the pool works") {
  ThreadPool pool(4);
  std::atomic<bool> over = false;
  const std::jthread busy([&] {
    while (!over) pool.for_each(4, [](std::size_t) {});
  });
  bool worked = true;
  for (int k = 0; k < 100 && worked; ++k)  // in some of the children the pool is locked for ever
    worked = forked_off([&] {
      std::atomic<int> done = 0;
      pool.for_each(100, [&](std::size_t) { ++done; });
      return done == 100;
    });
  over = true;
  CHECK(worked);
}

#if !defined(PULSECAST_TEST_SANITIZED)
TEST_CASE("without memory for all threads no pool is made, and a loop does with those that there are") {
  const auto without_memory = [] {
    std::size_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    const rlim_t most = pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE)) + (rlim_t{64} << 20);
    const rlimit limit{most, most};
    return pages > 0 && setrlimit(RLIMIT_AS, &limit) == 0;
  };
  CHECK(forked_off([&] {
    std::atomic<int> done = 0;
    if (without_memory()) for_each_index(1000, max_threads, [&](std::size_t) { ++done; });
    return done == 1000;
  }));
  CHECK(forked_off([&] {
    bool made = true;
    if (without_memory()) try {
        const ThreadPool pool(max_threads);
      } catch (const std::system_error&) {
        made = false;
      }
    return !made;
  }));
}
#endif
