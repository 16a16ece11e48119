// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_BASE_OPTIONAL_MEMBER_HPP
#define PULSECAST_BASE_OPTIONAL_MEMBER_HPP

/// Defines `detail::ModelCheck<T>` for a refinement concept `Model` of one optional member `name`. Its `passed`
/// refuses, by a static assertion that quotes `form`, a type with an accessible member of that name in another form, or
/// with a member under one of four near names that takes the arguments `call`. For constants `call` is empty. A member
/// of a near name is allowed beside one of the right form.
#define PULSECAST_OPTIONAL_MEMBER(Model, form, name, call, near_1, near_2, near_3, near_4)                    \
  namespace detail {                                                                                          \
  template <class T>                                                                                          \
  concept Model##OrAbsent =                                                                                   \
      Model<T> || !(                                                                                          \
                      requires { &T::name; } || requires(T & t) { t.name call; } ||                           \
                      requires(T & t) { t.near_1 call; } || requires(T & t) { t.near_2 call; } ||             \
                      requires(T & t) { t.near_3 call; } || requires(T & t) { t.near_4 call; });              \
  template <class T>                                                                                          \
  struct Model##Check {                                                                                       \
    static_assert(Model##OrAbsent<T>, "an optional member has another name or form here; it must be: " form); \
    static constexpr bool passed = true;                                                                      \
  };                                                                                                          \
  }

#endif
