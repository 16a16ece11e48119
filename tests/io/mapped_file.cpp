// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/mapped_file.hpp>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include <doctest/doctest.h>
#include <sys/stat.h>

#include "support/temporary_folder.hpp"

using namespace pulsecast;
using namespace pulsecast::io;
using namespace pulsecast::support;

namespace {

const TemporaryFolder folder;

void write(const std::filesystem::path& path, const std::string& text) { std::ofstream(path, std::ios::binary) << text; }

std::string text_of(const MappedFile& file) { return {reinterpret_cast<const char*>(file.bytes().data()), file.bytes().size()}; }

}  // namespace

TEST_CASE("a file stands in memory as it is, at the beginning of a page") {
  for (const std::size_t size : {1U, 4095U, 4096U, 4097U, 100'000U}) {
    std::string text;
    for (std::size_t i = 0; i < size; ++i) text += static_cast<char>(i * 31 % 251);
    write(folder / "file", text);
    const MappedFile file(folder / "file");
    CHECK(text_of(file) == text);
    CHECK(reinterpret_cast<std::uintptr_t>(file.bytes().data()) % 4096 == 0);
  }
}

TEST_CASE("a file that was replaced or removed is still there for who had it") {
  write(folder / "file", "old");
  const MappedFile file(folder / "file");
  write(folder / "new", "new");
  std::filesystem::rename(folder / "new", folder / "file");
  CHECK(text_of(file) == "old");
  CHECK(text_of(MappedFile(folder / "file")) == "new");
  std::filesystem::remove(folder / "file");
  CHECK(text_of(file) == "old");
}

TEST_CASE("what cannot be mapped is an error that says why") {
  write(folder / "empty", "");
  CHECK_THROWS_WITH_AS((void)MappedFile(folder / "none"), doctest::Contains("does not exist"), FileError);
  CHECK_THROWS_WITH_AS((void)MappedFile(folder / "empty"), doctest::Contains("is empty"), FileError);
  CHECK_THROWS_WITH_AS((void)MappedFile(folder.path()), doctest::Contains("is a directory"), FileError);
  CHECK_THROWS_WITH_AS((void)MappedFile("/dev/null"), doctest::Contains("is a directory or device"), FileError);
  REQUIRE(mkfifo((folder / "pipe").c_str(), 0600) == 0);  // is not waited for
  CHECK_THROWS_WITH_AS((void)MappedFile(folder / "pipe"), doctest::Contains("is a directory or device"), FileError);
}
