// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/ascii_grid.hpp>

#include "fuzz/fuzz.hpp"

using namespace pulsecast;
using namespace pulsecast::io;

FUZZ_TARGET(ascii_grid) {
  const std::filesystem::path path = fuzz::file(data, size, "terrain.asc");
  for (const AsciiGridSettings& settings :
       {AsciiGridSettings{}, AsciiGridSettings{.vertical_scale = 0.1, .missing = 0}})
    fuzz::may_refuse([&] {
      const AsciiGrid file = read_ascii_grid(path, settings);
      file.raster.validate();
      fuzz::expect(file.raster.heights.capacity() <= size / 2 + 1);
    });
}
