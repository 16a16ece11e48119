// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_PYTHON_DETAIL_ROWS_HPP
#define PULSECAST_PYTHON_DETAIL_ROWS_HPP

#include <pybind11/numpy.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>

#include <pulsecast/base/namespace.hpp>

namespace PULSECAST_NAMESPACE {
namespace [[gnu::visibility("hidden")]] python {

/// Bytes of rows that become a NumPy array in place. Growth avoids copies as far as the C library
/// can: a large array never takes twice its memory.
class RawRows {
 public:
  explicit RawRows(std::size_t row_size) noexcept : row_size_(row_size) {}

  [[nodiscard]] std::size_t size() const noexcept { return size_; }

  /// Room for `count` further rows, in sequence.
  [[nodiscard]] std::byte* append(std::size_t count) {
    if (size_ + count > capacity_) resize(std::max({std::size_t{1024}, 2 * capacity_, size_ + count}));
    return rows_.get() + row_size_ * std::exchange(size_, size_ + count);
  }

  /// Array of this type that owns the rows; leaves this empty.
  [[nodiscard]] pybind11::array take(const pybind11::dtype& type) {
    resize(std::max<std::size_t>(1, size_));
    std::byte* const rows = rows_.get();
    const pybind11::capsule owner(rows, [](void* p) { std::free(p); });
    (void)rows_.release();
    capacity_ = 0;
    return {type, {static_cast<pybind11::ssize_t>(std::exchange(size_, 0))}, {}, rows, owner};
  }

 private:
  struct Free {
    void operator()(std::byte* rows) const noexcept { std::free(rows); }
  };

  void resize(std::size_t capacity) {
    auto* const moved = static_cast<std::byte*>(std::realloc(rows_.get(), capacity * row_size_));
    if (!moved) throw std::bad_alloc();
    (void)rows_.release();
    rows_.reset(moved);
    capacity_ = capacity;
  }

  std::unique_ptr<std::byte, Free> rows_;
  std::size_t row_size_, size_ = 0, capacity_ = 0;
};

/// As above, of one type.
template <class Row>
requires std::is_trivially_copyable_v<Row>
class Rows {
 public:
  [[nodiscard]] std::size_t size() const noexcept { return rows_.size(); }
  void push_back(const Row& row) { std::memcpy(rows_.append(1), &row, sizeof row); }
  [[nodiscard]] pybind11::array_t<Row> take() { return rows_.take(pybind11::dtype::of<Row>()); }

 private:
  RawRows rows_{sizeof(Row)};
};

}  // namespace gnu::visibility("hidden")]]python
}  // namespace PULSECAST_NAMESPACE

#endif
