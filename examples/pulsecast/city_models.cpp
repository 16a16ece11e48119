// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include "city_models.hpp"

#if defined(PULSECAST_CITYGML)
#include <filesystem>
#include <utility>

#include <pulsecast/io/citygml.hpp>

using namespace pulsecast;

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
pulsecast::helios::CityReader city_models() { return {}; }
#endif
