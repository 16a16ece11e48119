// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/base/parallel.hpp>

#include <algorithm>
#include <atomic>
#include <concepts>
#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <doctest/doctest.h>

using namespace pulsecast;

TEST_CASE("zero threads are those of the machine, any other number is itself") {
  CHECK(thread_count(0) == std::max(1U, std::thread::hardware_concurrency()));
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

namespace {

/// Place where each of several threads waits for all.
class Meeting {
 public:
  explicit Meeting(std::size_t all) : all_(all) {}

  void wait() {
    std::unique_lock lock(mutex_);
    ++here_;
    arrived_.notify_all();
    arrived_.wait(lock, [this] { return here_ == all_; });
  }

 private:
  std::size_t all_, here_ = 0;
  std::mutex mutex_;
  std::condition_variable arrived_;
};

}  // namespace

TEST_CASE("as many threads as are asked for work at the same time") {
  Meeting meeting(3);
  std::atomic<int> done = 0;
  for_each_index(3, 3, [&](std::size_t) {
    meeting.wait();
    ++done;
  });
  CHECK(done == 3);
}

TEST_CASE("of several exceptions at the same time one comes out") {
  Meeting meeting(3);
  std::string said;
  try {
    for_each_index(3, 3, [&](std::size_t i) {
      meeting.wait();
      throw std::runtime_error(std::to_string(i));
    });
  } catch (const std::runtime_error& error) {
    said = error.what();
  }
  CHECK((said == "0" || said == "1" || said == "2"));
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

namespace {

/// Executor whose tasks run one after the other, the last one first.
struct Reverse {
  std::vector<std::size_t> counts{};
  unsigned threads() const { return 3; }
  void for_each(std::size_t count, const IndexTask& task) {
    counts.push_back(count);
    while (count-- > 0) task(count);
  }
};

/// Executor that names any number of threads.
struct Boast {
  unsigned number;
  unsigned threads() const { return number; }
  void for_each(std::size_t count, const IndexTask& task) const {
    while (count-- > 0) task(count);
  }
};

struct WithoutThreads {
  void for_each(std::size_t, const IndexTask&) const {}
};
struct WithoutLoop {
  unsigned threads() const { return 3; }
};

}  // namespace

static_assert(Executor<Reverse> && !Executor<WithoutThreads> && !Executor<WithoutLoop>);
static_assert(sizeof(ExecutorRef) == 2 * sizeof(void*) && sizeof(IndexTask) == 2 * sizeof(void*));
static_assert(std::convertible_to<Reverse&, Workers> && std::convertible_to<unsigned, Workers>);
static_assert(!std::convertible_to<Reverse, Workers>);  // a temporary would dangle

TEST_CASE("workers are a number of threads, those of an executor, or some of these") {
  Reverse executor;
  CHECK(Workers().count() == thread_count(0));
  CHECK(Workers(7).count() == 7);
  CHECK(Workers(executor).count() == 3);
  CHECK(Workers(executor, 0).count() == 3);
  CHECK(Workers(executor, 2).count() == 2);
  CHECK(Workers({}, 2).count() == 2);
  const Boast none{0}, many{max_threads + 1};
  CHECK(Workers(none).count() == 1);
  CHECK(Workers(many).count() == max_threads);
  CHECK_FALSE(Workers(7).executor());
  CHECK(Workers(executor).executor());
  CHECK(ExecutorRef().memory() == nullptr);
  CHECK(ExecutorRef(executor).memory() == nullptr);
}

TEST_CASE("an executor gets a task for each thread, at most one for each index, and none for a single index") {
  Reverse executor;
  for (const std::size_t count : {0U, 1U, 2U, 1000U}) {
    std::vector<std::size_t> done;
    for_each_index(count, executor, [&](std::size_t i) { done.push_back(i); });
    REQUIRE(done.size() == count);
    for (std::size_t i = 0; i < count; ++i) CHECK(done[i] == i);
  }
  CHECK(executor.counts == std::vector<std::size_t>{2, 3});
}

TEST_CASE("a task's exception does not pass through the executor, and comes out of the loop") {
  Reverse executor;
  std::size_t done = 0;
  const auto task = [&](std::size_t i) {
    if (i == 10) throw std::runtime_error("ten");
    ++done;
  };
  CHECK_THROWS_WITH_AS(for_each_index(1000, executor, task), "ten", std::runtime_error);
  CHECK(done == 10);
  CHECK(executor.counts.size() == 1);
}
