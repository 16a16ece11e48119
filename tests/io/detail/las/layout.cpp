// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/detail/las/layout.hpp>

#include <doctest/doctest.h>

namespace pulsecast::io {
namespace {

TEST_CASE("points have the formats and sizes of the specification, and the extra bytes stand behind") {
  struct Case {
    LasFormat file;
    bool waveforms;
    unsigned minor, format;
    std::size_t header, point;
  };
  for (const Case& c : {Case{LasFormat::las_1_4, false, 4, 6, 375, 30}, Case{LasFormat::las_1_4, true, 4, 9, 375, 59},
                        Case{LasFormat::las_1_4_legacy, false, 4, 1, 375, 28}, Case{LasFormat::las_1_4_legacy, true, 4, 4, 375, 57},
                        Case{LasFormat::las_1_0, false, 0, 1, 227, 28}}) {
    CAPTURE(c.point);
    const detail::LasLayout layout(c.file, c.waveforms);
    CHECK(layout.minor == c.minor);
    CHECK(layout.format == c.format);
    CHECK(layout.header == c.header);
    CHECK(layout.extras == c.point);
    CHECK(layout.record() == c.point + 32);
    CHECK(layout.legacy == (c.format < 6));
  }
}

}  // namespace
}  // namespace pulsecast::io
