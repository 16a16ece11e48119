// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Reads GeoTIFF files, and prints a line for each: its pixels (columns, rows, first one, size), and heights row by row
// from the north into PATH.f32, as numbers of single precision; or the reason why it is refused. Usage: read PATH...

#include <exception>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <span>

#include <pulsecast/io/geotiff.hpp>

using namespace pulsecast;

int main(int count, char** arguments) {
  std::cout << std::setprecision(17);
  for (const char* path : std::span(arguments, static_cast<std::size_t>(count)).subspan(1)) {
    try {
      const io::GeoTiff made = io::read_geotiff(path);
      const Raster& r = made.raster;
      std::ofstream(std::string(path) + ".f32", std::ios::binary)
          .write(reinterpret_cast<const char*>(r.heights.data()),
                 static_cast<std::streamsize>(r.heights.size() * sizeof(float)));
      std::cout << "read " << r.columns << ' ' << r.rows << ' ' << r.first.x << ' ' << r.first.y << ' ' << r.pixel.x
                << ' ' << r.pixel.y << ' ' << made.warnings.size();
      for (const std::string& warning : made.warnings) std::cout << " | " << warning;
    } catch (const std::exception& error) {
      std::cout << "refused " << error.what();
    }
    std::cout << '\n';
  }
}
