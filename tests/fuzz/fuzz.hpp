// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <ios>
#include <string>

#include <pulsecast/base/error.hpp>

#include "support/temporary_folder.hpp"

/// What libFuzzer calls with an input that it has made up.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

/// Programs that try a reader on files that nobody would write. Only a `FileError` may come of it.
namespace pulsecast::fuzz {

/// The input as a file of its name.
inline std::filesystem::path file(const std::uint8_t* data, std::size_t size, const char* name) {
  static const support::TemporaryFolder folder;
  std::filesystem::path path = folder / name;
  std::filesystem::remove(path);  // to write anew is quick; to cut off what stands there may wait for the disk
  std::ofstream(path, std::ios::binary).write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  return path;
}

/// Lets a reader refuse the file; any other error ends the program.
template <class Read>
void may_refuse(Read read) {
  try {
    read();
  } catch (const FileError&) {
  }
}

/// What must hold of what was read; ends the program if it does not.
inline void expect(bool condition) {
  if (!condition) __builtin_trap();
}

}  // namespace pulsecast::fuzz
