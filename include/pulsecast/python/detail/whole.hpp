// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_PYTHON_DETAIL_WHOLE_HPP
#define PULSECAST_PYTHON_DETAIL_WHOLE_HPP

#include <pybind11/pybind11.h>

#include <algorithm>

#include <pulsecast/base/error.hpp>

namespace PULSECAST_NAMESPACE {
namespace [[gnu::visibility("hidden")]] python {

/// Name of an argument in messages.
template <std::size_t size>
struct ArgumentName {
  char text[size]{};
  consteval ArgumentName(const char (&name)[size]) { std::copy_n(name, size, text); }  // NOLINT: is a text
};

/// Whole number as an argument of a bound function. One out of range is a `SettingError` that names it, and another
/// type a `TypeError`, where pybind11's own would list the signature of the function.
template <ArgumentName argument, class T = std::uint64_t>
struct Whole {
  T value = 0;
  operator T() const noexcept { return value; }  // NOLINT: is a number
};

}  // namespace gnu::visibility("hidden")]]python
}  // namespace PULSECAST_NAMESPACE

namespace pybind11::detail {

template <pulsecast::python::ArgumentName argument, class T>
struct [[gnu::visibility("hidden")]] type_caster<pulsecast::python::Whole<argument, T>> {
  using Number = pulsecast::python::Whole<argument, T>;
  PYBIND11_TYPE_CASTER(Number, const_name("int"));

  /// @throws TypeError for all but whole numbers
  bool load(handle from, bool /*convert*/) {
    const auto number = reinterpret_steal<object>(PyIndex_Check(from.ptr()) ? PyNumber_Index(from.ptr()) : nullptr);
    PyErr_Clear();
    if (!number)
      throw type_error(std::string(argument.text) + ": expected a whole number, not " + std::string(repr(from)));
    using Limits = std::numeric_limits<T>;
    if (number < int_(Limits::min()) || number > int_(Limits::max())) {
      const double rounded = PyLong_AsDouble(number.ptr());
      const bool huge = PyErr_Occurred() != nullptr;
      PyErr_Clear();
      throw pulsecast::SettingError(
          argument.text, huge ? std::numeric_limits<double>::infinity() : rounded, "",
          "a whole number from " + std::to_string(Limits::min()) + " to " + std::to_string(Limits::max()));
    }
    value.value = number.cast<T>();
    return true;
  }
};

}  // namespace pybind11::detail

#endif
