// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Meshes of foreign formats by the libraries that this process has loaded: for the Python module.

#include "foreign_meshes.hpp"

#include <filesystem>
#include <utility>

#include <pulsecast/io/mesh_file.hpp>
#if defined(PULSECAST_CITYGML)
#include <pulsecast/io/citygml.hpp>
#endif

using namespace pulsecast;

namespace {

[[gnu::used]] const auto of_mesh_files = &io::detail::foreign_scene;  // without pulsecast::compiled: is compiled here

}  // namespace

#if defined(PULSECAST_CITYGML)
helios::CityReader city_models() {
  return [](const std::filesystem::path& path, const io::MeshFileSettings& settings, unsigned threads) {
    return io::read_citygml(path,
                            {.materials = settings.materials,
                             .spectra = settings.spectra,
                             .isolated = settings.isolated,
                             .limits = settings.limits},
                            threads)
        .file;
  };
}
#else
helios::CityReader city_models() { return {}; }
#endif
