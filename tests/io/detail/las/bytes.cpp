// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/detail/las/bytes.hpp>

#include <limits>
#include <string>

#include <doctest/doctest.h>

namespace pulsecast::io {
namespace {

TEST_CASE("the header of a record is 54 bytes, the lowest of each number first") {
  const auto h = detail::las_vlr_header("LASF_Spec", 0x0164, 0xFE1A, "Waveform Packet Descriptor");
  std::string expected("\0\0LASF_Spec", 11);
  expected.resize(18);
  expected += "\x64\x01\x1A\xFE";
  expected += "Waveform Packet Descriptor";
  expected.resize(54);
  CHECK(std::string(reinterpret_cast<const char*>(h.data()), h.size()) == expected);
}

TEST_CASE("numbers are rounded to nearest and cut, and what is not a number is the least") {
  CHECK(detail::las_rounded<std::uint16_t>(2.6, 0, 65535) == 3);
  CHECK(detail::las_rounded<std::uint16_t>(65535.4, 0, 65535) == 65535);
  CHECK(detail::las_rounded<std::uint16_t>(1e300, 0, 65535) == 65535);
  CHECK(detail::las_rounded<std::int16_t>(-30001, -30000, 30000) == -30000);
  CHECK(detail::las_rounded<std::int8_t>(std::numeric_limits<double>::quiet_NaN(), -90, 90) == -90);
}

}  // namespace
}  // namespace pulsecast::io
