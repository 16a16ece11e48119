// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_MESH_PARTS_HPP
#define PULSECAST_HELIOS_DETAIL_MESH_PARTS_HPP

#include <filesystem>
#include <utility>
#include <vector>

#include <pulsecast/base/error.hpp>
#include <pulsecast/base/text.hpp>
#include <pulsecast/helios/scene.hpp>
#include <pulsecast/helios/settings.hpp>
#include <pulsecast/io/mesh_file.hpp>
#include <pulsecast/shape/triangle_mesh.hpp>

/// Parts of mesh files.
namespace PULSECAST_NAMESPACE::helios {

/// Files are imported by child processes, so that a damaged one ends as an error.
PULSECAST_INLINE std::vector<SceneBuilder::Loaded> SceneBuilder::read(const MeshSource& source) {
  io::MeshFileSettings settings{
      .unit = source.unit, .materials = source.materials, .spectra = options_.spectra, .isolated = true};
  if (source.up != MeshUp::file) settings.up = source.up == MeshUp::y ? io::UpAxis::y : io::UpAxis::z;
  return each(source.files, [&](const std::filesystem::path& file, std::vector<Loaded>& all) {
    const bool city =
        text::lower(file.extension().string()) == ".gml" || text::lower(file.extension().string()) == ".citygml";
    if (city && !options_.city_models)
      throw FileError(file.string(), "", "is a CityGML file, which this program was built without");
    io::MeshFile read = city ? options_.city_models(file, settings, options_.threads)
                             : io::read_mesh_file(file, settings, options_.threads);
    warn(read.warnings);
    add_files(read.files);
    if (read.placements.empty()) warn({file.string() + ": is left out"});
    read.materials = *table(std::move(read.materials));
    for (Part<TriangleMesh<>>& part : io::parts_of(std::move(read), 0, options_.threads))
      all.push_back({std::move(part.geometry), std::move(part.materials), part.placement, std::move(part.name)});
  });
}

}  // namespace PULSECAST_NAMESPACE::helios

#endif
