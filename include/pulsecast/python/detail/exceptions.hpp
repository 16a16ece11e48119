// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_PYTHON_DETAIL_EXCEPTIONS_HPP
#define PULSECAST_PYTHON_DETAIL_EXCEPTIONS_HPP

#include <pybind11/pybind11.h>

#include <exception>

#include <pulsecast/base/error.hpp>

namespace PULSECAST_NAMESPACE {
namespace [[gnu::visibility("hidden")]] python {

/// Exception class shared by all modules, created at first use.
[[nodiscard]] inline pybind11::handle shared_exception(const char* name, PyObject* base, const char* doc) {
  const std::string key = std::string("pulsecast.") + name;
  if (void* const known = pybind11::get_shared_data(key)) return static_cast<PyObject*>(known);
  PyObject* const made = PyErr_NewExceptionWithDoc(key.c_str(), doc, base, nullptr);
  if (!made) throw pybind11::error_already_set();
  pybind11::set_shared_data(key, made);
  return made;
}

template <class... Values>
void raise(pybind11::handle type, const std::string& message, std::pair<const char*, Values>... attributes) {
  const pybind11::object exception = type(message);
  ((exception.attr(attributes.first) = attributes.second), ...);
  PyErr_SetObject(type.ptr(), exception.ptr());
}

/// Exception classes of the library in Python.
struct Exceptions {
  pybind11::handle setting = shared_exception(
      "SettingError", PyExc_ValueError, "Setting outside its allowed range. Attributes: field, value, unit, allowed.");
  pybind11::handle file = shared_exception("FileError", PyExc_OSError,
                                           "Missing, malformed or unwritable file. Attributes: path, place, problem.");
  pybind11::handle interrupted =
      shared_exception("Interrupted", PyExc_KeyboardInterrupt,
                       "Ctrl-C during a run. Attribute: result, the Batch up to then, which is complete.");
};

/// Adds the exception classes to a module, which translates those of C++ into them.
inline void bind_exceptions(pybind11::module_& m) {
  const Exceptions exceptions;
  m.attr("SettingError") = exceptions.setting;
  m.attr("FileError") = exceptions.file;
  m.attr("Interrupted") = exceptions.interrupted;
  pybind11::register_local_exception_translator([](std::exception_ptr raised) {
    const Exceptions types;
    try {
      if (raised) std::rethrow_exception(raised);
    } catch (const SettingError& e) {
      raise(types.setting, e.what(), std::pair{"field", e.field()}, std::pair{"value", e.value()},
            std::pair{"unit", e.unit()}, std::pair{"allowed", e.allowed()});
    } catch (const FileError& e) {
      raise(types.file, e.what(), std::pair{"path", e.path()}, std::pair{"place", e.place()},
            std::pair{"problem", e.problem()});
    }
  });
}

}  // namespace gnu::visibility("hidden")]]python
}  // namespace PULSECAST_NAMESPACE

#endif
