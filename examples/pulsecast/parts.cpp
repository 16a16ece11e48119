// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

#include "parts.hpp"

#include <dlfcn.h>

#include <stdexcept>

#include <pulsecast/version.hpp>

/// Table of a part, by the function that each has. The loader looks for it in the folder of objects of this program.
const void* loaded_part(const char* name) {
  void* const object = dlopen(name, RTLD_NOW | RTLD_LOCAL);  // stays until the end
  using Table = const void*(const char* version);
  auto* const table = object == nullptr ? nullptr : reinterpret_cast<Table*>(dlsym(object, "pulsecast_part"));
  const void* const found = table == nullptr ? nullptr : table(PULSECAST_VERSION);
  if (found == nullptr)
    throw std::runtime_error(std::string("a part of this program cannot be loaded, ") + name +
                             ": expected that of the same build" +
                             (object == nullptr ? std::string("; ") + dlerror() : ""));
  return found;
}
