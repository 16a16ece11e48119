// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SCENE_SCENE_HPP
#define PULSECAST_SCENE_SCENE_HPP

#include <pulsecast/accel/refit.hpp>
#include <pulsecast/geometry/detail/bundle_budget.hpp>
#include <pulsecast/scene/detail/surface_sample.hpp>
#include <pulsecast/scene/find_hits.hpp>

namespace PULSECAST_NAMESPACE {

/// Static parts of the given kinds of geometry: `Scene<TriangleMesh<>>`, without code for others.
/// Parts share geometries: a second scene of other parts or placements costs one box per part, as
/// for changes between repetitions of a survey (leaves fall, a car is gone).
template <Geometry... Shapes>
class Scene {
  static_assert((detail::members_checked<Shapes, tag::UniformGeometry, tag::DeterministicGeometry,
                                         tag::TimeDependentGeometry, tag::MissesCones> &&
                 ...));

 public:
  /// True if hits depend on the tick of a ray.
  static constexpr bool time_dependent = (TimeDependentGeometry<Shapes> || ...);
  using Part = pulsecast::Part<Shapes...>;  ///< part of this scene

  /// `workers` build the index over the parts; the scene is the same for any. @throws SettingError
  /// for a moving part, a missing geometry, too few materials, or a placement out of range
  explicit Scene(std::vector<Part> parts, const Workers& workers = {});

  /// Scene of the same parts at other placements, one per part, that shares all geometry. The index
  /// over the parts is refitted, or made anew where it would be too slow; hits are those of a new
  /// scene. @throws SettingError for another number of placements, or one out of range
  [[nodiscard]] Scene with_placements(std::span<const Placement> placements, const Workers& workers = {}) const {
    return with_placements(placements, Scene(std::vector<Part>()), workers);
  }
  /// As above, in the memory of a scene no longer used: a loop over two soon allocates nothing.
  [[nodiscard]] Scene with_placements(std::span<const Placement> placements, Scene&& unused,
                                      const Workers& workers = {}) const {
    require_within("Scene::with_placements (number)", placements.size(), parts_.size(), parts_.size());
    unused.parts_ = parts_;
    unused.boxes_.resize(placements.size());
    for (std::size_t i = 0; i < placements.size(); ++i) {
      Part& part = unused.parts_[i];
      part.placement = validated(placements[i]);
      const auto bounds = [](const auto& shape) -> const Box& { return shape->bounds(); };
      unused.boxes_[i] = detail::placed_box(part.placement, visit_shape(bounds, part.geometry));
    }
    unused.refit_.update(index_, refit_, unused.boxes_, unused.index_, workers);
    unused.note_parts();
    return std::move(unused);
  }

  /// Scene with more parts after those of this one. Shares all geometry. @throws SettingError
  [[nodiscard]] Scene with_parts(std::span<const Part> more, const Workers& workers = {}) const {
    std::vector<Part> all = parts_;
    all.insert(all.end(), more.begin(), more.end());
    return Scene(std::move(all), workers);
  }
  /// Scene without the parts for which `leaves(part)` is true. Shares all geometry.
  template <std::predicate<const Part&> Leaves>
  [[nodiscard]] Scene without(const Leaves& leaves, const Workers& workers = {}) const {
    std::vector<Part> all;
    for (const Part& part : parts_)
      if (!leaves(part)) all.push_back(part);
    return Scene(std::move(all), workers);
  }

  [[nodiscard]] const Box& bounds() const noexcept { return index_.bounds(); }
  [[nodiscard]] std::span<const Part> parts() const noexcept { return parts_; }
  template <class Visitor>
  void visit_materials(const Visitor& visit) const {
    const void* last = nullptr;  // neighbouring parts often share a table
    for (const Part& part : parts_)
      if (std::exchange(last, part.materials.get()) != part.materials.get())
        for (const Material& material : *part.materials) visit(material);
  }
  /// True if no hit depends on the key of a ray, as of parts that are a `DeterministicGeometry`.
  [[nodiscard]] bool deterministic() const noexcept { return deterministic_; }

