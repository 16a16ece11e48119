// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_BASE_OPTIONAL_MEMBER_HPP
#define PULSECAST_BASE_OPTIONAL_MEMBER_HPP

#include <concepts>
#include <type_traits>

#include <pulsecast/base/namespace.hpp>

namespace PULSECAST_NAMESPACE {

/// Promise of a type to model refinements: a public member `using refinements =
/// pulsecast::refines<tag::Gated, tag::ForeseesOpening>;`. A missing one is an error.
template <class... Tags>
struct refines {
  /// True; refuses a type that breaks the promise.
  template <class T>
  static constexpr bool kept = (Tags::template checked<T, true>() && ...);
};

namespace detail {

template <class T>
concept PromisesRefinements = requires {
  typename T::refinements;
};
template <class T>
inline constexpr bool promise_kept = true;
template <PromisesRefinements T>
inline constexpr bool promise_kept<T> = T::refinements::template kept<T>;

/// True; refuses a type that breaks its promise, or has a member of a refinement in another form.
template <class T, class... Tags>
inline constexpr bool members_checked = promise_kept<T> && (Tags::template checked<T>() && ...);

}  // namespace detail
}  // namespace PULSECAST_NAMESPACE

/// Defines the tag of a refinement, the concept `Model` of one optional member `name`. A type has
/// the member if it is accessible, or callable with the arguments `call`. A last argument `&& ...`
/// excepts types `T` with a member of that name for another purpose.
#define PULSECAST_OPTIONAL_MEMBER(Model, form, name, call, ...)                                             \
  namespace tag {                                                                                           \
  struct Model {                                                                                            \
    template <class T>                                                                                      \
    static constexpr bool right =                                                                           \
        pulsecast::Model<T> || !(                                                                           \
                                   requires(T & t) { t.name call; } || requires { &T::name; } __VA_ARGS__); \
    template <class T, bool promised = false>                                                               \
    static consteval bool checked() {                                                                       \
      static_assert(right<T>, "optional member '" #name "' has another form here; it must be: " form);      \
      static_assert(pulsecast::Model<T> || !promised, "optional member '" #name                             \
                                                      "' is promised by `refinements`, but is "             \
                                                      "missing; it must be: " form);                        \
      return true;                                                                                          \
    }                                                                                                       \
  };                                                                                                        \
  }

/// Defines the concept `M` of types with a constant `static constexpr bool name = true`, and
/// its checks. A constant that is false is as one that is absent.
#define PULSECAST_OPTIONAL_CONSTANT(M, name)                                                     \
  template <class T>                                                                             \
  concept M = std::same_as<decltype(T::name), const bool> && std::bool_constant<T::name>::value; \
  PULSECAST_OPTIONAL_MEMBER(                                                                     \
      M, "static constexpr bool " #name " = true", name, (), &&!requires {                       \
        requires std::same_as<decltype(T::name), const bool>;                                    \
        typename std::bool_constant<T::name>;                                                    \
      })

#endif
