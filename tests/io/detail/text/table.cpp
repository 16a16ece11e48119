// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/detail/text/table.hpp>

#include <clocale>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include "support/temporary_folder.hpp"

namespace pulsecast::io {
namespace {

using support::TemporaryFolder;
using Rows = std::vector<std::vector<std::string>>;

std::filesystem::path put(const TemporaryFolder& folder, const std::string& text) {
  std::filesystem::remove(folder / "t.txt");
  std::ofstream(folder / "t.txt", std::ios::binary) << text;
  return folder / "t.txt";
}

Rows rows(const std::string& text, std::optional<char> separator = {}) {
  const TemporaryFolder folder;
  TextTable table(put(folder, text), "a table", separator);
  Rows result;
  while (table.next()) result.emplace_back(table.cells().begin(), table.cells().end());
  return result;
}

FileError error(const std::string& text) {
  try {
    (void)rows(text);
  } catch (const FileError& e) {
    return e;
  }
  return FileError("", "", "no error");
}

TEST_CASE("columns are separated by what the first row has") {
  const Rows expected{{"a", "b", "c"}, {"1", "2", "3"}};
  CHECK(rows("a,b,c\n1,2,3\n") == expected);
  CHECK(rows("a;b;c\n1;2;3\n") == expected);
  CHECK(rows("a\tb\tc\n1\t2\t3\n") == expected);
  CHECK(rows("a b c\n1 2 3\n") == expected);
  CHECK(rows("  a  b   c \n1\t2 3") == expected);
  CHECK(rows("\"a\" , \" b \",c\n 1,\t2 , 3 \n") == expected);
  CHECK(rows("a;b,x\n1;2,5\n") == Rows{{"a", "b,x"}, {"1", "2,5"}});
  CHECK(rows("a;b,x\n1;2,5\n", ',') == Rows{{"a;b", "x"}, {"1;2", "5"}});
  CHECK(rows("a, b\n", ' ') == Rows{{"a,", "b"}});
}

TEST_CASE("empty cells count, except among blanks") {
  CHECK(rows("a,,c,\n") == Rows{{"a", "", "c", ""}});
  CHECK(rows("a\t\tc\n") == Rows{{"a", "", "c"}});
}

TEST_CASE("lines end as on any system, and blank ones do not count") {
  CHECK(rows("\xEF\xBB\xBF"
             "a,b\r\n\r\n  \n1,2\r\n") == Rows{{"a", "b"}, {"1", "2"}});
  CHECK(rows("a\n\xEF\xBB\xBF"
             "b\n") == Rows{{"a"},
                            {"\xEF\xBB\xBF"
                             "b"}});
  const TemporaryFolder folder;
  TextTable table(put(folder, "a\n\n\nb"), "a table");
  CHECK(table.next());
  CHECK(table.line() == 1);
  CHECK_FALSE(table.line_is_open());
  CHECK(table.next());
  CHECK(table.line() == 4);
  CHECK(table.line_is_open());
  CHECK_FALSE(table.next());
  TextTable whole(put(folder, "a\n"), "a table");
  CHECK(whole.next());
  CHECK_FALSE(whole.next());
  CHECK_FALSE(whole.line_is_open());
}

TEST_CASE("a number is all of its cell, finite, and has a point in every locale") {
  std::setlocale(LC_ALL, "de_DE.UTF-8");  // where it is installed, numbers have commas
  struct Case {
    const char* cell;
    double value;
  };
  for (const Case& c : {Case{"1.5", 1.5}, {"+2", 2}, {"-1e3", -1000}, {".5", 0.5}, {"5.", 5}, {"-0", 0}}) {
    CAPTURE(c.cell);
    REQUIRE(TextTable::number_in(c.cell));
    CHECK(*TextTable::number_in(c.cell) == c.value);
  }
  for (const char* cell : {"", "nan", "inf", "-inf", "1,5", "1.5x", "0x10", "1e", "1e999", "--1", "+-1", "++1", " 1", "1 ", "e5", "."}) {
    CAPTURE(cell);
    CHECK_FALSE(TextTable::number_in(cell));
  }
  std::setlocale(LC_ALL, "C");
}

TEST_CASE("of a long cell, an error shows the beginning") {
  CHECK(TextTable::quoted("") == "''");
  CHECK(TextTable::quoted(std::string(64, 'x')) == "'" + std::string(64, 'x') + "'");
  CHECK(TextTable::quoted(std::string(65, 'x')) == "'" + std::string(64, 'x') + "...'");
}

TEST_CASE("what is no text file is refused, and says what was expected") {
  CHECK(error("").problem() == "is empty: expected a table");
  CHECK(error(std::string("a b\n1\0 2\n", 9)).place() == "line 2");
  CHECK(error("a b\n\x01\n").problem() == "holds binary data: expected the text of a table");
  const TemporaryFolder folder;
  CHECK_THROWS_WITH_AS(TextTable(folder / "none", "a table"), doctest::Contains("does not exist: expected a table"), FileError);
  CHECK_THROWS_WITH_AS(TextTable(folder.path(), "a table"), doctest::Contains("is a directory"), FileError);
  CHECK_THROWS_WITH_AS(TextTable("/proc/self/mem", "a table"), doctest::Contains("cannot be read"), FileError);
  TextTable table(put(folder, "a b\n"), "a table");
  (void)table.next();
  CHECK_THROWS_WITH_AS(table.fail_here(1, "is odd"), doctest::Contains("line 1, column 2: is odd"), FileError);
}

}  // namespace
}  // namespace pulsecast::io
