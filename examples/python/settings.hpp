// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <pybind11/pybind11.h>

#include <pulsecast/helios/document.hpp>
#include <pulsecast/helios/settings.hpp>

/// Settings of surveys as Python's own dataclasses: they are copied, compared, printed and pickled as any other, and
/// lists in them are lists.

/// Makes the classes.
void bind_settings(pybind11::module_& m);

/// To and from them. What comes from Python is checked: a `TypeError` or `ValueError` names the member.
pybind11::object to_python(const pulsecast::helios::SurveySettings& settings);
pulsecast::helios::SurveySettings survey_of(pybind11::handle settings);
pybind11::object to_python(const pulsecast::helios::AssetDocument& assets);
