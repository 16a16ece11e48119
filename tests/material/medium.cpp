// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/material/medium.hpp>

#include <doctest/doctest.h>

using namespace pulsecast;

TEST_CASE("two media at one place add up, and keep the index of the first") {
  const Medium fog{.index = 1.3, .absorption = 1, .scattering = 2, .backscatter = 0.1};
  const Medium both = fog.with({.absorption = 3, .scattering = 4, .backscatter = 0.2});
  CHECK(both.index == 1.3);
  CHECK(both.extinction() == 10);
  CHECK(both.backscatter == doctest::Approx(0.3));
}

TEST_CASE("light is as late as its index says, unless there is one of its own for pulses") {
  CHECK(Medium{.index = 1.33}.delay() == 1.33);
  CHECK(Medium{.index = 1.33, .group_index = 1.36}.delay() == 1.36);
}

TEST_CASE("a medium that cannot be is refused") {
  CHECK_NOTHROW(Medium{.index = 4, .group_index = 1, .absorption = 0, .scattering = 1, .backscatter = 1}.validate());
  CHECK_THROWS_WITH_AS(Medium{.index = 0.99}.validate(), "Medium::index is 0.99, but must be from 1 to 4",
                       SettingError);
  CHECK_THROWS_AS((Medium{.group_index = 0.5}.validate()), SettingError);
  CHECK_THROWS_AS((Medium{.absorption = -1}.validate()), SettingError);
  CHECK_THROWS_AS((Medium{.scattering = -1}.validate()), SettingError);
  CHECK_THROWS_AS((Medium{.scattering = 0.1, .backscatter = 0.2}.validate()), SettingError);
}
