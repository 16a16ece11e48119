// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/page/detail/json.hpp>

#include <array>
#include <cstdint>
#include <limits>
#include <string>

#include <doctest/doctest.h>

using pulsecast::page::detail::JsonWriter;

namespace {

std::string json_of(const auto& value) { return JsonWriter().value(value).text(); }

}  // namespace

TEST_CASE("commas stand between items and members, and nowhere else") {
  JsonWriter json;
  json.begin_object().member("a", 1).key("b").begin_array().end_array().key("c").begin_array();
  json.begin_object().end_object().value(2).begin_array().value("x,").value("[").value(true).end_array().end_array();
  json.member("d", false).end_object();
  CHECK(json.text() == R"({"a":1,"b":[],"c":[{},2,["x,","[",true]],"d":false})");
}

TEST_CASE("texts are JSON that may stand in HTML") {
  CHECK(json_of("a") == "\"a\"");
  CHECK(json_of(std::string("</script><!-- & \"\\\n\x7f")) ==
        R"("\u003c/script\u003e\u003c!-- \u0026 \u0022\u005c\u000a\u007f")");
  CHECK(json_of("\xc3\xa4") == "\"\xc3\xa4\"");
  CHECK(JsonWriter().begin_object().member("<", "").text() == R"({"\u003c":"")");
}

TEST_CASE("numbers are the shortest that read back as the same, or null") {
  CHECK(json_of(0.1) == "0.1");
  CHECK(json_of(1e300) == "1e+300");
  CHECK(json_of(std::numeric_limits<double>::quiet_NaN()) == "null");
  CHECK(json_of(-std::numeric_limits<double>::infinity()) == "null");
  CHECK(json_of(std::numeric_limits<std::uint64_t>::max()) == "18446744073709551615");
  CHECK(json_of(std::uint8_t{65}) == "65");
  CHECK(json_of(-7) == "-7");
}

TEST_CASE("arrays are written from what holds or computes their items") {
  CHECK(json_of(std::array<std::uint8_t, 3>{1, 2, 255}) == "[1,2,255]");
  CHECK(JsonWriter()
            .array(2,
                   [](std::size_t i) {
                     return std::array{0.5, static_cast<double>(i)};
                   })
            .text() == "[[0.5,0],[0.5,1]]");
  CHECK(JsonWriter().array(0, [](std::size_t i) { return i; }).text() == "[]");
}
