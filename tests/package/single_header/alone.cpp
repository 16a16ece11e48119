// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// A program that has the single header with io and no other header of the library.

#include <pulsecast/pulsecast_io.hpp>

#include <cstddef>
#include <iostream>
#include <string>

#include "scan.hpp"

int main() {
  std::size_t points = 0;
  const std::string files =
      scan({.vertices = {{-4, 10, -3}, {4, 10, -3}, {4, 10, 5}}, .triangles = {{0, 1, 2}}}, points);
  std::cout << points << " points, " << files.size() << " bytes\n";
}
