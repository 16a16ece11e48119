// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace pulsecast {

namespace detail {

/// Asks the system for pages of 2 MiB, where it has them, under memory that nothing has been written to: rays go anywhere, and looking
/// up where a small page is takes longer than reading what is there.
inline void advise_huge_pages([[maybe_unused]] void* memory, [[maybe_unused]] std::size_t size) noexcept {
#if defined(__linux__)
  constexpr std::size_t small = 4096, large = std::size_t{1} << 21;
  const std::size_t skipped = (small - reinterpret_cast<std::uintptr_t>(memory) % small) % small;
  if (size >= 2 * large) ::madvise(static_cast<std::byte*>(memory) + skipped, size - skipped, MADV_HUGEPAGE);
#endif
}

/// Memory of its own, so many bytes that nothing has been written to. Not a template, as compilers work hard on those for every type.
[[nodiscard]] inline std::shared_ptr<void> allocate_shared(std::size_t size, std::align_val_t alignment) {
  std::shared_ptr<void> memory(::operator new(size, alignment), [=](void* bytes) { ::operator delete(bytes, alignment); });
  advise_huge_pages(memory.get(), size);
  return memory;
}

}  // namespace detail

/// An array in the making: as made, its elements hold anything. Several threads may write to it, each where no other does. Copies share it.
template <class T>
requires std::is_trivially_copyable_v<T>
class SharedBuffer {
 public:
  SharedBuffer() = default;
  explicit SharedBuffer(std::size_t size)
      : memory_(detail::allocate_shared(size * sizeof(T), std::align_val_t{alignof(T)})),
        elements_(static_cast<T*>(memory_.get())),
        size_(size) {}

  [[nodiscard]] T& operator[](std::size_t i) const noexcept { return elements_[i]; }
  [[nodiscard]] T* data() const noexcept { return elements_; }
  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  [[nodiscard]] bool empty() const noexcept { return size_ == 0; }
  [[nodiscard]] T* begin() const noexcept { return elements_; }
  [[nodiscard]] T* end() const noexcept { return elements_ + size_; }
  [[nodiscard]] const std::shared_ptr<void>& memory() const noexcept { return memory_; }

 private:
  std::shared_ptr<void> memory_;
  T* elements_ = nullptr;
  std::size_t size_ = 0;
};

/// An array that is done: no element changes any more. It stands in memory of its own, or is a stretch of a file that is mapped into
/// memory. Copies share it.
template <class T>
requires std::is_trivially_copyable_v<T>
class SharedArray {
 public:
  using value_type = T;

  SharedArray() = default;

  /// Takes over what a build has made, and gives back what memory it had to spare.
  SharedArray(std::vector<T> made) {  // NOLINT(google-explicit-constructor): a vector that is done is one
    size_ = made.size();
    if (size_ == made.capacity()) {
      elements_ = made.data();
      owner_ = std::shared_ptr<const void>(new std::vector<T>(std::move(made)));
    } else {
      const SharedBuffer<T> copy(size_);
      std::copy(made.begin(), made.end(), copy.data());
      elements_ = copy.data(), owner_ = copy.memory();
    }
  }
  SharedArray(const SharedBuffer<T>& made)  // NOLINT(google-explicit-constructor): so is a buffer
      : elements_(made.data()), size_(made.size()), owner_(made.memory()) {}

  /// Elements that live as long as their owner does.
  SharedArray(std::span<const T> elements, std::shared_ptr<const void> owner)
      : elements_(elements.data()), size_(elements.size()), owner_(std::move(owner)) {}

  [[nodiscard]] const T& operator[](std::size_t i) const noexcept { return elements_[i]; }
  [[nodiscard]] const T* data() const noexcept { return elements_; }
  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  [[nodiscard]] bool empty() const noexcept { return size_ == 0; }
  [[nodiscard]] const T* begin() const noexcept { return elements_; }
  [[nodiscard]] const T* end() const noexcept { return elements_ + size_; }

  /// [byte]
  [[nodiscard]] std::size_t memory() const noexcept { return size_ * sizeof(T); }

 private:
  const T* elements_ = nullptr;
  std::size_t size_ = 0;
  std::shared_ptr<const void> owner_;
};

/// Says that an object is made empty, to be filled by `archive` from what was kept of one that was built.
struct DeserializeTag {
  explicit DeserializeTag() = default;
};

}  // namespace pulsecast
