// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <pybind11/embed.h>

namespace pulsecast::support {

/// Python after a statement; the interpreter lives as long as the tests, as NumPy cannot be loaded twice.
[[gnu::visibility("hidden")]] inline pybind11::dict python_names(const std::string& statement) {
  static pybind11::scoped_interpreter* const interpreter = new pybind11::scoped_interpreter;
  (void)interpreter;
  pybind11::dict scope;
  scope["__builtins__"] = pybind11::module_::import("builtins");
  pybind11::exec(statement, scope);
  return scope;
}

}  // namespace pulsecast::support
