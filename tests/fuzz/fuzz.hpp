// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <ios>
#include <map>
#include <string>

#include <pulsecast/base/error.hpp>

#include "support/temporary_folder.hpp"

/// Programs that try a reader on files that nobody would write. Only a `FileError` may come of it.
namespace pulsecast::fuzz {

/// Tries one input.
using Target = void (*)(const std::uint8_t* data, std::size_t size);

/// The targets of this program, by name.
inline std::map<std::string, Target>& targets() {
  static std::map<std::string, Target> all;
  return all;
}

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

/// Begins the definition of a target, as `FUZZ_TARGET(las) { ... }`, whose parameters are `data` and `size`.
#define FUZZ_TARGET(name)                                             \
  static void try_##name(const std::uint8_t* data, std::size_t size); \
  [[maybe_unused]] static const bool name##_is_target =               \
      ::pulsecast::fuzz::targets().emplace(#name, try_##name).second; \
  static void try_##name(const std::uint8_t* data, std::size_t size)
