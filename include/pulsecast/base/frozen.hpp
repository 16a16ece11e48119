// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

namespace pulsecast {

/// An array that is done: no element changes any more. It stands in memory of its own, or is a stretch of a file that is mapped into
/// memory. Copies share it.
template <class T>
requires std::is_trivially_copyable_v<T>
class Frozen {
 public:
  using value_type = T;

  Frozen() = default;

  /// Takes over what a build has made.
  Frozen(std::vector<T> made) {  // NOLINT(google-explicit-constructor): a vector that is done is one
    made.shrink_to_fit();
    auto owner = std::make_shared<const std::vector<T>>(std::move(made));
    elements_ = *owner;
    owner_ = std::move(owner);
  }

  /// Elements that live as long as their owner does.
  Frozen(std::span<const T> elements, std::shared_ptr<const void> owner) : elements_(elements), owner_(std::move(owner)) {}

  [[nodiscard]] const T& operator[](std::size_t i) const noexcept { return elements_[i]; }
  [[nodiscard]] const T* data() const noexcept { return elements_.data(); }
  [[nodiscard]] std::size_t size() const noexcept { return elements_.size(); }
  [[nodiscard]] bool empty() const noexcept { return elements_.empty(); }
  [[nodiscard]] auto begin() const noexcept { return elements_.begin(); }
  [[nodiscard]] auto end() const noexcept { return elements_.end(); }

  /// [byte]
  [[nodiscard]] std::size_t memory() const noexcept { return elements_.size_bytes(); }

 private:
  std::span<const T> elements_;
  std::shared_ptr<const void> owner_;
};

/// Says that an object is made empty, to be filled by `archive` from what was kept of one that was built.
struct Unfilled {
  explicit Unfilled() = default;
};

}  // namespace pulsecast
