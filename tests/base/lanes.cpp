// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/base/lanes.hpp>

#include <array>
#include <cstddef>
#include <cstdint>

#include <doctest/doctest.h>

using namespace pulsecast;

namespace {
std::array<double, lane_count + 1> counted() {
  std::array<double, lane_count + 1> numbers{};
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<double>(i);
  return numbers;
}
}  // namespace

TEST_CASE("lanes are loaded from and stored to memory of any alignment, in order") {
  auto numbers = counted();
  const Lanes lanes = load<Lanes>(numbers[1]);
  for (std::size_t i = 0; i < lane_count; ++i) CHECK(lanes[i] == static_cast<double>(i + 1));
  store(lanes + 10.0, numbers[0]);
  for (std::size_t i = 0; i < lane_count; ++i) CHECK(numbers[i] == static_cast<double>(i + 11));
  CHECK(numbers[lane_count] == static_cast<double>(lane_count));  // what lies behind is left alone
}

TEST_CASE("a comparison chooses by lane") {
  const auto numbers = counted();
  const Lanes lanes = load<Lanes>(numbers[0]);
  const LaneMask first = lanes < 1.0;
  const Lanes chosen = first ? lanes - 5.0 : lanes;
  CHECK(chosen[0] == -5);
  for (std::size_t i = 1; i < lane_count; ++i) CHECK(chosen[i] == static_cast<double>(i));
}

TEST_CASE("the bits of a mask are the lanes where it holds") {
  CHECK(bits(LaneMask{}) == 0);
  for (std::size_t i = 0; i < lane_count; ++i) {
    LaneMask mask{};
    mask[i] = -1;
    CHECK(bits(mask) == 1U << i);
  }
}

TEST_CASE("lanes of identities compare as unsigned numbers") {
  const LaneIds none = LaneIds{} + ~std::uint64_t{0}, small = LaneIds{} + std::uint64_t{7};
  CHECK(bits(small < none) == (1U << lane_count) - 1);
  CHECK(bits(none < small) == 0);
}

TEST_CASE_TEMPLATE("packs of either precision divide eight numbers", Real, float, double) {
  const std::array<Real, 9> numbers{0, 1, 2, 3, 4, 5, 6, 7, 8};
  static_assert(8 % pack_count<Real> == 0);
  unsigned above = 0;
  for (std::size_t first = 0; first < 8; first += pack_count<Real>) {
    const auto pack = load<Pack<Real>>(numbers[first + 1]);
    for (std::size_t i = 0; i < pack_count<Real>; ++i) CHECK(pack[i] == Real(first + i + 1));
    above |= bits(pack > Real(2)) << first;
  }
  CHECK(above == 0b11111100);
}
