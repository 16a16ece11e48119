// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/input_file.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <new>
#include <string>
#include <vector>

#include <doctest/doctest.h>
#include <sys/stat.h>

#include "support/file_errors.hpp"
#include "support/generators.hpp"
#include "support/temporary_folder.hpp"

namespace pulsecast::io {
namespace {

using support::contains;
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
  CHECK(lines("a\r\r\nb\rc\n") == std::vector<std::string>{"a\r", "b\rc"});
  for (const char* text : {"a\rb\r", "a\rb\n", "\xEF\xBB\xBFx\ry"})
    CHECK(
        contains(support::file_error([&] { (void)lines(text); }).problem(), "lines that end in CR alone: expected LF"));
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
  CHECK(file.line() == 3);
  CHECK(file.line_is_open());
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

TEST_CASE("the rest of a file comes whole, without a byte order mark at its beginning") {
  const TemporaryFolder folder;
  const std::string mark = "\xEF\xBB\xBF", text(2 * InputFile::block_size + 5, 'a');
  CHECK(InputFile(put(folder, mark + mark + text), "text").take_rest() == mark + text);
  InputFile file(put(folder, text + mark), "text");
  (void)file.take(3);
  CHECK(file.take_rest() == text.substr(3) + mark);
  CHECK(file.take_rest().empty());
}

TEST_CASE("a line that is longer than a block is refused") {
  const std::string longest(InputFile::block_size - 1, 'a');
  CHECK(lines(longest + "\n" + longest) == std::vector<std::string>{longest, longest});
  CHECK_THROWS_WITH_AS(lines("b\n" + longest + "aa\n"), doctest::Contains("line 2: is longer than 1048576 bytes"),
                       FileError);
}

TEST_CASE("a file that ends before its size is refused") {
  const TemporaryFolder folder;
  const std::string path = put(folder, std::string(3 * InputFile::block_size, 'a'));
  InputFile file(path, "a cloud");
  std::filesystem::resize_file(path, 10);
  CHECK_THROWS_WITH_AS((void)file.take(50), doctest::Contains("cannot be read"), FileError);
}

TEST_CASE("what is no file is refused, and says what was expected") {
  const TemporaryFolder folder;
  CHECK_THROWS_WITH_AS(InputFile(folder / "none", "a cloud"),
                       doctest::Contains("none: does not exist: expected a cloud"), FileError);
  CHECK_THROWS_WITH_AS(InputFile(folder.path(), "a cloud"),
                       doctest::Contains("is a directory or device: expected a cloud"), FileError);
  CHECK_THROWS_WITH_AS(InputFile("/dev/zero", "a cloud"), doctest::Contains("is a directory or device"), FileError);
#if defined(_LIBCPP_VERSION)
  const char* const endless = "is empty";  // as its streams find
#else
  const char* const endless = "cannot be read";
#endif
  CHECK_THROWS_WITH_AS(InputFile("/proc/self/mem", "a cloud"), doctest::Contains(endless), FileError);
  CHECK_THROWS_WITH_AS(InputFile(put(folder, ""), "a cloud"), doctest::Contains("is empty: expected a cloud"),
                       FileError);
}

TEST_CASE("errors name the line or the byte") {
  const TemporaryFolder folder;
  InputFile file(put(folder, "a\nb\n"), "text");
  (void)file.take_line();
  (void)file.take_line();
  CHECK_THROWS_WITH_AS(file.fail_at_line("is odd"), doctest::Contains("a, line 2: is odd"), FileError);
  CHECK_THROWS_WITH_AS(file.fail_at_column(3, "is odd"), doctest::Contains("a, line 2, column 4: is odd"), FileError);
  CHECK_THROWS_WITH_AS(file.fail_at_byte(7, "is odd"), doctest::Contains("a, byte 7: is odd"), FileError);
}

void write(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

std::string text_of(const MappedFile& file) {
  return {reinterpret_cast<const char*>(file.bytes().data()), file.bytes().size()};
}

TEST_CASE("a file stands in memory as it is, at the beginning of a page") {
  const TemporaryFolder folder;
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
  const TemporaryFolder folder;
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
  const TemporaryFolder folder;
  write(folder / "empty", "");
  CHECK_THROWS_WITH_AS((void)MappedFile(folder / "none"), doctest::Contains("does not exist"), FileError);
  CHECK_THROWS_WITH_AS((void)MappedFile(folder / "empty"), doctest::Contains("is empty"), FileError);
  CHECK_THROWS_WITH_AS((void)MappedFile(folder.path()), doctest::Contains("is a directory"), FileError);
  CHECK_THROWS_WITH_AS((void)MappedFile("/dev/null"), doctest::Contains("is a directory or device"), FileError);
  REQUIRE(mkfifo((folder / "pipe").c_str(), 0600) == 0);  // is not waited for
  CHECK_THROWS_WITH_AS((void)MappedFile(folder / "pipe"), doctest::Contains("is a directory or device"), FileError);
}

TEST_CASE("too little memory for a file is an error that names it") {
  CHECK(reading("a.obj", [] { return 3; }) == 3);
  CHECK_THROWS_WITH_AS(reading("a.obj", [] { throw std::bad_alloc(); }),
                       doctest::Contains("a.obj: takes more memory than there is"), FileError);
}

}  // namespace
}  // namespace pulsecast::io
