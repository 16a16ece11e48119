// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/page/detail/attributes.hpp>

#include <string_view>

#include <doctest/doctest.h>

using namespace pulsecast::page;

// What the script does is tested in a browser: tests/page/browser.

TEST_CASE("the script can stand in HTML, and makes no HTML or script of texts") {
  for (const std::string_view script : {page_attributes_script}) {
    CHECK(script.size() > 1000);
    for (const char* word :
         {"</script", "<!--", "innerHTML", "outerHTML", "insertAdjacentHTML", "document.write", "eval(", "new Function", "http:"}) {
      CAPTURE(word);
      CHECK(script.find(word) == std::string_view::npos);
    }
  }
}
