// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Tries a fuzz target on every file of a folder, on every beginning of the shorter ones, and on spoilt copies of each,
// with any compiler. Usage: fuzz_replay TARGET FOLDER; fails if there is no file.
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <string>

#include "fuzz/fuzz.hpp"
#include "support/spoilt_text.hpp"

namespace {

constexpr const char* words[] = {"nan", "-1", "0",    "1e308", "1e-320", "1e12", "99999999999", ",", ";",   "\t",
                                 "\n",  "\r", "\\\n", " ",     "/",      "#",    "\"",          "_", "=\"", "</",
                                 "<a>", "f ", "v ",   "-",     ".",      "e",    "x",           "%"};

void try_on(pulsecast::fuzz::Target target, const std::string& bytes, std::size_t size) {
  target(reinterpret_cast<const std::uint8_t*>(bytes.data()), size);
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 3 || !pulsecast::fuzz::targets().contains(arguments[1])) return 2;
  const pulsecast::fuzz::Target target = pulsecast::fuzz::targets()[arguments[1]];
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(arguments[2])) {
    const std::string bytes = pulsecast::support::content(entry.path());
    std::printf("%s\n", entry.path().filename().c_str());
    std::fflush(stdout);  // so that the one that ends the program is known
    try_on(target, bytes, bytes.size());
    for (std::size_t size = 0; size < bytes.size() && bytes.size() <= 512; ++size) try_on(target, bytes, size);
    for (std::uint64_t seed = 0; seed < 400; ++seed) {
      pulsecast::support::Generator random(seed);
      const std::string spoilt = pulsecast::support::spoilt(bytes, 1 + random.whole(4), words, random);
      try_on(target, spoilt, spoilt.size());
    }
    ++files;
  }
  std::printf("%zu files\n", files);
  return files == 0 ? 1 : 0;
}
