// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/leaf_angles.hpp>

#include <cmath>

#include "fuzz/fuzz.hpp"

using namespace pulsecast;
using namespace pulsecast::io;

/// The first byte chooses how many rows, evenly spread over all zenith angles, stand behind the input: without them,
/// few would be whole.
FUZZ_TARGET(leaf_angles) {
  if (size == 0) return;
  std::string text(reinterpret_cast<const char*>(data + 1), size - 1);
  const int rows = data[0] % 32;
  for (int i = 0; i < rows; ++i) {
    const double zenith = 0.5 * pi * (i + 0.5) / rows;
    text += '\n' + std::to_string(std::sin(zenith)) + ",0," + std::to_string(std::cos(zenith)) + ",0.5";
  }
  const std::filesystem::path path =
      fuzz::file(reinterpret_cast<const std::uint8_t*>(text.data()), text.size(), "leaves.txt");
  fuzz::may_refuse([&] {
    const LeafAngles leaves = read_leaf_angles(path);
    for (const Vec3& direction :
         {axis::up, axis::right, -axis::up, Vec3{1, 2, 3}, Vec3{0, 1e-300, 1}, Vec3{1, 0, -1e-9}}) {
      const double projection = leaves.projection(direction);
      fuzz::expect(projection >= 0 && projection <= 1);
    }
  });
}
