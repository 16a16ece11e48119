// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/base/shared_array.hpp>

#include <memory>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

using namespace pulsecast;

TEST_CASE("a shared array holds what a vector held, and nothing more") {
  std::vector<int> made{1, 2, 3};
  made.reserve(1000);
  const SharedArray<int> array(std::move(made));
  CHECK(std::vector<int>(array.begin(), array.end()) == std::vector<int>{1, 2, 3});
  CHECK(array[1] == 2);
  CHECK(array.memory() == 3 * sizeof(int));
  CHECK(SharedArray<int>().empty());
}

TEST_CASE("a shared buffer is written to, and becomes a shared array without a copy") {
  SharedBuffer<int> buffer(3);
  for (int i = 0; i < 3; ++i) buffer[static_cast<std::size_t>(i)] = i * i;
  const SharedArray<int> array = buffer;
  CHECK(array.data() == buffer.data());
  buffer = {};
  CHECK(buffer.empty());
  CHECK(std::vector<int>(array.begin(), array.end()) == std::vector<int>{0, 1, 4});
  CHECK(SharedBuffer<double>(0).empty());
}

TEST_CASE("copies of a shared array share it, and the last one lets its owner go") {
  const auto owner = std::make_shared<const std::vector<int>>(5, 7);
  {
    const SharedArray<int> array(*owner, owner), copy = array;
    CHECK(copy.data() == owner->data());
    CHECK(owner.use_count() == 3);
  }
  CHECK(owner.use_count() == 1);
}
