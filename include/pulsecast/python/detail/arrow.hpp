// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_PYTHON_DETAIL_ARROW_HPP
#define PULSECAST_PYTHON_DETAIL_ARROW_HPP

#include <pybind11/numpy.h>

#include <cerrno>
#include <memory>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include <pulsecast/base/namespace.hpp>

// Structures under the guards that all users share. Source: Apache Arrow, The Arrow C Data
// Interface, Structure definitions; The Arrow C Stream Interface, Structure definition.
extern "C" {

#ifndef ARROW_C_DATA_INTERFACE
#define ARROW_C_DATA_INTERFACE

#define ARROW_FLAG_DICTIONARY_ORDERED 1
#define ARROW_FLAG_NULLABLE 2
#define ARROW_FLAG_MAP_KEYS_SORTED 4

struct ArrowSchema {
  const char* format;
  const char* name;
  const char* metadata;
  int64_t flags;
  int64_t n_children;
  struct ArrowSchema** children;
  struct ArrowSchema* dictionary;
  void (*release)(struct ArrowSchema*);
  void* private_data;
};

struct ArrowArray {
  int64_t length;
  int64_t null_count;
  int64_t offset;
  int64_t n_buffers;
  int64_t n_children;
  const void** buffers;
  struct ArrowArray** children;
  struct ArrowArray* dictionary;
  void (*release)(struct ArrowArray*);
  void* private_data;
};

#endif

#ifndef ARROW_C_STREAM_INTERFACE
#define ARROW_C_STREAM_INTERFACE

struct ArrowArrayStream {
  int (*get_schema)(struct ArrowArrayStream*, struct ArrowSchema* out);
  int (*get_next)(struct ArrowArrayStream*, struct ArrowArray* out);
  const char* (*get_last_error)(struct ArrowArrayStream*);
  void (*release)(struct ArrowArrayStream*);
  void* private_data;
};

#endif
}

namespace PULSECAST_NAMESPACE {
namespace [[gnu::visibility("hidden")]] python {

/// Columns of a table that Arrow takes: names, formats, and NumPy arrays, whose memory is shared.
class ArrowTable {
 public:
  /// @throws ValueError for an array of another length, type or layout than Arrow takes
  explicit ArrowTable(const pybind11::dict& columns) {
    for (const auto& [name, column] : columns) {
      auto array = column.cast<pybind11::array>();
      const auto text = name.cast<std::string>();
      if (columns_.empty()) rows_ = array.size();
      if (array.ndim() != 1 || array.size() != rows_ || (rows_ > 1 && array.strides(0) != array.itemsize()))
        throw pybind11::value_error("column '" + text + "': expected " + std::to_string(rows_) +
                                    " numbers one after another");
      columns_.push_back({text, format_of(text, array.dtype()), std::move(array)});
    }
  }

  /// Describes the table as a structure with a member a column. No number is null.
  void describe(ArrowSchema& out) const {
    auto held = std::make_unique<Schemas>();
    held->children.resize(columns_.size());
    for (std::size_t k = 0; k < columns_.size(); ++k) {
      auto texts = std::make_unique<Texts>(columns_[k].format, columns_[k].name);
      const auto& [format, name] = *texts;
      held->children[k] = {format.c_str(), name.c_str(), nullptr, 0, 0, nullptr, nullptr, &release_column, texts.get()};
      (void)texts.release();
      held->pointers.push_back(&held->children[k]);
    }
    const auto count = static_cast<std::int64_t>(columns_.size());
    out = {"+s", "", nullptr, 0, count, held->pointers.data(), nullptr, &release_table<ArrowSchema>, held.get()};
    (void)held.release();
  }

  /// Hands on the columns, each of which holds its array. Requires the GIL.
  void hand_on(ArrowArray& out) const {
    auto held = std::make_unique<Arrays>();
    held->children.resize(columns_.size());
    for (std::size_t k = 0; k < columns_.size(); ++k) {
      auto column = std::make_unique<Buffers>(Buffers{{nullptr, columns_[k].array.data()}, nullptr});
      column->owner = columns_[k].array.inc_ref().ptr();
      held->children[k] = {rows_, 0, 0, 2, 0, column->all, nullptr, nullptr, &release_column, column.get()};
      (void)column.release();
      held->pointers.push_back(&held->children[k]);
    }
    const auto count = static_cast<std::int64_t>(columns_.size());
    out = {rows_,     0, 0, 1, count, &held->validity, held->pointers.data(), nullptr, &release_table<ArrowArray>,
           held.get()};
    (void)held.release();
  }

 private:
  struct Column {
    std::string name, format;
    pybind11::array array;
  };

  using Texts = std::pair<std::string, std::string>;

  /// Buffers of a column, and the array that they are the memory of.
  struct Buffers {
    const void* all[2];  ///< validity: none, as no number is null; numbers
    PyObject* owner;
  };

