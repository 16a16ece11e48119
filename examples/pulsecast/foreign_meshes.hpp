// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <pulsecast/helios/scene.hpp>

// Meshes of foreign formats come by the program pulsecast-import, so that program and Python module load no library of
// theirs.

/// Reader of CityGML files. What defines it defines `io::detail::foreign_scene` of mesh files, too.
pulsecast::helios::CityReader city_models();

/// Files of that name among programs: beside this program; of the build or the prefix that this code was installed in;
/// in the PATH.
std::vector<std::filesystem::path> programs_named(const std::string& name);
