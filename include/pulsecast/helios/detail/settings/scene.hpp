// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <pulsecast/base/error.hpp>
#include <pulsecast/base/require.hpp>
#include <pulsecast/base/vector.hpp>
#include <pulsecast/helios/detail/settings/mount.hpp>

namespace pulsecast::helios {

/// The materials of what brings none of its own.
struct MaterialSource {
  std::filesystem::path file{};       ///< MTL; empty: all is undescribed. `matfile`
  std::optional<std::string> name{};  ///< the first by alphabet unless given; `matname`
  int random = 0;                     ///< how many variants are made; `randomMaterials`
  double random_range = 1;            ///< by which colours of variants differ at most; `randomRange`

  void validate() const {
    detail::require_at_least(0, "randomMaterials", random);
    require_not_negative("randomRange", random_range, "");
  }

  bool operator==(const MaterialSource&) const = default;
};

/// Triangles: filter `objloader`.
struct ObjSource {
  std::vector<std::filesystem::path> files{};  ///< `filepath`, or those that `efilepath` matches, by name
  bool y_up = false;                           ///< `up`

  bool operator==(const ObjSource&) const = default;
};

/// A raster of heights: filter `geotiffloader`.
struct GeoTiffSource {
  std::vector<std::filesystem::path> files{};  ///< `filepath`, or those that `efilepath` matches, by name
  MaterialSource material{};

  void validate() const { material.validate(); }

  bool operator==(const GeoTiffSource&) const = default;
};

/// A point cloud that becomes voxels: filter `xyzloader`.
struct XyzSource {
  std::vector<std::filesystem::path> files{};  ///< `filepath`, or those that `efilepath` matches, by name
  MaterialSource material{};
  std::string separator{};                     ///< any of these separates columns; found unless given. `separator`
  double voxel_size = 1;                       ///< edge; `voxelSize` [m]
  std::optional<Vec3> default_normal{};        ///< of any length but zero; `defaultNormal`
  int estimate_normals = 0;                    ///< 0: from the file, else a plane is fitted in each voxel; `estimateNormals`
  bool snap_neighbor_normal = false;           ///< the normal of the point nearest to the centre, not the mean; `snapNeighborNormal`
  std::array<int, 3> normal_columns{3, 4, 5};  ///< from 0; `normalXIndex`, Y and Z

  void validate() const {
    material.validate();
    detail::require_at_least(0, "estimateNormals", estimate_normals);
  }

  bool operator==(const XyzSource&) const = default;
};

enum class VoxelMode : std::uint8_t {
  transmittive,  ///< rays pass by chance
  fixed,         ///< opaque cubes
  scaled,        ///< opaque cubes, the smaller the less there is in them
};

/// Voxels with what fills them: filter `detailedvoxels`.
struct VoxelSource {
  std::vector<std::filesystem::path> files{};  ///< `filepath`, or those that `efilepath` matches, by name
  MaterialSource material{};
  VoxelMode mode = VoxelMode::transmittive;  ///< `intersectionMode`
  double scaling_exponent = 0.5;             ///< if scaled; `intersectionArgument`
  bool random_shift = false;                 ///< if scaled, cubes stand anywhere in their cells; `randomShift`
  std::filesystem::path leaf_angles{};       ///< look-up table; empty: there is none. `ladlut`

  void validate() const { material.validate(); }

  bool operator==(const VoxelSource&) const = default;
};

using PartSource = std::variant<ObjSource, GeoTiffSource, XyzSource, VoxelSource>;

namespace detail {

inline void validate_source(const PartSource& source) {
  std::visit([](const auto& one) { (void)validated(one); }, source);
}

}  // namespace detail

/// How geometry is placed: each vertex goes to `translation + scale * (rotations * vertex)`. Filters `rotate`, `scale`, `translate`.
struct TransformSettings {
  double scale = 1;                       ///< `scale`
  std::vector<RotationList> rotations{};  ///< one after the other, about fixed axes; `rotation` of each filter
  Vec3 translation{};                     ///< `offset` [m]
  int on_ground = 0;                      ///< if not 0, it is let down onto the ground; the search depth. `onGround`

  bool operator==(const TransformSettings&) const = default;
};

/// `<motion type="identity">`
struct NoMotion {
  bool operator==(const NoMotion&) const = default;
};

/// `<motion type="translation">`
struct TranslationMotion {
  Vec3 by{};  ///< `vec` [m]

