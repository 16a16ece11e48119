// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/detail/laz/point.hpp>

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include <doctest/doctest.h>

namespace pulsecast::io::detail {
namespace {

TEST_CASE("a point's numbers are where point format 6 has them") {
  std::array<std::byte, laz_point_size> record{};
  for (std::size_t i = 0; i < record.size(); ++i) record[i] = static_cast<std::byte>(0xA0 + i);
  record[14] = std::byte{0xF3};  // return 3 of 15
  record[15] = std::byte{0xB5};  // edge of flight line; channel 3; flags of the class 5
  const LazPoint p(record.data());
  CHECK(p.x == std::bit_cast<std::int32_t>(0xA3A2A1A0U));
  CHECK(p.y == std::bit_cast<std::int32_t>(0xA7A6A5A4U));
  CHECK(p.z == std::bit_cast<std::int32_t>(0xABAAA9A8U));
  CHECK(p.intensity == 0xADAC);
  CHECK(p.number == 3);
  CHECK(p.returns == 15);
  CHECK(p.flags == 0x25);
  CHECK(p.channel == 3);
  CHECK(p.classification == 0xB0);
  CHECK(p.user == 0xB1);
  CHECK(p.angle == std::bit_cast<std::int16_t>(std::uint16_t{0xB3B2}));
  CHECK(p.source == 0xB5B4);
  CHECK(p.time == std::bit_cast<std::int64_t>(0xBDBCBBBAB9B8B7B6U));
  record[15] = std::byte{0x40};  // scan direction
  CHECK(LazPoint(record.data()).flags == 0x10);
}

TEST_CASE("a return is the first, the last, the only one, or none of these") {
  const auto point = [](std::uint8_t number, std::uint8_t returns) {
    LazPoint p;
    p.number = number;
    p.returns = returns;
    return p;
  };
  CHECK((point(1, 1).first() && point(1, 1).last() && point(1, 1).only()));
  CHECK((point(1, 3).first() && !point(1, 3).last() && !point(1, 3).only()));
  CHECK((!point(2, 3).first() && !point(2, 3).last()));
  CHECK((!point(3, 3).first() && point(3, 3).last()));
  CHECK(point(4, 3).last());
}

}  // namespace
}  // namespace pulsecast::io::detail
