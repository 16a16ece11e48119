// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include <pulsecast/io/mesh_file.hpp>
#include <pulsecast/version.hpp>

/// What pulsecast asks pulsecast-import for: a scene of a file, by what assimp and libcitygml need to know.
struct ImportRequest {
  std::string version = PULSECAST_VERSION;
  std::string path{};
  bool city = false;        ///< true: CityGML
  std::string materials{};  ///< MTL file; or empty
  std::optional<pulsecast::io::UpAxis> up{};
  std::optional<double> unit{};  ///< [m]
  bool texture = false, files_elsewhere = false;
  double memory_per_byte = 0;  ///< more for each byte of further files

  void archive(auto& a) { a(version, path, city, materials, up, unit, texture, files_elsewhere, memory_per_byte); }
};
