// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <pulsecast/helios/scene.hpp>

/// Reader of CityGML files by child processes; empty in a program built without libcitygml.
pulsecast::helios::CityReader city_models();
