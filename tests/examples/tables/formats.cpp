// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Prints what the readers do with the items of their formats, as the rows of docs/formats.md.

#include <array>
#include <iostream>
#include <span>
#include <string_view>

#include <pulsecast/io/detail/geotiff/rules.hpp>
#include <pulsecast/io/detail/las/rules.hpp>
#include <pulsecast/io/detail/mesh_file/mesh_rules.hpp>
#include <pulsecast/io/detail/packets/rules.hpp>
#include <pulsecast/io/detail/ply/rules.hpp>
#include <pulsecast/io/detail/ptx/points.hpp>
#include <pulsecast/io/detail/raster_rules.hpp>
#include <pulsecast/io/detail/reference_reader.hpp>
#include <pulsecast/io/detail/trajectory/rules.hpp>
#include <pulsecast/io/spectral_library.hpp>
#include <pulsecast/io/vox.hpp>

using namespace pulsecast::io;

namespace {
void print(std::string_view format, std::span<const FormatRule> rules) {
  constexpr std::array<std::string_view, 3> uses{"read", "noted", "refused"};
  for (const FormatRule& rule : rules)
    std::cout << "| " << format << " | `" << rule.name << "` | " << uses[static_cast<std::size_t>(rule.use)] << " | "
              << rule.meaning << " |\n";
}
}  // namespace

int main() {
  print("glTF", detail::gltf_rules);
  print("LAS, LAZ, COPC", detail::las_rules);
  print("PLY, as a mesh", detail::ply_mesh_rules);
  print("PLY, as points", detail::ply_cloud_rules);
  print("points: PLY, named columns", detail::point_rules);
  print("PTX", detail::ptx_rules);
  print("DAE, FBX", detail::mesh_rules);
  print("OBJ", detail::obj_rules);
  print("MTL", detail::mtl_rules);
  print("CityGML", detail::city_rules);
  print("AMAPVox", detail::vox_rules);
  print("GeoTIFF", detail::geotiff_rules);
  print("ASCII grid", detail::ascii_grid_rules);
  print("PNG heights", detail::png_rules);
  print("beside a raster", detail::side_file_rules);
  print("reference system", detail::reference_rules);
  print("trajectory", detail::trajectory_rules);
  print("spectrum", detail::spectrum_rules);
  print("Velodyne calibration", detail::velodyne_rules);
  print("Ouster metadata", detail::ouster_rules);
}
