// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/colour.hpp>

#include <limits>

#include <doctest/doctest.h>

using namespace pulsecast;
using namespace pulsecast::io;

TEST_CASE("every byte of a screen's colour comes back from light") {
  for (int v = 0; v < 256; ++v) {
    const auto byte = static_cast<std::uint8_t>(v);
    const Srgb bytes{byte, static_cast<std::uint8_t>(255 - v), 128};
    CHECK(to_srgb(from_srgb(bytes)) == bytes);
  }
}

TEST_CASE("black is no light, white is one, and middle grey is a fifth") {
  CHECK(from_srgb({0, 0, 0}) == Colour{0, 0, 0});
  CHECK(from_srgb({255, 255, 255}) == Colour{1, 1, 1});
  CHECK(from_srgb({119, 119, 119}).y == doctest::Approx(0.184).epsilon(0.005));  // L* = 50, CIE 1976
}

TEST_CASE("what a screen cannot show becomes the nearest that it can") {
  CHECK(to_srgb({-1, 0.5, 7}) == Srgb{0, 188, 255});
}

TEST_CASE("a scale runs through its entries and stays at its ends") {
  CHECK(to_srgb(along(viridis, 0)) == viridis.front());
  CHECK(to_srgb(along(viridis, 0.5)) == viridis[4]);
  CHECK(to_srgb(along(viridis, 1)) == viridis.back());
  CHECK(along(viridis, -3) == along(viridis, 0));
  CHECK(along(viridis, 3) == along(viridis, 1));
  CHECK(along(viridis, std::numeric_limits<double>::quiet_NaN()) == along(viridis, 0));
}

TEST_CASE("the scales grow lighter all the way") {
  const auto luminance = [](const Colour& c) {
    return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z;
  };  // source: IEC 61966-2-1
  for (int k = 0; k < 100; ++k) {
    CAPTURE(k);
    CHECK(luminance(along(viridis, (k + 1) / 100.0)) > luminance(along(viridis, k / 100.0)));
    CHECK(luminance(along(greys, (k + 1) / 100.0)) > luminance(along(greys, k / 100.0)));
  }
}

TEST_CASE("hues differ, and a screen can show all of them but for a little") {
  for (int k = 0; k < 12; ++k) {
    CAPTURE(k);
    const Colour c = of_hue(k / 12.0);
    for (int channel = 0; channel < 3; ++channel) {
      CHECK(c[channel] > -0.035);
      CHECK(c[channel] < 1);
    }
    for (int other = 0; other < k; ++other) CHECK(length(c - of_hue(other / 12.0)) > 0.05);
  }
  CHECK(length(of_hue(0) - of_hue(1)) < 1e-12);
}
