// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_BASE_PARALLEL_HPP
#define PULSECAST_BASE_PARALLEL_HPP

#include <algorithm>
#include <atomic>
#include <exception>
#include <memory>
#include <thread>

#include <pulsecast/base/require.hpp>

namespace PULSECAST_NAMESPACE {

inline constexpr unsigned max_threads = 1024;  ///< upper limit of a setting for threads

/// Threads to use: `asked`, or the machine's if 0. Throws a `SettingError` above `max_threads`.
[[nodiscard]] inline unsigned thread_count(unsigned asked) {
  require_within("threads", asked, 0, max_threads, "");
  return asked > 0 ? asked : std::max(1U, std::thread::hardware_concurrency());
}

/// Reference to a function of an index. Refers to the function, which must outlive it.
class IndexTask {
 public:
  /// Refers to a function.
  template <class Task>
  requires(!std::same_as<Task, IndexTask> && requires(const Task& task, std::size_t i) { task(i); })
      IndexTask(const Task& task)
  noexcept : task_(&task), call_([](const void* t, std::size_t i) { (*static_cast<const Task*>(t))(i); }) {}

  void operator()(std::size_t i) const { call_(task_, i); }

 private:
  const void* task_;
  void (*call_)(const void*, std::size_t);
};

/// Threads of the user's: `ThreadPool`, or an adaptor to a task scheduler. `threads()`: number of
/// threads that a call may use, with the caller's. `for_each(count, task)` calls task(i) once for
/// each i below `count`, on any threads. Law: it returns after all calls, and while it waits runs
/// no task of another call (oneTBB: `this_task_arena::isolate`). Threads may share an executor. Not
/// required: tasks at the same time; an order; exceptions, as the library's tasks throw none.
template <class E>
concept Executor = requires(E& e, std::size_t count, const IndexTask& task) {
  { e.threads() } -> std::convertible_to<unsigned>;
  e.for_each(count, task);
};

class ScratchMemory;

/// Executor that keeps memory from one call to the next: a second run then allocates nothing.
template <class E>
concept MemoryKeepingExecutor = Executor<E> && requires(E& e) {
  { e.memory() } -> std::same_as<ScratchMemory&>;
};

/// Reference to an executor, or none. The executor must outlive it; temporaries are refused.
class ExecutorRef {
 public:
  ExecutorRef() = default;
  /// Refers to an executor.
  template <Executor E>
  requires(!std::same_as<std::remove_const_t<E>, ExecutorRef>) ExecutorRef(E& executor)
  noexcept : executor_(const_cast<std::remove_const_t<E>*>(&executor)), functions_(&functions<E>) {}

  /// Names the mistake in the argument.
  template <class E>
  requires(!std::same_as<std::remove_cvref_t<E>, ExecutorRef>) ExecutorRef(E&&)
  noexcept {
    // clang-format off
    static_assert(requires(E e) { { e.threads() } -> std::convertible_to<unsigned>; },
                  "Executor: 'threads' is missing or has another form; it must be: unsigned threads()");
    static_assert(requires(E e, const IndexTask& task) { e.for_each(std::size_t{}, task); },
                  "Executor: 'for_each' is missing or has another form; it must be: "
                  "void for_each(std::size_t, const IndexTask&)");
    // clang-format on
    static_assert(std::is_lvalue_reference_v<E>, "Executor: a temporary; name it, as it must outlive the run");
  }

  /// False without an executor; the other functions then must not be called.
  explicit operator bool() const noexcept { return executor_ != nullptr; }
  /// Threads that a call may use, the caller's included.
  [[nodiscard]] unsigned threads() const { return functions_->threads(executor_); }
  /// Calls task(i) once for each i below `count`.
  void for_each(std::size_t count, const IndexTask& task) const { functions_->for_each(executor_, count, task); }
  /// Memory kept between calls; null if the executor keeps none.
  [[nodiscard]] ScratchMemory* memory() const { return executor_ ? functions_->memory(executor_) : nullptr; }

