// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Tries a fuzz target on every file of a folder, and on every beginning of the shorter ones, with any compiler.
// Usage: fuzz_NAME FOLDER; fails if there is no file.
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <string>

#include "fuzz/fuzz.hpp"

int main(int count, char** arguments) {
  if (count != 2) return 2;
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(arguments[1])) {
    const std::string bytes = pulsecast::support::content(entry.path());
    std::printf("%s\n", entry.path().filename().c_str());
    std::fflush(stdout);  // so that the one that ends the program is known
    const auto* data = reinterpret_cast<const std::uint8_t*>(bytes.data());
    LLVMFuzzerTestOneInput(data, bytes.size());
    for (std::size_t size = 0; size < bytes.size() && bytes.size() <= 512; ++size) LLVMFuzzerTestOneInput(data, size);
    ++files;
  }
  std::printf("%zu files\n", files);
  return files == 0 ? 1 : 0;
}
