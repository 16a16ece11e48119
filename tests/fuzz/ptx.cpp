// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/detail/ptx/points.hpp>

#include <pulsecast/io/point_cloud.hpp>

#include "fuzz/fuzz.hpp"

using namespace pulsecast;
using namespace pulsecast::io;

FUZZ_TARGET(ptx) {
  const std::filesystem::path path = fuzz::file(data, size, "a.ptx");
  fuzz::may_refuse([&] {
    PtxPoints points(InputFile(path, "a point cloud"));
    std::size_t count = 0;
    for (; points.next(); ++count) fuzz::expect(finite(points.position()));
    fuzz::expect(count <= size);
  });
  fuzz::may_refuse([&] { read_point_cloud(path, {.colours = true}).voxels.validate(); });
}
