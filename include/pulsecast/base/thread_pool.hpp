// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_BASE_THREAD_POOL_HPP
#define PULSECAST_BASE_THREAD_POOL_HPP

#include <condition_variable>
#include <vector>

#if __has_include(<unistd.h>)
#include <unistd.h>
#endif

#include <pulsecast/base/parallel.hpp>
#include <pulsecast/base/scratch_memory.hpp>

namespace PULSECAST_NAMESPACE {

/// Threads that are kept from call to call, with the memory of runs: the library's executor. The
/// caller of `for_each` works, too, and waits for its own tasks only, so calls may be nested, and
/// threads share a pool. It must outlive its calls. In a child of `fork`, callers work alone.
class ThreadPool {
 public:
  /// Starts `threads` - 1 threads, as the caller is one; 0 as in `thread_count`. Throws a
  /// `SettingError`, or a `std::system_error` if the machine has no more threads.
  explicit ThreadPool(unsigned threads = 0) : state_(std::make_unique<State>()) {
    const unsigned count = thread_count(threads);
    helpers_.reserve(count - 1);
    try {
      for (unsigned k = 1; k < count; ++k) helpers_.emplace_back([state = state_.get()] { state->help(); });
    } catch (...) {
      end();
      throw;
    }
  }
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;
  ~ThreadPool() { end(); }

  /// Number of threads, the caller's included.
  [[nodiscard]] unsigned threads() const noexcept { return static_cast<unsigned>(helpers_.size()) + 1; }

  /// Calls task(i) once for each i below `count`, low ones first. Allocates nothing.
  void for_each(std::size_t count, const IndexTask& task) {
    Job job(count, task);
    if (count > 1 && !helpers_.empty() && !forked())
      state_->share(job);
    else
      job.work();
    job.rethrow();
  }

  /// Memory that runs leave for the next run over a survey of the same type. `memory().clear()`
  /// releases it, as is due before a shared library is unloaded whose surveys ran here.
  [[nodiscard]] ScratchMemory& memory() noexcept { return memory_; }

 private:
  struct Job : detail::IndexLoop {
    using IndexLoop::IndexLoop;
    std::size_t helpers = 0;  ///< threads at work beside the caller's
    Job* next = nullptr;
  };

  struct State {
    std::mutex mutex;
    std::condition_variable offered, left;
    Job* jobs = nullptr;  ///< linked list, on the stacks of the callers
    bool ending = false;

    void help() noexcept {
      std::unique_lock lock(mutex);
      for (;;) {
        Job* job = nullptr;
        offered.wait(lock, [&] { return ending || (job = unfinished()); });
        if (!job) return;
        ++job->helpers;
        lock.unlock();
        job->work();
        lock.lock();
        if (--job->helpers == 0) left.notify_all();
      }
    }

    /// Runs a job on the caller and on the threads that are idle.
    void share(Job& job) {
      std::unique_lock lock(mutex);
      job.next = jobs;
      jobs = &job;
      lock.unlock();
      offered.notify_all();
      job.work();
      lock.lock();
      Job** place = &jobs;
      while (*place != &job) place = &(*place)->next;
      *place = job.next;
      left.wait(lock, [&] { return job.helpers == 0; });
    }

    [[nodiscard]] Job* unfinished() const noexcept {
      Job* job = jobs;
      while (job && job->exhausted()) job = job->next;
      return job;
    }
  };

  [[nodiscard]] static long process() noexcept {
#if __has_include(<unistd.h>)
    return getpid();
#else
    return 0;
#endif
  }
  [[nodiscard]] bool forked() const noexcept { return process() != process_; }

  void end() noexcept {
    if (forked()) {  // the threads do not exist here, and what they waited for cannot be destroyed
      for (std::thread& helper : helpers_) helper.detach();
      static_cast<void>(state_.release());
      return;
    }
    {
      const std::lock_guard lock(state_->mutex);
      state_->ending = true;
    }
    state_->offered.notify_all();
    for (std::thread& helper : helpers_) helper.join();
  }

  long process_ = process();
  std::unique_ptr<State> state_;
  std::vector<std::thread> helpers_;
  ScratchMemory memory_;
};

}  // namespace PULSECAST_NAMESPACE

#endif
