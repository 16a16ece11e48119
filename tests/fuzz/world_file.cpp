// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <cmath>

#include <pulsecast/io/world_file.hpp>

#include "fuzz/fuzz.hpp"

using namespace pulsecast;
using namespace pulsecast::io;

FUZZ_TARGET(world_file) {
  const std::filesystem::path path = fuzz::file(data, size, "dem.pgw");
  fuzz::may_refuse([&] {
    const WorldFile world = read_world_file(path);
    fuzz::expect(world.step.x >= 1e-9 && world.step.x <= 1e6);
    fuzz::expect(std::fabs(world.step.y) >= 1e-9 && std::fabs(world.step.y) <= 1e6);
    fuzz::expect(std::fabs(world.first.x) <= 1e15 && std::fabs(world.first.y) <= 1e15);
  });
}
