// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/page/detail/viewer.hpp>

#include <set>
#include <string>
#include <string_view>

#include <doctest/doctest.h>

using namespace pulsecast::page;

TEST_CASE("every element that the scripts ask for is on the page, once") {
  std::set<std::string> known{"points"};
  std::size_t ids = 1;
  for (auto at = page_head.find(" id=\""); at != std::string_view::npos; at = page_head.find(" id=\"", at + 1), ++ids)
    known.emplace(page_head.substr(at + 5, page_head.find('"', at + 5) - at - 5));
  CHECK(known.size() == ids);
  CHECK(page_before_points.find("id=\"points\"") != std::string_view::npos);
  std::size_t asked = 0;
  for (const std::string_view script : page_scripts)
    for (auto at = script.find("byId('"); at != std::string_view::npos; at = script.find("byId('", at + 1), ++asked) {
      const std::string id(script.substr(at + 6, script.find('\'', at + 6) - at - 6));
      CAPTURE(id);
      CHECK(known.contains(id));
    }
  CHECK(asked > 20);
}
