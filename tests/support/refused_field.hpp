// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <pulsecast/base/error.hpp>

namespace pulsecast::support {

/// Name of the setting that a call refuses; empty if it refuses none.
template <class Call>
[[nodiscard]] std::string refused_field(const Call& call) {
  try {
    call();
  } catch (const SettingError& e) {
    return e.field();
  }
  return "";
}

}  // namespace pulsecast::support
