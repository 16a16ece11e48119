// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/spatial_reference.hpp>

#include <doctest/doctest.h>

namespace pulsecast::io {
namespace {

TEST_CASE("a reference is unknown and in metres, until a file tells another") {
  const SpatialReference unknown;
  CHECK(unknown.epsg == 0);
  CHECK(unknown.unit == 1);
  CHECK(unknown.vertical_unit == 1);
  CHECK_FALSE(unknown == SpatialReference{.epsg = 25832});
}

}  // namespace
}  // namespace pulsecast::io
