// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_PYTHON_DETAIL_ROWS_HPP
#define PULSECAST_PYTHON_DETAIL_ROWS_HPP

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>

#include <pulsecast/base/namespace.hpp>

// hidden, as pybind11's own names, so that modules of different builds can coexist
namespace PULSECAST_NAMESPACE {
namespace [[gnu::visibility("hidden")]] python {

/// Rows that become a NumPy array in place. Growth avoids copies as far as the C library can: a large array never takes
/// twice its memory.
template <class Row>
requires std::is_trivially_copyable_v<Row>
class Rows {
 public:
  [[nodiscard]] std::size_t size() const noexcept { return size_; }

  void push_back(const Row& row) {
    if (size_ == capacity_) resize(std::max<std::size_t>(1024, 2 * capacity_));
    rows_.get()[size_++] = row;
  }

  /// Array that owns the rows; leaves this empty.
  [[nodiscard]] pybind11::array_t<Row> take() {
    resize(std::max<std::size_t>(1, size_));
    Row* const rows = rows_.get();
    const pybind11::capsule owner(rows, [](void* p) { std::free(p); });
    (void)rows_.release();
    capacity_ = 0;
    return pybind11::array_t<Row>(static_cast<pybind11::ssize_t>(std::exchange(size_, 0)), rows, owner);
  }

 private:
  struct Free {
    void operator()(Row* rows) const noexcept { std::free(rows); }
  };

  void resize(std::size_t capacity) {
    auto* const moved = static_cast<Row*>(std::realloc(rows_.get(), capacity * sizeof(Row)));
    if (!moved) throw std::bad_alloc();
    (void)rows_.release();
    rows_.reset(moved);
    capacity_ = capacity;
  }

  std::unique_ptr<Row, Free> rows_;
  std::size_t size_ = 0, capacity_ = 0;
};

}  // namespace gnu::visibility("hidden")]]python
}  // namespace PULSECAST_NAMESPACE

#endif
