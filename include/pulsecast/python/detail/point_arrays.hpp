// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_PYTHON_DETAIL_POINT_ARRAYS_HPP
#define PULSECAST_PYTHON_DETAIL_POINT_ARRAYS_HPP

#include <pybind11/numpy.h>

#include <pulsecast/io/point_records.hpp>
#include <pulsecast/python/detail/rows.hpp>

namespace PULSECAST_NAMESPACE {
namespace [[gnu::visibility("hidden")]] python {

/// Layout of a row, which ends at a multiple of 8 bytes, as a C++ structure does.
[[nodiscard]] inline io::PointLayout row_layout() {
  io::PointLayout layout = io::PointLayout::packed(io::layouts::columns(io::usual_point_columns));
  layout.size = (layout.size + 7) / 8 * 8;
  return layout;
}

[[nodiscard]] inline pybind11::dtype dtype_of(io::NumberType type) {
  constexpr std::array names{"", "i1", "u1", "i2", "u2", "i4", "u4", "f4", "f8", "i8", "u8"};
  return pybind11::dtype(names[static_cast<std::size_t>(type)]);
}

[[nodiscard]] inline pybind11::dtype dtype_of(const io::PointLayout& layout) {
  pybind11::list names, formats, offsets;
  for (const io::PointField& field : layout.fields) {
    names.append(field.name);
    formats.append(dtype_of(field.type));
    offsets.append(field.offset);
  }
  return {std::move(names), std::move(formats), std::move(offsets), static_cast<pybind11::ssize_t>(layout.size)};
}

/// Points as rows of a structured array.
class PointRows {
 public:
  explicit PointRows(io::PointEncoder encoder) : encoder_(std::move(encoder)), rows_(encoder_.layout().size) {}

  void operator()(const EchoBatch& batch) {
    const std::size_t count = io::count_echoes(batch);
    std::byte* const to = rows_.append(count);
    std::memset(to, 0, count * encoder_.layout().size);
    encoder_.encode(batch, to);
  }

  /// Rows so far; leaves this empty. Requires the GIL.
  [[nodiscard]] pybind11::array take() { return rows_.take(dtype_of(encoder_.layout())); }

 private:
  io::PointEncoder encoder_;
  RawRows rows_;
};

/// Points as columns: numbers of all points, one after another.
class PointColumns {
 public:
  explicit PointColumns(io::PointEncoder encoder) : encoder_(std::move(encoder)) {
    for (const io::PointField& field : encoder_.layout().fields) columns_.emplace_back(io::size_of(field.type));
  }

  void operator()(const EchoBatch& batch) {
    records_.clear();
    encoder_.encode(batch, records_);
    const io::PointLayout& layout = encoder_.layout();
    const std::size_t count = records_.size() / layout.size;
    for (std::size_t k = 0; k < columns_.size(); ++k) {
      const std::size_t size = io::size_of(layout.fields[k].type);
      const std::byte* from = records_.data() + layout.fields[k].offset;
      std::byte* to = columns_[k].append(count);
      for (std::size_t i = 0; i < count; ++i, from += layout.size, to += size) std::memcpy(to, from, size);
    }
  }

  /// Columns so far, by name; leaves this empty. Requires the GIL.
  [[nodiscard]] pybind11::dict take() {
    pybind11::dict all;
    for (std::size_t k = 0; k < columns_.size(); ++k) {
      const io::PointField& field = encoder_.layout().fields[k];
      all[field.name.c_str()] = columns_[k].take(dtype_of(field.type));
    }
    return all;
  }

 private:
  io::PointEncoder encoder_;
  std::vector<std::byte> records_;
  std::vector<RawRows> columns_;
};

}  // namespace gnu::visibility("hidden")]]python
}  // namespace PULSECAST_NAMESPACE

#endif
