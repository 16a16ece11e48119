// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Threads and memory that a run takes: threads started (calls of pthread_create) and allocations (calls of operator
// new), of runs over one pulse and over many with `threads = 64`. Fails if a run over one pulse starts a thread, or a
// later run on a pool starts one or allocates.

#include <dlfcn.h>
#include <pthread.h>

#include <atomic>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <new>

#include <pulsecast/base/thread_pool.hpp>
#include <pulsecast/pulsecast.hpp>

#include "surveys.hpp"

namespace {

std::atomic<std::size_t> threads_started = 0, allocations = 0;

}  // namespace

// never inlined, else g++ sees `free` meet the memory of `new`
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++allocations;
  if (void* const memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

/// Stands before that of the C library.
extern "C" int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*start)(void*),
                              void* argument) {
  using Create = int (*)(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*);
  static const auto create = reinterpret_cast<Create>(dlsym(RTLD_NEXT, "pthread_create"));
  ++threads_started;
  return create(thread, attributes, start, argument);
}

namespace {

using namespace bench;

struct Taken {
  std::size_t threads, allocations;
};

/// Prints what some work takes, and returns it.
template <class Work>
Taken taken(const char* name, const Work& work) {
  const std::size_t threads = threads_started, before = allocations;
  work();
  const Taken all{threads_started - threads, allocations - before};
  std::printf("%-44s %3zu threads started, %5zu allocations\n", name, all.threads, all.allocations);
  return all;
}

}  // namespace

int main() {
  const auto town = street::scene(1);
  const Survey survey{car(100'000), RingFootprint{3}, town, Receiver{}, FullWaveform{}};
  const auto work = [&](PulseIndex pulses, ExecutorRef executor) {
    return [&survey, pulses, executor] { run(survey, {.threads = 64, .executor = executor, .end = pulses}); };
  };
  const Taken alone = taken("one pulse, no pool", work(1, {}));
  const bool counted = taken("100,000 pulses, no pool", work(100'000, {})).threads > 0;
  ThreadPool pool(64);
  taken("one pulse, a pool of 64, first run", work(1, pool));
  const Taken second = taken("one pulse, a pool of 64, second run", work(1, pool));
  const Taken third = taken("one pulse, a pool of 64, third run", work(1, pool));
  const bool kept =
      counted && alone.threads + second.threads + second.allocations + third.threads + third.allocations == 0;
  if (!kept) std::fputs("a run takes what it must not, or nothing is counted\n", stderr);
  return kept ? 0 : 1;
}
