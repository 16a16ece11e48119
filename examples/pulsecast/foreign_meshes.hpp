// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <pulsecast/helios/scene.hpp>

/// Reader of CityGML files by child processes; empty in a module built without libcitygml. What defines it defines
/// `io::detail::foreign_scene` of mesh files, too: within the process and its forks, or by the program
/// pulsecast-import.
pulsecast::helios::CityReader city_models();
