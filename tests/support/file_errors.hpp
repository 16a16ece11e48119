// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <pulsecast/base/error.hpp>

namespace pulsecast::support {

/// The `FileError` that comes of an action; one that says "no error" if none does.
template <class Action>
[[nodiscard]] FileError file_error(Action action) {
  try {
    action();
  } catch (const FileError& error) {
    return error;
  }
  return {"", "", "no error"};
}

[[nodiscard]] inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace pulsecast::support
