// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SHAPE_TRIANGLE_MESH_HPP
#define PULSECAST_SHAPE_TRIANGLE_MESH_HPP

#include <pulsecast/accel/bvh.hpp>
#include <pulsecast/geometry/detail/bundle_budget.hpp>
#include <pulsecast/shape/detail/corner_table.hpp>
#include <pulsecast/shape/detail/line_test.hpp>
#include <pulsecast/shape/mesh_data.hpp>

namespace PULSECAST_NAMESPACE {

template <class Mesh>
class DeformingMesh;

namespace detail {
/// Accelerator that takes such rays and hits.
template <class Index, class Rays, class Test, class Hits>
concept Searches = requires(const Index& index, const Rays& rays, const Test& test, Hits& hits) {
  index.closest(rays, test, hits);
};
}  // namespace detail

/// Indexed triangle mesh; vertices equal to the last bit are merged per block. Two-sided; triangles
/// without area are never hit, nor those whose area is no normal number, of edges below 1e-150 m.
/// Triangles keep their numbers but are stored in the index's order, in blocks with vertices of
/// their own. Each takes 10 bytes, its index and vertices of 24 bytes, and a byte for several
/// materials. Rays pass holes of a `MaskedMesh`. `Bvh<float>` has the hits of `Bvh<double>`, in less
/// memory (docs/tradeoff.md).
template <Accelerator Index = Bvh<float>, class Masks = detail::NoMasks>
class TriangleMesh {
 public:
  using refinements = refines<tag::UniformGeometry, tag::DeterministicGeometry, tag::SelfChecking>;
  static constexpr bool uniform_surface = true;  ///< as the concept UniformGeometry describes
  static constexpr bool deterministic = true;    ///< as the concept DeterministicGeometry describes

  /// `workers`: threads of the build. @throws SettingError as `MeshData::validate`, for coordinates
  /// beyond 1e18 m, or for masks unless this is a `MaskedMesh`
  explicit TriangleMesh(MeshData data, const Workers& workers = {});

  explicit TriangleMesh(DeserializeTag tag) requires std::constructible_from<Index, DeserializeTag> : index_(tag) {}
  void archive(auto& a) {
    a(corners_, first_corners_, triangles_, places_, materials8_, materials_, texture_, masks_, index_,
      material_count_);
  }
  [[nodiscard]] bool is_consistent() const {
    if (triangles_.size() != index_.order().size() || first_corners_.size() != detail::chunk_count(triangles_.size()))
      return false;
    for (std::size_t place = 0; place < triangles_.size(); ++place) {
      const std::uint64_t first = first_corners_[place / detail::chunk_size];
      for (const std::uint16_t corner : triangles_[place])
        if (first >= corners_.size() || corner >= corners_.size() - first) return false;
    }
    if (!std::all_of(places_.begin(), places_.end(), [&](std::uint32_t place) { return place < triangles_.size(); }))
      return false;
    const auto in_table = [&](const auto& materials) {
      return (materials.empty() || materials.size() == size()) &&
             std::all_of(materials.begin(), materials.end(), [&](std::uint32_t m) { return m < material_count_; });
    };
    if (!texture_.empty() && texture_.size() != size()) return false;
    if (!masks_.empty() && texture_.empty()) return false;
    if (material_count_ == 0 || !in_table(materials8_) || !in_table(materials_)) return false;
    static_assert(detail::members_checked<Index, tag::SelfCheckingAccelerator, tag::MissesCones>);
    if constexpr (SelfCheckingAccelerator<Index>) return index_.is_consistent(size());
    return true;
  }

  [[nodiscard]] std::size_t size() const noexcept { return places_.size(); }
  /// Triangle i [m].
  [[nodiscard]] Triangle triangle(PrimitiveIndex i) const noexcept { return triangle_at(places_[i]); }
  /// Accelerator of the triangles.
  [[nodiscard]] const Index& index() const noexcept { return index_; }
  [[nodiscard]] std::size_t material_count() const noexcept { return material_count_; }
  [[nodiscard]] const Box& bounds() const noexcept { return index_.bounds(); }
  [[nodiscard]] std::size_t memory() const noexcept {
    return index_.memory() + corners_.memory() + first_corners_.memory() + triangles_.memory() + places_.memory() +
           materials8_.memory() + materials_.memory() + texture_.memory() + masks_.memory();
  }

