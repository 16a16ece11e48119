// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/base/simd.hpp>

#include <array>
#include <cstddef>
#include <cstdint>

#include <doctest/doctest.h>

using namespace pulsecast;

namespace {
std::array<double, simd::lane_count + 1> counted() {
  std::array<double, simd::lane_count + 1> numbers{};
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<double>(i);
  return numbers;
}
}  // namespace

TEST_CASE("lanes are loaded from and stored to memory of any alignment, in order") {
  auto numbers = counted();
  const simd::Doubles lanes = simd::load<simd::Doubles>(numbers[1]);
  for (std::size_t i = 0; i < simd::lane_count; ++i) CHECK(lanes[i] == static_cast<double>(i + 1));
  simd::store(lanes + 10.0, numbers[0]);
  for (std::size_t i = 0; i < simd::lane_count; ++i) CHECK(numbers[i] == static_cast<double>(i + 11));
  CHECK(numbers[simd::lane_count] == static_cast<double>(simd::lane_count));  // what lies behind is left alone
}

TEST_CASE("a comparison chooses by lane") {
  const auto numbers = counted();
  const simd::Doubles lanes = simd::load<simd::Doubles>(numbers[0]);
  const simd::Mask first = lanes < 1.0;
  const simd::Doubles chosen = first ? lanes - 5.0 : lanes;
  CHECK(chosen[0] == -5);
  for (std::size_t i = 1; i < simd::lane_count; ++i) CHECK(chosen[i] == static_cast<double>(i));
}

TEST_CASE("the bits of a mask are the lanes where it holds") {
  CHECK(simd::bits(simd::Mask{}) == 0);
  for (std::size_t i = 0; i < simd::lane_count; ++i) {
    simd::Mask mask{};
    mask[i] = -1;
    CHECK(simd::bits(mask) == 1U << i);
  }
}

TEST_CASE("lanes of identities compare as unsigned numbers") {
  const simd::Ids none = simd::Ids{} + ~std::uint64_t{0}, small = simd::Ids{} + std::uint64_t{7};
  CHECK(simd::bits(small < none) == (1U << simd::lane_count) - 1);
  CHECK(simd::bits(none < small) == 0);
}

TEST_CASE_TEMPLATE("packets of either precision divide eight numbers", Real, float, double) {
  const std::array<Real, 9> numbers{0, 1, 2, 3, 4, 5, 6, 7, 8};
  static_assert(8 % simd::packet_size<Real> == 0);
  unsigned above = 0;
  for (std::size_t first = 0; first < 8; first += simd::packet_size<Real>) {
    const auto packet = simd::load<simd::Packet<Real>>(numbers[first + 1]);
    for (std::size_t i = 0; i < simd::packet_size<Real>; ++i) CHECK(packet[i] == Real(first + i + 1));
    above |= simd::bits(packet > Real(2)) << first;
  }
  CHECK(above == 0b11111100);
}

TEST_CASE("the sum, the least and the greatest of all lanes") {
  const auto numbers = counted();
  const simd::Doubles lanes = simd::load<simd::Doubles>(numbers[1]);
  constexpr double n = simd::lane_count;
  double sum = 7;
  simd::add_lanes(sum, lanes);
  CHECK(sum == 7 + n * (n + 1) / 2);
  CHECK(simd::min(lanes) == 1);
  CHECK(simd::max(lanes) == n);
  CHECK(simd::min(-lanes) == -n);
}
