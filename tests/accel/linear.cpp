// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/accel/linear.hpp>

#include <doctest/doctest.h>

#include <vector>

#include "support/scenes.hpp"

using namespace pulsecast;

static_assert(Accelerator<Linear<float>>);
using namespace pulsecast::support;

static_assert(Accelerator<Linear<double>>);

TEST_CASE_TEMPLATE("testing all offers every primitive once, but never an empty box", Real, float, double) {
  Generator random(40);
  std::vector<Box> boxes;
  for (int i = 0; i < 20; ++i) boxes.push_back(random.box(10, 0.1, 1));
  boxes[7] = Box{};
  const Linear<Real> all(boxes);
  std::size_t largest = 0;
  const auto count = offers(all, boxes.size(), largest);
  for (std::size_t i = 0; i < boxes.size(); ++i) CHECK(count[i] == (i == 7 ? 0 : 1));
  CHECK(largest == 19);
  CHECK(all.memory() >= 19 * sizeof(PrimitiveIndex));
  Box bounds;
  for (const Box& box : boxes) bounds.extend(box);
  CHECK(all.bounds() == bounds);
}

TEST_CASE("testing all of nothing tests nothing") {
  const Linear<> none(std::span<const Box>{});
  std::size_t largest = 0;
  CHECK(offers(none, 0, largest).empty());
  CHECK(largest == 0);
  CHECK(none.bounds().empty());
}

TEST_CASE("a list of primitives is sound for as many as it has, and for no fewer") {
  const Linear<> all(std::vector<Box>(3, Box{{0, 0, 0}, {1, 1, 1}}));
  CHECK(all.is_consistent(3));
  CHECK_FALSE(all.is_consistent(2));
  CHECK(Linear<>(DeserializeTag{}).is_consistent(0));
}
