// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/base/scratch_memory.hpp>

#include <memory>

#include <doctest/doctest.h>

using namespace pulsecast;

namespace {

/// Item that fits any need.
struct Any : ScratchItem {
  [[nodiscard]] bool fits(int) const { return true; }
  [[nodiscard]] bool outdated(int) const { return false; }
};

struct Counted : Any {
  explicit Counted(int& alive) : alive_(&alive) { ++*alive_; }
  ~Counted() override { --*alive_; }
  int* alive_;
};

struct Number : ScratchItem {
  int value = 0;
  Number() = default;
  explicit Number(int least) : value(least) {}
  [[nodiscard]] bool fits(int least) const { return value >= least; }
  [[nodiscard]] bool outdated(int least) const { return least > 100; }
};

struct Other : Any {};

}  // namespace

TEST_CASE("a scratch memory gives back what was left, by type, each object once") {
  ScratchMemory memory;
  CHECK(memory.take<Number>(0) == nullptr);
  auto one = std::make_unique<Number>(), two = std::make_unique<Number>();
  Number* const first = one.get();
  Number* const second = two.get();
  memory.give_back(std::move(one));
  memory.give_back(std::make_unique<Other>());
  memory.give_back(std::move(two));
  const auto a = memory.take<Number>(0), b = memory.take<Number>(0);
  CHECK(((a.get() == first && b.get() == second) || (a.get() == second && b.get() == first)));
  CHECK(memory.take<Number>(0) == nullptr);
  CHECK(memory.take<Other>(0) != nullptr);
  CHECK(memory.take<Other>(0) == nullptr);
}

TEST_CASE("an object is found behind any others, which stay") {
  int alive = 0;
  ScratchMemory memory;
  memory.give_back(std::make_unique<Number>());
  for (int k = 0; k < 2; ++k) memory.give_back(std::make_unique<Other>());
  memory.give_back(std::make_unique<Counted>(alive));
  CHECK(memory.take<Number>(0) != nullptr);
  CHECK(memory.take<Counted>(0) != nullptr);
  for (int k = 0; k < 2; ++k) CHECK(memory.take<Other>(0) != nullptr);
  CHECK(memory.take<Other>(0) == nullptr);
}

TEST_CASE("a scratch memory deletes its objects when it is cleared and at its end") {
  int alive = 0;
  {
    ScratchMemory memory;
    for (int k = 0; k < 3; ++k) memory.give_back(std::make_unique<Counted>(alive));
    CHECK(alive == 3);
    memory.clear();
    CHECK(alive == 0);
    memory.give_back(std::make_unique<Counted>(alive));
  }
  CHECK(alive == 0);
}

TEST_CASE("an object is borrowed from a scratch memory, or is the call's own") {
  ScratchMemory memory;
  {
    const Borrowed<Number> first(&memory, 3), second(&memory, 3);
    CHECK(&*first != &*second);
    first->value = 7;
    second->value = 7;
  }
  const Borrowed<Number> again(&memory, 5), own(nullptr, 5);
  CHECK(again->value == 7);
  CHECK(own->value == 5);
}

TEST_CASE("an object that does not fit is left for who needs it, until it is outdated") {
  ScratchMemory memory;
  memory.give_back(std::make_unique<Number>(4));
  CHECK(Borrowed<Number>(&memory, 4)->value == 4);
  CHECK(Borrowed<Number>(&memory, 6)->value == 6);
  CHECK(Borrowed<Number>(&memory, 5)->value == 6);
  CHECK(Borrowed<Number>(&memory, 101)->value == 101);
  CHECK(memory.take<Number>(0)->value == 101);
  CHECK(memory.take<Number>(0) == nullptr);
}

TEST_CASE("a scratch memory provides as many objects as are asked for, beside those that do not fit") {
  ScratchMemory memory;
  memory.give_back(std::make_unique<Number>(4));
  memory.provide<Number>(2, 5);
  memory.provide<Number>(3, 3);
  for (const int value : {5, 5, 4}) CHECK(memory.take<Number>(value)->value == value);
  CHECK(memory.take<Number>(0) == nullptr);
}
