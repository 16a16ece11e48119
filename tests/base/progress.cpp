// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/base/progress.hpp>

#include <concepts>
#include <functional>
#include <memory>
#include <vector>

#include <doctest/doctest.h>

using namespace pulsecast;

namespace {

PulseIndex told = 0;
void tell(const Progress& progress) { told = progress.done; }

/// Function with state, which is not const.
struct Counter {
  std::vector<PulseIndex> done{};
  PulseIndex* calls;
  void operator()(const Progress& progress) {
    done.push_back(progress.done);
    *calls = done.size();
  }
};

}  // namespace

TEST_CASE("a callback is none by default, of a null pointer and of an empty std::function") {
  CHECK_FALSE(ProgressCallback{});
  CHECK_FALSE(ProgressCallback{static_cast<void (*)(const Progress&)>(nullptr)});
  CHECK_FALSE(ProgressCallback{std::function<void(const Progress&)>{}});
}

TEST_CASE("a callback calls functions, lambdas and std::function with the progress") {
  const std::function<void(const Progress&)> erased = tell;
  for (const ProgressCallback& callback :
       {ProgressCallback{tell}, ProgressCallback{[](const Progress& p) { tell(p); }}, ProgressCallback{erased}}) {
    told = 0;
    REQUIRE(callback);
    callback({.done = 7});
    CHECK(told == 7);
  }
}

TEST_CASE("copies of a callback share a function with state, and the last one deletes it") {
  PulseIndex calls = 0;
  ProgressCallback callback = Counter{.calls = &calls};
  ProgressCallback copy = callback;
  callback({.done = 1});
  copy({.done = 2});
  CHECK(calls == 2);

  const auto token = std::make_shared<int>(0);
  callback = [token](const Progress&) {};
  copy = callback;
  callback = {};
  CHECK_FALSE(callback);
  CHECK(token.use_count() == 2);
  copy = {};
  CHECK(token.use_count() == 1);
}

static_assert(!std::constructible_from<ProgressCallback, int> &&
              !std::constructible_from<ProgressCallback, void (*)(int)>);
