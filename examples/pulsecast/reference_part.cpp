// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

#include <string_view>

#include <pulsecast/io/reference.hpp>
#include <pulsecast/version.hpp>

#include "parts.hpp"

extern "C" [[gnu::visibility("default")]] const void* pulsecast_part(const char* version) {
  static constexpr ReferencePart functions{&pulsecast::io::complete_reference, &pulsecast::io::map_projector};
  return std::string_view(version) == PULSECAST_VERSION ? &functions : nullptr;
}
