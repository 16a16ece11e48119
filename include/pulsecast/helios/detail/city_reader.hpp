// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_CITY_READER_HPP
#define PULSECAST_HELIOS_DETAIL_CITY_READER_HPP

#include <filesystem>
#include <functional>

#include <pulsecast/base/namespace.hpp>

namespace PULSECAST_NAMESPACE::io {
struct MeshFile;
struct MeshFileSettings;
}  // namespace PULSECAST_NAMESPACE::io

namespace PULSECAST_NAMESPACE::helios {

/// Reader of CityGML files, on a number of threads, such as `io::read_citygml`. A program supplies
/// it, because libcitygml requires GDAL, which few programs need.
using CityReader = std::function<io::MeshFile(const std::filesystem::path&, const io::MeshFileSettings&, unsigned)>;

}  // namespace PULSECAST_NAMESPACE::helios

#endif
