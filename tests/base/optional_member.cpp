// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/base/optional_member.hpp>

#include <concepts>

#include <doctest/doctest.h>

namespace PULSECAST_NAMESPACE {

template <class T>
concept Rings = requires(const T& t) {
  { t.ring(1) } -> std::same_as<int>;
};
template <class T>
concept RingsAloud = requires(const T& t) {
  { t.ring() } -> std::same_as<int>;
};
PULSECAST_OPTIONAL_MEMBER(Rings, "int ring(int) const", ring, (1))
PULSECAST_OPTIONAL_MEMBER(RingsAloud, "int ring() const", ring, (), &&!pulsecast::Rings<T>)

PULSECAST_OPTIONAL_CONSTANT(Loud, loud)

namespace {

using detail::members_checked;
using detail::promise_kept;
template <class T>
constexpr bool rings_right = tag::Rings::right<T>;
template <class T>
constexpr bool aloud_right = tag::RingsAloud::right<T>;
template <class T>
constexpr bool loud_right = tag::Loud::right<T>;

struct Silent {
  void play() const {}
};
struct Bell {
  int ring(int times) const { return times; }
};
struct FinalBell final : Bell {};
static_assert(members_checked<Silent, tag::Rings> && members_checked<int, tag::Rings> &&
              members_checked<void (*)(int), tag::Rings>);
static_assert(members_checked<Bell, tag::Rings> && members_checked<FinalBell, tag::Rings>);

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
struct OfAnotherResultFinally final : OfAnotherResult {};
static_assert(!rings_right<OfAnotherResult> && !rings_right<OfAnotherArgument> && !rings_right<NotConst>);
static_assert(!rings_right<Overloaded> && !rings_right<Generic> && !rings_right<Data>);
static_assert(!rings_right<OfAnotherResultFinally>);

class Private {
  [[maybe_unused]] double ring(int) const { return 1; }
};
struct NearNames {
  int rings = 0;
  void rang(int) {}
  bool is_ringing() const { return true; }
};
static_assert(rings_right<Private> && rings_right<NearNames>, "neither could be meant");

struct BothBells : Bell {
  using Bell::ring;
  double ring() const { return 1; }
};
static_assert(aloud_right<Bell>, "its `ring` has another purpose");
static_assert(rings_right<BothBells> && !aloud_right<BothBells> && !aloud_right<OfAnotherArgument>);

struct IsLoud {
  static constexpr bool loud = true;
};
struct IsNotLoud {
  static constexpr bool loud = false;
};
struct Number {
  static constexpr int loud = 1;
};
struct Variable {
  [[maybe_unused]] static inline bool loud = true;
};
struct PerObject {
  const bool loud = true;
};
struct Function {
  bool loud() const { return true; }
};
struct StaticFunction {
  static constexpr bool loud() { return true; }
};
static_assert(Loud<IsLoud> && !Loud<IsNotLoud> && !Loud<Number> && !Loud<Variable> && !Loud<PerObject>);
static_assert(!Loud<Function> && !Loud<StaticFunction> && !Loud<Silent> && !Loud<int>);
static_assert(loud_right<IsLoud> && loud_right<IsNotLoud> && loud_right<Silent>);
static_assert(!loud_right<Number> && !loud_right<Variable> && !loud_right<PerObject> && !loud_right<Function> &&
              !loud_right<StaticFunction>);

// Broken promises are in tests/compile_fail/misspelt_members.cpp.
struct Promising : Bell, IsLoud {
  using refinements = refines<tag::Rings, tag::Loud>;
};
struct PromisingNothing {
  using refinements = refines<>;
};
static_assert(promise_kept<Promising> && promise_kept<PromisingNothing> && promise_kept<Silent> && promise_kept<int>);

}  // namespace

TEST_CASE("members of the right form are called") {
  CHECK(Bell{}.ring(2) == 2);
  CHECK(FinalBell{}.ring(3) == 3);
}

}  // namespace PULSECAST_NAMESPACE
