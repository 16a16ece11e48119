// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_BASE_SCRATCH_MEMORY_HPP
#define PULSECAST_BASE_SCRATCH_MEMORY_HPP

#include <memory>
#include <mutex>
#include <utility>

#include <pulsecast/base/namespace.hpp>

namespace PULSECAST_NAMESPACE {

/// Base of objects that a `ScratchMemory` keeps.
class ScratchItem {
 public:
  ScratchItem() = default;
  ScratchItem(const ScratchItem&) = delete;
  ScratchItem& operator=(const ScratchItem&) = delete;
  virtual ~ScratchItem() = default;

 private:
  friend class ScratchMemory;
  const void* type_ = nullptr;
  std::unique_ptr<ScratchItem> next_{};
};

/// Objects that calls leave for later calls, by their type. Several threads may use it at once.
class ScratchMemory {
 public:
  /// Removes an object of type T; null if there is none.
  template <class T>
  [[nodiscard]] std::unique_ptr<T> take() noexcept {
    return std::unique_ptr<T>(static_cast<T*>(remove(&key<T>).release()));
  }

  /// Keeps an object, without allocating.
  template <class T>
  void give_back(std::unique_ptr<T> item) noexcept {
    item->type_ = &key<T>;
    const std::lock_guard lock(mutex_);
    item->next_ = std::move(items_);
    items_ = std::move(item);
  }

  /// Deletes all objects. Due before code that left objects is unloaded.
  void clear() noexcept {
    std::unique_ptr<ScratchItem> items;
    const std::lock_guard lock(mutex_);
    items.swap(items_);
  }

 private:
  template <class T>
  static constexpr char key = 0;  // whose address tells types apart

  [[nodiscard]] std::unique_ptr<ScratchItem> remove(const void* type) noexcept {
    const std::lock_guard lock(mutex_);
    std::unique_ptr<ScratchItem>* place = &items_;
    while (*place && (*place)->type_ != type) place = &(*place)->next_;
    std::unique_ptr<ScratchItem> item = std::move(*place);
    if (item) *place = std::move(item->next_);
    return item;
  }

  std::mutex mutex_;
  std::unique_ptr<ScratchItem> items_;  // linked list
};

/// Object of type T for the duration of a call: taken from `memory` if it fits, or else new, and given back to `memory` unless that is
/// null.
template <class T>
class Borrowed {
 public:
  /// Takes an object for which `fits(need)` is true, or makes one from `need`. Deletes one that does not fit.
  template <class Need>
  Borrowed(ScratchMemory* memory, const Need& need) : memory_(memory), item_(memory ? memory->take<T>() : nullptr) {
    if (!item_ || !item_->fits(need)) item_ = std::make_unique<T>(need);
  }
  Borrowed(const Borrowed&) = delete;
  Borrowed& operator=(const Borrowed&) = delete;
  ~Borrowed() {
    if (memory_) memory_->give_back(std::move(item_));
  }

  /// The object.
  [[nodiscard]] T& operator*() const noexcept { return *item_; }
  /// Member of the object.
  [[nodiscard]] T* operator->() const noexcept { return item_.get(); }

 private:
  ScratchMemory* memory_;
  std::unique_ptr<T> item_;
};

}  // namespace PULSECAST_NAMESPACE

#endif
