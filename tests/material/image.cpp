// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/material/image.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/base/error.hpp>

#include "support/refused_field.hpp"

using namespace pulsecast;
using pulsecast::support::refused_field;

namespace {

/// Picture of so many pixels, whose samples count up from 0.
Image counting_image(std::uint32_t width, std::uint32_t height, std::uint32_t channels) {
  std::vector<std::uint8_t> samples(std::size_t{width} * height * channels);
  for (std::size_t i = 0; i < samples.size(); ++i) samples[i] = static_cast<std::uint8_t>(i);
  return {width, height, channels, samples};
}

}  // namespace

TEST_CASE("the middle of each pixel has its number, counted from the top left") {
  constexpr std::uint32_t width = 5, height = 3;
  for (std::uint32_t row = 0; row < height; ++row)
    for (std::uint32_t column = 0; column < width; ++column)
      CHECK(texel_at(width, height, {(column + 0.5) / width, 1 - (row + 0.5) / height}) == row * width + column);
}

TEST_CASE(
    "texture coordinates on a border belong to the pixel to the right and above, and a whole number begins the next "
    "picture") {
  CHECK(texel_at(4, 2, {0, 0}) == 4);     // the lower left pixel
  CHECK(texel_at(4, 2, {0.25, 0}) == 5);  // its right border
  CHECK(texel_at(4, 2, {0, 0.5}) == 0);   // its upper one
  CHECK(texel_at(4, 2, {1, 1}) == 4);     // of the next picture
  CHECK(texel_at(4, 2, {7, -3}) == 4);    // of one further away
  CHECK(texel_at(4, 2, {0.75, 1.5}) == 3);
}

TEST_CASE("negative texture coordinates repeat the picture") {
  CHECK(texel_at(4, 2, {-0.1, 0.1}) == 7);
  CHECK(texel_at(4, 2, {0.1, -0.1}) == 0);
  std::mt19937_64 random(1);
  std::uniform_int_distribution<int> eighth(0, 7), turns(-1000, 1000);
  for (int n = 0; n < 1000; ++n) {  // eighths and whole numbers have exact sums
    const Vec2 at((eighth(random) + 0.5) / 8, (eighth(random) + 0.5) / 8), away(turns(random), turns(random));
    CAPTURE(n);
    CHECK(texel_at(8, 8, at + away) == texel_at(8, 8, at));
  }
}

TEST_CASE("texture coordinates just below a whole number are of the last pixel, and none is beyond the picture") {
  const double below_one = std::nextafter(1.0, 0.0), below_zero = std::nextafter(0.0, -1.0);
  REQUIRE(below_zero - std::floor(below_zero) == 1);  // the fraction rounds up
  for (const double edge : {below_one, below_zero, -1e-20}) {
    CHECK(texel_at(4, 2, {edge, 0.1}) == 7);
    CHECK(texel_at(4, 2, {0.1, edge}) == 0);
    CHECK(texel_at(65536, 65536, {edge, edge}) == 65535);
  }
  for (const double far : {1e15 + 0.5, -1e15 - 0.5, 1e30, -1e30}) CHECK(texel_at(3, 7, {far, far}) < 21);
}

TEST_CASE("a picture of one pixel is the same everywhere") {
  const Image image{1, 1, 3, std::vector<std::uint8_t>{255, 51, 0}};
  for (const Vec2 at :
       {Vec2(0, 0), Vec2(1, 1), Vec2(-0.3, 12.7), Vec2(std::nextafter(0.0, -1.0), std::nextafter(1.0, 0.0))}) {
    CHECK(texel_at(1, 1, at) == 0);
    CHECK(image.colour(at) == Vec3(1, 51 / 255.0, 0));
  }
}

TEST_CASE("channels are those of the pixel; grey pictures have their grey as each colour, and opacity is no colour") {
  const std::array<std::array<double, 3>, 4> lower_right{{{3, 3, 3}, {6, 6, 6}, {9, 10, 11}, {12, 13, 14}}};
  for (std::uint32_t channels = 1; channels <= 4; ++channels) {
    CAPTURE(channels);
    const Image image = counting_image(2, 2, channels);
    const Vec2 at(0.9, 0.1);
    REQUIRE(image.at(at).size() == channels);
    for (std::uint32_t k = 0; k < channels; ++k) CHECK(image.at(at)[k] == 3 * channels + k);
    const auto& expected = lower_right[channels - 1];
    CHECK(image.colour(at) == Vec3(expected[0] / 255, expected[1] / 255, expected[2] / 255));
    CHECK(image.has_opacity() == (channels % 2 == 0));
  }
}

TEST_CASE("a picture without pixels, of another number of channels or of samples is refused") {
  CHECK_NOTHROW(counting_image(2, 3, 4).validate());
  const auto refused = [](const Image& image) { return refused_field([&] { image.validate(); }); };
  CHECK(refused({0, 3, 1, {}}) == "Image::width");
  CHECK(refused({3, 0, 1, {}}) == "Image::height");
  CHECK(refused({65537, 1, 1, std::vector<std::uint8_t>(65537)}) == "Image::width");
  CHECK(refused({1, 1, 0, {}}) == "Image::channels");
  CHECK(refused({1, 1, 5, std::vector<std::uint8_t>(5)}) == "Image::channels");
  CHECK(refused({2, 2, 3, std::vector<std::uint8_t>(11)}) == "Image::samples (number)");
}
