// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <memory>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include <pulsecast/base/expect.hpp>
#include <pulsecast/concepts.hpp>
#include <pulsecast/scene/material.hpp>

namespace pulsecast {

/// Where a part stands in the world: turned, scaled alike in all directions, and moved, in this order.
struct Similarity {
  Rotation rotation = no_rotation;  ///< unit quaternion
  double scale = 1;
  Vec3 translation{};  ///< [m]

  void validate() const {
    expect_within("Similarity::rotation (norm)", length(rotation), 1 - 1e-9, 1 + 1e-9, "");
    expect_positive("Similarity::scale", scale, "");
    if (!finite(translation)) throw SettingError("Similarity::translation (length)", length(translation), "m", "finite");
  }

  [[nodiscard]] Vec3 point(const Vec3& p) const noexcept { return rotation * (scale * p) + translation; }

  [[nodiscard]] bool identity() const noexcept { return rotation == no_rotation && scale == 1 && translation == Vec3{}; }

  /// The box around a box, placed.
  [[nodiscard]] Box box(const Box& b) const noexcept {
    Box out;
    for (int corner = 0; corner < 8; ++corner)
      out.extend(point({corner & 1 ? b.max.x : b.min.x, corner & 2 ? b.max.y : b.min.y, corner & 4 ? b.max.z : b.min.z}));
    return out;
  }

  /// Rays of the world in the part's own frame. Their directions get longer or shorter, so that ranges stay what they are.
  [[nodiscard]] RayBundle to_local(const RayBundle& rays) const noexcept {
    RayBundle local(static_cast<const BundleOrigin&>(rays));
    const Rotation back = conjugate(rotation);
    local.origin = back * (rays.origin - translation) / scale;
    local.direction_length = rays.direction_length / scale;
    const Vec3 x = back * right / scale, y = back * forward / scale, z = back * up / scale;
    for (std::size_t j = 0; j < rays.padded_size(); ++j) {
      local.x[j] = x.x * rays.x[j] + y.x * rays.y[j] + z.x * rays.z[j];
      local.y[j] = x.y * rays.x[j] + y.y * rays.y[j] + z.y * rays.z[j];
      local.z[j] = x.z * rays.x[j] + y.z * rays.y[j] + z.z * rays.z[j];
    }
    return local;
  }
};

/// Materials by index, shared by any number of parts.
using MaterialTable = std::shared_ptr<const std::vector<Material>>;

/// A table of materials; a single default one unless told otherwise.
[[nodiscard]] inline MaterialTable material_table(std::vector<Material> materials = std::vector<Material>(1)) {
  for (const Material& m : materials) m.validate();
  return std::make_shared<const std::vector<Material>>(std::move(materials));
}

/// A shape in a place: many parts may share one geometry and one table of materials.
template <Geometry... Shapes>
struct Part {
  std::variant<std::shared_ptr<const Shapes>...> geometry;
  MaterialTable materials = material_table();
  Similarity placement{};
  ObjectId object = 0;
};

}  // namespace pulsecast