  /// For a bundle or a `SingleRayPacket`, which an accelerator that takes bundles only gets as one.
  template <class Rays, HitsOf<Rays> Hits>
  void closest(const Rays& rays, Hits& nearest) const noexcept {
    const auto alone = [this](const auto& ray, auto& hit) noexcept { this->closest(ray, hit); };
    if constexpr (std::is_same_v<Rays, RayBundle> &&
                  detail::Searches<Index, SingleRayPacket, Test<SingleRayPacket, ClosestHit>, ClosestHit>)
      if (rays.size == 1) return detail::closest_one_by_one(rays, nearest, alone);
    const Test<Rays, Hits> test(*this, rays, nearest);
    using Limit = detail::BudgetedLimit<Hits>;
    if constexpr (Rays::capacity > 1 && detail::Searches<Index, Rays, Test<Rays, Hits>, Limit>) {
      Limit limit{nearest};
      index_.closest(rays, test, limit);
      if (limit.spent()) detail::closest_one_by_one(rays, nearest, alone);
    } else if constexpr (detail::Searches<Index, Rays, Test<Rays, Hits>, Hits>) {
      index_.closest(rays, test, nearest);
    } else {
      const RayBundle bundle = bundle_of(rays, nearest.limit_of(0));
      ClosestHits limits(bundle);
      const auto test_found = [&](std::span<const PrimitiveIndex> primitives) noexcept {
        test(primitives);
        limits.range[0] = nearest.limit_of(0);
      };
      index_.closest(bundle, test_found, limits);
    }
  }

  /// As for each ray of a sheaf, in one traversal. A template, as clang 14 instantiates other members whose
  /// requirements are not met when it instantiates the class.
  template <std::same_as<detail::SheafHits> Hits>
  void closest(const detail::RaySheaf& rays, Hits& nearest)
      const noexcept requires std::is_same_v<Index, Bvh<float>> && std::is_same_v<Masks, detail::NoMasks> {
    index_.closest(rays, Test<detail::RaySheaf, Hits>(*this, rays, nearest), nearest);
  }

  /// True only if no ray of a cone comes near a triangle.
  [[nodiscard]] bool misses_cone(const RayCone& cone) const noexcept requires MissesCones<Index> {
    return index_.misses_cone(cone);
  }

  /// Texture coordinates where the corners have these weights; empty without a column of them.
  [[nodiscard]] std::optional<Vec2> texture(PrimitiveIndex i, const Vec3& weights) const noexcept {
    if (texture_.empty()) return std::nullopt;
    const auto& corners = texture_[i];
    Vec2 at{};
    for (std::size_t k = 0; k < 3; ++k) at += weights[static_cast<int>(k)] * Vec2(corners[k][0], corners[k][1]);
    return at;
  }

  [[nodiscard]] SurfaceInteraction surface(PrimitiveIndex i, const auto&, std::size_t) const noexcept {
    const Vec3 normal = triangle(i).normal();
    return {finite(normal) ? normal : Vec3{}, material(i)};
  }

 private:
  template <class Mesh>
  friend class DeformingMesh;

  [[nodiscard]] std::uint32_t material(PrimitiveIndex i) const noexcept {
    return !materials8_.empty() ? materials8_[i] : !materials_.empty() ? materials_[i] : 0;
  }
  /// True if ray j meets a triangle outside the holes of its material.
  [[nodiscard]] bool solid(PrimitiveIndex i, const auto& rays, std::size_t j) const noexcept {
    const std::uint32_t masked = material(i);
    return !masks_.covers(masked) ||
           masks_.solid(masked, *texture(i, triangle(i).weights(rays.origin, rays.direction(j))));
  }

  using Corners = std::array<std::uint16_t, 3>;  ///< vertex indices of a triangle in its block
  static_assert(3 * detail::chunk_size < 0xFFFF);

  [[nodiscard]] const Vec3* block_corners(std::size_t place) const noexcept {
    return corners_.data() + first_corners_[place / detail::chunk_size];
  }
  [[nodiscard]] static detail::TriangleRef triangle_in(const Vec3* corners, const Corners& triangle) noexcept {
    return {corners[triangle[0]], corners[triangle[1]], corners[triangle[2]]};
  }

  /// Leaf test and prefetch of the index.
  template <class Rays, class Hits>
  struct Test {
    static constexpr bool alone = Rays::capacity == 1, in_sheaf = std::is_same_v<Rays, detail::RaySheaf>;
    static constexpr bool by_line = alone || in_sheaf;

