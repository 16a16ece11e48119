// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <pybind11/pybind11.h>

#include <pulsecast/base/frame.hpp>
#include <pulsecast/helios/simulation.hpp>

/// Scenes of arrays: meshes, light, and ray queries.

/// Makes the classes.
void bind_scene(pybind11::module_& m);

/// Meshes of one, of several, or of None. @throws TypeError for others
std::vector<pulsecast::helios::Simulation::Mesh> meshes_of(const pybind11::object& given);

/// Poses of an array of shape (n, 7) or (n, 8): time [s], x, y, z [m, world], and roll, pitch, yaw [rad; yaw clockwise
/// from north] or a quaternion x, y, z, w; or of a structured array with the first seven as fields. `name` is for
/// messages. Of shape (n, 4), without attitudes, they are level, and head along the path.
/// @throws SettingError for another shape
std::vector<pulsecast::TimedPose> trajectory_poses(const pybind11::object& array, const std::string& name);
