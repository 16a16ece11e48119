// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/base/optional_member.hpp>

#include <concepts>

#include <doctest/doctest.h>

namespace {

template <class T>
concept Rings = requires(const T& t) {
  { t.ring(1) } -> std::same_as<int>;
};
PULSECAST_OPTIONAL_MEMBER(Rings, "int ring(int) const", ring, (1), rings, sound, chime, toll)

template <class T>
concept Loud = requires {
  requires std::same_as<decltype(T::loud), const bool>;
};
PULSECAST_OPTIONAL_MEMBER(Loud, "static constexpr bool loud", loud, , is_loud, noisy, strong, audible)

struct Silent {
  void play() const {}
};
struct Bell {
  int ring(int times) const { return times; }
};
struct BellThatChimes : Bell {
  void chime(int) const {}
};
struct FinalBell final : Bell {};
static_assert(detail::RingsCheck<Silent>::passed && detail::RingsCheck<int>::passed &&
              detail::RingsCheck<void (*)(int)>::passed);
static_assert(detail::RingsCheck<Bell>::passed && detail::RingsCheck<BellThatChimes>::passed &&
              detail::RingsCheck<FinalBell>::passed);

struct OfAnotherResult {
  double ring(int) const { return 1; }
};
struct OfAnotherArgument {
  int ring(const Silent&) const { return 1; }
};
struct NotConst {
  int ring(int) { return 1; }
};
struct Overloaded {
  int ring(int) { return 1; }
  int ring(const Silent&) const { return 1; }
};
struct Generic {
  template <class T>
  int ring(T) {
    return 1;
  }
};
struct Data {
  int ring = 1;
};
struct Chimes {
  int chime(int) const { return 1; }
};
struct ChimesFinally final : Chimes {};
static_assert(!detail::RingsOrAbsent<OfAnotherResult> && !detail::RingsOrAbsent<OfAnotherArgument> &&
              !detail::RingsOrAbsent<NotConst>);
static_assert(!detail::RingsOrAbsent<Overloaded> && !detail::RingsOrAbsent<Generic> && !detail::RingsOrAbsent<Data>);
static_assert(!detail::RingsOrAbsent<Chimes> && !detail::RingsOrAbsent<ChimesFinally>);

class Private {
  [[maybe_unused]] int ring() const { return 1; }
  [[maybe_unused]] int chime(int) const { return 1; }
};
struct ChimesAlone {
  int chime() const { return 1; }
};
static_assert(detail::RingsOrAbsent<Private> && detail::RingsOrAbsent<ChimesAlone>, "neither could be meant");

struct IsLoud {
  static constexpr bool loud = true;
};
struct Number {
  static constexpr int loud = 1;
};
struct Noisy {
  bool noisy = true;
};
struct Function {
  bool loud() const { return true; }
};
struct OtherFunction {
  bool noisy() const { return true; }
};
static_assert(detail::LoudCheck<IsLoud>::passed && detail::LoudCheck<Silent>::passed &&
              detail::LoudCheck<OtherFunction>::passed);
static_assert(!detail::LoudOrAbsent<Number> && !detail::LoudOrAbsent<Noisy> && !detail::LoudOrAbsent<Function>);

}  // namespace

TEST_CASE("members of the right form are called") {
  CHECK(Bell{}.ring(2) == 2);
  CHECK(FinalBell{}.ring(3) == 3);
}
