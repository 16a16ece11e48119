// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/png_heights.hpp>

#include "fuzz/fuzz.hpp"

using namespace pulsecast;
using namespace pulsecast::io;

FUZZ_TARGET(png_heights) {
  const std::filesystem::path path = fuzz::file(data, size, "dem.png");
  const PngHeightSettings settings{.vertical_scale = 0.1, .missing = 0, .pixel = Vec2{1, 1}, .max_pixels = 1 << 20};
  fuzz::may_refuse([&] {
    const Raster raster = read_png_heights(path, settings);
    raster.validate();
    fuzz::expect(raster.pixels() <= settings.max_pixels);
  });
}
