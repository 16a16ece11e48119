// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/detail/las/encoder.hpp>

#include <cmath>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "support/generators.hpp"

namespace pulsecast::io::detail {
namespace {

template <class Number>
Number number(const std::byte* bytes, std::size_t at) {
  Number value{};
  std::memcpy(&value, bytes + at, sizeof value);
  return value;
}

TEST_CASE("tallies of parts add up to that of the whole, in any order") {
  support::Generator random(3);
  LasEncoder whole({}), a({}), b({}), c({});
  const LasTally nothing;
  for (int i = 0; i < 300; ++i) {
    const Vec3 point{random.uniform() * 1000 - 500, random.uniform() * 10, -random.uniform()};
    std::vector<Echo> echoes;
    for (int n = 0; n <= i % 4; ++n)
      echoes.push_back({.amplitude = random.log_uniform(1e-9, 1e-6), .number = static_cast<std::uint8_t>(n + 1)});
    const Shot shot{.origin = point, .echoes = static_cast<std::uint32_t>(echoes.size())};
    for (LasEncoder* encoder : {&whole, i % 3 == 0 ? &a : i % 3 == 1 ? &b : &c})
      encoder->encode(shot, {{}, echoes, {}, 0}, nullptr,
                      [&](LasEncoder::Record& record, const Vec3& at) { CHECK(encoder->locate(record.data(), at)); });
  }
  LasTally sum = c.tally();
  sum.add(nothing);
  sum.add(a.tally());
  sum.add(b.tally());
  CHECK(sum.least == whole.tally().least);
  CHECK(sum.most == whole.tally().most);
  CHECK(sum.points == 750);
  CHECK(sum.points_by_return[0] == 300);
  CHECK(sum.points_by_return[3] == 75);
  CHECK(sum.points_by_return == whole.tally().points_by_return);
  CHECK(sum.max_amplitude == whole.tally().max_amplitude);
}

TEST_CASE("points are located against an offset that comes later") {
  LasEncoder encoder({});
  const std::vector<Echo> echoes{{.range = 2}};
  std::vector<std::byte> bytes;
  Vec3 place{};
  encoder.encode({.origin = {1234567, 10, 0}, .direction = {0, 0, -1}, .echoes = 1}, {{}, echoes, {}, 0}, nullptr,
                 [&](const LasEncoder::Record& record, const Vec3& at) {
                   bytes.assign(record.begin(), record.end());
                   place = at;
                 });
  CHECK(!encoder.locate(bytes.data(), place));
  CHECK(encoder.misfit(place).find("x is 1234567 m") == 0);
  CHECK(encoder.misfit({0, -1234567, 0}).find("y is -1234567 m") == 0);
  CHECK(encoder.misfit({0, 0, 1234567}).find("z is 1234567 m") == 0);
  encoder.choose_offset({1234549, 0, 0});
  CHECK(encoder.offset() == Vec3{1234500, 0, 0});
  LasEncoder beside({});
  beside.choose_offset({-1e-4, 49, -49});
  CHECK(beside.offset() == Vec3{});
  for (int axis = 0; axis < 3; ++axis) CHECK(!std::signbit(beside.offset()[axis]));  // readers would show -0
  REQUIRE(encoder.locate(bytes.data(), place));
  CHECK(number<std::int32_t>(bytes.data(), 0) == 670'000);
  CHECK(number<std::int32_t>(bytes.data(), 4) == 100'000);
  CHECK(number<std::int32_t>(bytes.data(), 8) == -20'000);
  CHECK(encoder.tally().points == 1);
  LasEncoder given({.offset = Vec3{1, 2, 3}});
  given.choose_offset({1e6, 0, 0});
  CHECK(given.offset() == Vec3{1, 2, 3});
}

TEST_CASE("the level of less than 1e-20 is that of nothing") {
  CHECK(level_of(1) == 0);
  CHECK(level_of(100) == 20);
  for (const double ratio : {1e-20, 1e-25, 0.0, -1.0}) CHECK(level_of(ratio) == -200);
}

TEST_CASE("packets are moved, and where there is none, nothing is") {
  const LasEncoder encoder({.waveforms = true});
  const std::size_t size = encoder.layout().record(), packet = encoder.layout().packet;
  std::vector<std::byte> bytes(2 * size);
  bytes[packet] = std::byte{9};
  const std::uint64_t before = 1000;
  std::memcpy(bytes.data() + packet + 1, &before, sizeof before);
  encoder.move_packets(bytes, 60);
  CHECK(number<std::uint64_t>(bytes.data(), packet + 1) == 1060);
  CHECK(number<std::uint64_t>(bytes.data(), size + packet + 1) == 0);
}

}  // namespace
}  // namespace pulsecast::io::detail
