// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SCENE_PART_HPP
#define PULSECAST_SCENE_PART_HPP

#include <variant>

#include <pulsecast/base/unit_rotation.hpp>
#include <pulsecast/concepts.hpp>
#include <pulsecast/geometry/single_ray.hpp>
#include <pulsecast/material/material.hpp>

namespace PULSECAST_NAMESPACE {

class PartMotion;

namespace detail {

[[nodiscard]] inline std::array<Vec3, 8> corners(const Box& b) noexcept {
  std::array<Vec3, 8> all;
  for (std::size_t i = 0; i < 8; ++i)
    all[i] = {i & 1 ? b.max.x : b.min.x, i & 2 ? b.max.y : b.min.y, i & 4 ? b.max.z : b.min.z};
  return all;
}

/// Heap memory of a text [byte].
[[nodiscard]] inline std::size_t heap_bytes(const std::string& text) noexcept {
  return text.capacity() > std::string().capacity() ? text.capacity() + 1 : 0;
}

/// Memory of objects, shared ones once [byte]. A template, so that only who asks compiles it.
template <class Object = void>
class SharedMemorySum {
 public:
  void add(const Object* object, std::size_t bytes) { objects_.emplace_back(object, bytes); }
  [[nodiscard]] std::size_t sum() {
    std::sort(objects_.begin(), objects_.end());
    std::size_t bytes = 0;
    for (std::size_t i = 0; i < objects_.size(); ++i)
      if (i == 0 || objects_[i].first != objects_[i - 1].first) bytes += objects_[i].second;
    return bytes;
  }

 private:
  std::vector<std::pair<const Object*, std::size_t>> objects_{};
};

}  // namespace detail

/// Placement of a part in the world: rotation, uniform scale and translation, in this order.
struct Placement {
  Rotation rotation = no_rotation;  ///< unit quaternion, within a thousandth
  double scale = 1;                 ///< scale factor, from 1e-30 to 1e30
  Vec3 translation{};               ///< origin of the part's frame, in the world [m]

  void validate() const {
    require_rotation("Placement::rotation", rotation);
    require_within("Placement::scale", scale, 1e-30, 1e30, "");  // keeps squared lengths finite
    if (!finite(translation))
      throw_setting_error("Placement::translation (length)", length(translation), "m", "finite");
  }
  void normalize() noexcept { rotation = unit(rotation); }

  /// Maps a point of the part's frame [m] to the world [m].
  [[nodiscard]] Vec3 point(const Vec3& p) const noexcept { return rotation * (scale * p) + translation; }

  /// True if nothing is rotated, scaled or shifted.
  [[nodiscard]] bool identity() const noexcept {
    return translation == Vec3{} && scale == 1 && rotation == no_rotation;  // most placements differ in the first
  }

  /// Box around a placed box [m].
  [[nodiscard]] Box box(const Box& b) const noexcept {
    Box out;
    for (const Vec3& corner : detail::corners(b)) out.extend(point(corner));
    return out;
  }

  /// Rays of the world in the part's own frame. Directions change in length, and ranges do not.
  [[nodiscard]] RayBundle to_local(const RayBundle& rays) const noexcept {
    RayBundle local(static_cast<const BundleOrigin&>(rays));
    set_local(rays, local);
    return local;
  }
  /// As above.
  [[nodiscard]] StaggeredBundle to_local(const StaggeredBundle& rays) const noexcept {
    StaggeredBundle local(static_cast<const BundleOrigin&>(rays));
    set_local(rays, local);
    std::copy_n(rays.begin.begin(), rays.padded_size(), local.begin.begin());
    return local;
  }
  /// Ray of the world in the part's own frame, as above.
  [[nodiscard]] SingleRayPacket to_local(const SingleRayPacket& ray) const noexcept {
    SingleRayPacket local = ray;
    const double per_metre = 1 / scale;
    const Matrix3 back = per_metre * matrix_of(conjugate(rotation));
    local.origin = back * (ray.origin - translation);
    local.direction_length = ray.direction_length * per_metre;
    const Vec3 x = back[0], y = back[1], z = back[2],
               &d = ray.toward;  // written out: -0.6 % of a single ray's instructions
    local.toward = {x.x * d.x + y.x * d.y + z.x * d.z, x.y * d.x + y.y * d.y + z.y * d.z,
                    x.z * d.x + y.z * d.y + z.z * d.z};
    return local;
  }