    const TriangleMesh& mesh;
    const Rays& rays;
    Hits& nearest;
    LineTest<Rays> line;  ///< of a single ray, or those of a sheaf

    Test(const TriangleMesh& of, const Rays& by, Hits& found) noexcept
        : mesh(of), rays(by), nearest(found), line(by, of.bounds()) {
      if constexpr (in_sheaf)
        for (std::size_t j = 0; j < by.size; ++j) found.of[j].part = found.part;
    }

    void operator()(std::span<const PrimitiveIndex> primitives) const noexcept {
      const std::size_t place = place_of(primitives), room = by_line ? simd::lane_count : primitives.size();
      if (primitives.size() - 1 >= std::min(room, detail::chunk_size - place % detail::chunk_size)) [[unlikely]]
        return in_blocks(primitives, room);  // or none
      const Vec3* const corners = mesh.block_corners(place);
      const Corners* const triangles = mesh.triangles_.data() + place;
      const auto triangle_of = [&](std::size_t n) noexcept { return TriangleMesh::triangle_in(corners, triangles[n]); };
      if constexpr (std::is_same_v<Masks, detail::MaskTable>)
        if (!mesh.masks_.empty()) [[unlikely]]
          return test(primitives, triangle_of,
                      [this](std::size_t j, PrimitiveIndex i) noexcept { return mesh.solid(i, rays, j); });
      test(primitives, triangle_of, detail::SolidEverywhere{});
    }
    [[gnu::always_inline]] void meet(const TrianglePacket& packet, std::span<const PrimitiveIndex> primitives,
                                     const SingleRayPacket& ray, auto& found, const auto& solid) const noexcept {
      const auto [possible, certain] = line.meet(packet, ray);
      if (possible != 0) intersect(packet, primitives, ray, found, solid, possible == certain ? certain : 0);
    }
    // always inlined, as without masks it is all there is
    [[gnu::always_inline]] void test(std::span<const PrimitiveIndex> primitives, const auto& triangle_of,
                                     const auto& solid) const noexcept {
      if constexpr (alone) {
        const TrianglePacket packet(primitives.size(), triangle_of);
        meet(packet, primitives, rays, nearest, solid);
      } else if constexpr (in_sheaf) {
        const TrianglePacket packet(primitives.size(), triangle_of);
        for (std::size_t j = 0; j < rays.size; ++j) meet(packet, primitives, rays.rays[j], nearest.of[j], solid);
      } else {
        intersect(primitives, triangle_of, rays, nearest, solid);
      }
    }
    /// Tests up to `room` primitives of one block at a time.
    [[gnu::noinline]] void in_blocks(std::span<const PrimitiveIndex> primitives, std::size_t room) const noexcept {
      while (!primitives.empty()) {
        const std::size_t count =
            std::min({primitives.size(), room, detail::chunk_size - place_of(primitives) % detail::chunk_size});
        (*this)(primitives.first(count));
        if constexpr (detail::EndsEarly<Hits>)
          if (nearest.done()) return;
        primitives = primitives.subspan(count);
      }
    }
    [[gnu::always_inline]] void prefetch(std::span<const PrimitiveIndex> primitives) const noexcept {
      pulsecast::prefetch(mesh.triangles_.data() + place_of(primitives));
    }

    [[nodiscard]] std::size_t place_of(std::span<const PrimitiveIndex> primitives) const noexcept {
      return static_cast<std::size_t>(primitives.data() - mesh.index_.order().data());
    }
  };

  [[nodiscard]] Triangle triangle_at(std::size_t place) const noexcept {
    const detail::TriangleRef triangle = triangle_in(block_corners(place), triangles_[place]);
    return {triangle.a, triangle.b, triangle.c};
  }

  /// Boxes of the triangles, computed on access.
  struct Boxes {
    const MeshData& data;
    [[nodiscard]] std::size_t size() const noexcept { return data.triangles.size(); }
    [[nodiscard]] Box operator[](std::size_t i) const noexcept { return data.triangle(i).bounds(); }
  };

  static Index built(const MeshData& data, const Workers& workers) {
    data.validate();
    const Boxes boxes{data};
    if constexpr (std::constructible_from<Index, Boxes, Workers>) {
      return Index(boxes, workers);
    } else {
      std::vector<Box> all;
      all.reserve(boxes.size());
      for (std::size_t i = 0; i < boxes.size(); ++i) all.push_back(boxes[i]);
      if constexpr (std::constructible_from<Index, std::span<const Box>, Workers>)
        return Index(all, workers);
      else
        return Index(all);
    }
  }

