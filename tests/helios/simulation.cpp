// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/helios/simulation.hpp>

#include <type_traits>
#include <utility>

#include <doctest/doctest.h>

namespace pulsecast::helios {
namespace {

static_assert(std::is_abstract_v<Simulation> && std::has_virtual_destructor_v<Simulation>);
static_assert(std::is_same_v<decltype(std::declval<const Simulation&>().survey()), const AnySurvey&>);
static_assert(!std::is_copy_constructible_v<Simulation> && !std::is_copy_assignable_v<Simulation>);

TEST_CASE("receivers are those of the survey by default") {
  CHECK(ReceiverOverrides{} == ReceiverOverrides{.rings = {}, .bin_size = {}, .ideal = false});
  CHECK(ReceiverOverrides{} != ReceiverOverrides{.rings = 1});
}

}  // namespace
}  // namespace pulsecast::helios
