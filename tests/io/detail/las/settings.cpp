// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/detail/las/settings.hpp>

#include <doctest/doctest.h>

namespace pulsecast::io {
namespace {

TEST_CASE("version 1.0 has no waveforms, any other has") {
  CHECK_THROWS_WITH_AS((LasSettings{.format = LasFormat::las_1_0, .waveforms = true}.validate()),
                       doctest::Contains("must be false for version 1.0"), SettingError);
  CHECK_NOTHROW((LasSettings{.format = LasFormat::las_1_0}.validate()));
  CHECK_NOTHROW((LasSettings{.format = LasFormat::las_1_4_legacy, .waveforms = true}.validate()));
  CHECK_NOTHROW((LasSettings{.waveforms = true}.validate()));
}

TEST_CASE("the full scale of intensities is positive, in the unit of what they are, or left to the writer") {
  CHECK_NOTHROW((LasSettings{.intensity = LasIntensity::amplitude}.validate()));
  CHECK_NOTHROW((LasSettings{.intensity = LasIntensity::amplitude, .intensity_full_scale = 1e-6}.validate()));
  CHECK_THROWS_WITH_AS((LasSettings{.intensity = LasIntensity::amplitude, .intensity_full_scale = -1}.validate()),
                       doctest::Contains("-1 W,"), SettingError);
  CHECK_THROWS_WITH_AS((LasSettings{.intensity_full_scale = 0}.validate()), doctest::Contains("is 0, but"),
                       SettingError);
}

}  // namespace
}  // namespace pulsecast::io
