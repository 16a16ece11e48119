// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/base/frozen.hpp>

#include <memory>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

using namespace pulsecast;

TEST_CASE("a frozen array holds what a vector held, and nothing more") {
  std::vector<int> made{1, 2, 3};
  made.reserve(1000);
  const Frozen<int> frozen(std::move(made));
  CHECK(std::vector<int>(frozen.begin(), frozen.end()) == std::vector<int>{1, 2, 3});
  CHECK(frozen[1] == 2);
  CHECK(frozen.memory() == 3 * sizeof(int));
  CHECK(Frozen<int>().empty());
}

TEST_CASE("a draft is written to, and then frozen without a copy") {
  Draft<int> draft(3);
  for (int i = 0; i < 3; ++i) draft[static_cast<std::size_t>(i)] = i * i;
  const Frozen<int> frozen = draft;
  CHECK(frozen.data() == draft.data());
  draft = {};
  CHECK(draft.empty());
  CHECK(std::vector<int>(frozen.begin(), frozen.end()) == std::vector<int>{0, 1, 4});
  CHECK(Draft<double>(0).empty());
}

TEST_CASE("copies of a frozen array share it, and the last one lets its owner go") {
  const auto owner = std::make_shared<const std::vector<int>>(5, 7);
  {
    const Frozen<int> frozen(*owner, owner), copy = frozen;
    CHECK(copy.data() == owner->data());
    CHECK(owner.use_count() == 3);
  }
  CHECK(owner.use_count() == 1);
}
