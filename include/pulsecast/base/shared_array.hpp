// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_BASE_SHARED_ARRAY_HPP
#define PULSECAST_BASE_SHARED_ARRAY_HPP

#include <algorithm>
#include <memory>
#include <new>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#if defined(__linux__)
#include <sys/mman.h>

#include <pulsecast/base/namespace.hpp>
#endif

namespace PULSECAST_NAMESPACE {

namespace detail {

/// Requests 2 MiB pages, where the system has them, for memory not yet written to: with small
/// pages, reads at random spend more time in address translation.
inline void advise_huge_pages([[maybe_unused]] void* memory, [[maybe_unused]] std::size_t size) noexcept {
#if defined(__linux__)
  constexpr std::size_t small = 4096, large = std::size_t{1} << 21;
  const std::size_t skipped = (small - reinterpret_cast<std::uintptr_t>(memory) % small) % small;
  if (size >= 2 * large) ::madvise(static_cast<std::byte*>(memory) + skipped, size - skipped, MADV_HUGEPAGE);
#endif
}

/// Allocates uninitialized memory [byte]. No template, as each instance would cost compile time.
[[nodiscard]] inline std::shared_ptr<void> allocate_shared(std::size_t size, std::align_val_t alignment) {
  std::shared_ptr<void> memory(::operator new(size, alignment),
                               [=](void* bytes) { ::operator delete(bytes, alignment); });
  advise_huge_pages(memory.get(), size);
  return memory;
}

}  // namespace detail

/// Array under construction, uninitialized. Threads may write to different elements. Copies share.
template <class T>
requires std::is_trivially_copyable_v<T>
class SharedBuffer {
 public:
  SharedBuffer() = default;
  /// Allocates memory for `size` elements. Errors: std::bad_alloc.
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
  /// Owner of the memory.
  [[nodiscard]] const std::shared_ptr<void>& memory() const noexcept { return memory_; }

 private:
  std::shared_ptr<void> memory_;
  T* elements_ = nullptr;
  std::size_t size_ = 0;
};

/// Immutable array in memory of its own or in a memory-mapped file. Copies share it.
template <class T>
requires std::is_trivially_copyable_v<T>
class SharedArray {
 public:
  /// Type of an element.
  using value_type = T;

  SharedArray() = default;

  /// Takes over the elements of a vector and releases its spare capacity.
  SharedArray(std::vector<T> made) {  // NOLINT(google-explicit-constructor): a finished vector is one
    size_ = made.size();
    if (size_ == made.capacity()) {
      elements_ = made.data();
      owner_ = std::shared_ptr<const void>(new std::vector<T>(std::move(made)));
    } else {
      const SharedBuffer<T> copy(size_);
      std::copy(made.begin(), made.end(), copy.data());
      elements_ = copy.data();
      owner_ = copy.memory();
    }
  }
  /// Shares the memory of a finished buffer.
  SharedArray(const SharedBuffer<T>& made)  // NOLINT(google-explicit-constructor): a buffer, too
      : elements_(made.data()), size_(made.size()), owner_(made.memory()) {}

  /// Shares elements that live as long as `owner`.
  SharedArray(std::span<const T> elements, std::shared_ptr<const void> owner)
      : elements_(elements.data()), size_(elements.size()), owner_(std::move(owner)) {}

  [[nodiscard]] const T& operator[](std::size_t i) const noexcept { return elements_[i]; }
  [[nodiscard]] const T* data() const noexcept { return elements_; }
  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  [[nodiscard]] bool empty() const noexcept { return size_ == 0; }
  [[nodiscard]] const T* begin() const noexcept { return elements_; }
  [[nodiscard]] const T* end() const noexcept { return elements_ + size_; }

  /// Size of the elements [byte].
  [[nodiscard]] std::size_t memory() const noexcept { return size_ * sizeof(T); }

 private:
  const T* elements_ = nullptr;
  std::size_t size_ = 0;
  std::shared_ptr<const void> owner_;
};

/// Constructor tag: makes an empty object that `archive` fills from its serialized form.
struct DeserializeTag {
  explicit DeserializeTag() = default;
};

}  // namespace PULSECAST_NAMESPACE

#endif
