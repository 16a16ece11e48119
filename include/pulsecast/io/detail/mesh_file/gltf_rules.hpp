// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_MESH_FILE_GLTF_RULES_HPP
#define PULSECAST_IO_DETAIL_MESH_FILE_GLTF_RULES_HPP

#include <array>

#include <pulsecast/io/format_rules.hpp>

namespace PULSECAST_NAMESPACE::io::detail {

/// Extensions of glTF. Source: Khronos registry of glTF extensions.
inline constexpr std::array<FormatRule, 4> gltf_rules{{
    {"KHR_draco_mesh_compression", FormatUse::read, "compressed meshes"},
    {"EXT_mesh_gpu_instancing", FormatUse::noted,
     "a node for each instance has an effect, instances in a buffer do not"},
    {"CESIUM_RTC", FormatUse::noted, "the model is not moved to its place on the globe"},
    {"KHR_node_visibility", FormatUse::noted, "hidden nodes are there"},
}};

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
