// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <thread>
#include <vector>

#include <pulsecast/base/require.hpp>

namespace pulsecast {

inline constexpr unsigned max_threads = 1024;  ///< that a setting may ask for

/// Number of threads to use: as many as asked for, or as the machine runs at once where 0 is asked for.
/// @throws SettingError if more than `max_threads` are asked for
[[nodiscard]] inline unsigned thread_count(unsigned asked) {
  require_within("threads", asked, 0, max_threads, "");
  return asked > 0 ? asked : std::max(1U, std::thread::hardware_concurrency());
}

namespace detail {

/// `for_each_index` of whatever call(task, i) makes of a task: compiled once for all of them.
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
    std::vector<std::jthread> helpers;
    try {
      for (std::size_t k = 1; k < together; ++k) helpers.emplace_back(work);
    } catch (...) {  // no more threads to be had: those there are do it all
    }
    work();
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace detail

/// Calls task(i) once for every i below `count`, the low ones first, on up to so many threads, this one among them; 0 as `thread_count`
/// says. Tasks that touch nothing in common need no lock. What a task throws comes out here, if several do, one of them; those not yet
/// begun are then left out.
template <class Task>
void for_each_index(std::size_t count, unsigned threads, const Task& task) {
  detail::call_for_each_index(
      count, threads, [](const void* t, std::size_t i) { (*static_cast<const Task*>(t))(i); }, &task);
}

}  // namespace pulsecast