  template <class Number>
  static SharedBuffer<Number> numbers(const std::vector<std::uint32_t>& all) {
    const SharedBuffer<Number> copy(all.size());
    for (std::size_t i = 0; i < all.size(); ++i) copy[i] = static_cast<Number>(all[i]);
    return copy;
  }

  using TextureCorners = std::array<std::array<float, 2>, 3>;

  static SharedBuffer<TextureCorners> texture_of(const MeshData& data) {
    const SharedBuffer<TextureCorners> all(data.texture.size());
    for (std::size_t i = 0; i < all.size(); ++i)
      for (std::size_t k = 0; k < 3; ++k)
        all[i][k] = {static_cast<float>(data.texture[i][k].x), static_cast<float>(data.texture[i][k].y)};
    return all;
  }

  /// Stores triangles and corners in the index's order, block by block.
  void arrange(const MeshData& data, const Workers& workers) {
    const auto order = index_.order();
    const bool once = order.size() == data.triangles.size();  // else the last of its blocks wins
    const SharedBuffer<std::uint32_t> places(data.triangles.size());
    if (!once) {
      std::fill(places.begin(), places.end(), 0);  // triangles left out of the index are never hit
      for (std::size_t place = 0; place < order.size(); ++place)
        places[order[place]] = static_cast<std::uint32_t>(place);
    }
    const SharedBuffer<Corners> triangles(order.size());
    std::vector<std::vector<Vec3>> parts(detail::chunk_count(order.size()));
    detail::for_each_chunk(order.size(), workers, [&](std::size_t block, std::size_t begin, std::size_t end) {
      detail::CornerTable table(end - begin);
      for (std::size_t place = begin; place < end; ++place) {
        if (once) places[order[place]] = static_cast<std::uint32_t>(place);
        const auto& corners = data.triangles[order[place]];
        for (std::size_t k = 0; k < 3; ++k) triangles[place][k] = table.number_of(data.vertices[corners[k]]);
      }
      parts[block] = std::move(table).corners();
    });
    const SharedBuffer<std::uint64_t> first_corners(parts.size());
    std::size_t count = 0;
    for (std::size_t block = 0; block < parts.size(); ++block) {
      first_corners[block] = count;
      count += parts[block].size();
    }
    const SharedBuffer<Vec3> corners(count);
    for_each_index(parts.size(), workers, [&](std::size_t block) {
      std::copy(parts[block].begin(), parts[block].end(), corners.data() + first_corners[block]);
    });
    corners_ = corners;
    first_corners_ = first_corners;
    triangles_ = triangles;
    places_ = places;
  }

  SharedArray<Vec3> corners_;
  SharedArray<std::uint64_t> first_corners_;  ///< first corner of each block
  SharedArray<Corners> triangles_;            ///< of the triangles, in the index's order
  SharedArray<std::uint32_t> places_;         ///< of each triangle in that order
  SharedArray<std::uint8_t> materials8_;      ///< by triangle; empty if all are 0, or one above 255
  SharedArray<std::uint32_t> materials_;      ///< by triangle, if one is above 255
  SharedArray<TextureCorners> texture_;       ///< of each triangle's corners, if any
  Masks masks_;                               ///< holes by material
  Index index_;
  std::size_t material_count_ = 1;
};

template <Accelerator Index, class Masks>
TriangleMesh<Index, Masks>::TriangleMesh(MeshData data, const Workers& workers) : index_(built(data, workers)) {
  arrange(data, workers);
  for (const std::uint32_t m : data.materials)
    material_count_ = std::max<std::size_t>(material_count_, std::size_t{m} + 1);
  if (material_count_ > 256)
    materials_ = numbers<std::uint32_t>(data.materials);
  else if (material_count_ > 1)
    materials8_ = numbers<std::uint8_t>(data.materials);
  if (!data.texture.empty()) texture_ = texture_of(data);
  masks_ = Masks(data.masks);
}

/// Mesh whose materials may have holes, as `MeshData::masks` says.
template <Accelerator Index = Bvh<float>>
using MaskedMesh = TriangleMesh<Index, detail::MaskTable>;

}  // namespace PULSECAST_NAMESPACE

#endif
