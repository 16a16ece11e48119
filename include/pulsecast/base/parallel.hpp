// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_BASE_PARALLEL_HPP
#define PULSECAST_BASE_PARALLEL_HPP

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <memory>
#include <thread>

#include <pulsecast/base/require.hpp>

namespace pulsecast {

inline constexpr unsigned max_threads = 1024;  ///< upper limit of a setting for threads

/// Number of threads to use: `asked`, or the hardware concurrency if 0. Throws a `SettingError` above `max_threads`.
[[nodiscard]] inline unsigned thread_count(unsigned asked) {
  require_within("threads", asked, 0, max_threads, "");
  return asked > 0 ? asked : std::max(1U, std::thread::hardware_concurrency());
}

namespace detail {

/// Type-erased `for_each_index`, compiled once for all tasks; call(task, i) runs one index.
inline void call_for_each_index(std::size_t count, unsigned threads, void (*call)(const void*, std::size_t), const void* task) {
  std::atomic<std::size_t> next = 0;
  std::atomic<bool> failed = false;
  std::exception_ptr failure;
  const auto work = [&]() noexcept {
    for (std::size_t i = next++; i < count; i = next++) try {
        call(task, i);
      } catch (...) {
        next = count;
        if (!failed.exchange(true)) failure = std::current_exception();
      }
  };
  const std::size_t together = std::min<std::size_t>(thread_count(threads), count);
  {
    std::unique_ptr<std::jthread[]> helpers;
    try {
      helpers = std::make_unique<std::jthread[]>(together);  // of which the first is this one
      for (std::size_t k = 1; k < together; ++k) helpers[k] = std::jthread(work);
    } catch (...) {  // no more threads available: the existing ones do all the work
    }
    work();
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace detail

/// Calls task(i) once for each i below `count`, low ones first, on up to `threads` threads with the caller's; 0 as in `thread_count`.
/// Tasks that share no data need no lock. Rethrows the exception of a task, or one of several; indices not yet begun are then skipped.
template <class Task>
void for_each_index(std::size_t count, unsigned threads, const Task& task) {
  detail::call_for_each_index(
      count, threads, [](const void* t, std::size_t i) { (*static_cast<const Task*>(t))(i); }, &task);
}

}  // namespace pulsecast

#endif
