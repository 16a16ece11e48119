// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Lets libFuzzer try the only target of the program.
#include <cstddef>
#include <cstdint>

#include "fuzz/fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const pulsecast::fuzz::Target target = pulsecast::fuzz::targets().begin()->second;
  target(data, size);
  return 0;
}
