// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/shape/packed_heights.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

using namespace pulsecast;
using pulsecast::detail::PixelHeights;

namespace {

std::string refusal(const PackedHeights& packed) {
  try {
    packed.validate();
    return {};
  } catch (const SettingError& error) {
    return error.what();
  }
}

/// Heights that the numbers of a raster give, in the order of pixels.
std::vector<float> heights_of(const PackedHeights& packed) {
  const PixelHeights pixels({}, packed);
  CHECK(pixels.is_consistent(packed.numbers.size()));
  return pixels.read([&](const auto& at) {
    std::vector<float> all;
    for (std::size_t i = 0; i < packed.numbers.size(); ++i) all.push_back(at[i]);
    return all;
  });
}

}  // namespace

TEST_CASE("the height of a number is offset and scale times the steps from zero") {
  const PackedHeights plain{.numbers = {0, 1, 65535}};
  CHECK(heights_of(plain) == std::vector<float>{0, 1, 65535});
  const PackedHeights scaled{.numbers = {100, 104, 96}, .scale = 0.25, .offset = 1000, .zero = 100};
  CHECK(heights_of(scaled) == std::vector<float>{1000, 1001, 999});
  const PackedHeights both_signs{.numbers = {0, 32768, 65535}, .scale = 0.1, .zero = 32768};
  CHECK(heights_of(both_signs) ==
        std::vector<float>{static_cast<float>(-32768 * 0.1), 0, static_cast<float>(32767 * 0.1)});
}

TEST_CASE("missing numbers are missing below, among, above and in place of the others") {
  for (const std::uint16_t missing : std::vector<std::uint16_t>{0, 499, 500, 501, 510, 520, 521, 65535}) {
    CAPTURE(missing);
    PackedHeights packed{.numbers = {500, 520, missing, 505, missing}, .missing = missing};
    const std::vector<float> heights = heights_of(packed);
    for (std::size_t i = 0; i < 5; ++i) {
      if (packed.numbers[i] == missing)
        CHECK(std::isnan(heights[i]));
      else
        CHECK(heights[i] == packed.numbers[i]);
    }
  }
  PackedHeights all;
  for (std::uint32_t n = 0; n < 65536; ++n) all.numbers.push_back(static_cast<std::uint16_t>(n));
  for (const std::uint16_t missing : std::vector<std::uint16_t>{0, 7, 65535}) {
    all.missing = missing;
    const std::vector<float> heights = heights_of(all);
    for (std::uint32_t n = 0; n < 65536; ++n)
      if (n == missing ? !std::isnan(heights[n]) : heights[n] != static_cast<float>(n)) FAIL("number " << n);
  }
  for (const float height : heights_of({.numbers = {3, 3}, .missing = 3})) CHECK(std::isnan(height));
}

TEST_CASE("a table is as long as the range of the numbers, and one more for missing ones") {
  CHECK(PixelHeights({}, {.numbers = {40'000, 40'009}}).memory() == 2 * 2 + 10 * 4);
  CHECK(PixelHeights({}, {.numbers = {40'000, 40'009, 0}, .missing = 0}).memory() == 3 * 2 + 11 * 4);
  CHECK(PixelHeights({1, 2, 3}, {}).memory() == 3 * 4);
}

TEST_CASE("scales that cannot be are refused") {
  CHECK(refusal({}) == "");
  CHECK(refusal({.scale = -1}).find("PackedHeights::scale is -1 m") == 0);
  CHECK(refusal({.scale = std::numeric_limits<double>::quiet_NaN()}).find("PackedHeights::scale is nan m") == 0);
  CHECK(refusal({.offset = 2e15}).find("PackedHeights::offset is 2e+15 m") == 0);
  CHECK(refusal({.scale = 1e12}).find("PackedHeights::scale (height of 65,535 steps) is 6.5535e+16 m") == 0);
}