  bool operator==(const TranslationMotion&) const = default;
};

/// `<motion type="rotation">` and, with `glide`, `<motion type="helical">`
struct RotationMotion {
  Vec3 axis = axis::up;           ///< of any length but zero; `axis`
  double angle = 0;               ///< right-handed; `angle` in degrees [rad]
  std::optional<Vec3> center{};   ///< through which the axis goes; the origin unless given. `center` [m]
  std::optional<double> glide{};  ///< along the axis, in its lengths: helical only. `glide`

  bool operator==(const RotationMotion&) const = default;
};

/// `<motion type="reflection">` and, with `shift`, `<motion type="glideplane">`
struct ReflectionMotion {
  Vec3 normal = axis::up;       ///< of a plane through the origin, of any length but zero; `ortho`
  std::optional<Vec3> shift{};  ///< along the plane: glide plane only. `shift` [m]

  bool operator==(const ReflectionMotion&) const = default;
};

/// `<motion type="rotsym">`: a rotation, and then a reflection at the plane across the axis.
struct RotoreflectionMotion {
  Vec3 axis = axis::up;          ///< of any length but zero; `axis`
  double angle = 0;              ///< right-handed; `angle` in degrees [rad]
  std::optional<Vec3> center{};  ///< `center` [m]

  bool operator==(const RotoreflectionMotion&) const = default;
};

/// What a part does in each step: `<motion>`.
struct MotionSettings {
  std::variant<NoMotion, TranslationMotion, RotationMotion, ReflectionMotion, RotoreflectionMotion> kind{};
  bool about_itself = false;  ///< in a frame at the part's centre; `selfMode`
  double shift_factor = 0;    ///< times the centre of the scene, added to the coordinates given; `autoCRS`

  bool operator==(const MotionSettings&) const = default;
};

/// What a part does for a number of steps, and what then: `<dmotion>`.
struct MotionSequenceSettings {
  std::string id{};                       ///< `id`
  int loop = 1;                           ///< for how many steps; 0 stands for ever. `loop`
  std::optional<std::string> next{};      ///< the sequence that follows; it stops unless given. `next`
  std::vector<MotionSettings> motions{};  ///< all of them in each step, one after the other

  void validate() const { detail::require_at_least(0, "loop", loop); }

  bool operator==(const MotionSequenceSettings&) const = default;
};

/// What stands in a part's place in later runs of the survey: `<swap>`.
struct SwapSettings {
  int step = 1;                        ///< for how many runs; `swapStep`
  bool removes = false;                ///< nothing stands there; `force_null`
  std::optional<PartSource> source{};  ///< the part's own unless given
  TransformSettings transform{};

  void validate() const {
    detail::require_at_least(1, "swapStep", step);
    if (source) detail::validate_source(*source);
  }

  bool operator==(const SwapSettings&) const = default;
};

/// `<part>`
struct PartSettings {
  std::string id{};                               ///< `id`; unless given, how many parts and files stand before it
  PartSource source{};                            ///< the filter that loads
  TransformSettings transform{};                  ///< the filters that place
  int dynamic_step = 1;                           ///< it moves once in so many updates of the scene; `dynStep`
  std::optional<double> dynamic_interval{};       ///< it moves once in this time, where the scene has one; `dynTimeStep` [s]
  std::vector<MotionSequenceSettings> motions{};  ///< the first one begins; none: it stands still
  std::vector<SwapSettings> swaps{};              ///< one after the other

  void validate() const {
    detail::validate_source(source);
    detail::require_at_least(1, "dynStep", dynamic_step);
    if (dynamic_interval) require_positive("dynTimeStep", *dynamic_interval, "s");
    for (const MotionSequenceSettings& sequence : motions) sequence.validate();
    for (const SwapSettings& swap : swaps) swap.validate();
  }

  bool operator==(const PartSettings&) const = default;
};

/// `<scene>`
struct SceneSettings {
  std::string id{};                          ///< `id`
  std::string name{};                        ///< `name`
  int dynamic_step = 1;                      ///< it is updated once in so many pulse slots; `dynStep`
  std::optional<double> dynamic_interval{};  ///< instead, once in this time; `dynTimeStep` [s]
  std::vector<PartSettings> parts{};

  void validate() const {
    detail::require_at_least(1, "dynStep", dynamic_step);
    if (dynamic_interval) require_positive("dynTimeStep", *dynamic_interval, "s");
    for (const PartSettings& part : parts) naming("part '" + part.id + "'", [&] { part.validate(); });
  }

  bool operator==(const SceneSettings&) const = default;
};

}  // namespace pulsecast::helios
