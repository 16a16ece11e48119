// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <cstring>
#include <vector>

#include <pulsecast/io/geotiff.hpp>

#include "fuzz/fuzz.hpp"

using namespace pulsecast;
using namespace pulsecast::io;

FUZZ_TARGET(geotiff) {
  const std::filesystem::path path = fuzz::file(data, size, "terrain.tif");
  for (GeoTiffSettings settings : {GeoTiffSettings{}, GeoTiffSettings{.band = 2, .vertical_scale = 0.1, .missing = 0}})
    fuzz::may_refuse([&] {
      const GeoTiff file = read_geotiff(path, settings);
      file.raster.validate();
      fuzz::expect(file.raster.heights.size() * sizeof(float) <= (std::size_t{1} << 26) + 4096 * size);
      for (const Vec3& colour : file.colours)
        for (const double channel : {colour.x, colour.y, colour.z}) fuzz::expect(channel >= 0 && channel <= 1);
      settings.packed = true;  // the same heights
      const std::vector<float> again = read_geotiff(path, settings).raster.unpacked().heights;
      const auto& heights = file.raster.heights;
      fuzz::expect(again.size() == heights.size() &&
                   std::memcmp(again.data(), heights.data(), sizeof(float) * again.size()) == 0);
    });
}
