// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/detail/las/reference.hpp>

#include <array>
#include <string>

#include <doctest/doctest.h>

namespace pulsecast::io {
namespace {

TEST_CASE("zones of UTM are known, their neighbours in the register are not") {
  for (const unsigned epsg : {32601U, 32660U, 32701U, 32760U, 25828U, 25838U, 26901U, 26923U}) {
    CAPTURE(epsg);
    CHECK(detail::las_utm(static_cast<std::uint16_t>(epsg)).find("AUTHORITY[\"EPSG\",\"" + std::to_string(epsg) + "\"]") !=
          std::string::npos);
  }
  for (const unsigned epsg : {0U, 2056U, 32600U, 32661U, 32700U, 32761U, 25827U, 25839U, 26900U, 26924U})
    CHECK(detail::las_utm(static_cast<std::uint16_t>(epsg)).empty());
}

TEST_CASE("GeoTIFF keys say projected, the code, and metres") {
  CHECK(detail::las_geo_keys(2056) == std::array<std::uint16_t, 16>{1, 1, 0, 3, 1024, 0, 1, 1, 3072, 0, 1, 2056, 3076, 0, 1, 9001});
}

}  // namespace
}  // namespace pulsecast::io
