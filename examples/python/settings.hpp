// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <pybind11/pybind11.h>

#include <pulsecast/helios/document.hpp>
#include <pulsecast/helios/settings.hpp>
#include <pulsecast/material/surface_law.hpp>
#include <pulsecast/platform/block_flight.hpp>

/// Settings of surveys as Python's own dataclasses: they are copied, compared, printed and pickled as any other, and
/// lists in them are lists.

/// Makes the classes.
void bind_settings(pybind11::module_& m);

/// To and from them. What comes from Python is checked: a `TypeError` or `ValueError` names the member.
pybind11::object to_python(const pulsecast::helios::SurveySettings& settings);
pulsecast::helios::SurveySettings survey_of(pybind11::handle settings);
pulsecast::helios::LegScannerSettings leg_scanner_of(pybind11::handle settings);
pulsecast::BlockFlight block_flight_of(pybind11::handle settings);
pulsecast::SurfaceLaw law_of(pybind11::handle law);
pybind11::object to_python(const pulsecast::helios::AssetDocument& assets);
pybind11::object to_python(const std::vector<pulsecast::helios::LegSettings>& legs);
