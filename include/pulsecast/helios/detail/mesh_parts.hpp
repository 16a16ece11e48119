// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_MESH_PARTS_HPP
#define PULSECAST_HELIOS_DETAIL_MESH_PARTS_HPP

#include <pulsecast/helios/simulation.hpp>
#include <pulsecast/shape/triangle_mesh.hpp>

namespace PULSECAST_NAMESPACE::helios {

/// Parts of a mesh, one a placement, which share triangles, materials, attributes and motion. @throws SettingError
template <class Part>
[[nodiscard]] std::vector<Part> parts_of(const Simulation::Mesh& mesh, unsigned threads) {
  const std::size_t count = std::max<std::size_t>(1, mesh.placements.size());
  if (!mesh.objects.empty()) require_within("Mesh::objects (number)", mesh.objects.size(), count, count, "");
  Part part{.geometry = std::make_shared<const MaskedMesh<>>(mesh.data, threads),
            .materials = material_table(mesh.materials.empty() ? std::vector{mesh.material} : mesh.materials),
            .motion = mesh.motion,
            .attributes = mesh.attributes};
  std::vector<Part> parts;
  for (std::size_t k = 0; k < count; ++k) {
    if (!mesh.placements.empty()) part.placement = mesh.placements[k];
    part.object = mesh.objects.empty() ? mesh.object + static_cast<ObjectId>(k) : mesh.objects[k];
    parts.push_back(part);
  }
  return parts;
}

}  // namespace PULSECAST_NAMESPACE::helios

#endif
