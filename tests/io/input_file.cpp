// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/input_file.hpp>

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "support/generators.hpp"
#include "support/temporary_folder.hpp"

namespace pulsecast::io {
namespace {

using support::TemporaryFolder;

std::filesystem::path put(const TemporaryFolder& folder, const std::string& text) {
  std::filesystem::remove(folder / "a");
  std::ofstream(folder / "a", std::ios::binary) << text;
  return folder / "a";
}

std::vector<std::string> lines(const std::string& text) {
  const TemporaryFolder folder;
  InputFile file(put(folder, text), "text");
  std::vector<std::string> result;
  while (const auto line = file.take_line()) result.emplace_back(*line);
  return result;
}

TEST_CASE("lines come without their ends") {
  CHECK(lines("a\nbc\n\nd") == std::vector<std::string>{"a", "bc", "", "d"});
  CHECK(lines("a\r\nb\r\n") == std::vector<std::string>{"a", "b"});
  CHECK(lines("\xEF\xBB\xBF"
              "a\n\xEF\xBB\xBF\n") == std::vector<std::string>{"a", "\xEF\xBB\xBF"});
  CHECK(lines("\n") == std::vector<std::string>{""});
}

TEST_CASE("an input file knows where it is") {
  const TemporaryFolder folder;
  InputFile file(put(folder, "abc\ndef\ngh"), "text");
  CHECK(file.size() == 10);
  CHECK(file.take_line() == "abc");
  CHECK(file.line() == 1);
  CHECK(file.position() == 4);
  CHECK(file.take(2) == "de");
  CHECK(file.take_line() == "f");
  CHECK_FALSE(file.line_is_open());
  CHECK(file.take_line() == "gh");
  CHECK(file.line_is_open());
  CHECK_FALSE(file.take_line());
  CHECK(file.take(5).empty());
  file.seek(5);
  CHECK(file.take(100) == "ef\ngh");
  CHECK(file.position() == 10);
}

TEST_CASE("blocks do not show, wherever their borders fall") {
  constexpr std::uint64_t seed = 11;
  CAPTURE(seed);
  support::Generator random(seed);
  std::vector<std::string> expected;
  std::string text;
  while (text.size() < 3 * InputFile::block_size) {
    const auto longest = static_cast<std::uint64_t>(random.log_uniform(2, 1e5));
    expected.emplace_back(random.whole(longest), static_cast<char>('a' + random.whole(26)));
    text += expected.back() + "\n";
  }
  CHECK(lines(text) == expected);

  const TemporaryFolder folder;
  InputFile file(put(folder, text), "text");
  std::string joined;
  while (joined.size() < text.size()) {
    const std::uint64_t n = 1 + random.whole(InputFile::block_size);
    const std::string_view taken = file.take(n);
    REQUIRE(taken.size() == std::min<std::size_t>(n, text.size() - joined.size()));
    joined += taken;
  }
  CHECK(joined == text);
}

TEST_CASE("a line that is longer than a block is refused") {
  const std::string longest(InputFile::block_size - 1, 'a');
  CHECK(lines(longest + "\n" + longest) == std::vector<std::string>{longest, longest});
  CHECK_THROWS_WITH_AS(lines("b\n" + longest + "aa\n"), doctest::Contains("line 2: is longer than 1048576 bytes"), FileError);
}

TEST_CASE("what is no file is refused, and says what was expected") {
  const TemporaryFolder folder;
  CHECK_THROWS_WITH_AS(InputFile(folder / "none", "a cloud"), doctest::Contains("none: does not exist: expected a cloud"), FileError);
  CHECK_THROWS_WITH_AS(InputFile(folder.path(), "a cloud"), doctest::Contains("is a directory or device: expected a cloud"), FileError);
  CHECK_THROWS_WITH_AS(InputFile("/dev/zero", "a cloud"), doctest::Contains("is a directory or device"), FileError);
  CHECK_THROWS_WITH_AS(InputFile(put(folder, ""), "a cloud"), doctest::Contains("is empty: expected a cloud"), FileError);
}

TEST_CASE("errors name the line or the byte") {
  const TemporaryFolder folder;
  InputFile file(put(folder, "a\nb\n"), "text");
  (void)file.take_line(), (void)file.take_line();
  CHECK_THROWS_WITH_AS(file.fail_at_line("is odd"), doctest::Contains("a, line 2: is odd"), FileError);
  CHECK_THROWS_WITH_AS(file.fail_at_byte(7, "is odd"), doctest::Contains("a, byte 7: is odd"), FileError);
}

}  // namespace
}  // namespace pulsecast::io
