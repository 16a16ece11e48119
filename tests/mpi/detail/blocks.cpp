// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/mpi/detail/blocks.hpp>

#include <cstdint>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "support/generators.hpp"

namespace pulsecast::mpi {
namespace {

TEST_CASE("blocks cover all slots once, and become smaller towards the end") {
  for (const PulseIndex slots : {0U, 1U, 2047U, 2048U, 2049U, 100'000U, 12'345'678U}) {
    INFO(slots, " slots");
    MpiBlockScheduler scheduler(slots, 7);
    PulseIndex next = 0, last = 0;
    std::uint64_t blocks = 0;
    while (const auto block = scheduler.next(0)) {
      CHECK(block->number == blocks++);
      CHECK(block->from == next);
      CHECK(block->to > block->from);
      next = block->to;
      last = block->to - block->from;
      scheduler.finish(block->number, {}, {.slots = last, .bytes = last, .seconds = 1e-7 * static_cast<double>(last)});
    }
    CHECK(next == slots);
    CHECK(last <= MpiBlockScheduler::min_slots);
    CHECK(blocks < 200);
  }
}

TEST_CASE("blocks are small until it is known what they take, and never take much") {
  MpiBlockScheduler scheduler(1'000'000'000, 2);
  const auto size = [&] {
    const auto block = scheduler.next(0);
    return block->to - block->from;
  };
  CHECK(size() == 8192);
  scheduler.finish(0, {}, {.slots = 8192, .bytes = 8192 * 100, .seconds = 1e-3});
  CHECK(size() == 16 * 1024 * 1024 / 100 / 2048 * 2048);  // bytes
  scheduler.finish(1, {}, {.slots = 8192, .bytes = 0, .seconds = 10});
  CHECK(size() == 2048);  // seconds
}

TEST_CASE("blocks are placed in order, whatever the order in which they come back") {
  support::Generator random(5);
  MpiBlockScheduler scheduler(40'000, 3);
  std::vector<MpiBlock> out;
  while (const auto block = scheduler.next(static_cast<int>(out.size() % 3))) out.push_back(*block);
  REQUIRE(out.size() > 5);
  const std::size_t blocks = out.size();
  std::vector<std::uint64_t> placed;
  bool may = true;
  const auto settle = [&] {
    scheduler.settle([&] { return may; },
                     [&](std::uint64_t number, int owner, const std::vector<MpiExtent>& extents) {
                       CHECK(number == placed.size());
                       CHECK(owner == static_cast<int>(number % 3));
                       CHECK(extents.at(0).amounts[0] == number + 100);
                       placed.push_back(number);
                     });
  };
  while (!out.empty()) {
    const std::size_t k = random.whole(out.size());
    MpiExtent extent;
    extent.amounts[0] = out[k].number + 100;
    scheduler.finish(out[k].number, {extent}, {.slots = out[k].to - out[k].from});
    out.erase(out.begin() + static_cast<std::ptrdiff_t>(k));
    const std::size_t before = placed.size();
    may = false;
    settle();
    CHECK(placed.size() == before);
    may = true;
    settle();
  }
  CHECK(placed.size() == blocks);
  CHECK(scheduler.cost().slots == 40'000);
}

TEST_CASE("what is stopped hands out no more") {
  MpiBlockScheduler scheduler(1'000'000, 2);
  CHECK(scheduler.next(0));
  scheduler.stop();
  CHECK(!scheduler.next(1));
}

}  // namespace
}  // namespace pulsecast::mpi