  /// Columns of a table, which are released with it unless a consumer has moved them away.
  template <class Structure>
  struct Children {
    std::vector<Structure> children;
    std::vector<Structure*> pointers;
    const void* validity = nullptr;

    Children() = default;
    Children(const Children&) = delete;
    Children& operator=(const Children&) = delete;
    ~Children() {
      for (Structure& child : children)
        if (child.release) child.release(&child);
    }
  };
  using Schemas = Children<ArrowSchema>;
  using Arrays = Children<ArrowArray>;

  template <class Structure>
  static void release_table(Structure* table) noexcept {
    delete static_cast<Children<Structure>*>(table->private_data);
    table->release = nullptr;
  }
  static void release_column(ArrowSchema* schema) noexcept {
    delete static_cast<Texts*>(schema->private_data);
    schema->release = nullptr;
  }
  /// May be called by any thread.
  static void release_column(ArrowArray* array) noexcept {
    auto* const held = static_cast<Buffers*>(array->private_data);
    if (Py_IsInitialized() != 0) {  // else the memory has ended with Python
      const pybind11::gil_scoped_acquire gil;
      Py_DECREF(held->owner);
    }
    delete held;
    array->release = nullptr;
  }

  /// Format of a number type. Source: The Arrow C Data Interface, Data type description.
  [[nodiscard]] static std::string format_of(const std::string& name, const pybind11::dtype& type) {
    const std::string numpy = type.byteorder() == '>' ? "" : type.kind() + std::to_string(type.itemsize());
    constexpr std::string_view formats = "i1c u1C i2s u2S i4i u4I i8l u8L f4f f8g";
    for (std::size_t at = 0; at < formats.size(); at += 4)
      if (numpy == formats.substr(at, 2)) return std::string(formats.substr(at + 2, 1));
    throw pybind11::value_error("column '" + name + "': expected numbers of this machine, not " +
                                std::string(pybind11::repr(type)));
  }

  std::vector<Column> columns_;
  std::int64_t rows_ = 0;
};

/// Stream of a table, as one batch. Its functions may be called by any thread, one at a time.
class ArrowStream {
 public:
  /// Capsule of a stream, as `__arrow_c_stream__` returns it. @throws ValueError as `ArrowTable`
  /// Source: Apache Arrow, The Arrow PyCapsule Interface.
  [[nodiscard]] static pybind11::object capsule(const pybind11::dict& columns) {
    auto held = std::make_unique<ArrowStream>(ArrowTable(columns));
    auto stream = std::make_unique<ArrowArrayStream>(
        ArrowArrayStream{&get_schema, &get_next, &get_last_error, &release, held.get()});
    PyObject* const made = PyCapsule_New(stream.get(), name, [](PyObject* of_stream) {
      auto* const unused = static_cast<ArrowArrayStream*>(PyCapsule_GetPointer(of_stream, name));
      if (unused->release) unused->release(unused);
      delete unused;
    });
    if (!made) throw pybind11::error_already_set();
    (void)held.release();
    (void)stream.release();
    return pybind11::reinterpret_steal<pybind11::object>(made);
  }

  explicit ArrowStream(ArrowTable table) : table_(std::move(table)) {}

 private:
  static constexpr const char* name = "arrow_array_stream";

  [[nodiscard]] static ArrowStream& of(ArrowArrayStream* stream) noexcept {
    return *static_cast<ArrowStream*>(stream->private_data);
  }

  /// Calls `fill`; 0, or an error number that `get_last_error` explains.
  template <class Fill>
  [[nodiscard]] int filled(const Fill& fill) noexcept {
    error_ = nullptr;
    try {
      const pybind11::gil_scoped_acquire gil;
      fill();
      return 0;
    } catch (const std::bad_alloc&) {
      error_ = "out of memory";
      return ENOMEM;
    }
  }

  static int get_schema(ArrowArrayStream* stream, ArrowSchema* out) noexcept {
    return of(stream).filled([&] { of(stream).table_.describe(*out); });
  }
  static int get_next(ArrowArrayStream* stream, ArrowArray* out) noexcept {
    if (of(stream).done_) {
      *out = {};  // a released array is the end
      return 0;
    }
    const int error = of(stream).filled([&] { of(stream).table_.hand_on(*out); });
    of(stream).done_ = error == 0;
    return error;
  }
  static const char* get_last_error(ArrowArrayStream* stream) noexcept { return of(stream).error_; }
  static void release(ArrowArrayStream* stream) noexcept {
    if (Py_IsInitialized() != 0) {  // else the memory has ended with Python
      const pybind11::gil_scoped_acquire gil;
      delete &of(stream);
    }
    stream->release = nullptr;
  }

  ArrowTable table_;
  bool done_ = false;
  const char* error_ = nullptr;
};

}  // namespace gnu::visibility("hidden")]]python
}  // namespace PULSECAST_NAMESPACE

#endif