  [[nodiscard]] std::size_t memory() const {
    std::size_t bytes =
        index_.memory() + refit_.memory() + parts_.capacity() * sizeof(Part) + boxes_.capacity() * sizeof(Box);
    detail::SharedMemorySum<> shared;
    for (const Part& part : parts_) {
      bytes += detail::heap_bytes(part.name);
      visit_shape([&](const auto& shape) { shared.add(shape.get(), shape->memory()); }, part.geometry);
      std::size_t table = sizeof(*part.materials) + part.materials->capacity() * sizeof(Material);
      for (const Material& material : *part.materials) {
        table += detail::heap_bytes(material.name);
        if (material.spectrum) shared.add(material.spectrum.get(), material.spectrum->memory());
        const Image* const of_map = material.reflectance_map ? material.reflectance_map->picture() : nullptr;
        for (const Image* image : {material.picture.get(), of_map})
          if (image) shared.add(image->samples.data(), image->samples.memory());
      }
      shared.add(part.materials.get(), table);
    }
    return bytes + shared.sum();
  }

  /// Nearest hit of each ray of the bundle, one per ray. Ties between parts go to the first.
  void closest(const RayBundle& rays, std::span<Hit> hits) const noexcept {
    describe(rays, nearest(rays), rays.wavelength, hits, placements(), AskLaws{});
  }
  /// As above, and visits the surfaces in place of asking their laws, as with `SceneQueries`.
  template <class Visitor>
  void closest(const StaggeredBundle& rays, std::span<Hit> hits, const Visitor& visit) const noexcept {
    describe(rays, nearest(rays), rays.wavelength, hits, placements(), visit);
  }

  using TracesSheaves = Scene;  ///< as the concept requires
  /// As above, of each ray of a sheaf.
  void closest(const detail::RaySheaf& rays, double wavelength, std::span<Hit> hits) const noexcept
      requires(detail::TakesSingleRays<Shapes>&&...) {
    detail::SheafHits nearest(rays);
    search(rays, nearest);
    for (std::size_t j = 0; j < rays.size; ++j)
      describe(rays.rays[j], nearest.of[j], wavelength, hits.subspan(j, 1), placements(), AskLaws{});
  }

  /// Offers the hits of the rays of a bundle to `hits`, by part and primitive.
  void closest(const RayBundle& rays, ClosestHits& hits) const noexcept { search(rays, hits); }

  [[nodiscard]] bool misses_cone(const RayCone& cone) const noexcept {
    if (!single_part_) return index_.misses_cone(cone);
    if (cone.passes(bounds())) return true;
    const auto upper_levels = [&]<class Shape>(const std::shared_ptr<const Shape>& shape) noexcept {
      if constexpr (MissesCones<Shape>) return parts_[0].placement.identity() && shape->misses_cone(cone);
      return false;
    };
    return visit_shape(upper_levels, parts_[0].geometry);
  }

  [[nodiscard]] std::optional<RayHit> closest_hit(const Ray& ray) const noexcept {
    return detail::closest_hit(ray, searcher());
  }

  [[nodiscard]] bool occluded(const Ray& ray, double range = detail::infinity) const noexcept {
    return detail::occluded(ray, range, searcher());
  }

  /// Calls `visitor(hit)` with every `RayHit` of a ray, by range and then by part and primitive,
  /// until it returns false; it may return nothing. Each triangle counts once, a solid voxel where
  /// the ray enters it or leaves for the open, of leaves those that light of its key meets first,
  /// user-defined shapes by `closest` from each hit on. Allocates nothing. Returns the calls.
  template <class Visitor>
  std::size_t all_hits(const Ray& ray, Visitor&& visitor) const
      noexcept(std::is_nothrow_invocable_v<Visitor&, const RayHit&>) {
    return detail::visit_hits(ray, searcher(), visitor);
  }

  [[nodiscard]] SurfaceInteraction surface(const RayHit& hit, const Ray& ray) const noexcept {
    return detail::surface_at(hit, ray, parts_[hit.part], parts_[hit.part].placement);
  }

  /// Height of the ground material nearest to a height; by default the highest [m]; empty without.
  [[nodiscard]] std::optional<double> ground_height(const Vec2& at, double near = detail::infinity) const noexcept {
    if (!(bounds().min.z <= bounds().max.z)) return std::nullopt;
    const Ray down{.origin = {at.x, at.y, bounds().max.z + 1}, .direction = -axis::up};
    std::optional<double> height;  // of all hits: another part may lie on it
    all_hits(down, [&](const RayHit& hit) noexcept {
      if (!surface(hit, down).material->ground) return true;
      const double next = down.origin.z - hit.range;
      if (!height || !(*height - near < near - next)) height = next;
      return next > near;
    });
    return height;
  }

