// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/base/text.hpp>

#include <clocale>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include <doctest/doctest.h>

using namespace pulsecast::text;

namespace {

using Texts = std::vector<std::string_view>;

Texts words(std::string_view text, std::string_view separators) {
  Texts all;
  while (!text.empty()) all.push_back(take_word(text, separators));
  return all;
}

Texts lines(std::string_view text) {
  Texts all;
  while (!text.empty()) all.push_back(take_line(text));
  return all;
}

}  // namespace

TEST_CASE("a text is trimmed of blanks and tabs only") {
  CHECK(trimmed(" \t a b\t ") == "a b");
  CHECK(trimmed("\na\n") == "\na\n");
  CHECK(trimmed(" \t ").empty());
  CHECK(trimmed("").empty());
}

TEST_CASE("a byte order mark counts at the beginning, and once") {
  CHECK(without_byte_order_mark("\xEF\xBB\xBF\xEF\xBB\xBFx") == "\xEF\xBB\xBFx");
  CHECK(without_byte_order_mark("x\xEF\xBB\xBF") == "x\xEF\xBB\xBF");
  CHECK(without_byte_order_mark("\xEF\xBB") == "\xEF\xBB");
}

TEST_CASE("case is that of ASCII letters") {
  CHECK(lower("AZaz@[0\xC4") == "azaz@[0\xC4");
  CHECK(is_same_word("pulseFreq_Hz", "PULSEfreq_hZ"));
  CHECK_FALSE(is_same_word("a", "ab"));
  CHECK_FALSE(is_same_word("@", "`"));  // as far apart as a capital and its small letter
  CHECK(is_same_word("", ""));
}

TEST_CASE("a quotation stands on one line, and shows the beginning of a long text") {
  CHECK(quoted("") == "''");
  CHECK(quoted("a\tb\n") == "'a b '");
  CHECK(quoted(std::string(80, 'x')) == "'" + std::string(80, 'x') + "'");
  CHECK(quoted(std::string(81, 'x')) == "'" + std::string(80, 'x') + "...'");
}

TEST_CASE("words are taken one by one, with all separators behind them") {
  CHECK(words("a  b\tc ", blanks) == Texts{"a", "b", "c"});
  CHECK(words("a,;b c", ",;") == Texts{"a", "b c"});
  CHECK(words(",a", ",") == Texts{"", "a"});
  CHECK(words("", ",").empty());
}

TEST_CASE("lines are taken one by one, without their ends") {
  CHECK(lines("a\r\n\nb\rc\n") == Texts{"a", "", "b\rc"});
  CHECK(lines("a\nb") == Texts{"a", "b"});
  CHECK(lines("\n\r") == Texts{"", ""});
}

TEST_CASE("a number is taken from the beginning of a text, and the rest is left") {
  std::string_view text = "12.5e1deg";
  CHECK(take_number<double>(text) == 125);
  CHECK(text == "deg");
  CHECK_FALSE(take_number<double>(text));
  CHECK(text == "deg");
  text = "2e3";
  CHECK(take_number<double>(text, std::chars_format::fixed) == 2);
  CHECK(text == "e3");
  text = "256x";
  CHECK_FALSE(take_number<std::uint8_t>(text));
  CHECK(text == "256x");
}

TEST_CASE("a number is all of its text, and has a point in every locale") {
  std::setlocale(LC_ALL, "de_DE.UTF-8");  // where it is installed, numbers have commas
  struct Case {
    const char* text;
    double value;
  };
  for (const Case& c : {Case{"1.5", 1.5}, {"+2", 2}, {"-1e3", -1000}, {".5", 0.5}, {"5.", 5}, {"-0", 0}}) {
    CAPTURE(c.text);
    CHECK(number_in<double>(c.text) == c.value);
    CHECK(finite_number_in(c.text) == c.value);
  }
  for (const char* text :
       {"", "nan", "-nan", "1,5", "1.5x", "0x10", "1e", "1e999", "--1", "+-1", "++1", "+", " 1", "1 ", "e5", "."}) {
    CAPTURE(text);
    CHECK_FALSE(number_in<double>(text));
    CHECK_FALSE(finite_number_in(text));
  }
  CHECK(number_in<double>("-inf") == -std::numeric_limits<double>::infinity());
  CHECK_FALSE(finite_number_in("-inf"));
  std::setlocale(LC_ALL, "C");
}

TEST_CASE("a whole number fits its type") {
  CHECK(number_in<std::uint16_t>("65535") == 65535);
  CHECK(number_in<std::uint64_t>("+18446744073709551615") == std::numeric_limits<std::uint64_t>::max());
  CHECK(number_in<std::int64_t>("-5") == -5);
  for (const char* text : {"65536", "-1", "1.0", "1e3", "", "1 "}) CHECK_FALSE(number_in<std::uint16_t>(text));
}
