// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/page/detail/assets.hpp>

#include <set>
#include <string>
#include <string_view>

#include <doctest/doctest.h>

using namespace pulsecast::page::detail;

namespace {

/// The page, with `survey` and `points` where those go.
std::string page() {
  std::string out;
  for (const std::string_view piece : html_before_survey) out += piece;
  out += "survey";
  for (const std::string_view piece : html_before_points) out += piece;
  out += "points";
  for (const std::string_view piece : html_after_points) out += piece;
  return out;
}

/// The script of the page, from its tag on.
std::string script() {
  const std::string html = page();
  return html.substr(html.find("<script>\n'use strict'\n"));
}

/// All words of a text that stand between `before` and `after`.
std::multiset<std::string> words(const std::string& text, std::string_view before, char after) {
  std::multiset<std::string> out;
  for (auto at = text.find(before); at != std::string::npos; at = text.find(before, at + 1)) {
    const auto begin = at + before.size();
    out.insert(text.substr(begin, text.find(after, begin) - begin));
  }
  return out;
}

}  // namespace

TEST_CASE("the parts of the page are one document, without a mark left or a licence line") {
  const std::string html = page();
  CHECK(html.starts_with("<!DOCTYPE html>\n<html"));
  CHECK(html.ends_with("\n</script>\n</body>\n</html>\n"));
  CHECK(html.find("\" id=\"survey\">survey</script>\n") < html.find("\" id=\"points\">points</script>\n"));
  for (const char* mark : {"SPDX", ".js@", ".css@", ".glsl@", "@survey@", "@points@"}) {
    CAPTURE(mark);
    CHECK(html.find(mark) == std::string::npos);
  }
  for (const char* piece : {"\n:root {", "class Points", "class GlPainter", "`#version 300 es\nprecision",
                            "class Camera", "class Colouring"}) {
    CAPTURE(piece);
    CHECK(html.find(piece) != std::string::npos);
  }
}

TEST_CASE("no literal is longer than compilers must take") {
  std::size_t pieces = 0;
  const auto check = [&pieces](const auto& part) {
    for (const std::string_view piece : part) {
      CHECK(piece.size() < 16'384);
      ++pieces;
    }
  };
  check(html_before_survey);
  check(html_before_points);
  check(html_after_points);
  CHECK(pieces > 5);
}

TEST_CASE("the script can stand in HTML, and makes no HTML or script of texts") {
  const std::string all = script();
  CHECK(all.size() > 50'000);
  CHECK(all.find("</script") == all.rfind("</script>\n</body>"));
  for (const char* word :
       {"<!--", "innerHTML", "outerHTML", "insertAdjacentHTML", "document.write", "eval(", "new Function", "http:"}) {
    CAPTURE(word);
    CHECK(all.find(word) == std::string::npos);
  }
}

TEST_CASE("every element that the script asks for is on the page, once") {
  const auto ids = words(page(), " id=\"", '"'), asked = words(script(), "byId('", '\'');
  for (const std::string& id : ids) {
    CAPTURE(id);
    CHECK(ids.count(id) == 1);
  }
  CHECK(asked.size() > 20);
  for (const std::string& id : asked) {
    CAPTURE(id);
    CHECK(ids.contains(id));
  }
}
