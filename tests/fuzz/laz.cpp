// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <cstdint>

#include <pulsecast/io/detail/las/points.hpp>

#include "fuzz/fuzz.hpp"

using namespace pulsecast;
using namespace pulsecast::io;

FUZZ_TARGET(laz) {
  const std::filesystem::path path = fuzz::file(data, size, "cloud.laz");
  for (const LasWants& wants : {LasWants{}, LasWants{.colours = false, .objects = false}})
    fuzz::may_refuse([&] {
      LasPoints points(InputFile(path, "a point cloud"), wants);
      std::uint32_t sum = 0;
      for (int i = 0; i < 1000000 && points.next(); ++i) {
        fuzz::expect(std::isfinite(points.position().x) && points.classification() <= 255);
        if (points.has_colours()) fuzz::expect(points.colour().x <= LasPoints::max_colour);
        if (points.has_object()) sum += points.object();
      }
      static_cast<void>(sum);
      static_cast<void>(points.warnings());
    });
}
