// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/detail/digest.hpp>

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include <doctest/doctest.h>

#include "support/temporary_folder.hpp"

using namespace pulsecast;
using namespace pulsecast::io;
using namespace pulsecast::support;

namespace {

const TemporaryFolder folder;

void write(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

Fingerprint of_bytes(std::string_view text, std::size_t at_once) {
  Digest digest;
  for (std::size_t i = 0; i < text.size(); i += at_once) digest.add(std::as_bytes(std::span(text.substr(i, at_once))));
  return digest.value();
}

Fingerprint of_content(const std::filesystem::path& path) {
  Digest digest;
  digest.add_content(path);
  return digest.value();
}

}  // namespace

TEST_CASE("the fingerprint is XXH3 of 128 bits, in however many pieces the bytes come") {
  // Source: what xxhsum -H2 of xxHash 0.8 says of nothing
  CHECK(Digest().value() == Fingerprint{0x6001c324468d497f, 0x99aa06d3014798d8});
  std::string text;
  for (int i = 0; i < 5000; ++i) text += static_cast<char>(i * i % 251);
  const Fingerprint whole = of_bytes(text, text.size());
  for (const std::size_t at_once : {1U, 7U, 256U, 4999U}) CHECK(of_bytes(text, at_once) == whole);
  for (const std::size_t at : {0U, 1U, 2500U, 4999U}) {
    std::string other = text;
    other[at] = static_cast<char>(other[at] ^ 1);
    CHECK(of_bytes(other, 5000) != whole);
  }
}

TEST_CASE("it matters where one text ends and the next begins") {
  const auto of = [](std::string_view a, std::string_view b) {
    Digest digest;
    digest.add(a);
    digest.add(b);
    return digest.value();
  };
  CHECK(of("ab", "c") == of("ab", "c"));
  CHECK(of("ab", "c") != of("a", "bc"));
  CHECK(of("", "abc") != of("abc", ""));
}

TEST_CASE("a file counts by what it holds, wherever it is and however long it is") {
  write(folder / "a", "one");
  write(folder / "b", "one");
  write(folder / "c", "onf");
  write(folder / "empty", "");
  CHECK(of_content(folder / "a") == of_content(folder / "b"));
  CHECK(of_content(folder / "a") != of_content(folder / "c"));
  CHECK(of_content(folder / "empty") != Digest().value());
  std::string text((std::size_t{2} << 20) + 5, 'x');
  write(folder / "long", text);
  const Fingerprint before = of_content(folder / "long");
  text.back() = 'y';
  write(folder / "long", text);
  CHECK(of_content(folder / "long") != before);
  CHECK_THROWS_WITH_AS((void)of_content(folder / "none"), doctest::Contains("does not exist"), FileError);
  CHECK_THROWS_WITH_AS((void)of_content("/dev/null"), doctest::Contains("neither a file nor a folder"), FileError);
}

TEST_CASE("a folder counts as all files in it, with their names") {
  const std::filesystem::path spectra = folder / "spectra";
  std::filesystem::create_directories(spectra / "more");
  write(spectra / "oak.txt", "1 2");
  write(spectra / "more" / "elm.txt", "3 4");
  const Fingerprint before = of_content(spectra);
  CHECK(of_content(spectra) == before);
  write(spectra / "more" / "elm.txt", "3 5");
  CHECK(of_content(spectra) != before);
  write(spectra / "more" / "elm.txt", "3 4");
  CHECK(of_content(spectra) == before);
  write(spectra / "ash.txt", "");
  CHECK(of_content(spectra) != before);
  std::filesystem::remove(spectra / "ash.txt");
  std::filesystem::rename(spectra / "oak.txt", spectra / "pine.txt");
  CHECK(of_content(spectra) != before);
  std::filesystem::rename(spectra / "pine.txt", spectra / "oak.txt");
  std::filesystem::rename(spectra, folder / "elsewhere");
  CHECK(of_content(folder / "elsewhere") == before);
}
