// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Headers of other rooms, and then both single headers. The same survey gives the same files as in before_rooms.cpp.

#include <pulsecast/helios/simulation.hpp>
#include <pulsecast/io/obj.hpp>

#include <pulsecast/pulsecast_io.hpp>

#include <pulsecast/pulsecast.hpp>

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>

#include "scan.hpp"

std::string scan_before_rooms(const std::filesystem::path& obj, std::size_t& points);

int main() {
  const support::TemporaryFolder folder;
  const std::filesystem::path obj = folder / "wall.obj";
  std::ofstream(obj) << "v -4 10 -3\nv 4 10 -3\nv 4 10 5\nf 1 2 3\n";
  std::size_t points = 0;
  std::size_t points_before = 0;
  const bool same = scan(io::read_obj(obj).mesh, points) == scan_before_rooms(obj, points_before);
  std::cout << points << " points after, " << points_before << " before, files "
            << (same ? "are the same\n" : "differ\n");
  return same && points > 0 ? 0 : 1;
}
