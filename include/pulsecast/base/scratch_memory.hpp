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

/// Objects that calls leave for later calls, by type. Thread-safe. An object of type T returns
/// whether it `fits(need)`, and if not, whether it is `outdated(need)`: no later call can use it.
class ScratchMemory {
 public:
  /// Removes an object of type T that fits; null if none does. Deletes outdated ones on its way.
  template <class T, class Need>
  [[nodiscard]] std::unique_ptr<T> take(const Need& need) noexcept {
    const std::lock_guard lock(mutex_);
    for (std::unique_ptr<ScratchItem>* place = &items_; *place;) {
      const T* const item = as<T>(**place);
      if (item && item->fits(need)) return std::unique_ptr<T>(static_cast<T*>(remove(*place).release()));
      if (item && item->outdated(need))
        remove(*place).reset();
      else
        place = &(*place)->next_;
    }
    return nullptr;
  }

  /// Makes objects of type T from `need`, until `count` of those that are kept fit.
  template <class T, class Need>
  void provide(std::size_t count, const Need& need) {
    std::size_t kept = 0;
    {
      const std::lock_guard lock(mutex_);
      for (const ScratchItem* item = items_.get(); item; item = item->next_.get())
        if (const T* const it = as<T>(*item)) kept += it->fits(need) ? 1 : 0;
    }
    for (; kept < count; ++kept) give_back(std::make_unique<T>(need));
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
  static constexpr char key = 0;  // whose address identifies the type

  /// An object as one of type T; null if it is of another.
  template <class T>
  [[nodiscard]] static const T* as(const ScratchItem& item) noexcept {
    return item.type_ == &key<T> ? static_cast<const T*>(&item) : nullptr;
  }

  [[nodiscard]] static std::unique_ptr<ScratchItem> remove(std::unique_ptr<ScratchItem>& place) noexcept {
    std::unique_ptr<ScratchItem> item = std::move(place);
    place = std::move(item->next_);
    return item;
  }

  std::mutex mutex_;
  std::unique_ptr<ScratchItem> items_;  // linked list
};

/// Object of type T for the duration of a call: taken from `memory` if one fits, or else new, and
/// given back to `memory` unless that is null.
template <class T>
class Borrowed {
 public:
  /// Takes an object that fits, or makes one from `need`.
  Borrowed(ScratchMemory* memory, const auto& need) : memory_(memory), item_(memory ? memory->take<T>(need) : nullptr) {
    if (!item_) item_ = std::make_unique<T>(need);
  }
  Borrowed(const Borrowed&) = delete;
  Borrowed& operator=(const Borrowed&) = delete;
  ~Borrowed() {
    if (memory_) memory_->give_back(std::move(item_));
  }

  [[nodiscard]] T& operator*() const noexcept { return *item_; }        ///< the object
  [[nodiscard]] T* operator->() const noexcept { return item_.get(); }  ///< its member

 private:
  ScratchMemory* memory_;
  std::unique_ptr<T> item_;
};

}  // namespace PULSECAST_NAMESPACE

#endif
