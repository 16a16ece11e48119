// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include "support/allocations.hpp"

#include <cstdlib>
#include <new>

std::atomic<std::size_t> pulsecast::support::allocations = 0, pulsecast::support::allocations_left = 0;

namespace {

void count() {
  ++pulsecast::support::allocations;
  if (pulsecast::support::allocations_left > 0 && --pulsecast::support::allocations_left == 0) throw std::bad_alloc();
}

}  // namespace

// never inlined, else g++ sees `free` meet the memory of `new`; weak, as sanitizers have their own, under which nothing
// is counted
[[gnu::noinline, gnu::weak]] void* operator new(std::size_t size) {
  count();
  if (void* const memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline, gnu::weak]] void* operator new(std::size_t size, std::align_val_t alignment) {
  count();
  const auto step = static_cast<std::size_t>(alignment);
  if (void* const memory = std::aligned_alloc(step, (size + step - 1) / step * step)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline, gnu::weak]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline, gnu::weak]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
[[gnu::noinline, gnu::weak]] void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
[[gnu::noinline, gnu::weak]] void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}