 private:
  template <Geometry... OfMoving>
  friend class MovingScene;
  template <detail::HasParts Map>
  friend class WithoutObject;

  enum class Motions : std::uint8_t { refused, left_out };
  struct AskLaws {};  ///< in place of a visitor
  struct AnyPart {    ///< in place of a choice of parts
    constexpr bool operator()(const Part&) const noexcept { return true; }
  };

  /// Refuses moving parts, or leaves them out of the index.
  Scene(std::vector<Part> parts, Motions motions, const Workers& workers)
      : parts_(std::move(parts)), index_(boxes(parts_, motions), workers, 1) {
    note_parts();
  }

  void note_parts() noexcept {
    single_part_ = parts_.size() == 1 && !parts_[0].motion;
    single_untransformed_part_ = single_part_ && parts_[0].placement.identity();
    const auto deterministic = []<class Shape>(const std::shared_ptr<const Shape>&) noexcept {
      return DeterministicGeometry<Shape>;
    };
    deterministic_ = true;
    for (const Part& part : parts_) deterministic_ = deterministic_ && visit_shape(deterministic, part.geometry);
  }

  /// Boxes of parts, whose placements are validated.
  static SharedBuffer<Box> boxes(std::vector<Part>& parts, Motions motions) {
    const SharedBuffer<Box> boxes(parts.size());
    for (std::size_t i = 0; i < parts.size(); ++i) {
      Part& part = parts[i];
      detail::validate_in_place(part.placement);
      if (part.motion && motions == Motions::refused)
        throw_setting_error("Part::motion (number)", 1, "", "0 in a Scene; a MovingScene moves parts");
      const auto box_of = [&](const auto& shape) {
        if (!shape) throw_setting_error("Part::geometry (number)", 0, "", "1");
        const std::size_t materials = part.materials ? part.materials->size() : 0;
        require_within("Part::materials (number)", materials, shape->material_count(), 4294967295);
        return part.motion ? Box{} : part.placement.box(shape->bounds());
      };
      boxes[i] = visit_shape(box_of, part.geometry);
    }
    return boxes;
  }

  const Scene& still() const noexcept { return *this; }
  auto placements(const Tick& = {}) const noexcept {
    return [this](std::size_t part) noexcept -> const Placement& { return parts_[part].placement; };
  }

  template <class Rays>
  ClosestHits nearest(const Rays& rays) const noexcept {
    ClosestHits nearest(rays);
    search(rays, nearest);
    return nearest;
  }

  template <class Meets = AnyPart>
  auto searcher(Meets meets = {}) const noexcept {
    return [this, meets](const SingleRayPacket& ray, auto& hits) noexcept { this->search(ray, hits, meets); };
  }
  /// Offers the hits of parts for which `meets(part)` is true.
  template <class Rays, class Hits, class Meets = AnyPart>
  void search(const Rays& rays, Hits& hits, Meets meets = {}) const noexcept {
    if constexpr (std::is_same_v<Rays, RayBundle> && (detail::Intersects<Shapes, SingleRayPacket, ClosestHit> && ...))
      if (rays.size == 1) return detail::closest_one_by_one(rays, hits, searcher(meets));  // cheaper in frames of parts
    if constexpr (std::is_same_v<Rays, detail::RaySheaf>)
      if (!rays.together) {
        for (std::size_t j = 0; j < rays.size; ++j) search(rays.rays[j], hits.of[j], meets);
        return;
      }
    const auto test = [&, meets](std::span<const PrimitiveIndex> found) noexcept {
      for (const PrimitiveIndex p : found)
        if (meets(parts_[p])) closest_in(p, parts_[p].placement, rays, hits);
    };
    if (single_part_ && !meets(parts_[0])) return;
    if (single_untransformed_part_)
      closest_in(0, rays, hits);
    else if (single_part_)
      closest_in(0, parts_[0].placement, rays, hits);  // shapes test their own bounds
    else
      index_.closest(rays, test, hits);
  }