 private:
  // always inlined, as the bundle of a scene is made in place
  [[gnu::always_inline]] void set_local(const RayBundle& rays, RayBundle& local) const noexcept {
    const double per_metre = 1 / scale;
    const Matrix3 back = per_metre * matrix_of(conjugate(rotation));
    local.origin = back * (rays.origin - translation);
    local.direction_length = rays.direction_length * per_metre;
    const Vec3 x = back[0], y = back[1], z = back[2];
    local.set_directions([&](std::size_t j) noexcept -> RayBundle::Directions {
      const auto of = [j](const RayBundle::Column& column) noexcept { return simd::load<simd::Doubles>(column[j]); };
      const simd::Doubles a = of(rays.x), b = of(rays.y), c = of(rays.z);
      return {x.x * a + y.x * b + z.x * c, x.y * a + y.y * b + z.y * c, x.z * a + y.z * b + z.z * c};
    });
  }
};

namespace detail {

/// Shared shape of one of several kinds.
template <Geometry... Shapes>
struct SharedShape {
  /// Variant of shared pointers.
  using type = std::variant<std::shared_ptr<const Shapes>...>;
};
/// Shared shape of the only kind. A variant of one takes g++ 12 some 60 ms more to compile.
template <Geometry Shape>
struct SharedShape<Shape> {
  /// Shared pointer.
  using type = std::shared_ptr<const Shape>;
};

/// Half sides of the box around a turned box of these half sides, in axes `turn` [m].
/// Source: Arvo 1990, Transforming axis-aligned bounding boxes, Graphics Gems.
[[nodiscard]] inline Vec3 reach_of(const Matrix3& turn, const Vec3& half) noexcept {
  const auto reach = [&](int k) noexcept {
    const auto size = [&](int column) noexcept { return std::fabs(turn[column][k]); };
    return size(0) * half.x + size(1) * half.y + size(2) * half.z;
  };
  return {reach(0), reach(1), reach(2)};
}

/// Box around a placed box [m], as `Placement::box` up to rounding; empty for an empty box.
[[nodiscard]] inline Box placed_box(const Placement& placement, const Box& box) noexcept {
  if (box.empty()) return {};
  const Matrix3 turn = matrix_of(placement.rotation);
  const Vec3 middle = turn * (placement.scale * box.centre()) + placement.translation;
  const Vec3 reach = reach_of(turn, 0.5 * placement.scale * box.size());
  return {middle - reach, middle + reach};
}

}  // namespace detail

/// Materials by index, shareable among parts.
using MaterialTable = std::shared_ptr<const std::vector<Material>>;

/// Makes a table of materials. @throws SettingError for values out of range
[[nodiscard]] inline MaterialTable material_table(std::vector<Material> materials) {
  for (const Material& m : materials) m.validate();
  return std::make_shared<const std::vector<Material>>(std::move(materials));
}

/// Table of a single default material, shared by all callers.
[[nodiscard]] inline MaterialTable material_table() {
  static const MaterialTable table = material_table(std::vector<Material>(1));
  return table;
}

/// Calls `visitor` with the shared pointer to a part's shape, of the only kind.
template <class Visitor, class Shape>
[[gnu::always_inline]] constexpr decltype(auto) visit_shape(const Visitor& visitor,
                                                            const std::shared_ptr<const Shape>& of) {
  return visitor(of);
}
/// Calls `visitor` with the shared pointer to a part's shape, of one of several kinds.
template <class Visitor, class... Pointers>
constexpr decltype(auto) visit_shape(const Visitor& visitor, const std::variant<Pointers...>& of) {
  return std::visit(visitor, of);
}

/// Named number of a part, such as age, species or diameter.
struct Attribute {
  std::string name{};  ///< as columns have it
  double value = 0;    ///< in units of the user's

  friend bool operator==(const Attribute&, const Attribute&) = default;
};

/// Named numbers of a part, shareable among parts.
using Attributes = std::shared_ptr<const std::vector<Attribute>>;

/// Makes the named numbers of parts, as `attributes({{"age", 80}, {"leaf", 1}})`. @throws
/// SettingError for a name that is empty or comes twice
[[nodiscard]] inline Attributes attributes(std::vector<Attribute> all) {
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::string& name = all[i].name;
    const auto same = [&](const Attribute& other) { return other.name == name; };
    if (name.empty() || std::any_of(all.data(), &all[i], same))
      throw_setting_error("Attribute::name (number of '" + name + "')", static_cast<double>(i), "",
                          "not empty, and each name once");
  }
  return std::make_shared<const std::vector<Attribute>>(std::move(all));
}

/// Placed shape. Many parts may share one geometry, one table of materials and one motion.
template <Geometry... Shapes>
struct Part {
  /// Shared pointer to the shape; a variant of them for several kinds.
  typename detail::SharedShape<Shapes...>::type geometry;
  MaterialTable materials = material_table();  ///< by the shape's material index
  Placement placement{};                       ///< placement in the world
  ObjectId object = 0;                         ///< object id of its points
  std::string name{};                          ///< user's name for it
  std::shared_ptr<const PartMotion> motion{};  ///< on top of the placement; for a `MovingScene`
  Attributes attributes{};                     ///< of its points, by `ObjectAttributes`
};

namespace detail {
/// `Scene` or `MovingScene`.
template <class Map>
concept HasParts = requires(const Map& map) { map.parts(); };
}  // namespace detail

}  // namespace PULSECAST_NAMESPACE

#endif