 private:
  struct Functions {
    unsigned (*threads)(void*);
    void (*for_each)(void*, std::size_t, const IndexTask&);
    ScratchMemory* (*memory)(void*);
  };
  template <class E>
  static constexpr Functions functions{
      [](void* e) { return static_cast<unsigned>(static_cast<E*>(e)->threads()); },
      [](void* e, std::size_t count, const IndexTask& task) { static_cast<E*>(e)->for_each(count, task); },
      [](void* e) -> ScratchMemory* {
        if constexpr (MemoryKeepingExecutor<E>)
          return &static_cast<E*>(e)->memory();
        else
          return nullptr;
      }};

  void* executor_ = nullptr;
  const Functions* functions_ = nullptr;
};

/// Threads for a call: a number of them, which live for the call, or an executor.
class Workers {
 public:
  /// Up to `threads` threads with the caller's; 0 as in `thread_count`.
  Workers(unsigned threads = 0) noexcept : threads_(threads) {}
  /// The threads of an executor.
  template <class E>
  requires Executor<E> Workers(E& executor)
  noexcept : executor_(executor) {}
  /// Up to `threads` threads of an executor, 0 for all of them; without an executor as above.
  Workers(ExecutorRef executor, unsigned threads) noexcept : executor_(executor), threads_(threads) {}

  /// Number of threads. Throws a `SettingError` above `max_threads`.
  [[nodiscard]] unsigned count() const {
    if (threads_ == 0 && executor_) return std::clamp(executor_.threads(), 1U, max_threads);
    return thread_count(threads_);
  }
  /// Executor, if one was given.
  [[nodiscard]] const ExecutorRef& executor() const noexcept { return executor_; }

 private:
  ExecutorRef executor_{};
  unsigned threads_ = 0;
};

namespace detail {

/// Indices below `count`, handed out to all threads that call `work`, low ones first.
class IndexLoop {
 public:
  IndexLoop(std::size_t count, const IndexTask& task) noexcept : task_(task), count_(count) {}

  /// Runs indices until none is left. After an exception none is.
  void work() noexcept {
    for (std::size_t i = next_++; i < count_; i = next_++) try {
        task_(i);
      } catch (...) {
        next_ = count_;
        if (!failed_.exchange(true)) failure_ = std::current_exception();
      }
  }
  [[nodiscard]] bool exhausted() const noexcept { return next_ >= count_; }
  /// Rethrows the first exception of a task, if any. Due when all calls of `work` have returned.
  void rethrow() const {
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  IndexTask task_;
  std::size_t count_;
  std::atomic<std::size_t> next_ = 0;
  std::atomic<bool> failed_ = false;
  std::exception_ptr failure_;
};

/// Runs a loop on `threads` threads with the caller's; the others live for this call.
inline void work_on_threads(IndexLoop& loop, std::size_t threads) {
  std::unique_ptr<std::jthread[]> helpers;
  try {
    helpers = std::make_unique<std::jthread[]>(threads - 1);
    for (std::size_t k = 0; k + 1 < threads; ++k) helpers[k] = std::jthread(&IndexLoop::work, &loop);
  } catch (...) {  // no more threads available: the existing ones do all the work
  }
  loop.work();
}

}  // namespace detail

/// Calls task(i) once for each i below `count`, low ones first, on as many threads as `workers`
/// says. Rethrows the exception of a task, or one of several; the indices left are skipped.
inline void for_each_index(std::size_t count, const Workers& workers, const IndexTask& task) {
  detail::IndexLoop loop(count, task);
  const std::size_t threads = std::min<std::size_t>(workers.count(), count);
  if (threads <= 1)
    loop.work();
  else if (workers.executor())
    workers.executor().for_each(threads, [&loop](std::size_t) { loop.work(); });
  else
    detail::work_on_threads(loop, threads);
  loop.rethrow();
}

}  // namespace PULSECAST_NAMESPACE

#endif