  template <class Rays, class Hits>
  void closest_in(std::size_t part, const Placement& placement, const Rays& rays, Hits& nearest) const noexcept {
    if (placement.identity()) return closest_in(part, rays, nearest);
    if constexpr (std::is_same_v<Rays, detail::RaySheaf>) {
      Rays local;
      for (std::size_t j = 0; j < rays.size; ++j) local.push_back(placement.to_local(rays.rays[j]), rays.far[j]);
      if (local.enclose()) return closest_in(part, local, nearest);
      for (std::size_t j = 0; j < rays.size; ++j) closest_in(part, local.rays[j], nearest.of[j]);
    } else {
      closest_in(part, placement.to_local(rays), nearest);
    }
  }
  /// `local` are rays in the frame of the part.
  template <class Rays, class Hits>
  void closest_in(std::size_t part, const Rays& local, Hits& nearest) const noexcept {
    nearest.part = std::uint64_t{part} << 32;
    const auto offer = [&](const auto& shape) noexcept { detail::offer_hits(*shape, local, nearest); };
    visit_shape(offer, parts_[part].geometry);
  }

  /// Sets the geometry of the hits of rays, and visits their surfaces, by the placements of parts.
  template <class PlacementOf, class Visitor>
  void describe(const auto& rays, const auto& nearest, double wavelength, std::span<Hit> hits,
                const PlacementOf& placement_of, const Visitor& visit) const noexcept {
    using Rays = std::conditional_t<(std::remove_cvref_t<decltype(rays)>::capacity > 1), RayBundle, SingleRayPacket>;
    constexpr std::size_t nothing = std::size_t(-1);
    std::size_t at = nothing;  // part of the frame of `local`
    const Rays* local = &rays;
    Rays turned;
    for (std::size_t first = 0, end = 0; first < rays.size; first = end) {
      end = first + 1;
      if (!nearest.met(first)) {
        while (end < rays.size && !nearest.met(end)) ++end;
        std::fill_n(&hits[first], end - first, Hit{});
        continue;
      }
      if (at != nearest.part_of(first)) {
        at = nearest.part_of(first);
        const Placement& placement = placement_of(at);
        local = placement.identity() ? &rays : &(turned = placement.to_local(static_cast<const Rays&>(rays)));
      }
      const detail::SurfaceSampler<Part, Rays> sampler{parts_[at], nearest.primitive_of(first), *local, first};
      const detail::SurfaceSample surface = visit_shape(sampler, parts_[at].geometry);
      // neighbouring rays often hit the same primitive
      if (surface.uniform)
        while (end < rays.size && nearest.id[end] == nearest.id[first]) ++end;
      const Vec3 n = surface.normal / local->direction_length;
      const ObjectId object = parts_[at].object;
      const std::uint16_t classification = surface.material->classification;
      const double least = surface.normal == Vec3{} ? 1 : 0;
      for (std::size_t j = first; j < end; ++j) {
        const double cosine = std::min(1.0, std::fabs(dot(local->direction(j), n)));
        Hit& hit = hits[j];
        hit.range = nearest.range[j];
        hit.cos_incidence = std::max(least, cosine);
        hit.object = object;
        hit.classification = classification;
      }
      if constexpr (std::is_same_v<Visitor, AskLaws>)
        scatter_at(*surface.material, wavelength, surface.texture, hits.subspan(first, end - first));
      else
        visit(first, end,
              SurfaceInteraction{.normal = placement_of(at).rotation * surface.normal,
                                 .material_index = surface.material_index,
                                 .foliage = surface.foliage,
                                 .classification = classification,
                                 .object = object,
                                 .material = surface.material,
                                 .texture = surface.texture});
    }
  }

  std::vector<Part> parts_;
  Bvh<float> index_;
  bool single_part_ = false;                ///< a single part, static
  bool single_untransformed_part_ = false;  ///< and without a placement
  bool deterministic_ = false;
  std::vector<Box> boxes_;  ///< of each part, after `with_placements`
  BvhRefit<float> refit_;
};

template <Geometry... Shapes>
Scene<Shapes...>::Scene(std::vector<Part> parts, const Workers& workers)
    : Scene(std::move(parts), Motions::refused, workers) {}

}  // namespace PULSECAST_NAMESPACE

#endif
